// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A built database, as plain osgDB reads it: heights against GDAL, positions against GeographicLib.
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseReader.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

const std::string oahu = GEOFX_SOURCE_DIR "/data/oahu/elevation.tif";

BuildOptions options(const std::vector<std::string>& dems, const std::filesystem::path& output, int epsg = 0,
                     int tileSize = 16)
{
    BuildOptions result;
    result.dems = dems;
    result.epsg = epsg;
    result.tileSize = tileSize;
    result.textureSize = 2 * tileSize;
    result.output = output.string();
    return result;
}

/// Every post of the finest level: its height against GDAL's bilinear sample to 0.05 m, its position against
/// GeographicLib's to 1 mm and what is rounded in the tile's frame.
void expectAsGdalSays(const std::vector<std::string>& dems, const std::string& database,
                      const std::string& crs, std::size_t leastPosts)
{
    const DatabaseRoot root(database);
    const FinestLevel level(database);
    const auto samples = [&](double shiftX, double shiftY)
    {
        return warpedHeights(dems, crs, level.x0 + shiftX * level.dx, level.y0 + shiftY * level.dy, level.dx,
                             level.dy, level.columns, level.rows);
    };
    const auto expected = samples(0.0, 0.0);

    std::size_t posts = 0;
    std::vector<std::size_t> withoutGround;
    double worstHeight = 0.0, worstPosition = 0.0;
    for (int row = 0; row < level.rows; ++row)
        for (int column = 0; column < level.columns; ++column)
        {
            const std::size_t index = level.index(column, row);
            if (!level.used[index]) continue;
            ++posts;
            if (std::isnan(expected[index]))
            {
                withoutGround.push_back(index);
                continue;
            }
            const double height = root.fromWorld(level.world[index]).z();
            worstHeight = std::max(worstHeight, std::abs(height - static_cast<double>(expected[index])));
            const osg::Vec3d place =
                root.toWorld({level.x0 + column * level.dx, level.y0 + row * level.dy, height});
            worstPosition =
                std::max(worstPosition, (place - level.world[index]).length() - level.rounding[index]);
        }
    EXPECT_LE(worstHeight, 0.05);
    EXPECT_LE(worstPosition, 0.001);
    // On the outermost edge of a raster, rounding decides whether a post has data.
    std::vector<bool> onEdge(expected.size(), false);
    for (const double shiftX : {-0.03, 0.03})
        for (const double shiftY : {-0.03, 0.03})
        {
            const auto shifted = withoutGround.empty() ? expected : samples(shiftX, shiftY);
            for (const std::size_t index : withoutGround)
                onEdge[index] = onEdge[index] || !std::isnan(shifted[index]);
        }
    EXPECT_TRUE(
        std::all_of(withoutGround.begin(), withoutGround.end(), [&](std::size_t i) { return onEdge[i]; }))
        << "there is ground where GDAL finds no data";
    EXPECT_GE(posts, leastPosts);

    std::size_t missing = 0;
    for (int row = 0; row + 1 < level.rows; ++row)
        for (int column = 0; column + 1 < level.columns; ++column)
        {
            bool ground = true, drawn = true;
            for (const std::size_t index : {level.index(column, row), level.index(column + 1, row),
                                            level.index(column, row + 1), level.index(column + 1, row + 1)})
            {
                ground = ground && !std::isnan(expected[index]);
                drawn = drawn && level.used[index];
            }
            missing += ground && !drawn;
        }
    EXPECT_EQ(missing, 0u) << "cells that have data and are not drawn";
}

TEST(DatabaseHeights, GeographicToGeocentric)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 211, 157, 10.0, 47.5, 1.0 / 3600.0);
    buildDatabase(options({dem}, folder / "db"));
    expectAsGdalSays({dem}, folder / "db", "EPSG:4326", 211u * 157u);
}

TEST(DatabaseHeights, SouthernHemisphereAndUnevenPixels)
{
    const TempDir folder;
    const auto dem = TestRaster(90, 160)
                         .placed(-70.3, -33.0, 0.0011, 0.0004)
                         .crs("EPSG:4326")
                         .fill([](int column, int row, int) { return relief(3.0 * column, row); })
                         .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "db"));
    expectAsGdalSays({dem}, folder / "db", "EPSG:4326", 90u * 160u);
}

