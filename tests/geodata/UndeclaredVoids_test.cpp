// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Heights that are none although no file says so are found, and coasts are left alone.
#include <osgGeoFX/geodata/detail/UndeclaredVoids.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gdalwarper.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class UndeclaredVoidsTest : public ::testing::Test
{
protected:
    std::string write(int columns, int rows, const std::function<double(int, int)>& height,
                      const char* unit = "", const std::vector<std::string>& options = {}) const
    {
        TestRaster raster(columns, rows);
        raster.placed(600000.0, 2400000.0, 30.0, 30.0).crs("EPSG:32604");
        raster.dataset().GetRasterBand(1)->SetUnitType(unit);
        return raster.fill([&](int column, int row, int) { return height(column, row); })
            .write(_folder / ("dem" + std::to_string(_files++) + ".tif"), options);
    }

    /// Finds them, and the warning.
    UndeclaredVoids look(const std::string& file)
    {
        UndeclaredVoids result;
        _messages = _watch.messagesOf([&] { result = UndeclaredVoids::of(file); });
        return result;
    }

    const TempDir _folder;
    NotifyWatch _watch;
    std::vector<std::string> _messages;
    mutable int _files = 0;
};

/// A survey of 0.7 of the raster's size, turned about its middle; how deep a pixel's center lies in it, pixels.
double depthInSurvey(int column, int row, int size, double degrees)
{
    const double turn = degrees * M_PI / 180.0, x = column + 0.5 - 0.5 * size, y = row + 0.5 - 0.5 * size;
    const double across = std::abs(x * std::cos(turn) + y * std::sin(turn));
    const double along = std::abs(y * std::cos(turn) - x * std::sin(turn));
    return std::min(0.35 * size - across, 0.32 * size - along);
}

} // namespace

TEST_F(UndeclaredVoidsTest, ASingleValueFarFromAllOthersIsNoHeight)
{
    for (const double none : {-9999.0, -32768.0, 32767.0, -99999.0, static_cast<double>(-3.4028235e38f)})
    {
        const UndeclaredVoids voids =
            look(write(100, 80, [&](int c, int r) { return c > 90 && r > 60 ? none : relief(c, r); }));
        EXPECT_TRUE(voids.has(none, 95, 70)) << none;
        EXPECT_FALSE(voids.has(relief(3, 4), 3, 4)) << none;
        ASSERT_EQ(_messages.size(), 1u) << none;
        EXPECT_NE(_messages[0].find("far from all other heights"), std::string::npos) << _messages[0];
        EXPECT_NE(_messages[0].find("--all-heights"), std::string::npos) << _messages[0];
    }
}

TEST_F(UndeclaredVoidsTest, AnyValueFarFromAllOthersAlongTheBorderIsNoHeight)
{
    for (const auto& [columns, rows] : {std::pair(3, 30), std::pair(30, 2)})
        for (const bool atEnd : {false, true})
        {
            const auto height = [&](int c, int r)
            {
                return (atEnd ? 99 - c < columns && 79 - r < rows : c < columns && r < rows) ? 5000.0
                                                                                             : relief(c, r);
            };
            EXPECT_TRUE(look(write(100, 80, height)).has(5000.0, 0, 0)) << columns << " " << atEnd;
        }
    // Within, such a value may be a tower's.
    EXPECT_FALSE(
        look(write(100, 80, [&](int c, int r) { return c == 50 && r == 40 ? 5000.0 : relief(c, r); }))
            .has(5000.0, 50, 40));
    EXPECT_TRUE(
        look(write(100, 80, [&](int c, int r) { return c == 50 && r == 40 ? 32767.0 : relief(c, r); }))
            .has(32767.0, 50, 40));
}

TEST_F(UndeclaredVoidsTest, SeveralSuchValuesAreFound)
{
    const UndeclaredVoids voids =
        look(write(100, 80,
                   [&](int c, int r) {
                       return c > 90 ? -9999.0 : r > 70 ? -32768.0 : r < 2 ? 1e20 : relief(c, r);
                   }));
    for (const double none : {-9999.0, -32768.0, static_cast<double>(1e20f)})
        EXPECT_TRUE(voids.has(none, 0, 0)) << none;
    EXPECT_EQ(_messages.size(), 1u);
}

