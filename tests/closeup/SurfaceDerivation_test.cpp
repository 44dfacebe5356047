// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is derived from heights, on surfaces of which mathematics knows the answer and against a plain search for the
// horizon.
#include <osgGeoFX/closeup/SurfaceData.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>
#include <tools/SurfaceLayers.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

namespace
{

using geofx::test::hasTexel;
using geofx::test::layerImage;
using geofx::test::none;
using geofx::test::NotifyWatch;
using geofx::test::Random;
using geofx::test::Texel;
using geofx::test::texelAt;
using geofx::test::texelOf;
using geofx::test::valueAt;
using osgGeoFX::SurfaceData;

/// Metres at a place in metres; NaN for holes.
using Ground = std::function<double(double x, double y)>;

/// What stands in holes, to show where it bleeds.
constexpr float rubbish = 1e4f;

/// Texel (0, 0) at the place (0, 0).
osg::ref_ptr<osg::Image> heightsOf(int width, int height, const osg::Vec2d& spacing, const Ground& ground)
{
    osg::ref_ptr<osg::Image> image = layerImage(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            const double z = ground(x * spacing.x(), y * spacing.y());
            float* texel = texelOf(*image, x, y);
            texel[0] = std::isnan(z) ? rubbish : static_cast<float>(z);
            texel[3] = std::isnan(z) ? 0.0f : 1.0f;
        }
    return image;
}

/// Holes in one of ten texels, the same ones each time.
Ground withHoles(const Ground& ground, const osg::Vec2d& spacing)
{
    return [=](double x, double y)
    {
        const auto texel =
            static_cast<std::uint64_t>(std::lround(x / spacing.x()) + 1000 * std::lround(y / spacing.y()));
        return Random(texel).integer(0, 9) == 0 ? none : ground(x, y);
    };
}

/// The share of the sky above horizons whose tangent, in each of the 16 directions, is given (0 and more).
double skyAbove(const std::function<double(double angle)>& tangent)
{
    double sum = 0.0;
    for (int i = 0; i < 16; ++i)
    {
        const double t = std::max(0.0, tangent(osg::PI * i / 8.0));
        sum += 1.0 / (1.0 + t * t);
    }
    return sum / 16.0;
}

/** The horizon in a plain way: from every texel along the two lines beside it, every point of the lines within the radius.
    Written anew from the documentation, without hulls. */
class PlainOcclusion
{
public:
    PlainOcclusion(const osg::Image& heights, const osg::Vec2d& spacing, double radius)
        : _heights(heights), _spacing(spacing), _radius(radius)
    {
    }

    double at(int x, int y) const
    {
        double sum = 0.0;
        int count = 0;
        for (int i = 0; i < 16; ++i)
        {
            const double hidden = hiddenIn(osg::PI * i / 8.0, x, y);
            if (std::isnan(hidden)) continue;
            sum += hidden;
            ++count;
        }
        return 1.0 - sum / count;
    }

private:
    double hiddenIn(double angle, int x, int y) const
    {
        double right = std::cos(angle) / _spacing.x();
        double up = std::sin(angle) / _spacing.y();
        const bool steep = std::abs(up) > std::abs(right) * (1.0 + 1e-9);
        const int major = steep ? y : x;
        const int minor = steep ? x : y;
        if (steep) std::swap(right, up);
        const int forth = right > 0.0 ? 1 : -1;
        const double gradient = up / right;
        const double step = 1.0 / std::abs(right);
        if (step > _radius * (1.0 + 1e-9)) return 0.0;
        const double base = std::floor(gradient * major + 1e-6);
        double sum = 0.0, weights = 0.0;
        for (const int line : {0, 1})
        {
            const double share = gradient * major - base;
            const double weight = line == 0 ? 1.0 - share : share;
            if (weight < 2e-6) continue;
            const double first = minor - line - base;
            const auto height = [&](int place)
            {
                return heightOn(steep, place, first + gradient * place);
            };
            const double from = height(major);
            if (std::isnan(from)) continue;
            double steepest = 0.0;
            for (int i = 1; i * step <= _radius * (1.0 + 1e-9); ++i)
            {
                const double to = height(major + forth * i);
                if (!std::isnan(to)) steepest = std::max(steepest, (to - from) / (i * step));
            }
            sum += weight * steepest * steepest / (1.0 + steepest * steepest);
            weights += weight;
        }
        return weights > 0.0 ? sum / weights : none;
    }

    double heightOn(bool steep, int major, double minor) const
    {
        const double low = std::floor(minor + 1e-6);
        const double share = minor - low;
        const auto height = [&](int place)
        {
            const int x = steep ? place : major;
            const int y = steep ? major : place;
            const bool inside = x >= 0 && y >= 0 && x < _heights.s() && y < _heights.t();
            return inside && hasTexel(_heights, x, y) ? valueAt(_heights, x, y) : none;
        };
        const double below = height(static_cast<int>(low));
        if (share < 1e-6) return below;
        return (1.0 - share) * below + share * height(static_cast<int>(low) + 1);
    }

