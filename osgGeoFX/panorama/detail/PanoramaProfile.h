// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Vec2d>
#include <osg/Vec3d>

#include <array>
#include <vector>

namespace osgGeoFX
{

/// The distance where heights have faded and nothing shows any more, as a multiple of D2.
constexpr double endOfHeights = 1.25;

/// The curve through at most six points (distance, height), both shares of the horizon's, 0…1: they increase strictly in distance and
/// do not decrease in height. It has no points, and `first` is 0, if there are none.
glsl::geofx_Profile profileThrough(const std::vector<osg::Vec2d>& points);

/// Its six knots as uniforms take them: distance, height, slope.
std::array<osg::Vec3d, 6> knotsOf(const glsl::geofx_Profile& profile);

/// The largest derivatives of a curve's height between two distances.
struct ProfileRates
{
    double slope = 0.0, second = 0.0;
};
ProfileRates ratesOf(const glsl::geofx_Profile& profile, double from, double to);

} // namespace osgGeoFX
