// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Sampling one raster on lattices: every kind of file that people have.
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr float NONE = std::numeric_limits<float>::quiet_NaN();

std::vector<float> heights(RasterSource& source, const GridCrs& crs, const Lattice& lattice)
{
    std::vector<float> result(
        static_cast<std::size_t>(lattice.columns) * static_cast<std::size_t>(lattice.rows), NONE);
    source.sampleHeights(crs, lattice, result.data());
    return result;
}

std::vector<float> heights(const std::string& file, const Lattice& lattice)
{
    RasterSource source(file, RasterKind::Elevation);
    return heights(source, GridCrs::geocentric(), lattice);
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

TEST(RasterHeights, RandomLatticesOnRandomAffineRasters)
{
    const TempDir folder;
    const int samples = fullTest() ? 2000 : 60;
    for (int sample = 0; sample < samples; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const int width = random.integer(2, 60), height = random.integer(2, 60);
        const double pixelX = random.logarithmic(1.0, 100.0), pixelY = random.logarithmic(1.0, 100.0);
        const double turn = random.integer(0, 2) ? 0.0 : random.uniform(-3.0, 3.0),
                     shear = random.uniform(-0.3, 0.3);
        std::array<double, 6> t{500000.0 + random.uniform(-1e5, 1e5),
                                pixelX * std::cos(turn),
                                pixelY * (turn == 0.0 ? 0.0 : shear - std::sin(turn)),
                                2e6,
                                pixelX * std::sin(turn),
                                random.sign() * pixelY * std::cos(turn)};
        std::array<double, 6> inverse{};
        ASSERT_TRUE(GDALInvGeoTransform(t.data(), inverse.data()));
        const double seed = random.uniform(0.0, 1000.0);
        const auto value = [&](int column, int row)
        {
            return relief(column + seed, row - seed);
        };
        const std::string file = TestRaster(width, height)
                                     .geoTransform(t)
                                     .crs("EPSG:32604")
                                     .fill([&](int column, int row, int) { return value(column, row); })
                                     .write(folder / "dem.tif");

        RasterSource source(file, RasterKind::Elevation);
        const GridCrs crs = GridCrs::projected(32604);
        const Footprint print = source.footprint(crs);
        Lattice lattice{print.west, print.south, 0.0, 0.0, random.integer(2, 90), random.integer(2, 90)};
        lattice.dx = (print.east - print.west) / (lattice.columns - 1);
        lattice.dy = (print.north - print.south) / (lattice.rows - 1);
        const auto found = heights(source, crs, lattice);
        for (int row = 0; row < lattice.rows; ++row)
            for (int column = 0; column < lattice.columns; ++column)
            {
                double px = 0.0, py = 0.0;
                GDALApplyGeoTransform(inverse.data(), lattice.x0 + column * lattice.dx,
                                      lattice.y0 + row * lattice.dy, &px, &py);
                const float h = found[static_cast<std::size_t>(row * lattice.columns + column)];
                // From center to center of the outermost pixels; beyond their outer edges there is nothing.
                if (px < -0.03 || px > width + 0.03 || py < -0.03 || py > height + 0.03)
                {
                    ASSERT_TRUE(std::isnan(h)) << "Random(" << sample << "), " << px << " " << py;
                    continue;
                }
                if (px < 0.0 || px > width || py < 0.0 || py > height) continue;
                const double x = std::clamp(px - 0.5, 0.0, width - 1.0),
                             y = std::clamp(py - 0.5, 0.0, height - 1.0);
                const int i = std::min(static_cast<int>(x), width - 2),
                          j = std::min(static_cast<int>(y), height - 2);
                const double u = x - i, v = y - j;
                const double expected = (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
                                        v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
                ASSERT_NEAR(static_cast<double>(h), expected, 0.02)
                    << "Random(" << sample << "), pixel " << px << " " << py << " of " << width << "x"
                    << height;
            }
    }
}

/// A hole of no-data in ground of `ground` metres: the samples are ground or nothing, and nothing in the
/// hole's midst.
void expectHole(const std::string& file, float ground)
{
    const auto found = heights(file, {10.05, 49.05, 0.013, 0.013, 70, 70});
    int holes = 0;
    for (const float h : found)
    {
        holes += std::isnan(h);
        ASSERT_TRUE(std::isnan(h) || std::abs(h - ground) < 0.01f) << h;
    }
    EXPECT_TRUE(std::isnan(found[static_cast<std::size_t>(35 * 70 + 35)]));
    EXPECT_GT(holes, 100);
    EXPECT_LT(holes, 1300);
}

/// 10 × 10 pixels with 4 × 4 of no-data in their midst.
TestRaster withHole(double value, double noData, GDALDataType type = GDT_Float32)
{
    TestRaster raster(10, 10, 1, type);
    raster.placed(10.0, 50.0, 0.1, 0.1).crs("EPSG:4326");
    raster.dataset().GetRasterBand(1)->SetNoDataValue(noData);
    raster.fill([=](int column, int row, int)
                { return column >= 3 && column < 7 && row >= 3 && row < 7 ? noData : value; });
    return raster;
}

TEST(RasterHeights, NoDataIsAHoleWithoutPillars)
{
    const TempDir folder;
    expectHole(withHole(1234.0, -9999.0).write(folder / "a.tif"), 1234.0f);
    expectHole(withHole(1234.0, -32768.0, GDT_Int16).write(folder / "b.tif"), 1234.0f);
    expectHole(withHole(1234.0, static_cast<double>(NONE)).write(folder / "c.tif"), 1234.0f);
    expectHole(withHole(1234.0, -3.4028234663852886e38).write(folder / "d.tif"), 1234.0f);
    expectHole(withHole(1234.0, 0.0).write(folder / "e.tif"), 1234.0f);
    expectHole(withHole(1234.0, 65535.0, GDT_UInt16).write(folder / "f.tif"), 1234.0f);
}

TEST(RasterHeights, MaskBandIsAHole)
{
    const TempDir folder;
    TestRaster raster = halves({100.0}, {700.0}, GDT_Float32);
    raster.dataset().CreateMaskBand(GMF_PER_DATASET);
    std::vector<unsigned char> mask(100, 255);
    std::fill(mask.begin() + 50, mask.end(), 0);
    ASSERT_EQ(raster.dataset().GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 10, 10, mask.data(),
                                                                         10, 10, GDT_Byte, 0, 0, nullptr),
              CE_None);
    const auto found = heights(raster.write(folder / "dem.tif"), {10.25, 49.25, 0.5, 0.5, 2, 2});
    EXPECT_TRUE(std::isnan(found[0]) && std::isnan(found[1])) << found[0] << " " << found[1];
    EXPECT_EQ(found[2], 100.0f);
    EXPECT_EQ(found[3], 700.0f);
}

TEST(RasterHeights, ScaleAndOffset)
{
    const TempDir folder;
    TestRaster raster = withHole(4000.0, -1.0, GDT_Int16);
    raster.dataset().GetRasterBand(1)->SetScale(0.25);
    raster.dataset().GetRasterBand(1)->SetOffset(-100.0);
    expectHole(raster.write(folder / "dem.tif"), 900.0f);
}

TEST(RasterHeights, Feet)
{
    const TempDir folder;
    for (const auto& [unit, metres] :
         std::vector<std::pair<std::string, double>>{{"ft", 0.3048},
                                                     {"US survey foot", 1200.0 / 3937.0},
                                                     {"ftUS", 1200.0 / 3937.0},
                                                     {"dm", 0.1},
                                                     {"cm", 0.01},
                                                     {"km", 1000.0},
                                                     {"m", 1.0},
                                                     {"", 1.0}})
    {
        TestRaster raster = withHole(10000.0, -9999.0);
        raster.dataset().GetRasterBand(1)->SetUnitType(unit.c_str());
        expectHole(raster.write(folder / "dem.tif"), static_cast<float>(10000.0 * metres));
    }
    TestRaster raster = withHole(2000.0, -9999.0, GDT_Int16);
    raster.dataset().GetRasterBand(1)->SetUnitType("ft");
    raster.dataset().GetRasterBand(1)->SetScale(5.0);
    expectHole(raster.write(folder / "scaled.tif"), 3048.0f);
}

TEST(RasterHeights, AnUnknownUnitIsNamedOnce)
{
    const TempDir folder;
    TestRaster raster = withHole(100.0, -9999.0);
    raster.dataset().GetRasterBand(1)->SetUnitType("cubits");
    const std::string file = raster.write(folder / "dem.tif");
    NotifyWatch watch;
    const auto messages = watch.messagesOf(
        [&]
        {
            expectHole(file, 100.0f);
            expectHole(file, 100.0f);
        });
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find(file + ": the unit of its heights, \"cubits\", is not known."),
              std::string::npos)
        << messages[0];
}

