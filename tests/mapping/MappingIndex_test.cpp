// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The grid over the plane: what it finds for a place is compared with all footprints, one by one.
#include "MappingModel.h"

#include <osgGeoFX/mapping/detail/MappingIndex.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <limits>
#include <vector>

using namespace geofx::test;

namespace
{

double milliseconds(std::chrono::steady_clock::time_point since)
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

} // namespace

class MappingIndexSizes : public testing::TestWithParam<std::size_t>
{
};

INSTANTIATE_TEST_SUITE_P(Counts, MappingIndexSizes, testing::Values(1, 16, 17, 256, 257, 1024, 65537),
                         [](const auto& each) { return std::to_string(each.param); });

TEST_P(MappingIndexSizes, findsWhatCoversAPlace)
{
    TexelArena arena;
    MappingIndex index(arena);
    const std::vector<Entry> entries = smallOnes(GetParam(), GetParam());
    ASSERT_TRUE(index.assign(entries));
    Model model;
    for (const Entry& entry : entries)
    {
        model.insert(entry);
    }
    Random random(7);
    model.compare(index, random, GetParam() > 2000 ? 300 : 10000);
    EXPECT_EQ(4 * std::size_t(arena.used()), wordsOf(index.statistics()));
    index.clear();
    EXPECT_EQ(arena.used(), 0u);
    EXPECT_EQ(index.root().block, 0u);
    EXPECT_TRUE(index.at({0, 0}).empty());
}

TEST(MappingIndex, anySizeShapeAndStack)
{
    Model model;
    Random random(11);
    const PlaneFootprint stacked = turnedRectangle({100, 200}, 500, 300, 0.5);
    for (std::uint64_t rank = 1; rank <= 2000; ++rank)
    {
        const int kind = random.integer(0, 9);
        const PlaneFootprint footprint = kind == 0   ? stacked
                                         : kind == 1 ? randomFootprint(random, 1e3, 2e4)
                                         : kind == 2 ? randomFootprint(random, 1e-3, 1.0)
                                                     : randomFootprint(random, 1.0, 300.0);
        ASSERT_TRUE(footprint.valid());
        model.insert(entryOf(rank, footprint));
    }
    TexelArena arena;
    MappingIndex index(arena);
    ASSERT_TRUE(index.assign(model.entries()));
    model.compare(index, random, 10000);
}

TEST(MappingIndex, edgesOfTheRootAndOfCells)
{
    // Footprints that end where cells do, and places on both sides of it, as float sees them.
    TexelArena arena;
    MappingIndex index(arena);
    Model model;
    for (std::uint64_t rank = 1; rank <= 900; ++rank)
    {
        const Vec2d low(static_cast<double>(rank % 30) * 32.0,
                        std::floor(static_cast<double>(rank) / 30.0) * 32.0);
        model.insert(entryOf(rank, PlaneFootprint::box(low, low + Vec2d(64, 64))));
    }
    ASSERT_TRUE(index.assign(model.entries()));
    for (const Entry& entry : model.entries())
    {
        for (const Vec2d& corner : entry.footprint.corners)
        {
            for (const double nudge : {-1e-5, 0.0, 1e-5})
            {
                const Ids found = index.at(corner + Vec2d(nudge, -nudge));
                ASSERT_NE(std::find(found.begin(), found.end(), entry.id), found.end());
            }
        }
    }
    EXPECT_TRUE(index.at({1e6, 0}).empty());
    EXPECT_TRUE(index.at({-1e6, 0}).empty());
    EXPECT_TRUE(index.at({std::numeric_limits<double>::quiet_NaN(), 0}).empty());
    EXPECT_TRUE(index.at({std::numeric_limits<double>::infinity(), 0}).empty());
}

