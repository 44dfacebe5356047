// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/terrain/BuilderCode.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/TileTextures.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/paging/TerrainInfo.h>

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

constexpr int MAX_LEVEL = 20;
// Elevation files whose spacings differ by less than this factor count as equally dense.
constexpr double SAME_DENSITY = 1.5;
// Heights of a denser layer blend into those below over so many cells of the coarser one.
constexpr double BLEND_CELLS = 3.0;
// What the account of a tile takes, with its place in a table.
constexpr double BYTES_PER_TILE = sizeof(TileFacts) + 40.0;
// What a unit takes of a plan whose facts stay in files.
constexpr double BYTES_PER_UNIT = 160.0;
// How far a CRS may be used beyond its area of use, degrees: a neighbouring zone and some more.
constexpr double CRS_MARGIN = 10.0;

void require(bool condition, const std::string& sentence)
{
    if (!condition) throw BuildError(sentence);
}

std::vector<Footprint> footprints(const std::vector<std::string>& files, RasterKind kind, const GridCrs& crs)
{
    std::vector<Footprint> result;
    for (const auto& file : files)
        result.push_back(RasterSource(file, kind).footprint(crs));
    return result;
}

/// Turns footprints by full circles, so that together they take the shortest range of longitudes.
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
    // As near to the usual −180…180 as possible.
    bestStart -= 360.0 * std::floor((bestStart + 180.0) / 360.0 + 1e-12);
    for (auto& print : prints)
        print = turnedTo(print, bestStart);
}

bool overlaps(const Footprint& print, const TilingScheme& scheme)
{
    if (print.south >= scheme.north || print.north <= scheme.south) return false;
    if (!scheme.crs.geographic) return print.west < scheme.east && print.east > scheme.west;
    for (const double turn : {-360.0, 0.0, 360.0})
        if (print.west + turn < scheme.east && print.east + turn > scheme.west) return true;
    return false;
}

/// Throws unless a raster lies within the area of use of a projected CRS, or near it. At its antipode a CRS would
/// tear a raster apart.
void requireWithin(const GridCrs& crs, const std::string& file)
{
    double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
    const char* name = nullptr;
    if (!crs.srs.GetAreaOfUse(&west, &south, &east, &north, &name) || west < -360.0) return;
    if (east < west) east += 360.0;
    const Footprint print = RasterSource(file, RasterKind::Elevation).footprint(GridCrs::geocentric());
    bool meets = print.wholeCircle;
    for (const double turn : {-720.0, -360.0, 0.0, 360.0, 720.0})
        meets = meets || (print.west + turn <= east + CRS_MARGIN && print.east + turn >= west - CRS_MARGIN);
    if (meets && print.south <= north + CRS_MARGIN && print.north >= south - CRS_MARGIN) return;
    const auto degrees = [](double value, const char* positive, const char* negative)
    {
        value -= 360.0 * std::round(value / 360.0);
        return std::string(CPLSPrintf("%.4g° %s", std::abs(value), value < 0.0 ? negative : positive));
    };
    throw BuildError(file + ": it lies at " + degrees(0.5 * (print.west + print.east), "E", "W") + ", " +
                     degrees(0.5 * (print.south + print.north), "N", "S") + ", where the CRS \"" +
                     crs.srs.GetName() + "\" does not reach (it is for " + degrees(west, "E", "W") + " to " +
                     degrees(east, "E", "W") + ", " + degrees(south, "N", "S") + " to " +
                     degrees(north, "N", "S") + "); choose a CRS of the region, or --geocentric.");
}

std::string outside(const std::string& file)
{
    return file + ": it lies wholly outside the elevation; give an elevation that covers the same region, or "
                  "leave the file out.";
}

} // namespace

