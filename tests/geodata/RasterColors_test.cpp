// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Colors and classes of one raster on lattices: every kind of image that people have.
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <algorithm>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Texel = std::array<int, 4>;

/// Red, green, blue and alpha of each point, over black without alpha.
std::vector<Texel> colors(RasterSource& source, const Lattice& lattice)
{
    const auto count = static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows);
    std::vector<unsigned char> planes(4 * count, 0);
    source.sampleColors(GridCrs::geocentric(), lattice, planes.data());
    std::vector<Texel> result(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t channel = 0; channel < 4; ++channel)
            result[i][channel] = planes[channel * count + i];
    return result;
}

/// Ten by ten pixels of 0.1° from 10° E 50° N; the western half has `west`, the eastern `east`.
TestRaster halves(const std::vector<double>& west, const std::vector<double>& east,
                  GDALDataType type = GDT_Byte)
{
    TestRaster raster(10, 10, static_cast<int>(west.size()), type);
    raster.placed(10.0, 50.0, 0.1, 0.1)
        .crs("EPSG:4326")
        .fill([&](int column, int, int band)
              { return (column < 5 ? west : east)[static_cast<std::size_t>(band)]; });
    return raster;
}

/// Colors amid the western and the eastern half, far enough from the border between them.
std::vector<Texel> colorsOf(RasterSource& source)
{
    const auto found = colors(source, {10.15, 49.55, 0.1, 0.1, 8, 1});
    return {found.front(), found.back()};
}

std::vector<Texel> colorsOf(const TestRaster& raster)
{
    const TempDir folder;
    RasterSource source(raster.write(folder / "image.tif"), RasterKind::Imagery);
    return colorsOf(source);
}

/// Pixel (25, 25) of a turned raster, and a corner of its box.
const Lattice middleAndCorner{10.0, 49.95, -0.045, 0.045, 2, 2};

TEST(RasterColors, GreyRgbAndAlpha)
{
    EXPECT_EQ(colorsOf(halves({40}, {200})), (std::vector<Texel>{{40, 40, 40, 255}, {200, 200, 200, 255}}));
    EXPECT_EQ(colorsOf(halves({1, 2, 3}, {250, 150, 50})),
              (std::vector<Texel>{{1, 2, 3, 255}, {250, 150, 50, 255}}));
    TestRaster rgba = halves({9, 8, 7, 255}, {100, 100, 100, 0});
    rgba.dataset().GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    const auto found = colorsOf(rgba);
    EXPECT_EQ(found[0], (Texel{9, 8, 7, 255}));
    EXPECT_EQ(found[1][3], 0);
    TestRaster greyAlpha = halves({90, 255}, {100, 0});
    greyAlpha.dataset().GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
    EXPECT_EQ(colorsOf(greyAlpha)[0], (Texel{90, 90, 90, 255}));
    EXPECT_EQ(colorsOf(greyAlpha)[1][3], 0);
}

TEST(RasterColors, InfraredIsNotAlpha)
{
    TestRaster raster = halves({9, 8, 7, 0}, {1, 2, 3, 100});
    EXPECT_EQ(colorsOf(raster)[0], (Texel{9, 8, 7, 255}));
}

TEST(RasterColors, SixteenBits)
{
    EXPECT_EQ(colorsOf(halves({0, 32896, 65535}, {257, 514, 65278}, GDT_UInt16)),
              (std::vector<Texel>{{0, 128, 255, 255}, {1, 2, 254, 255}}));
}

TEST(RasterColors, Palette)
{
    TestRaster raster = halves({3}, {7});
    GDALColorTable table;
    const GDALColorEntry brown{120, 80, 40, 255}, clear{10, 20, 30, 0};
    table.SetColorEntry(3, &brown);
    table.SetColorEntry(7, &clear);
    raster.dataset().GetRasterBand(1)->SetColorTable(&table);
    raster.dataset().GetRasterBand(1)->SetColorInterpretation(GCI_PaletteIndex);
    EXPECT_EQ(colorsOf(raster)[0], (Texel{120, 80, 40, 255}));
    raster.dataset().GetRasterBand(1)->SetNoDataValue(7.0);
    EXPECT_EQ(colorsOf(raster)[1][3], 0);
}

