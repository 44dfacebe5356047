// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The functions of shaders/lib/detail.glsl.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace osgGeoFX::glsl;
using namespace geofx::test;

namespace
{

geofx_Cover randomCover(Random& random)
{
    return {random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0),
            random.uniform(-500.0, 500.0)};
}

Rgb randomColor(Random& random)
{
    return {random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)};
}

std::array<double, 7> shares(const geofx_DetailClasses& of)
{
    return {of.grass, of.forest, of.rock, of.sand, of.snow, of.town, of.paved};
}

double total(const Rgba& weights)
{
    return weights.x + weights.y + weights.z + weights.w;
}

Rgba bilinear(double x, double y)
{
    return {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
}

} // namespace

TEST(DetailFunctions, NoWaveIsShownThatAPixelCannotShow)
{
    for (const double pixel : {0.01, 1.0, 700.0})
    {
        EXPECT_EQ(geofx_detailFade(2.5 * pixel, pixel), 0.0);
        EXPECT_EQ(geofx_detailFade(6.0 * pixel, pixel), 1.0);
        double last = 0.0;
        for (double pixels = 1.0; pixels < 8.0; pixels += 0.01)
        {
            const double fade = geofx_detailFade(pixels * pixel, pixel);
            EXPECT_GE(fade, last);
            EXPECT_LT(fade - last, 0.01); // it comes slowly
            last = fade;
        }
    }
    EXPECT_EQ(geofx_detailFade(NAN, 1.0), 0.0) << "a hole in the data";
}

TEST(DetailFunctions, DetailBeginsWhereTexelsShow)
{
    // The builder shows finer tiles where a texel takes more than two pixels (BuildOptions::texelError).
    EXPECT_EQ(geofx_detailNearness(2.0), 0.0);
    EXPECT_GT(geofx_detailNearness(2.1), 0.0);
    EXPECT_EQ(geofx_detailNearness(5.0), 1.0);
    EXPECT_EQ(geofx_detailMissing(240.0, 30.0), 1.0);
    EXPECT_EQ(geofx_detailMissing(480.0, 30.0), 0.0);
}

TEST(DetailFunctions, EachWaveBelongsToTheBandsAsAWhole)
{
    for (double wavelength = 0.05; wavelength < 5000.0; wavelength *= 1.03)
    {
        const Vector3 bands = geofx_detailBands(wavelength);
        EXPECT_NEAR(bands.x + bands.y + bands.z, 1.0, 1e-12);
        EXPECT_GE(std::min({bands.x, bands.y, bands.z}), -1e-12) << wavelength;
    }
    EXPECT_EQ(geofx_detailBands(200.0).x, 1.0);
    EXPECT_EQ(geofx_detailBands(15.0).y, 1.0);
    EXPECT_EQ(geofx_detailBands(1.0).z, 1.0);
}

TEST(DetailFunctions, ClassesAreSharesOfOne)
{
    for (int i = 0; i < sampleCount(); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const geofx_DetailClasses classes =
            geofx_detailClasses(randomCover(random), randomColor(random), random.uniform(0.0, 3.0));
        double sum = 0.0;
        for (const double share : shares(classes))
        {
            EXPECT_GE(share, -1e-12) << i;
            sum += share;
        }
        EXPECT_NEAR(sum, 1.0, 1e-9) << i;
    }
}

