// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The close-ups' functions (shaders/lib/closeup.glsl), in double and in float.
#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Matrixd>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using geofx::test::Random;
using geofx::test::sampleCount;
using glsl::Position;
using glsl::Rgb;
using glsl::Vector2;

namespace
{

Vector2 randomPlace(Random& random, double reach)
{
    return {random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

Rgb randomColor(Random& random)
{
    return {random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)};
}

double luma(const Rgb& color)
{
    return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
}

} // namespace

TEST(CloseUpShaders, LiftIsAMatrix)
{
    const int count = sampleCount();
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        // OSG's vectors stand on the left; the last column is that of a picture with or without perspective.
        osg::Matrixd matrix = osg::Matrixd::scale(random.uniform(0.5, 4.0), random.uniform(0.5, 4.0), 1.0) *
                              osg::Matrixd::rotate(random.uniform(-3.0, 3.0), osg::Vec3d(0.2, 0.3, 0.9)) *
                              osg::Matrixd::translate(random.uniform(-1e3, 1e3), 50.0, -5e3);
        if (random.integer(0, 1)) matrix(2, 3) = -1e-4;
        const auto row = [&](int k)
        {
            return glsl::Row(matrix(0, k), matrix(1, k), matrix(2, k), matrix(3, k));
        };
        const glsl::geofx_Lift lift{row(0), row(1), row(2), row(3)};
        const osg::Vec3d at(random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3), random.uniform(-9e3, -1e3));
        const osg::Vec3d wanted = at * matrix;
        const Position found = glsl::geofx_lift(lift, Position(at.x(), at.y(), at.z()));
        EXPECT_LT(glm::length(found - Position(wanted.x(), wanted.y(), wanted.z())), 1e-8);

        const double mask = random.uniform(0.0, 1.0);
        const Position ground(at.x() + 10.0, at.y(), at.z());
        const Position raised = glsl::geofx_raise(ground, found, mask);
        EXPECT_LT(glm::length(raised - (mask * found + (1.0 - mask) * ground)), 1e-8);
        EXPECT_EQ(glsl::geofx_raise(ground, found, 0.0), ground);
    }
}

TEST(CloseUpShaders, MasksAreReadBetweenTexelsAsRegionsReadThem)
{
    const osg::ref_ptr<RegionOfInterest> region = new RegionOfInterest;
    const int count = sampleCount();
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        if (i % 100 == 0)
        {
            region->setSize(random.logarithmic(500.0, 5000.0), random.logarithmic(500.0, 5000.0));
            region->setShape(static_cast<RegionOfInterest::Shape>(random.integer(0, 4)));
            region->setSoftness(random.integer(0, 1) ? 0.3 : 0.0);
            region->setMaskSide(random.integer(16, 64));
        }
        const osg::ref_ptr<const osg::Image> picture = region->mask();
        const Vector2 place = randomPlace(random, 1.0);
        const Vector2 texel = glsl::geofx_maskTexel(place, picture->s());
        const Vector2 low = glm::floor(texel);
        const auto value = [&](double dx, double dy)
        {
            const int last = picture->s() - 1;
            const auto* at = reinterpret_cast<const float*>(
                picture->data(std::clamp(static_cast<int>(low.x + dx), 0, last),
                              std::clamp(static_cast<int>(low.y + dy), 0, last)));
            return Vector2(static_cast<double>(at[0]), static_cast<double>(at[1]));
        };
        const Vector2 between =
            glsl::geofx_between(value(0, 0), value(1, 0), value(0, 1), value(1, 1), texel - low);
        const double smaller = std::min(region->getWidth(), region->getDepth());
        const double border = glsl::geofx_border(
            between.y, place, picture->s(), {region->getWidth() / smaller, region->getDepth() / smaller});
        const osg::Vec2d wanted = region->maskAt({place.x, place.y});
        EXPECT_NEAR(between.x, wanted.x(), 1e-9);
        EXPECT_NEAR(border, wanted.y(), 1e-9);
    }
}

