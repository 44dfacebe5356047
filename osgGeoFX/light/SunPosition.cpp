// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/SunPosition.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

const double turn = 2.0 * osg::PI;
constexpr double secondsOfDay = 86400.0;
constexpr double daysFrom1970To2000 = 10957.5; ///< noon of January 1st, from where the almanac counts

} // namespace

SunPosition sunPosition(double longitude, double latitude, double time)
{
    const double days = time / secondsOfDay - daysFrom1970To2000;
    const double meanLongitude = osg::DegreesToRadians(280.460 + 0.9856474 * days);
    const double anomaly = osg::DegreesToRadians(357.528 + 0.9856003 * days);
    const double ecliptic = meanLongitude + osg::DegreesToRadians(1.915) * std::sin(anomaly) +
                            osg::DegreesToRadians(0.020) * std::sin(2.0 * anomaly);
    const double obliquity = osg::DegreesToRadians(23.439 - 0.0000004 * days);
    const double rightAscension = std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
    const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic));
    const double siderealTime =
        osg::DegreesToRadians(std::fmod(280.46061837 + 360.98564736629 * days, 360.0));
    const double hour = siderealTime + longitude - rightAscension;

    const double up = std::sin(latitude) * std::sin(declination) +
                      std::cos(latitude) * std::cos(declination) * std::cos(hour);
    const double east = -std::cos(declination) * std::sin(hour);
    const double north = std::cos(latitude) * std::sin(declination) -
                         std::sin(latitude) * std::cos(declination) * std::cos(hour);
    const double azimuth = std::atan2(east, north);
    return {azimuth < 0.0 ? azimuth + turn : azimuth, std::asin(std::clamp(up, -1.0, 1.0))};
}

} // namespace osgGeoFX
