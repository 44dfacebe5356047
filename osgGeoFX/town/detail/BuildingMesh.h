// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>

#include <osg/Geometry>
#include <osg/Matrixd>

#include <vector>

namespace osgGeoFX
{

class Openness;

/// A level of detail of a building.
enum class BuildingLevel
{
    SINGLE, ///< a prism in one color
    DETAIL  ///< with windows, and with its roof
};

/** Collects buildings into one geometry in a local frame, metres.

    Walls stand `depth` below the lowest ground below a building, for ground that is drawn coarsely. Only a part above the ground
    has a floor. Each
    vertex has a normal, a color, a texture coordinate in the picture of windows (WindowPicture.h), and its building's reference
    (RigidParts). Walls face outward and courtyards inward; triangles are counter-clockwise seen from outside. Not
    thread-safe. */
class BuildingMesh
{
public:
    /// With `openness`, what is shut in is darker. `toOpenness`: from this frame to that of its places; both are upright.
    explicit BuildingMesh(double depth, const Openness* openness = nullptr,
                          const osg::Matrixd& toOpenness = {})
        : _depth(depth), _openness(openness), _toOpenness(toOpenness)
    {
    }

    /// `number`: of the building in the openness.
    void add(const PlacedBuilding& building, BuildingLevel level, std::size_t number = 0);
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
    void quad(const osg::Vec3d (&corners)[4], const osg::Vec3d& normal, const osg::Vec3d (&colors)[4],
              const osg::Vec2d& from, const osg::Vec2d& to);
    /// What is left of the color at some heights of a vertical.
    std::vector<double> shades(const osg::Vec2d& place, const osg::Vec3d& normal,
                               const std::vector<double>& heights, bool roof) const;
    void flatRoof(const std::vector<Ring>& rings, double z, const osg::Vec3d& color);
    void floor(const PlacedBuilding& building, const osg::Vec3d& color);
    void gable(const PlacedBuilding& building, double eaves, const Look& look);
    void face(const std::vector<osg::Vec3d>& corners, const osg::Vec3d& color);

    const double _depth;
    const Openness* const _openness;
    const osg::Matrixd _toOpenness;
    std::size_t _number = 0; ///< of the building in it
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

/// From a gabled roof's eaves to its ridge, metres; 0 for a flat roof.
double roofRise(const PlacedBuilding& building);

/// The top of a prism that is as high as the building is on average.
inline double meanTop(const PlacedBuilding& building)
{
    return building.top - 0.5 * roofRise(building);
}

} // namespace osgGeoFX
