// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Regions of interest: masks of images, when they are made, copies, refusals and frames.
#include <closeup/RegionSamples.h>
#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using geofx::test::areaOf;
using geofx::test::disc;
using geofx::test::greyImage;
using geofx::test::imageRegion;
using geofx::test::Line;
using geofx::test::makeRegion;
using geofx::test::NotifyWatch;
using geofx::test::Random;
using geofx::test::Region;
using geofx::test::texelOf;
using geofx::test::toSegment;
using osg::Vec2d;
using osg::Vec3d;
using osgGeoFX::Property;
using osgGeoFX::RegionOfInterest;

namespace
{

TEST(RegionOfInterest, AnImagesGreysAreTheMask)
{
    // As many texels: the greys themselves; from below to above.
    const auto slope = [](double x, double y)
    {
        return 0.5 + 0.3 * x + 0.2 * y;
    };
    for (const auto& [width, height] : {std::pair(64, 64), {37, 91}, {1000, 333}, {3001, 7}})
    {
        SCOPED_TRACE(width);
        const Region region = imageRegion(greyImage(width, height, slope));
        for (const Vec2d& place : {Vec2d(0, 0), Vec2d(0.5, -0.5), Vec2d(-0.6, 0.3), Vec2d(0.7, 0.6)})
            EXPECT_NEAR(region->maskAt(place).x(), slope(place.x(), place.y()), 0.004);
        // 0.3 x + 0.2 y = 0.
        for (const Vec2d& place : {Vec2d(0, 0), Vec2d(0.3, -0.2), Vec2d(-0.3, 0.2), Vec2d(0.1, 0.1)})
            EXPECT_NEAR(region->maskAt(place).y(), (0.3 * place.x() + 0.2 * place.y()) / std::hypot(0.3, 0.2),
                        0.02);
        const std::vector<Line> lines = region->contours(0.1);
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_NEAR(areaOf(lines), 2.0, 0.02);
    }
    const Region white = imageRegion(greyImage(1, 1, [](double, double) { return 1.0; }));
    EXPECT_EQ(white->maskAt({-1, 1}).x(), 1.0);
    EXPECT_NEAR(white->maskAt({0.5, 0}).y(), 0.5, 0.02);
    EXPECT_NEAR(areaOf(white->contours(0.1)), 4.0, 0.01);
    EXPECT_FALSE(white->isEmpty());
    const Region black = imageRegion(greyImage(1, 1, [](double, double) { return 0.0; }));
    EXPECT_EQ(black->maskAt({0, 0}), Vec2d(0.0, -2.0));
    EXPECT_TRUE(black->contours(0.1).empty());
    EXPECT_TRUE(black->isEmpty());
}

TEST(RegionOfInterest, AnImagesDistancesAreThoseOfItsBorder)
{
    for (const double radius : {0.1, 0.5, 0.9})
    {
        for (const int side : {64, 200})
        {
            // The picture's texels and the image's, fewer or more.
            for (const int texels : {side, 512, 100})
            {
                SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(texels));
                const Region region = imageRegion(greyImage(texels, texels, disc(radius, texels)), side);
                Random random(7);
                for (int i = 0; i < 500; ++i)
                {
                    // Between the centers of texels; beyond, the last ones stay.
                    const double last = 1.0 - 1.0 / side;
                    const Vec2d place(random.uniform(-last, last), random.uniform(-last, last));
                    EXPECT_NEAR(region->maskAt(place).y(), radius - place.length(), 0.2 * 2.0 / side);
                }
                EXPECT_NEAR(areaOf(region->contours(0.1)), osg::PI * radius * radius,
                            0.03 * osg::PI * radius);
            }
        }
    }
    // Of noise, brute force knows: no texel is nearer to one of the other kind than its distance says.
    Random random(3);
    const osg::ref_ptr<osg::Image> noise =
        greyImage(48, 48, [&](double, double) { return random.uniform(0, 1) < 0.02 ? 1.0 : 0.0; });
    const Region region = imageRegion(noise, 48, 3000, 1000);
    const osg::ref_ptr<const osg::Image> mask = region->mask();
    const Vec2d texel(2.0 * 3.0 / 48, 2.0 / 48);
    for (int i = 0; i < 48 * 48; ++i)
    {
        double least = 1e30;
        for (int k = 0; k < 48 * 48; ++k)
        {
            // The line around a single white texel runs half way to its four neighbours.
            if (*noise->data(k % 48, k / 48) < 128) continue;
            const int columns = i % 48 - k % 48;
            const int rows = i / 48 - k / 48;
            const Vec2d middle(texel.x() * columns, texel.y() * rows);
            const Vec2d u(texel.x() / 2, 0), v(0, texel.y() / 2);
            for (const auto& [a, b] : {std::pair(u, v), {v, -u}, {-u, -v}, {-v, u}})
                least = std::min(least, toSegment(middle, a, b));
        }
        const double found = texelOf(*mask, i % 48, i / 48).y();
        // Whites side by side have a line that runs farther out, by less than half a texel.
        if (found < 0.0)
        {
            EXPECT_LE(-found, std::min(least, 2.0) + 1e-5);
            EXPECT_GE(-found, std::min(least, 2.0) - texel.x() / 2);
        }
    }
}

