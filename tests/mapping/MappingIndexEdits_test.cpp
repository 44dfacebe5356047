// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Mappings that come, go and move: the grid stays right, little changes, and nothing is left behind.
#include "MappingModel.h"

#include <osgGeoFX/mapping/detail/MappingIndex.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <vector>

using namespace geofx::test;

namespace
{

std::size_t bytesOf(const TexelArena::Changes& changes)
{
    std::size_t texels = 0;
    for (const TexelArena::Range& range : changes.ranges)
    {
        texels += range.count;
    }
    return texels * sizeof(TexelArena::Texel);
}

double milliseconds(std::chrono::steady_clock::time_point since)
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

} // namespace

TEST(MappingIndex, randomEditsLeaveNoTrace)
{
    TexelArena arena;
    MappingIndex index(arena);
    Model model;
    Random random(13);
    std::uint64_t newest = 0;
    for (int step = 0; step < 6000; ++step)
    {
        const bool growing = step / 1500 % 2 == 0;
        const int action = random.integer(0, 9);
        if (model.byRank.empty() || action < (growing ? 5 : 1))
        {
            const Entry entry =
                entryOf(++newest, randomFootprint(random, 1.0, random.integer(0, 30) ? 400.0 : 3e4));
            ASSERT_TRUE(index.insert(entry));
            model.insert(entry);
            continue;
        }
        auto found = model.byRank.lower_bound(
            static_cast<std::uint64_t>(random.uniform(0.0, static_cast<double>(newest))));
        if (found == model.byRank.end()) found = model.byRank.begin();
        Entry entry = found->second;
        model.byRank.erase(found);
        if (action < (growing ? 6 : 5))
        {
            ASSERT_TRUE(index.erase(entry.id));
            ASSERT_FALSE(index.erase(entry.id));
        }
        else
        {
            if (random.integer(0, 2) == 0) entry.rank = ++newest;
            if (random.integer(0, 2))
            {
                const Vec2d by(random.uniform(-300, 300), random.uniform(-300, 300));
                for (Vec2d& corner : entry.footprint.corners)
                {
                    corner += by;
                }
            }
            ASSERT_TRUE(index.update(entry.id, entry.rank, entry.footprint));
            model.insert(entry);
        }
        if (step % 250 == 0) model.compare(index, random, 1000);
        if (HasFatalFailure()) FAIL() << "step " << step;
    }
    model.compare(index, random, 3000);
    EXPECT_EQ(4 * std::size_t(arena.used()), wordsOf(index.statistics()));
    for (const Entry& entry : model.entries())
    {
        ASSERT_TRUE(index.size() > 2 || index.statistics().blocks == 1) << "what was split is merged";
        ASSERT_TRUE(index.erase(entry.id));
    }
    EXPECT_EQ(arena.used(), 0u);
    EXPECT_EQ(index.root().block, 0u);
}

TEST(MappingIndex, aMoveChangesLittle)
{
    TexelArena arena;
    MappingIndex index(arena);
    std::vector<Entry> entries = smallOnes(10000, 21);
    ASSERT_TRUE(index.assign(entries));
    arena.takeChanges();
    Random random(22);
    std::size_t most = 0;
    std::size_t sum = 0;
    double time = 0;
    const int moves = 3000;
    for (int i = 0; i < moves; ++i)
    {
        Entry& entry = entries[static_cast<std::size_t>(random.integer(0, 9999))];
        const Vec2d by(random.uniform(-100, 100), random.uniform(-100, 100));
        for (Vec2d& corner : entry.footprint.corners)
        {
            corner += by;
        }
        const auto start = std::chrono::steady_clock::now();
        ASSERT_TRUE(index.update(entry.id, entry.rank, entry.footprint));
        time += milliseconds(start);
        const TexelArena::Changes changes = arena.takeChanges();
        if (changes.all) continue; // the arena has grown
        most = std::max(most, bytesOf(changes));
        sum += bytesOf(changes);
    }
    std::cout << "a move of one of 10,000: " << sum / moves << " bytes, at most " << most << "; "
              << time / moves << " ms\n";
    EXPECT_LT(sum / moves, 1024u);
    EXPECT_LT(most, 8192u);
    Model model;
    for (const Entry& entry : entries)
    {
        model.insert(entry);
    }
    model.compare(index, random, 500);
}

TEST(MappingIndex, nothingChangesWhenNothingMoves)
{
    TexelArena arena;
    MappingIndex index(arena);
    const std::vector<Entry> entries = smallOnes(1000, 5);
    ASSERT_TRUE(index.assign(entries));
    arena.takeChanges();
    for (const Entry& entry : entries)
    {
        ASSERT_TRUE(index.update(entry.id, entry.rank, entry.footprint));
    }
    EXPECT_TRUE(arena.takeChanges().ranges.empty());
}

