// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <osg/BoundingBox>
#include <osg/Drawable>
#include <osg/observer_ptr>

#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/** Smaller boxes within a drawable's: a few on each side, each around the triangles whose middle is in its cell.

    A terrain tile's box is as high as its highest peak everywhere. Where it crosses the border of the picture, the
    smaller ones tell whether the terrain does. Made when first asked for, and kept while the drawable lives. For one
    thread at a time. */
class MeshBoxes
{
public:
    using Boxes = std::vector<osg::BoundingBox>;

    struct Entry
    {
        osg::observer_ptr<const osg::Drawable> drawable;
        GeometryStamp stamp;
        Boxes boxes;
        std::size_t witness = 0; ///< a box that was in sight when last asked, for who asks to remember
    };

    Entry& of(const osg::Drawable& drawable);
    /// Null where it has not been made yet or may be out of date.
    const Entry* find(const osg::Drawable& drawable) const;
    /// Forgets what has been deleted; to be called now and then.
    void purge();

private:
    std::unordered_map<const osg::Drawable*, Entry> _entries;
};

} // namespace osgGeoFX
