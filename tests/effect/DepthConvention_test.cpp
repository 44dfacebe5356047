// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which of two depths is the nearer one, and rays through pictures with any kind of depth.
#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace osgGeoFX;
using geofx::test::NotifyWatch;
using geofx::test::Random;

namespace
{

/// The same picture with reversed depths: from 1 to 0, from 1 to −1, and, of a perspective, from 1 to 0 at infinity.
std::vector<osg::Matrixd> reversedOf(const osg::Matrixd& projection, double nearest)
{
    osg::Matrixd toZero, toMinusOne;
    toZero(2, 2) = -0.5;
    toZero(3, 2) = 0.5;
    toMinusOne(2, 2) = -1.0;
    std::vector<osg::Matrixd> all = {projection * toZero, projection * toMinusOne};
    if (projection(3, 3) == 0.0)
    {
        all.push_back(all.front());
        all.back()(2, 2) = 0.0;
        all.back()(3, 2) = nearest;
    }
    return all;
}

osg::Matrixd randomProjection(Random& random, double nearest)
{
    const double left = random.uniform(-2.0, -0.1) * nearest, right = random.uniform(0.1, 2.0) * nearest;
    const double low = random.uniform(-2.0, -0.1) * nearest, high = random.uniform(0.1, 2.0) * nearest;
    const double farthest = nearest * random.logarithmic(5.0, 1e5);
    return random.integer(0, 2) ? osg::Matrixd::frustum(left, right, low, high, nearest, farthest)
                                : osg::Matrixd::ortho(left, right, low, high, nearest, farthest);
}

} // namespace

TEST(DepthConventionTest, ProjectionsTellWhetherTheyReverse)
{
    for (int i = 0; i < 200; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const double nearest = random.logarithmic(0.01, 100.0);
        const osg::Matrixd standard = randomProjection(random, nearest);
        const CameraDepth plain({}, standard);
        EXPECT_FALSE(plain.reversed());
        EXPECT_EQ(plain.farthest(), 1.0);
        EXPECT_EQ(plain.notBehind(), osg::Depth::LEQUAL);
        for (const osg::Matrixd& each : reversedOf(standard, nearest))
        {
            const CameraDepth depth({}, each);
            EXPECT_TRUE(depth.reversed());
            EXPECT_TRUE(depth.cutByProjection());
            EXPECT_EQ(depth.farthest(), 0.0);
            EXPECT_EQ(depth.notBehind(), osg::Depth::GEQUAL);
        }
    }
}

TEST(DepthConventionTest, LogarithmsNeedAPerspectiveAndAFarDistance)
{
    const osg::Matrixd perspective = osg::Matrixd::perspective(40.0, 1.5, 1.0, 1023.0);
    const auto factorOf = [](const DepthConvention& convention, const osg::Matrixd& projection)
    {
        const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        CameraDepth(convention, projection).put(*state);
        const osg::Uniform* uniform = state->getUniform("geofx_logDepth");
        float factor = 0.0f;
        if (uniform) uniform->get(factor);
        return factor;
    };
    // log2 of 1,024 is 10, that of 2^20 is 20.
    EXPECT_NEAR(factorOf({DepthConvention::LOGARITHMIC, 0.0}, perspective), 0.2f, 1e-6f);
    EXPECT_NEAR(factorOf({DepthConvention::LOGARITHMIC_BY_FRAGMENT, 1048575.0}, perspective), 0.1f, 1e-6f);
    EXPECT_EQ(factorOf({DepthConvention::LOGARITHMIC, 1e6}, osg::Matrixd::ortho(-1, 1, -1, 1, 1, 10)), 0.0f);
    EXPECT_EQ(factorOf({DepthConvention::OF_PROJECTION, 1e6}, perspective), 0.0f);
    osg::Matrixd endless = perspective;
    endless(2, 2) = -1.0;
    EXPECT_EQ(factorOf({DepthConvention::LOGARITHMIC, 0.0}, endless), 0.0f);
    EXPECT_FALSE(CameraDepth({DepthConvention::LOGARITHMIC, 1e6}, perspective).cutByProjection());
    EXPECT_TRUE(CameraDepth({DepthConvention::LOGARITHMIC_BY_FRAGMENT, 1e6}, perspective).cutByProjection());
}

