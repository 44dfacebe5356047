// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The styles of bent views (shaders/lib/bendstyle.glsl).
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

using namespace osgGeoFX::glsl;
using namespace geofx::test;

namespace
{

constexpr geofx_BendStyle plain = {1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0};

double greyOf(const Rgb& color)
{
    return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
}

void expectColor(const Rgb& actual, const Rgb& expected)
{
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(actual[channel], expected[channel], 1e-9);
}

} // namespace

TEST(BendStyle, ChangesNothingUnlessAsked)
{
    for (int i = 0; i < 200; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const Rgb color(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
        for (const bool building : {false, true})
            expectColor(
                geofx_bendRestyle(plain, color, Rgba(0.1, 0.9, 0.3, 1.0), building, random.uniform(0, 1)),
                color);
    }
}

TEST(BendStyle, SeveralAtOnce)
{
    const Rgb color(0.7, 0.4, 0.2);
    const Rgba map(0.2, 0.6, 0.9, 1.0);
    geofx_BendStyle style = {0.0, 0.5, 1.5, 0.8, 1.0, 0.0, 0.0};
    // The context: the map, grey, half as bright. The focus: its own color, more of it, a little darker.
    const double grey = greyOf({0.2, 0.6, 0.9});
    expectColor(geofx_bendRestyle(style, color, map, false, 1.0), Rgb(0.5 * grey));
    const double own = greyOf(color);
    expectColor(geofx_bendRestyle(style, color, map, false, 0.0), 0.8 * (own + 1.5 * (color - own)));
    // The reverse.
    style.mapInFocus = 1.0;
    expectColor(geofx_bendRestyle(style, color, map, false, 1.0), Rgb(0.5 * own));
    expectColor(geofx_bendRestyle(style, color, map, false, 0.0),
                0.8 * (grey + 1.5 * (Rgb(0.2, 0.6, 0.9) - grey)));
    // What has no map keeps its color there.
    expectColor(geofx_bendRestyle(style, color, Rgba(0.0), false, 0.0), 0.8 * (own + 1.5 * (color - own)));
}

TEST(BendStyle, ChangesWithoutAStep)
{
    for (int i = 0; i < 200; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const auto any = [&]
        {
            return random.uniform(0.0, 2.0);
        };
        const geofx_BendStyle style = {
            any(), any(), any(), any(), 1.0, double(random.integer(0, 1)), random.uniform(0, 1)};
        const Rgb color(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
        const Rgba map(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1), 1.0);
        const bool building = random.integer(0, 1) != 0;
        Rgb last = geofx_bendRestyle(style, color, map, building, 0.0);
        for (int step = 1; step <= 1000; ++step)
        {
            const Rgb next = geofx_bendRestyle(style, color, map, building, step / 1000.0);
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_LT(std::abs(next[channel] - last[channel]), 0.02);
            last = next;
        }
    }
}

TEST(BendStyle, BuildingsBecomeBlocksInTheContextAndOnTheMap)
{
    const Rgb windows(0.2, 0.25, 0.3);
    const Rgba bare(0.8, 0.8, 0.8, 1.0);
    geofx_BendStyle style = plain;
    style.blocks = 1.0;
    expectColor(geofx_bendRestyle(style, windows, bare, true, 0.0), windows);
    expectColor(geofx_bendRestyle(style, windows, bare, true, 1.0),
                (0.7 + 0.36 * 0.8) * Rgb(0.93, 0.87, 0.78));
    expectColor(geofx_bendRestyle(style, windows, bare, false, 1.0), windows);
    style.blocks = 0.0;
    style.map = 1.0;
    style.mapInFocus = 1.0;
    expectColor(geofx_bendRestyle(style, windows, bare, true, 0.0),
                (0.7 + 0.36 * 0.8) * Rgb(0.93, 0.87, 0.78));
    expectColor(geofx_bendRestyle(style, windows, bare, true, 1.0), windows);
}

TEST(BendStyle, TheMapShowsWaterWoodsAndTownsInTheirLight)
{
    const Rgb light(0.8);
    const Rgb open = geofx_bendMap({0.0, 0.0, 0.0, -500.0}, 0.0, light);
    const Rgb wood = geofx_bendMap({0.9, 0.0, 0.0, -500.0}, 0.0, light);
    const Rgb town = geofx_bendMap({0.2, 0.6, 0.0, -500.0}, 0.0, light);
    const Rgb water = geofx_bendMap({0.9, 0.6, 0.5, 500.0}, 1.0, light);
    EXPECT_GT(wood.y, wood.x + 0.05) << "green";
    EXPECT_GT(water.z, water.x + 0.15) << "blue, whatever else is there";
    for (const Rgb& color : {open, wood, town, water})
    {
        EXPECT_GT(greyOf(color), 0.6) << "pale";
        EXPECT_LE(std::max({color.x, color.y, color.z}), 1.0);
    }
    EXPECT_LT(greyOf(town), greyOf(open));
    EXPECT_LT(greyOf(geofx_bendMap({0.0, 0.0, 0.0, -500.0}, 0.0, Rgb(0.2))), greyOf(open));
}