TEST_F(UndeclaredVoidsTest, TheUnitCounts)
{
    // A cliff of 400 m, of 1,400 and 1,900 feet, and of 4,500 decimetres.
    const auto cliff = [](double low)
    {
        return [low](int c, int r)
        {
            return c < 20 ? low : 0.1 * relief(c, r);
        };
    };
    EXPECT_TRUE(look(write(100, 80, cliff(-400.0))).isEmpty());
    EXPECT_TRUE(look(write(100, 80, cliff(-1400.0), "ft")).isEmpty());
    EXPECT_FALSE(look(write(100, 80, cliff(-1900.0), "ft")).isEmpty());
    EXPECT_TRUE(look(write(100, 80, cliff(-4500.0), "dm")).isEmpty());
}

TEST_F(UndeclaredVoidsTest, ADeepSeaHasHeights)
{
    // 9,999 m below the sea is a depth where others are about as deep.
    const auto trench = [](int c, int r)
    {
        return std::min(500.0, std::round(-11000.0 + 60.0 * c + 30.0 * r));
    };
    EXPECT_TRUE(look(write(200, 120, trench)).isEmpty());
    // Few heights show nothing.
    EXPECT_TRUE(
        look(write(4, 4, [](int c, int r) { return c == 1 && r == 1 ? 3000.0 : 10.0 * c + r; })).isEmpty());
}

TEST_F(UndeclaredVoidsTest, ZerosAroundATurnedSurveyAreNoSea)
{
    const int size = 240;
    for (const double degrees : {2.0, 14.0, 45.0, 80.0})
    {
        const auto height = [&](int c, int r)
        {
            const bool lake = std::hypot(c - 120, r - 130) < 12.0;
            return depthInSurvey(c, r, size, degrees) < 0.0 || lake ? 0.0 : 3.0 + 0.02 * relief(c, r);
        };
        const UndeclaredVoids voids = look(write(size, size, height));
        ASSERT_EQ(_messages.size(), 1u) << degrees;
        EXPECT_NE(_messages[0].find("0 is all around turned data"), std::string::npos) << _messages[0];
        int wrong = 0;
        for (int r = 0; r < size; ++r)
            for (int c = 0; c < size; ++c)
                wrong += voids.has(height(c, r), c, r) != (depthInSurvey(c, r, size, degrees) < 0.0);
        EXPECT_EQ(wrong, 0) << degrees;
    }
}

/// As GDAL leaves it that has brought a survey into another coordinate system.
TEST_F(UndeclaredVoidsTest, ReprojectedSurveysAreTurned)
{
    TestRaster raster(300, 260);
    raster.placed(300000.0, 5200000.0, 100.0, 100.0).crs("EPSG:32632");
    const std::string from =
        raster.fill([](int c, int r, int) { return 700.0 + relief(c, r); }).write(_folder / "utm.tif");
    const geofx::test::DatasetPtr source(GDALDataset::Open(from.c_str(), GDAL_OF_RASTER));
    const geofx::test::DatasetPtr turned(GDALDataset::FromHandle(GDALAutoCreateWarpedVRT(
        GDALDataset::ToHandle(source.get()), nullptr, SRS_WKT_WGS84_LAT_LONG, GRA_Bilinear, 0.0, nullptr)));
    ASSERT_TRUE(turned);
    const std::string file = _folder / "degrees.tif";
    geofx::test::DatasetPtr(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
        file.c_str(), turned.get(), FALSE, nullptr, nullptr, nullptr));
    const UndeclaredVoids voids = look(file);
    EXPECT_EQ(_messages.size(), 1u);
    const geofx::test::DatasetPtr copy(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    const int columns = copy->GetRasterXSize(), rows = copy->GetRasterYSize();
    std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    ASSERT_EQ(copy->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, values.data(), columns, rows,
                                               GDT_Float64, 0, 0, nullptr),
              CE_None);
    int empty = 0, left = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] == 0.0)
        {
            ++empty;
            left += !voids.has(0.0, static_cast<int>(i) % columns, static_cast<int>(i) / columns);
        }
    EXPECT_GT(empty, 1000);
    EXPECT_EQ(left, 0);
}

