// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/lines/LinePlacement.h>
#include <tools/HeightMesh.h>

#include <gtest/gtest.h>
#include <osg/Geometry>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;

namespace
{

/// Waves on a plane, 20 × 20 km.
double heightAt(double x, double y)
{
    return 500.0 + 300.0 * std::sin(x / 700.0) * std::cos(y / 900.0);
}

osg::ref_ptr<osg::Geometry> mesh(int cells)
{
    return geofx::test::HeightMesh{heightAt}.mesh(cells);
}

TerrainRelief relief(int cells)
{
    return geofx::test::HeightMesh{heightAt}.relief(cells);
}

std::map<std::string, LineStyle> styles()
{
    std::map<std::string, LineStyle> result;
    result["lift"].straight = true;
    result["secret"].shown = false;
    return result;
}

} // namespace

TEST(LinePlacement, LinesLieOnTheGroundAllAlong)
{
    LinePlacement placement;
    placement.step = 50.0;
    placement.tolerance = 1.0;
    std::vector<MapLine> lines = {
        {"", "road", {{-8000.0, -7000.0, 0.0}, {0.0, 500.0, 0.0}, {8500.0, 400.0, 0.0}}}};
    const auto result = placement.place(lines, styles(), *mesh(400), nullptr, relief(100));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].name, "road");
    EXPECT_EQ(result.places, lines[0].places.size());
    EXPECT_EQ(result.outside, 0u);
    // A straight line on waves needs many places, but not all steps.
    EXPECT_GT(lines[0].places.size(), 80u);
    EXPECT_LT(lines[0].places.size(), 380u);
    double worst = 0.0;
    for (std::size_t i = 1; i < lines[0].places.size(); ++i)
        for (int k = 0; k <= 10; ++k)
        {
            const osg::Vec3d place =
                lines[0].places[i - 1] + (lines[0].places[i] - lines[0].places[i - 1]) * (k / 10.0);
            worst = std::max(worst, std::abs(place.z() - heightAt(place.x(), place.y())));
        }
    EXPECT_LT(worst, 3.0) << "the mesh itself is half a metre off, and a step of 50 m one";
    const auto along = [](const osg::Vec3d& place)
    {
        return osg::Vec2d(place.x(), place.y());
    };
    EXPECT_LT((along(lines[0].places.front()) - osg::Vec2d(-8000.0, -7000.0)).length(), 1e-9);
    EXPECT_LT((along(lines[0].places.back()) - osg::Vec2d(8500.0, 400.0)).length(), 1e-9);
}

TEST(LinePlacement, LinesEndWhereTheTerrainDoes)
{
    LinePlacement placement;
    placement.step = 100.0;
    std::vector<MapLine> lines = {
        {"", "through", {{-15000.0, 0.0, 0.0}, {15000.0, 0.0, 0.0}}},
        {"", "beside", {{-15000.0, 0.0, 0.0}, {-15000.0, 9000.0, 0.0}}},
        {"",
         "out and in",
         {{9000.0, 0.0, 0.0}, {12000.0, 0.0, 0.0}, {12000.0, 2000.0, 0.0}, {9000.0, 2000.0, 0.0}}},
        {"secret", "hidden", {{0.0, 0.0, 0.0}, {9000.0, 0.0, 0.0}}}};
    const auto result = placement.place(lines, styles(), *mesh(100), nullptr, relief(100));
    EXPECT_EQ(result.outside, 1u);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].name, "through");
    EXPECT_NEAR(lines[0].places.front().x(), -1e4, 101.0);
    EXPECT_NEAR(lines[0].places.back().x(), 1e4, 101.0);
    EXPECT_EQ(lines[1].name, "out and in");
    EXPECT_EQ(lines[2].name, "out and in") << "two parts of one line";
}

TEST(LinePlacement, LiftsGoThroughTheAirFromPylonToPylon)
{
    LinePlacement placement;
    std::vector<MapLine> lines = {
        {"lift", "", {{-3000.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {4000.0, 1000.0, 0.0}}}};
    placement.place(lines, styles(), *mesh(400), nullptr, relief(100));
    ASSERT_EQ(lines[0].places.size(), 3u);
    for (const osg::Vec3d& place : lines[0].places)
        EXPECT_NEAR(place.z(), heightAt(place.x(), place.y()) + placement.wire, 1.0);
}

TEST(LinePlacement, LongitudesGoOnBeyondTheAntimeridian)
{
    const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    TerrainRelief flat;
    flat.geocentric = true;
    flat.west = 179.0;
    flat.east = 181.0;
    flat.south = -1.0;
    flat.north = 1.0;
    flat.columns = flat.rows = 50;
    flat.heights.assign(2500, 10.0f);
    flat.water.assign(2500, 0);
    LinePlacement placement;
    placement.step = 1000.0;
    placement.finest = 0;
    std::vector<MapLine> lines = {{"", "", {{179.5, 0.0, 0.0}, {-179.5, 0.2, 0.0}}}};
    placement.place(lines, styles(), *mesh(1), ellipsoid, flat);
    ASSERT_EQ(lines.size(), 1u);
    double length = 0.0;
    for (std::size_t i = 1; i < lines[0].places.size(); ++i)
        length += (lines[0].places[i] - lines[0].places[i - 1]).length();
    EXPECT_NEAR(length, 113500.0, 500.0) << "a degree of longitude, and a fifth of one of latitude";
}
