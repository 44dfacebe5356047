// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Topographic prominence, against flooding: the water rises until a summit's island joins one with higher ground.
#include <osgGeoFX/labels/Prominence.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

HeightField randomField(Random& random)
{
    HeightField field;
    field.columns = random.integer(3, 28);
    field.rows = random.integer(3, 28);
    field.wraps = random.integer(0, 3) == 0;
    const bool stepped = random.integer(0, 2) == 0; // with plateaus
    const bool holes = random.integer(0, 2) == 0;
    double kx[4], ky[4], phase[4], size[4];
    for (int i = 0; i < 4; ++i)
    {
        kx[i] = random.uniform(-1.2, 1.2);
        ky[i] = random.uniform(-1.2, 1.2);
        phase[i] = random.uniform(0.0, 6.28);
        size[i] = random.uniform(20.0, 400.0);
    }
    for (int row = 0; row < field.rows; ++row)
    {
        for (int column = 0; column < field.columns; ++column)
        {
            double height = 1000.0;
            for (int i = 0; i < 4; ++i)
                height += size[i] * std::sin(kx[i] * column + ky[i] * row + phase[i]);
            height += random.uniform(0.0, 30.0);
            if (stepped) height = 100.0 * std::round(height / 100.0);
            field.heights.push_back(holes && random.integer(0, 9) == 0 ? nothing
                                                                       : static_cast<float>(height));
        }
    }
    return field;
}

/// The cells that are reached from one over ground of at least a height.
std::set<int> island(const HeightField& field, int from, float least)
{
    std::set<int> found = {from};
    std::vector<int> open = {from};
    while (!open.empty())
    {
        const int cell = open.back();
        open.pop_back();
        for (int dy = -1; dy <= 1; ++dy)
        {
            for (int dx = -1; dx <= 1; ++dx)
            {
                int x = cell % field.columns + dx;
                const int y = cell / field.columns + dy;
                if (field.wraps) x = (x + field.columns) % field.columns;
                if (x < 0 || x >= field.columns || y < 0 || y >= field.rows) continue;
                const int next = y * field.columns + x;
                if (!(field.heights[static_cast<std::size_t>(next)] >= least)) continue;
                if (found.insert(next).second) open.push_back(next);
            }
        }
    }
    return found;
}

/// The prominence of a cell by flooding; 0 if a cell as high, which comes first, or a higher one is its neighbor.
float flooded(const HeightField& field, int cell)
{
    const auto heightOf = [&](int i)
    {
        return field.heights[static_cast<std::size_t>(i)];
    };
    const float height = heightOf(cell);
    std::set<float> levels;
    for (const float each : field.heights)
        if (each <= height) levels.insert(each);
    float last = height;
    for (auto level = levels.rbegin(); level != levels.rend(); ++level)
    {
        last = *level;
        for (const int other : island(field, cell, last))
            if (heightOf(other) > height || (heightOf(other) == height && other < cell)) return height - last;
    }
    // The highest of its island.
    const std::set<int> all = island(field, cell, -std::numeric_limits<float>::max());
    float lowest = height;
    for (const int other : all)
        lowest = std::min(lowest, heightOf(other));
    return height - lowest;
}

} // namespace

// 20 random DEMs: every cell's prominence is that of flooding.
TEST(Prominence, IsThatOfFlooding)
{
    Random random(11);
    for (int sample = 0; sample < 20; ++sample)
    {
        SCOPED_TRACE(sample);
        const HeightField field = randomField(random);
        std::vector<float> found(field.heights.size(), 0.0f);
        for (const Summit& summit : computeSummits(field, 0.0f))
        {
            const auto cell = static_cast<std::size_t>(summit.row * field.columns + summit.column);
            EXPECT_EQ(summit.height, field.heights[cell]);
            EXPECT_EQ(found[cell], 0.0f) << "named twice";
            found[cell] = summit.prominence;
        }
        for (std::size_t cell = 0; cell < found.size(); ++cell)
        {
            if (std::isnan(field.heights[cell])) continue;
            EXPECT_NEAR(found[cell], flooded(field, static_cast<int>(cell)), 1e-3) << cell;
        }
    }
}

TEST(Prominence, TheMostProminentComesFirstAndLowOnesAreLeftOut)
{
    Random random(12);
    HeightField field = randomField(random);
    while (computeSummits(field, 0.0f).size() < 12)
        field = randomField(random);
    const std::vector<Summit> all = computeSummits(field, 0.0f), high = computeSummits(field, 150.0f);
    ASSERT_GT(all.size(), high.size());
    ASSERT_GT(high.size(), 0u);
    for (std::size_t i = 0; i < high.size(); ++i)
    {
        EXPECT_GE(high[i].prominence, 150.0f);
        EXPECT_EQ(high[i].prominence, all[i].prominence);
        EXPECT_LE(high[i].prominence, high[i > 0 ? i - 1 : 0].prominence);
    }
}

// Nothing that is no summit, and nothing that is no ground.
TEST(Prominence, OfNoGroundAndOfAPlainThereIsNone)
{
    EXPECT_TRUE(computeSummits({}, 0.0f).empty());
    EXPECT_TRUE(computeSummits({4, 4, std::vector<float>(16, nothing), false}, 0.0f).empty());
    EXPECT_TRUE(computeSummits({4, 4, std::vector<float>(16, 7.0f), false}, 0.0f).empty());
    EXPECT_TRUE(computeSummits({4, 4, std::vector<float>(15, 7.0f), false}, 0.0f).empty())
        << "a cell is missing";
}
