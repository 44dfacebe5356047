// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Voids of the elevation: filled inside the data, left alone outside, the same bytes always, and told of.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseTexels.h>
#include <tools/FolderContents.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

constexpr double NONE = -32768.0;

/// A height for each pixel, row 0 the northernmost.
struct Dem
{
    Dem(int c, int r, const std::function<double(int, int)>& height) : columns(c), rows(r)
    {
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                values.push_back(static_cast<float>(height(column, row)));
    }

    float& at(int column, int row)
    {
        return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)];
    }
    float at(int column, int row) const { return const_cast<Dem*>(this)->at(column, row); }

    std::string write(const fs::path& file, double west = 600000.0, double north = 2400000.0,
                      double cell = 30.0, const std::string& crs = "EPSG:32604") const
    {
        TestRaster raster(columns, rows);
        raster.placed(west, north, cell, cell).crs(crs);
        raster.dataset().GetRasterBand(1)->SetNoDataValue(NONE);
        return raster.fill([this](int column, int row, int) { return static_cast<double>(at(column, row)); })
            .write(file);
    }

    int columns, rows;
    std::vector<float> values;
};

/// The Ko'olau ridge above Honolulu.
Dem koolau()
{
    GDALAllRegister();
    const DatasetPtr file(GDALDataset::Open(GEOFX_SOURCE_DIR "/data/oahu/elevation.tif", GDAL_OF_RASTER));
    Dem dem(500, 400, [](int, int) { return 0.0; });
    if (!file || file->GetRasterBand(1)->RasterIO(GF_Read, 1900, 1500, 500, 400, dem.values.data(), 500, 400,
                                                  GDT_Float32, 0, 0, nullptr) != CE_None)
        throw std::runtime_error("GDAL cannot read the elevation of Oahu");
    return dem;
}

struct Hole
{
    int column, row;
    std::function<bool(int dx, int dy)> holds;
    int reach; ///< around its place, samples

    template<typename Visit>
    void visit(const Visit& visitor) const
    {
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx)
                if (holds(dx, dy)) visitor(column + dx, row + dy);
    }
    void cut(Dem& dem) const
    {
        visit(
            [&](int c, int r)
            {
                if (c >= 0 && c < dem.columns && r >= 0 && r < dem.rows)
                    dem.at(c, r) = static_cast<float>(NONE);
            });
    }
};

/// 4 × 5 samples, and a disc 20 across.
Hole twentySamples(int column, int row)
{
    return {column, row, [](int dx, int dy) { return dx >= 0 && dx < 4 && dy >= 0 && dy < 5; }, 5};
}
Hole twentyAcross(int column, int row)
{
    return {column, row, [](int dx, int dy) { return dx * dx + dy * dy <= 100; }, 10};
}

BuildOptions optionsFor(const std::vector<std::string>& dems, const fs::path& output, int epsg = 32604)
{
    BuildOptions result;
    result.dems = dems;
    result.epsg = epsg;
    result.tileSize = 16; // several units
    result.textureSize = 64;
    result.output = output.string();
    return result;
}

/// Heights of the finest posts by the pixels of a DEM that they lie on; NaN where there is no ground.
Dem builtHeights(const fs::path& database, const Dem& dem)
{
    const DatabaseRoot root(database);
    const FinestLevel level(database);
    EXPECT_EQ(level.columns, dem.columns);
    EXPECT_EQ(level.rows, dem.rows);
    return {dem.columns, dem.rows,
            [&](int column, int row)
            {
                const std::size_t index = level.index(column, level.rows - 1 - row);
                return level.used[index] ? root.fromWorld(level.world[index]).z()
                                         : std::numeric_limits<double>::quiet_NaN();
            }};
}

/// The range of the true heights around a hole, a margin of samples wide.
double reliefAround(const Dem& dem, const Hole& hole, int margin)
{
    float low = 1e9f, high = -1e9f;
    hole.visit(
        [&](int column, int row)
        {
            for (int r = row - margin; r <= row + margin; ++r)
                for (int c = column - margin; c <= column + margin; ++c)
                {
                    low = std::min(low, dem.at(c, r));
                    high = std::max(high, dem.at(c, r));
                }
        });
    return static_cast<double>(high - low);
}