TEST(DepthConventionTest, WhatCannotBeRightIsRefused)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    CameraEffects& own = CameraEffects::of(*camera);
    const DepthConvention good = {DepthConvention::LOGARITHMIC, 5e6};
    EXPECT_TRUE(scene->setDepthConvention(good));
    EXPECT_TRUE(own.setDepthConvention(good));
    for (const double wrong :
         {-1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    {
        NotifyWatch watch;
        EXPECT_EQ(watch
                      .messagesOf(
                          [&] {
                              EXPECT_FALSE(scene->setDepthConvention({DepthConvention::LOGARITHMIC, wrong}));
                          })
                      .size(),
                  1u);
        EXPECT_EQ(watch
                      .messagesOf(
                          [&] {
                              EXPECT_FALSE(own.setDepthConvention({DepthConvention::LOGARITHMIC, wrong}));
                          })
                      .size(),
                  1u);
    }
    EXPECT_EQ(scene->getDepthConvention(), good);
    EXPECT_EQ(*own.getDepthConvention(), good);
    const osg::ref_ptr<EffectScene> copy = new EffectScene(*scene);
    EXPECT_EQ(copy->getDepthConvention(), good);
    own.clearDepthConvention();
    EXPECT_FALSE(own.getDepthConvention());
}

TEST(DepthConventionTest, RaysAndPartsOfPicturesAreThoseOfStandardDepths)
{
    for (int i = 0; i < 200; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        const double nearest = random.logarithmic(0.01, 100.0);
        const osg::Matrixd standard = randomProjection(random, nearest);
        const osg::Matrixd modelView =
            osg::Matrixd::lookAt(osg::Vec3d(0, 0, 100), osg::Vec3d(30, 70, 20), osg::Vec3d(0, 0, 1));
        const ViewGeometry expected(modelView, standard, Ground());
        const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0);
        osg::Vec3d origin, direction;
        expected.ray(x, y, origin, direction);
        direction.normalize();
        // The right half of the picture, from a little beside.
        const osg::Matrixd half = osg::Matrixd::scale(2, 1, 1) * osg::Matrixd::translate(-1, 0, 0);
        const osg::Matrixd beside = modelView * osg::Matrixd::translate(0.01 * nearest, 0, 0);
        for (const osg::Matrixd& each : reversedOf(standard, nearest))
        {
            ViewGeometry view(modelView, each, Ground());
            osg::Vec3d from, along;
            view.ray(x, y, from, along);
            along.normalize();
            EXPECT_LT((from - origin).length(), 1e-6 * origin.length());
            EXPECT_LT((along - direction).length(), 1e-6);
            for (const osg::Matrixd& place : {modelView, beside})
            {
                view.setImage(place, each * half);
                osg::Vec2d low, high;
                view.picturePart(low, high);
                // Of a parallel projection the way beside counts.
                const double shift =
                    standard(3, 3) == 0.0 ? 0.0 : (place == beside ? -0.01 * nearest * standard(0, 0) : 0.0);
                EXPECT_NEAR(low.x(), shift, 1e-4);
                EXPECT_NEAR(high.x(), 1.0 + shift, 1e-4);
                EXPECT_NEAR(low.y(), -1.0, 1e-6);
                EXPECT_NEAR(high.y(), 1.0, 1e-6);
            }
        }
    }
}

/// Of one that has no far plane, and of one whose far plane lies a little beyond infinity, as Lengyel has it against rounding.
TEST(DepthConventionTest, RaysAndPartsOfPicturesWithoutAFarPlaneAreThoseWithOne)
{
    int perspectives = 0;
    for (int i = 0; i < 200; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        const double nearest = random.logarithmic(0.01, 100.0);
        const osg::Matrixd standard = randomProjection(random, nearest);
        if (standard(3, 3) != 0.0) continue;
        ++perspectives;
        const osg::Matrixd modelView =
            osg::Matrixd::lookAt(osg::Vec3d(0, 0, 100), osg::Vec3d(30, 70, 20), osg::Vec3d(0, 0, 1));
        const ViewGeometry expected(modelView, standard, Ground());
        const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0);
        osg::Vec3d origin, direction;
        expected.ray(x, y, origin, direction);
        direction.normalize();
        const osg::Matrixd half = osg::Matrixd::scale(2, 1, 1) * osg::Matrixd::translate(-1, 0, 0);
        for (const double beyond : {0.0, 2.4e-7, 1e-16})
        {
            SCOPED_TRACE(beyond);
            osg::Matrixd endless = standard;
            endless(2, 2) = beyond - 1.0;
            endless(3, 2) = (beyond - 2.0) * nearest;
            ViewGeometry view(modelView, endless, Ground());
            osg::Vec3d from, along;
            view.ray(x, y, from, along);
            along.normalize();
            EXPECT_LT((from - origin).length(), 1e-6 * origin.length());
            EXPECT_LT((along - direction).length(), 1e-6);
            view.setImage(modelView, endless * half);
            osg::Vec2d low, high;
            view.picturePart(low, high);
            EXPECT_NEAR(low.x(), 0.0, 1e-6);
            EXPECT_NEAR(high.x(), 1.0, 1e-6);
            EXPECT_NEAR(low.y(), -1.0, 1e-6);
            EXPECT_NEAR(high.y(), 1.0, 1e-6);
        }
    }
    EXPECT_GT(perspectives, 50);
}
