// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where a layer's slot lies: alone, on its own grid, with little waste, and free again afterwards.
#include <osgGeoFX/mapping/detail/LayerAtlas.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

using namespace osgGeoFX;
using geofx::test::Random;
using Slot = LayerAtlas::Slot;

namespace
{

/// Who holds each texel of each page; the plain way to see an overlap.
class Ground
{
public:
    Ground(int side, int pages) : _side(side), _taken(static_cast<std::size_t>(side) * side * pages) {}

    /// False where a texel is not as it was, or outside.
    bool change(const Slot& slot, bool from)
    {
        if (slot.page < 0 || slot.x < 0 || slot.y < 0 || slot.x + slot.side > _side ||
            slot.y + slot.side > _side)
            return false;
        for (int y = slot.y; y < slot.y + slot.side; ++y)
            for (int x = slot.x; x < slot.x + slot.side; ++x)
            {
                const std::size_t texel = (static_cast<std::size_t>(slot.page) * _side + y) * _side + x;
                if (_taken.at(texel) != from) return false;
                _taken[texel] = !from;
            }
        return true;
    }

private:
    int _side;
    std::vector<bool> _taken;
};

TEST(LayerAtlas, RandomUseNeverOverlapsAndLeavesNothingBehind)
{
    const int side = 64, maxPages = 4;
    for (int sample = 0; sample < 30; ++sample)
    {
        Random random(sample);
        LayerAtlas atlas(side, maxPages);
        Ground ground(side, maxPages);
        std::vector<Slot> slots;
        std::int64_t used = 0;
        const int steps = geofx::test::sampleCount() / 10;
        for (int step = 0; step < steps; ++step)
        {
            if (slots.empty() || random.integer(0, 99) < 60)
            {
                const int asked = 1 << random.integer(0, 5);
                const auto slot = atlas.add(asked);
                if (!slot) continue;
                ASSERT_EQ(slot->side, asked);
                ASSERT_EQ(slot->x % asked, 0);
                ASSERT_EQ(slot->y % asked, 0);
                ASSERT_LT(slot->page, atlas.pages());
                ASSERT_TRUE(ground.change(*slot, false));
                slots.push_back(*slot);
                used += asked * asked;
            }
            else
            {
                const int index = random.integer(0, static_cast<int>(slots.size()) - 1);
                std::swap(slots[index], slots.back());
                ASSERT_TRUE(ground.change(slots.back(), true));
                ASSERT_TRUE(atlas.release(slots.back()));
                ASSERT_FALSE(atlas.release(slots.back()));
                used -= slots.back().side * slots.back().side;
                slots.pop_back();
            }
            ASSERT_EQ(atlas.used(), used);
        }
        for (const Slot& slot : slots)
            ASSERT_TRUE(atlas.release(slot));
        EXPECT_EQ(atlas.used(), 0);
        // All merged: every page is one square again.
        for (int page = 0; page < maxPages; ++page)
            EXPECT_TRUE(atlas.add(side)) << page;
        EXPECT_FALSE(atlas.add(1));
    }
}

TEST(LayerAtlas, RefusesOnlyWhereNoSquareIsFree)
{
    for (int sample = 0; sample < 30; ++sample)
    {
        Random random(1000 + sample);
        LayerAtlas atlas(16, 2);
        Ground ground(16, 2);
        std::vector<Slot> slots;
        for (int step = 0; step < 300; ++step)
        {
            const int asked = 1 << random.integer(0, 4);
            if (const auto slot = atlas.add(asked))
            {
                ASSERT_TRUE(ground.change(*slot, false));
                slots.push_back(*slot);
            }
            else
            {
                for (int page = 0; page < 2; ++page)
                    for (int y = 0; y < 16; y += asked)
                        for (int x = 0; x < 16; x += asked)
                            ASSERT_FALSE(Ground(ground).change({page, x, y, asked}, false))
                                << "free, but refused: " << asked;
                for (int i = random.integer(1, 5); i > 0 && !slots.empty(); --i)
                {
                    const int index = random.integer(0, static_cast<int>(slots.size()) - 1);
                    ASSERT_TRUE(atlas.release(slots[index]));
                    ASSERT_TRUE(ground.change(slots[index], true));
                    slots.erase(slots.begin() + index);
                }
            }
        }
    }
}

TEST(LayerAtlas, EqualSlotsFillAPageWithoutWaste)
{
    LayerAtlas atlas(2048, 3);
    for (int i = 0; i < 64; ++i)
        EXPECT_EQ(atlas.add(256)->page, 0);
    EXPECT_EQ(atlas.pages(), 1);
    EXPECT_EQ(atlas.used(0), 2048 * 2048);
    EXPECT_EQ(atlas.add(256)->page, 1);
    EXPECT_EQ(atlas.add(2048)->page, 2);
    EXPECT_FALSE(atlas.add(2048));
    EXPECT_EQ(atlas.add(1024)->page, 1);
}

TEST(LayerAtlas, SmallSlotsTakeTheSmallestHole)
{
    LayerAtlas atlas(64, 4);
    std::vector<Slot> first(4), second(4);
    for (Slot& slot : first)
        slot = *atlas.add(32);
    for (Slot& slot : second)
        slot = *atlas.add(32);
    const Slot small = *atlas.add(8); // begins the third page
    ASSERT_EQ(small.page, 2);
    EXPECT_TRUE(atlas.release(first[1]));
    // The third page has squares of 8 left; the hole of 32 in the first stays whole.
    EXPECT_EQ(atlas.add(8)->page, 2);
    EXPECT_EQ(atlas.add(32)->page, 0);

    // Holes of one size: the fuller page's.
    EXPECT_TRUE(atlas.release(first[0]));
    EXPECT_TRUE(atlas.release(first[2]));
    EXPECT_TRUE(atlas.release(second[3]));
    EXPECT_EQ(atlas.add(32)->page, 1);
}

TEST(LayerAtlas, RefusesWhatIsNoSlot)
{
    LayerAtlas atlas(64, 2);
    for (const int side : {0, -1, -64, 3, 48, 65, 128, std::numeric_limits<int>::min(),
                           std::numeric_limits<int>::max(), 1 << 30})
        EXPECT_FALSE(atlas.add(side)) << side;
    EXPECT_EQ(atlas.pages(), 0);

    const Slot slot = *atlas.add(16);
    for (const Slot& wrong : {Slot{1, 0, 0, 16}, Slot{-1, 0, 0, 16}, Slot{0, 16, 0, 16}, Slot{0, 0, 0, 8},
                              Slot{0, 0, 0, 32}, Slot{0, 1, 0, 16}, Slot{0, -16, 0, 16}, Slot{0, 64, 0, 16},
                              Slot{0, 0, 0, 0}, Slot{0, 0, 1 << 20, 16}})
        EXPECT_FALSE(atlas.release(wrong));
    EXPECT_EQ(atlas.used(), 256);
    EXPECT_TRUE(atlas.release(slot));
    EXPECT_FALSE(atlas.release(slot));
}

TEST(LayerAtlas, LimitsOfTheConstructor)
{
    EXPECT_EQ(LayerAtlas(2048, 8).pageSide(), 2048);
    EXPECT_EQ(LayerAtlas(3000, 8).pageSide(), 2048);
    EXPECT_EQ(LayerAtlas(-5, 8).pageSide(), 1);
    EXPECT_EQ(LayerAtlas(1 << 20, -1).pageSide(), 32768);
    EXPECT_FALSE(LayerAtlas(2048, 0).add(1));
    EXPECT_FALSE(LayerAtlas(2048, -1).add(1));
    LayerAtlas largest(32768, 1);
    std::vector<Slot> slots(4);
    for (Slot& slot : slots)
        slot = *largest.add(16384);
    EXPECT_EQ(slots[3].x, 16384);
    EXPECT_EQ(slots[3].y, 16384);
    EXPECT_TRUE(largest.release(slots[3]));
    const Slot corner = *largest.add(1);
    EXPECT_TRUE(largest.release(corner));
    EXPECT_TRUE(largest.add(16384));
}

} // namespace
