// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The arena: what is allocated stays apart, what is given back can be had again, and an upload of the changes makes
// a copy equal.
#include <osgGeoFX/mapping/detail/TexelArena.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

using geofx::test::Random;
using osgGeoFX::TexelArena;

namespace
{

struct Piece
{
    std::uint32_t offset;
    std::uint32_t count;
    std::uint32_t mark;
};

void fill(TexelArena& arena, const Piece& piece)
{
    TexelArena::Texel* texels = arena.edit(piece.offset, piece.count);
    std::fill_n(texels, piece.count, TexelArena::Texel{piece.mark, 1, 2, 3});
}

bool isWhole(const TexelArena& arena, const Piece& piece)
{
    const auto first = arena.texels().begin() + piece.offset;
    return std::all_of(first, first + piece.count,
                       [&](const TexelArena::Texel& texel) { return texel[0] == piece.mark; });
}

std::uint32_t randomCount(Random& random)
{
    return static_cast<std::uint32_t>(random.logarithmic(1.0, random.integer(0, 20) ? 12.0 : 500.0));
}

/// What a texture buffer has after uploads.
struct Copy
{
    void upload(TexelArena& arena)
    {
        const TexelArena::Changes changes = arena.takeChanges();
        if (changes.all) texels.resize(arena.size());
        for (const TexelArena::Range& range : changes.ranges)
        {
            ASSERT_LE(range.first + range.count, texels.size());
            std::copy_n(arena.texels().begin() + range.first, range.count, texels.begin() + range.first);
        }
    }

    std::vector<TexelArena::Texel> texels;
};

/// An arena of 1,000 texels or more, and no changes.
TexelArena uploadedArena()
{
    TexelArena arena;
    arena.allocate(1000);
    arena.takeChanges();
    return arena;
}

std::vector<std::uint32_t> flat(const TexelArena::Changes& changes)
{
    std::vector<std::uint32_t> numbers;
    for (const TexelArena::Range& range : changes.ranges)
    {
        numbers.push_back(range.first);
        numbers.push_back(range.count);
    }
    return numbers;
}

using Numbers = std::vector<std::uint32_t>;

} // namespace

TEST(TexelArena, piecesStayApartAndAreGivenBack)
{
    TexelArena arena;
    std::vector<Piece> pieces;
    Random random(1);
    Copy copy;
    std::uint32_t used = 0;
    std::uint32_t mostUsed = 0;
    for (int step = 0; step < 20000; ++step)
    {
        if (pieces.empty() || random.integer(0, 99) < (step / 2500 % 2 ? 30 : 70))
        {
            const std::uint32_t count = randomCount(random);
            const std::uint32_t offset = arena.allocate(count);
            ASSERT_GT(offset, 0u);
            ASSERT_LE(offset + count, arena.size());
            pieces.push_back({offset, count, static_cast<std::uint32_t>(step + 1)});
            fill(arena, pieces.back());
            used += count;
        }
        else
        {
            std::swap(pieces[static_cast<std::size_t>(random.integer(0, int(pieces.size()) - 1))],
                      pieces.back());
            ASSERT_TRUE(isWhole(arena, pieces.back())) << "step " << step;
            arena.release(pieces.back().offset, pieces.back().count);
            used -= pieces.back().count;
            pieces.pop_back();
        }
        ASSERT_EQ(arena.used(), used);
        mostUsed = std::max(mostUsed, used);
        if (step % 50 == 0)
        {
            copy.upload(arena);
            ASSERT_TRUE(copy.texels == arena.texels()) << "step " << step;
        }
    }
    EXPECT_LE(arena.size(), 2 * mostUsed);
    for (const Piece& piece : pieces)
    {
        ASSERT_TRUE(isWhole(arena, piece));
        arena.release(piece.offset, piece.count);
    }
    EXPECT_EQ(arena.used(), 0u);
    const std::uint32_t size = arena.size();
    EXPECT_GT(arena.allocate(size / 4), 0u);
    EXPECT_EQ(arena.size(), size) << "free space is joined again";
}

