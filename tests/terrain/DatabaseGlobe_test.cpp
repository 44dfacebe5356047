// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Elevation of different density in one database: a coarse globe with a fine patch.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseReader.h>
#include <tools/FolderContents.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

// The patch, degrees: its outermost pixels' centers.
constexpr double WEST = 20.0, SOUTH = 40.0, STEP = 0.02;
constexpr int SIDE = 100;
constexpr double EAST = WEST + (SIDE - 1) * STEP, NORTH = SOUTH + (SIDE - 1) * STEP;
constexpr double VOID_WEST = 20.8, VOID_EAST = 21.2, VOID_SOUTH = 40.8, VOID_NORTH = 41.2;

double coarse(double longitude, double latitude)
{
    return 500.0 + 100.0 * std::sin(3.0 * longitude * osg::PI / 180.0) + 2.0 * latitude;
}

double fine(double longitude, double latitude)
{
    return coarse(longitude, latitude) + 300.0 +
           50.0 * std::sin(20.0 * longitude) * std::cos(20.0 * latitude);
}

std::string world(const std::filesystem::path& file)
{
    return TestRaster(180, 90)
        .placed(-180.0, 90.0, 2.0, 2.0)
        .crs("EPSG:4326")
        .fill([](int column, int row, int) { return coarse(-179.0 + 2.0 * column, 89.0 - 2.0 * row); })
        .write(file);
}

std::string patch(const std::filesystem::path& file, bool withVoid = false)
{
    TestRaster raster(SIDE, SIDE);
    raster.placed(WEST - 0.5 * STEP, NORTH + 0.5 * STEP, STEP, STEP).crs("EPSG:4326");
    raster.dataset().GetRasterBand(1)->SetNoDataValue(-9999.0);
    return raster
        .fill(
            [&](int column, int row, int)
            {
                const double x = WEST + STEP * column, y = NORTH - STEP * row;
                return withVoid && x > VOID_WEST && x < VOID_EAST && y > VOID_SOUTH && y < VOID_NORTH
                           ? -9999.0
                           : fine(x, y);
            })
        .write(file);
}

BuildOptions options(const std::vector<std::string>& dems, const std::filesystem::path& output)
{
    BuildOptions result;
    result.dems = dems;
    result.tileSize = 16;
    result.textureSize = 16;
    result.output = output.string();
    return result;
}

/// A tile's rectangle, degrees.
struct Rectangle
{
    double west, south, east, north;
};

Rectangle rectangle(const DatabaseRoot& root, const DatabaseTile& tile)
{
    // The quadtree is square, and its finest cells are as wide as they are high in posts.
    Rectangle result{1e9, 1e9, -1e9, -1e9};
    for (const auto& triangle : tile.surface)
        for (const unsigned int corner : triangle)
        {
            const osg::Vec3d place = root.fromWorld(tile.world(corner));
            result.west = std::min(result.west, place.x());
            result.east = std::max(result.east, place.x());
            result.south = std::min(result.south, place.y());
            result.north = std::max(result.north, place.y());
        }
    return result;
}

bool touchesPatch(const Rectangle& r, double margin)
{
    return r.west <= EAST + margin && r.east >= WEST - margin && r.south <= NORTH + margin &&
           r.north >= SOUTH - margin;
}

/// All corners of the leaves' ground: longitude, latitude, height.
std::vector<osg::Vec3d> leafPosts(const std::string& folder)
{
    const DatabaseRoot root(folder);
    std::vector<osg::Vec3d> posts;
    for (const auto& tile : readTiles(folder))
    {
        if (tile.lod) continue;
        std::set<unsigned int> corners;
        for (const auto& triangle : tile.surface)
            corners.insert(triangle.begin(), triangle.end());
        for (const unsigned int corner : corners)
            posts.push_back(root.fromWorld(tile.world(corner)));
    }
    return posts;
}

TEST(DatabaseGlobe, IsDeepWhereItsDataAreDense)
{
    const TempDir folder;
    const BuildSummary summary =
        buildDatabase(options({world(folder / "world.tif"), patch(folder / "patch.tif")}, folder / "db"));
    const DatabaseRoot root(folder / "db");
    std::map<int, int> leaves;
    bool deepInPatch = false;
    for (const auto& tile : readTiles(folder / "db"))
    {
        if (tile.lod) continue;
        ++leaves[tile.level];
        const Rectangle r = rectangle(root, tile);
        if (r.west >= WEST && r.east <= EAST && r.south >= SOUTH && r.north <= NORTH)
        {
            EXPECT_EQ(tile.level, root.finestLevel());
            deepInPatch = true;
        }
        // A block of eight tiles a side goes deep together.
        if (tile.level == root.finestLevel())
        {
            EXPECT_TRUE(touchesPatch(r, 8.0 * (r.east - r.west))) << r.west << " " << r.south;
        }
    }
    EXPECT_TRUE(deepInPatch);
    EXPECT_GE(leaves.size(), 2u) << "all leaves have one level";
    // With one density everywhere, the finest level alone would have 18,000 × 9,000 posts.
    EXPECT_LT(summary.samples, 1000000u);
    EXPECT_LT(summary.tiles, 2000u);
}

