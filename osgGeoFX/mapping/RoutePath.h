// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/RouteMapping.h>

#include <osg/Vec2d>
#include <osg/Vec3d>
#include <osg/Vec4>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A way as files have it: a route, a track or a line. A plain value.
/// @ingroup mapping
struct OSGGEOFX_EXPORT RoutePath
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

    /// The places' longitudes and latitudes, degrees, with more of them on great circles where two are farther apart than so many metres.
    std::vector<osg::Vec2d> alongGreatCircles(double longest = 20000.0) const;

    /// How showOn() draws a way.
    struct Look
    {
        double width =
            0.0; ///< of the line without its outline, metres; 0: a 120th of the way's extent, 8 m at least
        int order = 0; ///< RouteMapping's
        /// Enlarged so that the line has the width. The way's own color goes before its color. By default the surroundings keep
        /// their colors.
        RouteMapping::Style style = plainStyle();
    };
    /// The look of RouteMapping without a darkened context.
    static RouteMapping::Style plainStyle();
    /** Draws the way on the ground, as RouteMapping does; its mappings stay in the effect, named after the way. `places`: the way in the effect's
        frame, metres. Way points get marks, the points of tracks none; these are simplified to an eighth of the width. False, with
        a warning, if a place or the look is out of range, or if there are more than 20000 way points. */
    bool showOn(ProjectiveMappings& effect, const std::vector<osg::Vec2d>& places, const Look& look) const;
};

} // namespace osgGeoFX