class DatabaseVoids : public ::testing::Test
{
protected:
    TerrainInfo info(const std::string& folder) const
    {
        std::string error;
        const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(folder + "/terrain.osgb");
        const auto result = TerrainInfo::read(root, error);
        EXPECT_TRUE(result) << error;
        return result.value_or(TerrainInfo());
    }

    std::string path(const std::string& name) const { return (_folder / name).string(); }

    const TempDir _folder;
};

TEST_F(DatabaseVoids, FilledHeightsLieNearTheTrueOnes)
{
    const Dem whole = koolau();
    std::vector<Hole> small, large;
    Dem dem = whole;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x)
        {
            (y % 2 == 0 ? small : large)
                .push_back(y % 2 == 0 ? twentySamples(40 + 80 * x, 40 + 100 * y)
                                      : twentyAcross(40 + 80 * x, 40 + 100 * y));
            (y % 2 == 0 ? small : large).back().cut(dem);
        }
    const auto summary = buildDatabase(optionsFor({dem.write(path("dem.tif"))}, path("db")));
    const Dem built = builtHeights(path("db"), dem);
    const auto errorsOf = [&](const Hole& hole)
    {
        std::vector<double> errors;
        hole.visit([&](int c, int r)
                   { errors.push_back(std::abs(static_cast<double>(built.at(c, r) - whole.at(c, r)))); });
        return errors;
    };
    for (const Hole& hole : small)
    {
        const auto errors = errorsOf(hole);
        ASSERT_EQ(errors.size(), 20u);
        for (const double error : errors)
            EXPECT_LE(error, 0.15 * reliefAround(whole, hole, 5)) << hole.column << " " << hole.row;
    }
    // Nobody can know a summit within a hole as wide as a mountain: what holds there is the mean.
    for (const Hole& hole : large)
    {
        double squares = 0.0;
        const auto errors = errorsOf(hole);
        for (const double error : errors)
            squares += error * error / static_cast<double>(errors.size());
        EXPECT_LE(std::sqrt(squares), 0.15 * reliefAround(whole, hole, 10)) << hole.column << " " << hole.row;
    }
    EXPECT_NEAR(summary.filledShare, (12 * 20 + 12 * 317) / 200000.0, 1e-9);
    EXPECT_EQ(summary.openShare, 0.0);
}

/// To the bit, in the tiles' own numbers, whether the holes are filled or kept.
TEST_F(DatabaseVoids, NothingOutsideThemChanges)
{
    const Dem whole = koolau();
    Dem dem = whole;
    for (const int x : {60, 200, 400})
        twentyAcross(x, x / 2 + 40).cut(dem);
    auto unharmed = optionsFor({whole.write(path("whole.tif"))}, path("whole"));
    unharmed.tileSize = 64;
    buildDatabase(unharmed);
    const std::string file = dem.write(path("dem.tif"));
    auto options = optionsFor({file}, path("filled"));
    options.tileSize = 64;
    buildDatabase(options);
    options.voids = Voids::KEEP;
    options.output = path("kept");
    buildDatabase(options);
    const FinestLevel expected(path("whole")), filled(path("filled")), kept(path("kept"));
    ASSERT_EQ(filled.world.size(), expected.world.size());
    int holes = 0;
    for (int row = 0; row < dem.rows; ++row)
        for (int column = 0; column < dem.columns; ++column)
        {
            const std::size_t index = expected.index(column, dem.rows - 1 - row);
            const bool hole = dem.at(column, row) == static_cast<float>(NONE);
            ASSERT_TRUE(filled.used[index]) << column << " " << row;
            ASSERT_TRUE(!hole || !kept.used[index]) << column << " " << row;
            holes += hole ? 1 : 0;
            if (hole) continue;
            ASSERT_EQ(filled.world[index], expected.world[index]) << column << " " << row;
            ASSERT_TRUE(!kept.used[index] || kept.world[index] == expected.world[index])
                << column << " " << row;
        }
    EXPECT_EQ(holes, 3 * 317);
    EXPECT_EQ(info(path("kept")).filledShare, 0.0);
    EXPECT_FALSE(info(path("kept")).filledMask.valid());
}

