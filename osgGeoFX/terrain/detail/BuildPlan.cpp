// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/terrain/BuilderCode.h>
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

BuildPlan::BuildPlan(const BuildOptions& o) : options(o)
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
    chooseEstimate();
    chooseUnits();
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
    groundStepX = finest.x;
    groundStepY = finest.y;
    if (scheme.crs.geographic && (wholeCircle || scheme.east - scheme.west > 360.0))
        scheme.east = scheme.west + 360.0;
    require(scheme.east > scheme.west && scheme.north > scheme.south,
            options.dems.front() +
                ": the elevation is a single row, column or pixel; a terrain needs at least 2 × 2.");
    return finest;
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
        if (!imagery)
        {
            groundStepX = print.stepX;
            groundStepY = print.stepY;
        }
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
        if (rootLevel == 0) break;
        latticeLevel = rootLevel;
    }
    unitsTotal += static_cast<std::uint64_t>(GroundRaster::steps(*this));

    for (int level = 0; level <= scheme.finestLevel; ++level)
    {
        const auto across = static_cast<std::size_t>(scheme.tilesAcross(level));
        facts.emplace_back(across * across);
    }

    const double texels = std::pow(static_cast<double>(scheme.texels << tiers[0][0].depth), 2.0);
    const double posts = std::pow(static_cast<double>(options.tileSize << tiers[0][0].depth) + 3.0, 2.0);
    const double unitMiB = (texels * 32.0 + posts * 36.0) / (1024.0 * 1024.0) + 64.0;
    const int wanted = options.threads > 0 ? options.threads : coreCount();
    const int affordable = static_cast<int>(0.75 * options.memoryMiB / unitMiB);
    threads = std::clamp(wanted, 1, std::max(1, affordable));
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
    return scheme.lattice(scheme.firstColumn(unit.root) - 1, scheme.firstRow(unit.root) - 1, 1.0,
                          validColumns(unit) + 2, validRows(unit) + 2);
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
