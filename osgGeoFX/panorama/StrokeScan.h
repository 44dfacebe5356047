// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/StrokeLattice.h>

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

/** Finds the lattice points on a tile's mesh.

    A point belongs to the triangle that its stroke's place lies in, seen from above; one on an edge to one of the two that share it,
    also where these are in two tiles: vertices are rounded to a grid, on which the test is exact. Left out are triangles
    with heights that are not numbers, those nearly seen from the edge (tiles' skirts), from below, and those around a pole.

    The finest level that a tile has follows from the tile's size in lattice steps alone, such that its longer side
    has at most `strokesAlongTile` points. Levels nest: what a tile has, all finer tiles over the same ground have, too. */
class OSGGEOFX_EXPORT StrokeScan
{
public:
    /// `toWorld` is the way from the geometry's frame to the world. The geometry must outlive the scan.
    StrokeScan(const StrokeLattice& lattice, const osg::Geometry& mesh, const osg::Matrixd& toWorld,
               double strokesAlongTile);

    /// The finest level, in halves, and the spots, in no particular but always the same order.
    int finest() const { return _finest; }
    const std::vector<StrokeSpot>& spots() const { return _spots; }
    /// Height above the ellipsoid or z = 0, and the unit vector upwards in the geometry's frame, of a vertex of a spot.
    double height(unsigned int vertex) const { return _coordinates[vertex].z(); }
    osg::Vec3d up(unsigned int vertex) const;

private:
    struct Triangle;
    struct Collect;

    std::vector<Triangle> usable() const;
    void chooseLevel(const std::vector<Triangle>& triangles, double strokesAlongTile);
    void sow(std::vector<StrokeSpot>& spots) const;
    void settle(const std::vector<Triangle>& triangles);

    const StrokeLattice& _lattice;
    const osg::Geometry& _mesh;
    const osg::Vec3Array* _vertices = nullptr;
    const osg::Matrixd _toWorld;
    std::vector<osg::Vec3d> _coordinates; ///< of the vertices: column, row, height
    osg::Vec2d _low, _high;               ///< of the triangles
    int _finest = 0;
    std::vector<StrokeSpot> _spots;
};

} // namespace osgGeoFX
