// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is a void inside the data and what lies outside, and the two sweeps against a plain flood fill.
#include <osgGeoFX/terrain/detail/VoidFinder.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Rows of posts, the first the southernmost: '#' data, '~' data at the sea's height, '.' void, ' ' outside; 'o' filled.
using Map = std::vector<std::string>;

Post postOf(char c)
{
    return c == '#' || c == '~' ? Post::DATA : c == '.' ? Post::VOID : Post::OUTSIDE;
}

float heightOf(char c)
{
    return c == '~' ? 0.0f : 100.0f;
}

Map found(const Map& map, int reach = 100, bool wholeCircle = false)
{
    const auto columns = static_cast<int>(map.front().size()), rows = static_cast<int>(map.size());
    VoidFinder finder(columns, rows, reach, wholeCircle);
    std::vector<std::vector<Post>> posts;
    for (const std::string& line : map)
    {
        std::vector<float> heights;
        std::transform(line.begin(), line.end(), std::back_inserter(heights), heightOf);
        std::transform(line.begin(), line.end(), std::back_inserter(posts.emplace_back()), postOf);
        finder.add(posts.back(), heights);
    }
    Map result = map;
    for (int row = rows - 1; row >= 0; --row)
    {
        auto& line = posts[static_cast<std::size_t>(row)];
        const bool any = finder.mark(line);
        EXPECT_EQ(any, std::find(line.begin(), line.end(), Post::FILLED) != line.end());
        for (std::size_t c = 0; c < line.size(); ++c)
            if (line[c] == Post::FILLED) result[static_cast<std::size_t>(row)][c] = 'o';
    }
    return result;
}

/// The same by a flood fill, from the rules in the class's comment.
Map flooded(const Map& map, int reach, bool wholeCircle)
{
    const auto columns = static_cast<int>(map.front().size()), rows = static_cast<int>(map.size());
    const auto at = [&](int column, int row)
    {
        if (row < 0 || row >= rows || column < 0 || column >= columns) return ' ';
        return map[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    };
    Map result = map;
    std::vector<std::vector<bool>> seen(map.size(), std::vector<bool>(map.front().size()));
    for (int startRow = 0; startRow < rows; ++startRow)
        for (int startColumn = 0; startColumn < columns; ++startColumn)
        {
            std::vector<std::pair<int, int>> area;
            const auto visit = [&](int column, int row)
            {
                if (at(column, row) != '.') return;
                auto mark = seen[static_cast<std::size_t>(row)].begin() + column;
                if (!*mark) area.emplace_back(column, row);
                *mark = true;
            };
            visit(startColumn, startRow);
            int rim = 0, low = 0, edge = 0, square = 0;
            for (std::size_t next = 0; next < area.size(); ++next)
            {
                const auto [column, row] = area[next];
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx)
                    {
                        visit(column + dx, row + dy);
                        const int x = column + dx;
                        if ((dx != 0) == (dy != 0) || (wholeCircle && (x < 0 || x >= columns))) continue;
                        const char there = at(x, row + dy);
                        edge += there == ' ' ? 1 : 0;
                        rim += there == '#' || there == '~' ? 1 : 0;
                        low += there == '~' ? 1 : 0;
                    }
                if (wholeCircle && column == 0) visit(columns - 1, row);
                if (wholeCircle && column == columns - 1) visit(0, row);
                for (int side = square + 1;; ++side)
                {
                    bool fits = true;
                    for (int y = 0; y < side && fits; ++y)
                        for (int x = 0; x < side && fits; ++x)
                            fits = at(column + x, row + y) == '.';
                    if (!fits) break;
                    square = side;
                }
            }
            const bool isVoid = rim > 0 && square <= 2 * reach && edge <= 0.4 * (rim + edge) + 1e-9 &&
                                (edge == 0 || 3 * low < rim);
            for (const auto& [column, row] : area)
                if (isVoid) result[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = 'o';
        }
    return result;
}

TEST(VoidFinder, DataAroundMakeAVoid)
{
    EXPECT_EQ(found({"######", "##..##", "##.###", "######"}), (Map{"######", "##oo##", "##o###", "######"}));
}

TEST(VoidFinder, CornersAndBandsAlongTheEdgeAreOutside)
{
    const Map corner{"....##", "...###", "..####", ".#####", "######"};
    EXPECT_EQ(found(corner), corner);
    const Map band{"######", "######", "......"};
    EXPECT_EQ(found(band), band);
    const Map footprint{"   ####", "  .####", " ..####", "#######"};
    EXPECT_EQ(found(footprint), footprint) << "what is no raster's is an edge, too";
}

TEST(VoidFinder, WhatTheEdgeCutsIsAVoidNonetheless)
{
    EXPECT_EQ(found({"##....##", "##....##", "###..###", "########"}),
              (Map{"##oooo##", "##oooo##", "###oo###", "########"}));
    const Map sea{"~~....##", "~~....##", "~~~..###", "########"};
    EXPECT_EQ(found(sea), sea) << "a sea that was left out";
}

TEST(VoidFinder, LargeRegionsAreLeftOutOnPurpose)
{
    Map map(9, std::string(9, '#'));
    for (std::size_t row = 1; row < 8; ++row)
        map[row] = "#.......#";
    EXPECT_EQ(found(map, 3), map);
    EXPECT_EQ(found(map, 4)[4], "#ooooooo#");
    Map narrow(9, "####..###");
    narrow.front() = narrow.back() = "#########";
    EXPECT_EQ(found(narrow, 1)[4], "####oo###") << "a long one is not a large one";
}

TEST(VoidFinder, AroundTheGlobeTheSidesAreNoEdge)
{
    const Map map{"#######", "..###..", "..###..", "#######"};
    EXPECT_EQ(found(map, 100, true)[1], "oo###oo");
    const Map wide{"#######", "..###..", "..###..", "..###..", "..###.."};
    EXPECT_EQ(found(wide, 100, false), wide);
}

TEST(VoidFinder, AsAFloodFillFindsThem)
{
    Random random(14);
    int filled = 0, left = 0;
    for (int turn = 0; turn < (fullTest() ? 20000 : 2000); ++turn)
    {
        const int columns = random.integer(1, 24), rows = random.integer(1, 24), reach = random.integer(1, 3);
        const double missing = random.uniform(0.05, 0.7), outside = random.uniform(0.0, 0.1);
        Map map(static_cast<std::size_t>(rows), std::string(static_cast<std::size_t>(columns), '#'));
        for (std::string& line : map)
            for (char& c : line)
                c = random.uniform(0.0, 1.0) < missing   ? '.'
                    : random.uniform(0.0, 1.0) < outside ? ' '
                    : random.uniform(0.0, 1.0) < 0.2     ? '~'
                                                         : '#';
        const bool wholeCircle = columns > 2 && random.integer(0, 3) == 0;
        if (wholeCircle)
            for (std::string& line : map)
                line.back() = line.front();
        const Map expected = flooded(map, reach, wholeCircle), result = found(map, reach, wholeCircle);
        ASSERT_EQ(result, expected) << "turn " << turn << ", reach " << reach
                                    << (wholeCircle ? ", round" : "");
        for (const std::string& line : result)
        {
            filled += static_cast<int>(std::count(line.begin(), line.end(), 'o'));
            left += static_cast<int>(std::count(line.begin(), line.end(), '.'));
        }
    }
    EXPECT_GT(filled, 1000);
    EXPECT_GT(left, 1000);
}

} // namespace