TEST(RegionOfInterest, TexelsThatTouchAtACornerAreJoinedAsTheGreysBetweenThemSay)
{
    for (const auto& [high, low] : {std::pair(1.0, 0.4), {0.6, 0.0}})
    {
        const bool joined = high + low > 1.0;
        const auto pair = [high = high, low = low](double x, double y)
        {
            return std::max(std::abs(x), std::abs(y)) < 0.125 ? (x * y > 0 ? high : low) : 0.0;
        };
        const Region region = imageRegion(greyImage(16, 16, pair), 16);
        EXPECT_EQ(region->maskAt({0, 0}).x() > 0.5, joined);
        EXPECT_EQ(region->contours(0.1).size(), joined ? 1u : 2u);
    }
}

TEST(RegionOfInterest, AnImageMayHaveAnyFormat)
{
    // White whose alpha falls to the right; colors; one channel.
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const unsigned char alpha[] = {255, 255, 255, 255, 255, 255, 255, 0};
    std::copy(std::begin(alpha), std::end(alpha), image->data());
    const Region region = imageRegion(image);
    EXPECT_NEAR(region->maskAt({-0.75, 0}).x(), 1.0, 1e-6);
    EXPECT_NEAR(region->maskAt({0.75, 0}).x(), 0.0, 1e-6);
    EXPECT_NEAR(region->maskAt({0.0, 0.0}).x(), 0.5, 1e-6);
    const unsigned char colors[] = {0, 255, 0, 255, 0, 0, 255, 255};
    std::copy(std::begin(colors), std::end(colors), image->data());
    image->dirty();
    EXPECT_NEAR(region->maskAt({-0.75, 0}).x(), 0.7152, 1e-6);
    EXPECT_NEAR(region->maskAt({0.75, 0}).x(), 0.0722, 1e-6);
    osg::ref_ptr<osg::Image> red = new osg::Image;
    red->allocateImage(1, 1, 1, GL_RED, GL_UNSIGNED_BYTE);
    *red->data() = 204;
    region->setImage(red);
    EXPECT_NEAR(region->maskAt({0, 0}).x(), 0.8, 1e-6);
    const auto number = std::numeric_limits<double>::quiet_NaN();
    region->setImage(greyImage(
        2, 1, [=](double x, double) { return x < 0 ? number : 7.0; }, GL_FLOAT));
    EXPECT_EQ(region->maskAt({-0.75, 0}).x(), 0.0);
    EXPECT_EQ(region->maskAt({0.75, 0}).x(), 1.0);
}

