// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <tools/PagedScene.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>

#include <GeographicLib/Geocentric.hpp>
#include <gtest/gtest.h>
#include <osg/CoordinateSystemNode>
#include <osg/Group>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/ValueObject>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>

using geofx::test::PagedScene;
using geofx::test::Random;
using geofx::test::TempDir;
using osgGeoFX::Georeference;
using osgGeoFX::TerrainInfo;
using osgGeoFX::TileInfo;

namespace
{

osg::ref_ptr<Georeference> geocentric()
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    osg::ref_ptr<osg::CoordinateSystemNode> node = new osg::CoordinateSystemNode("WKT", "");
    node->setEllipsoidModel(new osg::EllipsoidModel);
    scene->addChild(new osg::Group);
    scene->addChild(node);
    std::string error;
    osg::ref_ptr<Georeference> reference = Georeference::create(scene, error);
    EXPECT_TRUE(reference.valid()) << error;
    return reference;
}

} // namespace

// A micrometre is far below the millimetre that is asked for, and far above rounding (1e-9 m at 6.4e6 m).
TEST(Georeference, AgreesWithGeographicLib)
{
    const osg::ref_ptr<Georeference> reference = geocentric();
    const GeographicLib::Geocentric& exact = GeographicLib::Geocentric::WGS84();
    for (int i = 0; i < geofx::test::sampleCount(); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const double longitude = random.uniform(-180.0, 180.0);
        // Every fourth sample lies close to a pole, where formulas divide by nothing.
        const double latitude =
            i % 4 ? random.uniform(-90.0, 90.0) : random.sign() * (90.0 - random.logarithmic(1e-12, 1e-2));
        const double height = random.uniform(-11000.0, 1000000.0);
        osg::Vec3d expected;
        exact.Forward(latitude, longitude, height, expected.x(), expected.y(), expected.z());
        osg::Vec3d world;
        ASSERT_TRUE(reference->toWorld(osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude),
                                       height, world));
        ASSERT_LT((world - expected).length(), 1e-6) << "sample " << i;
        double lon = 0.0;
        double lat = 0.0;
        double back = 0.0;
        ASSERT_TRUE(reference->toGeodetic(expected, lon, lat, back));
        EXPECT_NEAR(back, height, 1e-6) << "sample " << i;
        EXPECT_NEAR(osg::RadiansToDegrees(lat), latitude, 1e-11) << "sample " << i;
        const double alongParallel = std::remainder(lon - osg::DegreesToRadians(longitude), 2.0 * osg::PI) *
                                     std::hypot(expected.x(), expected.y());
        EXPECT_NEAR(alongParallel, 0.0, 1e-6) << "sample " << i;
    }
}

TEST(Georeference, PolesAndTheAxisAreFine)
{
    const osg::ref_ptr<Georeference> reference = geocentric();
    double longitude = 0.0;
    double latitude = 0.0;
    double height = 0.0;
    ASSERT_TRUE(reference->toGeodetic({0.0, 0.0, 6356752.314245179 + 10.0}, longitude, latitude, height));
    EXPECT_NEAR(latitude, osg::PI_2, 1e-15);
    EXPECT_NEAR(height, 10.0, 1e-6);
    ASSERT_TRUE(reference->toGeodetic({0.0, 0.0, -6356752.314245179}, longitude, latitude, height));
    EXPECT_NEAR(latitude, -osg::PI_2, 1e-15);
    EXPECT_NEAR(height, 0.0, 1e-6);
}

TEST(Georeference, LocalFrameIsEastNorthUp)
{
    const osg::ref_ptr<Georeference> reference = geocentric();
    for (int i = 0; i < 200; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const double longitude = random.uniform(-3.1, 3.1);
        const double latitude = random.uniform(-1.5, 1.5);
        osg::Matrixd frame;
        ASSERT_TRUE(reference->localToWorld(longitude, latitude, 500.0, frame));
        const auto expectAt = [&](const osg::Vec3d& local, double dLongitude, double dLatitude, double h)
        {
            osg::Vec3d expected;
            reference->toWorld(longitude + dLongitude, latitude + dLatitude, h, expected);
            EXPECT_LT((local * frame - expected).length(), 0.01) << "sample " << i;
        };
        expectAt({0.0, 0.0, 0.0}, 0.0, 0.0, 500.0);
        expectAt({0.0, 0.0, 100.0}, 0.0, 0.0, 600.0);
        // 10 m to the east and north, by the ellipsoid's two radii of curvature.
        const double w = std::sqrt(1.0 - 0.0066943799901413165 * std::pow(std::sin(latitude), 2));
        const double n = 6378137.0 / w;
        const double m = 6378137.0 * (1.0 - 0.0066943799901413165) / (w * w * w);
        expectAt({10.0, 0.0, 0.0}, 10.0 / ((n + 500.0) * std::cos(latitude)), 0.0, 500.0);
        expectAt({0.0, 10.0, 0.0}, 0.0, 10.0 / (m + 500.0), 500.0);
    }
}

