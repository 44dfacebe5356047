// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/CoordinateSystemNode>

#include <optional>

namespace geofx::test
{

/** Terrain for tests of panorama maps: hills of up to 1500 m, 80 × 80 km, with woods, a town and a lake around a place, as
    a tile of osggeofx_build has them. The place is longitude 0.4 and this latitude, radians, or the origin of a projected
    terrain. */
struct PanoramaHills
{
    std::optional<double> latitude;

    osg::ref_ptr<osg::CoordinateSystemNode> terrain() const;
    /// The place, at height 0.
    osg::Vec3d middle() const;
};

} // namespace geofx::test