TEST(RegionOfInterest, AnImageIsBlurredAsFarAsTheSoftness)
{
    // The left half is white.
    const Region region =
        imageRegion(greyImage(256, 256, [](double x, double) { return x < 0 ? 1.0 : 0.0; }), 256);
    region->setSoftness(0.2);
    const auto mask = [&](double x)
    {
        return region->maskAt({x, 0.0}).x();
    };
    EXPECT_NEAR(mask(-0.21), 1.0, 1e-3);
    EXPECT_NEAR(mask(0.0), 0.5, 0.01);
    EXPECT_NEAR(mask(-0.1), 0.875, 0.01); // of a tent
    EXPECT_NEAR(mask(0.1), 0.125, 0.01);
    EXPECT_NEAR(mask(0.21), 0.0, 1e-3);
    // At the region's border it grows as other shapes do.
    EXPECT_NEAR(mask(-0.9), 0.5, 0.01);
    EXPECT_NEAR(mask(-1.0), 0.0, 0.03);
    // The line stays where it is.
    EXPECT_NEAR(region->maskAt({-0.3, 0.0}).y(), 0.3, 0.01);
    region->setSize(8000, 2000);
    EXPECT_NEAR(mask(-0.025), 0.875, 0.02); // as far in metres
}

TEST(RegionOfInterest, MasksAreMadeAnewWhenTheyChange)
{
    const osg::ref_ptr<osg::Image> image = greyImage(8, 8, [](double, double) { return 1.0; });
    const Region region = imageRegion(image);
    osg::ref_ptr<const osg::Image> mask = region->mask();
    EXPECT_EQ(region->mask(), mask);
    // None of these changes it.
    region->setCenter({5, 6});
    region->setGeodeticCenter(0.1, 0.2);
    region->setBaseHeight(100.0);
    region->setHeading(1.0);
    region->setSize(500.0, 500.0);
    EXPECT_EQ(region->mask(), mask);
    const auto expectNew = [&](const char* why)
    {
        EXPECT_NE(region->mask(), mask) << why;
        mask = region->mask();
    };
    // What is being drawn stays as it is.
    *image->data(0, 0) = 0;
    EXPECT_EQ(region->maskAt({-1, -1}).x(), 1.0);
    const osg::ref_ptr<const osg::Image> former = mask;
    image->dirty();
    EXPECT_LT(region->maskAt({-1, -1}).x(), 0.1);
    expectNew("the image");
    EXPECT_EQ(texelOf(*former, 0, 0).x(), 1.0);
    region->setSize(500.0, 600.0);
    expectNew("the ratio");
    region->setSoftness(0.1);
    expectNew("the softness");
    region->setMaskSide(32);
    expectNew("the side");
    region->setShape(RegionOfInterest::STAR);
    expectNew("the shape");
    region->setPoints(7);
    expectNew("the points");
    region->setInnerRadius(0.7);
    expectNew("the inner radius");
    region->setShape(RegionOfInterest::ROUNDED);
    expectNew("the shape");
    region->setRounding(0.5);
    expectNew("the rounding");
    region->setShape(RegionOfInterest::POLYGON);
    expectNew("the shape");
    EXPECT_TRUE(region->setOutline({{0, 0}, {1, 0}, {0, 1}}));
    expectNew("the outline");
}

TEST(RegionOfInterest, ThreadsShareOneMask)
{
    for (int i = 0; i < 20; ++i)
    {
        const Region region = makeRegion(RegionOfInterest::STAR, 3000, 1000, 100);
        osg::ref_ptr<const osg::Image> masks[2];
        bool empty[2] = {true, true};
        std::thread other(
            [&]
            {
                masks[1] = region->mask();
                empty[1] = region->isEmpty();
            });
        masks[0] = region->mask();
        empty[0] = region->isEmpty();
        other.join();
        EXPECT_EQ(masks[0], masks[1]);
        EXPECT_FALSE(empty[0] || empty[1]);
    }
}

