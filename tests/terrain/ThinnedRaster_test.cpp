// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/ThinnedRaster.h>
#include <tools/InventedTerrain.h>
#include <tools/TempDir.h>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

using geofx::test::TempDir;
using osgGeoFX::BuildError;
using osgGeoFX::ThinnedRaster;

namespace
{

struct Closer
{
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

/// A raster of one degree at 46° N, 7° E.
void write(const std::string& file, int side, const std::function<double(int, int)>& value,
           const char* unit = "")
{
    GDALAllRegister();
    const Dataset dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), side, side,
                                                                                   1, GDT_Float32, nullptr));
    double transform[] = {7.0, 1.0 / side, 0.0, 47.0, 0.0, -1.0 / side};
    dataset->SetGeoTransform(transform);
    OGRSpatialReference srs;
    srs.importFromEPSG(4326);
    dataset->SetSpatialRef(&srs);
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    band.SetNoDataValue(-9999.0);
    band.SetUnitType(unit);
    std::vector<float> row(static_cast<std::size_t>(side));
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
            row[static_cast<std::size_t>(x)] = static_cast<float>(value(x, y));
        ASSERT_EQ(band.RasterIO(GF_Write, 0, y, side, 1, row.data(), side, 1, GDT_Float32, 0, 0), CE_None);
    }
}

std::vector<float> read(const std::string& file, int& columns, int& rows)
{
    const Dataset dataset(GDALDataset::Open(file.c_str()));
    columns = dataset->GetRasterXSize();
    rows = dataset->GetRasterYSize();
    std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, values.data(), columns, rows,
                                                  GDT_Float32, 0, 0),
              CE_None);
    return values;
}

std::string in(const TempDir& folder, const char* name)
{
    return (std::filesystem::path(folder.path()) / name).string();
}

} // namespace

TEST(ThinnedRaster, AveragesAndKeepsPlaceUnitAndHoles)
{
    const TempDir folder;
    const std::string file = in(folder, "a.tif"), copy = in(folder, "b.tif");
    write(
        file, 103, [](int x, int y) { return x < 8 && y < 8 ? -9999.0 : 100.0 * x + y; }, "ft");
    const ThinnedRaster::Size size = ThinnedRaster::look(file);
    EXPECT_EQ(size.columns, 103);
    EXPECT_NEAR(size.spacing, 111319.5 / 103 * std::cos(46.5 * M_PI / 180.0), 20.0);
    EXPECT_FALSE(size.seaFloor);
    const ThinnedRaster::Cut cut = ThinnedRaster::cut(file, {}, 4);
    EXPECT_EQ(cut.columns, 100) << "whole squares";
    ThinnedRaster::write(file, cut, copy);
    int columns = 0, rows = 0;
    const std::vector<float> values = read(copy, columns, rows);
    ASSERT_EQ(columns, 25);
    ASSERT_EQ(rows, 25);
    EXPECT_FLOAT_EQ(values[0], -9999.0f) << "holes stay";
    EXPECT_FLOAT_EQ(values[25 * 10 + 7], 100.0f * 29.5f + 41.5f) << "the mean of 16";
    const Dataset dataset(GDALDataset::Open(copy.c_str()));
    EXPECT_STREQ(dataset->GetRasterBand(1)->GetUnitType(), "ft");
    double transform[6];
    ASSERT_EQ(dataset->GetGeoTransform(transform), CE_None);
    EXPECT_NEAR(transform[1], 4.0 / 103, 1e-12);
    EXPECT_FALSE(std::filesystem::exists(copy + ".part"));
}

