// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/CoordinateSystemNode>

#include <cmath>

namespace osgGeoFX
{

/// Sets what shaders/lib/exaggeration.glsl needs of an ellipsoid, at a place whose geodetic latitude has this sine.
inline void setGlobe(glsl::geofx_Exaggeration& frame, const osg::EllipsoidModel& ellipsoid, double sine)
{
    const double a = ellipsoid.getRadiusEquator();
    const double b = ellipsoid.getRadiusPolar();
    // The support function: the distance of the tangent plane from the center, 1/|gradient| of the ellipsoid's
    // equation.
    const double support = std::sqrt(a * a * (1.0 - sine * sine) + b * b * sine * sine);
    frame.curvature = support / (a * a);
    frame.scale = 1.0 / support;
    frame.flattening = a * a / (b * b) - 1.0;
}

} // namespace osgGeoFX