TEST(DatabaseHeights, UtmToGeocentric)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 180, 140, 600000.0, 2380000.0, 30.0, "EPSG:32604");
    buildDatabase(options({dem}, folder / "db"));
    expectAsGdalSays({dem}, folder / "db", "EPSG:4326", 170u * 130u);
}

TEST(DatabaseHeights, GeographicToUtm)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 180, 140, -158.0, 21.5, 1.0 / 3600.0);
    buildDatabase(options({dem}, folder / "db", 32604));
    expectAsGdalSays({dem}, folder / "db", "EPSG:32604", 170u * 130u);
}

TEST(DatabaseHeights, RotatedGeotransform)
{
    const TempDir folder;
    const double size = 25.0, turn = 0.5;
    const auto dem = TestRaster(150, 120)
                         .geoTransform({600000.0, size * std::cos(turn), size * std::sin(turn), 2400000.0,
                                        size * std::sin(turn), -size * std::cos(turn)})
                         .crs("EPSG:32604")
                         .fill([](int column, int row, int) { return relief(column, row); })
                         .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "flat", 32604));
    expectAsGdalSays({dem}, folder / "flat", "EPSG:32604", 149u * 119u);
    buildDatabase(options({dem}, folder / "round"));
    expectAsGdalSays({dem}, folder / "round", "EPSG:4326", 149u * 119u);
}

TEST(DatabaseHeights, SouthUpRaster)
{
    const TempDir folder;
    const auto dem = TestRaster(60, 50)
                         .geoTransform({10.0, 0.001, 0.0, 45.0, 0.0, 0.001})
                         .crs("EPSG:4326")
                         .fill([](int column, int row, int) { return relief(column, row); })
                         .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "db"));
    expectAsGdalSays({dem}, folder / "db", "EPSG:4326", 60u * 50u);
}

TEST(DatabaseHeights, Oahu)
{
    const TempDir folder;
    // The Ko'olau ridge above Honolulu, or the whole island.
    const auto dem = fullTest() ? oahu : writeCrop(oahu, folder / "dem.tif", 1900, 1500, 500, 400);
    buildDatabase(options({dem}, folder / "db", 0, fullTest() ? 128 : 32));
    expectAsGdalSays({dem}, folder / "db", "EPSG:4326", fullTest() ? 3240u * 2700u : 500u * 400u);
    if (!fullTest()) return;
    buildDatabase(options({dem}, folder / "utm", 32604, 128));
    expectAsGdalSays({dem}, folder / "utm", "EPSG:32604", 3000u * 2500u);
}

/// GDAL mixes neighbouring files otherwise than we do only within a pixel of a border between them.
TEST(DatabaseHeights, LaterFileWinsAndNoDataShowsTheEarlierOne)
{
    const TempDir folder;
    const auto wide = writeRelief(folder / "wide.tif", 120, 100, 10.0, 45.0, 0.001);
    TestRaster raster(40, 30);
    raster.placed(10.04, 44.96, 0.001, 0.001)
        .crs("EPSG:4326")
        .dataset()
        .GetRasterBand(1)
        ->SetNoDataValue(-9999.0);
    const auto inset = raster.fill([](int column, int, int) { return column < 20 ? 2000.0 : -9999.0; })
                           .write(folder / "inset.tif");
    buildDatabase(options({wide, inset}, folder / "db"));
    const DatabaseRoot root(folder / "db");
    const FinestLevel level(folder / "db");
    for (std::size_t i = 0; i < level.world.size(); ++i)
    {
        ASSERT_TRUE(level.used[i]);
        const osg::Vec3d p = root.fromWorld(level.world[i]);
        const bool inside = p.x() > 10.0401 && p.x() < 10.0595 && p.y() > 44.9301 && p.y() < 44.9599;
        const bool outside = p.x() < 10.0395 || p.x() > 10.0615 || p.y() < 44.9295 || p.y() > 44.9605;
        ASSERT_TRUE(!inside || std::abs(p.z() - 2000.0) < 0.05) << p.x() << " " << p.y() << " " << p.z();
        ASSERT_TRUE(!outside || p.z() < 1100.0) << p.x() << " " << p.y() << " " << p.z();
    }
    // In the other order nothing of the inset is to be seen.
    buildDatabase(options({inset, wide}, folder / "other"));
    expectAsGdalSays({wide}, folder / "other", "EPSG:4326", 120u * 100u);
}

} // namespace