TEST(MappingIndex, placesThatRoundingPutsIntoTheNextCell)
{
    TexelArena arena;
    MappingIndex index(arena);
    ASSERT_TRUE(index.insert(entryOf(1, PlaneFootprint::box({0.0, 0.0}, {1000.0, 1000.0}))));
    const MappingIndex::Root root = index.root();
    for (std::uint64_t column = 1; column < 8; ++column)
    {
        // As far before a cell's border as float does not tell from the border.
        const double border = root.origin.x() + root.size * static_cast<double>(column) / 8.0;
        const Vec2d high(border - 2e-9 * root.size, 600.0);
        if (high.x() < 100.0 || high.x() > 1000.0) continue;
        const Entry entry = entryOf(column + 1, PlaneFootprint::box(high - Vec2d(50.0, 200.0), high));
        ASSERT_TRUE(index.insert(entry));
        const Ids found = index.at({high.x() - 1e-9 * root.size, 500.0});
        EXPECT_NE(std::find(found.begin(), found.end(), entry.id), found.end()) << column;
    }
    EXPECT_EQ(index.root().size, root.size);
}

TEST(MappingIndex, farFromTheOrigin)
{
    for (const double far : {1e6, 1e7, 1e10})
    {
        TexelArena arena;
        MappingIndex index(arena);
        const Vec2d middle(far, -far);
        for (int i = 0; i < 100; ++i)
        {
            const Vec2d at = middle + gridPlace(i) * 2.0;
            ASSERT_TRUE(index.insert(
                entryOf(static_cast<std::uint64_t>(i + 1), PlaneFootprint::box(at, at + Vec2d(1, 1)))));
        }
        EXPECT_GE(index.root().size, std::ldexp(far, -24)) << "numbers are coarse";
        for (int i = 0; i < 100; ++i)
        {
            const Ids found = index.at(middle + gridPlace(i) * 2.0 + Vec2d(0.5, 0.5));
            const Entry entry = entryOf(static_cast<std::uint64_t>(i + 1), PlaneFootprint());
            EXPECT_NE(std::find(found.begin(), found.end(), entry.id), found.end());
        }
    }
}

TEST(MappingIndex, manyIdenticalOnesStayWithinTheBudget)
{
    constexpr std::size_t count = 65537;
    const PlaneFootprint same = turnedRectangle({0, 0}, 1000, 500, 0.3);
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < count; ++i)
    {
        entries.push_back(entryOf(i + 1, same));
    }
    TexelArena arena;
    MappingIndex index(arena);
    ASSERT_TRUE(index.assign(entries));
    EXPECT_LE(wordsOf(index.statistics()), 64 * count + (1u << 20));
    const Ids found = index.at({0, 0});
    ASSERT_EQ(found.size(), count);
    for (std::size_t i = 0; i < count; i += 100)
    {
        ASSERT_EQ(found[i], entries[i].id);
    }
    ASSERT_TRUE(index.erase(entries[30000].id));
    ASSERT_TRUE(index.insert(entries[30000]));
    EXPECT_EQ(index.at({0, 0}), found);
}

