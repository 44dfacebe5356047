// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures with more bands or bits than a photo, in the layouts of real products, through each reader: which bands are red, green and blue, and which
// numbers are black and white.
#include <geodata/RasterReaders.h>
#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

using namespace geofx::test;
using namespace geofx::test::readers;

namespace
{

using Numbers = std::vector<double>;
using Color = std::array<double, 3>;

struct Product
{
    std::string name;
    GDALDataType type = GDT_UInt16;
    std::vector<GDALColorInterp> colors; ///< of the bands
    std::vector<std::string> names;      ///< the same; may be empty
    Numbers west, east;                  ///< of the two halves, by band
    Color westColor, eastColor;          ///< what must come out
    std::string nbits;                   ///< of all bands; empty: none
    const char* format = "tif";

    friend std::ostream& operator<<(std::ostream& stream, const Product& product)
    {
        return stream << product.name;
    }
};

/// A number of a stretch, 0…255.
double shown(double number, double black, double white)
{
    return std::clamp(255.0 * (number - black) / (white - black), 0.0, 255.0);
}

Color shown(const Color& numbers, double black, double white)
{
    return {shown(numbers[0], black, white), shown(numbers[1], black, white),
            shown(numbers[2], black, white)};
}

constexpr GDALColorInterp R = GCI_RedBand, G = GCI_GreenBand, B = GCI_BlueBand, U = GCI_Undefined,
                          grey = GCI_GrayIndex;

std::vector<Product> products()
{
    const Color water{300, 400, 600}, soil{1600, 1200, 800};
    std::vector<Product> result;
    // As SENTINEL2's driver opens it, and as a stack of the files B02, B03, B04 and B08.
    result.push_back({"Sentinel-2, 10 m",
                      GDT_UInt16,
                      {R, G, B, U},
                      {},
                      {300, 400, 600, 200},
                      {1600, 1200, 800, 3000},
                      shown(water, 300, 1600),
                      shown(soil, 300, 1600),
                      ""});
    result.push_back({"Sentinel-2, a stack",
                      GDT_UInt16,
                      {grey, U, U, U},
                      {"B02", "B03", "B04", "B08"},
                      {600, 400, 300, 200},
                      {800, 1200, 1600, 3000},
                      shown(water, 300, 1600),
                      shown(soil, 300, 1600),
                      ""});
    result.push_back({"PlanetScope",
                      GDT_UInt16,
                      {B, G, R, U},
                      {},
                      {600, 400, 300, 200},
                      {800, 1200, 1600, 3000},
                      shown(water, 300, 1600),
                      shown(soil, 300, 1600),
                      ""});
    result.push_back({"SuperDove",
                      GDT_UInt16,
                      {grey, U, U, U, U, U, U, U},
                      {"coastal_blue", "blue", "green_i", "green", "yellow", "red", "rededge", "nir"},
                      {9, 600, 9, 400, 9, 300, 9, 9},
                      {5000, 800, 5000, 1200, 5000, 1600, 5000, 5000},
                      shown(water, 300, 1600),
                      shown(soil, 300, 1600),
                      ""});
    result.push_back({"Landsat, Collection 2",
                      GDT_UInt16,
                      {R, G, B},
                      {},
                      {7800, 8600, 9800},
                      {20000, 17000, 14000},
                      shown({7800, 8600, 9800}, 7800, 20000),
                      shown({20000, 17000, 14000}, 7800, 20000),
                      ""});
    result.push_back(
        {"Landsat, panchromatic", GDT_UInt16, {grey}, {}, {7000}, {14000}, {0, 0, 0}, {255, 255, 255}, ""});
    result.push_back({"NAIP",
                      GDT_Byte,
                      {R, G, B, U},
                      {},
                      {20, 30, 90, 0},
                      {200, 0, 60, 255},
                      {20, 30, 90},
                      {200, 0, 60},
                      ""});
    result.push_back({"bytes, blue first",
                      GDT_Byte,
                      {B, G, R},
                      {},
                      {90, 30, 20},
                      {60, 150, 200},
                      {20, 30, 90},
                      {200, 150, 60},
                      ""});
    result.push_back({"Pleiades, dark",
                      GDT_UInt16,
                      {R, G, B, U},
                      {},
                      {300, 400, 600, 900},
                      {1600, 1200, 800, 2000},
                      shown(water, 300, 1600),
                      shown(soil, 300, 1600),
                      "12"});
    result.push_back({"Pleiades, bright",
                      GDT_UInt16,
                      {R, G, B, U},
                      {},
                      {300, 400, 600, 900},
                      {4000, 3000, 2000, 2000},
                      shown(water, 0, 4095),
                      shown({4000, 3000, 2000}, 0, 4095),
                      "12"});
    result.push_back({"a photo of 16 bits",
                      GDT_UInt16,
                      {R, G, B},
                      {},
                      {1000, 20000, 40000},
                      {60000, 30000, 5000},
                      shown({1000, 20000, 40000}, 0, 65535),
                      shown({60000, 30000, 5000}, 0, 65535),
                      ""});
    result.push_back({"a dark PNG of 16 bits",
                      GDT_UInt16,
                      {R, G, B},
                      {},
                      {257, 514, 1028},
                      {2570, 5140, 10280},
                      {1, 2, 4},
                      {10, 20, 40},
                      "",
                      "png"});
    result.push_back({"four bits", GDT_Byte, {grey}, {}, {3}, {15}, {51, 51, 51}, {255, 255, 255}, "4"});
    result.push_back({"reflectance",
                      GDT_Float32,
                      {R, G, B, U},
                      {},
                      {0.03, 0.04, 0.06, 0.5},
                      {0.16, 0.12, 0.08, 0.4},
                      shown({0.03, 0.04, 0.06}, 0.03, 0.16),
                      shown({0.16, 0.12, 0.08}, 0.03, 0.16),
                      ""});
    result.push_back({"MicaSense",
                      GDT_Float32,
                      {grey, U, U, U, U},
                      {"Blue", "Green", "Red", "NIR", "Red edge"},
                      {0.06, 0.04, 0.03, 0.5, 0.9},
                      {0.08, 0.12, 0.16, 0.4, 0.9},
                      shown({0.03, 0.04, 0.06}, 0.03, 0.16),
                      shown({0.16, 0.12, 0.08}, 0.03, 0.16),
                      ""});
    return result;
}

bool isWest(int column)
{
    return column < columns / 2;
}

std::string write(const fs::path& folder, const Product& product)
{
    TestRaster raster(columns, rows, static_cast<int>(product.colors.size()), product.type);
    raster.placed(west, north, pixel, pixel).crs("EPSG:32604");
    raster.fill([&](int column, int, int band)
                { return (isWest(column) ? product.west : product.east)[static_cast<std::size_t>(band)]; });
    for (std::size_t i = 0; i < product.colors.size(); ++i)
    {
        GDALRasterBand& band = *raster.dataset().GetRasterBand(static_cast<int>(i) + 1);
        band.SetColorInterpretation(product.colors[i]);
        if (!product.names.empty()) band.SetDescription(product.names[i].c_str());
    }
    fs::create_directories(folder / "steps");
    const std::string file = (folder / "steps" / ("raster." + std::string(product.format))).string();
    if (std::string(product.format) == "png")
    {
        GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("PNG");
        GDALClose(driver->CreateCopy(file.c_str(), &raster.dataset(), FALSE, nullptr, nullptr, nullptr));
        return file;
    }
    std::vector<std::string> options;
    if (!product.nbits.empty()) options.push_back("NBITS=" + product.nbits);
    return raster.write(file, options);
}

const std::map<std::string, Reader> all = {{"mapping", mapping}, {"tiled", tiled},     {"sequence", sequence},
                                           {"picture", picture}, {"overlay", overlay}, {"surface", surface},
                                           {"builder", builder}};

void expectColor(const Picture& picture, double column, double row, const Color& color, double alpha = 255.0)
{
    ASSERT_GT(picture.width, 0);
    const Picture::Texel texel = picture.at(static_cast<int>(column * picture.width / columns),
                                            static_cast<int>(row * picture.height / rows));
    EXPECT_NEAR(texel[3], alpha, 1.0);
    for (std::size_t i = 0; i < 3 && alpha > 0.0; ++i)
        EXPECT_NEAR(texel[i], color[i], 1.0) << "channel " << i << " at " << column << ", " << row;
}

/// Of a raster of three bands, R, G and B.
std::string writeNumbers(const fs::path& folder, GDALDataType type, const TestRaster::Value& value,
                         const std::function<void(GDALDataset&)>& change = {}, int bands = 3)
{
    TestRaster raster(columns, rows, bands, type);
    raster.placed(west, north, pixel, pixel).crs("EPSG:32604").fill(value);
    for (int band = 1; band <= 3; ++band)
        raster.dataset().GetRasterBand(band)->SetColorInterpretation(
            static_cast<GDALColorInterp>(GCI_RedBand + band - 1));
    if (change) change(raster.dataset());
    fs::create_directories(folder / "steps");
    return raster.write(folder / "steps" / "raster.tif");
}

} // namespace

