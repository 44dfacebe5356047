// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec3d>
#include <osg/Vec4>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A way as files have it: a route, a track or a line. A plain value.
/// @ingroup mapping
struct RoutePath
{
    std::string name;
    /// Degrees of longitude and latitude, and metres of height; the height is 0 where `altitude` is CLAMPED.
    std::vector<osg::Vec3d> places;
    /// What heights count from.
    enum Altitude
    {
        CLAMPED,      ///< the way lies on the ground
        ABOVE_GROUND, ///< the ground
        ABSOLUTE      ///< the sea
    };
    Altitude altitude = CLAMPED;
    bool extruded = false; ///< a curtain goes down to the ground
    /// Whether the places are way points, which a person has chosen. Else they are what a receiver has written.
    bool wayPoints = false;
    std::optional<osg::Vec4> color; ///< the file's own, 0…1
};

} // namespace osgGeoFX
