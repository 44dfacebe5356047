// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/NamePlacement.h>
#include <tools/HeightMesh.h>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/Math>

#include <cmath>
#include <limits>

using namespace osgGeoFX;

namespace
{

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Two cones on a plain of height 100, the larger one at (400, 300), 20 × 20 km on a plane.
double heightAt(double x, double y)
{
    const auto cone = [&](double cx, double cy, double high, double wide)
    {
        return high * std::max(1.0 - std::hypot(x - cx, y - cy) / wide, 0.0);
    };
    return 100.0 + std::max(cone(400.0, 300.0, 1000.0, 4000.0), cone(-6000.0, -5000.0, 300.0, 2000.0));
}

osg::ref_ptr<osg::Geometry> mesh(int cells)
{
    return geofx::test::HeightMesh{heightAt}.mesh(cells);
}

/// Fine from near, coarse from afar, as paged terrain is.
osg::ref_ptr<osg::LOD> terrain()
{
    osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    lod->addChild(mesh(10), 20000.0f, 1e9f);
    lod->addChild(mesh(200), 0.0f, 20000.0f);
    return lod;
}

TerrainRelief relief(int cells)
{
    return geofx::test::HeightMesh{heightAt}.relief(cells);
}

MapName named(const std::string& text, double x, double y, double z = unknown,
              const std::string& style = "peak")
{
    MapName name;
    name.text = text;
    name.style = style;
    name.places = {{x, y, z}};
    return name;
}

} // namespace

TEST(NamePlacement, SummitsStandOnTheirSummitsAndTownsWhereTheyAre)
{
    std::vector<MapName> names = {named("High", 560.0, 200.0), named("Low", -5900.0, -5050.0, 400.0),
                                  named("Town", 2000.0, 0.0, unknown, "town"), named("Beside", 2e4, 0.0)};
    const NamePlacement placement;
    const NamePlacement::Result result = placement.place(names, *terrain(), nullptr, relief(100));
    EXPECT_EQ(result.outside, 1u);
    EXPECT_EQ(result.moved, 2u);
    ASSERT_EQ(names.size(), 3u);
    // The mesh has a vertex at each 100 m, so at the larger cone's tip.
    EXPECT_NEAR(names[0].places[0].x(), 400.0, 8.0);
    EXPECT_NEAR(names[0].places[0].y(), 300.0, 8.0);
    EXPECT_NEAR(names[0].places[0].z(), 1100.0, 4.0);
    EXPECT_NEAR(names[1].places[0].x(), -6000.0, 8.0);
    EXPECT_NEAR(names[1].places[0].z(), 400.0, 4.0);
    // Prominences above the plain, as exact as the relief's cells.
    EXPECT_NEAR(names[0].importance, 1000.0, 80.0);
    EXPECT_NEAR(names[1].importance, 300.0, 40.0);
    EXPECT_EQ(names[2].places[0].x(), 2000.0);
    EXPECT_NEAR(names[2].places[0].z(), heightAt(2000.0, 0.0), 4.0);
    EXPECT_TRUE(std::isnan(names[2].importance));
}

TEST(NamePlacement, StaysWhereItIsWithoutReach)
{
    std::vector<MapName> names = {named("High", 560.0, 200.0)};
    NamePlacement placement;
    placement.reach = 0.0;
    EXPECT_EQ(placement.place(names, *terrain(), nullptr, relief(100)).moved, 0u);
    ASSERT_EQ(names.size(), 1u);
    EXPECT_EQ(names[0].places[0].x(), 560.0);
    EXPECT_NEAR(names[0].places[0].z(), heightAt(560.0, 200.0), 4.0);
}

// Of a million names the first ones stand on the finest ground, and the others on the relief.
TEST(NamePlacement, BeyondTheFinestTheReliefCounts)
{
    std::vector<MapName> names;
    for (int i = 0; i < 10; ++i)
        names.push_back(named("Town", 1500.0, 300.0, unknown, "town"));
    NamePlacement placement;
    placement.finest = 4;
    placement.place(names, *terrain(), nullptr, relief(20));
    ASSERT_EQ(names.size(), 10u);
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        const TerrainRelief cells = relief(20);
        const double expected =
            i < 4 ? heightAt(1500.0, 300.0) : static_cast<double>(cells.heights[cells.index(11, 10)]);
        EXPECT_NEAR(names[i].places[0].z(), expected, 4.0) << i;
    }
}

TEST(NamePlacement, OnAGlobePlacesAreOnTheEllipsoidsGround)
{
    const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const auto& [longitude, latitude] :
         {std::pair{179.0, 10.0}, {181.0, 10.0}, {181.0, 12.0}, {179.0, 12.0}})
    {
        osg::Vec3d place;
        ellipsoid->convertLatLongHeightToXYZ(osg::DegreesToRadians(latitude),
                                             osg::DegreesToRadians(longitude), 3000.0, place.x(), place.y(),
                                             place.z());
        vertices->push_back(place);
    }
    osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
    ground->setVertexArray(vertices);
    ground->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    TerrainRelief cells;
    cells.geocentric = true;
    cells.west = 179.0;
    cells.east = 181.0; // over the antimeridian
    cells.south = 10.0;
    cells.north = 12.0;
    cells.columns = cells.rows = 4;
    cells.heights.assign(16, 3000.0f);
    cells.water.assign(16, 0);
    std::vector<MapName> names = {named("East", -179.5, 11.0, unknown, "town"),
                                  named("West", 179.5, 11.0, unknown, "town")};
    const NamePlacement placement;
    EXPECT_EQ(placement.place(names, *ground, ellipsoid, cells).outside, 0u);
    ASSERT_EQ(names.size(), 2u);
    for (const MapName& name : names)
    {
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        ellipsoid->convertXYZToLatLongHeight(name.places[0].x(), name.places[0].y(), name.places[0].z(),
                                             latitude, longitude, height);
        EXPECT_NEAR(osg::RadiansToDegrees(longitude), name.text == "East" ? -179.5 : 179.5, 1e-6);
        // The chords of so large triangles sag by up to 2 km.
        EXPECT_GT(height, 500.0);
        EXPECT_LT(height, 3001.0);
    }
}
