// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/LocalOrigin.h>

#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <osgGeoFX/closeup/SurfaceData.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <gtest/gtest.h>
#include <osg/Math>

#include <utility>

namespace
{

using osg::DegreesToRadians;
using osgGeoFX::LocalOrigin;

constexpr double longitude = -157.8, latitude = 21.3, height = 320.0;

LocalOrigin both()
{
    LocalOrigin origin = LocalOrigin::onGlobe(DegreesToRadians(longitude), DegreesToRadians(latitude));
    origin.x = 612000.0;
    origin.y = 2361000.0;
    return origin;
}

TEST(LocalOrigin, OnAGlobeItsFrameIsGeographicLibs)
{
    const osg::ref_ptr<osg::EllipsoidModel> globe = new osg::EllipsoidModel;
    const osg::Matrixd toWorld = both().toWorld(globe, height);
    const GeographicLib::LocalCartesian other(latitude, longitude, height);
    for (const osg::Vec3d& place :
         {osg::Vec3d(), osg::Vec3d(900.0, 0.0, 0.0), osg::Vec3d(-30.0, 7000.0, 55.0)})
    {
        double there = 0.0, east = 0.0, up = 0.0;
        other.Reverse(place.x(), place.y(), place.z(), there, east, up);
        osg::Vec3d expected;
        globe->convertLatLongHeightToXYZ(DegreesToRadians(there), DegreesToRadians(east), up, expected.x(),
                                         expected.y(), expected.z());
        EXPECT_LT((place * toWorld - expected).length(), 1e-6);
    }
}

TEST(LocalOrigin, OnAPlaneItMoves)
{
    EXPECT_EQ(osg::Vec3d(3.0, 4.0, 5.0) * both().toWorld(nullptr, height),
              osg::Vec3d(612003.0, 2361004.0, 325.0));
    EXPECT_EQ(LocalOrigin::onPlane(osg::Vec2d(8.0, 9.0)).place(), osg::Vec2d(8.0, 9.0));
}

TEST(LocalOrigin, TurnsLongitudesByFullCircles)
{
    for (const auto& [given, expected] : {std::pair(-170.0, -170.0), {190.0, -170.0}, {-545.0, 175.0}})
        EXPECT_NEAR(LocalOrigin::onGlobe(DegreesToRadians(given), 0.5).longitude, DegreesToRadians(expected),
                    1e-12);
}

TEST(LocalOrigin, GivesAllThatHaveItOneFrame)
{
    const osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;
    const osg::ref_ptr<osgGeoFX::SurfaceData> data = new osgGeoFX::SurfaceData;
    const osg::ref_ptr<osgGeoFX::RegionOfInterest> region = new osgGeoFX::RegionOfInterest;
    const osg::ref_ptr<osg::EllipsoidModel> globe = new osg::EllipsoidModel;
    ASSERT_TRUE(mappings->setLocalOrigin(both()));
    ASSERT_TRUE(data->setLocalOrigin(mappings->getLocalOrigin()));
    ASSERT_TRUE(region->setCenter(data->getOrigin()));
    ASSERT_TRUE(region->setGeodeticCenter(data->getLongitude(), data->getLatitude()));
    for (const osg::EllipsoidModel* ellipsoid :
         {static_cast<const osg::EllipsoidModel*>(nullptr), static_cast<const osg::EllipsoidModel*>(globe)})
    {
        const osg::Matrixd expected = both().toWorld(ellipsoid);
        EXPECT_EQ(mappings->frameToWorld(ellipsoid), expected);
        EXPECT_EQ(data->frameToWorld(ellipsoid), expected);
        EXPECT_EQ(region->frameToWorld(ellipsoid), expected);
    }
}

} // namespace
