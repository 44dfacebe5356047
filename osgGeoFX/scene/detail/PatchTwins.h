// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <osg/Geometry>
#include <osg/observer_ptr>

#include <unordered_map>

namespace osgGeoFX
{

/** The same triangles as geometries have, as patches for tessellation. A twin shares all arrays of its geometry, which stays as it
    is, and has indices of its own. It is made when it is first asked for, and kept as long as it is in use. For one thread at a
    time. */
class PatchTwins
{
public:
    /// Whether a drawable can have a twin: an osg::Geometry and no other class, of nothing but triangles (strips, fans and quads are
    /// some), without instances, draw callbacks, values for each primitive set, or things that keep their shape (RigidParts).
    static bool mayHave(const osg::Drawable& drawable);

    /// Null where there is none.
    osg::Geometry* of(osg::Geometry& geometry);
    /// Forgets those of deleted geometries and those that have long been out of use. Call it when none is on its way to the screen.
    void startFrame();
    void resizeGLObjectBuffers(unsigned int size);
    /// Releases the objects of the twins alone, not those of the shared arrays.
    void releaseGLObjects(osg::State* state) const;

private:
    struct Entry
    {
        osg::observer_ptr<osg::Geometry> geometry;
        GeometryStamp stamp;
        osg::ref_ptr<osg::Geometry> twin; ///< null where there is none
        unsigned int idle = 0;            ///< frames without use
    };
    static osg::ref_ptr<osg::Geometry> make(osg::Geometry& geometry);

    std::unordered_map<const osg::Geometry*, Entry> _entries;
};

} // namespace osgGeoFX