// The colors of data/oahu/landcover.csv.
TEST(DetailFunctions, KnowsTheGroundByItsCoverAndItsColor)
{
    const auto of = [](geofx_Cover cover, int red, int green, int blue, double steepness = 0.05)
    {
        return geofx_detailClasses(cover, Rgb(red, green, blue) / 255.0, steepness);
    };
    EXPECT_GT(of({0.05, 0.0, 0.0, -500.0}, 162, 174, 112).grass, 0.9);
    EXPECT_GT(of({0.25, 0.0, 0.0, -500.0}, 136, 170, 100).grass, 0.9) << "a golf course";
    EXPECT_GT(of({0.55, 0.0, 0.0, -500.0}, 112, 138, 82).forest, 0.9) << "scrub";
    EXPECT_GT(of({0.0, 0.0, 0.5, -500.0}, 224, 210, 174).sand, 0.9);
    EXPECT_GT(of({0.0, 0.0, 0.5, -500.0}, 96, 90, 86, 0.8).rock, 0.9) << "lava on a slope";
    EXPECT_GT(of({0.2, 0.6, 0.0, -500.0}, 210, 200, 182).town, 0.9);
    EXPECT_GT(of({0.0, 0.0, 0.0, -500.0}, 114, 113, 114).paved, 0.9) << "a runway";
    EXPECT_GT(of({0.0, 0.3, 0.0, -500.0}, 214, 172, 112).paved, 0.9) << "a freeway";
    EXPECT_GT(of({0.05, 0.0, 0.0, -500.0}, 162, 174, 112, 3.0).rock, 0.9) << "a cliff";
    EXPECT_GT(of({0.0, 0.0, 1.0, -500.0}, 245, 248, 250).snow, 0.9);
}

// Detail may come and go: the mean of its factor over the ground is 1 for each class and channel.
TEST(DetailFunctions, NoColorChangesInTheMean)
{
    const std::array<geofx_Cover, 5> covers = {
        geofx_Cover{0.0, 0.0, 0.0, -500.0}, geofx_Cover{0.9, 0.0, 0.0, -500.0},
        geofx_Cover{0.0, 0.0, 0.5, -500.0}, geofx_Cover{0.2, 0.6, 0.0, -500.0},
        geofx_Cover{0.05, 1.0, 0.0, -500.0}};
    for (const geofx_Cover& cover : covers)
    {
        for (const double share : {0.3, 1.0})
        {
            Random random(7);
            Rgb sum(0.0);
            const int count = 20000;
            const geofx_DetailClasses classes = geofx_detailClasses(cover, Rgb(0.5, 0.56, 0.4), 0.1);
            for (int i = 0; i < count; ++i)
            {
                geofx_DetailWaves waves = geofx_detailCalm();
                for (double wavelength = 320.0; wavelength > 0.6; wavelength /= GEOFX_DETAIL_STEP)
                {
                    // As the noise has them, near enough: a sum of four even numbers.
                    double height = 0.0;
                    for (int j = 0; j < 4; ++j)
                        height += random.uniform(-0.5, 0.5);
                    height *= 0.33 / std::sqrt(4.0 / 12.0);
                    waves = geofx_detailWith(waves, share * geofx_detailBands(wavelength), height,
                                             random.uniform(-0.57, 0.57));
                }
                sum += geofx_detailFactor(classes, cover, waves, 1.0);
            }
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(sum[channel] / count, 1.0, 0.06)
                    << cover.trees << " " << cover.town << " " << share;
        }
    }
}

TEST(DetailFunctions, GardensAreTheirShareNearAndFar)
{
    for (const double green : {0.1, 0.46, 0.55, 0.9})
    {
        EXPECT_NEAR(geofx_detailGardens(green, geofx_detailCalm()), green, 1e-12);
        double sum = 0.0;
        Random random(3);
        for (int i = 0; i < 20000; ++i)
        {
            geofx_DetailWaves waves = geofx_detailCalm();
            double height = 0.0;
            for (int j = 0; j < 12; ++j)
                height += random.uniform(-0.5, 0.5);
            waves.soft.y = 0.52 * height;
            waves.shown.y = 2.0;
            sum += geofx_detailGardens(green, waves);
        }
        EXPECT_NEAR(sum / 20000, green, 0.04);
    }
}

