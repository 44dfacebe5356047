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

/// A mark of a road or a river that lies on a mesh. Column and row are the mark's index and the line's number.
struct StrokeLineSpot : StrokeSpot
{
    StrokeLines::Kind kind = StrokeLines::ROAD;
    osg::Vec3d along; ///< along the line on the ground, in the geometry's frame, of any length
};

/** Finds the lattice points on a tile's mesh.

    A point belongs to the triangle that its stroke's place lies in, seen from above; one on an edge to one of the two that share it,
    also where these are in two tiles: vertices are rounded to a grid, on which the test is exact. Left out are triangles
    with heights that are not numbers, those nearly seen from the edge (tiles' skirts), from below, and those around a pole.

    The finest level that a tile has follows from the tile's size in lattice steps alone, such that its longer side
    has at most `strokesAlongTile` points. Levels nest: what a tile has, all finer tiles over the same ground have, too.

    Marks of lines are found in the same way, at half the lattice's spacing, and from the tile's whole level on. */
class StrokeScan
{
public:
    /// `toWorld` is the way from the geometry's frame to the world. `lines` in other units
    /// than the lattice's terrain has are none; `spacing` is the lattice's, metres.
    StrokeScan(const StrokeLattice& lattice, const osg::Geometry& mesh, const osg::Matrixd& toWorld,
               double strokesAlongTile, const StrokeLines* lines = nullptr, double spacing = 25.0);

    /// The finest level, in halves, and the spots, in no particular but always the same order.
    int finest() const { return _finest; }
    const std::vector<StrokeSpot>& spots() const { return _spots; }
    /// Of roads and rivers; and their finest level, in halves.
    const std::vector<StrokeLineSpot>& lineSpots() const { return _lineSpots; }
    int finestOfLines() const { return 2 * (_finest / 2) - 2; }
    /// Columns and rows of the triangles lie between these.
    const osg::Vec2d& low() const { return _low; }
    const osg::Vec2d& high() const { return _high; }
    /// Height above the ellipsoid or z = 0, and the unit vector upwards in the geometry's frame, of a vertex of a spot.
    double height(unsigned int vertex) const { return _coordinates[vertex].z(); }
    /// The mesh's vertices; null where it has none that can be read.
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
    osg::ref_ptr<const osg::Vec3Array> _vertices; ///< the mesh's, or as many of another type
    std::vector<unsigned int> _corners;           ///< of the mesh's triangles
    const osg::Matrixd _toWorld;
    std::vector<osg::Vec3d> _coordinates; ///< of the vertices: column, row, height
    osg::Vec2d _low, _high;               ///< of the triangles
    int _finest = 0;
    std::vector<StrokeSpot> _spots;
    std::vector<StrokeLineSpot> _lineSpots;
};

} // namespace osgGeoFX
