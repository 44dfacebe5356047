// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// By which osggeofx_bench --check judges.
#include <bench/Report.h>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace
{

using geofx::bench::Bound;
using geofx::bench::Figure;
using geofx::bench::SuiteResult;

Figure figure(Bound bound, double asked, std::optional<double> measured)
{
    Figure result;
    result.name = "figure";
    result.bound = bound;
    result.asked = asked;
    result.measured = measured;
    return result;
}

TEST(BenchFigures, AreReachedOnTheRightSideOfWhatIsAsked)
{
    EXPECT_EQ(figure(Bound::None, 1.0, 5.0).reached(), std::nullopt);
    EXPECT_EQ(figure(Bound::None, 1.0, std::nullopt).reached(), std::nullopt);
    EXPECT_EQ(figure(Bound::Below, 1.0, 0.999).reached(), true);
    EXPECT_EQ(figure(Bound::Below, 1.0, 1.0).reached(), false);
    EXPECT_EQ(figure(Bound::AtMost, 1.0, 1.0).reached(), true);
    EXPECT_EQ(figure(Bound::AtMost, 1.0, 1.001).reached(), false);
    EXPECT_EQ(figure(Bound::AtLeast, 1.0, 1.0).reached(), true);
    EXPECT_EQ(figure(Bound::AtLeast, 1.0, 0.999).reached(), false);
    for (const Bound bound : {Bound::Below, Bound::AtMost, Bound::AtLeast})
        EXPECT_EQ(figure(bound, 1.0, std::nullopt).reached(), false) << "what was not measured falls short";
    EXPECT_EQ(figure(Bound::AtMost, 1.0, std::nan("")).reached(), false);
}

TEST(BenchFigures, OneThatFallsShortIsEnough)
{
    const Figure good = figure(Bound::AtLeast, 1.0, 2.0);
    const Figure told = figure(Bound::None, 0.0, 2.0);
    const Figure bad = figure(Bound::AtLeast, 3.0, 2.0);
    EXPECT_TRUE(geofx::bench::allReached({}));
    EXPECT_TRUE(geofx::bench::allReached({{"a", {good, told}}, {"b", {}}, {"c", {good}}}));
    EXPECT_FALSE(geofx::bench::allReached({{"a", {good, told}}, {"b", {good, bad, good}}}));
    EXPECT_FALSE(geofx::bench::allReached({{"a", {figure(Bound::Below, 1.0, std::nullopt)}}}));

    std::ostringstream table;
    geofx::bench::printTable(table, {}, {{"suite", {good, bad, figure(Bound::Below, 1.0, std::nullopt)}}});
    EXPECT_NE(table.str().find(">= 1   2         reached"), std::string::npos) << table.str();
    EXPECT_NE(table.str().find(">= 3   2         FALLS SHORT"), std::string::npos) << table.str();
    EXPECT_NE(table.str().find("< 1    -         NOT MEASURED"), std::string::npos) << table.str();
}

TEST(BenchFigures, MediansAreTheMiddle)
{
    EXPECT_EQ(geofx::bench::median({3.0}), 3.0);
    EXPECT_EQ(geofx::bench::median({9.0, 1.0, 4.0}), 4.0);
    EXPECT_EQ(geofx::bench::median({9.0, 1.0, 4.0, 2.0}), 3.0);
}

} // namespace
