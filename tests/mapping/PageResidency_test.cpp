// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Which pages have a slot, what of them is drawn, and what shows until then.
#include <osgGeoFX/mapping/detail/PageDrawing.h>
#include <osgGeoFX/mapping/detail/PageResidency.h>
#include <osgGeoFX/mapping/detail/PageTable.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace osgGeoFX;

namespace
{

constexpr std::int64_t page = std::int64_t{MappingPage::side} * MappingPage::side;
constexpr PageResidency::Budget plenty{4 * page, 100 * page};

std::vector<MappingPage> square(int level, int side, std::int64_t x = 0)
{
    std::vector<MappingPage> cut;
    for (int j = 0; j < side; ++j)
    {
        for (int i = 0; i < side; ++i)
            cut.push_back({level, x + i, j});
    }
    return cut;
}

} // namespace

TEST(PageResidency, DrawsCoarsePagesFirstAndNoMoreThanTheBudget)
{
    PageResidency residency(200);
    const std::vector<MappingPage> cut = square(3, 8);
    int frames = 0;
    std::set<int> slots;
    std::vector<MappingPage> drawn;
    PageResidency::Frame frame;
    for (; !frame.settled && frames < 100; ++frames)
    {
        frame = residency.plan(cut, {4 * page, 2 * page});
        EXPECT_LE(frame.pieces.size(), 2u);
        for (const PageResidency::Piece& piece : frame.pieces)
        {
            EXPECT_TRUE(slots.insert(piece.slot).second);
            EXPECT_GT(piece.slot, 0);
            drawn.push_back(piece.page);
        }
    }
    EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
    // 64 pages, four two levels above, one four levels above.
    EXPECT_EQ(drawn.size(), 69u);
    EXPECT_EQ(frames, 35);
    EXPECT_TRUE(residency.plan(cut, plenty).pieces.empty());
}

TEST(PageResidency, ShowsCoarserPagesUntilThen)
{
    PageResidency residency(200);
    const std::vector<MappingPage> cut = square(3, 4);
    PageResidency::Frame frame = residency.plan(cut, {0, 1});
    // The coarsest one alone.
    EXPECT_TRUE(frame.complete);
    EXPECT_FALSE(frame.settled);
    EXPECT_EQ(frame.coarsest, 4);
    ASSERT_EQ(frame.sources.size(), cut.size());
    for (const PageResidency::Source& source : frame.sources)
        EXPECT_EQ(source.page, source.wanted.above(4));
    // And where there is none of another part of the plane.
    EXPECT_FALSE(residency.plan(square(3, 4, 1000), {0, 0}).complete);
}

TEST(PageResidency, DrawsChangesInTheSameFrameOrNot)
{
    PageResidency residency(200);
    const std::vector<MappingPage> cut = square(3, 4);
    ASSERT_TRUE(residency.plan(cut, plenty).settled);
    residency.change({{3.0, 3.0}, {4.0, 4.0}});
    PageResidency::Frame frame = residency.plan(cut, {page / 2, 0});
    EXPECT_TRUE(frame.settled);
    ASSERT_EQ(frame.pieces.size(), 1u);
    EXPECT_EQ(frame.pieces[0].page, (MappingPage{3, 0, 0}));
    EXPECT_TRUE(frame.pieces[0].part.contains({{3.0, 3.0}, {4.0, 4.0}}));
    EXPECT_FALSE(frame.pieces[0].part.contains({{2.0, 2.0}, {5.0, 5.0}}));
    // A soft edge and filters reach a texel beyond. What lies at the border of a page is on its neighbour's, too.
    const double texel = MappingPage::texelOf(3);
    EXPECT_TRUE(frame.pieces[0].part.contains({{3.0 - texel, 3.0}, {4.0, 4.0 + texel}}));
    residency.change({{7.9, 3.0}, {8.0 - texel, 4.0}});
    EXPECT_EQ(residency.plan(cut, {page / 2, 0}).pieces.size(), 2u);
    // Too much: nothing of it, until it has rested.
    residency.change({{-100.0, -100.0}, {100.0, 100.0}});
    frame = residency.plan(cut, plenty);
    EXPECT_FALSE(frame.complete);
    EXPECT_TRUE(frame.pieces.empty());
    int frames = 1;
    for (; !frame.settled && frames < 20; ++frames)
        frame = residency.plan(cut, plenty);
    EXPECT_TRUE(frame.settled);
    EXPECT_GT(frames, 2);
    // What lies elsewhere stays.
    residency.change({{500.0, 500.0}, {501.0, 501.0}});
    EXPECT_TRUE(residency.plan(cut, plenty).pieces.empty());
}