TEST(ThinnedRaster, CutsOutWhatAPictureNeeds)
{
    const TempDir folder;
    const std::string file = in(folder, "a.tif");
    write(file, 400, [](int x, int) { return x; });
    const ThinnedRaster::Cut cut = ThinnedRaster::cut(file, {{7.5, 46.5}, {7.6, 46.7}}, 2);
    // 0.5 and 0.6 of 400 columns, with 16 samples of two pixels beyond.
    EXPECT_EQ(cut.left, 168);
    EXPECT_EQ(cut.left + cut.columns, 272);
    EXPECT_EQ(cut.top, 88);
    EXPECT_EQ(cut.top + cut.rows, 232);
    EXPECT_EQ(ThinnedRaster::cut(file, {{20.0, 10.0}}, 1).columns, 0) << "nothing is there";
    // A rotated grid of another CRS.
    const std::string rotated = in(folder, "rotated.tif");
    geofx::test::inventTerrain("rotated", rotated, 200);
    const ThinnedRaster::Cut part = ThinnedRaster::cut(rotated, {{-70.9, -32.4}}, 1);
    EXPECT_LE(part.columns, 40);
}

TEST(ThinnedRaster, TheSeaIsItsSurfaceAndLowLandStays)
{
    const TempDir folder;
    const std::string file = in(folder, "a.tif"), copy = in(folder, "b.tif");
    const auto height = [](int x, int y)
    {
        const bool depression = std::hypot(x - 70.0, y - 50.0) < 15.0;
        return x < 40 ? -5.0 * (40 - x) : depression ? -80.0 : 3.0 * (x - 39);
    };
    write(file, 100, height);
    EXPECT_TRUE(ThinnedRaster::look(file).seaFloor);
    ThinnedRaster::write(file, ThinnedRaster::cut(file, {}, 1), copy);
    int columns = 0, rows = 0;
    const std::vector<float> values = read(copy, columns, rows);
    ASSERT_EQ(columns, 100);
    for (int y = 0; y < 100; ++y)
    {
        for (int x = 0; x < 100; ++x)
        {
            const float value = values[static_cast<std::size_t>(100 * y + x)];
            EXPECT_FLOAT_EQ(value, static_cast<float>(x < 40 ? 0.0 : height(x, y))) << x << ", " << y;
        }
    }
}

TEST(ThinnedRaster, SaysWhatIsWrong)
{
    const TempDir folder;
    const std::string missing = in(folder, "none.tif"), file = in(folder, "a.tif");
    const auto sentence = [](const std::function<void()>& action)
    {
        try
        {
            action();
        }
        catch (const BuildError& error)
        {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_NE(sentence([&] { ThinnedRaster::look(missing); }).find(missing), std::string::npos);
    write(file, 100, [](int x, int) { return x; });
    EXPECT_NE(
        sentence([&] { ThinnedRaster::write(file, ThinnedRaster::cut(file, {}, 1), in(folder, "no/b.tif")); })
            .find("no/b.tif"),
        std::string::npos);
    const std::string stopped = in(folder, "stopped.tif");
    EXPECT_NE(sentence(
                  [&] {
                      ThinnedRaster::write(file, ThinnedRaster::cut(file, {}, 1), stopped,
                                           [](double) { return false; });
                  }),
              "no error");
    EXPECT_FALSE(std::filesystem::exists(stopped));
}

TEST(ThinnedRaster, HeightsThatAreNoneAreNotAveraged)
{
    const TempDir folder;
    const std::string file = in(folder, "a.tif"), copy = in(folder, "b.tif");
    // The file declares another value.
    write(file, 100,
          [](int x, int y) { return x > 41 && x < 60 && y > 30 && y < 51 ? -32768.0 : 500.0 + 3.0 * x + y; });
    for (const bool all : {false, true})
    {
        EXPECT_EQ(ThinnedRaster::look(file, all).seaFloor, all);
        ThinnedRaster::write(file, ThinnedRaster::cut(file, {}, 4), copy, {}, all);
        int columns = 0, rows = 0;
        float lowest = 1e9f;
        int holes = 0;
        for (const float height : read(copy, columns, rows))
        {
            lowest = std::min(lowest, height);
            holes += std::isnan(height) ? 1 : 0;
        }
        EXPECT_EQ(lowest < 500.0f, all);
        EXPECT_EQ(holes > 0, !all);
    }
}
