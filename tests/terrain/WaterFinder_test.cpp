// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is water in heights alone, and the two sweeps against a plain flood fill.
#include <osgGeoFX/terrain/detail/WaterFinder.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr float HOLE = std::numeric_limits<float>::quiet_NaN();
constexpr double CELL = 900.0, LAKE = 40 * CELL; // square metres

struct Heights
{
    Heights(int c, int r, const std::function<double(int, int)>& height) : columns(c), rows(r)
    {
        for (int row = 0; row < rows; ++row)
        {
            auto& line = values.emplace_back();
            for (int column = 0; column < columns; ++column)
                line.push_back(static_cast<float>(height(column, row)));
        }
    }
    float at(int column, int row) const
    {
        return values[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    }
    int columns, rows;
    std::vector<std::vector<float>> values;
};

std::vector<std::vector<GroundKind>> found(const Heights& heights, double lakeArea = LAKE)
{
    WaterFinder finder(heights.columns, std::vector<double>(heights.values.size(), CELL), lakeArea);
    for (const auto& row : heights.values)
        finder.add(row);
    std::vector<std::vector<GroundKind>> result;
    for (auto row = heights.values.rbegin(); row != heights.values.rend(); ++row)
        result.insert(result.begin(), finder.mark(*row));
    return result;
}

int count(const std::vector<std::vector<GroundKind>>& ground, GroundKind wanted)
{
    int cells = 0;
    for (const auto& row : ground)
        cells += static_cast<int>(std::count(row.begin(), row.end(), wanted));
    return cells;
}

/// A rising plain with one height in a square of 8 × 8 cells.
Heights withSquare(double inside, double around = 100.0)
{
    return {30, 30,
            [=](int column, int row)
            {
                const bool square = column >= 10 && column < 18 && row >= 12 && row < 20;
                return square ? inside : around + 0.37 * column + 0.11 * row;
            }};
}

TEST(WaterFinder, LevelGroundAmidHigherIsALake)
{
    EXPECT_EQ(count(found(withSquare(95.0)), GroundKind::LAKE), 64);
    EXPECT_EQ(count(found(withSquare(95.0), 65 * CELL), GroundKind::LAKE), 0) << "it is too small";
}

/// Of a row of rows with the same cells measured.
int countMeasured(const Heights& heights, const std::function<bool(int, int)>& measured, GroundKind wanted)
{
    WaterFinder finder(heights.columns, std::vector<double>(heights.values.size(), CELL), LAKE);
    for (int row = 0; row < heights.rows; ++row)
    {
        std::vector<bool> cells;
        for (int column = 0; column < heights.columns; ++column)
            cells.push_back(measured(column, row));
        finder.add(heights.values[static_cast<std::size_t>(row)], cells);
    }
    int cells = 0;
    for (int row = heights.rows - 1; row >= 0; --row)
    {
        const auto line = finder.mark(heights.values[static_cast<std::size_t>(row)]);
        cells += static_cast<int>(std::count(line.begin(), line.end(), wanted));
    }
    return cells;
}

TEST(WaterFinder, WhatWasNotMeasuredMakesNoWater)
{
    const auto lake = withSquare(95.0), hollow = withSquare(-1.0);
    const auto notIn = [](int west, int east)
    {
        return [=](int column, int row)
        {
            return column < west || column >= east || row < 12 || row >= 20;
        };
    };
    EXPECT_EQ(countMeasured(lake, notIn(10, 18), GroundKind::LAKE), 0) << "all of it is filled";
    EXPECT_EQ(countMeasured(lake, notIn(10, 14), GroundKind::LAKE), 0) << "what is measured is too small";
    EXPECT_EQ(countMeasured(lake, notIn(10, 11), GroundKind::LAKE), 64) << "a lake with a void in it";
    EXPECT_EQ(countMeasured(withSquare(0.0), notIn(10, 18), GroundKind::SEA), 0);
    EXPECT_EQ(countMeasured(withSquare(0.0), notIn(10, 11), GroundKind::SEA), 64);
    EXPECT_EQ(countMeasured(hollow, notIn(10, 11), GroundKind::SEA), 0);
    // A void that the border cuts is no way in for the sea.
    const Heights cut(30, 30,
                      [](int column, int row) { return column < 4 && row < 4 ? -1.0 : 50.0 + column; });
    EXPECT_EQ(countMeasured(
                  cut, [](int, int) { return true; }, GroundKind::SEA),
              16);
    EXPECT_EQ(countMeasured(
                  cut, [](int column, int row) { return column >= 4 || row >= 4; }, GroundKind::SEA),
              0);
}

TEST(WaterFinder, TerracesAndSummitsAreLand)
{
    EXPECT_EQ(count(found(withSquare(130.0)), GroundKind::LAKE), 0);
    EXPECT_EQ(count(found(withSquare(106.7)), GroundKind::LAKE), 0) << "half of the rim is lower";
}

TEST(WaterFinder, LakesOfAnyShape)
{
    // A comb: bays to the south and to the north of a bar, and an island.
    const auto inLake = [](int column, int row)
    {
        if (column < 3 || column > 36 || row < 3 || row > 26) return false;
        if (row >= 13 && row <= 16) return !(column == 20 && row == 14);
        return row > 16 ? column % 4 == 0 : column % 4 == 2;
    };
    const Heights heights(40, 30,
                          [&](int column, int row)
                          { return inLake(column, row) ? 7.25 : 9.0 + 0.01 * column + 0.5 * row; });
    const auto ground = found(heights);
    for (int row = 0; row < 30; ++row)
        for (int column = 0; column < 40; ++column)
            EXPECT_EQ(ground[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)],
                      inLake(column, row) ? GroundKind::LAKE : GroundKind::LAND)
                << column << " " << row;
}

