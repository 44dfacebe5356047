// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/StrokeLines.h>
#include <osgGeoFX/panorama/detail/StrokeLattice.h>

#include <osg/Geometry>
#include <osg/Matrixd>

#include <array>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// A lattice point that lies on a mesh.
struct StrokeSpot
{
    std::int64_t column = 0, row = 0;
    int halfLevel = 0;
    std::array<unsigned int, 3> corners{}; ///< vertices of the triangle
    std::array<double, 3> weights{};       ///< of them; the sum is 1
};

/// A mark of a road or a river on a mesh. Its column and row are the mark's index and the line's number.
struct StrokeLineSpot : StrokeSpot
{
    StrokeLines::Kind kind = StrokeLines::ROAD;
    osg::Vec3d along; ///< along the line on the ground, in the geometry's frame, of any length
};

/** Finds the lattice points on a tile's mesh.

    A point belongs to the triangle under its stroke's place, seen from above. A point on an edge belongs to one of
    the two triangles that share it, even if these are in two tiles: vertices are rounded to a grid, on which the test
    is exact. Some triangles do not count: those with heights that are not numbers, nearly upright ones (tiles'
    skirts), those seen from below, and those around a pole.

    The finest level of a tile follows from the tile's size in lattice steps alone: its longer side has at most
    `strokesAlongTile` points. Levels nest: finer tiles over the same ground have everything that a tile has.

    Marks of lines are found in the same way, at half the lattice's spacing, from the tile's whole level on. */
class StrokeScan
{
public:
    /// `toWorld` is the matrix from the geometry's frame to the world. `lines` in other units than the terrain's do
    /// not count. `spacing` is the lattice's, metres.
    StrokeScan(const StrokeLattice& lattice, const osg::Geometry& mesh, const osg::Matrixd& toWorld,
               double strokesAlongTile, const StrokeLines* lines = nullptr, double spacing = 25.0);

    /// The finest level, in halves, and the spots. Their order is always the same.
    int finest() const { return _finest; }
    const std::vector<StrokeSpot>& spots() const { return _spots; }
    /// The spots of roads and rivers, and their finest level, in halves.
    const std::vector<StrokeLineSpot>& lineSpots() const { return _lineSpots; }
    int finestOfLines() const { return 2 * (_finest / 2) - 2; }
    /// The least and the largest column and row of the triangles.
    const osg::Vec2d& low() const { return _low; }
    const osg::Vec2d& high() const { return _high; }
    /// Of a vertex of a spot: the height above the ellipsoid or z = 0, and the upward unit vector in the geometry's
    /// frame.
    double height(unsigned int vertex) const { return _coordinates[vertex].z(); }
    /// The mesh's vertices. Null if there are none that can be read.
    const osg::Vec3Array* vertices() const { return _vertices; }
    osg::Vec3d up(unsigned int vertex) const;

private:
    struct Triangle;
    struct Footing;

    std::vector<Triangle> usable() const;
    void addIfUsable(const unsigned int* corners, std::vector<Triangle>& triangles) const;
    void chooseLevel(const std::vector<Triangle>& triangles, double strokesAlongTile);
    void sow(std::vector<StrokeSpot>& spots) const;
    std::vector<Footing> footings(const std::vector<Triangle>& triangles,
                                  const std::vector<osg::Vec2d>& places) const;
    void settle(const std::vector<Triangle>& triangles);
    void settleLines(const std::vector<Triangle>& triangles, const StrokeLines& lines, double spacing);

    const StrokeLattice& _lattice;
    osg::ref_ptr<const osg::Vec3Array> _vertices; ///< the mesh's, or a copy of those of another type
    std::vector<unsigned int> _corners;           ///< of the mesh's triangles
    const osg::Matrixd _toWorld;
    std::vector<osg::Vec3d> _coordinates; ///< of the vertices: column, row, height
    osg::Vec2d _low, _high;               ///< of the triangles
    int _finest = 0;
    std::vector<StrokeSpot> _spots;
    std::vector<StrokeLineSpot> _lineSpots;
};

} // namespace osgGeoFX
