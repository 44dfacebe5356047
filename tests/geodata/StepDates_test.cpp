// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Dates in the names of files, and the order of names.
#include <osgGeoFX/geodata/detail/StepDates.h>
#include <osgGeoFX/mapping/LayerClock.h>

#include <gtest/gtest.h>

using namespace osgGeoFX;

namespace
{

TEST(StepDates, InNames)
{
    const auto at = [](const char* date)
    {
        return LayerClock::parseDate(date);
    };
    EXPECT_EQ(dateIn("LC08_L2SP_044034_20200315_20200822_02_T1"), at("2020-03-15"));
    EXPECT_EQ(dateIn("S2A_MSIL2A_20200315T184951_N0214_R070_T10SEG"), at("2020-03-15T18:49:51Z"));
    EXPECT_EQ(dateIn("rain_202601"), at("2026-01-01"));
    EXPECT_EQ(dateIn("rain_2026-02"), at("2026-02-01"));
    EXPECT_EQ(dateIn("rain_2026-01-12T06"), at("2026-01-12T06:00:00Z"));
    EXPECT_EQ(dateIn("2026011206"), at("2026-01-12T06:00:00Z"));
    EXPECT_EQ(dateIn("20260112063015"), at("2026-01-12T06:30:15Z"));
    EXPECT_EQ(dateIn("wind 2026-01-12 06:30"), at("2026-01-12T06:30:00Z"));
    EXPECT_EQ(dateIn("2026_01_12_v2"), at("2026-01-12"));
    EXPECT_EQ(dateIn("tile_1234567890"), std::nullopt);
    EXPECT_EQ(dateIn("step_123456"), std::nullopt);
    EXPECT_EQ(dateIn("step_20261399"), std::nullopt);
    EXPECT_EQ(dateIn(""), std::nullopt);
}

TEST(StepDates, NumbersInNamesStandByTheirValue)
{
    const char* const order[] = {"a", "a_1", "a_2", "a_2b", "a_007", "a_10", "b"};
    for (const auto& left : order)
        for (const auto& right : order)
            EXPECT_EQ(standsBefore(left, right), &left < &right) << left << " " << right;
}

} // namespace