TEST_F(DatabaseVoids, TheOutsideStaysOutside)
{
    // A turned raster within its box, a void inside, one that the box's edge cuts, and one too large.
    Dem dem(220, 180,
            [](int column, int row)
            {
                const bool collar = row + column / 4 < 20 || column + row / 6 < 16;
                return collar ? NONE : 200.0 + relief(column, row);
            });
    const Dem before = dem;
    twentyAcross(60, 90).cut(dem);
    twentyAcross(219, 60).cut(dem);
    for (int row = 100; row < 150; ++row)
        for (int column = 110; column < 160; ++column)
            dem.at(column, row) = static_cast<float>(NONE);
    auto options = optionsFor({dem.write(path("dem.tif"))}, path("db"));
    options.voidReach = 20;
    const auto summary = buildDatabase(options);
    const Dem built = builtHeights(path("db"), dem);
    int open = 0, filled = 0;
    for (int row = 0; row < dem.rows; ++row)
        for (int column = 0; column < dem.columns; ++column)
        {
            const bool square = row >= 100 && row < 150 && column >= 110 && column < 160;
            const bool hasData = dem.at(column, row) != static_cast<float>(NONE);
            const bool shouldHave = !square && before.at(column, row) != static_cast<float>(NONE);
            // On the border of what stays empty, posts without a whole cell are not drawn.
            ASSERT_TRUE(!shouldHave || hasData || !std::isnan(built.at(column, row))) << column << " " << row;
            ASSERT_TRUE(shouldHave || std::isnan(built.at(column, row))) << column << " " << row;
            open += shouldHave ? 0 : 1;
            filled += shouldHave && !hasData ? 1 : 0;
        }
    EXPECT_NEAR(summary.openShare, open / (220.0 * 180.0), 1e-9);
    EXPECT_NEAR(summary.filledShare, filled / (220.0 * 180.0 - open), 1e-9);
    EXPECT_GT(filled, 317 + 160);
}

// As files have them that were made without care: a pit of 10 km, and a sea around a turned survey.
TEST_F(DatabaseVoids, HeightsThatAreNoneCountAsVoidsUnlessTheyAreAskedFor)
{
    const Dem whole(140, 120, [](int column, int row) { return 300.0 + relief(column, row); });
    const auto written = [&](const Dem& dem, const std::string& name)
    {
        TestRaster raster(dem.columns, dem.rows);
        raster.placed(600000.0, 2400000.0, 30.0, 30.0).crs("EPSG:32604");
        return raster.fill([&](int column, int row, int) { return static_cast<double>(dem.at(column, row)); })
            .write(path(name));
    };
    Dem pit = whole, survey = whole;
    for (int row = 50; row < 56; ++row)
        for (int column = 60; column < 70; ++column)
            pit.at(column, row) = -9999.0f;
    const auto isInside = [](int column, int row)
    {
        const double x = column - 69.5, y = row - 59.5;
        return std::abs(x + 0.4 * y) < 50.0 && std::abs(y - 0.4 * x) < 40.0;
    };
    for (int row = 0; row < survey.rows; ++row)
        for (int column = 0; column < survey.columns; ++column)
            if (!isInside(column, row)) survey.at(column, row) = 0.0f;
    for (const bool all : {false, true})
    {
        auto options = optionsFor({written(pit, "pit.tif")}, path(all ? "pit-all" : "pit"));
        options.allHeights = all;
        const auto summary = buildDatabase(options);
        EXPECT_EQ(summary.lowestHeight,
                  all ? -9999.0
                      : static_cast<double>(*std::min_element(whole.values.begin(), whole.values.end())));
        EXPECT_EQ(summary.highestHeight,
                  static_cast<double>(*std::max_element(whole.values.begin(), whole.values.end())));
        EXPECT_NEAR(summary.filledShare, all ? 0.0 : 60.0 / (140.0 * 120.0), 1e-9);
        EXPECT_NE(summary.heightUnits.find("metres"), std::string::npos) << summary.heightUnits;
        // Next to the pit, too, heights are as they were.
        const Dem built = builtHeights(options.output, whole);
        EXPECT_NEAR(static_cast<double>(built.at(59, 52)), static_cast<double>(whole.at(59, 52)), 0.05);
        EXPECT_EQ(built.at(64, 52) < -9000.0f, all);

        auto turned = optionsFor({written(survey, "survey.tif")}, path(all ? "survey-all" : "survey"));
        turned.allHeights = all;
        EXPECT_EQ(buildDatabase(turned).lowestHeight > 0.0, !all);
        const Dem seen = builtHeights(turned.output, whole);
        for (const auto& [column, row] :
             {std::pair(2, 2), std::pair(137, 2), std::pair(2, 117), std::pair(137, 117)})
            EXPECT_EQ(seen.at(column, row) == 0.0f, all) << column << " " << row;
        EXPECT_NEAR(static_cast<double>(seen.at(70, 60)), static_cast<double>(whole.at(70, 60)), 0.05);
    }
}

