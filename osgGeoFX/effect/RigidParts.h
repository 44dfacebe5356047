// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/Array>
#include <osg/Geometry>
#include <osg/Node>
#include <osg/Vec3d>

#include <vector>

namespace osgGeoFX
{

/** Many things in one geometry, such as the buildings of a town, that each keep their shape where the ground below them is
    deformed. It is the scene's RigidReference for thousands of things without a node for each.

    Each vertex names the reference point of its thing. The deformation moves this point, and the thing turns as the ground
    there does. Light falls on the thing as it stands undeformed, as it does on the ground. The vertex attribute number
    `attribute` has four floats: the reference point in the geometry's frame, and the radius of the geometry's largest thing
    about its reference point, metres, which is the same at all vertices. The define GEOFX_RIGID must be in force in a state
    set at or above the geometry. Without the kit, OpenGL ignores both.

    Bounding spheres at and above the geometry must contain a ball of this radius about each reference point; finish() sees to
    the geometry's own. The geometry must be in metres: a transform above it must not scale.

    The functions only read. Any thread may call them.
    @ingroup effect */
struct OSGGEOFX_EXPORT RigidParts
{
    static constexpr unsigned int attribute = 13;
    static constexpr const char* define = "GEOFX_RIGID";

    /// Whether the define is in force at some place, by the state sets on the way down to it. OSG's rules of inheritance apply, as on
    /// the GPU. Without it the attribute belongs to the application.
    struct OSGGEOFX_EXPORT Switch
    {
        bool on = false;
        bool overridden = false;
        /// Inherits from a state set on the way down; null changes nothing.
        void meet(const osg::StateSet* state);
    };
    /// The array of references of the drawable at the end of a path, if the define is in force there; otherwise null. What stands
    /// above the path's first node counts, too, but for the camera of a view; of several parents the first one.
    static const osg::Vec4Array* inForce(const osg::NodePath& path);
    /// The array of references, whether the define is in force or not; null if the geometry has none of this kind.
    static const osg::Vec4Array* of(const osg::Drawable& drawable)
    {
        const osg::Geometry* geometry = drawable.asGeometry();
        if (!geometry || geometry->getVertexAttribArrayList().size() <= attribute) return nullptr;
        return arrayOf(*geometry);
    }
    /// The radius of the largest thing, metres; 0 if the drawable has no such things.
    static double radius(const osg::Drawable& drawable)
    {
        const osg::Vec4Array* references = of(drawable);
        return references && !references->empty() ? static_cast<double>(references->front().w()) : 0.0;
    }

    /// Gives the geometry one reference for each vertex, computes the radius, and sets the geometry's initial bound.
    static void finish(osg::Geometry& geometry, const std::vector<osg::Vec3>& references);

    /// The deformed place of a vertex whose thing has this reference. All are in eye space.
    static osg::Vec3d place(const DeformationChain& chain, const osg::Vec3d& position,
                            const osg::Vec3d& reference);
    /// How far the drawable's things may reach beyond what becomes of its bounding box, metres; 0 without such things. `ball` is
    /// around the box, in eye space; `scale` is that of the matrix to eye space.
    static double reach(const osg::Drawable& drawable, const DeformationChain& chain, const Ball& ball,
                        double scale);

private:
    static const osg::Vec4Array* arrayOf(const osg::Geometry& geometry);
};

} // namespace osgGeoFX
