// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>

#include <osg/Geometry>

#include <vector>

namespace osgGeoFX
{

/// A level of detail of a building.
enum class BuildingLevel
{
    SINGLE, ///< a prism in one color
    DETAIL  ///< with windows, and with its roof
};

/** Collects buildings into one geometry in a local frame, metres.

    Walls stand `depth` below the lowest ground below a building, for ground that is drawn coarsely. There is no floor. Each
    vertex has a normal, a color, a texture coordinate in the picture of windows (WindowPicture.h), and its building's reference
    (RigidParts). Walls face outward and courtyards inward; triangles are counter-clockwise seen from outside. Not
    thread-safe. */
class BuildingMesh
{
public:
    explicit BuildingMesh(double depth) : _depth(depth) {}

    void add(const PlacedBuilding& building, BuildingLevel level);
    bool empty() const { return _triangles.empty(); }
    /// All that was added, as one geometry; null if nothing was.
    osg::ref_ptr<osg::Geometry> create() const;

private:
    struct Look;
    unsigned int vertex(const osg::Vec3d& place, const osg::Vec3d& normal, const osg::Vec3d& color, double u,
                        double v);
    /// Corners counter-clockwise from outside, with their texture coordinates and shades.
    void wall(const PlacedBuilding& building, const osg::Vec2d& a, const osg::Vec2d& b, double eaves,
              const Look& look, bool windows);
    void quad(const osg::Vec3d (&corners)[4], const osg::Vec3d& normal, const osg::Vec3d& lower,
              const osg::Vec3d& upper, const osg::Vec2d& from, const osg::Vec2d& to);
    void flatRoof(const std::vector<Ring>& rings, double z, const osg::Vec3d& color);
    void gable(const PlacedBuilding& building, double eaves, const Look& look);
    void face(const std::vector<osg::Vec3d>& corners, const osg::Vec3d& color);

    const double _depth;
    std::vector<osg::Vec3> _places, _normals, _references;
    std::vector<osg::Vec4ub> _colors;
    std::vector<osg::Vec2> _texels;
    std::vector<unsigned int> _triangles;
    osg::Vec3 _reference;
};

/// The triangles of a polygon with holes, counter-clockwise, three places each.
std::vector<osg::Vec2d> triangulate(const std::vector<Ring>& rings);

/// Whether an outline is a rectangle, about, and so can have a gabled roof.
bool isRectangle(const std::vector<Ring>& rings);

} // namespace osgGeoFX