TEST_F(DatabaseVoids, WhereNoFileLiesIsNoVoid)
{
    // Three tiles of four, with a hole on the border between two of them, and one in the corner of all.
    const auto height = [](int column, int row)
    {
        return 300.0 + relief(column, row);
    };
    Dem all(121, 121, height);
    Hole seam = twentyAcross(30, 60), corner = twentyAcross(60, 60);
    seam.cut(all);
    corner.cut(all);
    std::vector<std::string> files;
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(0, 60), std::pair(60, 60)})
        files.push_back(Dem(61, 61, [&, x = x, y = y](int c, int r) { return all.at(x + c, y + r); })
                            .write(path("tile" + std::to_string(x + y) + std::to_string(x) + ".tif"),
                                   600000.0 + 30.0 * x, 2400000.0 - 30.0 * y));
    buildDatabase(optionsFor(files, path("db")));
    const Dem built = builtHeights(path("db"), all);
    seam.visit([&](int c, int r) { EXPECT_FALSE(std::isnan(built.at(c, r))) << c << " " << r; });
    for (int row = 0; row < 59; ++row)
        for (int column = 62; column < 121; ++column)
            ASSERT_TRUE(std::isnan(built.at(column, row))) << column << " " << row;
}

TEST_F(DatabaseVoids, AHoleInOneFileShowsTheOther)
{
    const Dem low(80, 80, [](int c, int r) { return 100.0 + 0.1 * relief(c, r); });
    Dem high(80, 80, [](int, int) { return 900.0; });
    twentyAcross(40, 40).cut(high);
    const auto summary =
        buildDatabase(optionsFor({low.write(path("low.tif")), high.write(path("high.tif"))}, path("db")));
    EXPECT_EQ(summary.filledShare, 0.0);
    EXPECT_NEAR(static_cast<double>(builtHeights(path("db"), low).at(40, 40)),
                static_cast<double>(low.at(40, 40)), 0.01);
}

TEST_F(DatabaseVoids, TheDatabaseTellsOfThem)
{
    Dem dem(300, 200, [](int c, int r) { return 300.0 + relief(c, r); });
    const Hole hole = twentyAcross(100, 50);
    hole.cut(dem);
    auto options = optionsFor({dem.write(path("dem.tif"))}, path("db"));
    const auto summary = buildDatabase(options);
    const TerrainInfo told = info(path("db"));
    EXPECT_NEAR(told.filledShare, 317.0 / 60000.0, 1e-12);
    EXPECT_EQ(told.filledShare, summary.filledShare);
    ASSERT_TRUE(told.filledMask.valid());
    EXPECT_EQ(told.filledMaskColumns, 300);
    EXPECT_EQ(told.filledMask->size(), 300u * 200u);
    for (int row = 0; row < 200; ++row)
        for (int column = 0; column < 300; ++column)
            ASSERT_EQ(told.filledAt(600015.0 + 30.0 * column, 2399985.0 - 30.0 * row) > 0.0,
                      dem.at(column, row) == static_cast<float>(NONE))
                << column << " " << row;
    EXPECT_EQ(told.filledAt(0.0, 0.0), 0.0);
    // A finished database is told of by itself.
    options.resume = true;
    EXPECT_EQ(buildDatabase(options).filledShare, summary.filledShare);
    const auto result =
        runProgram({builtProgram("osggeofx_build"), "--dem", path("dem.tif"), "--srs", "EPSG:32604",
                    "--tile-size", "16", "--texture-size", "64", "-o", path("again")});
    EXPECT_NE(result.standardOutput.find("Voids: 0.528 % of the heights are filled"), std::string::npos)
        << result.standardOutput << result.standardError;
}

