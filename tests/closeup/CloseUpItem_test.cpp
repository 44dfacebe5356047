// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where one camera has a close-up, and what its tests and bounds promise to culling.
#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <tools/CloseUpSamples.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

struct Sample
{
    CameraPose pose;
    osg::ref_ptr<CloseUp> closeUp;
    osg::ref_ptr<DeformationChain> chain = new DeformationChain;

    CloseUpItem item(double time = 0.0) const
    {
        return {*closeUp, pose.view(), pose.modelView(), *chain, time};
    }
};

void randomize(Sample& sample, Random& random)
{
    sample.pose = randomCommonPose(random);
    CloseUpPlan plan;
    plan.globe = sample.pose.globe;
    plan.center.set(sample.pose.x, sample.pose.y);
    plan.size = random.logarithmic(10.0, 1e5);
    plan.reach = plan.globe && std::abs(sample.pose.y) > 1.3 ? 0.0 : 2.0 * plan.size;
    plan.rise = plan.size;
    sample.closeUp = randomCloseUp(random, plan);
}

} // namespace

TEST(CloseUpItem, WhatIsOverTheRegionIsNeverOutside)
{
    int outside = 0;
    const int count = fullTest() ? 100000 : 10000;
    for (int i = 0; i < count; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        Sample sample;
        randomize(sample, random);
        const CloseUpItem item = sample.item();
        const RegionOfInterest& region = *sample.closeUp->getRegion();
        const double size = 0.5 * std::max(region.getWidth(), region.getDepth());
        // A point of the ground, over the region or near it, and balls and boxes that have it.
        const osg::Vec3d place(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5),
                               random.uniform(-1.0, 1.0) * size);
        const bool over = std::abs(place.x()) <= 1.0 && std::abs(place.y()) <= 1.0;
        const osg::Vec3d point =
            osg::Vec3d(0.5 * region.getWidth() * place.x(), 0.5 * region.getDepth() * place.y(), place.z()) *
            item.regionToEye();
        const double radius = size * random.logarithmic(1e-3, 2.0);
        const Ball ball = {point + randomDirection(random) * (radius * random.uniform(0.0, 0.999)), radius};
        osg::Matrixd turned = osg::Matrixd::rotate(random.uniform(0.0, 6.0), randomDirection(random));
        turned.setTrans(ball.center);
        const auto half = static_cast<float>(radius);
        const EyeBox box = EyeBox::of(osg::BoundingBox(-half, -half, -half, half, half, half), turned);
        outside += item.outside(ball) ? 1 : 0;
        if (!over) continue;
        ASSERT_FALSE(item.outside(ball)) << "sample " << i;
        ASSERT_FALSE(item.outside(box)) << "sample " << i;
        double lowest = 1e30;
        double highest = -1e30;
        item.includeHeights(box, lowest, highest);
        ASSERT_LE(lowest, place.z() + 1e-5 * size) << "sample " << i;
        ASSERT_GE(highest, place.z() - 1e-5 * size) << "sample " << i;
    }
    // So that it is a test: there are some that are.
    EXPECT_GT(outside, count / 20);
}

