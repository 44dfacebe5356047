// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Vec3d>
#include <osg/observer_ptr>

#include <vector>

namespace osgGeoFX
{

/** The triangles of a drawable, in the order in which OpenGL draws them, for work on the CPU.

    OSG's own functors know only osg::Vec3 vertices, and trust every index. This class reads vertex arrays of all
    types. They may have two, three or four coordinates; the first three are divided by the fourth. It knows primitive
    restart. None of its numbers lies beyond the array. It is a copy, so the drawable may change afterwards. */
class DrawableTriangles
{
public:
    explicit DrawableTriangles(const osg::Drawable& drawable);

    /// In the drawable's frame. Empty if the vertices cannot be read.
    const std::vector<osg::Vec3d>& positions() const { return _positions; }
    /// Numbers of positions, three for each triangle.
    const std::vector<unsigned int>& corners() const { return _corners; }

    /// Triangles in a row that are drawn equally often.
    struct Part
    {
        std::size_t end; ///< where the next part begins in corners()
        int instances;   ///< as in osg::PrimitiveSet; 0 without instancing
    };
    const std::vector<Part>& parts() const { return _parts; }

    /// Of a geometry, where the triangles of each of its primitive sets end in corners().
    const std::vector<std::size_t>& setEnds() const { return _setEnds; }

    /// Whether these triangles are everything that the drawable draws, at the places where it draws. False with
    /// points, lines or instances, with a bounding box that its owner set (a shader may move the vertices), and if
    /// anything could not be read.
    bool tellAll() const { return _tellAll; }
    /// Whether a primitive set of a geometry is drawn more than once.
    static bool instanced(const osg::Geometry& geometry);

private:
    class Reader;

    std::vector<osg::Vec3d> _positions;
    std::vector<unsigned int> _corners;
    std::vector<Part> _parts;
    std::vector<std::size_t> _setEnds;
    bool _tellAll = true;
};

/** Tells whether a geometry still has its vertices and primitives: the same arrays with the same counts of changes. */
class GeometryStamp
{
public:
    enum What
    {
        SHAPE,     ///< vertices and primitives
        ALL_ARRAYS ///< also which other arrays it has
    };

    GeometryStamp() = default;
    explicit GeometryStamp(const osg::Geometry& geometry, What what = SHAPE);
    bool matches(const osg::Geometry& geometry) const;

private:
    using Parts = std::vector<osg::observer_ptr<const osg::Referenced>>;
    /// Calls an action with each part. False as soon as the action returns false.
    template<typename Action>
    static bool forEachPart(const osg::Geometry& geometry, What what, Action action);
    static unsigned int changes(const osg::Geometry& geometry);

    What _what = SHAPE;
    Parts _parts;
    unsigned int _changes = 0;
    bool _taken = false;
};

} // namespace osgGeoFX
