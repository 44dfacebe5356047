// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The painting's functions (shaders/lib/painting.glsl), in double and in float.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace osgGeoFX;
using geofx::test::Random;
using geofx::test::sampleCount;
using Rgb = glsl::Rgb;

namespace
{

constexpr double pi = 3.14159265358979323846;

Rgb randomColor(Random& random)
{
    return {random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)};
}

/// As an image keeps it.
Rgb rounded(const Rgb& color)
{
    return glm::round(color * 255.0) / 255.0;
}

double valueOf(const Rgb& color)
{
    return std::max(color.x, std::max(color.y, color.z));
}

/// Between two hues, the shorter way around.
double hueDistance(double a, double b)
{
    const double d = std::abs(a - b - std::floor(a - b));
    return std::min(d, 1.0 - d);
}

glsl::geofx_PaintStyle alps()
{
    glsl::geofx_PaintStyle style;
    style.snowLine = 2900.0;
    style.winterDrop = 2000.0;
    style.snowWidth = 400.0;
    style.cliffSlope = 0.9;
    style.hillSlope = 0.2;
    style.season = 0.5;
    return style;
}

glsl::geofx_Cover meadow()
{
    glsl::geofx_Cover cover;
    cover.trees = 0.0;
    cover.town = 0.0;
    cover.bare = 0.0;
    cover.shore = -1000.0;
    return cover;
}

double sum(const glsl::geofx_Classes& c)
{
    return c.field + c.hill + c.cliff + c.snow + c.forest + c.town + c.bare;
}

double least(const glsl::geofx_Classes& c)
{
    return std::min({c.field, c.hill, c.cliff, c.snow, c.forest, c.town, c.bare});
}

double change(const glsl::geofx_Classes& a, const glsl::geofx_Classes& b)
{
    return std::max({std::abs(a.field - b.field), std::abs(a.hill - b.hill), std::abs(a.cliff - b.cliff),
                     std::abs(a.snow - b.snow), std::abs(a.forest - b.forest), std::abs(a.town - b.town),
                     std::abs(a.bare - b.bare)});
}

struct Ground
{
    glsl::geofx_Cover cover;
    double height;
    double steepness;
    double noise;
};

Ground randomGround(Random& random)
{
    Ground ground{meadow(), random.uniform(-100.0, 6000.0), random.logarithmic(0.001, 20.0),
                  random.uniform(-1.0, 1.0)};
    ground.cover.trees = random.uniform(0.0, 1.0);
    ground.cover.town = random.uniform(0.0, 1.0);
    ground.cover.bare = random.uniform(0.0, 1.0);
    return ground;
}

glsl::geofx_Classes classesOf(const Ground& ground, const glsl::geofx_PaintStyle& style)
{
    return glsl::geofx_classify(ground.cover, ground.height, ground.steepness, ground.noise, style);
}

} // namespace

TEST(Painting, HsvAndBack)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(sample);
        const Rgb color = randomColor(random);
        const glsl::Vector3 hsv = glsl::geofx_toHsv(color);
        for (int i = 0; i < 3; ++i)
        {
            ASSERT_GE(hsv[i], 0.0);
            ASSERT_LE(hsv[i], 1.0);
        }
        ASSERT_LT(glm::distance(glsl::geofx_fromHsv(hsv), color), 1e-12) << "sample " << sample;
        ASSERT_LT(glm::distance(glslf::geofx_fromHsv(glslf::geofx_toHsv(color)), glslf::Rgb(color)), 2e-6f);
        ASSERT_LT(glm::distance(glsl::geofx_fromHsv(hsv + glsl::Vector3(random.integer(-3, 3), 0, 0)), color),
                  1e-12);
    }
    EXPECT_EQ(glsl::geofx_toHsv(Rgb(0, 0, 0)), glsl::Vector3(0, 0, 0));
    EXPECT_EQ(glsl::geofx_toHsv(Rgb(0.4, 0.4, 0.4)), glsl::Vector3(0, 0, 0.4));
    EXPECT_EQ(glsl::geofx_toHsv(Rgb(1, 0, 0)), glsl::Vector3(0, 1, 1));
    EXPECT_EQ(glsl::geofx_toHsv(Rgb(0, 0.5, 0)), glsl::Vector3(1.0 / 3, 1, 0.5));
    EXPECT_EQ(glsl::geofx_toHsv(Rgb(0, 0, 1)), glsl::Vector3(2.0 / 3, 1, 1));
    EXPECT_NEAR(glsl::geofx_toHsv(Rgb(1, 0, 0.5)).x, 11.0 / 12, 1e-12);
}

