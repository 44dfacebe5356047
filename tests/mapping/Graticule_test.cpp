// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Patterns as functions: degrees against GeographicLib, and how much of a pixel lines cover.
#include <osgGeoFX/mapping/detail/Graticule.h>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <gtest/gtest.h>

#include <cmath>

using namespace osgGeoFX;

TEST(Patterns, DegreesAreThoseOfGeographicLib)
{
    const osg::EllipsoidModel earth;
    for (const osg::Vec2d& origin :
         {osg::Vec2d(-157.9, 21.4), osg::Vec2d(8.0, 46.5), osg::Vec2d(179.9, -70.0), osg::Vec2d(0.0, 0.0)})
    {
        const Graticule graticule(
            LocalOrigin::onGlobe(osg::DegreesToRadians(origin.x()), osg::DegreesToRadians(origin.y())),
            &earth);
        const GeographicLib::LocalCartesian frame(origin.y(), origin.x(), 0.0);
        for (const double reach : {0.01, 0.3, 2.0, 10.0})
        {
            for (int i = 0; i < 40; ++i)
            {
                const osg::Vec2d off(reach * std::cos(0.5 * i), reach * std::sin(0.7 * i));
                osg::Vec3d at;
                frame.Forward(origin.y() + off.y(), origin.x() + off.x(), 250.0 * (i % 5), at.x(), at.y(),
                              at.z());
                const glm::dvec2 found = glsl::geofx_degrees(graticule.functions(), {at.x(), at.y(), at.z()});
                EXPECT_NEAR(found.x, off.x(), 1e-9 * reach) << reach;
                // The third order of the meridian's curve is left out.
                EXPECT_NEAR(found.y, off.y(), 1e-9 + 4e-6 * std::pow(reach, 3.0)) << reach;
            }
        }
        // Both parts of the origin are the origin.
        EXPECT_NEAR(graticule.origin.x() + graticule.origin.y(), origin.x(), 1e-12);
        EXPECT_EQ(static_cast<double>(static_cast<float>(graticule.origin.x())), graticule.origin.x());
        EXPECT_LE(std::abs(graticule.origin.w()), 1.0 / 128.0);
    }
    const Graticule plane(LocalOrigin::onPlane({604000.25, 2366000.0}), nullptr);
    EXPECT_EQ(plane.globe, osg::Vec4d());
    EXPECT_EQ(plane.origin, osg::Vec4d(604000.0, 0.25, 2366000.0, 0.0));
}

TEST(Patterns, LinesCoverWhatTheirWidthSays)
{
    // Over ten lines of three pixels each, twenty pixels apart, pixel by pixel.
    double sum = 0.0;
    for (int pixel = 0; pixel < 200; ++pixel)
        sum += glsl::geofx_isolines(0.05 * (pixel + 0.5), 0.03, -0.04, 1.0, 3.0, 0.0);
    EXPECT_NEAR(sum, 30.0, 1e-6);
    // Half a pixel is half as dark.
    EXPECT_NEAR(glsl::geofx_isolines(7.0, 0.05, 0.0, 1.0, 0.5, 0.0), 0.5, 1e-12);
    // Each fifth one is twice as wide.
    sum = 0.0;
    for (int pixel = 0; pixel < 200; ++pixel)
        sum += glsl::geofx_isolines(0.05 * (pixel + 0.5), 0.05, 0.0, 1.0, 3.0, 5.0);
    EXPECT_NEAR(sum, 8.0 * 3.0 + 2.0 * 6.0, 1e-6);
    // Too close together they are none; the wider ones stay.
    EXPECT_EQ(glsl::geofx_isolines(7.0, 0.5, 0.0, 1.0, 1.0, 0.0), 0.0);
    EXPECT_EQ(glsl::geofx_isolines(10.0, 0.5, 0.0, 1.0, 1.0, 10.0), 1.0);
    EXPECT_EQ(glsl::geofx_isolines(0.0, 0.0, 0.0, 1.0, 1.0, 0.0), 0.0) << "level ground";
    // A disc's area, seen under a slant.
    sum = 0.0;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x)
            sum += glsl::geofx_dots({0.3 * (x - 50) + 0.1 * (y - 50), 0.2 * (y - 50) + 0.01}, {0.3, 0.0},
                                    {0.1, 0.2}, 100.0, 20.0);
    EXPECT_NEAR(sum, osg::PI * 100.0, 2.0);
}
