// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the GPU draws lines by: widths, dashes and the hand's pressure.
#include <osgGeoFX/effect/GlslFunctions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;

TEST(LineFunctions, WidthsGoByTheDistanceBetweenTwoLimits)
{
    EXPECT_EQ(glsl::geofx_lineWidth(40.0, 0.5, 3.0, 0.05), 2.0);
    EXPECT_EQ(glsl::geofx_lineWidth(40.0, 0.5, 3.0, 1.0), 3.0);
    EXPECT_EQ(glsl::geofx_lineWidth(40.0, 0.5, 3.0, 1e-6), 0.5);
    EXPECT_EQ(glsl::geofx_lineWidth(0.0, 0.5, 3.0, 1e-6), 3.0) << "without a width on the ground";
    EXPECT_EQ(glsl::geofx_lineWidth(40.0, 9.0, 3.0, 1e-6), 3.0)
        << "the least width is larger than the greatest";
}

TEST(LineFunctions, DashesKeepTheirShareAndArePowersOfTwoOfWhatWasAskedFor)
{
    for (const double perMetre : {10.0, 1.0, 0.2, 0.013, 1e-4})
    {
        int drawn = 0, changes = 0;
        const int steps = 400000;
        const double length = 4000.0 / perMetre; // 4000 pixels
        double former = -1.0;
        for (int i = 0; i < steps; ++i)
        {
            const double dash = glsl::geofx_lineDash(length * i / steps, 90.0, 30.0, 6.0, perMetre);
            ASSERT_TRUE(dash == 0.0 || dash == 1.0);
            drawn += dash > 0.5 ? 1 : 0;
            changes += former >= 0.0 && dash != former ? 1 : 0;
            former = dash;
        }
        const double period = 2.0 * 4000.0 / std::max(changes, 1);
        if (changes > 20)
        {
            EXPECT_NEAR(static_cast<double>(drawn) / steps, 0.75, 0.03) << perMetre;
            EXPECT_GT(0.75 * period, 5.5) << "the shortest dash, pixels";
            const double doubled = std::log2(period / perMetre / 120.0);
            EXPECT_NEAR(doubled, std::round(doubled), 0.1) << perMetre;
        }
        if (perMetre * 90.0 < 6.0)
        {
            EXPECT_LT(0.75 * period, 13.0) << "no longer than needed";
        }
    }
    EXPECT_EQ(glsl::geofx_lineDash(17.0, 90.0, 0.0, 6.0, 1.0), 1.0);
    EXPECT_EQ(glsl::geofx_lineDash(17.0, 0.0, 30.0, 6.0, 1.0), 1.0);
}

TEST(LineFunctions, AHandsPressureIsOneInTheMeanAndNeverJumps)
{
    for (const double perMetre : {3.0, 0.2, 0.0137})
    {
        double sum = 0.0, low = 10.0, high = 0.0, former = 0.0;
        const int steps = 100000;
        for (int i = 0; i < steps; ++i)
        {
            const double pixel = 0.2 * i;
            const double pressure = glsl::geofx_linePressure(pixel / perMetre, 0.4, perMetre);
            if (i > 0)
            {
                EXPECT_LT(std::abs(pressure - former), 0.03);
            }
            former = pressure;
            sum += pressure;
            low = std::min(low, pressure);
            high = std::max(high, pressure);
        }
        EXPECT_NEAR(sum / steps, 1.0, 0.01);
        EXPECT_GT(low, 0.599);
        EXPECT_LT(high, 1.401);
        EXPECT_GT(high - low, 0.3);
    }
    // While the camera comes nearer.
    double former = glsl::geofx_linePressure(1234.0, 1.0, 0.01);
    for (double perMetre = 0.01; perMetre < 1.0; perMetre *= 1.001)
    {
        const double pressure = glsl::geofx_linePressure(1234.0, 1.0, perMetre);
        EXPECT_LT(std::abs(pressure - former), 0.01);
        former = pressure;
    }
    EXPECT_EQ(glsl::geofx_linePressure(1234.0, 0.0, 0.3), 1.0);
}