TEST(Painting, EasingHasNoCorners)
{
    EXPECT_EQ(glsl::geofx_ease(2.0, 2.0, 4.0), 0.0);
    EXPECT_EQ(glsl::geofx_ease(3.0, 2.0, 4.0), 0.5);
    EXPECT_EQ(glsl::geofx_ease(4.0, 2.0, 4.0), 1.0);
    EXPECT_LT(glsl::geofx_ease(2.002, 2.0, 4.0), 1e-5);
    EXPECT_GT(glsl::geofx_ease(3.998, 2.0, 4.0), 1.0 - 1e-5);
}

TEST(Painting, ClassesShareTheGround)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(sample);
        glsl::geofx_PaintStyle style = alps();
        style.season = random.uniform(0.0, 1.0);
        const Ground ground = randomGround(random);
        const glsl::geofx_Classes classes = classesOf(ground, style);
        ASSERT_NEAR(sum(classes), 1.0, 1e-12) << "sample " << sample;
        ASSERT_GE(least(classes), 0.0) << "sample " << sample;

        // No argument makes a jump: a thousandth of its range changes no share by more than 1.5 %.
        Ground near = ground;
        near.cover.trees = std::min(ground.cover.trees + 0.001, 1.0);
        ASSERT_LT(change(classes, classesOf(near, style)), 0.015);
        near = ground;
        near.cover.bare = std::min(ground.cover.bare + 0.001, 1.0);
        ASSERT_LT(change(classes, classesOf(near, style)), 0.015);
        near = ground;
        near.cover.town = std::min(ground.cover.town + 0.001, 1.0);
        ASSERT_LT(change(classes, classesOf(near, style)), 0.015);
        near = ground;
        near.height += 1.0;
        ASSERT_LT(change(classes, classesOf(near, style)), 0.015);
        near = ground;
        near.steepness += 0.001;
        ASSERT_LT(change(classes, classesOf(near, style)), 0.015);
        near = ground;
        near.noise += 0.002;
        ASSERT_LT(change(classes, classesOf(near, style)), 0.015);
        glsl::geofx_PaintStyle later = style;
        later.season += 0.0001;
        ASSERT_LT(change(classes, classesOf(ground, later)), 0.015);
    }
}

TEST(Painting, PureGroundIsOfOneClass)
{
    for (const double noise : {-1.0, 0.0, 1.0})
    {
        const glsl::geofx_PaintStyle style = alps();
        const auto classify = [&](const glsl::geofx_Cover& cover, double height, double steepness)
        {
            return glsl::geofx_classify(cover, height, steepness, noise, style);
        };
        glsl::geofx_Cover cover = meadow();
        EXPECT_NEAR(classify(cover, 500.0, 0.0).field, 1.0, 1e-12);
        EXPECT_NEAR(classify(cover, 500.0, 0.45).hill, 1.0, 1e-12);
        EXPECT_NEAR(classify(cover, 500.0, 2.0).cliff, 1.0, 1e-12);
        EXPECT_NEAR(classify(cover, 3500.0, 0.2).snow, 1.0, 1e-12);
        // Too steep for snow.
        EXPECT_NEAR(classify(cover, 3500.0, 2.5).cliff, 1.0, 1e-12);
        cover.trees = 1.0;
        EXPECT_NEAR(classify(cover, 500.0, 0.3).forest, 1.0, 1e-12);
        EXPECT_NEAR(classify(cover, 500.0, 0.85).forest, 1.0, 1e-12) << "woods hold on to slopes";
        cover = meadow();
        cover.town = 1.0;
        EXPECT_NEAR(classify(cover, 500.0, 0.1).town, 1.0, 1e-12);
        cover = meadow();
        cover.bare = 0.5;
        EXPECT_NEAR(classify(cover, 500.0, 0.1).bare, 1.0, 1e-12);
        cover.bare = 1.0;
        EXPECT_NEAR(classify(cover, 500.0, 0.1).snow, 1.0, 1e-12) << "ice stays in midsummer";
        EXPECT_NEAR(classify(cover, 500.0, 2.5).snow, 1.0, 1e-12) << "also on cliffs";
    }
}