TEST_F(DatabaseVoids, AMaskOfALargeRasterIsCoarser)
{
    Dem dem(2600, 60, [](int c, int r) { return 300.0 + 0.2 * relief(c, r); });
    dem.at(1300, 30) = static_cast<float>(NONE);
    auto options = optionsFor({dem.write(path("dem.tif"))}, path("db"));
    options.tileSize = 64;
    buildDatabase(options);
    const TerrainInfo told = info(path("db"));
    ASSERT_TRUE(told.filledMask.valid());
    EXPECT_EQ(told.filledMaskColumns, 1024);
    EXPECT_GT(told.filledAt(600015.0 + 30.0 * 1300, 2399985.0 - 30.0 * 30), 0.0);
    EXPECT_EQ(told.filledAt(600015.0 + 30.0 * 1310, 2399985.0 - 30.0 * 30), 0.0);
}

TEST_F(DatabaseVoids, AreNoWaterOfTheirOwn)
{
    // Land at 40 m that falls to a sea in the west; voids on it, on the coast, and in the sea.
    Dem dem(160, 120,
            [](int column, int row) { return column < 30 ? 0.0 : 0.4 * (column - 30) + 0.05 * row; });
    const Hole inland = twentyAcross(110, 40), coast = twentyAcross(34, 80), sea = twentyAcross(14, 30);
    for (const Hole& hole : {inland, coast, sea})
        hole.cut(dem);
    auto options = optionsFor({dem.write(path("dem.tif"))}, path("db"));
    options.lakeArea = 1e4;
    buildDatabase(options);
    constexpr unsigned int coverUnit = 7;
    int atSea = 0, onLand = 0;
    const int shore = static_cast<int>(std::lround(255.0 * glsl::geofx_shoreCode(0.0)));
    forEachTexel(path("db"), DatabaseRoot(path("db")).finestLevel(), coverUnit,
                 [&](double x, double y, const osg::Image& image, int column, int row)
                 {
                     const int c = static_cast<int>(std::floor((x - 600000.0) / 30.0));
                     const int r = static_cast<int>(std::floor((2400000.0 - y) / 30.0));
                     const int code =
                         image.data(static_cast<unsigned>(column), static_cast<unsigned>(row))[3];
                     const auto within = [&](const Hole& hole)
                     {
                         return hole.holds(c - hole.column, r - hole.row);
                     };
                     if (within(sea) && ++atSea)
                     {
                         EXPECT_GT(code, shore) << c << " " << r;
                     }
                     if (within(inland) && ++onLand)
                     {
                         EXPECT_LT(code, shore) << c << " " << r;
                     }
                     if (within(coast) && c > 32)
                     {
                         EXPECT_LE(code, shore) << c << " " << r;
                     }
                 });
    EXPECT_GT(atSea, 300);
    EXPECT_GT(onLand, 300);
}

TEST_F(DatabaseVoids, GetTheColorsOfTheirHeights)
{
    Dem dem(100, 100, [](int c, int r) { return 300.0 + relief(c, r); });
    twentyAcross(50, 50).cut(dem);
    const std::string file = dem.write(path("dem.tif"));
    const auto greyTexels = [&](Voids voids)
    {
        auto options = optionsFor({file}, path("db"));
        options.voids = voids;
        buildDatabase(options);
        int grey = 0;
        forEachTexel(path("db"), DatabaseRoot(path("db")).finestLevel(), 0,
                     [&](double, double, const osg::Image& image, int column, int row)
                     {
                         const unsigned char* rgb =
                             image.data(static_cast<unsigned>(column), static_cast<unsigned>(row));
                         grey += rgb[0] == 128 && rgb[1] == 128 && rgb[2] == 128 ? 1 : 0;
                     });
        return grey;
    };
    EXPECT_EQ(greyTexels(Voids::FILL), 0);
    EXPECT_GT(greyTexels(Voids::KEEP), 300);
}

TEST_F(DatabaseVoids, AreFilledAboveTheSeaWhereHeightsMoveToTheEllipsoid)
{
    Dem dem(60, 60, [](int, int) { return 0.0; });
    twentyAcross(30, 30).cut(dem);
    auto options = optionsFor({dem.write(path("dem.tif"), 500000.0, 4000000.0, 3000.0, "EPSG:32654")},
                              path("db"), 32654);
    options.vertical = VerticalDatum::Egm96;
    buildDatabase(options);
    const Dem built = builtHeights(path("db"), dem);
    // The geoid is smooth: across the hole it departs little from a plane, and hardly ever is it a plane itself.
    options.voids = Voids::KEEP;
    options.dems = {Dem(60, 60, [](int, int) { return 0.0; })
                        .write(path("whole.tif"), 500000.0, 4000000.0, 3000.0, "EPSG:32654")};
    options.output = path("whole");
    buildDatabase(options);
    const Dem whole = builtHeights(path("whole"), dem);
    for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 60; ++column)
            ASSERT_EQ(built.at(column, row), whole.at(column, row)) << column << " " << row;
}