TEST(SatelliteColors, AreThoseOfTheirProduct)
{
    for (const Product& product : products())
    {
        const TempDir folder;
        const std::string file = write(folder.path(), product);
        const bool isPng = std::string(product.format) == "png";
        for (const auto& [name, reader] : all)
        {
            SCOPED_TRACE(testing::Message() << product << ", " << name);
            // A grey raster of a folder is one of values, and a PNG has its place in a file beside it.
            if (name == "sequence" && (product.colors.size() == 1 || isPng)) continue;
            std::string error;
            const Picture read = reader(file, DataLayer::COLOR, columns, error);
            EXPECT_EQ(error, "");
            expectColor(read, 60, 96, product.westColor);
            expectColor(read, 200, 96, product.eastColor);
        }
    }
}

// One band alone has the value by chance.
TEST(SatelliteColors, APixelIsMissingOnlyWhereAllColorsAre)
{
    const auto value = [](int column, int row, int band)
    {
        if (row < 48) return 0.0;                                // missing, also where infrared is not
        if (row < 96) return band == 2 ? 0.0 : 400.0;            // without blue
        return (isWest(column) ? 300.0 : 1600.0) + 100.0 * band; // all of them
    };
    const TempDir folder;
    const std::string file = writeNumbers(
        folder.path(), GDT_UInt16,
        [&](int column, int row, int band) { return band == 3 ? 500.0 : value(column, row, band); },
        [](GDALDataset& raster)
        {
            for (int band = 1; band <= 4; ++band)
                raster.GetRasterBand(band)->SetNoDataValue(0.0);
        },
        4);
    for (const auto& [name, reader] : all)
    {
        SCOPED_TRACE(name);
        std::string error;
        const Picture read = reader(file, DataLayer::COLOR, columns, error);
        EXPECT_EQ(error, "");
        expectColor(read, 60, 20, {}, 0.0);
        expectColor(read, 60, 70, shown({400, 400, 0}, 0, 1800));
        expectColor(read, 60, 140, shown({300, 400, 500}, 0, 1800));
        expectColor(read, 200, 140, shown({1600, 1700, 1800}, 0, 1800));
    }
}

