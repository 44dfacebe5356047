// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where a camera will be, by its last frames: flights of which the test knows the way.
#include <osgGeoFX/scene/detail/CameraMotion.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// The frames of a flight.
class Flight
{
public:
    void frame(double time, const osg::Matrixd& view)
    {
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(time);
        stamp->setReferenceTime(time);
        motion.add(*stamp, view);
    }

    CameraMotion motion;
};

/// Level, along a line; at a heading of 0 it looks north.
osg::Matrixd at(const osg::Vec3d& eye, double heading)
{
    return osg::Matrixd::lookAt(eye, eye + osg::Vec3d(std::sin(heading), std::cos(heading), -0.2),
                                osg::Vec3d(0.0, 0.0, 1.0));
}

osg::Vec3d direction(Random& random)
{
    osg::Vec3d result;
    do
        result.set(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    while (result.length() < 0.1 || result.length() > 1.0);
    result.normalize();
    return result;
}

osg::Vec3d eyeOf(const osg::Matrixd& view)
{
    return osg::Matrixd::inverse(view).getTrans();
}

osg::Vec3d lookOf(const osg::Matrixd& view)
{
    return osg::Matrixd::transform3x3(view, osg::Vec3d(0.0, 0.0, -1.0));
}

} // namespace

TEST(CameraMotion, AStraightFlightGoesOn)
{
    Random random(1);
    for (int sample = 0; sample < 100; ++sample)
    {
        // As far from the origin as on a globe.
        const osg::Vec3d start = direction(random) * 6.4e6;
        const osg::Vec3d velocity = direction(random) * random.logarithmic(1.0, 5000.0);
        const osg::Vec3d aim = direction(random);
        const auto view = [&](double time)
        {
            const osg::Vec3d eye = start + velocity * time;
            return osg::Matrixd::lookAt(eye, eye + aim, start);
        };
        Flight flight;
        double time = 0.0;
        for (int i = 0; i < 20; ++i)
        {
            // Frames come as they like, and the camera is where its time says.
            time += random.uniform(0.01, 0.06);
            flight.frame(time, view(time));
        }
        for (const double ahead : {0.5, 3.0})
        {
            const std::optional<osg::Matrixd> there = flight.motion.at(ahead);
            ASSERT_TRUE(there);
            EXPECT_LT((eyeOf(*there) - eyeOf(view(time + ahead))).length(), 0.01 * velocity.length() * ahead)
                << sample;
            EXPECT_LT((lookOf(*there) - lookOf(view(time))).length(), 0.02);
        }
    }
}

TEST(CameraMotion, ACurveGoesOnForAWhile)
{
    for (const double rate : {-0.4, 0.1, 0.4})
    {
        // 200 m/s along a circle, looking ahead.
        const auto view = [&](double time)
        {
            const double radius = 200.0 / rate, heading = rate * time;
            const osg::Vec3d eye(radius * (1.0 - std::cos(heading)), radius * std::sin(heading), 1000.0);
            return at(eye, heading);
        };
        Flight flight;
        for (int i = 0; i <= 60; ++i)
            flight.frame(i / 60.0, view(i / 60.0));
        const osg::Matrixd truth = view(1.5);
        const std::optional<osg::Matrixd> there = flight.motion.at(0.5);
        ASSERT_TRUE(there);
        EXPECT_LT((eyeOf(*there) - eyeOf(truth)).length(), 5.0) << "of 100 m";
        EXPECT_LT(std::acos(lookOf(*there) * lookOf(truth)), 0.25 * std::abs(0.5 * rate));
        // In the long run it goes where it looks by then, and does not go round and round.
        const double turned = std::acos(lookOf(*flight.motion.at(60.0)) * lookOf(view(1.0)));
        EXPECT_NEAR(turned, std::abs(rate), 0.1 * std::abs(rate));
    }
}

TEST(CameraMotion, WhatStandsStillGoesNowhere)
{
    Flight flight;
    for (int i = 0; i < 100; ++i)
    {
        flight.frame(i / 30.0, at(osg::Vec3d(6.4e6, 10.0, 500.0), 1.0));
        EXPECT_FALSE(flight.motion.at(3.0)) << i;
    }
}

TEST(CameraMotion, AJumpIsNoMotion)
{
    for (const double speed : {0.0, 200.0})
    {
        Flight flight;
        const auto fly = [&](int frame, double east)
        {
            flight.frame(frame / 30.0, at(osg::Vec3d(east, speed * frame / 30.0, 500.0), 0.0));
        };
        for (int i = 0; i < 30; ++i)
            fly(i, 0.0);
        EXPECT_EQ(flight.motion.at(1.0).has_value(), speed > 0.0);
        for (int i = 30; i < 60; ++i)
        {
            fly(i, 20000.0);
            const std::optional<osg::Matrixd> there = flight.motion.at(1.0);
            ASSERT_EQ(there.has_value(), i >= 33 && speed > 0.0) << "frame " << i;
            if (!there) continue;
            const osg::Vec3d expected(20000.0, speed * (i / 30.0 + 1.0), 500.0);
            EXPECT_LT((eyeOf(*there) - expected).length(), 1.0);
        }
        // To turn round at once is a jump, too.
        flight.frame(2.0, at(osg::Vec3d(20000.0, 2.0 * speed, 500.0), 2.0));
        EXPECT_FALSE(flight.motion.at(1.0));
    }
}

TEST(CameraMotion, OneLateFrameDoesNotCount)
{
    Flight flight;
    for (int i = 0; i < 20; ++i)
        flight.frame(i / 30.0 + (i == 18 ? 0.02 : 0.0), at(osg::Vec3d(0.0, 200.0 * i / 30.0, 500.0), 0.0));
    const std::optional<osg::Matrixd> there = flight.motion.at(3.0);
    ASSERT_TRUE(there);
    EXPECT_NEAR(eyeOf(*there).y(), 200.0 * (19 / 30.0 + 3.0), 1.0);
}

TEST(CameraMotion, RealTimeCountsWhereTheSimulationStandsStill)
{
    CameraMotion motion;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    for (int i = 0; i < 10; ++i)
    {
        stamp->setReferenceTime(100.0 + i / 25.0);
        motion.add(*stamp, at(osg::Vec3d(0.0, 50.0 * i / 25.0, 0.0), 0.0));
    }
    ASSERT_TRUE(motion.at(2.0));
    EXPECT_NEAR(eyeOf(*motion.at(2.0)).y(), 50.0 * (9 / 25.0 + 2.0), 0.1);
    // The same time twice: the latter frame of it counts. Time that goes back begins anew.
    motion.add(*stamp, at(osg::Vec3d(0.0, 50.0 * 9 / 25.0 + 0.1, 0.0), 0.0));
    EXPECT_TRUE(motion.at(2.0));
    stamp->setReferenceTime(50.0);
    motion.add(*stamp, at(osg::Vec3d(), 0.0));
    EXPECT_FALSE(motion.at(2.0));
}