TEST(RasterHeights, FeetOfACompoundCrs)
{
    const TempDir folder;
    // WGS 84 and NAVD88 height (ftUS).
    const auto file = withHole(10000.0, -9999.0).crs("EPSG:4326+6360").write(folder / "dem.tif");
    expectHole(file, static_cast<float>(10000.0 * 1200.0 / 3937.0));
}

/// Pixel (25, 25) of a turned raster, and a corner of its box.
const Lattice middleAndCorner{10.0, 49.95, -0.045, 0.045, 2, 2};

TEST(RasterHeights, GroundControlPoints)
{
    const TempDir folder;
    for (const auto type : {GDT_Float32, GDT_UInt16})
    {
        TestRaster raster(50, 50, 1, type);
        raster.fill([](int column, int row, int) { return 500.0 + column + 2.0 * row; });
        const auto found =
            heights(raster.placedByPoints(10.0, 50.0, 0.001).write(folder / "dem.tif"), middleAndCorner);
        EXPECT_NEAR(found[0], 573.5, 1.0);
        EXPECT_TRUE(std::isnan(found[3])) << found[3];
        raster.dataset().GetRasterBand(1)->SetUnitType("ft");
        EXPECT_NEAR(heights(raster.write(folder / "feet.tif"), middleAndCorner)[0], 573.5 * 0.3048, 0.5);
    }
}