BuildPlan::BuildPlan(const BuildOptions& o, Workers w) : options(o), workers(w)
{
    initialiseGdal();
    require(!options.dems.empty(), "No elevation raster is named; give at least one with --dem FILE.");
    require(!options.output.empty(), "No folder for the database is named; give one with -o DIR.");
    require(options.tileSize >= 8 && options.tileSize <= 256 &&
                (options.tileSize & (options.tileSize - 1)) == 0,
            "The tile size must be a power of two from 8 to 256 (it is " + std::to_string(options.tileSize) +
                ").");
    require(options.textureSize == 0 || (options.textureSize >= 16 && options.textureSize <= 4096),
            "The texture size must be 16 to 4096 intervals (it is " + std::to_string(options.textureSize) +
                ").");
    require(options.pixelError > 0.0 && options.texelError > 0.0 && options.pixelsPerRadian > 0.0,
            "The pixel error, the texel error and the pixels per radian must be greater than 0.");
    require(options.anisotropy == 0.0 || (options.anisotropy >= 1.0 && options.anisotropy <= 16.0),
            "The anisotropy must be 1 to 16, or 0 for a default by what the colors are.");
    require(options.memoryMiB >= 128,
            "At least 128 MiB of memory are needed (--memory is " + std::to_string(options.memoryMiB) + ").");
    require(options.landCover.empty() || !options.landCoverTable.empty(),
            options.landCover + ": a land-cover raster needs its table; name it with --landcover-table CSV.");
    require(!options.treeLine || (*options.treeLine >= 0.0 && std::isfinite(*options.treeLine)),
            "The tree line must be a height in metres, 0 or greater.");
    require(options.lakeArea >= 0.0, "The least area of a lake must be 0 or greater.");
    require(options.voidReach >= 1 && options.voidReach <= 500,
            "How far voids are filled must be 1 to 500 samples (--void-reach is " +
                std::to_string(options.voidReach) + ").");
    require(options.voidSmoothing >= 0 && options.voidSmoothing <= 100,
            "Filled voids may be smoothed 0 to 100 times (--void-smoothing is " +
                std::to_string(options.voidSmoothing) + ").");
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
            _classByValue[static_cast<std::size_t>(entry.value)] = &entry;
        }
    }
    chooseGrid();
    chooseDemands();
    chooseGround();
    if (uniform()) chooseEstimate(); // before the account of the tiles is made, which may be too large
    chooseUnits();
    if (!uniform()) chooseEstimate();
    chooseFingerprint();
}

void BuildPlan::chooseGrid()
{
    const Spacing posts = chooseExtent();
    const Spacing colors = checkColors();
    chooseLevels(posts);
    chooseTexels(colors);
}

BuildPlan::Spacing BuildPlan::chooseExtent()
{
    for (const auto& file : options.dems)
        if (!scheme.crs.geographic) requireWithin(scheme.crs, file);
    auto dems = footprints(options.dems, RasterKind::Elevation, scheme.crs);
    if (scheme.crs.geographic) gatherLongitudes(dems);
    scheme.west = scheme.south = std::numeric_limits<double>::max();
    scheme.east = scheme.north = std::numeric_limits<double>::lowest();
    Spacing finest{scheme.west, scheme.west};
    bool wholeCircle = false;
    for (const auto& print : dems)
    {
        scheme.west = std::min(scheme.west, print.west);
        scheme.east = std::max(scheme.east, print.east);
        scheme.south = std::min(scheme.south, print.south);
        scheme.north = std::max(scheme.north, print.north);
        finest = {std::min(finest.x, print.stepX), std::min(finest.y, print.stepY)};
        wholeCircle = wholeCircle || print.wholeCircle;
    }
    if (scheme.crs.geographic && (wholeCircle || scheme.east - scheme.west > 360.0))
        scheme.east = scheme.west + 360.0;
    require(scheme.east > scheme.west && scheme.north > scheme.south,
            options.dems.front() +
                ": the elevation is a single row, column or pixel; a terrain needs at least 2 × 2.");
    chooseLayers(dems);
    _dems = std::move(dems);
    return finest;
}