/// Too large to be read as a whole.
TEST_F(UndeclaredVoidsTest, LargeRastersAreLookedAtInParts)
{
    const int size = 3200;
    const auto height = [&](int c, int r)
    {
        return depthInSurvey(c, r, size, 20.0) < 0.0 ? 0.0 : 20.0 + 0.05 * c + 0.02 * ((r * 7 + c * 3) % 13);
    };
    for (const char* const tiled : {"TILED=YES", "TILED=NO"})
    {
        const UndeclaredVoids voids = look(write(size, size, height, "", {tiled}));
        ASSERT_EQ(_messages.size(), 1u) << tiled;
        int wrong = 0;
        for (int r = 0; r < size; r += 7)
            for (int c = 0; c < size; c += 7)
                wrong += voids.has(height(c, r), c, r) != (depthInSurvey(c, r, size, 20.0) < 0.0);
        EXPECT_EQ(wrong, 0) << tiled;
    }
}

TEST_F(UndeclaredVoidsTest, CoastsAndIslandsAreTheirOwn)
{
    const int size = 200;
    const auto at = [](int c, int r)
    {
        return std::pair(c - 99.5, r - 99.5);
    };
    const std::pair<const char*, std::function<double(int, int)>> grounds[] = {
        {"a round island",
         [&](int c, int r)
         {
             const auto [x, y] = at(c, r);
             return std::max(0.0, 8.0 * (80.0 - std::hypot(x, y)));
         }},
        {"a round island with cliffs",
         [&](int c, int r)
         {
             const auto [x, y] = at(c, r);
             return std::hypot(x, y) < 80.0 ? 60.0 + 0.1 * relief(c, r) : 0.0;
         }},
        {"a square mountain",
         [&](int c, int r)
         {
             const auto [x, y] = at(c, r);
             return std::max(0.0, 5.0 * (90.0 - std::abs(x) - std::abs(y)));
         }},
        {"an island with a bay and cliffs",
         [&](int c, int r)
         {
             const auto [x, y] = at(c, r);
             const bool bay = std::hypot(x - 40.0, y) < 40.0;
             return std::abs(x) + std::abs(y) < 90.0 && !bay ? 40.0 + 0.1 * relief(c, r) : 0.0;
         }},
        {"a straight coast with cliffs",
         [&](int c, int r)
         {
             const auto [x, y] = at(c, r);
             return x + 0.4 * y > 0.0 ? 30.0 + 0.1 * relief(c, r) : 0.0;
         }},
        {"a coast across corners",
         [&](int c, int r)
         {
             const auto [x, y] = at(c, r);
             return std::abs(x + y) < 60.0 ? 30.0 + 0.1 * relief(c, r) : 0.0;
         }},
        {"an island along the grid",
         [](int c, int r)
         {
             return c > 30 && c < 170 && r > 20 && r < 180 ? 30.0 + 0.1 * relief(c, r) : 0.0;
         }},
        {"a plain with a tower",
         [](int c, int r)
         {
             return c == 40 && r == 50 ? 900.0 : 0.0;
         }},
        {"hills with a tower", [](int c, int r)
         {
             return c == 40 && r == 50 ? 900.0 : 0.1 * relief(c, r);
         }}};
    for (const auto& [name, height] : grounds)
    {
        EXPECT_TRUE(look(write(size, size, height)).isEmpty()) << name;
        EXPECT_TRUE(_messages.empty()) << name;
    }
    EXPECT_TRUE(look(GEOFX_SOURCE_DIR "/data/oahu/elevation.tif").isEmpty());
}