TEST(RasterHeights, AcrossTheAntimeridian)
{
    const TempDir folder;
    const auto east = [](double longitude)
    {
        return longitude < 0.0 ? longitude + 360.0 : longitude;
    };
    const auto plane = [&](double west)
    {
        return [=](int column, int, int)
        {
            return 100.0 * (east(west + (column + 0.5) * 0.1) - 170.0);
        };
    };
    const auto write = [&](const std::string& name, double west, int columns)
    {
        return TestRaster(columns, 20)
            .placed(west, 1.0, 0.1, 0.1)
            .crs("EPSG:4326")
            .fill(plane(west))
            .write(folder / name);
    };
    const auto before = write("before.tif", 179.0, 10), after = write("after.tif", -180.0, 10);
    const auto one = write("one.tif", 170.0, 200);
    const Lattice across{179.5, 0.0, 0.05, 0.1, 21, 3};
    std::vector<float> two(63, NONE);
    for (const auto& file : {before, after})
        RasterSource(file, RasterKind::Elevation).sampleHeights(GridCrs::geocentric(), across, two.data());
    const auto single = heights(one, across);
    for (std::size_t i = 0; i < two.size(); ++i)
    {
        const double expected = 100.0 * (9.5 + 0.05 * static_cast<double>(i % 21));
        EXPECT_NEAR(single[i], expected, 0.02) << i;
        // Between the last pixel of the one and the first of the other file each of them has its own height.
        EXPECT_NEAR(two[i], expected, 5.1) << i;
    }
    const Footprint print = RasterSource(one, RasterKind::Elevation).footprint(GridCrs::geocentric());
    EXPECT_NEAR(print.west, 170.05, 1e-9);
    EXPECT_NEAR(print.east, 189.95, 1e-9);
    EXPECT_FALSE(print.wholeCircle);
}