    const osg::Image& _heights;
    osg::Vec2d _spacing;
    double _radius;
};

/// Texels of different sides, a plane that is known, and holes.
class SurfaceDataPlanes : public testing::TestWithParam<int>
{
};

TEST_P(SurfaceDataPlanes, HaveTheirSlopeAspectAndNormalEverywhere)
{
    Random random(static_cast<std::uint64_t>(GetParam()));
    const osg::Vec2d spacing(random.logarithmic(1.0, 100.0), random.logarithmic(1.0, 100.0));
    const double steepness = random.logarithmic(0.01, 3.0);
    const double down = random.uniform(0.0, 2.0 * osg::PI); // clockwise from north
    const Ground plane = [&](double x, double y)
    {
        return -steepness * (std::sin(down) * x + std::cos(down) * y);
    };
    const osg::ref_ptr<osg::Image> heights = heightsOf(24, 17, spacing, withHoles(plane, spacing));
    const osg::ref_ptr<osg::Image> slopes = SurfaceData::derive(SurfaceData::SLOPE, *heights, spacing);
    const osg::ref_ptr<osg::Image> aspects = SurfaceData::derive(SurfaceData::ASPECT, *heights, spacing);
    const osg::ref_ptr<osg::Image> normals = SurfaceData::derive(SurfaceData::NORMAL, *heights, spacing);
    const osg::Vec3d normal =
        osg::Vec3d(steepness * std::sin(down), steepness * std::cos(down), 1.0) / std::hypot(steepness, 1.0);
    // Floats of a height that is many times that of a step.
    const double tolerance = 1e-3;
    int holes = 0;
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 24; ++x)
        {
            SCOPED_TRACE(testing::Message() << x << " " << y);
            if (!hasTexel(*heights, x, y))
            {
                ++holes;
                for (const auto& image : {slopes, aspects, normals})
                    EXPECT_EQ(texelAt(*image, x, y), Texel());
                continue;
            }
            EXPECT_NEAR(valueAt(*slopes, x, y), std::atan(steepness), tolerance);
            EXPECT_EQ(texelAt(*slopes, x, y)[3], 1.0f);
            const Texel aspect = texelAt(*aspects, x, y);
            EXPECT_NEAR(std::remainder(static_cast<double>(aspect[0]) - down, 2.0 * osg::PI), 0.0, tolerance);
            EXPECT_GE(aspect[0], 0.0f);
            EXPECT_NEAR(static_cast<double>(aspect[1]), std::sin(down), tolerance);
            EXPECT_NEAR(static_cast<double>(aspect[2]), std::cos(down), tolerance);
            EXPECT_EQ(aspect[3], 1.0f);
            const Texel n = texelAt(*normals, x, y);
            EXPECT_LT((osg::Vec3d(osg::Vec3f(n[0], n[1], n[2])) - normal).length(), tolerance);
            EXPECT_EQ(n[3], 1.0f);
        }
    EXPECT_GT(holes, 10);
}

TEST_P(SurfaceDataPlanes, AreHiddenByThemselvesOnly)
{
    Random random(static_cast<std::uint64_t>(GetParam()));
    const osg::Vec2d spacing(random.uniform(5.0, 10.0), random.uniform(5.0, 10.0));
    const double east = random.uniform(-1.0, 1.0), north = random.uniform(-1.0, 1.0);
    const Ground plane = [&](double x, double y)
    {
        return east * x + north * y;
    };
    const osg::ref_ptr<osg::Image> heights = heightsOf(50, 50, spacing, withHoles(plane, spacing));
    const osg::ref_ptr<osg::Image> sky =
        SurfaceData::derive(SurfaceData::OCCLUSION, *heights, spacing, random.uniform(90.0, 300.0));
    const double expected =
        skyAbove([&](double angle) { return east * std::cos(angle) + north * std::sin(angle); });
    int count = 0;
    for (int y = 20; y < 30; ++y)
        for (int x = 20; x < 30; ++x)
        {
            if (!hasTexel(*heights, x, y))
            {
                EXPECT_EQ(texelAt(*sky, x, y), Texel());
                continue;
            }
            // Between two holes some directions are left out.
            const bool beside = hasTexel(*heights, x - 1, y) || hasTexel(*heights, x + 1, y);
            const bool above = hasTexel(*heights, x, y - 1) || hasTexel(*heights, x, y + 1);
            if (!beside || !above) continue;
            ++count;
            EXPECT_NEAR(valueAt(*sky, x, y), expected, 1e-4) << x << " " << y;
        }
    EXPECT_GT(count, 60);
}

