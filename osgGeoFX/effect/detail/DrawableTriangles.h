// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Vec3d>
#include <osg/observer_ptr>

#include <vector>

namespace osgGeoFX
{

/** The triangles of a drawable, in the order in which OpenGL draws them: for whoever works on them on the CPU.

    OSG's own functors know vertices as osg::Vec3 alone and trust every index. This one reads vertex arrays of all types, with two
    coordinates, three, or four, which are divided by the last; it knows primitive restart; and no number that it hands out lies
    beyond the array. Made of a copy, so the drawable may change afterwards. */
class DrawableTriangles
{
public:
    explicit DrawableTriangles(const osg::Drawable& drawable);

    /// In the drawable's frame; empty where its vertices cannot be read.
    const std::vector<osg::Vec3d>& positions() const { return _positions; }
    /// Three for each triangle, numbers of positions.
    const std::vector<unsigned int>& corners() const { return _corners; }

    /// Triangles in a row that are drawn equally often.
    struct Part
    {
        std::size_t end; ///< where the next part begins in corners()
        int instances;   ///< as osg::PrimitiveSet has it: 0 where they are not instanced
    };
    const std::vector<Part>& parts() const { return _parts; }

    /// Whether the triangles are all that the drawable draws, and where it draws it: no points and lines, no instances, no box
    /// that its owner has told (a shader may move the vertices), nothing that could not be read.
    bool tellAll() const { return _tellAll; }
    /// Whether a geometry is drawn more than once by one of its primitive sets.
    static bool instanced(const osg::Geometry& geometry);

private:
    class Reader;

    std::vector<osg::Vec3d> _positions;
    std::vector<unsigned int> _corners;
    std::vector<Part> _parts;
    bool _tellAll = true;
};

/** Tells whether a geometry still has the vertices and primitives that it had: the same arrays, which count their own changes. */
class GeometryStamp
{
public:
    enum What
    {
        SHAPE,     ///< vertices and primitives
        ALL_ARRAYS ///< which arrays it has for all else, too
    };

    GeometryStamp() = default;
    explicit GeometryStamp(const osg::Geometry& geometry, What what = SHAPE);
    bool matches(const osg::Geometry& geometry) const;

private:
    using Parts = std::vector<osg::observer_ptr<const osg::Referenced>>;
    /// Calls an action with each part; false as soon as the action says so.
    template<typename Action>
    static bool forEachPart(const osg::Geometry& geometry, What what, Action action);
    static unsigned int changes(const osg::Geometry& geometry);

    What _what = SHAPE;
    Parts _parts;
    unsigned int _changes = 0;
    bool _taken = false;
};

} // namespace osgGeoFX