TEST(TexelArena, takesNoMoreThanAsked)
{
    TexelArena arena;
    for (int i = 0; i < 1000; ++i)
    {
        arena.allocate(20);
    }
    for (int i = 0; i < 3000; ++i)
    {
        arena.allocate(4);
    }
    EXPECT_EQ(arena.used(), 32000u);
    EXPECT_LE(arena.size(), 48100u);
}

TEST(TexelArena, partsAreGivenBack)
{
    TexelArena arena;
    const std::uint32_t offset = arena.allocate(100);
    arena.release(offset + 37, 63);
    EXPECT_EQ(arena.used(), 37u);
    EXPECT_GT(arena.allocate(63), 0u);
    arena.release(offset, 37);
    EXPECT_EQ(arena.used(), 63u);
    const std::uint32_t size = arena.size();
    EXPECT_GT(arena.allocate(64), 0u);
    EXPECT_EQ(arena.size(), size);
}

TEST(TexelArena, keepsToItsLimit)
{
    TexelArena arena;
    arena.setLimit(1000);
    std::vector<std::uint32_t> offsets;
    while (const std::uint32_t offset = arena.allocate(10))
    {
        offsets.push_back(offset);
        ASSERT_LE(arena.size(), 1000u);
    }
    EXPECT_GT(offsets.size(), 60u);
    arena.takeChanges();
    const std::uint32_t size = arena.size();
    const std::uint32_t used = arena.used();
    EXPECT_EQ(arena.allocate(10), 0u);
    EXPECT_EQ(arena.allocate(2000000000u), 0u);
    EXPECT_EQ(arena.allocate(0xffffffffu), 0u);
    EXPECT_EQ(arena.allocate(0), 0u);
    EXPECT_EQ(arena.size(), size);
    EXPECT_EQ(arena.used(), used);
    const TexelArena::Changes changes = arena.takeChanges();
    EXPECT_FALSE(changes.all);
    EXPECT_TRUE(changes.ranges.empty());
    arena.release(offsets[3], 10);
    EXPECT_EQ(arena.allocate(10), offsets[3]);
}

TEST(TexelArena, changesAreSortedAndJoined)
{
    TexelArena arena = uploadedArena();
    arena.edit(60, 5);
    arena.edit(50, 6); // a gap of four
    arena.edit(70, 1); // a gap of five
    arena.edit(62, 1);
    arena.edit(71, 2);
    const TexelArena::Changes changes = arena.takeChanges();
    EXPECT_FALSE(changes.all);
    EXPECT_EQ(flat(changes), (Numbers{50, 15, 70, 3}));
    EXPECT_TRUE(arena.takeChanges().ranges.empty());
}

TEST(TexelArena, saysWhenAllIsToBeUploaded)
{
    TexelArena arena;
    TexelArena::Changes changes = arena.takeChanges();
    EXPECT_TRUE(changes.all);
    EXPECT_EQ(flat(changes), (Numbers{0, arena.size()}));
    arena.allocate(1000);
    EXPECT_TRUE(arena.takeChanges().all) << "grown";
    arena.edit(10, arena.size() / 4);
    EXPECT_FALSE(arena.takeChanges().all);
    arena.edit(10, arena.size() / 4 + 1);
    changes = arena.takeChanges();
    EXPECT_TRUE(changes.all);
    EXPECT_EQ(flat(changes), (Numbers{0, arena.size()}));
}

TEST(TexelArena, manyScatteredEditsAreNotLost)
{
    TexelArena arena;
    arena.allocate(400000);
    Copy copy;
    copy.upload(arena);
    Random random(2);
    for (std::uint32_t i = 1; i <= 30000; ++i)
    {
        (*arena.edit(static_cast<std::uint32_t>(random.integer(1, 399999)), 1))[3] = i;
    }
    copy.upload(arena);
    EXPECT_TRUE(copy.texels == arena.texels());
}