TEST(WaterFinder, ArmsThatMeetLate)
{
    // Two arms, each with a bay that ends before they meet.
    const auto inLake = [](int column, int row)
    {
        if (row < 3 || row > 20 || column < 5 || column > 25) return false;
        const int arm = std::min(std::abs(column - 5), std::abs(column - 25));
        return arm == 0 || row >= 19 || (arm == 1 && row == 5) || (arm == 2 && row >= 5 && row <= 9);
    };
    const auto ground = found(Heights(
        30, 30,
        [&](int column, int row) { return inLake(column, row) ? 7.25 : 9.0 + 0.01 * column + 0.5 * row; }));
    for (int row = 0; row < 30; ++row)
        for (int column = 0; column < 30; ++column)
            EXPECT_EQ(ground[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)],
                      inLake(column, row) ? GroundKind::LAKE : GroundKind::LAND)
                << column << " " << row;
}

TEST(WaterFinder, TheSeaReachesTheBorder)
{
    const auto ground = found(
        Heights(40, 30, [](int column, int row) { return column < 5 ? -row : 3.0 + column + 0.1 * row; }));
    EXPECT_EQ(count(ground, GroundKind::SEA), 5 * 30);
    EXPECT_EQ(count(found(withSquare(-60.0)), GroundKind::SEA), 0) << "a depression";
    EXPECT_EQ(count(found(withSquare(0.0)), GroundKind::SEA), 64) << "a lagoon";
}

TEST(WaterFinder, NoDataBesideLowLandIsTheSea)
{
    const auto bay = [](double shore)
    {
        return Heights(40, 30,
                       [=](int column, int row) {
                           return column < 5 ? static_cast<double>(HOLE)
                                             : shore + 2.0 * (column - 5) + 0.01 * row;
                       });
    };
    EXPECT_EQ(count(found(bay(0.3)), GroundKind::SEA), 5 * 30);
    EXPECT_EQ(count(found(bay(20.0)), GroundKind::SEA), 0);
    const Heights mostlyHigh(40, 30,
                             [](int column, int row)
                             {
                                 if (column < 5) return static_cast<double>(HOLE);
                                 return (row < 6 ? 0.3 : 20.0) + 2.0 * (column - 5) + 0.01 * row;
                             });
    EXPECT_EQ(count(found(mostlyHigh), GroundKind::SEA), 0);
    EXPECT_EQ(count(found(Heights(9, 9, [](int, int) { return HOLE; })), GroundKind::SEA), 0);
}