TEST(RasterHeights, AroundTheGlobeWithoutAGap)
{
    const TempDir folder;
    for (const double west : {-180.0, 0.0})
    {
        const auto file = TestRaster(72, 36)
                              .placed(west, 90.0, 5.0, 5.0)
                              .crs("EPSG:4326")
                              .fill([](int column, int, int) { return column; })
                              .write(folder / "dem.tif");
        RasterSource source(file, RasterKind::Elevation);
        const Footprint print = source.footprint(GridCrs::geocentric());
        EXPECT_TRUE(print.wholeCircle);
        EXPECT_NEAR(print.east - print.west, 360.0, 1e-9);
        const auto found = heights(source, GridCrs::geocentric(), {print.west, -80.0, 1.25, 10.0, 289, 17});
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            const double column = static_cast<double>(i % 289) / 4.0;
            ASSERT_FALSE(std::isnan(found[i])) << i;
            ASSERT_TRUE(column > 71.0 || std::abs(static_cast<double>(found[i]) - column) < 0.01) << i;
        }
    }
}

/// A lattice all around with a point more at each end lies symmetrically about the jump of the longitudes: seen at
/// its ends and its middle only, it looks straight, and mirrored.
TEST(RasterHeights, AroundTheGlobeAndOneMore)
{
    const TempDir folder;
    const auto file = TestRaster(100, 50)
                          .placed(-180.0, 90.0, 3.6, 3.6)
                          .crs("EPSG:4326")
                          .fill([](int column, int, int) { return column; })
                          .write(folder / "dem.tif");
    for (const int more : {0, 1, 2})
    {
        const auto found = heights(file, {-178.2 - more * 3.6, -70.2, 3.6, 3.6, 101 + 2 * more, 40});
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            const int column = static_cast<int>(i) % (101 + 2 * more) - more;
            ASSERT_NEAR(static_cast<double>(found[i]), (column + 100) % 100, 0.01)
                << column << " of " << more;
        }
    }
}

TEST(RasterHeights, PolarStereographic)
{
    const TempDir folder;
    const std::string crs = "EPSG:3995";
    const auto file = TestRaster(100, 100)
                          .placed(-500000.0, 500000.0, 10000.0, 10000.0)
                          .crs(crs)
                          .fill([](int column, int row, int) { return 10.0 * column + row; })
                          .write(folder / "dem.tif");
    RasterSource source(file, RasterKind::Elevation);
    const GridCrs grid = GridCrs::geocentric();
    const Footprint print = source.footprint(grid);
    EXPECT_TRUE(print.wholeCircle);
    EXPECT_EQ(print.north, 90.0);
    EXPECT_LT(print.south, 84.0);
    EXPECT_NEAR(print.east - print.west, 360.0, 1e-9);
    const Lattice lattice{print.west, print.south, 2.0, (90.0 - print.south) / 40.0, 181, 41};
    const auto found = heights(source, grid, lattice);
    OGRSpatialReference polar;
    polar.SetFromUserInput(crs.c_str());
    polar.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const TransformationPtr toPolar = createTransformation(grid.srs, polar, file);
    int inside = 0;
    for (int row = 0; row < lattice.rows; ++row)
        for (int column = 0; column < lattice.columns; ++column)
        {
            double x = lattice.x0 + column * lattice.dx, y = lattice.y0 + row * lattice.dy;
            ASSERT_TRUE(toPolar->Transform(1, &x, &y));
            const float h = found[static_cast<std::size_t>(row * lattice.columns + column)];
            ASSERT_TRUE(std::max(std::abs(x), std::abs(y)) < 500300.0 || std::isnan(h))
                << column << " " << row;
            if (std::max(std::abs(x), std::abs(y)) > 495000.0) continue;
            ++inside;
            const double expected = 10.0 * ((x + 500000.0) / 10000.0 - 0.5) + (500000.0 - y) / 10000.0 - 0.5;
            ASSERT_NEAR(static_cast<double>(h), expected, 0.02) << column << " " << row;
        }
    EXPECT_GT(inside, 4000);
}

} // namespace