void BuildPlan::chooseLayers(const std::vector<Footprint>& dems)
{
    for (std::size_t i = 0; i < dems.size(); ++i)
    {
        const Footprint& print = dems[i];
        const auto alike = [](double a, double b)
        {
            return std::max(a, b) < SAME_DENSITY * std::min(a, b);
        };
        if (layers.empty() || !alike(layers.back().stepX, print.stepX) ||
            !alike(layers.back().stepY, print.stepY))
        {
            layers.push_back(
                {i, i, print.west, print.south, print.east, print.north, print.stepX, print.stepY});
        }
        Layer& layer = layers.back();
        layer.last = i + 1;
        layer.west = std::min(layer.west, print.west);
        layer.south = std::min(layer.south, print.south);
        layer.east = std::max(layer.east, print.east);
        layer.north = std::max(layer.north, print.north);
        layer.stepX = std::min(layer.stepX, print.stepX);
        layer.stepY = std::min(layer.stepY, print.stepY);
    }
    for (std::size_t i = 1; i < layers.size(); ++i)
    {
        Layer& layer = layers[i];
        const Layer& below = layers[i - 1];
        layer.blendX =
            std::min(BLEND_CELLS * std::max(layer.stepX, below.stepX), 0.2 * (layer.east - layer.west));
        layer.blendY =
            std::min(BLEND_CELLS * std::max(layer.stepY, below.stepY), 0.2 * (layer.north - layer.south));
    }
}

int BuildPlan::levelFor(double stepX, double stepY) const
{
    const double ratio = std::min(stepX / ((scheme.east - scheme.west) / scheme.lastColumn),
                                  stepY / ((scheme.north - scheme.south) / scheme.lastRow));
    return std::clamp(scheme.finestLevel - static_cast<int>(std::floor(std::log2(ratio) + 1e-3)), 0,
                      scheme.finestLevel);
}

void BuildPlan::chooseDemands()
{
    voidLevel = scheme.finestLevel;
    const auto demandOf = [&](const Footprint& print, int level)
    {
        for (const double turn : {-360.0, 0.0, 360.0})
            if (turn == 0.0 || scheme.crs.geographic)
                _demands.push_back({print.west + turn, print.south, print.east + turn, print.north, level});
    };
    // Files whose densities differ little share their level: that of the densest.
    int deepest = 0;
    for (const Layer& layer : layers)
    {
        const int level = levelFor(layer.stepX, layer.stepY);
        deepest = std::max(deepest, level);
        voidLevel = std::min(voidLevel, level);
        for (std::size_t i = layer.first; i < layer.last; ++i)
            demandOf(_dems[i], level);
    }
    // If colors are denser than the texels of any post, they ask for levels below those of the elevation.
    const std::vector<std::string> files = colorFiles();
    for (const auto& file : files)
    {
        const bool imagery = &file != &files.back() || options.landCover.empty();
        if (imagery == options.imagery.empty()) continue;
        const Footprint print =
            RasterSource(file, imagery ? RasterKind::Imagery : RasterKind::LandCover).footprint(scheme.crs);
        int level = 0;
        for (; level < scheme.finestLevel; ++level)
        {
            const double posts =
                static_cast<double>(scheme.intervals) * scheme.step(level) / scheme.textureIntervals(level);
            const Lattice texels = scheme.lattice(0.0, 0.0, posts, 1, 1);
            if (texels.dx <= print.stepX * 1.001 && texels.dy <= print.stepY * 1.001) break;
        }
        demandOf(print, level);
        deepest = std::max(deepest, level);
    }
    // The densest source of all has the finest level, however its density was rounded.
    if (deepest < scheme.finestLevel)
        for (Demand& each : _demands)
            if (each.level == deepest) each.level = scheme.finestLevel;
    if (uniform()) voidLevel = scheme.finestLevel;
    // Whole cells on the lattice of voids.
    const int step = scheme.step(voidLevel);
    scheme.lastColumn = (scheme.lastColumn + step - 1) / step * step;
    scheme.lastRow = (scheme.lastRow + step - 1) / step * step;
}

bool BuildPlan::uniform() const
{
    return std::all_of(_demands.begin(), _demands.end(),
                       [&](const Demand& each) { return each.level == scheme.finestLevel; });
}

int BuildPlan::demand(const TileKey& key) const
{
    if (uniform()) return scheme.finestLevel;
    const int width = scheme.intervals * scheme.step(key.level);
    const double west = scheme.gridX(scheme.firstColumn(key)), south = scheme.gridY(scheme.firstRow(key));
    const double east = scheme.gridX(scheme.firstColumn(key) + width),
                 north = scheme.gridY(scheme.firstRow(key) + width);
    int level = 0;
    for (const Demand& each : _demands)
        if (each.west <= east && each.east >= west && each.south <= north && each.north >= south)
            level = std::max(level, each.level);
    return level;
}

