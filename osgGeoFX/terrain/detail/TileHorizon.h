// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/TileKey.h>
#include <osgGeoFX/terrain/detail/TilingScheme.h>

#include <osg/ClusterCullingCallback>

namespace osgGeoFX
{

/** Leaves a tile of a whole Earth out where the Earth itself hides it, in every program that reads the database: OSG knows no
    horizon. The callback is OSG's own, in the world's frame.

    A sphere within all ground that is ever drawn stands for the Earth. From beyond the cone that touches it, nothing of the
    tile is seen, up to `maxHeight` above the ellipsoid, metres. Null for tiles so large that they are in sight from almost everywhere. */
osg::ref_ptr<osg::ClusterCullingCallback> createHorizonCulling(const TilingScheme& scheme, const TileKey& key,
                                                               double maxHeight);

} // namespace osgGeoFX