TEST(Painting, SnowGrowsWithHeightAndTowardsWinter)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(sample);
        Ground ground = randomGround(random);
        glsl::geofx_PaintStyle style = alps();
        style.season = random.uniform(0.0, 0.5);
        const double snow = classesOf(ground, style).snow;
        Ground higher = ground;
        higher.height += random.uniform(0.0, 500.0);
        ASSERT_GE(classesOf(higher, style).snow, snow) << "sample " << sample;
        Ground steeper = ground;
        steeper.steepness *= random.uniform(1.0, 2.0);
        ASSERT_LE(classesOf(steeper, style).snow, snow) << "sample " << sample;
        glsl::geofx_PaintStyle colder = style;
        colder.season *= random.uniform(0.0, 1.0);
        ASSERT_GE(classesOf(ground, colder).snow, snow) << "sample " << sample;
        glsl::geofx_PaintStyle autumn = style;
        autumn.season = 1.0 - style.season;
        ASSERT_NEAR(classesOf(ground, autumn).snow, snow, 1e-9) << "the year is symmetric";
    }
    glsl::geofx_PaintStyle style = alps();
    EXPECT_DOUBLE_EQ(glsl::geofx_snowLineNow(style), 2900.0);
    style.season = 0.0;
    EXPECT_DOUBLE_EQ(glsl::geofx_snowLineNow(style), 900.0);
    style.season = 0.25;
    EXPECT_NEAR(glsl::geofx_snowLineNow(style), 1900.0, 1e-9);
}

TEST(Painting, SnowComesInOverItsWidth)
{
    for (const double width : {100.0, 500.0, 2000.0})
    {
        glsl::geofx_PaintStyle style = alps();
        style.snowWidth = width;
        const auto snowAt = [&](double height)
        {
            glsl::geofx_Cover cover{};
            cover.shore = -1000.0;
            return glsl::geofx_classify(cover, height, 0.1, 0.0, style).snow;
        };
        // In midsummer the Alps' line lies 2900 m high: half of the even ground is white there.
        EXPECT_NEAR(snowAt(2900.0), 0.5, 1e-9);
        EXPECT_EQ(snowAt(2900.0 - 0.5 * width), 0.0);
        EXPECT_GT(snowAt(2900.0 - 0.45 * width), 0.0);
        EXPECT_LT(snowAt(2900.0 + 0.45 * width), 1.0);
        EXPECT_EQ(snowAt(2900.0 + 0.5 * width), 1.0);
    }
}

TEST(Painting, SnowLinesOfTheWorld)
{
    EXPECT_NEAR(glsl::geofx_snowLine(0.0), 5000.0, 1e-9);
    EXPECT_NEAR(glsl::geofx_snowLine(46.0 * pi / 180.0), 2900.0, 50.0);
    EXPECT_NEAR(glsl::geofx_snowLine(-pi / 2), 0.0, 1e-3);
    EXPECT_GT(glsl::geofx_snowLine(35.36 * pi / 180.0), 3500.0)
        << "Mount Fuji, 3776 m, is all but bare in summer";
    EXPECT_NEAR(glsl::geofx_winterDrop(0.0), 0.0, 1e-9);
    EXPECT_NEAR(glsl::geofx_winterDrop(46.0 * pi / 180.0), 2070.0, 10.0);
    EXPECT_EQ(glsl::geofx_snowLine(0.7), glsl::geofx_snowLine(-0.7));
}

TEST(Painting, LightFallsTowardsTheBottom)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(sample);
        const double lambert = random.uniform(-1.0, 1.0);
        const double y = random.uniform(0.0, 1.0);
        const double shade = random.uniform(0.0, 2.0);
        const double light = glsl::geofx_paintLight(lambert, y, shade);
        ASSERT_GE(light, -1.0);
        ASSERT_LE(light, lambert + 1e-12);
        ASSERT_LE(light, glsl::geofx_paintLight(lambert, y + random.uniform(0.0, 1.0), shade) + 1e-12);
        if (y >= 0.25)
        {
            ASSERT_NEAR(light, lambert, 1e-12);
        }
    }
    EXPECT_NEAR(glsl::geofx_paintLight(0.5, 0.0, 0.3), 0.2, 1e-12);
    EXPECT_NEAR(glsl::geofx_paintLight(0.5, glsl::GEOFX_BOTTOM_SHARE / 2, 0.3), 0.35, 1e-12);
}