TEST(MappingIndex, refusesWhatMakesNoSense)
{
    TexelArena arena;
    MappingIndex index(arena);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const PlaneFootprint good = PlaneFootprint::box({0, 0}, {1, 1});
    const std::vector<PlaneFootprint> bad = {
        PlaneFootprint::box({0, 0}, {nan, 1}),
        PlaneFootprint::box({0, nan}, {1, 1}),
        PlaneFootprint::box({0, 0}, {infinity, 1}),
        PlaneFootprint::box({-infinity, 0}, {1, 1}),
        PlaneFootprint::box({0, 0}, {1e300, 1e300}),
        PlaneFootprint::box({0, 0}, {0, 1}),
        PlaneFootprint::box({5, 5}, {5, 5}),
        turnedRectangle({0, 0}, 100, 0, 0.5),
        {{Vec2d(0, 0), Vec2d(1, 1), Vec2d(1, 0), Vec2d(0, 1)}},      // crosses itself
        {{Vec2d(0, 0), Vec2d(4, 0), Vec2d(1, 1), Vec2d(0, 4)}},      // has a corner inwards
        {{Vec2d(0, 0), Vec2d(4, 0), Vec2d(0.1, 0.1), Vec2d(0, 4)}}}; // the same, an arrow
    ASSERT_TRUE(index.insert(entryOf(1, good)));
    for (const PlaneFootprint& footprint : bad)
    {
        EXPECT_FALSE(index.insert(entryOf(2, footprint)));
        EXPECT_FALSE(index.update(entryOf(1, {}).id, 1, footprint));
    }
    EXPECT_FALSE(index.insert(entryOf(1, good))) << "the id is there already";
    EXPECT_FALSE(index.update(12345, 1, good));
    EXPECT_FALSE(index.erase(12345));
    EXPECT_EQ(index.size(), 1u);
    EXPECT_EQ(index.at({0.5, 0.5}), (Ids{entryOf(1, {}).id}));
    ASSERT_TRUE(index.assign({entryOf(3, good), entryOf(4, bad[0]), entryOf(3, good)}));
    EXPECT_EQ(index.size(), 1u);
    // A triangle will do: two corners in one place.
    EXPECT_TRUE(index.insert(entryOf(5, {{Vec2d(0, 0), Vec2d(1, 0), Vec2d(1, 1), Vec2d(1, 1)}})));
}

TEST(MappingIndex, splitsOnlyWhereItPays)
{
    TexelArena arena;
    MappingIndex index(arena);
    std::vector<Entry> entries;
    for (std::uint64_t rank = 1; rank <= 200; ++rank)
    {
        entries.push_back(entryOf(rank, PlaneFootprint::box({-1000, -1000}, {1000, 1000})));
    }
    ASSERT_TRUE(index.assign(entries));
    const std::size_t blocks = index.statistics().blocks;
    for (std::uint64_t rank = 201; rank <= 220; ++rank)
    {
        entries.push_back(entryOf(rank, PlaneFootprint::box({10, 10}, {100, 100})));
    }
    ASSERT_TRUE(index.assign(entries));
    EXPECT_EQ(index.statistics().blocks, blocks) << "a list of 220 would become one of 200, 64 times";
}

TEST(MappingIndex, cellsFollowTheDensity)
{
    TexelArena arena;
    MappingIndex index(arena);
    for (const std::size_t count : {1000u, 10000u, 100000u})
    {
        const std::vector<Entry> entries = smallOnes(count, 31);
        const auto start = std::chrono::steady_clock::now();
        ASSERT_TRUE(index.assign(entries));
        const double time = milliseconds(start);
        const osgGeoFX::GridStatistics statistics = index.statistics();
        std::cout << count << " mappings: " << time << " ms, " << wordsOf(statistics) << " words, "
                  << statistics.blocks << " blocks, " << statistics.leaves << " lists, "
                  << statistics.meanList << " on the average, " << statistics.longestList
                  << " at most, levels " << statistics.levels << ", filled " << statistics.filledShare
                  << "\n";
        EXPECT_LT(statistics.meanList, 4.0);
        EXPECT_LE(wordsOf(statistics), 64 * count + (1u << 20));
    }
    // A town in a country: deep where it is dense, and nothing where there is nothing.
    std::vector<Entry> town = smallOnes(5000, 32);
    for (Entry& entry : town)
    {
        for (Vec2d& corner : entry.footprint.corners)
        {
            corner = corner * 0.05;
        }
    }
    town.push_back(entryOf(6000, PlaneFootprint::box({100e3, 100e3}, {101e3, 101e3})));
    ASSERT_TRUE(index.assign(town));
    EXPECT_LT(index.statistics().meanList, 4.0);
    EXPECT_TRUE(index.at({50e3, 50e3}).empty());
    EXPECT_EQ(index.at({100.5e3, 100.5e3}).size(), 1u);
}