TEST(MappingIndex, theRootGrowsAndStays)
{
    TexelArena arena;
    MappingIndex index(arena);
    ASSERT_TRUE(index.insert(entryOf(1, PlaneFootprint::box({0, 0}, {100, 100}))));
    EXPECT_EQ(index.root().size, 256.0);
    const osg::Vec2d origin = index.root().origin;
    ASSERT_TRUE(index.update(entryOf(1, {}).id, 1, PlaneFootprint::box({10, 10}, {110, 110})));
    EXPECT_EQ(index.root().origin, origin);
    ASSERT_TRUE(index.insert(entryOf(2, PlaneFootprint::box({3000, 0}, {3100, 100}))));
    EXPECT_EQ(index.root().size, 8192.0);
    ASSERT_TRUE(index.update(entryOf(2, {}).id, 2, PlaneFootprint::box({0, 0}, {100, 100})));
    EXPECT_EQ(index.root().size, 8192.0);
    ASSERT_TRUE(index.update(entryOf(2, {}).id, 2, PlaneFootprint::box({-9000, 0}, {-8900, 100})));
    EXPECT_EQ(index.root().size, 16384.0);
    EXPECT_EQ(index.at({-8950, 50}), (Ids{entryOf(2, {}).id}));
    EXPECT_EQ(index.at({50, 50}), (Ids{entryOf(1, {}).id}));
    ASSERT_TRUE(index.update(entryOf(2, {}).id, 2, PlaneFootprint::box({5000, 0}, {5100, 100})));
    EXPECT_EQ(index.root().size, 16384.0) << "8192 would do";
    const Vec2d corner = index.root().origin;
    ASSERT_TRUE(index.update(entryOf(2, {}).id, 2,
                             PlaneFootprint::box(corner + Vec2d(1, 1), corner + Vec2d(900, 900))));
    EXPECT_EQ(index.root().origin, corner);
    EXPECT_EQ(index.at(corner + Vec2d(5, 5)), (Ids{entryOf(2, {}).id}));
    EXPECT_TRUE(index.at(corner + Vec2d(-5, 5)).empty());
    EXPECT_TRUE(index.at(corner + Vec2d(5, -5)).empty());
}

TEST(MappingIndex, aFullArenaLeavesTheFormerState)
{
    for (const std::uint32_t limit : {20u, 100u, 300u, 1000u, 2000u})
    {
        TexelArena arena;
        arena.setLimit(limit);
        MappingIndex index(arena);
        Model model;
        Random random(limit);
        int refused = 0;
        for (std::uint64_t rank = 1; rank <= 2500 && refused < 100; ++rank)
        {
            Entry entry = entryOf(rank, randomFootprint(random, 10.0, random.integer(0, 30) ? 500.0 : 2e4));
            const bool moves = refused > 20 && !model.byRank.empty() && random.integer(0, 1);
            if (moves)
            {
                // On top, and larger, so that it needs more room.
                entry = model.byRank.begin()->second;
                entry.rank = rank;
                const Vec2d middle = (entry.footprint.corners[0] + entry.footprint.corners[2]) / 2;
                for (Vec2d& corner : entry.footprint.corners)
                {
                    corner = middle + (corner - middle) * 10.0;
                }
            }
            if (moves ? index.update(entry.id, rank, entry.footprint) : index.insert(entry))
            {
                if (moves) model.byRank.erase(model.byRank.begin());
                model.insert(entry);
            }
            else
            {
                ++refused;
                model.compare(index, random, 50);
                ASSERT_EQ(4 * std::size_t(arena.used()), wordsOf(index.statistics()));
                ASSERT_FALSE(HasFatalFailure()) << "limit " << limit << ", rank " << rank;
            }
        }
        EXPECT_GT(refused, 0) << "limit " << limit;
        EXPECT_EQ(model.byRank.empty(), limit < 30);
        const std::vector<Entry> tooMany = smallOnes(5 * limit, 1);
        EXPECT_FALSE(index.assign(tooMany));
        model.compare(index, random, 1000);
        EXPECT_LE(arena.size(), limit);
        index.clear();
        EXPECT_EQ(arena.used(), 0u);
    }
}

TEST(MappingIndex, largeOnesOverManyCellsStayWithinTheBudget)
{
    TexelArena arena;
    MappingIndex index(arena);
    constexpr std::uint32_t limit = 300000;
    arena.setLimit(limit);
    ASSERT_TRUE(index.assign(smallOnes(5000, 3)));
    Random random(4);
    for (std::uint64_t i = 0; i < 60; ++i)
    {
        ASSERT_TRUE(index.insert(entryOf(10000 + i, randomFootprint(random, 2e4, 3e4))));
        ASSERT_LE(wordsOf(index.statistics()), 2u * limit + 500000);
    }
}
