// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/observer_ptr>

#include <unordered_map>

namespace osgGeoFX
{

/// The same triangles as patches, which tessellation asks for: geometries that share the arrays of what they copy. Made
/// when first asked for, and kept while the drawable lives. For one thread at a time.
class PatchCopies
{
public:
    /// Of a drawable that is made of triangles.
    osg::Geometry& of(const osg::Geometry& geometry);
    /// Forgets what has been deleted; to be called now and then, when nothing of it is on its way to the screen.
    void purge();

private:
    struct Entry
    {
        osg::observer_ptr<const osg::Geometry> geometry;
        unsigned int modified = 0;
        osg::ref_ptr<osg::Geometry> copy;
    };
    std::unordered_map<const osg::Geometry*, Entry> _entries;
};

} // namespace osgGeoFX
