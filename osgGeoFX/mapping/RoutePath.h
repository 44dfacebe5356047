// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/RouteMapping.h>

#include <osg/Vec2d>
#include <osg/Vec3d>
#include <osg/Vec4>

#include <map>
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

    /// The places' longitudes and latitudes, degrees, with more of them on geodesics of WGS 84, the shortest ways, where two are farther apart than
    /// so many metres: evenly, within 1 m of GeographicLib's for up to 10 000 km. Between places that lie nearly opposite each other on the
    /// globe there are many such ways, and this takes one that is about as long.
    std::vector<osg::Vec2d> alongGeodesics(double longest = 20000.0) const;
    /// Between two places, degrees: metres on a sphere, within 1 % of the geodesic's length.
    static double distance(const osg::Vec2d& from, const osg::Vec2d& to);

    /// How showOn() draws a way.
    struct Look
    {
        /// Of the line without its outline, metres; 0: a 120th of the way's extent, or of the ground's if that is smaller, 8 m at least.
        double width = 0.0;
        double groundExtent = 0.0; ///< largest diameter of the ground that shows the way, metres; 0: unknown
        int order = 0;             ///< RouteMapping's
        /// Enlarged so that the line has the width. The way's own color goes before its color. By default the surroundings keep
        /// their colors.
        RouteMapping::Style style = plainStyle();
        /// Properties of the RouteMapping that go before all of these, not enlarged.
        std::map<std::string, double> properties;
    };
    /// The look of RouteMapping without a darkened context.
    static RouteMapping::Style plainStyle();
    /** Draws the way on the ground: adds a RouteMapping of the way's name to the effect, with the way as geographic way points (see
        RouteMapping::setGeographicWayPoints() for `ellipsoid` and `reference`). Way points get marks, the points of tracks none;
        these are simplified to an eighth of the width. False, with a sentence in `error`, if a place or the look is out of
        range, or if there are more than 20 000 way points. */
    bool showOn(ProjectiveMappings& effect, const osg::EllipsoidModel* ellipsoid,
                const Georeference* reference, const Look& look, std::string& error) const;
};

} // namespace osgGeoFX
