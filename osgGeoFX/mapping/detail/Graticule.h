// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/LocalOrigin.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>
#include <osg/Vec4d>

#include <cmath>

namespace osgGeoFX
{

/// What shaders/stages/mappings.frag.glsl needs for lines of equal longitude and latitude, or of equal coordinates.
struct Graticule
{
    osg::Vec4d
        origin; ///< of the frame, degrees or metres: x and y, each as a number that a float has exactly, and the rest
    osg::Vec4d globe; ///< geofx_Graticule without its last; 0 on a plane
    double drift = 0.0;

    /// `ellipsoid`: null on a plane.
    Graticule(const LocalOrigin& place, const osg::EllipsoidModel* ellipsoid)
    {
        const double x = ellipsoid ? osg::RadiansToDegrees(place.longitude) : place.x;
        const double y = ellipsoid ? osg::RadiansToDegrees(place.latitude) : place.y;
        const double unit = ellipsoid ? 1.0 / 64.0 : 1.0;
        const auto round = [&](double number)
        {
            return unit * std::floor(number / unit + 0.5);
        };
        origin.set(round(x), x - round(x), round(y), y - round(y));
        if (!ellipsoid) return;
        const double a = ellipsoid->getRadiusEquator(), b = ellipsoid->getRadiusPolar();
        const double e2 = 1.0 - b * b / (a * a);
        const double s = std::sin(place.latitude), c = std::cos(place.latitude);
        const double w = 1.0 - e2 * s * s;
        const double normal = a / std::sqrt(w);
        globe.set(s, c, normal * c, normal * (1.0 - e2) / w);
        drift = 1.5 * e2 * s * c / w;
    }
    glsl::geofx_Graticule functions() const { return {globe.x(), globe.y(), globe.z(), globe.w(), drift}; }
};

} // namespace osgGeoFX