TEST(CloseUpItem, HeightsAreThoseOverTheRegionOnly)
{
    // Wide boxes that lean, as tiles far from a region's middle do: most of their height is beside it.
    double gained = 0.0;
    for (int i = 0; i < 200; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        Sample sample;
        sample.pose.height = 1e4;
        sample.closeUp = new CloseUp;
        sample.closeUp->getRegion()->setSize(1000.0, 600.0);
        sample.closeUp->getRegion()->setHeading(random.uniform(-3.0, 3.0));
        const CloseUpItem item = sample.item();
        osg::Matrixd leaning = osg::Matrixd::rotate(random.uniform(-1.2, 1.2), randomDirection(random));
        leaning.setTrans(random.uniform(-1500.0, 1500.0), random.uniform(-1500.0, 1500.0),
                         random.uniform(-500.0, 500.0));
        const osg::Vec3d half(2000.0, 1500.0, random.uniform(10.0, 200.0));
        const EyeBox box =
            EyeBox::of(osg::BoundingBox(osg::Vec3(-half), osg::Vec3(half)), leaning * item.regionToEye());
        double lowest = 1e30, highest = -1e30;
        item.includeHeights(box, lowest, highest);
        // Along the uprights through a lattice of places: where each enters the box and leaves it.
        const osg::Matrixd toBox = osg::Matrixd::inverse(leaning);
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), toBox);
        double trueLowest = 1e30, trueHighest = -1e30, wholeHighest = -1e30;
        constexpr int steps = 100;
        for (int k = 0; k <= steps; ++k)
        {
            for (int j = 0; j <= steps; ++j)
            {
                const osg::Vec3d at =
                    osg::Vec3d(500.0 * (2.0 * j / steps - 1.0), 300.0 * (2.0 * k / steps - 1.0), 0.0) * toBox;
                double enters = -1e30, leaves = 1e30;
                for (int axis = 0; axis < 3; ++axis)
                {
                    const double one = (-half[axis] - at[axis]) / up[axis];
                    const double other = (half[axis] - at[axis]) / up[axis];
                    enters = std::max(enters, std::min(one, other));
                    leaves = std::min(leaves, std::max(one, other));
                }
                if (!(enters < leaves)) continue;
                trueLowest = std::min(trueLowest, enters);
                trueHighest = std::max(trueHighest, leaves);
            }
        }
        if (!(trueLowest < trueHighest)) continue;
        for (int corner = 0; corner < 8; ++corner)
            wholeHighest = std::max(wholeHighest, (osg::Vec3d((corner & 1) ? half.x() : -half.x(),
                                                              (corner & 2) ? half.y() : -half.y(),
                                                              (corner & 4) ? half.z() : -half.z()) *
                                                   leaning)
                                                      .z());
        // The lattice may miss a corner by a step, where the box is as steep as it is.
        const double steep = 12.0 * std::tan(1.2) + 5.0;
        EXPECT_LE(lowest, trueLowest + 1e-3) << "sample " << i;
        EXPECT_GE(highest, trueHighest - 1e-3) << "sample " << i;
        EXPECT_GE(lowest, trueLowest - steep) << "sample " << i;
        EXPECT_LE(highest, trueHighest + steep) << "sample " << i;
        gained = std::max(gained, wholeHighest - highest);
    }
    EXPECT_GT(gained, 500.0);
}

TEST(CloseUpItem, TheOtherSideOfAGlobeIsOutside)
{
    Sample sample;
    sample.pose.globe = true;
    sample.closeUp = new CloseUp;
    sample.closeUp->getRegion()->setSize(2e6, 2e6);
    const CloseUpItem item = sample.item();
    const auto ballAt = [&](double x, double height)
    {
        return Ball{osg::Vec3d(x, 0.0, height) * item.regionToEye(), 1000.0};
    };
    EXPECT_FALSE(item.outside(ballAt(0.0, 0.0)));
    // Ground at the region's border, which the globe's curve takes 79 km below its middle, and the deepest one.
    EXPECT_FALSE(item.outside(ballAt(1e6, -79e3)));
    EXPECT_FALSE(item.outside(ballAt(0.0, -12e3)));
    EXPECT_TRUE(item.outside(ballAt(0.0, -2.0 * 6.37e6)));
    // A ball that has both sides has this one.
    EXPECT_FALSE(item.outside(Ball{osg::Vec3d(0.0, 0.0, -6.37e6) * item.regionToEye(), 6.4e6}));
    const auto boxAt = [&](double height)
    {
        return EyeBox::of(osg::BoundingBox(-1000.0f, -1000.0f, -10.0f, 1000.0f, 1000.0f, 10.0f),
                          osg::Matrixd::translate(0.0, 0.0, height) * item.regionToEye());
    };
    EXPECT_FALSE(item.outside(boxAt(-12e3)));
    EXPECT_TRUE(item.outside(boxAt(-2.0 * 6.37e6)));
    // On a plane there is no other side.
    sample.pose.globe = false;
    const CloseUpItem level = sample.item();
    EXPECT_FALSE(level.outside(Ball{osg::Vec3d(0.0, 0.0, -2.0 * 6.37e6) * level.regionToEye(), 1000.0}));
}