/// The areas of WaterFinder's rules, by flood fill.
GroundKind groundByFlood(const Heights& heights, int column, int row)
{
    const auto low = [](float height)
    {
        return height <= 0.0f;
    };
    const auto together = [&](float a, float b)
    {
        return std::isnan(a) ? std::isnan(b) : low(a) ? low(b) : a == b;
    };
    std::vector<std::vector<bool>> seen(heights.values.size(),
                                        std::vector<bool>(static_cast<std::size_t>(heights.columns)));
    std::vector<std::pair<int, int>> open{{column, row}};
    seen[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = true;
    int cells = 0, zeros = 0, rim = 0, lower = 0, lowRim = 0;
    bool border = false;
    while (!open.empty())
    {
        const auto [c, r] = open.back();
        open.pop_back();
        const float here = heights.at(c, r);
        ++cells;
        zeros += here == 0.0f;
        for (const auto& [dc, dr] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
        {
            const int nc = c + dc, nr = r + dr;
            if (nc < 0 || nr < 0 || nc >= heights.columns || nr >= heights.rows)
            {
                border = true;
                continue;
            }
            const float there = heights.at(nc, nr);
            if (!together(here, there))
            {
                border = border || std::isnan(there);
                rim += !std::isnan(there);
                lower += there < here;
                lowRim += there <= 1.0f;
            }
            else if (!seen[static_cast<std::size_t>(nr)][static_cast<std::size_t>(nc)])
            {
                seen[static_cast<std::size_t>(nr)][static_cast<std::size_t>(nc)] = true;
                open.emplace_back(nc, nr);
            }
        }
    }
    if (cells == 1) return GroundKind::LAND; // single cells are not looked at
    const float here = heights.at(column, row);
    const bool large = cells * CELL >= LAKE && cells >= 32;
    if (std::isnan(here)) return 3 * lowRim >= std::max(rim, 1) ? GroundKind::SEA : GroundKind::LAND;
    if (low(here)) return border || (large && 2 * zeros >= cells) ? GroundKind::SEA : GroundKind::LAND;
    return large && rim > 0 && 5 * lower <= rim ? GroundKind::LAKE : GroundKind::LAND;
}

TEST(WaterFinder, EqualsAFloodFill)
{
    int lakes = 0, sea = 0;
    for (int sample = 0; sample < sampleCount() / 100; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        // Waves cut to steps: shores with bays, terraces, islands, lakes within them, and holes.
        const double wave = random.uniform(0.15, 0.5), other = random.uniform(0.15, 0.5),
                     step = random.uniform(0.5, 4.0);
        const double up = random.uniform(-1.0, 8.0), hole = random.uniform(0.0, 14.0);
        const Heights heights(static_cast<int>(random.uniform(2.0, 60.0)),
                              static_cast<int>(random.uniform(2.0, 50.0)),
                              [&](int column, int row)
                              {
                                  const double height = up + 4.0 * std::sin(wave * column + 0.3 * row) *
                                                                 std::cos(other * row - 0.2 * column);
                                  if (height < up - 1.0 && up > 3.0) return 0.7 * up;
                                  if (height > hole) return static_cast<double>(HOLE);
                                  return height < 0.4 ? std::min(0.0, std::floor(height))
                                                      : step * std::floor(height / step) + 0.1;
                              });
        const auto ground = found(heights);
        for (int row = 0; row < heights.rows; ++row)
            for (int column = 0; column < heights.columns; ++column)
            {
                const GroundKind expected = groundByFlood(heights, column, row);
                ASSERT_EQ(ground[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)], expected)
                    << column << " " << row << " of " << heights.columns << " " << heights.rows;
                lakes += expected == GroundKind::LAKE;
                sea += expected == GroundKind::SEA;
            }
    }
    EXPECT_GT(lakes, 100);
    EXPECT_GT(sea, 100);
}

} // namespace
