// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The lattice of brush strokes: groups, chances, and that strokes stand equally dense on the screen at any zoom.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/detail/StrokeLattice.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <vector>

using namespace osgGeoFX;
using geofx::test::Random;

namespace
{

std::int64_t powerOf(std::int64_t index)
{
    std::int64_t power = 1;
    while (power < 65536 && index % (2 * power) == 0)
        power *= 2;
    return power;
}

struct Stroke
{
    osg::Vec2d place;
    double level;
    double threshold;
};

/// The strokes of a square of the lattice around its origin.
std::vector<Stroke> strokesOf(const StrokeLattice& lattice, int reach)
{
    std::vector<Stroke> strokes;
    for (int row = -reach; row <= reach; ++row)
    {
        for (int column = -reach; column <= reach; ++column)
        {
            // Somewhere on the lattice where no point is of an outstanding level.
            const std::int64_t c = column + 333333, r = row + 777777;
            strokes.push_back({lattice.place(c, r) - osg::Vec2d(333333.0, 777777.0),
                               0.5 * StrokeLattice::halfLevel(c, r),
                               lattice.chance(c, r, StrokeChance::Threshold)});
        }
    }
    return strokes;
}

/// Mean distance to the nearest other stroke, of those that are shown, over the wanted spacing.
double meanNearest(const std::vector<Stroke>& strokes, double wanted, double reach)
{
    const double spacing = std::exp2(wanted);
    std::map<std::pair<int, int>, std::vector<osg::Vec2d>> cells;
    const auto cell = [&](double at)
    {
        return static_cast<int>(std::floor(at / (2.0 * spacing)));
    };
    for (const Stroke& each : strokes)
        if (glsl::geofx_strokeScale(each.level, each.threshold, wanted) > 0.5)
            cells[{cell(each.place.x()), cell(each.place.y())}].push_back(each.place);
    double sum = 0.0;
    int count = 0;
    for (const auto& [at, places] : cells)
    {
        for (const osg::Vec2d& place : places)
        {
            if (std::max(std::abs(place.x()), std::abs(place.y())) > reach) continue;
            double nearest = 1e9;
            for (int dy = -1; dy <= 1; ++dy)
            {
                for (int dx = -1; dx <= 1; ++dx)
                {
                    const auto found = cells.find({at.first + dx, at.second + dy});
                    if (found == cells.end()) continue;
                    for (const osg::Vec2d& other : found->second)
                        if (other != place) nearest = std::min(nearest, (other - place).length());
                }
            }
            sum += nearest;
            ++count;
        }
    }
    return sum / count / spacing;
}

/// The share of the screen that strokes of the size of the wanted spacing would cover, without overlaps.
double drawnArea(const std::vector<Stroke>& strokes, double wanted, double reach)
{
    double sum = 0.0;
    for (const Stroke& each : strokes)
    {
        if (std::max(std::abs(each.place.x()), std::abs(each.place.y())) > reach) continue;
        const double scale = glsl::geofx_strokeScale(each.level, each.threshold, wanted);
        sum += scale * scale;
    }
    return sum * std::exp2(2.0 * wanted) / (4.0 * reach * reach);
}

TEST(StrokeLattice, GroupsAreTheHighestPowersOfTwoThatDivideBothIndices)
{
    for (std::int64_t row = -70; row <= 70; ++row)
    {
        for (std::int64_t column = -70; column <= 70; ++column)
        {
            const int half = StrokeLattice::halfLevel(column, row);
            const std::int64_t power = std::min(powerOf(column), powerOf(row));
            ASSERT_EQ(half == StrokeLattice::highest ? 65536 : std::int64_t{1} << (half / 2), power)
                << column << " " << row;
            if (half == StrokeLattice::highest) continue;
            ASSERT_EQ(half % 2 == 0, (column / power + row / power) % 2 != 0) << column << " " << row;
        }
    }
    EXPECT_EQ(StrokeLattice::halfLevel(0, 0), StrokeLattice::highest);
    EXPECT_EQ(StrokeLattice::halfLevel(65536 * 3, 65536 * 2), StrokeLattice::highest);
}

TEST(StrokeLattice, EachHalfLevelHalvesThePoints)
{
    std::map<int, int> counts;
    for (int row = 0; row < 256; ++row)
        for (int column = 0; column < 256; ++column)
            ++counts[StrokeLattice::halfLevel(column, row)];
    int left = 256 * 256;
    for (int half = 0; half < 16; ++half)
    {
        EXPECT_EQ(counts[half], left / 2) << half;
        left -= counts[half];
    }
}

TEST(StrokeLattice, ChancesAreEvenAndIndependent)
{
    const StrokeLattice lattice({}, nullptr);
    const StrokeChance all[] = {StrokeChance::East,  StrokeChance::North, StrokeChance::Cover,
                                StrokeChance::Cliff, StrokeChance::Seed,  StrokeChance::Threshold};
    constexpr int side = 200;
    for (const StrokeChance which : all)
    {
        double sum = 0.0, squares = 0.0, beside = 0.0, above = 0.0;
        for (int row = -side / 2; row < side / 2; ++row)
        {
            for (int column = -side / 2; column < side / 2; ++column)
            {
                const double x = lattice.chance(column, row, which) - 0.5;
                ASSERT_GE(x, -0.5);
                ASSERT_LT(x, 0.5);
                sum += x;
                squares += x * x;
                beside += x * (lattice.chance(column + 1, row, which) - 0.5);
                above += x * (lattice.chance(column, row + 1, StrokeChance::Cover) - 0.5);
            }
        }
        constexpr double count = side * side;
        // Five standard deviations of each mean.
        EXPECT_NEAR(sum / count, 0.0, 5.0 * std::sqrt(1.0 / 12.0 / count));
        EXPECT_NEAR(squares / count, 1.0 / 12.0, 0.002);
        EXPECT_NEAR(beside / count, 0.0, 5.0 / 12.0 / std::sqrt(count));
        EXPECT_NEAR(above / count, 0.0, 5.0 / 12.0 / std::sqrt(count));
    }
}

TEST(StrokeLattice, SeedsGiveOtherStrokes)
{
    StrokeParameters other;
    other.seed = 1;
    const StrokeLattice a({}, nullptr), b(other, nullptr);
    int same = 0;
    for (int i = 0; i < 1000; ++i)
        same += std::abs(a.chance(i, 5, StrokeChance::Cover) - b.chance(i, 5, StrokeChance::Cover)) < 0.01
                    ? 1
                    : 0;
    EXPECT_LT(same, 60);
}

TEST(StrokeLattice, StrokesStayWithinReachOfTheirPoints)
{
    StrokeParameters parameters;
    parameters.jitter = 0.3;
    const StrokeLattice lattice(parameters, nullptr);
    std::map<int, std::pair<double, int>> offsets;
    for (std::int64_t row = -40; row <= 40; ++row)
    {
        for (std::int64_t column = -40; column <= 40; ++column)
        {
            const int half = StrokeLattice::halfLevel(column, row);
            const osg::Vec2d off = lattice.place(column, row) -
                                   osg::Vec2d(static_cast<double>(column), static_cast<double>(row));
            ASSERT_LE(std::max(std::abs(off.x()), std::abs(off.y())), lattice.reach(half));
            ASSERT_DOUBLE_EQ(lattice.reach(half), 0.3 * std::exp2(0.5 * half));
            offsets[half].first += std::abs(off.x()) + std::abs(off.y());
            offsets[half].second += 2;
        }
    }
    // Of each level as far off as of the others, in its own spacing.
    for (int half = 0; half < 5; ++half)
        EXPECT_NEAR(offsets[half].first / offsets[half].second, 0.5 * lattice.reach(half),
                    0.07 * lattice.reach(half));
}

TEST(StrokeLattice, ColumnsCloseAtTheDateLine)
{
    const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    for (const double latitude : {0.0, 0.37, 1.2})
    {
        StrokeParameters parameters;
        parameters.referenceLatitude = latitude;
        const StrokeLattice lattice(parameters, ellipsoid);
        const std::int64_t around = lattice.columns();
        ASSERT_GT(around, 0);
        // Its step at that latitude is what was asked for, but for the rounding.
        const double step = 2.0 * osg::PI * 6378137.0 * std::cos(latitude) / static_cast<double>(around);
        EXPECT_NEAR(step, parameters.spacing, 0.04 * parameters.spacing);
        for (const std::int64_t column : {std::int64_t{0}, std::int64_t{17}, std::int64_t{-123456}})
        {
            EXPECT_EQ(StrokeLattice::halfLevel(column + around, 6), StrokeLattice::halfLevel(column, 6));
            EXPECT_EQ(lattice.chance(column + around, 6, StrokeChance::Seed),
                      lattice.chance(column, 6, StrokeChance::Seed));
            EXPECT_EQ(lattice.chance(column - around, 6, StrokeChance::Seed),
                      lattice.chance(column, 6, StrokeChance::Seed));
        }
        EXPECT_NEAR(
            lattice.columnNear(static_cast<double>(around) * 0.49, static_cast<double>(around) * -0.49),
            static_cast<double>(around) * -0.51, 1e-6);
    }
}

TEST(StrokeLattice, UpIsTheEllipsoidsNormal)
{
    const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    const StrokeLattice lattice({}, ellipsoid);
    Random random(1);
    for (int i = 0; i < 100; ++i)
    {
        const double longitude = random.uniform(-3.1, 3.1), latitude = random.uniform(-1.55, 1.55);
        osg::Vec3d world;
        ellipsoid->convertLatLongHeightToXYZ(latitude, longitude, 0.0, world.x(), world.y(), world.z());
        const osg::Vec3d up(std::cos(latitude) * std::cos(longitude),
                            std::cos(latitude) * std::sin(longitude), std::sin(latitude));
        EXPECT_LT((lattice.up(world) - up).length(), 1e-9);
    }
}

TEST(StrokeScale, GoesFromOneToNoughtAndNeverBack)
{
    for (const double level : {0.0, 0.5, 3.0})
    {
        for (const double threshold : {0.0, 0.3, 1.0})
        {
            double former = 1.0;
            for (double wanted = level - 1.0; wanted < level + 1.5; wanted += 0.001)
            {
                const double scale = glsl::geofx_strokeScale(level, threshold, wanted);
                ASSERT_LE(scale, former);
                ASSERT_GE(scale, 0.0);
                former = scale;
            }
            EXPECT_EQ(glsl::geofx_strokeScale(level, threshold, level - 0.1), 1.0);
            EXPECT_EQ(glsl::geofx_strokeScale(level, threshold, level + 0.6), 0.0);
            const double end = glsl::geofx_strokeEnd(level, threshold);
            EXPECT_NEAR(glsl::geofx_strokeScale(level, threshold, end), 0.5, 1e-12);
            EXPECT_GE(end, level);
            EXPECT_LE(end, level + 0.5);
        }
    }
}

TEST(StrokeScale, WantedLevelIsThatOfTheSpacing)
{
    EXPECT_NEAR(glsl::geofx_strokeWanted(8.0, 25.0, 0.32), 0.0, 1e-12);
    EXPECT_NEAR(glsl::geofx_strokeWanted(8.0, 25.0, 0.04), 3.0, 1e-12);
    EXPECT_TRUE(std::isfinite(glsl::geofx_strokeWanted(8.0, 25.0, 0.0)));
    EXPECT_EQ(glsl::geofx_strokeGrowth(2.0), 1.0);
    EXPECT_NEAR(glsl::geofx_strokeGrowth(-1.0), 2.0, 1e-12);
    EXPECT_EQ(glsl::geofx_strokeGrowth(-9.0), 3.0);
}

// Section 3.3: "maintain an even distribution of trees".
TEST(StrokeScale, StrokesStandEquallyDenseAtAnyZoom)
{
    const StrokeLattice lattice({}, nullptr);
    constexpr int reach = 200;
    const std::vector<Stroke> strokes = strokesOf(lattice, reach);
    std::vector<double> nearest, areas;
    // A zoom of 8.
    for (double wanted = 0.0; wanted <= 3.0; wanted += 0.25)
    {
        nearest.push_back(meanNearest(strokes, wanted, 0.85 * reach));
        areas.push_back(drawnArea(strokes, wanted, 0.85 * reach));
    }
    const auto [least, most] = std::minmax_element(nearest.begin(), nearest.end());
    const double middle = 0.5 * (*least + *most);
    RecordProperty("spread", std::to_string(*most / middle - 1.0));
    EXPECT_LT(*most / middle - 1.0, 0.15);
    EXPECT_GT(*least, 0.5);
    const auto [leastArea, mostArea] = std::minmax_element(areas.begin(), areas.end());
    EXPECT_LT(*mostArea / *leastArea, 1.15);
    std::cout << "mean nearest " << *least << ".." << *most << " of the wanted spacing; area " << *leastArea
              << ".." << *mostArea << std::endl;
}

TEST(StrokeScale, NothingPopsWhileZooming)
{
    const std::vector<Stroke> strokes = strokesOf(StrokeLattice({}, nullptr), 130);
    std::vector<double> changes;
    constexpr int steps = 200;
    // On the screen, without the growth of the lattice itself.
    const auto area = [&](double wanted)
    {
        return drawnArea(strokes, wanted, 110.0) / std::exp2(2.0 * wanted);
    };
    double former = area(0.0);
    for (int i = 1; i <= steps; ++i)
    {
        const double wanted = 3.0 * i / steps;
        const double now = area(wanted);
        changes.push_back(1.0 - now / former);
        former = now;
    }
    std::vector<double> sorted = changes;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[steps / 2];
    std::cout << "share of the strokes that goes in a step: median " << median << ", most " << sorted.back()
              << std::endl;
    EXPECT_GT(sorted.front(), 0.0);
    EXPECT_LT(sorted.back(), 2.0 * median);
}

TEST(StrokeShape, VariesWithinBounds)
{
    Random random(7);
    double least = 9.0, most = 0.0;
    for (int i = 0; i < 2000; ++i)
    {
        const double seed = random.integer(0, 32767) / 32767.0;
        for (const int kind :
             {glsl::GEOFX_STROKE_TREE, glsl::GEOFX_STROKE_CLIFF, glsl::GEOFX_STROKE_HOUSE,
              glsl::GEOFX_STROKE_CONIFER, glsl::GEOFX_STROKE_BLOCK, glsl::GEOFX_STROKE_TOWER})
        {
            const glsl::geofx_StrokeShape shape = glsl::geofx_strokeShape(kind, seed);
            ASSERT_GT(std::min(shape.size.x, shape.size.y), 0.1);
            ASSERT_LT(std::max(shape.size.x, shape.size.y), 1.9);
            ASSERT_LT(std::abs(shape.lean), 0.3);
            ASSERT_LT(std::abs(shape.tone), 0.5);
            // A brush has a middle, and ends within its rectangle.
            ASSERT_GT(glsl::geofx_strokeInside(kind, {0.0, 0.02}, seed), 0.0);
            for (double angle = 0.0; angle < 6.3; angle += 0.1)
            {
                const glsl::Vector2 out(1.15 * std::cos(angle), 1.15 * std::sin(angle));
                ASSERT_LT(glsl::geofx_strokeInside(kind, out, seed), 0.0)
                    << kind << " " << seed << " " << angle;
                const double lit = glsl::geofx_strokeLit(out, {-0.7, 0.7}, seed);
                ASSERT_TRUE(lit >= 0.0 && lit <= 1.0);
            }
            if (kind != glsl::GEOFX_STROKE_TREE) continue;
            least = std::min(least, shape.size.x * shape.size.y);
            most = std::max(most, shape.size.x * shape.size.y);
        }
    }
    EXPECT_GT(most / least, 2.0);
}

TEST(StrokeShape, ConifersStandAboveBroadleavesAndPointUp)
{
    Random random(8);
    const auto conifers = [&](double share)
    {
        int count = 0;
        for (int i = 0; i < 1000; ++i)
            count += glsl::geofx_strokeTree(share, random.integer(0, 32767) / 32767.0) ==
                     glsl::GEOFX_STROKE_CONIFER;
        return count;
    };
    EXPECT_EQ(conifers(0.2), 0);
    EXPECT_EQ(conifers(0.7), 1000);
    EXPECT_GT(conifers(0.45), 300);
    EXPECT_LT(conifers(0.45), 700);
    // A broadleaf is about as wide above its middle as below; a conifer is not.
    const auto width = [](int kind, double y)
    {
        double x = 0.0;
        while (x < 2.0 && glsl::geofx_strokeInside(kind, {x, y}, 0.3) > 0.0)
            x += 0.001;
        return x;
    };
    EXPECT_GT(width(glsl::GEOFX_STROKE_CONIFER, -0.5), 2.0 * width(glsl::GEOFX_STROKE_CONIFER, 0.5));
    EXPECT_LT(width(glsl::GEOFX_STROKE_TREE, -0.5), 2.0 * width(glsl::GEOFX_STROKE_TREE, 0.5));
}

/// The mean height of what a house is drawn as, the share of each kind, and that of gardens.
struct Street
{
    double height = 0.0, blocks = 0.0, towers = 0.0, gardens = 0.0;