TEST(DetailFunctions, WaterIsLightAtTheShoreAndAsItWasFarFromIt)
{
    const Rgb deep(0.15, 0.32, 0.48);
    const Rgb far = geofx_detailWater(deep, 2000.0, 1.0, geofx_detailCalm(), 1.0, 1.0);
    const Rgb near = geofx_detailWater(deep, 25.0, 1.0, geofx_detailCalm(), 1.0, 1.0);
    const Rgb lake = geofx_detailWater(deep, 25.0, 0.0, geofx_detailCalm(), 1.0, 1.0);
    for (int channel = 0; channel < 3; ++channel)
    {
        EXPECT_NEAR(far[channel], deep[channel], 1e-6);
        EXPECT_NEAR(lake[channel], deep[channel], 1e-6) << "a lake has no surf";
        EXPECT_GT(near[channel], deep[channel]);
    }
    geofx_DetailWaves waves = geofx_detailCalm();
    EXPECT_LT(geofx_detailWater(deep, 0.0, 1.0, waves, 1.0, 1.0).x, near.x + 0.1) << "foam from afar";
    waves.shown.y = 1.0;
    EXPECT_GT(geofx_detailWater(deep, 0.0, 1.0, waves, 1.0, 1.0).x, near.x + 0.2) << "foam";
}

TEST(DetailFunctions, TheBorderOfTwoClassesIsALine)
{
    const Rgb grass(0.64, 0.68, 0.44), wood(0.31, 0.43, 0.27);
    // The left two texels are of one class, and the right two of the other: the border runs through their middle.
    for (double x = 0.03; x < 1.0; x += 0.04)
    {
        for (double y = 0.02; y < 1.0; y += 0.08)
        {
            const Rgba weights = geofx_crispWeights(bilinear(x, y), grass, wood, grass, wood, 100.0);
            EXPECT_NEAR(total(weights), 1.0, 1e-9);
            EXPECT_NEAR(weights.x + weights.z, x < 0.5 ? 1.0 : 0.0, 1e-9) << x << " " << y;
        }
    }
    // A corner alone: the border is the line where its weight is a half, and no corner of a cell.
    EXPECT_NEAR(geofx_crispWeights(bilinear(0.8, 0.8), grass, grass, grass, wood, 100.0).w, 1.0, 1e-9);
    EXPECT_NEAR(geofx_crispWeights(bilinear(0.65, 0.65), grass, grass, grass, wood, 100.0).w, 0.0, 1e-9);
    // A diagonal: no staircase.
    const double across = geofx_crispWeights(bilinear(0.5, 0.49), grass, grass, grass, wood, 100.0).w;
    EXPECT_NEAR(across, 0.0, 1e-9);
}

TEST(DetailFunctions, TheBorderIsSmoothOverAPixel)
{
    const Rgb grass(0.64, 0.68, 0.44), wood(0.31, 0.43, 0.27);
    const double pixels = 20.0;
    double last = 1.0;
    int between = 0;
    for (double x = 0.3; x < 0.7; x += 0.25 / pixels)
    {
        const Rgba weights = geofx_crispWeights(bilinear(x, 0.5), grass, wood, grass, wood, pixels);
        const double share = weights.x + weights.z;
        EXPECT_LE(share, last + 1e-9);
        EXPECT_LT(last - share, 0.3) << "a quarter of a pixel";
        between += share > 0.02 && share < 0.98 ? 1 : 0;
        last = share;
    }
    EXPECT_GE(between, 3);
    EXPECT_LE(between, 6);
}

TEST(DetailFunctions, PhotosStayAsTheyAre)
{
    for (int i = 0; i < sampleCount(); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const Rgba smooth = bilinear(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
        const Rgb a = randomColor(random);
        const Rgb step(0.1, 0.02, -0.06);
        const Rgba weights = geofx_crispWeights(smooth, a, a + step, a + 2.0 * step, a + 3.0 * step,
                                                random.logarithmic(1.0, 100.0));
        EXPECT_NEAR(total(weights), 1.0, 1e-9);
        for (int corner = 0; corner < 4; ++corner)
            EXPECT_NEAR(weights[corner], smooth[corner], 1e-9);
        // Whatever the colors are, weights are none below 0.
        const Rgba any = geofx_crispWeights(smooth, a, randomColor(random), a, randomColor(random), 50.0);
        EXPECT_NEAR(total(any), 1.0, 1e-9);
        EXPECT_GE(std::min({any.x, any.y, any.z, any.w}), -1e-9);
    }
}