TEST(RegionOfInterest, WithoutAnImageItIsEmptyAndSaysSoOnce)
{
    NotifyWatch watch;
    const Region region = makeRegion(RegionOfInterest::IMAGE);
    const auto messages = watch.messagesOf(
        [&]
        {
            EXPECT_EQ(region->maskAt({0, 0}), Vec2d(0.0, -2.0));
            region->setSoftness(0.5);
            EXPECT_TRUE(region->isEmpty());
            EXPECT_TRUE(region->contours(0.1).empty());
            region->setCenter({1, 1});
            EXPECT_NE(region->mask(), nullptr);
        });
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("osgGeoFX: RegionOfInterest"), std::string::npos) << messages[0];
    // An image that was good and is no more.
    const osg::ref_ptr<osg::Image> image = greyImage(4, 4, [](double, double) { return 1.0; });
    ASSERT_TRUE(region->setImage(image));
    EXPECT_FALSE(region->isEmpty());
    image->allocateImage(4, 4, 2, GL_LUMINANCE, GL_UNSIGNED_BYTE);
    image->dirty();
    EXPECT_EQ(watch.messagesOf([&] { EXPECT_TRUE(region->isEmpty()); }).size(), 1u);
    // Again after a good one.
    for (int turn = 0; turn < 2; ++turn)
    {
        ASSERT_TRUE(region->setImage(nullptr));
        EXPECT_EQ(watch.messagesOf([&] { EXPECT_TRUE(region->isEmpty()); }).size(), 1u);
        ASSERT_TRUE(region->setImage(greyImage(4, 4, [](double, double) { return 1.0; })));
        EXPECT_FALSE(region->isEmpty());
    }
}