TEST(PageResidency, SettlesThoughSomethingMovesFromTheFirstFrameOn)
{
    PageResidency residency(200);
    const std::vector<MappingPage> cut = square(3, 8);
    PageResidency::Budget budget{4 * page, 2 * page, false};
    PageResidency::Frame frame;
    int frames = 0;
    for (; !frame.settled && frames < 100; ++frames)
    {
        const double at = 3.0 + 0.1 * frames;
        residency.change({{at, 3.0}, {at + 9.0, 9.0}});
        frame = residency.plan(cut, budget);
        // Nothing is drawn in vain before the pages can be shown.
        if (!frame.settled)
        {
            EXPECT_LE(frame.pieces.size(), 2u) << frames;
        }
    }
    EXPECT_TRUE(frame.settled);
    EXPECT_LT(frames, 45);
}

TEST(PageDrawing, KeepsToTheMemoryAndToTheLargestTexture)
{
    for (const int megabytes : {1, 7, 64, 512})
    {
        for (const int side : {1024, 4096, 8192, 16384})
        {
            const PageDrawing drawing(megabytes, side);
            EXPECT_LE(drawing.side(), side) << megabytes;
            EXPECT_LE(drawing.slots(), std::max(4, 4 * megabytes)) << side;
            EXPECT_GE(drawing.slots(), 4) << side;
            EXPECT_EQ(drawing.texture()->getTextureWidth(), drawing.columns() * MappingPage::side);
            EXPECT_EQ(drawing.texture()->getTextureHeight(), drawing.rows() * MappingPage::side);
        }
    }
    EXPECT_EQ(PageDrawing(512, 16384).slots(), 2048);
    EXPECT_EQ(PageDrawing(512, 4096).slots(), 256);
}

TEST(PageResidency, LetsGoOfThePagesThatWereNeededLongestAgo)
{
    PageResidency residency(24);
    ASSERT_TRUE(residency.plan(square(3, 3), plenty).settled);
    ASSERT_TRUE(residency.plan(square(3, 3, 1000), plenty).settled);
    EXPECT_EQ(residency.used(), 22);
    EXPECT_TRUE(residency.plan(square(3, 3), plenty).pieces.empty());
    ASSERT_TRUE(residency.plan(square(3, 3, 2000), plenty).settled);
    // Those of the first place were needed after those of the second.
    EXPECT_LE(residency.plan(square(3, 3), plenty).pieces.size(), 2u);
    EXPECT_FALSE(residency.plan(square(3, 5), plenty).fits);
}

TEST(PageTable, TellsWhichPageShowsAPlace)
{
    PageTable table;
    const std::vector<PageResidency::Source> sources = {{{3, 0, 0}, {3, 0, 0}, 5},
                                                        {{3, 1, 0}, {5, 0, 0}, 17},
                                                        {{4, 1, 1}, {4, 1, 1}, 9},
                                                        {{3, 0, -1}, {3, 0, -1}, 2}};
    ASSERT_TRUE(table.write(sources, 4));
    const auto word = [&](double x, double y)
    {
        const int column = static_cast<int>(std::floor((x - table.anchor().x()) * table.inverseCell()));
        const int row = static_cast<int>(std::floor((y - table.anchor().y()) * table.inverseCell()));
        return table.word(column - table.corner().first, row - table.corner().second);
    };
    const auto expected = [](int slot, int levels)
    {
        return static_cast<std::uint32_t>(slot % 4 | (slot / 4) << 8 | (127 - levels) << 16);
    };
    EXPECT_EQ(word(1.0, 1.0), expected(5, 0));
    EXPECT_EQ(word(9.0, 1.0), expected(17, 2));
    EXPECT_EQ(word(31.0, 17.0), expected(9, 1));
    EXPECT_EQ(word(17.0, 31.0), expected(9, 1));
    EXPECT_EQ(word(4.0, -1.0), expected(2, 0));
    EXPECT_EQ(word(1.0, 9.0), 0u);
    EXPECT_EQ(word(-1.0, 1.0), 0u);
    // Squares of the coarsest page begin at the anchor.
    EXPECT_EQ(std::fmod(table.anchor().x(), 32.0), 0.0);
    // Another texture after each change, and the same without.
    const osg::Texture2D* const before = table.texture();
    ASSERT_TRUE(table.write(sources, 4));
    EXPECT_EQ(table.texture(), before);
    ASSERT_TRUE(table.write({sources[0]}, 4));
    EXPECT_NE(table.texture(), before);
    EXPECT_EQ(word(1.0, 1.0), expected(5, 0));
    EXPECT_EQ(word(9.0, 1.0), 0u);
    // Too many squares between them.
    EXPECT_FALSE(table.write({{{3, 0, 0}, {3, 0, 0}, 5}, {{3, 5000, 0}, {3, 5000, 0}, 6}}, 4));
}
