// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/ViewGeometry.h>

#include <tools/RandomSamples.h>

#include <cmath>

#include <gtest/gtest.h>

using geofx::test::Random;
using osgGeoFX::Ground;
using osgGeoFX::ViewGeometry;

namespace
{

Ground globe()
{
    Ground ground;
    ground.ellipsoid = new osg::EllipsoidModel;
    return ground;
}

/// A camera without a turn: eye space has the world's axes.
ViewGeometry cameraAt(const osg::Vec3d& eye)
{
    return {osg::Matrixd::translate(-eye), osg::Matrixd::perspective(40.0, 1.5, 1.0, 1e6), globe()};
}

} // namespace

TEST(ViewGeometry, FindsTheFootOfTheEyeOnTheEllipsoid)
{
    const osg::EllipsoidModel ellipsoid;
    for (int i = 0; i < 1000; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const double latitude = random.uniform(-osg::PI_2, osg::PI_2);
        const double longitude = random.uniform(-osg::PI, osg::PI);
        const double height = random.integer(0, 9) ? random.uniform(-10e3, 30e3) : random.uniform(0.0, 1e6);
        osg::Vec3d eye;
        ellipsoid.convertLatLongHeightToXYZ(latitude, longitude, height, eye.x(), eye.y(), eye.z());
        const ViewGeometry view = cameraAt(eye);
        const osg::Vec3d up(std::cos(latitude) * std::cos(longitude),
                            std::cos(latitude) * std::sin(longitude), std::sin(latitude));
        // Bowring's formula is off by the cube of the height's share of the radius.
        EXPECT_LT((view.up - up).length(), 1e-9) << i;
        EXPECT_NEAR(view.eyeHeight, height, 1e-6) << i;
    }
}

TEST(ViewGeometry, HasANormalAtThePolesAndAtTheCenter)
{
    const double polar = osg::EllipsoidModel().getRadiusPolar();
    for (const double sign : {1.0, -1.0})
    {
        const ViewGeometry view = cameraAt({0.0, 0.0, sign * (polar + 500.0)});
        EXPECT_NEAR(view.up.z(), sign, 1e-12);
        EXPECT_NEAR(view.eyeHeight, 500.0, 1e-6);
    }
    const ViewGeometry center = cameraAt({0.0, 0.0, 0.0});
    EXPECT_EQ(center.up, osg::Vec3d(0.0, 0.0, 1.0));
    EXPECT_NEAR(center.eyeHeight, -polar, 1e-6);
}
