// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/ThinnedRaster.h>

#include <osgGeoFX/geodata/detail/Lengths.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/geodata/detail/RasterMask.h>
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <osgGeoFX/terrain/detail/WaterFinder.h>

#include <gdal_alg.h>
#include <gdal_utils.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

namespace osgGeoFX
{

namespace
{

/// Samples beyond the outermost place.
constexpr int room = 16;
/// GDAL's cache while a copy is written, bytes.
constexpr GIntBig copyCache = 192 << 20;
constexpr double earthRadius = 6378137.0;
/// Elevation below the sea is a depth only if it reaches this far down somewhere, metres. Otherwise it is noise about 0.
constexpr double leastDepth = 10.0;
/// As BuildOptions::lakeArea; only the sea matters here.
constexpr double lakeArea = 2e5;

/// With a mask where one is needed.
DatasetChain openMasked(const std::string& file, bool allHeights)
{
    DatasetChain chain = RasterFile::open(file);
    auto mask = std::make_unique<RasterMask>(chain.top(), std::vector<int>{1},
                                             allHeights ? UndeclaredVoids() : UndeclaredVoids::of(file));
    if (!mask->isEmpty() && !mask->isNoDataValue())
        RasterMask::addTo(chain, std::move(mask), RasterMask::Form::NOT_A_NUMBER);
    return chain;
}

/// From the values of a band to metres.
struct HeightScale
{
    HeightScale(GDALDataset& dataset, const std::string& file)
    {
        GDALRasterBand& band = *dataset.GetRasterBand(1);
        scale = band.GetScale() != 0.0 ? band.GetScale() : 1.0;
        offset = band.GetOffset();
        const OGRSpatialReference* const srs = dataset.GetSpatialRef();
        metres = Lengths::metresPerHeight(band, srs ? *srs : OGRSpatialReference(), file);
    }
    double height(double value) const { return (value * scale + offset) * metres; }
    /// The value of the sea's surface.
    double surface() const { return -offset / scale; }

    double scale = 1.0, offset = 0.0, metres = 1.0;
};

void takeScale(GDALRasterBand& from, GDALRasterBand& to)
{
    int has = 0;
    const double scale = from.GetScale(&has);
    if (has) to.SetScale(scale);
    const double offset = from.GetOffset(&has);
    if (has) to.SetOffset(offset);
    if (from.GetUnitType() && *from.GetUnitType()) to.SetUnitType(from.GetUnitType());
}

bool hasSeaFloor(GDALDataset& dataset, const std::string& file)
{
    GdalErrorScope errors;
    double range[2] = {0.0, 0.0};
    // Approximate: from overviews or some of the blocks, where the raster is large.
    if (dataset.GetRasterBand(1)->ComputeRasterMinMax(TRUE, range) != CE_None) return false;
    return HeightScale(dataset, file).height(range[0]) < -leastDepth;
}

/// Gives the sea of a raster the height 0.
void flattenSea(GDALDataset& dataset, const std::string& file, double spacing)
{
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    const HeightScale scale(dataset, file);
    int known = 0;
    const double none = band.GetNoDataValue(&known);
    const int columns = dataset.GetRasterXSize(), rows = dataset.GetRasterYSize();
    std::vector<float> values(static_cast<std::size_t>(columns)), heights(values.size());
    const auto transfer = [&](GDALRWFlag way, int row)
    {
        if (band.RasterIO(way, 0, row, columns, 1, values.data(), columns, 1, GDT_Float32, 0, 0) != CE_None)
            throw BuildError(file + ": cannot be read back or written; check the disk's space.");
    };
    const auto read = [&](int row)
    {
        transfer(GF_Read, row);
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            const auto value = static_cast<double>(values[i]);
            const bool hole =
                std::isnan(value) || (known && value == static_cast<double>(static_cast<float>(none)));
            heights[i] =
                hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(scale.height(value));
        }
    };
    WaterFinder finder(columns, std::vector<double>(static_cast<std::size_t>(rows), spacing * spacing),
                       lakeArea);
    for (int row = 0; row < rows; ++row)
    {
        read(row);
        finder.add(heights);
    }
    for (int row = rows; row-- > 0;)
    {
        read(row);
        const std::vector<GroundKind> kinds = finder.mark(heights);
        bool changed = false;
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            if (kinds[i] != GroundKind::SEA || !(heights[i] < 0.0f)) continue;
            values[i] = static_cast<float>(scale.surface());
            changed = true;
        }
        if (changed) transfer(GF_Write, row);
    }
}

int CPL_STDCALL report(double done, const char*, void* progress)
{
    const auto& action = *static_cast<const std::function<bool(double)>*>(progress);
    return !action || action(done) ? TRUE : FALSE;
}

} // namespace

ThinnedRaster::Size ThinnedRaster::look(const std::string& file, bool allHeights)
{
    const GdalErrorScope quiet; // also where a file's metadata are read late
    const Footprint footprint = RasterSource(file, RasterKind::Elevation).footprint(GridCrs::geocentric());
    const DatasetChain chain = openMasked(file, allHeights);
    GDALDataset& dataset = chain.top();
    const double metre = osg::DegreesToRadians(earthRadius);
    const double middle = osg::DegreesToRadians(0.5 * (footprint.south + footprint.north));
    return {dataset.GetRasterXSize(), dataset.GetRasterYSize(),
            metre * std::min(footprint.stepX * std::cos(middle), footprint.stepY),
            hasSeaFloor(dataset, file)};
}