TEST(Painting, PalettePlacesAreTexelsMiddles)
{
    const glsl::Vector2 dark = glsl::geofx_palettePlace(-1.0, glsl::GEOFX_PALETTE_FIELD);
    EXPECT_NEAR(dark.x, 0.5 / 256, 1e-12);
    EXPECT_NEAR(dark.y, 0.5 / 8, 1e-12);
    const glsl::Vector2 bright = glsl::geofx_palettePlace(1.0, glsl::GEOFX_PALETTE_BARE);
    EXPECT_NEAR(bright.x, 255.5 / 256, 1e-12);
    EXPECT_NEAR(bright.y, 7.5 / 8, 1e-12);
    EXPECT_NEAR(glsl::geofx_palettePlace(0.0, 3).x, 0.5, 1e-12);
}

TEST(Painting, WaterIsPaleAtTheShoreAndDeepFarOff)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(sample);
        const double deepShore = random.logarithmic(10.0, 1e5);
        const double shore = random.uniform(-0.5, 1.5) * deepShore;
        const double t = glsl::geofx_waterDepth(shore, deepShore);
        ASSERT_GE(t, -1e-12);
        ASSERT_LE(t, 1.0 + 1e-12);
        ASSERT_GE(glsl::geofx_waterDepth(shore + random.uniform(0.0, 1.0) * deepShore, deepShore), t - 1e-12);
        const Rgb deep = randomColor(random);
        const glsl::Vector3 own = glsl::geofx_toHsv(deep);
        const glsl::Vector3 shown = glsl::geofx_toHsv(glsl::geofx_waterColor(deep, t));
        ASSERT_LE(shown.y, own.y + 1e-9);
        ASSERT_GE(shown.z, own.z - 1e-9);
        if (t > 0.01 && own.y > 0.01 && own.z > 0.01)
        {
            ASSERT_LT(hueDistance(shown.x, own.x), 1e-6);
        }
        ASSERT_LT(glm::distance(glsl::geofx_waterColor(deep, 1.0), deep), 1e-12);
        ASSERT_LT(glm::distance(glsl::geofx_waterColor(deep, 0.0), Rgb(1, 1, 1)), 1e-12);
    }
    EXPECT_NEAR(glsl::geofx_waterDepth(0.0, 1000.0), 0.0, 1e-12);
    EXPECT_NEAR(glsl::geofx_waterDepth(-500.0, 1000.0), 0.0, 1e-12);
    EXPECT_NEAR(glsl::geofx_waterDepth(1000.0, 1000.0), 1.0, 1e-12);
    // A sigmoid: more of the water is nearly white or nearly deep than linearly.
    EXPECT_LT(glsl::geofx_waterDepth(50.0, 1000.0), 0.07);
    EXPECT_GT(glsl::geofx_waterDepth(220.0, 1000.0), 0.4);
    EXPECT_GT(glsl::geofx_waterDepth(600.0, 1000.0), 0.95);
}

TEST(Painting, ReflectionsLendTheirHue)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(sample);
        const Rgb own = randomColor(random);
        const Rgb seen = randomColor(random);
        const glsl::Vector3 a = glsl::geofx_toHsv(own);
        const glsl::Vector3 b = glsl::geofx_toHsv(seen);
        const glsl::Vector3 both = glsl::geofx_toHsv(glsl::geofx_waterMix(own, seen, 1.0));
        ASSERT_NEAR(both.y, std::min(a.y, b.y), 1e-9);
        ASSERT_NEAR(both.z, 0.5 * (a.z + b.z), 1e-9);
        if (both.y * both.z > 1e-3)
        {
            ASSERT_LT(hueDistance(both.x, b.x), 1e-6);
        }
        ASSERT_LT(glm::distance(glsl::geofx_waterMix(own, seen, 0.0), own), 1e-12);
        const double strength = random.uniform(0.0, 1.0);
        ASSERT_LT(glm::distance(glsl::geofx_waterMix(own, seen, strength),
                                glm::mix(own, glsl::geofx_waterMix(own, seen, 1.0), strength)),
                  1e-12);
    }
}