TEST(RegionOfInterest, RefusesWhatMakesNoSense)
{
    NotifyWatch watch;
    const Region region = makeRegion(RegionOfInterest::POLYGON);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Line outline = region->getOutline();
    const osg::ref_ptr<osg::Image> none = new osg::Image, deep = new osg::Image;
    deep->allocateImage(2, 2, 2, GL_RGB, GL_UNSIGNED_BYTE);
    const std::function<bool()> attempts[] = {
        [&] {
            return region->setCenter({nan, 0});
        },
        [&] {
            return region->setCenter({0, infinity});
        },
        [&] { return region->setGeodeticCenter(0, 2.0); },
        [&] { return region->setGeodeticCenter(nan, 0); },
        [&] { return region->setBaseHeight(nan); },
        [&] { return region->setSize(0.5, 100); },
        [&] { return region->setSize(100, 3e6); },
        [&] { return region->setSize(nan, 100); },
        [&] { return region->setHeading(7.0); },
        [&] { return region->setRounding(1.1); },
        [&] { return region->setPoints(2); },
        [&] { return region->setPoints(65); },
        [&] { return region->setInnerRadius(0.0); },
        [&] { return region->setSoftness(-0.1); },
        [&] { return region->setMaskSide(15); },
        [&] { return region->setMaskSide(1025); },
        [&] { return region->setOutline({}); },
        [&] {
            return region->setOutline({{0, 0}, {1, 1}});
        },
        [&] {
            return region->setOutline({{0, 0}, {1, 0}, {nan, 1}});
        },
        [&] {
            return region->setOutline({{0, 0}, {1, 0}, {0, 1.01}});
        },
        [&] {
            return region->setOutline({{0, 0}, {0.5, 0.5}, {1, 1}});
        },
        [&] {
            return region->setOutline({{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}});
        },
        // There and back, with other stops.
        [&] {
            return region->setOutline({{0, 0}, {1, 0}, {0.5, 0}, {0.5, 1}, {0.5, 0.3}, {0.5, 0}});
        },
        [&] { return region->setImage(none); },
        [&] { return region->setImage(deep); },
    };
    const Region former = osg::clone(region.get());
    int number = 0;
    for (const auto& attempt : attempts)
    {
        SCOPED_TRACE(number++);
        const auto messages = watch.messagesOf([&] { EXPECT_FALSE(attempt()); });
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_NE(messages[0].find("osgGeoFX: RegionOfInterest: "), std::string::npos) << messages[0];
    }
    for (const Property& property : region->properties())
        EXPECT_EQ(property.get(*region), property.get(*former)) << property.name;
    EXPECT_EQ(region->getOutline(), outline);
    EXPECT_EQ(region->getImage(), nullptr);
    // What looks alike and is fine: outlines that cross themselves have an area though a sum of signs has none.
    EXPECT_TRUE(region->setOutline({{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}));
    EXPECT_TRUE(region->setOutline({{-1, -1}, {1, 1}, {1, -1}, {-1, 1}}));
}

TEST(RegionOfInterest, CopiesHaveTheSameMask)
{
    const Region region = imageRegion(greyImage(16, 16, disc(0.5, 16)), 32, 3000, 1000);
    EXPECT_TRUE(region->setOutline({{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_TRUE(region->setHeading(0.5));
    for (const bool deep : {false, true})
    {
        const Region copy =
            osg::clone(region.get(), deep ? osg::CopyOp::DEEP_COPY_ALL : osg::CopyOp::SHALLOW_COPY);
        EXPECT_EQ(copy->getImage() == region->getImage(), !deep);
        EXPECT_EQ(copy->getOutline(), region->getOutline());
        for (const Property& property : region->properties())
            EXPECT_EQ(property.get(*copy), property.get(*region)) << property.name;
        const osg::ref_ptr<const osg::Image> mask = copy->mask();
        ASSERT_EQ(mask->s(), 32);
        EXPECT_EQ(std::memcmp(mask->data(), region->mask()->data(), mask->getTotalSizeInBytes()), 0);
        // Each goes its own way.
        copy->setShape(RegionOfInterest::POLYGON);
        EXPECT_EQ(region->getShape(), RegionOfInterest::IMAGE);
    }
}

TEST(RegionOfInterest, FramesLieWhereTheRegionIs)
{
    const Region region = makeRegion(RegionOfInterest::ELLIPSE, 3000, 1000);
    region->setCenter({500000, 4000000});
    region->setBaseHeight(120);
    const auto expectNear = [](const Vec3d& a, const Vec3d& b, double tolerance)
    {
        EXPECT_LT((a - b).length(), tolerance) << a.x() << " " << a.y() << " " << a.z();
    };
    expectNear(Vec3d(10, 20, 30) * region->frameToWorld(nullptr), {500010, 4000020, 150}, 1e-6);
    // A quarter clockwise: the front is east, the right south.
    region->setHeading(osg::PI_2);
    expectNear(Vec3d(0, 20, 0) * region->frameToWorld(nullptr), {500020, 4000000, 120}, 1e-6);
    expectNear(Vec3d(10, 0, 0) * region->frameToWorld(nullptr), {500000, 3999990, 120}, 1e-6);
    expectNear(Vec3d(500250, 4000000, 125) * region->worldToRegion(nullptr), {0, 0.5, 5}, 1e-9);

    const osg::ref_ptr<osg::EllipsoidModel> wgs84 = new osg::EllipsoidModel;
    const double longitude = osg::DegreesToRadians(-157.9), latitude = osg::DegreesToRadians(21.4);
    region->setGeodeticCenter(longitude, latitude);
    const auto world = [&](double east, double north, double height)
    {
        Vec3d place;
        wgs84->convertLatLongHeightToXYZ(latitude + north, longitude + east, height, place.x(), place.y(),
                                         place.z());
        return place;
    };
    for (const double heading : {0.0, 0.7, osg::PI_2, -2.0})
    {
        region->setHeading(heading);
        const osg::Matrixd frame = region->frameToWorld(wgs84);
        const osg::Matrixd back = region->worldToRegion(wgs84);
        expectNear(Vec3d() * frame, world(0, 0, 120), 1e-6);
        expectNear(Vec3d(0, 0, 80) * frame, world(0, 0, 200), 1e-6);
        // Steps so small that the tangent plane is the ellipsoid.
        Vec3d east = world(1e-6, 0, 120) - world(-1e-6, 0, 120),
              north = world(0, 1e-6, 120) - world(0, -1e-6, 120);
        east.normalize();
        north.normalize();
        const Vec3d front = east * std::sin(heading) + north * std::cos(heading);
        const Vec3d right = east * std::cos(heading) - north * std::sin(heading);
        expectNear(Vec3d(0, 1, 0) * frame - Vec3d() * frame, front, 1e-7);
        expectNear(Vec3d(1, 0, 0) * frame - Vec3d() * frame, right, 1e-7);
        expectNear((world(0, 0, 120) + right * 1500 + front * 250) * back, {1, 0.5, 0}, 1e-6);
    }
}

} // namespace
