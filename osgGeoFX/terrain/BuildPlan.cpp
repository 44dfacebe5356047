// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "BuildPlan.h"

#include <osgGeoFX/geodata/BuildError.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <thread>

namespace osgGeoFX
{

namespace
{

constexpr int FORMAT_VERSION = 1;
constexpr int MAX_LEVEL = 20;

void require(bool condition, const std::string& sentence)
{
    if (!condition)
        throw BuildError(sentence);
}

std::vector<Footprint> footprints(const std::vector<std::string>& files, RasterKind kind, const GridCrs& crs)
{
    std::vector<Footprint> result;
    for (const auto& file : files)
        result.push_back(RasterSource(file, kind).footprint(crs));
    return result;
}

/// The shortest range of longitudes that holds all footprints, which it turns by full circles to lie in it.
void gatherLongitudes(std::vector<Footprint>& prints)
{
    const auto turnedTo = [](Footprint print, double start)
    {
        const double turns = std::ceil((start - print.west) / 360.0 - 1e-12);
        print.west += 360.0 * turns;
        print.east += 360.0 * turns;
        return print;
    };
    double best = std::numeric_limits<double>::max(), bestStart = 0.0;
    for (const auto& candidate : prints)
    {
        double east = candidate.east;
        for (const auto& other : prints)
            east = std::max(east, turnedTo(other, candidate.west).east);
        if (east - candidate.west < best - 1e-9)
        {
            best = east - candidate.west;
            bestStart = candidate.west;
        }
    }
    // As near to the usual −180…180 as it goes.
    bestStart -= 360.0 * std::floor((bestStart + 180.0) / 360.0 + 1e-12);
    for (auto& print : prints)
        print = turnedTo(print, bestStart);
}

bool overlaps(const Footprint& print, const TilingScheme& scheme)
{
    if (print.south >= scheme.north || print.north <= scheme.south)
        return false;
    if (!scheme.crs.geographic)
        return print.west < scheme.east && print.east > scheme.west;
    for (const double turn : {-360.0, 0.0, 360.0})
        if (print.west + turn < scheme.east && print.east + turn > scheme.west)
            return true;
    return false;
}

} // namespace

BuildPlan::BuildPlan(const BuildOptions& o) : options(o)
{
    initialiseGdal();
    require(!options.dems.empty(), "No elevation raster is named; give at least one with --dem FILE.");
    require(!options.output.empty(), "No folder for the database is named; give one with -o DIR.");
    require(options.tileSize >= 8 && options.tileSize <= 240,
            "The tile size must be 8 to 240 intervals (it is " + std::to_string(options.tileSize) + ").");
    require(options.textureSize == 0 || (options.textureSize >= 16 && options.textureSize <= 4096 &&
                                         options.textureSize % 2 == 0),
            "The texture size must be an even number from 16 to 4096 (it is " +
                std::to_string(options.textureSize) + ").");
    require(options.pixelError > 0.0 && options.texelError > 0.0 && options.pixelsPerRadian > 0.0,
            "The pixel error, the texel error and the pixels per radian must be greater than 0.");
    require(options.memoryMiB >= 128,
            "At least 128 MiB of memory are needed (--memory is " + std::to_string(options.memoryMiB) + ").");
    require(options.landCover.empty() || !options.landCoverTable.empty(),
            options.landCover + ": a land-cover raster needs its table; name it with --landcover-table CSV.");
    require(options.landCoverTable.empty() || !options.landCover.empty(),
            options.landCoverTable + ": a land-cover table needs its raster; name it with --landcover FILE.");

    scheme.crs = options.epsg == 0 ? GridCrs::geocentric() : GridCrs::projected(options.epsg);
    if (!options.landCover.empty())
    {
        classes = readLandCoverTable(options.landCoverTable);
        for (const auto& entry : classes)
        {
            auto& color = classColors[static_cast<std::size_t>(entry.value)];
            color = {entry.color[0], entry.color[1], entry.color[2], 255};
        }
    }
    chooseGrid();
    chooseUnits();
    chooseFingerprint();
}

void BuildPlan::chooseGrid()
{
    auto dems = footprints(options.dems, RasterKind::Elevation, scheme.crs);
    if (scheme.crs.geographic)
        gatherLongitudes(dems);
    scheme.west = scheme.south = std::numeric_limits<double>::max();
    scheme.east = scheme.north = std::numeric_limits<double>::lowest();
    double stepX = scheme.west, stepY = scheme.west;
    bool wholeCircle = false;
    for (const auto& print : dems)
    {
        scheme.west = std::min(scheme.west, print.west);
        scheme.east = std::max(scheme.east, print.east);
        scheme.south = std::min(scheme.south, print.south);
        scheme.north = std::max(scheme.north, print.north);
        stepX = std::min(stepX, print.stepX);
        stepY = std::min(stepY, print.stepY);
        wholeCircle = wholeCircle || print.wholeCircle;
    }
    if (scheme.crs.geographic && (wholeCircle || scheme.east - scheme.west > 360.0))
        scheme.east = scheme.west + 360.0;
    require(scheme.east > scheme.west && scheme.north > scheme.south,
            options.dems.front() + ": the elevation is a single row, column or pixel; a terrain needs at least 2 × 2.");

    // The colours ask for a resolution of their own.
    const bool fromImagery = !options.imagery.empty();
    std::vector<std::string> colorFiles = options.imagery;
    if (!options.landCover.empty())
        colorFiles.push_back(options.landCover);
    double colorStepX = std::numeric_limits<double>::max(), colorStepY = colorStepX;
    for (const auto& file : colorFiles)
    {
        const bool imagery = &file != &colorFiles.back() || options.landCover.empty();
        const Footprint print =
            RasterSource(file, imagery ? RasterKind::Imagery : RasterKind::LandCover).footprint(scheme.crs);
        require(overlaps(print, scheme),
                file + ": it lies wholly outside the elevation; give an elevation that covers the same region, or "
                       "leave the file out.");
        if (imagery == fromImagery)
        {
            colorStepX = std::min(colorStepX, print.stepX);
            colorStepY = std::min(colorStepY, print.stepY);
        }
    }

    const auto count = [](double extent, double step) { return std::ceil(extent / step - 1e-4); };
    const double postsX = count(scheme.east - scheme.west, stepX);
    const double postsY = count(scheme.north - scheme.south, stepY);
    const double texelsX = colorFiles.empty() ? 0.0 : count(scheme.east - scheme.west, colorStepX);
    const double texelsY = colorFiles.empty() ? 0.0 : count(scheme.north - scheme.south, colorStepY);

    scheme.finestLevel = 0;
    const auto tiles = [&] { return static_cast<double>(scheme.tilesAcross(scheme.finestLevel)); };
    while (scheme.finestLevel < MAX_LEVEL && tiles() * options.tileSize < std::max(postsX, postsY))
        ++scheme.finestLevel;

    // A texture may be a quarter coarser than its source: resampling blurs by more than that anyway.
    scheme.textureIntervals = options.textureSize;
    const double texels = 0.75 * std::max(texelsX, texelsY);
    if (scheme.textureIntervals == 0)
    {
        scheme.textureIntervals = 32;
        while (scheme.textureIntervals < 2 * options.tileSize)
            scheme.textureIntervals *= 2;
        while (scheme.textureIntervals < std::min(8 * options.tileSize, 1024) &&
               tiles() * scheme.textureIntervals < texels)
            scheme.textureIntervals *= 2;
    }
    while (scheme.finestLevel < MAX_LEVEL && tiles() * scheme.textureIntervals < texels)
        ++scheme.finestLevel;
    require(scheme.finestLevel < MAX_LEVEL, options.dems.front() + ": at its resolution the terrain would need more than " +
                                                std::to_string(MAX_LEVEL) +
                                                " levels; give coarser rasters or a smaller region.");

    scheme.intervalsX = std::max(2, static_cast<int>(std::ceil(postsX / tiles())));
    scheme.intervalsY = std::max(2, static_cast<int>(std::ceil(postsY / tiles())));
}

void BuildPlan::chooseUnits()
{
    // A unit's textures are its largest arrays: some four million texels at most. Bytes at a unit's border
    // depend on where it lies, so nothing here may depend on the machine.
    int depthLimit = 3;
    while (depthLimit > 1 && (scheme.textureIntervals << depthLimit) > 2048)
        --depthLimit;
    int latticeLevel = scheme.finestLevel;
    for (int tier = 0;; ++tier)
    {
        const int depth = std::min(depthLimit, latticeLevel);
        const int rootLevel = latticeLevel - depth;
        const int across = scheme.tilesAcross(rootLevel);
        auto& units = tiers.emplace_back();
        for (int y = 0; y < across; ++y)
            for (int x = 0; x < across; ++x)
                units.push_back({{rootLevel, x, y}, depth, tier});
        unitsTotal += 2 * units.size();
        if (rootLevel == 0)
            break;
        latticeLevel = rootLevel;
    }

    for (int level = 0; level <= scheme.finestLevel; ++level)
    {
        const auto across = static_cast<std::size_t>(scheme.tilesAcross(level));
        facts.emplace_back(across * across);
        horizontalSkirts.emplace_back((across + 1) * across, 0.0f);
        verticalSkirts.emplace_back((across + 1) * across, 0.0f);
    }

    const double texels = std::pow(static_cast<double>(scheme.textureIntervals << tiers[0][0].depth) + 1.0, 2.0);
    const double posts = std::pow(static_cast<double>(options.tileSize << tiers[0][0].depth) + 3.0, 2.0);
    const double unitMiB = (texels * 24.0 + posts * 28.0) / (1024.0 * 1024.0) + 64.0;
    const int wanted = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
    const int affordable = static_cast<int>(0.75 * options.memoryMiB / unitMiB);
    threads = std::clamp(wanted, 1, std::max(1, affordable));
}

void BuildPlan::chooseFingerprint()
{
    std::ostringstream text;
    text.precision(17);
    text << "osgGeoFX terrain database, format " << FORMAT_VERSION << "\n";
    const auto source = [&](const char* kind, const std::string& file)
    {
        std::error_code code;
        const auto size = std::filesystem::file_size(file, code);
        text << kind << " " << std::filesystem::absolute(file).lexically_normal().string();
        if (!code)
            text << ", " << size << " bytes, changed "
                 << std::filesystem::last_write_time(file, code).time_since_epoch().count();
        text << "\n";
    };
    for (const auto& file : options.dems)
        source("elevation", file);
    for (const auto& file : options.imagery)
        source("imagery", file);
    if (!options.landCover.empty())
    {
        source("land cover", options.landCover);
        source("land-cover table", options.landCoverTable);
    }
    text << "CRS " << (options.epsg ? "EPSG:" + std::to_string(options.epsg) : std::string("geocentric WGS 84"))
         << "\nvertical datum " << static_cast<int>(options.vertical) << "\ntile size " << options.tileSize
         << "\ntexture size " << options.textureSize << "\npixel error " << options.pixelError << "\ntexel error "
         << options.texelError << "\npixels per radian " << options.pixelsPerRadian << "\n";
    fingerprint = text.str();
}

TileFacts& BuildPlan::fact(const TileKey& key)
{
    return const_cast<TileFacts&>(static_cast<const BuildPlan*>(this)->fact(key));
}

const TileFacts& BuildPlan::fact(const TileKey& key) const
{
    return facts[static_cast<std::size_t>(key.level)]
                [static_cast<std::size_t>(key.y) * static_cast<std::size_t>(scheme.tilesAcross(key.level)) +
                 static_cast<std::size_t>(key.x)];
}

float BuildPlan::horizontalSkirt(int level, int line, int tile) const
{
    return horizontalSkirts[static_cast<std::size_t>(level)]
                           [static_cast<std::size_t>(line) * static_cast<std::size_t>(scheme.tilesAcross(level)) +
                            static_cast<std::size_t>(tile)];
}

float BuildPlan::verticalSkirt(int level, int line, int tile) const
{
    return verticalSkirts[static_cast<std::size_t>(level)]
                         [static_cast<std::size_t>(line) * static_cast<std::size_t>(scheme.tilesAcross(level)) +
                          static_cast<std::size_t>(tile)];
}

std::string BuildPlan::tileFile(const TileKey& parent) const
{
    return options.output + "/tiles/" + parent.path() + ".osgb";
}

std::string BuildPlan::workFile(const char* pass, const Unit& unit) const
{
    return workFolder() + "/" + pass + "/" + unit.root.path();
}

void BuildPlan::advance(const std::string& phase)
{
    const std::lock_guard<std::mutex> lock(_progressMutex);
    ++unitsDone;
    if (progress && !progress(unitsDone, unitsTotal, phase))
        throw BuildError(options.output + ": the build was stopped; continue it with --resume.");
}

} // namespace osgGeoFX