TEST_F(DatabaseVoids, AcrossTheAntimeridianOfAWholeGlobe)
{
    TestRaster raster(144, 72);
    raster.placed(-180.0, 90.0, 2.5, 2.5).crs("EPSG:4326");
    raster.dataset().GetRasterBand(1)->SetNoDataValue(NONE);
    raster.fill(
        [](int column, int row, int)
        {
            const int x = column < 72 ? column : column - 144;
            return x * x + (row - 36) * (row - 36) <= 20 ? NONE : 2000.0 + 30.0 * x + 5.0 * row;
        });
    auto options = optionsFor({raster.write(path("dem.tif"))}, path("db"), 0);
    buildDatabase(options);
    const FinestLevel level(path("db"));
    const DatabaseRoot root(path("db"));
    for (int row = 0; row < level.rows; ++row)
    {
        const auto first = level.index(0, row), last = level.index(level.columns - 1, row);
        ASSERT_TRUE(level.used[first] && level.used[last]) << row;
        ASSERT_NEAR(root.fromWorld(level.world[first]).z(), root.fromWorld(level.world[last]).z(), 1.0)
            << row;
    }
    // From both sides, so it is the plane again.
    EXPECT_NEAR(root.fromWorld(level.world[level.index(0, 35)]).z(), 2000.0 + 5.0 * 36, 40.0);
}

/// The posts are the same however the work is cut, so the heights must be, too: a window shows what the whole would.
TEST_F(DatabaseVoids, TheSameHeightsHoweverTheWorkIsCut)
{
    Dem dem(300, 280, [](int c, int r) { return 300.0 + relief(c, r); });
    for (int row = 60; row < 220; ++row)
        for (int column = 60; column < 240; ++column)
            if ((column - 150) * (column - 150) + (row - 140) * (row - 140) < 70 * 70)
                dem.at(column, row) = static_cast<float>(NONE);
    auto options = optionsFor({dem.write(path("dem.tif"))}, path("small"));
    options.tileSize = 8; // units of 64 posts, smaller than the void
    buildDatabase(options);
    options.tileSize = 64; // one unit
    options.output = path("large");
    buildDatabase(options);
    const Dem small = builtHeights(path("small"), dem), large = builtHeights(path("large"), dem);
    for (int row = 0; row < dem.rows; ++row)
        for (int column = 0; column < dem.columns; ++column)
            ASSERT_EQ(small.at(column, row), large.at(column, row)) << column << " " << row;
}

/// Blobs of many sizes across the units' borders; a build that is stopped at each tenth of its way and taken up again.
TEST_F(DatabaseVoids, TheSameBytesForAnyThreadsAndInterruptions)
{
    Dem dem(260, 200, [](int c, int r) { return 300.0 + relief(c, r); });
    for (int i = 0; i < 60; ++i)
    {
        const int size = i % 12;
        Hole{(i * 97) % 260, (i * 61) % 200, [=](int dx, int dy) { return dx * dx + dy * dy <= size * size; },
             12}
            .cut(dem);
    }
    auto options = optionsFor({dem.write(path("dem.tif"))}, path("one"), 0);
    options.threads = 1;
    EXPECT_GT(buildDatabase(options).filledShare, 0.05);
    const auto expected = contents(path("one"));
    options.output = path("two");
    options.threads = 3;
    options.memoryMiB = 128;
    buildDatabase(options);
    EXPECT_TRUE(contents(path("two")) == expected);

    options.output = path("resumed");
    options.resume = true;
    int stops = 0;
    for (std::uint64_t limit = 1; limit < 10000; limit += 5)
    {
        try
        {
            std::uint64_t steps = 0;
            buildDatabase(options, [&](std::uint64_t, std::uint64_t, const std::string& phase)
                          { return phase != "voids" || ++steps < limit; });
            break;
        }
        catch (const BuildError&)
        {
            ++stops;
        }
    }
    EXPECT_GT(stops, 3);
    EXPECT_TRUE(contents(path("resumed")) == expected);
}

} // namespace