    explicit Street(double middle)
    {
        constexpr int houses = 4000;
        Random random(9);
        for (int i = 0; i < houses; ++i)
        {
            const double seed = random.integer(0, 32767) / 32767.0;
            const int kind = glsl::geofx_strokeHouse(middle, seed);
            blocks += kind == glsl::GEOFX_STROKE_BLOCK ? 1.0 / houses : 0.0;
            towers += kind == glsl::GEOFX_STROKE_TOWER ? 1.0 / houses : 0.0;
            gardens += kind == glsl::GEOFX_STROKE_TREE ? 1.0 / houses : 0.0;
            if (kind == glsl::GEOFX_STROKE_TREE) continue;
            const double storeys = glsl::geofx_strokeStoreys(kind, middle, seed);
            EXPECT_TRUE(storeys > 0.3 && storeys < 1.5);
            height += glsl::geofx_strokeShape(kind, seed).size.y * storeys / houses;
        }
    }
};

TEST(StrokeShape, BlocksGetTallerWithTheTown)
{
    double former = 0.0;
    for (const double middle : {0.0, 0.25, 0.5, 0.75, 1.0})
    {
        const Street street(middle);
        std::cout << "middle " << middle << ": height " << street.height << ", blocks " << street.blocks
                  << ", towers " << street.towers << ", gardens " << street.gardens << '\n';
        EXPECT_GT(street.height, 1.1 * former) << middle;
        former = street.height;
        // Landmarks are few.
        EXPECT_LT(street.towers, 0.04);
    }
    const Street suburb(0.2), center(1.0);
    EXPECT_EQ(suburb.blocks, 0.0);
    EXPECT_GT(suburb.gardens, 0.1);
    EXPECT_GT(center.blocks, 0.35);
    EXPECT_GT(center.towers, 0.02);
    EXPECT_LT(center.gardens, 0.02);
    EXPECT_GT(center.height, 1.7 * suburb.height);
}

TEST(StrokeShape, TheMiddleOfATownIsWhereTheCoverHasMostOfIt)
{
    Random random(10);
    for (int i = 0; i < 2000; ++i)
    {
        const double town = random.uniform(0.0, 1.0), steepness = random.uniform(0.0, 0.5);
        const double shore = -random.logarithmic(1.0, 1e5);
        const double middle = glsl::geofx_townMiddle(town, steepness, shore);
        ASSERT_TRUE(middle >= 0.0 && middle <= 1.0);
        // More town, more even ground and a nearer harbor never make less of it.
        ASSERT_GE(glsl::geofx_townMiddle(std::min(town + 0.05, 1.0), steepness, shore), middle);
        ASSERT_GE(glsl::geofx_townMiddle(town, 0.8 * steepness, shore), middle);
        ASSERT_GE(glsl::geofx_townMiddle(town, steepness, 0.8 * shore), middle);
    }
    EXPECT_NEAR(glsl::geofx_townMiddle(1.0, 0.0, 0.0), 1.0, 1e-9);
    EXPECT_LT(glsl::geofx_townMiddle(0.6, 0.0, 0.0), 0.4) << "a small town has no blocks";
    EXPECT_LT(glsl::geofx_townMiddle(1.0, 0.3, -500.0), 0.4) << "nor has a slope";
    EXPECT_EQ(glsl::geofx_townMiddle(0.0, 0.0, 0.0), 0.0);
}

TEST(StrokeShape, SlopesHaveMoreStrokesTheSteeperTheyAre)
{
    constexpr double cliff = 1.2;
    EXPECT_EQ(glsl::geofx_strokeSlopes(0.0, cliff), 0.0);
    EXPECT_EQ(glsl::geofx_strokeSlopes(0.2, cliff), 0.0) << "hills and fields are smooth";
    EXPECT_GT(glsl::geofx_strokeSlopes(0.5 * cliff, cliff), 0.3) << "what a far tile has left of a cliff";
    double former = 0.0;
    for (double steepness = 0.0; steepness < 3.0; steepness += 0.05)
    {
        const double share = glsl::geofx_strokeSlopes(steepness, cliff);
        ASSERT_GE(share, former);
        ASSERT_LE(share - former, 0.15) << "no edge";
        ASSERT_LE(share, 1.0);
        former = share;
        ASSERT_LE(glsl::geofx_strokeDepth(steepness, cliff), glsl::geofx_strokeDepth(steepness + 0.1, cliff));
    }
    EXPECT_LT(glsl::geofx_strokeDepth(0.3, cliff), 0.6 * glsl::geofx_strokeDepth(1.2, cliff));
}

TEST(StrokeShape, IsSmallerTowardsTheHorizon)
{
    EXPECT_EQ(glsl::geofx_strokeShrink(0.0), 1.0);
    EXPECT_LT(glsl::geofx_strokeShrink(1.0), 0.7);
    EXPECT_GT(glsl::geofx_strokeShrink(0.3), glsl::geofx_strokeShrink(0.6));
}

} // namespace