TEST(Georeference, SaysWhyThereIsNone)
{
    std::string error;
    EXPECT_FALSE(Georeference::create(nullptr, error).valid());
    EXPECT_NE(error.find("no coordinate system"), std::string::npos) << error;
    error.clear();
    EXPECT_FALSE(Georeference::create(osg::ref_ptr<osg::Node>(new osg::Group), error).valid());
    EXPECT_NE(error.find("no coordinate system"), std::string::npos) << error;
    error.clear();
    osg::ref_ptr<osg::CoordinateSystemNode> nonsense = new osg::CoordinateSystemNode("WKT", "nonsense");
    EXPECT_FALSE(Georeference::create(nonsense, error).valid());
    EXPECT_FALSE(error.empty());
}

TEST(TerrainInfo, IsReadBackFromAFile)
{
    const TempDir folder;
    const auto file = PagedScene::write(folder.path(), PagedScene::Kind::Geocentric);
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file.string());
    ASSERT_TRUE(node.valid());
    osg::ref_ptr<osg::Group> above = new osg::Group;
    above->addChild(node);
    std::string error;
    const auto info = TerrainInfo::read(above, error);
    ASSERT_TRUE(info) << error;
    EXPECT_TRUE(info->geocentric);
    EXPECT_EQ(info->levels, 3);
    EXPECT_DOUBLE_EQ(info->west, -157.82);
    EXPECT_DOUBLE_EQ(info->north, 21.42);
    EXPECT_DOUBLE_EQ(info->pixelsPerRadian, 2077.0);
    EXPECT_EQ(info->vertical, "none");

    node->setUserValue("geofx.format", TerrainInfo::newestFormat + 1);
    EXPECT_FALSE(TerrainInfo::read(above, error));
    EXPECT_NE(error.find("newer"), std::string::npos) << error;
    node->setUserValue("geofx.format", TerrainInfo::newestFormat - 1);
    error.clear();
    EXPECT_FALSE(TerrainInfo::read(above, error));
    EXPECT_NE(error.find("build it again"), std::string::npos) << error;
    node->setUserValue("geofx.format", TerrainInfo::newestFormat);
    node->setUserValue("geofx.kind", std::string("round"));
    error.clear();
    EXPECT_FALSE(TerrainInfo::read(above, error));
    EXPECT_NE(error.find("incomplete"), std::string::npos) << error;
    error.clear();
    EXPECT_FALSE(TerrainInfo::read(osg::ref_ptr<osg::Node>(new osg::Group), error));
    EXPECT_TRUE(error.empty()) << "a scene without a terrain is no error: " << error;
}

TEST(TerrainInfo, LodScaleNeverCoarsens)
{
    TerrainInfo info;
    info.pixelsPerRadian = 2000.0;
    EXPECT_FLOAT_EQ(osgGeoFX::lodScaleFor(info, 4000.0), 0.5f);
    EXPECT_FLOAT_EQ(osgGeoFX::lodScaleFor(info, 1000.0), 1.0f);
    EXPECT_NEAR(osgGeoFX::pixelsPerRadian(1080.0, osg::DegreesToRadians(90.0)), 540.0, 1e-9);
}

TEST(TileInfo, IsReadFromTheTransform)
{
    osg::ref_ptr<osg::MatrixTransform> tile = new osg::MatrixTransform;
    tile->setName("tile 12/345/6");
    EXPECT_TRUE(TileInfo::isTile(*tile));
    EXPECT_FALSE(TileInfo::read(*tile)) << "without a box";
    tile->setUserValue("geofx.boxMin", osg::Vec3d(-1.0, -2.0, -3.0));
    tile->setUserValue("geofx.boxMax", osg::Vec3d(1.0, 2.0, 3.0));
    const auto info = TileInfo::read(*tile);
    ASSERT_TRUE(info);
    EXPECT_EQ(info->level, 12);
    EXPECT_EQ(info->x, 345);
    EXPECT_EQ(info->y, 6);
    EXPECT_EQ(info->boxMin, osg::Vec3d(-1.0, -2.0, -3.0));
    EXPECT_EQ(info->boxMax, osg::Vec3d(1.0, 2.0, 3.0));
    tile->setName("tile 12/345/6b");
    EXPECT_FALSE(TileInfo::read(*tile));
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->setName("tile 1/2/3");
    EXPECT_FALSE(TileInfo::isTile(*group));
}
