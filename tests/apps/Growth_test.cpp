// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How osggeofx_bench tells what grows while it flies from what only goes up and down.
#include <bench/Growth.h>

#include <gtest/gtest.h>

#include <cmath>

using geofx::bench::Growth;

TEST(BenchGrowth, IsToldForTenThousandFrames)
{
    Growth growth;
    for (int frame = 0; frame < 100000; frame += 100)
        growth.add(frame, 300.0 + 2.5e-4 * frame + 20.0 * std::sin(0.01 * frame));
    EXPECT_NEAR(growth.slopeFrom(10000.0), 2.5, 0.05);
    EXPECT_NEAR(growth.typicalSlopeFrom(10000.0), 2.5, 0.05);
    EXPECT_NEAR(growth.medianWithin(10000.0, 40000.0), 306.25, 3.0);
}

TEST(BenchGrowth, LeavesOutWhatIsBefore)
{
    Growth growth;
    for (int frame = 0; frame < 100000; frame += 100)
        growth.add(frame, frame < 10000 ? 0.01 * frame : 100.0);
    EXPECT_NEAR(growth.slopeFrom(10000.0), 0.0, 1e-9);
    EXPECT_GT(growth.slopeFrom(0.0), 0.5);
}

TEST(BenchGrowth, AStepIsNotTypical)
{
    Growth growth;
    for (int frame = 0; frame < 100000; frame += 100)
        growth.add(frame, (frame < 20000 ? 300.0 : 700.0) + (frame / 100 % 2 ? 5.0 : 0.0));
    EXPECT_GT(growth.slopeFrom(10000.0), 10.0);
    EXPECT_NEAR(growth.typicalSlopeFrom(10000.0), 0.0, 0.1);
    EXPECT_NEAR(growth.typicalSlopeFrom(20000.0), growth.slopeFrom(20000.0), 0.1);
}

TEST(BenchGrowth, OfFewSamplesIsNone)
{
    Growth growth;
    EXPECT_EQ(growth.slopeFrom(0.0), 0.0);
    EXPECT_EQ(growth.typicalSlopeFrom(0.0), 0.0);
    EXPECT_EQ(growth.medianWithin(0.0, 10.0), 0.0);
    growth.add(5.0, 17.0);
    EXPECT_EQ(growth.slopeFrom(0.0), 0.0);
    EXPECT_EQ(growth.medianWithin(0.0, 10.0), 17.0);
    EXPECT_EQ(growth.medianWithin(0.0, 5.0), 0.0);
}
