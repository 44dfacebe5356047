// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Tiles of rasters in the frames of mappings, against a MappingRaster of the same place; large files are never read whole.
#include <osgGeoFX/geodata/TiledRaster.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gdal_priv.h>
#include <osg/Math>

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

MappingFrame oahu()
{
    MappingFrame frame;
    frame.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(-157.9), osg::DegreesToRadians(21.4));
    return frame;
}

} // namespace

TEST(TiledRaster, TilesAreThePixelsOfTheirPlace)
{
    const TempDir folder;
    for (const bool colors : {false, true})
    {
        TestRaster raster(600, 500, colors ? 3 : 1, colors ? GDT_Byte : GDT_Float32);
        raster.placed(-158.0, 21.5, 0.0003, 0.0003).crs("EPSG:4326");
        raster.fill([](int column, int row, int band) { return (column * 3 + row * 5 + band * 70) % 251; });
        const std::string file = raster.write(folder.path() / (colors ? "colors.tif" : "values.tif"));
        std::string error;
        const osg::ref_ptr<RasterTiles> tiles = TiledRaster::open(file, oahu(), std::nullopt, error);
        ASSERT_TRUE(tiles) << error;
        EXPECT_EQ(tiles->kind(), colors ? DataLayer::COLOR : DataLayer::VALUE);
        EXPECT_NEAR(tiles->texel(), 32.0, 2.0);
        // Inside, over an edge, and of all of it, by several threads at once.
        const osg::Vec2d size = tiles->high() - tiles->low();
        const auto check = [&](const osg::Vec2d& from, const osg::Vec2d& to)
        {
            std::string fault;
            const osg::ref_ptr<osg::Image> image = tiles->read(from, to, 64, 48, fault);
            ASSERT_TRUE(image) << fault;
            MappingRaster::Options options;
            options.window = MappingRaster::Window{from, to, (to - from).x() / 64.0};
            const std::optional<MappingRaster> expected = MappingRaster::read(file, oahu(), options, fault);
            ASSERT_TRUE(expected) << fault;
            const osg::Image& other = *expected->layer->getImage();
            ASSERT_EQ(other.s(), 64);
            ASSERT_EQ(other.t(), 48);
            ASSERT_EQ(image->getTotalSizeInBytes(), other.getTotalSizeInBytes());
            EXPECT_EQ(std::memcmp(image->data(), other.data(), other.getTotalSizeInBytes()), 0);
        };
        std::vector<std::thread> threads;
        for (const double at : {-0.1, 0.2, 0.5, 0.8})
            threads.emplace_back(
                [&check, at, low = tiles->low(), width = size.x()]
                {
                    const osg::Vec2d from = low + osg::Vec2d(at * width, at * width);
                    check(from, from + osg::Vec2d(0.32 * width, 0.24 * width));
                });
        for (std::thread& each : threads)
            each.join();
        check(tiles->low(), tiles->low() + osg::Vec2d(size.x(), 0.75 * size.x()));
    }
}

TEST(TiledRaster, LargeFilesNeedOverviews)
{
    const TempDir folder;
    const std::string file = writeHollow(folder.path() / "large.tif", 9000, 9000);
    {
        GDALAllRegister();
        const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        double transform[] = {-158.3, 1e-5, 0.0, 21.7, 0.0, -1e-5};
        dataset->SetGeoTransform(transform);
        OGRSpatialReference srs;
        srs.importFromEPSG(4326);
        dataset->SetSpatialRef(&srs);
    }
    std::string error;
    EXPECT_FALSE(TiledRaster::open(file, oahu(), std::nullopt, error));
    EXPECT_TRUE(contains(error, file) && contains(error, "gdaladdo")) << error;
    {
        const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        int levels[] = {8, 64};
        CPLSetThreadLocalConfigOption("SPARSE_OK_OVERVIEW", "YES");
        ASSERT_EQ(dataset->BuildOverviews("NEAREST", 2, levels, 0, nullptr, nullptr, nullptr), CE_None);
        CPLSetThreadLocalConfigOption("SPARSE_OK_OVERVIEW", nullptr);
    }
    const GIntBig cache = GDALGetCacheMax64();
    osg::ref_ptr<RasterTiles> tiles = TiledRaster::open(file, oahu(), std::nullopt, error);
    ASSERT_TRUE(tiles) << error;
    EXPECT_LE(GDALGetCacheMax64(), 64 << 20);
    // All of it takes no more time than a part of it.
    EXPECT_TRUE(tiles->read(tiles->low(), tiles->high(), 256, 256, error)) << error;
    tiles = nullptr;
    EXPECT_EQ(GDALGetCacheMax64(), cache);
}

