// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Distances from the shore against those of every cell to every other.
#include <osgGeoFX/terrain/detail/ShoreDistance.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Rows = std::vector<std::vector<float>>;

Rows distancesOf(const CellMask& water, const CellMetres& metres)
{
    const TempDir folder;
    Rows result(static_cast<std::size_t>(water.rows));
    findShoreDistances(water, metres, folder / "rows",
                       [&](int row, const std::vector<float>& distances)
                       { result[static_cast<std::size_t>(row)] = distances; });
    return result;
}

CellMetres evenMetres(int rows, double x, double y)
{
    CellMetres metres;
    for (int row = 0; row < rows; ++row)
    {
        metres.x.push_back(x);
        metres.y.push_back(row * y);
    }
    return metres;
}

double bruteDistance(const CellMask& water, const CellMetres& metres, int column, int row)
{
    double nearest = 1e30;
    for (int r = 0; r < water.rows; ++r)
        for (int c = 0; c < water.columns; ++c)
        {
            if (water.at(c, r) == water.at(column, row)) continue;
            int columns = std::abs(c - column);
            if (metres.wholeCircle) columns = std::min(columns, water.columns - 1 - columns);
            nearest = std::min(nearest, std::hypot(columns * metres.x[static_cast<std::size_t>(row)],
                                                   metres.y[static_cast<std::size_t>(r)] -
                                                       metres.y[static_cast<std::size_t>(row)]));
        }
    return nearest;
}

TEST(ShoreDistance, EqualsThatToEveryCell)
{
    for (int sample = 0; sample < sampleCount() / 100; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const int columns = static_cast<int>(random.uniform(1.0, 45.0)),
                  rows = static_cast<int>(random.uniform(2.0, 40.0));
        CellMask water(columns, rows);
        const double share = random.uniform(0.0, 1.0);
        CellMetres metres = evenMetres(rows, 1.0, random.uniform(5.0, 60.0));
        for (int row = 0; row < rows; ++row)
        {
            metres.x[static_cast<std::size_t>(row)] = random.uniform(5.0, 60.0); // meridians converge
            for (int column = 0; column < columns; ++column)
                if (random.uniform(0.0, 1.0) < share * share * share) water.set(column, row);
        }
        metres.wholeCircle = columns > 2 && random.uniform(0.0, 1.0) < 0.5;
        for (int row = 0; row < rows && metres.wholeCircle; ++row)
            if (water.at(0, row)) // the last column is the first
                water.set(columns - 1, row);
            else if (water.at(columns - 1, row))
                water.set(0, row);
        const double stepY = metres.y[1];
        const Rows found = distancesOf(water, metres);
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
            {
                const double half = 0.5 * std::min(metres.x[static_cast<std::size_t>(row)], stepY);
                const double expected = std::min(bruteDistance(water, metres, column, row) - half, 1e6);
                ASSERT_NEAR(static_cast<double>(
                                found[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]),
                            water.at(column, row) ? expected : -expected, 1e-4 * std::max(1.0, expected))
                    << column << " " << row << " of " << columns << " " << rows;
            }
    }
}

TEST(ShoreDistance, TheShoreLiesBetweenTheCells)
{
    CellMask water(20, 10);
    for (int row = 0; row < 10; ++row)
        for (int column = 0; column < 8; ++column)
            water.set(column, row);
    const Rows found = distancesOf(water, evenMetres(10, 30.0, 30.0));
    for (std::size_t column = 0; column < 20; ++column)
        EXPECT_FLOAT_EQ(found[4][column], 30.0f * (7.5f - static_cast<float>(column)));
}

TEST(ShoreDistance, WithoutAShore)
{
    CellMask water(7, 5);
    EXPECT_FLOAT_EQ(distancesOf(water, evenMetres(5, 30.0, 30.0))[2][3], -1e6f);
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 7; ++column)
            water.set(column, row);
    EXPECT_FLOAT_EQ(distancesOf(water, evenMetres(5, 30.0, 30.0))[2][3], 1e6f);
}

} // namespace