void BuildPlan::chooseGround()
{
    const auto points = [](double extent, double step)
    {
        return static_cast<int>(
                   std::clamp(std::ceil(extent / step - 1e-4), 1.0, GroundRaster::LARGEST_SIDE - 1.0)) +
               1;
    };
    // A raster over a rectangle of finest posts, wide enough for the ends of the shores in it.
    const auto add = [&](double west, double south, double east, double north, double stepX, double stepY)
    {
        const double postsX = scheme.lastColumn / (scheme.east - scheme.west),
                     postsY = scheme.lastRow / (scheme.north - scheme.south);
        GroundPatch patch;
        patch.firstColumn = static_cast<int>(
            std::clamp(std::floor((west - scheme.west) * postsX), 0.0, scheme.lastColumn - 1.0));
        patch.firstRow = static_cast<int>(
            std::clamp(std::floor((south - scheme.south) * postsY), 0.0, scheme.lastRow - 1.0));
        patch.lastColumn = static_cast<int>(std::clamp(std::ceil((east - scheme.west) * postsX),
                                                       patch.firstColumn + 1.0, scheme.lastColumn * 1.0));
        patch.lastRow = static_cast<int>(std::clamp(std::ceil((north - scheme.south) * postsY),
                                                    patch.firstRow + 1.0, scheme.lastRow * 1.0));
        patch.columns = points((patch.lastColumn - patch.firstColumn) / postsX, stepX);
        patch.rows = points((patch.lastRow - patch.firstRow) / postsY, stepY);
        groundPatches.push_back(patch);
    };
    const bool classed = !options.landCover.empty();
    const Layer* coarsest = &layers.front();
    for (const Layer& layer : layers)
        if (layer.stepX > coarsest->stepX) coarsest = &layer;
    if (layers.size() == 1)
    {
        add(scheme.west, scheme.south, scheme.east, scheme.north,
            classed ? _landCover.stepX : coarsest->stepX, classed ? _landCover.stepY : coarsest->stepY);
        return;
    }
    // The coarsest over the whole, then one for each denser source: its rectangle and an eighth around it.
    struct Part
    {
        double west, south, east, north, stepX, stepY;
    };
    std::vector<Part> parts;
    for (const Layer& layer : layers)
        parts.push_back({layer.west, layer.south, layer.east, layer.north, layer.stepX, layer.stepY});
    if (classed)
        parts.push_back({_landCover.west, _landCover.south, _landCover.east, _landCover.north,
                         _landCover.stepX, _landCover.stepY});
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.stepX > b.stepX; });
    add(scheme.west, scheme.south, scheme.east, scheme.north, coarsest->stepX, coarsest->stepY);
    for (const Part& part : parts)
    {
        if (part.stepX * SAME_DENSITY > coarsest->stepX) continue;
        const double x = 0.125 * (part.east - part.west), y = 0.125 * (part.north - part.south);
        add(part.west - x, part.south - y, part.east + x, part.north + y, part.stepX, part.stepY);
    }
}

std::vector<std::string> BuildPlan::colorFiles() const
{
    std::vector<std::string> files = options.imagery;
    if (!options.landCover.empty()) files.push_back(options.landCover);
    return files;
}