TEST(CloseUpShaders, BordersGoOnToTheEdgesOfTheirRegion)
{
    const int count = sampleCount();
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        const double side = random.integer(16, 1024);
        Vector2 half(random.logarithmic(1.0, 5.0), 1.0);
        if (random.integer(0, 1)) std::swap(half.x, half.y);
        // What the texels say that are nearest where the place is beyond the outermost of them.
        const Vector2 place = randomPlace(random, 1.2);
        const double outermost = 1.0 - 1.0 / side;
        const Vector2 nearest = glm::clamp(place, -outermost, outermost);
        const double wanted =
            std::min((1.0 - std::abs(place.x)) * half.x, (1.0 - std::abs(place.y)) * half.y);
        const double said = glsl::geofx_squareEdge(nearest, half);
        EXPECT_NEAR(glsl::geofx_squareEdge(place, half), wanted, 1e-12);
        EXPECT_NEAR(glsl::geofx_border(said, place, side, half), wanted, 1e-12) << "a rectangle's is exact";
        EXPECT_NEAR(glslf::geofx_border(static_cast<float>(said), glm::vec2(place), static_cast<float>(side),
                                        glm::vec2(half)),
                    wanted, 2e-6);
        // A disc touches the edge, and the border there is the disc's.
        const double along = 0.3 * random.uniform(-1.0, 1.0) / std::sqrt(side);
        const double down = random.uniform(outermost, 1.0);
        const double disc =
            glsl::geofx_border(1.0 - std::hypot(along, outermost), {along, down}, side, {1.0, 1.0});
        EXPECT_NEAR(disc, 1.0 - std::hypot(along, down), 0.1 / side);
        // What no texel doubts stays, and nothing beyond the region is inside.
        const double any = random.uniform(-1.0, said);
        EXPECT_TRUE(nearest != place || glsl::geofx_border(any, place, side, half) == any);
        EXPECT_LE(glsl::geofx_border(any, place, side, half), wanted + 1e-12);
    }
}

TEST(CloseUpShaders, CoverageIsOneHalfOnTheBorderAndAPixelWide)
{
    for (const double pixel : {1e-6, 0.004, 0.3})
    {
        EXPECT_EQ(glsl::geofx_coverage(0.0, pixel), 0.5);
        EXPECT_NEAR(glsl::geofx_coverage(0.25 * pixel, pixel), 0.75, 1e-12);
        EXPECT_EQ(glsl::geofx_coverage(0.51 * pixel, pixel), 1.0);
        EXPECT_EQ(glsl::geofx_coverage(-0.51 * pixel, pixel), 0.0);
    }
    EXPECT_EQ(glsl::geofx_coverage(1e-3, 0.0), 1.0);
    EXPECT_EQ(glsl::geofx_coverage(-1e-3, 0.0), 0.0);
}

TEST(CloseUpShaders, RestyledColors)
{
    const int count = sampleCount();
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        const Rgb color = randomColor(random);
        EXPECT_LT(glm::length(glsl::geofx_restyle(color, 1.0, 1.0, 0.0) - color), 1e-12);
        const Rgb grey = glsl::geofx_restyle(color, 0.0, 1.0, 0.0);
        EXPECT_NEAR(grey.r, luma(color), 1e-12);
        EXPECT_NEAR(grey.b, luma(color), 1e-12);
        const Rgb faded = glsl::geofx_restyle(color, random.uniform(0.0, 1.0), 1.0, 0.0);
        EXPECT_NEAR(luma(faded), luma(color), 1e-12) << "saturation changes no luma";
        const Rgb flat = glsl::geofx_restyle(color, 1.0, 0.0, 0.25);
        EXPECT_LT(glm::length(flat - Rgb(0.75)), 1e-12)
            << "contrast is about middle grey, brightness is added";
        const Rgb any = glsl::geofx_restyle(color, random.uniform(0.0, 4.0), random.uniform(0.0, 4.0),
                                            random.uniform(-1.0, 1.0));
        for (int channel = 0; channel < 3; ++channel)
        {
            EXPECT_GE(any[channel], 0.0);
            EXPECT_LE(any[channel], 1.0);
        }
    }
}

TEST(CloseUpShaders, SunlightIsLevelOnLevelGround)
{
    const Position up(0.0, 0.0, 1.0);
    for (const double height : {0.35, 0.8, 1.0})
    {
        const Position sun(std::sqrt(1.0 - height * height), 0.0, height);
        EXPECT_NEAR(glsl::geofx_sunlight(up, sun), 1.0, 1e-12);
        EXPECT_NEAR(glsl::geofx_sunlight(-sun, sun), 0.35, 1e-12)
            << "what looks away has the share of the sky";
        EXPECT_GT(glsl::geofx_sunlight(sun, sun), glsl::geofx_sunlight(up, sun) - 1e-12);
    }
    // A low sun does not make slopes glare.
    EXPECT_LE(glsl::geofx_sunlight({1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}), 0.35 + 0.65 / 0.3 + 1e-12);
}
