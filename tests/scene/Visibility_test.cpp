// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a camera sees of deformed balls and boxes, without a scene: against points within them.
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/detail/Visibility.h>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 400, HEIGHT = 300;

/// A camera over a plain, looking ahead and down.
class VisibilityTest : public ::testing::Test
{
protected:
    VisibilityTest() : _viewport(new osg::Viewport(0, 0, WIDTH, HEIGHT))
    {
        _camera.projection = osg::Matrixd::perspective(45.0, 1.0 * WIDTH / HEIGHT, 1.0, 1e5);
        _planes.setToUnitFrustum(true, true);
        _planes.transformProvidingInverse(_camera.projection);
        _camera.viewport = _viewport;
        _camera.planes = &_planes;
        _sight.set(_camera);
    }

    /// Of eye space; true where a point is drawn.
    bool inPicture(const osg::Vec3d& point) const
    {
        const osg::Vec4d clip = osg::Vec4d(point, 1.0) * _camera.projection;
        return clip.w() > 0.0 && std::abs(clip.x()) < clip.w() && std::abs(clip.y()) < clip.w() &&
               std::abs(clip.z()) < clip.w();
    }
    /// The width of a pixel, metres, so many metres ahead.
    static double pixelAt(double distance)
    {
        return 2.0 * distance * std::tan(osg::DegreesToRadians(22.5)) / HEIGHT;
    }
    static osg::ref_ptr<DeformationChain> chainOf(const Deformation& deformation, const ViewGeometry& view)
    {
        osg::ref_ptr<DeformationChain> chain = new DeformationChain;
        const osg::ref_ptr<const DeformationSnapshot> snapshot = deformation.snapshot(view);
        if (snapshot) chain->add(snapshot);
        return chain;
    }

    osg::ref_ptr<osg::Viewport> _viewport;
    osg::Polytope _planes;
    Visibility::Camera _camera;
    Visibility _sight;
};

} // namespace

TEST_F(VisibilityTest, BallsAreOutsideCrossingOrInside)
{
    Visibility::Mask mask = _sight.all();
    EXPECT_NE(mask, 0u);
    EXPECT_FALSE(_sight.outOfSight({osg::Vec3d(0, 0, -1000), 50.0}, mask));
    EXPECT_EQ(mask, 0u) << "nothing below it needs a test any more";
    mask = _sight.all();
    EXPECT_TRUE(_sight.outOfSight({osg::Vec3d(-2000, 0, -1000), 50.0}, mask));
    // The left plane stands at x = −552 there.
    mask = _sight.all();
    EXPECT_FALSE(_sight.outOfSight({osg::Vec3d(-560, 0, -1000), 50.0}, mask));
    EXPECT_NE(mask, 0u) << "its parts may still be outside";
    mask = _sight.all();
    EXPECT_TRUE(_sight.outOfSight({osg::Vec3d(0, 0, 100), 50.0}, mask)) << "behind the eye";
}

TEST_F(VisibilityTest, SmallThingsAreOutOfSightWhereTheyMayBe)
{
    // A pixel is 2·1000·tan(22.5°)/300 metres wide there; OSG counts somewhat generously.
    const double pixel = _sight.radiusOfPixel(osg::Vec3d(0, 0, -1000));
    EXPECT_GT(pixel, 0.4 * pixelAt(1000.0));
    EXPECT_LT(pixel, 0.5 * pixelAt(1000.0));
    EXPECT_FALSE(_sight.tooSmall({osg::Vec3d(0, 0, -1000), 0.001})) << "nobody asked";
    _camera.smallPixels = 2.0;
    _sight.set(_camera);
    Visibility::Mask mask = _sight.all();
    const Ball small = {osg::Vec3d(0, 0, -1000), 1.9 * pixel};
    EXPECT_TRUE(_sight.outOfSight(small, mask));
    EXPECT_FALSE(_sight.outOfSight(small, mask, true));
    EXPECT_FALSE(_sight.outOfSight({small.center, 2.1 * pixel}, mask));
}

TEST_F(VisibilityTest, WhatReachesIntoThePictureIsInSight)
{
    // Beside the picture by 5 pixels, 1000 m ahead.
    const double pixel = pixelAt(1000.0);
    const double border = 0.5 * WIDTH * pixel;
    const Ball beside = {osg::Vec3d(border + 5.0 * pixel, 0, -1000), 1.0};
    for (const auto& [reach, seen] : {std::pair(0.0, false), {3.0, false}, {7.0, true}})
    {
        _camera.reach = reach;
        _sight.set(_camera);
        Visibility::Mask mask = _sight.all();
        EXPECT_EQ(_sight.outOfSight(beside, mask), !seen) << "reach of " << reach << " pixels";
    }
}

// What is out of sight has no point in the picture, wherever it comes from; and most that has none is out of sight.
TEST_F(VisibilityTest, BoxesOutOfSightHaveNoPointInThePicture)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(3.0);
    Random random(5);
    int out = 0, empty = 0, moved = 0;
    for (int i = 0; i < 4000; ++i)
    {
        const double height = random.uniform(100.0, 3000.0), pitch = random.uniform(-0.8, -0.1);
        const osg::Vec3d eye(0, 0, height);
        const osg::Matrixd view = osg::Matrixd::lookAt(
            eye, eye + osg::Vec3d(0, std::cos(pitch), std::sin(pitch)), osg::Vec3d(osg::Z_AXIS));
        const Deformation& deformation = i % 2 == 0 ? static_cast<const Deformation&>(*bend) : *lift;
        const osg::ref_ptr<DeformationChain> chain =
            chainOf(deformation, ViewGeometry(view, _camera.projection, Ground()));
        const osg::Vec3d middle(random.uniform(-9000.0, 9000.0), random.uniform(-2000.0, 20000.0),
                                random.uniform(0.0, 500.0));
        const osg::Vec3d half(random.uniform(10.0, 800.0), random.uniform(10.0, 800.0),
                              random.uniform(1.0, 200.0));
        const EyeBox box = EyeBox::of(osg::BoundingBox(middle - half, middle + half), view);
        int seen = 0, seenBefore = 0;
        for (int k = 0; k < 60; ++k)
        {
            const osg::Vec3d point = box.center + box.half[0] * random.uniform(-1.0, 1.0) +
                                     box.half[1] * random.uniform(-1.0, 1.0) +
                                     box.half[2] * random.uniform(-1.0, 1.0);
            seen += inPicture(chain->deform(point)) ? 1 : 0;
            seenBefore += inPicture(point) ? 1 : 0;
        }
        const bool outOfSight = _sight.outOfSight(*chain, box, _sight.all());
        EXPECT_FALSE(outOfSight && seen > 0) << "box " << i << " has " << seen << " points in the picture";
        out += outOfSight ? 1 : 0;
        empty += seen == 0 ? 1 : 0;
        moved += (seen > 0) != (seenBefore > 0) ? 1 : 0;
    }
    EXPECT_GT(moved, 200) << "the deformations must matter";
    EXPECT_GT(out, 0.85 * empty) << out << " of " << empty;
}