TEST_P(SurfaceDataPlanes, OfAnyShapeAreHiddenAsAPlainSearchSays)
{
    Random random(static_cast<std::uint64_t>(GetParam()));
    const osg::Vec2d spacing(random.uniform(5.0, 20.0), random.uniform(5.0, 20.0));
    const int width = random.integer(1, 40), height = random.integer(1, 40);
    const double radius = random.logarithmic(5.0, 1000.0);
    const Ground rough = [&](double x, double y)
    {
        return Random(static_cast<std::uint64_t>(std::lround(7.0 * x + 1234.0 * y))).uniform(0.0, 30.0) +
               100.0 * std::sin(x / 60.0) * std::cos(y / 50.0);
    };
    const osg::ref_ptr<osg::Image> heights = heightsOf(width, height, spacing, withHoles(rough, spacing));
    const osg::ref_ptr<osg::Image> sky =
        SurfaceData::derive(SurfaceData::OCCLUSION, *heights, spacing, radius);
    const PlainOcclusion plain(*heights, spacing, radius);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            if (!hasTexel(*heights, x, y)) continue;
            EXPECT_NEAR(valueAt(*sky, x, y), plain.at(x, y), 1e-4)
                << x << " " << y << " of " << width << " " << height << ", radius " << radius;
        }
}

INSTANTIATE_TEST_SUITE_P(Samples, SurfaceDataPlanes, testing::Range(0, geofx::test::fullTest() ? 400 : 24));

TEST(SurfaceDataDerived, DomeAndConeSlopeOutwards)
{
    const osg::Vec2d spacing(10.0, 15.0);
    const osg::Vec2d middle(200.0, 300.0);
    // Central differences give a parabola's slope back exactly.
    const osg::ref_ptr<osg::Image> dome =
        heightsOf(41, 41, spacing,
                  [&](double x, double y) { return 500.0 - (osg::Vec2d(x, y) - middle).length2() / 400.0; });
    const osg::ref_ptr<osg::Image> cone =
        heightsOf(41, 41, spacing,
                  [&](double x, double y) { return 500.0 - 0.5 * (osg::Vec2d(x, y) - middle).length(); });
    const osg::ref_ptr<osg::Image> domeSlope = SurfaceData::derive(SurfaceData::SLOPE, *dome, spacing);
    const osg::ref_ptr<osg::Image> coneSlope = SurfaceData::derive(SurfaceData::SLOPE, *cone, spacing);
    const osg::ref_ptr<osg::Image> domeAspect = SurfaceData::derive(SurfaceData::ASPECT, *dome, spacing);
    const osg::ref_ptr<osg::Image> coneAspect = SurfaceData::derive(SurfaceData::ASPECT, *cone, spacing);
    const osg::ref_ptr<osg::Image> sky = SurfaceData::derive(SurfaceData::OCCLUSION, *dome, spacing);
    for (int y = 1; y < 40; ++y)
        for (int x = 1; x < 40; ++x)
        {
            SCOPED_TRACE(testing::Message() << x << " " << y);
            const osg::Vec2d out = osg::Vec2d(x * spacing.x(), y * spacing.y()) - middle;
            EXPECT_NEAR(valueAt(*domeSlope, x, y), std::atan(out.length() / 200.0), 1e-4);
            if (out.length() < 50.0) continue;
            const double aspect = std::atan2(out.x(), out.y());
            EXPECT_NEAR(std::remainder(valueAt(*domeAspect, x, y) - aspect, 2.0 * osg::PI), 0.0, 1e-3);
            EXPECT_NEAR(std::remainder(valueAt(*coneAspect, x, y) - aspect, 2.0 * osg::PI), 0.0, 0.03);
            EXPECT_NEAR(valueAt(*coneSlope, x, y), std::atan(0.5), 0.01);
        }
    EXPECT_EQ(texelAt(*domeAspect, 20, 20), Texel()) << "the top is level";
    EXPECT_EQ(texelAt(*domeSlope, 20, 20), (Texel{0.0f, 0.0f, 0.0f, 1.0f}));
    EXPECT_NEAR(valueAt(*sky, 20, 20), 1.0, 1e-4) << "from the top all of the sky is seen";
}

TEST(SurfaceDataDerived, LevelGroundHasNoAspectAndAllOfTheSky)
{
    const osg::Vec2d spacing(30.0, 30.0);
    const osg::ref_ptr<osg::Image> flat = heightsOf(20, 20, spacing, [](double, double) { return 812.3; });
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x)
        {
            EXPECT_EQ(texelAt(*SurfaceData::derive(SurfaceData::ASPECT, *flat, spacing), x, y), Texel());
            EXPECT_EQ(texelAt(*SurfaceData::derive(SurfaceData::OCCLUSION, *flat, spacing), x, y),
                      (Texel{1.0f, 0.0f, 0.0f, 1.0f}));
        }
}

