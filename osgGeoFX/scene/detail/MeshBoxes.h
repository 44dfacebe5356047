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

/** Smaller boxes within a drawable's box, a few along each side. Each box encloses the triangles whose middle lies in
    its cell.

    The box of a terrain tile is as high as its highest peak everywhere. Where this box crosses the border of the
    picture, the smaller boxes tell whether the terrain itself does. They are made on demand, and kept while the
    drawable lives. For one thread at a time. */
class MeshBoxes
{
public:
    using Boxes = std::vector<osg::BoundingBox>;

    struct Entry
    {
        osg::observer_ptr<const osg::Drawable> drawable;
        GeometryStamp stamp;
        Boxes boxes;
        std::size_t witness = 0; ///< the box that showed last time; the caller sets it
    };

    Entry& of(const osg::Drawable& drawable);
    /// The entry of a drawable. Null if there is none yet, or if it may be out of date.
    const Entry* find(const osg::Drawable& drawable) const;
    /// Forgets deleted drawables; call it now and then.
    void purge();

private:
    std::unordered_map<const osg::Drawable*, Entry> _entries;
};

} // namespace osgGeoFX
