// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Lengths as people write them, and units as files have them.
#include <osgGeoFX/geodata/detail/Lengths.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace osgGeoFX;

namespace
{

TEST(Lengths, InWords)
{
    const auto metres = [](const char* text, double plain = 1.0)
    {
        return Lengths::read(text, plain).value_or(-1.0);
    };
    EXPECT_DOUBLE_EQ(metres("12.5"), 12.5);
    EXPECT_DOUBLE_EQ(metres("12.5", Lengths::METRES_PER_FOOT), 3.81);
    EXPECT_DOUBLE_EQ(metres("12.5 m", Lengths::METRES_PER_FOOT), 12.5);
    EXPECT_DOUBLE_EQ(metres("40 ft"), 12.192);
    EXPECT_DOUBLE_EQ(metres("12'6\""), 3.81);
    EXPECT_DOUBLE_EQ(metres("2,014 ft"), 2014 * 0.3048);
    EXPECT_DOUBLE_EQ(metres("2014 feet"), 2014 * 0.3048);
    EXPECT_DOUBLE_EQ(metres("2 014 m"), 2014.0);
    EXPECT_DOUBLE_EQ(metres("2\u202F014\u00A0"), -1.0) << "a space that does not break is no unit";
    EXPECT_DOUBLE_EQ(metres("2\u202F014 m"), 2014.0);
    EXPECT_DOUBLE_EQ(metres("2'014 m"), 2014.0);
    EXPECT_DOUBLE_EQ(metres("1,234,567 ft"), 1234567 * 0.3048);
    EXPECT_DOUBLE_EQ(metres("12,5 m"), 12.5);
    EXPECT_DOUBLE_EQ(metres("8,848.86"), 8848.86);
    EXPECT_DOUBLE_EQ(metres("-1,360 ft."), -1360 * 0.3048);
    EXPECT_DOUBLE_EQ(metres("+2014m"), 2014.0);
    EXPECT_DOUBLE_EQ(metres("1.2 km"), 1200.0);
    EXPECT_DOUBLE_EQ(metres("2014\u2032"), 2014 * 0.3048);
    EXPECT_DOUBLE_EQ(metres("20141 ft"), 20141 * 0.3048);
    EXPECT_DOUBLE_EQ(metres("2,014 ft (about)"), 2014 * 0.3048);
    EXPECT_DOUBLE_EQ(metres("40 ft; 42 ft"), 12.192);
    EXPECT_DOUBLE_EQ(metres("high"), -1.0);
    EXPECT_DOUBLE_EQ(metres(""), -1.0);
    EXPECT_DOUBLE_EQ(metres("12 storeys"), -1.0);
    EXPECT_TRUE(std::isnan(metres("nan")));
}

TEST(Lengths, Units)
{
    const double survey = 1200.0 / 3937.0;
    const std::pair<const char*, double> units[] = {{"m", 1},
                                                    {"Metres", 1},
                                                    {"metre", 1},
                                                    {"dm", 0.1},
                                                    {"cm", 0.01},
                                                    {"mm", 0.001},
                                                    {"km", 1000},
                                                    {"ft", 0.3048},
                                                    {"foot", 0.3048},
                                                    {"us-ft", survey},
                                                    {"ftUS", survey},
                                                    {"US_FT", survey},
                                                    {"US survey foot", survey},
                                                    {"U.S. Survey Feet", survey},
                                                    {"yd", 0.9144},
                                                    {"Fathom", 1.8288}};
    for (const auto& [word, metres] : units)
        EXPECT_EQ(Lengths::metresPerUnit(word).value_or(-1.0), metres) << word;
    for (const char* const word : {"", "degrees", "K", "metresque"})
        EXPECT_FALSE(Lengths::metresPerUnit(word)) << word;
}

} // namespace