BuildPlan::Spacing BuildPlan::checkColors()
{
    const bool fromImagery = !options.imagery.empty();
    const std::vector<std::string> files = colorFiles();
    Spacing finest{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    for (const auto& file : files)
    {
        const bool imagery = &file != &files.back() || options.landCover.empty();
        const Footprint print =
            RasterSource(file, imagery ? RasterKind::Imagery : RasterKind::LandCover).footprint(scheme.crs);
        require(overlaps(print, scheme), outside(file));
        if (!imagery) _landCover = print;
        if (imagery == fromImagery)
            finest = {std::min(finest.x, print.stepX), std::min(finest.y, print.stepY)};
    }
    if (!options.treeCover.empty())
        require(
            overlaps(RasterSource(options.treeCover, RasterKind::TreeCover).footprint(scheme.crs), scheme),
            outside(options.treeCover));
    return finest;
}

void BuildPlan::chooseLevels(const Spacing& posts)
{
    const auto count = [](double extent, double step)
    {
        return std::ceil(extent / step - 1e-4);
    };
    const double columns = count(scheme.east - scheme.west, posts.x),
                 rows = count(scheme.north - scheme.south, posts.y);
    scheme.intervals = options.tileSize;
    if (options.compressTextures) scheme.texelBlock = TileTextures::BLOCK;
    require(std::max(columns, rows) <= static_cast<double>(scheme.intervals << MAX_LEVEL),
            options.dems.front() + ": at its resolution the terrain would need more than " +
                std::to_string(MAX_LEVEL) + " levels; give coarser rasters or a smaller region.");
    scheme.lastColumn = std::max(1, static_cast<int>(columns));
    scheme.lastRow = std::max(1, static_cast<int>(rows));
    scheme.finestLevel = 0;
    while ((scheme.intervals << scheme.finestLevel) < std::max(scheme.lastColumn, scheme.lastRow))
        ++scheme.finestLevel;
}

void BuildPlan::chooseTexels(const Spacing& colors)
{
    // Finest tiles have as many texels as the colors' source has pixels, by default up to four for each interval.
    // Tiles above them keep these texels up to two for each interval, by default. Thus texels are as fine as the
    // relief asks for.
    const int limit = options.textureSize > 0 ? options.textureSize : 4 * options.tileSize;
    const std::vector<std::string> files = colorFiles();
    for (;; ++scheme.finestLevel, scheme.lastColumn *= 2, scheme.lastRow *= 2)
    {
        require(scheme.finestLevel <= MAX_LEVEL,
                (files.empty() ? options.dems.front() : files.front()) +
                    ": at its resolution the terrain would need more than " + std::to_string(MAX_LEVEL) +
                    " levels; give coarser rasters, a smaller region, or a larger --texture-size.");
        double texels = std::min(scheme.intervals, limit);
        if (!files.empty())
            texels = scheme.intervals * std::max((scheme.east - scheme.west) / colors.x / scheme.lastColumn,
                                                 (scheme.north - scheme.south) / colors.y / scheme.lastRow);
        scheme.texels = std::max(2, static_cast<int>(std::ceil(texels - 1e-3)));
        if (scheme.texels <= limit) break;
    }
    const int kept = options.textureSize > 0 ? options.textureSize : 2 * options.tileSize;
    scheme.textureDepth = 0;
    while (scheme.textureDepth < scheme.finestLevel && (scheme.texels << (scheme.textureDepth + 1)) <= kept)
        ++scheme.textureDepth;
}

void BuildPlan::chooseUnits()
{
    // A unit's textures are its largest arrays. They may have some four million texels. Bytes at a unit's border
    // depend on its place, so nothing here may depend on the machine.
    int depthLimit = 3;
    while (depthLimit > 1 && (scheme.texels << depthLimit) > 2048)
        --depthLimit;
    int latticeLevel = scheme.finestLevel;
    for (;;)
    {
        const int depth = std::min(depthLimit, latticeLevel);
        const int rootLevel = latticeLevel - depth;
        _roots.push_back(rootLevel);
        _lattices.push_back(rootLevel + depth);
        if (rootLevel == 0) break;
        latticeLevel = rootLevel;
    }
    tiers.resize(_roots.size());
    _blocks.resize(_roots.size());
    addUnits({0, 0, 0}, _roots.size() - 1);
    if (uniform())
        voidUnits = tiers.front();
    else
    {
        const int depth = std::min(depthLimit, voidLevel), across = scheme.tilesAcross(voidLevel - depth);
        for (int y = 0; y < across; ++y)
            for (int x = 0; x < across; ++x)
                if (scheme.exists({voidLevel - depth, x, y}))
                    voidUnits.push_back({{voidLevel - depth, x, y}, depth, true});
    }

    double texels = 0.0, posts = 0.0;
    for (const auto& units : tiers)
        for (const Unit& unit : units)
        {
            const int across = scheme.textureIntervals(unit.latticeLevel()) << unit.depth;
            texels = std::max(texels, std::pow(static_cast<double>(across), 2.0));
            posts = std::max(posts, std::pow(static_cast<double>(options.tileSize << unit.depth) + 3.0, 2.0));
        }
    const double unitMiB = (texels * 32.0 + posts * 36.0) / (1024.0 * 1024.0) + 64.0;
    const int wanted = options.threads > 0 ? options.threads : coreCount();
    const int affordable = static_cast<int>(0.75 * options.memoryMiB / unitMiB);
    threads = std::clamp(wanted, 1, std::max(1, affordable));
}

/// Adds a unit and all below it. `ladder` counts the tiers from the deepest one.
void BuildPlan::addUnits(const TileKey& root, std::size_t ladder)
{
    if (!scheme.exists(root)) return;
    const int wanted = demand(root), lattice = _lattices[ladder];
    const bool sampled = wanted <= lattice;
    const int depth = std::clamp(wanted, root.level, lattice) - root.level;
    _blocks[ladder][placeNumber(root.x, root.y)].unit = tiers[ladder].size();
    tiers[ladder].push_back({root, depth, sampled});
    countTiles(tiers[ladder].back());
    if (sampled) return;
    const int span = 1 << depth;
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
            addUnits({lattice, root.x * span + x, root.y * span + y}, ladder - 1);
}

/// The tiles whose facts a unit settles. Those of the lattice of an upper tier are the roots of other units.
void BuildPlan::countTiles(const Unit& unit)
{
    for (int level = unit.root.level; level <= unit.latticeLevel() - (unit.sampled ? 0 : 1); ++level)
    {
        const int span = 1 << (level - unit.root.level), width = scheme.intervals * scheme.step(level);
        const auto there = [&](int root, int last)
        {
            return static_cast<std::uint64_t>(std::min(span, (last + width - 1) / width - root * span));
        };
        _tiles += there(unit.root.x, scheme.lastColumn) * there(unit.root.y, scheme.lastRow);
    }
    ++_units;
    const bool one = workers == Workers::ONE_PROCESS;
    const std::uint64_t count = one ? _tiles : _units;
    if (static_cast<double>(count) * (one ? BYTES_PER_TILE : BYTES_PER_UNIT) >
        options.memoryMiB * 1024.0 * 1024.0)
        throw BuildError(options.dems.front() + ": the terrain would have more than " +
                         std::to_string(count) + (one ? " tiles" : " units of tiles") +
                         ", of which the builder cannot keep account in " +
                         std::to_string(options.memoryMiB) +
                         " MiB of memory; give it more with --memory, or give a smaller region or coarser "
                         "rasters (gdal_translate -projwin, gdalwarp -tr).");
}

void BuildPlan::chooseFingerprint()
{
    std::ostringstream text;
    text.precision(17);
    text << "osgGeoFX terrain database, format " << TerrainInfo::newestFormat << ", content "
         << DATABASE_CONTENT << "\nbuilder " << builderCode() << "\n";
    const auto source = [&](const char* kind, const std::string& file)
    {
        std::error_code code;
        // GDAL's own file systems: archives, and what lies on servers.
        if (file.rfind("/vsi", 0) == 0)
        {
            VSIStatBufL remote{};
            text << kind << " " << file;
            if (VSIStatL(file.c_str(), &remote) == 0)
                text << ", " << remote.st_size << " bytes, changed " << remote.st_mtime;
            text << "\n";
            return;
        }
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
        const auto legends = readyLegends();
        if (std::find(legends.begin(), legends.end(), options.landCoverTable) != legends.end())
            text << "legend " << options.landCoverTable << "\n";
        else
            source("land-cover table", options.landCoverTable);
    }
    if (!options.treeCover.empty()) source("tree cover", options.treeCover);
    if (options.treeLine) text << "tree line " << *options.treeLine << "\n";
    text << "lake area " << options.lakeArea << "\n";
    if (options.voids == Voids::FILL)
        text << "voids filled up to " << options.voidReach << " samples, smoothed " << options.voidSmoothing
             << " times\n";
    else
        text << "voids kept\n";
    text << "CRS "
         << (options.epsg ? "EPSG:" + std::to_string(options.epsg) : std::string("geocentric WGS 84"))
         << "\nvertical datum " << static_cast<int>(options.vertical) << "\ntile size " << options.tileSize
         << "\ntexture size " << options.textureSize << "\npixel error " << options.pixelError
         << "\ntexel error " << options.texelError << "\nanisotropy " << options.anisotropy
         << "\npixels per radian " << options.pixelsPerRadian << "\n"
         << (options.compressTextures ? "textures compressed\n" : "");
    fingerprint = text.str();
}

int coreCount()
{
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool BuildPlan::isLeaf(const TileKey& key) const
{
    return !has(key.child(0, 0)); // the child that lies on the extent if any does
}

double BuildPlan::tolerance(int level) const
{
    // At the distance where a tile's children replace it, its edge is two pixels long for each pixel of error. So
    // relief and texture ask for the children at about the same distance.
    return 2.0 * options.pixelError * scheme.tileMetres(level) / options.pixelsPerRadian;
}

double BuildPlan::finestError(int level) const
{
    // The errors of an edge and of its parts add up, but hardly ever to more.
    return level == scheme.finestLevel ? 0.0 : 1.5 * tolerance(level);
}

double BuildPlan::largestError(int level) const
{
    // A tile needs no meshes for more than twice the distance at which its parent replaces it.
    return 4.0 * tolerance(level);
}

double BuildPlan::skirt(const TileKey& key, int side) const
{
    // A tile has no neighbour beyond the terrain's border. A skirt would only show below the edge there.
    const int width = scheme.intervals * scheme.step(key.level);
    const bool outer[] = {key.y == 0, scheme.firstColumn(key) + width >= scheme.lastColumn,
                          scheme.firstRow(key) + width >= scheme.lastRow, key.x == 0};
    // The globe's eastern and western end are one line, however, with tiles of all levels on both sides.
    const bool seam = outer[side] && scheme.wholeCircle() && side % 2 == 1;
    if (outer[side] && !seam) return 0.0;

    // The camera and the pager decide which neighbour stands on the other side. It may be of any level from the
    // coarsest one on which this line divides two tiles. (On coarser levels both sides lie in one tile.)
    const int dx = side == 1 ? 1 : side == 3 ? -1 : 0, dy = side == 0 ? -1 : side == 2 ? 1 : 0;
    double other = 0.0;
    for (TileKey self = key;; self = {self.level - 1, self.x / 2, self.y / 2})
    {
        const TileKey neighbour{self.level, self.x + dx, self.y + dy};
        const int across = scheme.tilesAcross(self.level);
        if (neighbour.x >= 0 && neighbour.y >= 0 && neighbour.x < across && neighbour.y < across)
            other = std::max(other, static_cast<double>(fact(neighbour).error));
        other = std::max(other, static_cast<double>(fact(self).error));
        const int place = dx != 0 ? self.x : self.y;
        const bool towardsEnd = dx + dy > 0;
        if (self.level == 0 || (!seam && (place % 2 == 1) != towardsEnd)) break;
    }
    // Posts of a coarse leaf may be joined beside what a denser neighbour has between them.
    if (isLeaf(key)) other += static_cast<double>(fact(key).error);
    return other + leastSkirt(key.level);
}

double BuildPlan::leastSkirt(int level) const
{
    // Even in a plain, rounding opens hair lines between meshes of different density.
    return 0.5 + 0.02 * scheme.tileMetres(level) / scheme.intervals;
}

int BuildPlan::validColumns(const Unit& unit) const
{
    const int step = scheme.step(unit.latticeLevel());
    return std::min(unit.span() * scheme.intervals,
                    (scheme.lastColumn - scheme.firstColumn(unit.root) + step - 1) / step) +
           1;
}

int BuildPlan::validRows(const Unit& unit) const
{
    const int step = scheme.step(unit.latticeLevel());
    return std::min(unit.span() * scheme.intervals,
                    (scheme.lastRow - scheme.firstRow(unit.root) + step - 1) / step) +
           1;
}

Lattice BuildPlan::postsWithApron(const Unit& unit) const
{
    const int step = scheme.step(unit.latticeLevel());
    return scheme.lattice(scheme.firstColumn(unit.root) - step, scheme.firstRow(unit.root) - step, step,
                          validColumns(unit) + 2, validRows(unit) + 2);
}

std::string BuildPlan::tileFile(const TileKey& parent) const
{
    return options.output + "/tiles/" + parent.path() + ".osgb";
}

std::string BuildPlan::workFolder() const
{
    return workFolderOf(options.output).string();
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