// What lies beside the picture, declared or not, and clouds of 1 % do not darken it.
TEST(SatelliteColors, FewNumbersAndEmptyPlacesDoNotCount)
{
    const TempDir folder;
    const std::string file = writeNumbers(folder.path(), GDT_UInt16,
                                          [](int column, int row, int)
                                          {
                                              if (column < 64) return 0.0;
                                              if (row == 0) return 60000.0;
                                              return isWest(column) ? 1000.0 : 3000.0;
                                          });
    for (const auto& [name, reader] : all)
    {
        SCOPED_TRACE(name);
        std::string error;
        const Picture read = reader(file, DataLayer::COLOR, columns, error);
        EXPECT_EQ(error, "");
        expectColor(read, 20, 96, {0, 0, 0});
        expectColor(read, 100, 96, {0, 0, 0});
        expectColor(read, 200, 96, {255, 255, 255});
    }
}

// The mean of dark and bright pixels is a middle grey on any overview.
TEST(SatelliteColors, OverviewsAreAsBrightAsTheRaster)
{
    const TempDir folder;
    const std::string file = writeNumbers(folder.path(), GDT_UInt16,
                                          [](int column, int row, int)
                                          { return isWest(column) && (column + row) % 2 ? 400.0 : 1600.0; });
    {
        const geofx::test::DatasetPtr dataset(
            GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        int factors[] = {2, 4};
        ASSERT_EQ(dataset->BuildOverviews("AVERAGE", 2, factors, 0, nullptr, nullptr, nullptr), CE_None);
    }
    for (const auto& [name, reader] : all)
        for (const int side : {columns / 2, columns / 4})
        {
            SCOPED_TRACE(testing::Message() << name << ", " << side);
            std::string error;
            const Picture read = reader(file, DataLayer::COLOR, side, error);
            EXPECT_EQ(error, "");
            expectColor(read, 60, 96, {127.5, 127.5, 127.5});
            expectColor(read, 200, 96, {255, 255, 255});
        }
}

// A large raster's numbers are looked at in one of its overviews.
TEST(SatelliteColors, TheStretchOfALargeRasterIsThatOfAnOverview)
{
    const TempDir folder;
    const std::string file = (folder / "large.tif").string();
    {
        GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
        const char* const options[] = {"SPARSE_OK=YES", "TILED=YES", "PHOTOMETRIC=RGB", nullptr};
        const geofx::test::DatasetPtr dataset(
            driver->Create(file.c_str(), 4096, 2048, 3, GDT_UInt16, const_cast<char**>(options)));
        dataset->SetGeoTransform(std::array<double, 6>{west, pixel, 0.0, north, 0.0, -pixel}.data());
        dataset->SetProjection(wktOf(32604).c_str());
        int factors[] = {4, 16};
        ASSERT_EQ(dataset->BuildOverviews("NONE", 2, factors, 0, nullptr, nullptr, nullptr), CE_None);
        for (int band = 1; band <= 3; ++band)
            for (int level = 0; level < 2; ++level)
            {
                GDALRasterBand& overview = *dataset->GetRasterBand(band)->GetOverview(level);
                ASSERT_EQ(overview.Fill(level == 0 ? 1000.0 : 9000.0), CE_None);
                std::vector<std::uint16_t> half(static_cast<std::size_t>(overview.GetXSize()) * 100, 2000);
                ASSERT_EQ(overview.RasterIO(GF_Write, 0, 0, overview.GetXSize(), 100, half.data(),
                                            overview.GetXSize(), 100, GDT_UInt16, 0, 0, nullptr),
                          CE_None);
            }
    }
    const RasterSource source(file, RasterKind::Imagery);
    EXPECT_EQ(source.bands().channels[0].range, (std::pair<double, double>(1000.0, 2000.0)));
}

TEST(SatelliteColors, TheStretchMayBeSet)
{
    const TempDir folder;
    const std::string file = writeNumbers(folder.path(), GDT_UInt16,
                                          [](int column, int, int band)
                                          { return (isWest(column) ? 300.0 : 1600.0) + 100.0 * band; });
    RasterBands bands;
    for (RasterBands::Channel& channel : bands.channels)
        channel.range = {100.0, 2100.0};
    const NotifyWatch nothingIsGuessed;
    std::string error;
    MappingRaster::Options options;
    options.bands = bands;
    const auto mapped = MappingRaster::read(file, frame(), options, error);
    ASSERT_TRUE(mapped) << error;
    expectColor(pictureOf(mapped->layer->getImage()), 60, 96, shown({300, 400, 500}, 100, 2100));
    const osg::ref_ptr<RasterTiles> tiles = TiledRaster::open(file, frame(), std::nullopt, error, bands);
    ASSERT_TRUE(tiles) << error;
    EXPECT_EQ(tiles->source()->bands->channels[2].range, bands.channels[2].range);
    const osg::ref_ptr<osg::Image> tile = tiles->read(tiles->low(), tiles->high(), columns, rows, error);
    expectColor(pictureOf(tile), 200, 96, shown({1600, 1700, 1800}, 100, 2100));
    const RasterSource source(file, RasterKind::Imagery, bands);
    EXPECT_EQ(source.bands().channels[1].range, bands.channels[1].range);
    SequenceRaster::Options steps;
    steps.maxSide = columns;
    steps.bands = bands;
    MappingFrame place = frame();
    const auto opened = SequenceRaster::open((folder / "steps").string(), place, false, steps, error);
    ASSERT_TRUE(opened) << error;
    expectColor(pictureOf(opened->steps->read(0, error)), 60, 96, shown({300, 400, 500}, 100, 2100));
    // From white to black, and of bytes, too.
    EXPECT_TRUE(bands.setRange("200,0"));
    options.bands = bands;
    const TempDir other;
    const std::string bytes =
        writeNumbers(other.path(), GDT_Byte, [](int, int, int band) { return 50.0 * band; });
    const auto inverse = MappingRaster::read(bytes, frame(), options, error);
    ASSERT_TRUE(inverse) << error;
    expectColor(pictureOf(inverse->layer->getImage()), 60, 96, {255, 191.25, 127.5});
    for (const char* const text : {"", "1", "1,", "1,1", "a,2", "1,2,3", "1;2", "nan,2"})
        EXPECT_FALSE(bands.setRange(text)) << text;
    EXPECT_EQ(bands.channels[0].range, (std::pair<double, double>(200.0, 0.0)));
}

// The pictures of a folder are as bright as the first.
TEST(SatelliteColors, StepsInTimeShareTheStretch)
{
    const TempDir folder;
    const auto write = [&](const char* name, double number)
    {
        const TempDir one;
        const std::string file =
            writeNumbers(one.path(), GDT_UInt16,
                         [&](int column, int, int) { return isWest(column) ? number : 2.0 * number; });
        fs::create_directories(folder / "steps");
        fs::copy_file(file, folder / "steps" / name);
    };
    write("a.tif", 1000.0);
    write("b.tif", 1500.0);
    MappingFrame place = frame();
    std::string error;
    const auto opened = SequenceRaster::open((folder / "steps").string(), place, false, {"", columns}, error);
    ASSERT_TRUE(opened) << error;
    expectColor(pictureOf(opened->steps->read(0, error)), 60, 96, {0, 0, 0});
    expectColor(pictureOf(opened->steps->read(1, error)), 60, 96, {127.5, 127.5, 127.5});
    expectColor(pictureOf(opened->steps->read(1, error)), 200, 96, {255, 255, 255});
}

// Rasters around the globe are six parts.
TEST(SatelliteColors, PartsOfTheWorldShowTheBands)
{
    const TempDir folder;
    TestRaster world(36, 18, 4, GDT_UInt16);
    world.placed(-180.0, 90.0, 10.0, 10.0)
        .crs("EPSG:4326")
        .fill([](int, int, int band) { return 500.0 * band; });
    for (const char* const name : {"a.tif", "b.tif"})
        world.write(folder / name, {"PHOTOMETRIC=MINISBLACK", "ALPHA=NO"});
    SequenceRaster::Options options;
    options.maxSide = 64;
    RasterBands bands;
    for (std::size_t i = 0; i < 3; ++i)
        bands.channels[i] = {4 - static_cast<int>(i), std::pair(0.0, 2000.0)};
    options.bands = bands;
    MappingFrame globe;
    std::string error;
    const auto opened = SequenceRaster::open(folder.path().string(), globe, true, options, error);
    ASSERT_TRUE(opened) << error;
    ASSERT_EQ(opened->others.size(), 5u);
    std::vector<osg::ref_ptr<SequenceSteps>> parts{opened->steps};
    for (const SequenceRaster::Part& part : opened->others)
        parts.push_back(part.steps);
    for (const osg::ref_ptr<SequenceSteps>& part : parts)
    {
        const osg::ref_ptr<osg::Image> image = part->read(1, error);
        ASSERT_TRUE(image) << error;
        expectColor(pictureOf(image), 0.6 * columns, 0.6 * rows, shown({1500, 1000, 500}, 0, 2000));
        ASSERT_TRUE(part->source()->bands);
        EXPECT_EQ(part->source()->bands->channels[2].band, 2);
    }
}

TEST(SatelliteColors, GuessesAreToldOnce)
{
    const TempDir folder;
    const std::string file = writeNumbers(
        folder.path(), GDT_UInt16, [](int column, int, int) { return isWest(column) ? 300.0 : 1600.0; });
    TestRaster four(8, 8, 4, GDT_Byte);
    four.placed(west, north, pixel, pixel).crs("EPSG:32604");
    const std::string unnamed = four.write(folder / "four.tif", {"PHOTOMETRIC=MINISBLACK", "ALPHA=NO"});
    NotifyWatch notices;
    std::string error;
    const std::vector<std::string> told = notices.messagesOf(
        [&]
        {
            for (int i = 0; i < 2; ++i)
                EXPECT_TRUE(MappingRaster::read(file, frame(), {}, error)) << error;
            builder(file, DataLayer::COLOR, columns, error);
            EXPECT_TRUE(MappingRaster::read(unnamed, frame(), {}, error)) << error;
        });
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(told[0],
              "OSG: osgGeoFX: " + file +
                  ": its numbers from 300 to 1600 (2 to 98 % of them) are shown from black to white. Set "
                  "others with --stretch LOW,HIGH, or make bytes with gdal_translate -ot Byte -scale LOW "
                  "HIGH.\n");
    EXPECT_EQ(told[1],
              "OSG: osgGeoFX: " + unnamed +
                  ": none of its 4 bands is declared to be red, green or blue, so the first three are "
                  "taken in this order; declare them with gdal_edit.py -colorinterp_1 blue "
                  "-colorinterp_2 green and so on.\n");
}

// Three bands of numbers are a picture only where they are declared to be one.
TEST(SatelliteColors, NumbersAreNoPicture)
{
    const TempDir folder;
    TestRaster heights(8, 8, 3, GDT_Float32);
    heights.placed(west, north, pixel, pixel)
        .crs("EPSG:32604")
        .fill([](int, int, int band) { return 7.0 + band; });
    const std::string file = heights.write(folder / "heights.tif", {"PHOTOMETRIC=MINISBLACK"});
    NotifyWatch notices;
    std::string error;
    std::optional<MappingRaster> read;
    const std::vector<std::string> told =
        notices.messagesOf([&] { read = MappingRaster::read(file, frame(), {}, error); });
    ASSERT_TRUE(read) << error;
    EXPECT_EQ(read->layer->getKind(), DataLayer::VALUE);
    EXPECT_EQ(read->highest, 7.0);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("the first of its 3 bands is shown, as values"), std::string::npos);
    MappingRaster::Options second;
    second.kind = DataLayer::VALUE;
    second.bands.channels[0].band = 2;
    const auto other = MappingRaster::read(file, frame(), second, error);
    ASSERT_TRUE(other) << error;
    EXPECT_EQ(other->highest, 8.0);
    second.bands.channels[0].band = 4;
    EXPECT_FALSE(MappingRaster::read(file, frame(), second, error));
    EXPECT_NE(error.find("it has 3 bands, and no band 4"), std::string::npos) << error;
    second.kind = DataLayer::COLOR;
    EXPECT_FALSE(MappingRaster::read(file, frame(), second, error));
    EXPECT_NE(error.find("it has 3 bands, and no band 4"), std::string::npos) << error;
}