TEST(RasterColors, NoDataIsTransparent)
{
    TestRaster raster = halves({255, 255, 255}, {200, 100, 50});
    for (int band = 1; band <= 3; ++band)
        raster.dataset().GetRasterBand(band)->SetNoDataValue(255.0);
    EXPECT_EQ(colorsOf(raster)[0][3], 0);
    EXPECT_EQ(colorsOf(raster)[1], (Texel{200, 100, 50, 255}));
}

TEST(RasterColors, CoarseLatticesAverage)
{
    const TempDir folder;
    const auto file = TestRaster(512, 512, 1, GDT_Byte)
                          .placed(10.0, 50.0, 0.001, 0.001)
                          .crs("EPSG:4326")
                          .fill([](int column, int row, int) { return (column + row) % 2 ? 255 : 0; })
                          .write(folder / "image.tif");
    RasterSource source(file, RasterKind::Imagery);
    for (const auto& texel : colors(source, {10.05, 49.54, 0.02, 0.02, 20, 20}))
        ASSERT_NEAR(texel[0], 127, 12);
}

TEST(RasterClasses, NearestAndColored)
{
    const TempDir folder;
    TestRaster raster = halves({11}, {22});
    raster.dataset().GetRasterBand(1)->SetNoDataValue(22.0);
    RasterSource source(raster.write(folder / "classes.tif"), RasterKind::LandCover);
    std::vector<unsigned char> found(10, 99);
    const Lattice line{10.05, 49.55, 0.1, 0.1, 10, 1};
    source.sampleClasses(GridCrs::geocentric(), line, found.data());
    for (std::size_t i = 0; i < 10; ++i)
        EXPECT_EQ(found[i], i < 5 ? 11 : 99) << i;

    std::array<std::array<unsigned char, 4>, 256> table{};
    table[11] = {200, 100, 50, 255};
    RasterSource colored(halves({11}, {33}).write(folder / "b.tif"), RasterKind::LandCover);
    colored.colorize(table);
    const auto texels = colorsOf(colored);
    EXPECT_EQ(texels[0], (Texel{200, 100, 50, 255}));
    EXPECT_EQ(texels[1][3], 0) << "a value that the table does not name has a color";
}

TEST(RasterColors, GroundControlPoints)
{
    const TempDir folder;
    TestRaster raster(50, 50, 3, GDT_Byte);
    raster.fill([](int, int, int band) { return 50.0 * (band + 1); });
    RasterSource source(raster.placedByPoints(10.0, 50.0, 0.001).write(folder / "image.tif"),
                        RasterKind::Imagery);
    const auto found = colors(source, middleAndCorner);
    EXPECT_EQ(found[0], (Texel{50, 100, 150, 255}));
    EXPECT_EQ(found[3][3], 0);
}

TEST(RasterClasses, GroundControlPoints)
{
    const TempDir folder;
    TestRaster raster(50, 50, 1, GDT_Byte);
    raster.fill([](int column, int, int) { return column % 2 ? 10 : 20; });
    RasterSource source(raster.placedByPoints(10.0, 50.0, 0.001).write(folder / "classes.tif"),
                        RasterKind::LandCover);
    std::vector<unsigned char> found(61 * 61, 99);
    source.sampleClasses(GridCrs::geocentric(), {9.94, 49.89, 0.002, 0.002, 61, 61}, found.data());
    for (const int value : found)
        ASSERT_TRUE(value == 10 || value == 20 || value == 99) << "a mixture of classes: " << value;
    EXPECT_GT(std::count(found.begin(), found.end(), 10), 500);
    EXPECT_EQ(found[0], 99);

    std::array<std::array<unsigned char, 4>, 256> table{};
    table[10] = table[20] = {200, 100, 50, 255};
    source.colorize(table);
    const auto texels = colors(source, middleAndCorner);
    EXPECT_EQ(texels[0], (Texel{200, 100, 50, 255}));
    EXPECT_EQ(texels[3][3], 0);
}

} // namespace
