// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

namespace osgGeoFX
{

/** Where the sun's middle stands in the sky of a place, without what the air bends.
    @ingroup light */
struct SunPosition
{
    double azimuth = 0.0;   ///< radians clockwise from true north, from 0 to 2π
    double elevation = 0.0; ///< radians above the horizon, from -π/2 to π/2
};

/** The sun's position by the low-precision formulas of the Astronomical Almanac (as in: Michalsky, The Astronomical
    Almanac's algorithm for approximate solar position, Solar Energy 40, 1988): right within 0.02° from 1950 to 2050.

    `longitude` and `latitude` in radians, east and north positive. `time` in seconds since 1970-01-01T00:00:00Z, without
    leap seconds. Any thread may call it. */
OSGGEOFX_EXPORT SunPosition sunPosition(double longitude, double latitude, double time);

} // namespace osgGeoFX