// What QGIS and GeoServer say of bands in an SLD file.
TEST(SatelliteColors, AnSldFileChoosesBandsAndTheirNumbers)
{
    const TempDir folder;
    TestRaster raster(64, 64, 4, GDT_UInt16);
    raster.placed(west, north, pixel, pixel)
        .crs("EPSG:32604")
        .fill([](int column, int, int band) { return 100.0 * (band + 1) + column; });
    const std::string file = raster.write(folder / "stack.tif", {"PHOTOMETRIC=MINISBLACK", "ALPHA=NO"});
    const auto sld = [&](const std::string& symbolizer)
    {
        return folder
            .write("look.sld",
                   R"(<sld:StyledLayerDescriptor xmlns:sld="http://www.opengis.net/sld"><sld:UserLayer>
<sld:UserStyle><sld:FeatureTypeStyle><sld:Rule><sld:RasterSymbolizer>)" +
                       symbolizer +
                       "</sld:RasterSymbolizer></sld:Rule></sld:FeatureTypeStyle></sld:UserStyle>"
                       "</sld:UserLayer></sld:StyledLayerDescriptor>")
            .string();
    };
    const auto channel = [](const std::string& color, int band, const std::string& more = "")
    {
        return "<sld:" + color + "Channel><sld:SourceChannelName>" + std::to_string(band) +
               "</sld:SourceChannelName>" + more + "</sld:" + color + "Channel>";
    };
    const auto range = [](int low, int high)
    {
        const auto option = [](const std::string& name, const std::string& text)
        {
            return "<sld:VendorOption name=\"" + name + "\">" + text + "</sld:VendorOption>";
        };
        return "<sld:ContrastEnhancement><sld:Normalize>" + option("algorithm", "StretchToMinimumMaximum") +
               option("minValue", std::to_string(low)) + option("maxValue", std::to_string(high)) +
               "</sld:Normalize></sld:ContrastEnhancement>";
    };
    const auto read = [&](const std::string& symbolizer, OverlayReader& reader)
    {
        reader.globe = false;
        reader.wkt = wktOf(32604);
        OverlayReader::Options options;
        options.colors = sld(symbolizer);
        std::string error;
        reader.read(file, options, error);
        return error;
    };
    // Infrared, red and green as red, green and blue, with a range for each.
    OverlayReader colors;
    EXPECT_EQ(read("<sld:Opacity>0.5</sld:Opacity><sld:ChannelSelection>" +
                       channel("Red", 4, range(400, 500)) + channel("Green", 3, range(200, 400)) +
                       channel("Blue", 2, range(0, 300)) + "</sld:ChannelSelection>",
                   colors),
              "");
    ASSERT_EQ(colors.overlays.size(), 1u);
    EXPECT_EQ(colors.overlays[0].opacity, 0.5);
    EXPECT_TRUE(colors.notices.empty());
    const Picture::Texel texel = pictureOf(colors.overlays[0].layer->getImage()).at(32, 32);
    EXPECT_NEAR(texel[0], shown(432, 400, 500), 1.0);
    EXPECT_NEAR(texel[1], shown(332, 200, 400), 1.0);
    EXPECT_NEAR(texel[2], shown(232, 0, 300), 1.0);
    // One band in grey.
    OverlayReader greys;
    EXPECT_EQ(read("<sld:ChannelSelection>" + channel("Gray", 3, range(300, 400)) + "</sld:ChannelSelection>",
                   greys),
              "");
    const Picture::Texel greyTexel = pictureOf(greys.overlays.at(0).layer->getImage()).at(32, 32);
    EXPECT_NEAR(greyTexel[0], shown(332, 300, 400), 1.0);
    EXPECT_NEAR(greyTexel[2], shown(332, 300, 400), 1.0);
    // One band's values through a color map, half as opaque.
    OverlayReader values;
    EXPECT_EQ(
        read(
            "<sld:Opacity>0.5</sld:Opacity><sld:ChannelSelection>" + channel("Gray", 3) +
                "</sld:ChannelSelection><sld:ColorMap><sld:ColorMapEntry color=\"#ff0000\" quantity=\"300\"/>"
                "<sld:ColorMapEntry color=\"#0000ff\" quantity=\"400\" opacity=\"0.5\"/></sld:ColorMap>",
            values),
        "");
    ASSERT_EQ(values.overlays.size(), 1u);
    EXPECT_EQ(values.overlays[0].layer->getKind(), DataLayer::VALUE);
    EXPECT_NEAR(values.overlays[0].lowest, 300.0, 1.0);
    EXPECT_NEAR(values.overlays[0].highest, 363.0, 1.0);
    EXPECT_EQ(values.overlays[0].table->at(300.0), osg::Vec4(1, 0, 0, 0.5f));
    EXPECT_EQ(values.overlays[0].table->at(400.0), osg::Vec4(0, 0, 1, 0.25f));
    EXPECT_EQ(values.overlays[0].opacity, 1.0);
    // What is left out is told, and what cannot be is refused.
    OverlayReader odd;
    EXPECT_EQ(read("<sld:ChannelSelection>" + channel("Gray", 1) +
                       "</sld:ChannelSelection><sld:ContrastEnhancement><sld:Histogram/><sld:GammaValue>1.5</"
                       "sld:GammaValue>"
                       "</sld:ContrastEnhancement><sld:ShadedRelief/><sld:VendorOption "
                       "name=\"saturation\">0.5</sld:VendorOption>",
                   odd),
              "");
    ASSERT_EQ(odd.notices.size(), 4u);
    EXPECT_NE(odd.notices[0].find("look.sld: GammaValue of its RasterSymbolizer is left out"),
              std::string::npos);
    EXPECT_NE(odd.notices[3].find("saturation of its RasterSymbolizer is left out"), std::string::npos);
    OverlayReader bad;
    EXPECT_NE(read("<sld:ChannelSelection>" + channel("Gray", 5) + "</sld:ChannelSelection>", bad)
                  .find("stack.tif: it has 4 bands, and no band 5"),
              std::string::npos);
    EXPECT_NE(read("<sld:ChannelSelection>" + channel("Gray", 0) + "</sld:ChannelSelection>", bad)
                  .find("the channel is \"0\"; write the number of a band"),
              std::string::npos);
    EXPECT_NE(read("<sld:Opacity>2</sld:Opacity>", bad).find("the opacity is \"2\""), std::string::npos);
    EXPECT_NE(read("", bad).find("it has no ColorMap"), std::string::npos);
}
