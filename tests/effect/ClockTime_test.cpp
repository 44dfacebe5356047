// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/ClockTime.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace osgGeoFX;
using namespace geofx::test;

TEST(ClockTimeTest, ReadsWhatItWrites)
{
    Random random(2);
    for (int i = 0; i < 300; ++i)
    {
        const ClockTime time{std::floor(random.uniform(-6e9, 6e9)), 60 * random.integer(-14 * 60, 14 * 60)};
        const auto read = readClockTime(textOf(time));
        ASSERT_TRUE(read) << textOf(time);
        EXPECT_EQ(*read, time) << textOf(time);
    }
    EXPECT_EQ(textOf({0.0, -36000}), "1969-12-31T14:00:00-10:00");
    EXPECT_EQ(readClockTime("1970-01-01T00:00Z")->time, 0.0);
    EXPECT_EQ(readClockTime("2000-02-29T12:00:00.25+05:30")->time, 951805800.25);
}

TEST(ClockTimeTest, RefusesWhatIsNoTime)
{
    for (const std::string text : {"",
                                   "2026",
                                   "2026-06-21",
                                   "2026-06-21T08:00:00",
                                   "2026-06-31T08:00:00Z",
                                   "2026-02-29T08:00:00Z",
                                   "2026-13-01T08:00:00Z",
                                   "2026-00-10T08:00:00Z",
                                   "2026-06-00T08:00:00Z",
                                   "2026-06-21T24:00:00Z",
                                   "2026-06-21T08:60:00Z",
                                   "2026-06-21T08:00:60Z",
                                   "2026-06-21T08:00:0Z",
                                   "2026-06-21T08:00:00.Z",
                                   "2026-06-21T08:00:012Z",
                                   "2026-06-21T08:00:00+15:00",
                                   "2026-06-21T08:00:00+1:00",
                                   "2026-06-21T08:00:00 Z",
                                   " 2026-06-21T08:00:00Z",
                                   "2026-06-21T08:00:00ZZ",
                                   "+026-06-21T08:00:00Z",
                                   "2026-6-21T08:00:00Z",
                                   "0000-06-21T08:00:00Z",
                                   "2026-06-21 08:00:00Z",
                                   "2026-06-21T08:00:1e1Z"})
        EXPECT_FALSE(readClockTime(text)) << text;
}
