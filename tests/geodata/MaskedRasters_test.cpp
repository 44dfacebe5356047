// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which pixels of a raster are missing: each way to say it, with each kind of overviews and storage, through each reader. What is
// missing has colors and values that must not show, not even mixed with those beside it.
#include <geodata/RasterReaders.h>
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gdal_utils.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

using namespace geofx::test;
using namespace geofx::test::readers;

namespace
{

constexpr double least = 1000.0, most = 1400.0;      ///< of the values that are there
constexpr double garbage = 5000.0, absent = 65000.0; ///< of those that are masked, and of no-data

enum class Mask
{
    NONE,
    INTERNAL,
    BESIDE, ///< .msk
    ALPHA,
    NO_DATA,
    NO_DATA_OF_ONE ///< of a color's red; of the second of two bands of values
};

enum class Overviews
{
    NONE,
    INTERNAL,
    BESIDE ///< .ovr
};

struct Storage
{
    std::string compression;
    bool tiles;

    bool isLossy() const { return compression == "JPEG"; }
};

struct Sample
{
    Mask mask;
    Overviews overviews;
    Storage storage;
};

std::ostream& operator<<(std::ostream& stream, const Sample& sample)
{
    static const char* const masks[] = {"no mask", "internal mask",        ".msk",
                                        "alpha",   "no-data of all bands", "no-data of one band"};
    static const char* const overviews[] = {"no overviews", "internal overviews", ".ovr"};
    return stream << masks[static_cast<int>(sample.mask)] << ", "
                  << overviews[static_cast<int>(sample.overviews)] << ", " << sample.storage.compression
                  << (sample.storage.tiles ? " tiles" : " strips");
}

/// Its borders are those of blocks of JPEG, also in overviews.
bool isHole(int column, int row)
{
    return column >= 64 && column < 128 && row >= 64 && row < 128;
}

bool isMissing(const Sample& sample, int column, int row)
{
    return sample.mask != Mask::NONE && sample.mask != Mask::NO_DATA_OF_ONE && isHole(column, row);
}

bool hasNoData(const Sample& sample)
{
    return sample.mask == Mask::NO_DATA || sample.mask == Mask::NO_DATA_OF_ONE;
}

std::array<int, 3> colorAt(const Sample& sample, int column, int row)
{
    if (isHole(column, row))
        return hasNoData(sample) ? std::array<int, 3>{0, 0, 0} : std::array<int, 3>{250, 0, 250};
    // One band of these has the value of no-data.
    if (column < 32) return {0, 200, 100};
    if (column >= 192) return {200, 60, 0};
    if (row >= 160) return {230, 230, 230};
    return {40, 160, 90};
}

double valueAt(const Sample& sample, int column, int row)
{
    if (isHole(column, row)) return sample.mask == Mask::NO_DATA ? absent : garbage;
    if (column < 32) return 1200.0;
    return column >= 192 ? most : least;
}

int classAt(const Sample& sample, int column, int row)
{
    if (isHole(column, row)) return sample.mask == Mask::NO_DATA ? 0 : 7;
    if (column < 32) return 1;
    return column >= 192 ? 2 : 3;
}

/// Pixels that are looked at: six that are far from any border, and six beside the hole's.
constexpr std::array<std::array<int, 2>, 12> places{{{96, 96},
                                                     {160, 40},
                                                     {16, 96},
                                                     {224, 96},
                                                     {160, 176},
                                                     {10, 10},
                                                     {65, 65},
                                                     {126, 126},
                                                     {60, 96},
                                                     {131, 96},
                                                     {96, 60},
                                                     {96, 131}}};
constexpr std::size_t farPlaces = 6;

class ConfigOption
{
public:
    ConfigOption(const char* name, const char* value) : _name(name) { CPLSetConfigOption(name, value); }
    ~ConfigOption() { CPLSetConfigOption(_name, nullptr); }
    ConfigOption(const ConfigOption&) = delete;
    ConfigOption& operator=(const ConfigOption&) = delete;

private:
    const char* const _name;
};

/// A file of a sample, alone in its folder. `alphaMost`: of the type.
std::string write(const fs::path& folder, const Sample& sample, int bands, GDALDataType type,
                  const TestRaster::Value& value)
{
    const double opaque = type == GDT_Byte ? 255.0 : 65535.0;
    const bool hasAlpha = sample.mask == Mask::ALPHA;
    TestRaster source(columns, rows, bands + (hasAlpha ? 1 : 0), type);
    source.placed(west, north, pixel, pixel).crs("EPSG:32604");
    source.fill([&](int column, int row, int band)
                { return band == bands ? (isHole(column, row) ? 0.0 : opaque) : value(column, row, band); });
    if (bands == 3)
        for (int band = 1; band <= 3; ++band)
            source.dataset().GetRasterBand(band)->SetColorInterpretation(
                static_cast<GDALColorInterp>(GCI_RedBand + band - 1));
    if (hasAlpha) source.dataset().GetRasterBand(bands + 1)->SetColorInterpretation(GCI_AlphaBand);
    if (sample.mask == Mask::NO_DATA)
        for (int band = 1; band <= bands; ++band)
            source.dataset().GetRasterBand(band)->SetNoDataValue(type == GDT_Byte ? 0.0 : absent);
    std::vector<std::string> options{"COMPRESS=" + sample.storage.compression,
                                     sample.storage.tiles ? "TILED=YES" : "TILED=NO"};
    if (sample.storage.tiles) options.insert(options.end(), {"BLOCKXSIZE=64", "BLOCKYSIZE=64"});
    if (!sample.storage.tiles) options.emplace_back("BLOCKYSIZE=16");
    if (sample.storage.isLossy() && bands == 3 && !hasAlpha) options.emplace_back("PHOTOMETRIC=YCBCR");
    // GeoTIFFs have one no-data value for all bands; a virtual dataset elsewhere has one of a band alone.
    const bool isVirtual = sample.mask == Mask::NO_DATA_OF_ONE;
    fs::create_directories(folder / "steps");
    fs::create_directories(folder / "base");
    const std::string file = source.write(folder / (isVirtual ? "base" : "steps") / "raster.tif", options);
    if (sample.mask == Mask::INTERNAL || sample.mask == Mask::BESIDE)
    {
        const ConfigOption internal("GDAL_TIFF_INTERNAL_MASK", sample.mask == Mask::INTERNAL ? "YES" : "NO");
        const geofx::test::DatasetPtr dataset(
            GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        EXPECT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
        std::vector<unsigned char> mask;
        for (int i = 0; i < columns * rows; ++i)
            mask.push_back(isHole(i % columns, i / columns) ? 0 : 255);
        EXPECT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(
                      GF_Write, 0, 0, columns, rows, mask.data(), columns, rows, GDT_Byte, 0, 0, nullptr),
                  CE_None);
    }
    if (sample.overviews != Overviews::NONE)
    {
        const geofx::test::DatasetPtr dataset(GDALDataset::Open(
            file.c_str(), GDAL_OF_RASTER | (sample.overviews == Overviews::INTERNAL ? GDAL_OF_UPDATE : 0)));
        int factors[] = {2, 4};
        const char* const resampling = bands == 1 && type == GDT_Byte ? "NEAREST" : "AVERAGE";
        EXPECT_EQ(dataset->BuildOverviews(resampling, 2, factors, 0, nullptr, nullptr, nullptr), CE_None);
    }
    if (!isVirtual) return file;
    const std::string result = (folder / "steps" / "raster.vrt").string();
    const geofx::test::DatasetPtr base(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    CPLStringList arguments;
    arguments.AddString("-of");
    arguments.AddString("VRT");
    GDALTranslateOptions* const translation = GDALTranslateOptionsNew(arguments.List(), nullptr);
    const geofx::test::DatasetPtr dataset(GDALDataset::FromHandle(
        GDALTranslate(result.c_str(), GDALDataset::ToHandle(base.get()), translation, nullptr)));
    GDALTranslateOptionsFree(translation);
    dataset->GetRasterBand(bands == 3 ? 1 : 2)->SetNoDataValue(type == GDT_Byte ? 0.0 : absent);
    return result;
}

std::vector<Sample> samples(bool lossy)
{
    std::vector<Sample> result;
    for (const Mask mask :
         {Mask::NONE, Mask::INTERNAL, Mask::BESIDE, Mask::ALPHA, Mask::NO_DATA, Mask::NO_DATA_OF_ONE})
        for (const Overviews overviews : {Overviews::NONE, Overviews::INTERNAL, Overviews::BESIDE})
            for (const char* const compression : {"JPEG", "DEFLATE", "LZW", "NONE"})
                for (const bool tiles : {false, true})
                    if (lossy || std::string(compression) != "JPEG")
                        result.push_back({mask, overviews, {compression, tiles}});
    return result;
}

/// How virtual rasters stand on a file.
const char* const virtualForms[] = {"the file",           "a mosaic",     "a mosaic of a mosaic",
                                    "a copy of a mosaic", "a warped one", "a mosaic beside a lossless file"};

geofx::test::DatasetPtr opened(const std::string& file)
{
    return geofx::test::DatasetPtr(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
}

std::string writeMosaic(const fs::path& result, const std::vector<std::string>& files)
{
    std::vector<const char*> names;
    for (const std::string& file : files)
        names.push_back(file.c_str());
    const geofx::test::DatasetPtr dataset(GDALDataset::FromHandle(GDALBuildVRT(
        result.c_str(), static_cast<int>(names.size()), nullptr, names.data(), nullptr, nullptr)));
    EXPECT_TRUE(dataset);
    return result.string();
}

std::string writeCopy(const fs::path& result, const std::string& file)
{
    CPLStringList arguments;
    arguments.AddString("-of");
    arguments.AddString("VRT");
    GDALTranslateOptions* const options = GDALTranslateOptionsNew(arguments.List(), nullptr);
    const geofx::test::DatasetPtr source = opened(file);
    const geofx::test::DatasetPtr dataset(GDALDataset::FromHandle(
        GDALTranslate(result.c_str(), GDALDataset::ToHandle(source.get()), options, nullptr)));
    GDALTranslateOptionsFree(options);
    EXPECT_TRUE(dataset);
    return result.string();
}

std::string writeWarped(const fs::path& result, const std::string& file)
{
    CPLStringList arguments;
    arguments.AddString("-of");
    arguments.AddString("VRT");
    GDALWarpAppOptions* const options = GDALWarpAppOptionsNew(arguments.List(), nullptr);
    const geofx::test::DatasetPtr source = opened(file);
    GDALDatasetH handle = GDALDataset::ToHandle(source.get());
    const geofx::test::DatasetPtr dataset(
        GDALDataset::FromHandle(GDALWarp(result.c_str(), nullptr, 1, &handle, options, nullptr)));
    GDALWarpAppOptionsFree(options);
    EXPECT_TRUE(dataset);
    return result.string();
}

/// A virtual raster of a sample, alone in its folder. `form`: of virtualForms.
std::string writeVirtual(const fs::path& folder, const Sample& sample, std::size_t form,
                         const TestRaster::Value& value)
{
    const std::string file = write(folder / "own", sample, 3, GDT_Byte, value);
    fs::create_directories(folder / "steps");
    const fs::path result = folder / "steps" / "raster.vrt", below = folder / "below.vrt";
    switch (form)
    {
    case 0:
        return file;
    case 1:
        return writeMosaic(result, {file});
    case 2:
        return writeMosaic(result, {writeMosaic(below, {file})});
    case 3:
        return writeCopy(result, writeMosaic(below, {file}));
    case 4:
        return writeWarped(result, file);
    default:
    {
        Sample lossless = sample;
        lossless.storage = {"DEFLATE", true};
        return writeMosaic(result, {write(folder / "other", lossless, 3, GDT_Byte,
                                          [&](int column, int row, int band)
                                          { return isHole(column, row) ? 0.0 : value(column, row, band); }),
                                    file});
    }
    }
}

/// All of them in ./tests/run --full, else each mask with each kind of overviews, in one storage: those with no-data of all bands in
/// JPEG, which rounds it.
bool isTaken(std::size_t index, std::size_t storages)
{
    return fullTest() || index % storages == (index / storages + 4) % storages;
}

/// Whether a texel is so near to the hole that the same is all around it. JPEG itself mixes the colors on both sides of the border.
bool isAroundHole(const Sample& sample, double column, double row)
{
    constexpr double mixed = 8.0;
    const double beside = std::max({64.0 - column, column - 128.0, 64.0 - row, row - 128.0});
    return column > 40.0 && column < 184.0 && row > 8.0 && row < 152.0 &&
           (!sample.storage.isLossy() || beside > mixed || beside < -mixed);
}

/// `expected`: the numbers of a pixel.
template<typename Expected>
void check(const Sample& sample, const Picture& picture, const Expected& expected, double tolerance)
{
    ASSERT_GT(picture.width, 0);
    const double wide = static_cast<double>(columns) / picture.width,
                 high = static_cast<double>(rows) / picture.height;
    // A coarser texel beside a border is of both sides.
    const std::size_t looks = picture.width == columns ? places.size() : farPlaces;
    for (std::size_t k = 0; k < looks; ++k)
    {
        const auto [column, row] = places[k];
        const Picture::Texel texel =
            picture.at(static_cast<int>((column + 0.5) / wide), static_cast<int>((row + 0.5) / high));
        if (isMissing(sample, column, row))
        {
            EXPECT_LE(texel[3], 2.0) << "at " << column << ", " << row;
            continue;
        }
        EXPECT_GE(texel[3], 253.0) << "at " << column << ", " << row;
        const auto right = expected(sample, column, row);
        for (std::size_t i = 0; i < right.size(); ++i)
            EXPECT_NEAR(texel[i], right[i], tolerance) << "at " << column << ", " << row << ", number " << i;
    }
    // Nothing of what is missing shows in a texel beside it.
    if (!isMissing(sample, 96, 96)) return;
    const auto around = expected(sample, 60, 96);
    double worst = 0.0;
    for (int row = 0; row < picture.height; ++row)
        for (int column = 0; column < picture.width; ++column)
        {
            if (!isAroundHole(sample, (column + 0.5) * wide, (row + 0.5) * high)) continue;
            const Picture::Texel texel = picture.at(column, row);
            for (std::size_t i = 0; i < around.size() && texel[3] > 0.0; ++i)
                worst = std::max(worst, std::abs(texel[i] - around[i]));
        }
    EXPECT_LE(worst, tolerance) << "at the border of what is missing";
}

/// Each reader with each sample that is taken. `bandsOf`: of a sample; `toleranceOf`: the same.
template<typename Expected>
void checkAll(const std::vector<Sample>& samples, std::size_t storages,
              const std::map<std::string, Reader>& readers, DataLayer::Kind kind,
              const std::function<std::string(const fs::path&, const Sample&)>& write,
              const Expected& expected, double tolerance)
{
    std::size_t index = 0;
    for (const Sample& sample : samples)
    {
        if (!isTaken(index++, storages)) continue;
        const TempDir folder;
        const std::string file = write(folder.path(), sample);
        for (const auto& [name, reader] : readers)
            for (const int side : {columns, 100, columns / 4})
            {
                SCOPED_TRACE(testing::Message() << sample << ", " << name << ", " << side << " texels");
                std::string error;
                const Picture read = reader(file, kind, side, error);
                EXPECT_EQ(error, "");
                check(sample, read, expected, sample.storage.isLossy() ? 12.0 : tolerance);
            }
    }
}

} // namespace

TEST(MaskedRasters, ColorsAreThoseOfTheirPlaces)
{
    const auto make = [](const fs::path& folder, const Sample& sample)
    {
        return write(folder, sample, 3, GDT_Byte,
                     [&](int column, int row, int band)
                     { return colorAt(sample, column, row)[static_cast<std::size_t>(band)]; });
    };
    checkAll(samples(true), 8,
             {{"mapping", mapping},
              {"tiled", tiled},
              {"sequence", sequence},
              {"picture", picture},
              {"overlay", overlay},
              {"surface", surface},
              {"builder", builder}},
             DataLayer::COLOR, make, colorAt, 1.0);
}

// A hole of JPEG has values beside no-data: in the file, and in virtual rasters of it.
TEST(MaskedRasters, VirtualRastersAreAsRoughAsTheirFiles)
{
    const std::map<std::string, Reader> readers{
        {"mapping", mapping}, {"tiled", tiled},     {"sequence", sequence}, {"picture", picture},
        {"overlay", overlay}, {"surface", surface}, {"builder", builder}};
    const auto rough = [](const Sample& sample)
    {
        return [&sample](int column, int row, int band)
        {
            if (isHole(column, row)) return (column / 8 + row / 8) % 3 * 1.0;
            return colorAt(sample, column, row)[static_cast<std::size_t>(band)] * 1.0;
        };
    };
    for (std::size_t form = 0; form < std::size(virtualForms); ++form)
    {
        SCOPED_TRACE(virtualForms[form]);
        checkAll(
            {{Mask::NO_DATA, Overviews::INTERNAL, {"JPEG", true}}}, 1, readers, DataLayer::COLOR,
            [&](const fs::path& folder, const Sample& sample)
            { return writeVirtual(folder, sample, form, rough(sample)); },
            colorAt, 1.0);
    }
}

TEST(MaskedRasters, ValuesAreThoseOfTheirPlaces)
{
    const auto make = [](const fs::path& folder, const Sample& sample)
    {
        // The second band is a second step.
        return write(folder, sample, 2, GDT_UInt16,
                     [&](int column, int row, int band)
                     { return band == 0 ? valueAt(sample, column, row) : absent; });
    };
    checkAll(
        samples(false), 6,
        {{"mapping", mapping},
         {"tiled", tiled},
         {"sequence", sequence},
         {"picture", picture},
         {"surface", surface},
         {"builder", builder},
         {"thinned", thinned}},
        DataLayer::VALUE, make,
        [](const Sample& sample, int column, int row)
        { return std::array<double, 1>{valueAt(sample, column, row)}; },
        1.0);
}

TEST(MaskedRasters, ClassesAreThoseOfTheirPlaces)
{
    const auto make = [](const fs::path& folder, const Sample& sample)
    {
        const int bands = sample.mask == Mask::NO_DATA_OF_ONE ? 2 : 1;
        return write(folder, sample, bands, GDT_Byte,
                     [&](int column, int row, int band)
                     { return band == 0 ? classAt(sample, column, row) : 0; });
    };
    checkAll(
        samples(false), 6,
        {{"mapping", mapping},
         {"tiled", tiled},
         {"picture", picture},
         {"surface", surface},
         {"builder", builder},
         {"colorized", colorized}},
        DataLayer::CLASS, make,
        [](const Sample& sample, int column, int row)
        { return std::array<double, 1>{classAt(sample, column, row) * 1.0}; },
        0.1);
}