TEST(TiledRaster, CoarseTilesAreReadFromOverviewsOfAllKindsOfRasters)
{
    const TempDir folder;
    // The overviews have another color than the raster, so that one sees what is read.
    for (const char* kind : {"plain", "nodata", "alpha", "values"})
    {
        const bool values = std::string(kind) == "values";
        const bool alpha = std::string(kind) == "alpha";
        TestRaster raster(1024, 1024, values ? 1 : alpha ? 4 : 3, GDT_Byte);
        raster.placed(-158.0, 21.5, 0.0002, 0.0002).crs("EPSG:4326");
        raster.fill([](int, int, int band) { return band == 3 ? 255.0 : 200.0; });
        if (alpha) raster.dataset().GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
        if (std::string(kind) == "nodata")
            for (int band = 1; band <= 3; ++band)
                raster.dataset().GetRasterBand(band)->SetNoDataValue(7.0);
        const std::string file = raster.write(folder.path() / (std::string(kind) + ".tif"), {"TILED=YES"});
        {
            const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
            int levels[] = {4, 16};
            ASSERT_EQ(dataset->BuildOverviews("NEAREST", 2, levels, 0, nullptr, nullptr, nullptr), CE_None);
            for (int band = 1; band <= std::min(3, dataset->GetRasterCount()); ++band)
                for (int i = 0; i < 2; ++i)
                    ASSERT_EQ(dataset->GetRasterBand(band)->GetOverview(i)->Fill(i == 0 ? 100.0 : 50.0),
                              CE_None);
        }
        std::string error;
        const osg::ref_ptr<RasterTiles> tiles = TiledRaster::open(file, oahu(), std::nullopt, error);
        ASSERT_TRUE(tiles) << error;
        const osg::Vec2d middle = (tiles->low() + tiles->high()) * 0.5;
        const auto valueOf = [&](double pixels)
        {
            const double side = 16.0 * pixels * tiles->texel();
            const osg::ref_ptr<osg::Image> image =
                tiles->read(middle, middle + osg::Vec2d(side, side), 16, 16, error);
            EXPECT_TRUE(image) << error;
            if (!image) return -1.0;
            return values ? static_cast<double>(*reinterpret_cast<const float*>(image->data(8, 8)))
                          : static_cast<double>(*image->data(8, 8));
        };
        EXPECT_EQ(valueOf(1.0), 200.0) << kind;
        EXPECT_EQ(valueOf(3.0), 200.0) << kind;
        EXPECT_EQ(valueOf(4.2), 100.0) << kind;
        EXPECT_EQ(valueOf(20.0), 50.0) << kind;
    }
}

TEST(TiledRaster, WhatIsNoRasterIsRefused)
{
    const TempDir folder;
    std::string error;
    EXPECT_FALSE(TiledRaster::open((folder.path() / "none.tif").string(), oahu(), std::nullopt, error));
    EXPECT_TRUE(contains(error, "none.tif")) << error;
    TestRaster nowhere(8, 8);
    nowhere.placed(0.0, 1.0, 0.1, 0.1);
    EXPECT_FALSE(
        TiledRaster::open(nowhere.write(folder.path() / "nowhere.tif"), oahu(), std::nullopt, error));
    EXPECT_TRUE(contains(error, "no coordinate reference system")) << error;
}
