// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sun's place against libnova, whose theory of the planets (VSOP87) is right to a hundredth of a second of arc.
#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/light/SunPosition.h>
#include <tools/RandomSamples.h>

#include <osg/Math>

#include <gtest/gtest.h>
#include <libnova/precession.h>
#include <libnova/solar.h>
#include <libnova/transform.h>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

osg::Vec3d direction(double azimuth, double elevation)
{
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
            std::sin(elevation)};
}

osg::Vec3d byLibnova(double longitude, double latitude, double time)
{
    const double day = time / 86400.0 + 2440587.5;
    ln_lnlat_posn place{osg::RadiansToDegrees(longitude), osg::RadiansToDegrees(latitude)};
    ln_equ_posn sun{};
    // In the time of dynamics, which is ahead of UTC by the seconds that the Earth turns slower.
    ln_get_solar_equ_coords(day + 69.0 / 86400.0, &sun);
    ln_equ_posn ofDate{}; // of that day's equinox, not of the year 2000's
    ln_get_equ_prec(&sun, day, &ofDate);
    ln_hrz_posn found{};
    ln_get_hrz_from_equ(&ofDate, &place, day, &found);
    // Its azimuths count from the south.
    return direction(osg::DegreesToRadians(found.az + 180.0), osg::DegreesToRadians(found.alt));
}

double seconds(const std::string& text)
{
    const auto time = readClockTime(text);
    EXPECT_TRUE(time) << text;
    return time ? time->time : 0.0;
}

} // namespace

TEST(SunPositionTest, IsThatOfALibraryOfAstronomers)
{
    Random random(1);
    const double first = seconds("1950-01-01T00:00:00Z"), last = seconds("2050-01-01T00:00:00Z");
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i)
    {
        const double longitude = random.uniform(-osg::PI, osg::PI);
        const double latitude = std::asin(random.uniform(-1.0, 1.0));
        const double time = random.uniform(first, last);
        const SunPosition sun = sunPosition(longitude, latitude, time);
        EXPECT_GE(sun.azimuth, 0.0);
        EXPECT_LE(sun.azimuth, 2.0 * osg::PI);
        const osg::Vec3d difference =
            direction(sun.azimuth, sun.elevation) - byLibnova(longitude, latitude, time);
        worst = std::max(worst, difference.length());
    }
    EXPECT_LT(osg::RadiansToDegrees(worst), 0.02);
    EXPECT_GT(worst, 0.0);
}

TEST(SunPositionTest, StandsWhereAlmanacsSay)
{
    // Lahaina noon in Honolulu: the sun is in the zenith twice a year.
    const SunPosition zenith = sunPosition(osg::DegreesToRadians(-157.858), osg::DegreesToRadians(21.307),
                                           seconds("2026-05-26T12:28:00-10:00"));
    EXPECT_GT(osg::RadiansToDegrees(zenith.elevation), 89.5);
    // Midnight sun at the North Cape, and none in December.
    const double east = osg::DegreesToRadians(25.78), north = osg::DegreesToRadians(71.17);
    EXPECT_GT(sunPosition(east, north, seconds("2026-06-21T00:00:00+02:00")).elevation, 0.0);
    EXPECT_LT(sunPosition(east, north, seconds("2026-12-21T12:00:00+01:00")).elevation, 0.0);
    // Mornings in the east, evenings in the west.
    EXPECT_NEAR(osg::RadiansToDegrees(sunPosition(0.0, 0.0, seconds("2026-03-20T07:00:00Z")).azimuth), 90.0,
                1.0);
    EXPECT_NEAR(osg::RadiansToDegrees(sunPosition(0.0, 0.0, seconds("2026-03-20T17:00:00Z")).azimuth), 270.0,
                1.0);
}

TEST(SunLightTest, ShinesFromWhereTheSunStands)
{
    const double longitude = osg::DegreesToRadians(-157.86), latitude = osg::DegreesToRadians(21.3);
    // A frame whose east is the world's z.
    const osg::Matrixd frame(0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 6, 7, 1);
    const osg::ref_ptr<SunLight> sun = new SunLight;
    sun->setPlace(longitude, latitude, frame);
    osg::Vec4 former(2.0f, 2.0f, 2.0f, 1.0f);
    // From noon to night the light comes from farther down, and is darker and redder.
    for (int minutes = 12 * 60 + 30; minutes < 20 * 60; minutes += 30)
    {
        char text[64];
        std::snprintf(text, sizeof text, "2026-03-20T%02d:%02d:00-10:00", minutes / 60, minutes % 60);
        sun->setTime(*readClockTime(text));
        const SunPosition there = sunPosition(longitude, latitude, seconds(text));
        const osg::Vec3d expected =
            osg::Matrixd::transform3x3(direction(there.azimuth, there.elevation), frame);
        const osg::Vec4 position = sun->getLight()->getPosition();
        EXPECT_EQ(position.w(), 0.0f);
        EXPECT_LT((osg::Vec3d(position.x(), position.y(), position.z()) - expected).length(), 1e-6);
        const osg::Vec4 color = sun->getLight()->getDiffuse();
        if (osg::RadiansToDegrees(there.elevation) < -1.0)
        {
            EXPECT_EQ(color.r() + color.g() + color.b(), 0.0f) << text;
            EXPECT_GT(sun->getLight()->getAmbient().b(), 0.0f);
            continue;
        }
        EXPECT_LE(color.r(), former.r()) << text;
        EXPECT_LE(color.b() * former.r(), former.b() * color.r() * 1.0001f) << text;
        former = color;
    }
    EXPECT_LT(former.b(), 0.5f * former.r());
    // In the zenith it has its own color.
    sun->setTime(*readClockTime("2026-05-26T12:28:00-10:00"));
    EXPECT_NEAR(sun->getLight()->getDiffuse().b(), sun->getColor().b(), 0.001f);
    EXPECT_NEAR(sun->getLight()->getAmbient().b(), sun->getAmbient().b(), 0.001f);
}

TEST(SunLightTest, CopiesHaveLightsOfTheirOwn)
{
    const osg::ref_ptr<SunLight> sun = new SunLight;
    const osg::ref_ptr<SunLight> copy = osg::clone(sun.get(), osg::CopyOp::SHALLOW_COPY);
    const osg::Vec4 before = sun->getLight()->getPosition();
    copy->setTime({sun->getTime().time + 7200.0, 0});
    EXPECT_EQ(sun->getLight()->getPosition(), before);
    EXPECT_NE(copy->getLight()->getPosition(), before);
    // Without a light there is nothing to move.
    copy->setLight(nullptr);
    copy->setTime({0.0, 0});
}