TEST(Painting, AirKeepsTheValueOfWhatIsLightAndLiftsTheDark)
{
    double most = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(sample);
        const Rgb color = rounded(randomColor(random));
        const Rgb air = rounded(randomColor(random));
        const double amount = random.uniform(0.0, 1.0);
        const Rgb far = glsl::geofx_atmosphere(color, air, amount);
        // Up to 60 % of the way to 85 % of the air's value, and never down.
        const double lifted =
            valueOf(color) + 0.6 * amount * std::max(0.85 * valueOf(air) - valueOf(color), 0.0);
        most = std::max(most, std::abs(valueOf(rounded(far)) - lifted));
        // Light and shade stay in their order.
        const Rgb darker = color * random.uniform(0.0, 1.0);
        ASSERT_LE(valueOf(glsl::geofx_atmosphere(darker, air, amount)), valueOf(far) + 1e-12);
        for (int i = 0; i < 3; ++i)
        {
            ASSERT_GE(far[i], 0.0);
            ASSERT_LE(far[i], 1.0);
        }
        ASSERT_LT(glm::distance(glsl::geofx_atmosphere(color, air, 0.0), color), 1e-12);
        const glsl::Vector3 all = glsl::geofx_toHsv(glsl::geofx_atmosphere(color, air, 1.0));
        const glsl::Vector3 its = glsl::geofx_toHsv(air);
        if (its.y * its.z > 0.01 && valueOf(color) > 0.01)
        {
            ASSERT_LT(hueDistance(all.x, its.x), 1e-6);
        }
        const glslf::Rgb single =
            glslf::geofx_atmosphere(glslf::Rgb(color), glslf::Rgb(air), static_cast<float>(amount));
        ASSERT_LT(glm::distance(glsl::Rgb(single), far), 1e-5);
    }
    EXPECT_LT(most, 1.0 / 255) << "not a level, also in an image";
    EXPECT_EQ(glsl::geofx_atmosphere(Rgb(0, 0, 0), Rgb(0, 0, 0), 0.5), Rgb(0, 0, 0));
    EXPECT_EQ(glsl::geofx_atmosphere(Rgb(0, 0, 0), Rgb(0.5, 0.6, 0.9), 0.0), Rgb(0, 0, 0));
    const Rgb shade = glsl::geofx_atmosphere(Rgb(0.15, 0.12, 0.3), glsl::geofx_airColor(), 0.8);
    EXPECT_GT(valueOf(shade), 0.45) << "a far shade is blue, not black";
    EXPECT_GT(shade.z, shade.x);

    EXPECT_EQ(glsl::geofx_airAmount(-1.0, 0.7), 0.0);
    EXPECT_EQ(glsl::geofx_airAmount(0.0, 0.7), 0.0);
    EXPECT_EQ(glsl::geofx_airAmount(1.0, 0.7), 0.7);
    EXPECT_EQ(glsl::geofx_airAmount(9.0, 0.7), 0.7);
    EXPECT_NEAR(glsl::geofx_airAmount(0.5, 0.8), 0.2, 1e-12);
}

TEST(Painting, NothingSpreadsThatIsNotANumber)
{
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    constexpr double endless = std::numeric_limits<double>::infinity();
    const double odd[] = {none, endless, -endless, 0.0, 1e30, -1e30, 1e-30, 1.0};
    const auto pick = [&](int& digits)
    {
        const double value = odd[digits % 8];
        digits /= 8;
        return value;
    };
    for (int combination = 0; combination < 8 * 8 * 8 * 8 * 8 * 8; ++combination)
    {
        int digits = combination;
        glsl::geofx_Cover cover = meadow();
        cover.trees = pick(digits);
        cover.town = pick(digits);
        cover.bare = pick(digits);
        const double height = pick(digits);
        const double steepness = pick(digits);
        const double noise = pick(digits);
        const glsl::geofx_Classes classes = glsl::geofx_classify(cover, height, steepness, noise, alps());
        ASSERT_NEAR(sum(classes), 1.0, 1e-9) << combination;
        ASSERT_GE(least(classes), 0.0) << combination;
    }
    for (const double a : odd)
    {
        for (const double b : odd)
        {
            for (const double c : {none, 0.0, 0.3, endless})
            {
                const double light = glsl::geofx_paintLight(a, b, c);
                ASSERT_TRUE(light >= -1.0 && light <= 1.0) << a << " " << b << " " << c;
            }
            const double t = glsl::geofx_waterDepth(a, b);
            ASSERT_TRUE(t >= -1e-12 && t <= 1.0 + 1e-12) << a << " " << b;
            ASSERT_TRUE(std::isfinite(glsl::geofx_palettePlace(a, 0).x));
            ASSERT_TRUE(std::isfinite(glsl::geofx_airAmount(a, 0.5)));
            const double eased = glsl::geofx_ease(a, b, 1.0);
            ASSERT_TRUE(eased >= 0.0 && eased <= 1.0) << a << " " << b;
        }
    }
    glsl::geofx_PaintStyle flat = alps();
    flat.snowWidth = flat.cliffSlope = flat.hillSlope = 0.0;
    EXPECT_NEAR(sum(glsl::geofx_classify(meadow(), 0.0, 0.0, 0.0, flat)), 1.0, 1e-12);
}