TEST(SurfaceDataDerived, AtTheBottomOfAFunnelTheSkyIsAsWideAsItsWallsAreSteep)
{
    const osg::Vec2d spacing(5.0, 5.0);
    for (const double steepness : {0.2, 1.0, 4.0})
    {
        const osg::ref_ptr<osg::Image> funnel =
            heightsOf(101, 101, spacing,
                      [&](double x, double y) { return steepness * std::hypot(x - 250.0, y - 250.0); });
        const osg::ref_ptr<osg::Image> sky = SurfaceData::derive(SurfaceData::OCCLUSION, *funnel, spacing);
        EXPECT_NEAR(valueAt(*sky, 50, 50), 1.0 / (1.0 + steepness * steepness), 0.01) << steepness;
    }
}

TEST(SurfaceDataDerived, WhatIsBeyondTheRadiusHidesNothing)
{
    const osg::Vec2d spacing(10.0, 10.0);
    const osg::ref_ptr<osg::Image> wall =
        heightsOf(200, 9, spacing, [](double x, double) { return x > 1495.0 && x < 1505.0 ? 300.0 : 0.0; });
    for (const double radius : {0.0, 9.0, 100.0, 340.0, 1500.0})
    {
        const osg::ref_ptr<osg::Image> sky =
            SurfaceData::derive(SurfaceData::OCCLUSION, *wall, spacing, radius);
        for (int x = 0; x < 200; ++x)
        {
            if (x == 150) continue;
            if (std::abs(x - 150) * 10.0 <= radius)
                EXPECT_LT(valueAt(*sky, x, 4), 0.999) << x << " " << radius;
            else
                EXPECT_EQ(valueAt(*sky, x, 4), 1.0) << x << " " << radius;
        }
    }
}

TEST(SurfaceDataDerived, IsAddedFromTheFirstHeights)
{
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    ASSERT_TRUE(data->setRectangle(osg::Vec2d(0.0, 0.0), osg::Vec2d(200.0, 100.0)));
    const osg::ref_ptr<osg::Image> heights =
        heightsOf(20, 20, osg::Vec2d(10.0, 5.0), [](double x, double) { return x; });
    ASSERT_TRUE(data->addLayer("picture", SurfaceData::COLOR, layerImage(20, 20)));
    ASSERT_TRUE(data->addLayer("height", SurfaceData::HEIGHT, heights));
    ASSERT_TRUE(data->addDerived("slope", SurfaceData::SLOPE));
    EXPECT_EQ(data->getLayerKind(2), SurfaceData::SLOPE);
    EXPECT_NEAR(valueAt(*data->getLayerImage(2), 7, 7), osg::PI_4, 1e-5);
    ASSERT_TRUE(data->addDerived("sky", SurfaceData::OCCLUSION, 0.0));
    EXPECT_EQ(valueAt(*data->getLayerImage(3), 7, 7), 1.0);
}

TEST(SurfaceDataDerived, FromAnythingElseIsRefused)
{
    NotifyWatch watch;
    const osg::Vec2d spacing(10.0, 10.0);
    const osg::ref_ptr<osg::Image> good = layerImage(4, 4);
    const auto refuses =
        [&](SurfaceData::Kind kind, const osg::Image& image, const osg::Vec2d& step, double radius)
    {
        osg::ref_ptr<osg::Image> result;
        return watch.messagesOf([&] { result = SurfaceData::derive(kind, image, step, radius); }).size() ==
                   1 &&
               !result;
    };
    for (const auto kind : {SurfaceData::COLOR, SurfaceData::HEIGHT, SurfaceData::CLASS, SurfaceData::VALUE})
        EXPECT_TRUE(refuses(kind, *good, spacing, 100.0)) << kind;
    EXPECT_TRUE(refuses(SurfaceData::SLOPE, *layerImage(4, 4, GL_RED), spacing, 100.0));
    const osg::ref_ptr<osg::Image> empty = new osg::Image;
    EXPECT_TRUE(refuses(SurfaceData::SLOPE, *empty, spacing, 100.0));
    for (const double bad : {0.0, -1.0, none, std::numeric_limits<double>::infinity()})
    {
        EXPECT_TRUE(refuses(SurfaceData::SLOPE, *good, osg::Vec2d(bad, 10.0), 100.0));
        EXPECT_TRUE(refuses(SurfaceData::SLOPE, *good, osg::Vec2d(10.0, bad), 100.0));
    }
    EXPECT_TRUE(refuses(SurfaceData::OCCLUSION, *good, spacing, -1.0));
    EXPECT_TRUE(refuses(SurfaceData::OCCLUSION, *good, spacing, none));
    EXPECT_TRUE(
        SurfaceData::derive(SurfaceData::OCCLUSION, *good, spacing, std::numeric_limits<double>::infinity()));
}

} // namespace