TEST(DatabaseGlobe, MayBeginWithLessThanATile)
{
    const TempDir folder;
    TestRaster raster(12, 6);
    const std::string few =
        raster.placed(-180.0, 90.0, 30.0, 30.0)
            .crs("EPSG:4326")
            .fill([](int column, int row, int) { return coarse(-165.0 + 30.0 * column, 75.0 - 30.0 * row); })
            .write(folder / "few.tif");
    const BuildSummary summary = buildDatabase(options({few, patch(folder / "patch.tif")}, folder / "db"));
    EXPECT_LT(summary.tiles, 2000u);
    int inside = 0;
    for (const osg::Vec3d& post : leafPosts(folder / "db"))
    {
        const double border = 0.21 * (EAST - WEST);
        if (post.x() < WEST + border || post.x() > EAST - border || post.y() < SOUTH + border ||
            post.y() > NORTH - border)
            continue;
        ++inside;
        ASSERT_NEAR(post.z(), fine(post.x(), post.y()), 3.0) << post.x() << " " << post.y();
    }
    EXPECT_GT(inside, 2000);
}

TEST(DatabaseGlobe, HasTheHeightsOfItsFiles)
{
    const TempDir folder;
    buildDatabase(options({world(folder / "world.tif"), patch(folder / "patch.tif")}, folder / "db"));
    int inside = 0, outside = 0;
    for (const osg::Vec3d& post : leafPosts(folder / "db"))
    {
        const double x = std::remainder(post.x(), 360.0), y = post.y();
        // Heights blend over a fifth of the patch at each of its borders.
        const double border = 0.21 * (EAST - WEST);
        if (x > WEST + border && x < EAST - border && y > SOUTH + border && y < NORTH - border)
        {
            ++inside;
            // Bilinear samples of waves of 0.3° at steps of 0.02°.
            ASSERT_NEAR(post.z(), fine(x, y), 3.0) << x << " " << y;
        }
        else if (!(x > WEST - STEP && x < EAST + STEP && y > SOUTH - STEP && y < NORTH + STEP) &&
                 std::abs(x) < 179.0)
        {
            ++outside;
            // What floats lose in a tile as large as a continent, and what is lost between samples 2° apart.
            ASSERT_NEAR(post.z(), coarse(x, y), 2.0) << x << " " << y;
        }
    }
    EXPECT_GT(inside, 2000);
    EXPECT_GT(outside, 10000);
}

TEST(DatabaseGlobe, BlendsAtTheBorderOfDenserData)
{
    const TempDir folder;
    buildDatabase(options({world(folder / "world.tif"), patch(folder / "patch.tif")}, folder / "db"));
    // Without a blend the patch would stand 300 m above the ground around it, from one post to the next.
    std::map<std::pair<long, long>, double> heights;
    for (const osg::Vec3d& post : leafPosts(folder / "db"))
    {
        const double x = std::remainder(post.x(), 360.0);
        if (x > WEST - 0.3 && x < EAST + 0.3 && post.y() > SOUTH - 0.3 && post.y() < NORTH + 0.3)
            heights[{std::lround(x * 1e4), std::lround(post.y() * 1e4)}] = post.z();
    }
    ASSERT_GT(heights.size(), 5000u);
    double steepest = 0.0;
    const std::pair<const std::pair<long, long>, double>* before = nullptr;
    for (const auto& post : heights)
    {
        if (before && before->first.first == post.first.first &&
            post.first.second - before->first.second < 250)
            steepest = std::max(steepest, std::abs(post.second - before->second));
        before = &post;
    }
    EXPECT_GT(steepest, 5.0);
    EXPECT_LT(steepest, 60.0);
}

TEST(DatabaseGlobe, FillsVoidsFromCoarserData)
{
    const TempDir folder;
    const auto summary = buildDatabase(
        options({world(folder / "world.tif"), patch(folder / "patch.tif", true)}, folder / "db"));
    EXPECT_EQ(summary.filledShare, 0.0) << "nothing is left to be made up";
    int inside = 0;
    for (const osg::Vec3d& post : leafPosts(folder / "db"))
        if (post.x() > VOID_WEST + STEP && post.x() < VOID_EAST - STEP && post.y() > VOID_SOUTH + STEP &&
            post.y() < VOID_NORTH - STEP)
        {
            ++inside;
            ASSERT_NEAR(post.z(), coarse(post.x(), post.y()), 2.0) << post.x() << " " << post.y();
        }
    EXPECT_GT(inside, 50);
}

TEST(DatabaseGlobe, HasTheSameBytesAfterAnInterruption)
{
    const TempDir folder;
    const auto dems = std::vector{world(folder / "world.tif"), patch(folder / "patch.tif", true)};
    buildDatabase(options(dems, folder / "whole"));
    auto o = options(dems, folder / "resumed");
    o.threads = 1;
    std::uint64_t stop = 0;
    for (const double share : {0.2, 0.5, 0.8})
    {
        EXPECT_THROW(buildDatabase(o,
                                   [&](std::uint64_t done, std::uint64_t total, const std::string&)
                                   {
                                       stop = static_cast<std::uint64_t>(share * static_cast<double>(total));
                                       return done < stop;
                                   }),
                     BuildError);
        o.resume = true;
    }
    EXPECT_GT(buildDatabase(o).tilesReused, 0u);
    EXPECT_EQ(contents(folder / "whole" / "tiles"), contents(folder / "resumed" / "tiles"));
}

} // namespace