TEST(CloseUpItem, CornersHoldTheCloseUp)
{
    const int count = fullTest() ? 100000 : 10000;
    int parallel = 0;
    for (int i = 0; i < count; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        Sample sample;
        randomize(sample, random);
        const CloseUpItem item = sample.item();
        parallel += item.parallel() ? 1 : 0;
        const RegionOfInterest& region = *sample.closeUp->getRegion();
        const double low = random.uniform(-0.2, 0.1) * region.getWidth();
        const double high = low + random.logarithmic(1e-3, 0.3) * region.getWidth();
        const auto corners = item.liftedCorners(low, high);
        const osg::Vec3d point(0.5 * region.getWidth() * random.uniform(-1.0, 1.0),
                               0.5 * region.getDepth() * random.uniform(-1.0, 1.0),
                               random.uniform(low, high));
        const osg::Vec3d lifted = item.lifted(point * item.regionToEye());
        // Within what they span, seen along any direction; lines stay lines without perspective, too, where it is before the eye.
        for (int k = 0; k < 4; ++k)
        {
            const osg::Vec3d axis = randomDirection(random);
            double least = 1e30;
            double most = -1e30;
            double scale = 0.0;
            for (const osg::Vec3d& corner : corners)
            {
                least = std::min(least, corner * axis);
                most = std::max(most, corner * axis);
                scale = std::max(scale, corner.length());
            }
            ASSERT_GE(lifted * axis, least - 1e-7 * scale) << "sample " << i;
            ASSERT_LE(lifted * axis, most + 1e-7 * scale) << "sample " << i;
        }
        const EyeBox ground = item.groundBox(low, high);
        const osg::Vec3d from = point * item.regionToEye() - ground.center;
        for (const osg::Vec3d& half : ground.half)
            ASSERT_LE(std::abs(from * half), half * half * (1.0 + 1e-5) + 1e-5 * half.length())
                << "sample " << i;
    }
    EXPECT_GT(parallel, count / 50);
}

TEST(CloseUpItem, LiftsAsItIsDocumented)
{
    for (int i = 0; i < 1000; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        Sample sample;
        randomize(sample, random);
        CloseUp& closeUp = *sample.closeUp;
        const osg::Vec3d point(random.uniform(-100.0, 100.0), random.uniform(-100.0, 100.0),
                               random.uniform(-10.0, 10.0));
        // offset + R S v, with the turn about the vertical first and then the tilt about x.
        osg::Vec3d shaped(point.x() * closeUp.getScaleX(), point.y() * closeUp.getScaleY(),
                          point.z() * closeUp.getScaleHeight());
        const double turn = closeUp.getTurn();
        shaped.set(shaped.x() * std::cos(turn) - shaped.y() * std::sin(turn),
                   shaped.x() * std::sin(turn) + shaped.y() * std::cos(turn), shaped.z());
        const double tilt = closeUp.getTilt();
        shaped.set(shaped.x(), shaped.y() * std::cos(tilt) - shaped.z() * std::sin(tilt),
                   shaped.y() * std::sin(tilt) + shaped.z() * std::cos(tilt));
        const CloseUpItem item = sample.item();
        const osg::Vec3d eye = point * item.regionToEye();
        const double scale = 1e-7 * (eye.length() + item.lifted(eye).length()) + 1e-6;
        if (closeUp.getOrientation() == CloseUp::SCENE)
        {
            const osg::Vec3d expected = (shaped + closeUp.getOffset()) * item.regionToEye();
            EXPECT_LT((item.lifted(eye) - expected).length(), scale) << "sample " << i;
        }
        else if (!item.parallel())
        {
            // The offset is the scene's, the axes are the camera's.
            const osg::Vec3d expected = shaped + closeUp.getOffset() * item.regionToEye();
            EXPECT_LT((item.lifted(eye) - expected).length(), scale) << "sample " << i;
        }
        // Half of the way is half of the way.
        const osg::Vec3d half = item.raised(eye, eye, 0.5);
        EXPECT_LT((half - (eye + item.lifted(eye)) * 0.5).length(), scale) << "sample " << i;
    }
}