ThinnedRaster::Cut ThinnedRaster::cut(const std::string& file, const std::vector<osg::Vec2d>& places,
                                      int factor)
{
    const GdalErrorScope quiet;
    const DatasetChain chain = RasterFile::open(file);
    GDALDataset* const dataset = &chain.top();
    const int columns = dataset->GetRasterXSize(), rows = dataset->GetRasterYSize();
    Cut result{0, 0, columns, rows, std::max(factor, 1)};
    if (!places.empty())
    {
        GdalErrorScope errors;
        char** options = CSLSetNameValue(nullptr, "DST_SRS", "OGC:CRS84");
        const std::unique_ptr<void, void (*)(void*)> transformer(
            GDALCreateGenImgProjTransformer2(dataset, nullptr, options), GDALDestroyGenImgProjTransformer);
        CSLDestroy(options);
        if (!transformer)
            throw BuildError(file +
                             ": its georeference cannot be used; assign one with gdal_translate -a_srs and "
                             "-a_ullr" +
                             (errors.failed() ? " (" + errors.message() + ")." : "."));
        double west = HUGE_VAL, east = -HUGE_VAL, top = HUGE_VAL, bottom = -HUGE_VAL;
        for (const osg::Vec2d& place : places)
        {
            double x = place.x(), y = place.y(), z = 0.0;
            int good = 0;
            if (!GDALGenImgProjTransform(transformer.get(), TRUE, 1, &x, &y, &z, &good) || !good) continue;
            west = std::min(west, x);
            east = std::max(east, x);
            top = std::min(top, y);
            bottom = std::max(bottom, y);
        }
        const double more = static_cast<double>(room) * result.factor;
        const auto pixel = [](double value, int count)
        {
            return static_cast<int>(std::clamp(value, 0.0, double(count)));
        };
        result.left = pixel(std::floor(west - more), columns);
        result.columns = pixel(std::ceil(east + more), columns) - result.left;
        result.top = pixel(std::floor(top - more), rows);
        result.rows = pixel(std::ceil(bottom + more), rows) - result.top;
    }
    // Whole squares, so that all samples are means of as many pixels.
    result.columns -= result.columns % result.factor;
    result.rows -= result.rows % result.factor;
    if (result.columns < 2 * result.factor || result.rows < 2 * result.factor)
        result.columns = result.rows = 0;
    return result;
}

void ThinnedRaster::write(const std::string& file, const Cut& cut, const std::string& output,
                          const std::function<bool(double)>& progress, bool allHeights)
{
    const GdalErrorScope quiet;
    const DatasetChain chain = openMasked(file, allHeights);
    std::vector<std::string> words = {
        "-of", "GTiff",     "-ot", "Float32",       "-r",  "average",         "-b", "1",
        "-co", "TILED=YES", "-co", "COMPRESS=NONE", "-co", "BIGTIFF=IF_SAFER"};
    const auto add = [&](const char* option, std::initializer_list<int> values)
    {
        words.emplace_back(option);
        for (const int value : values)
            words.push_back(std::to_string(value));
    };
    add("-srcwin", {cut.left, cut.top, cut.columns, cut.rows});
    add("-outsize", {cut.columns / cut.factor, cut.rows / cut.factor});
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const std::unique_ptr<GDALTranslateOptions, void (*)(GDALTranslateOptions*)> options(
        GDALTranslateOptionsNew(arguments.data(), nullptr), GDALTranslateOptionsFree);
    std::function<bool(double)> action = progress;
    GDALTranslateOptionsSetProgress(options.get(), report, &action);
    // GDAL's own choice is a share of the machine's memory.
    const GdalCacheLimit limit(copyCache);
    GdalErrorScope errors;
    const std::string unfinished = output + ".part";
    int misused = 0;
    DatasetPtr copy(static_cast<GDALDataset*>(
        GDALTranslate(unfinished.c_str(), GDALDataset::ToHandle(&chain.top()), options.get(), &misused)));
    const bool made = copy && !misused;
    // GDAL leaves them out where the type changes.
    if (made) takeScale(*chain.file().GetRasterBand(1), *copy->GetRasterBand(1));
    if (made && hasSeaFloor(*copy, file))
        flattenSea(*copy, unfinished, look(file, allHeights).spacing * cut.factor);
    copy.reset(); // Writes what is left.
    std::error_code fault;
    if (made && !errors.failed()) std::filesystem::rename(unfinished, output, fault);
    if (!made || errors.failed() || fault)
    {
        std::filesystem::remove(unfinished, fault);
        throw BuildError(output + ": a coarser copy of " + file +
                         " cannot be written; check the folder, its permissions and the disk's space" +
                         (errors.failed() ? " (" + errors.message() + ")." : "."));
    }
}

} // namespace osgGeoFX