TEST(CloseUpItem, StartsWhereABendHasMovedItsRegion)
{
    int moved = 0;
    for (int i = 0; i < 1000; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        Sample sample;
        sample.pose.height = random.logarithmic(500.0, 5000.0);
        sample.pose.heading = random.uniform(-3.0, 3.0);
        sample.pose.pitch = -random.uniform(0.3, 0.8);
        const ViewGeometry view = sample.pose.view();
        const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setFocusLine(0.3);
        bend->setHorizonLine(random.uniform(0.7, 0.9));
        const auto frame = bend->snapshot(view);
        if (!frame) continue;
        sample.chain->add(frame);
        sample.closeUp = new CloseUp;
        CloseUp& closeUp = *sample.closeUp;
        const double distance = sample.pose.height * random.uniform(1.0, 6.0);
        const double bearing = sample.pose.heading + random.uniform(-0.3, 0.3);
        closeUp.getRegion()->setCenter({distance * std::sin(bearing), distance * std::cos(bearing)});
        closeUp.setOrientation(static_cast<CloseUp::Orientation>(random.integer(0, 1)));
        closeUp.setOffset(
            {random.uniform(-500.0, 500.0), random.uniform(-500.0, 500.0), random.uniform(0.0, 900.0)});
        const CloseUpItem item = sample.item();
        // Where the bend takes the middle, and how the ground lies there, from three points a metre apart.
        const auto bent = [&](double x, double y)
        {
            return sample.chain->deform(osg::Vec3d(x, y, 0.0) * item.regionToEye());
        };
        const osg::Vec3d middle = bent(0.0, 0.0);
        osg::Vec3d east = bent(1.0, 0.0) - bent(-1.0, 0.0);
        osg::Vec3d north = bent(0.0, 1.0) - bent(0.0, -1.0);
        osg::Vec3d up = east ^ north;
        for (osg::Vec3d* axis : {&east, &north, &up})
            axis->normalize();
        const osg::Vec3d offset = closeUp.getOffset();
        const osg::Vec3d expected = middle + east * offset.x() + north * offset.y() + up * offset.z();
        const osg::Vec3d at = item.lifted(item.regionToEye().getTrans());
        EXPECT_LT((at - expected).length(), 0.03 * offset.length()) << "sample " << i;
        const osg::Vec3d plain = offset * item.regionToEye();
        moved += (plain - expected).length() > 0.2 * offset.length() ? 1 : 0;
    }
    EXPECT_GT(moved, 100);
}

TEST(CloseUpItem, WithoutPerspectiveAllDepthsAreAsLarge)
{
    CloseUpPlan plan;
    Random random(1);
    Sample sample;
    sample.pose.height = 20000.0;
    sample.pose.pitch = -1.2;
    sample.closeUp = randomCloseUp(random, plan);
    sample.closeUp->setOrientation(CloseUp::BILLBOARD);
    sample.closeUp->setScale(1.0, 1.0, 1.0);
    sample.closeUp->setTilt(0.0);
    sample.closeUp->setTurn(0.0);
    sample.closeUp->getRegion()->setCenter({0.0, 5000.0});
    const CloseUpItem item = sample.item();
    ASSERT_TRUE(item.parallel());
    const auto pictureOf = [&](double x, double height)
    {
        const osg::Vec3d eye = item.lifted(osg::Vec3d(x, 0.0, height) * item.regionToEye());
        return eye.x() / -eye.z();
    };
    const double width = pictureOf(100.0, 0.0) - pictureOf(-100.0, 0.0);
    EXPECT_GT(width, 0.0);
    for (const double height : {-50.0, 100.0, 200.0})
        EXPECT_NEAR(pictureOf(100.0, height) - pictureOf(-100.0, height), width, 1e-9);
    // What is higher is nearer.
    const auto depth = [&](double height)
    {
        return -item.lifted(osg::Vec3d(0.0, 0.0, height) * item.regionToEye()).z();
    };
    EXPECT_LT(depth(100.0), depth(0.0));
}

TEST(CloseUpItem, TurnsByItself)
{
    const osg::ref_ptr<CloseUp> closeUp = new CloseUp;
    closeUp->setTurnRate(0.5);
    const osg::Vec3d point(1.0, 0.0, 0.0);
    const osg::Matrixd later = closeUp->shape(2.0);
    EXPECT_NEAR((point * later - later.getTrans()).x(), 1.5 * std::cos(1.0), 1e-12);
    EXPECT_NEAR((point * later - later.getTrans()).y(), 1.5 * std::sin(1.0), 1e-12);
}
