// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/TileTextures.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/Lengths.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace osgGeoFX
{

namespace
{

constexpr int MAX_LEVEL = 20;
// Elevation files whose spacings differ by less than this factor count as equally dense.
constexpr double SAME_DENSITY = 1.5;
// Posts may be so much wider apart than those of a source, as a logarithm of 2: by 5 %. Reprojected tiles of one mosaic
// differ by less, so a tile more or less does not change the grid.
constexpr double DENSITY_MARGIN = 0.07;
// A land cover over this share of the extent sets the density of the raster of shores over the whole.
constexpr double MOST_OF_ALL = 0.5;
// Walls' depths are rounded up to so many steps for each doubling.
constexpr double SKIRT_STEPS = 4.0;
// Texture intervals are a multiple of this if there are many of them, so that tiles of denser levels can have a half, a
// quarter or an eighth of them.
constexpr int TEXEL_STEP = 8;
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
    chooseExtent();
    checkColors();
    chooseLevels();
    chooseTexels();
}

void BuildPlan::chooseExtent()
{
    for (const auto& file : options.dems)
        if (!scheme.crs.geographic) requireWithin(scheme.crs, file);
    std::vector<Footprint> dems;
    std::vector<double> units;
    for (const auto& file : options.dems)
    {
        const RasterSource dem(file, RasterKind::Elevation);
        dems.push_back(dem.footprint(scheme.crs));
        units.push_back(dem.metresPerHeight());
    }
    lookAtHeights(units);
    if (scheme.crs.geographic) gatherLongitudes(dems);
    scheme.west = scheme.south = std::numeric_limits<double>::max();
    scheme.east = scheme.north = std::numeric_limits<double>::lowest();
    bool wholeCircle = false;
    for (const auto& print : dems)
    {
        // What lies beyond the border by less than a cell of the first file does not move it: the outermost pixels of a
        // denser file, or of one on another grid, over the same area.
        const bool first = &print == &dems.front();
        const double x = first ? 0.0 : dems.front().stepX, y = first ? 0.0 : dems.front().stepY;
        if (print.west < scheme.west - x) scheme.west = print.west;
        if (print.east > scheme.east + x) scheme.east = print.east;
        if (print.south < scheme.south - y) scheme.south = print.south;
        if (print.north > scheme.north + y) scheme.north = print.north;
        wholeCircle = wholeCircle || print.wholeCircle;
    }
    // Several files may go around together. From the last post to the first it is a pixel, as it is between any two of them.
    double step = 0.0;
    for (const auto& print : dems)
        if (print.west < scheme.west + print.stepX || print.east > scheme.east - print.stepX)
            step = std::max(step, print.stepX);
    if (scheme.crs.geographic && (wholeCircle || scheme.east - scheme.west + 1.5 * step >= 360.0))
        scheme.east = scheme.west + 360.0;
    require(scheme.east > scheme.west && scheme.north > scheme.south,
            options.dems.front() +
                ": the elevation is a single row, column or pixel; a terrain needs at least 2 × 2.");
    chooseLayers(dems);
    _dems = std::move(dems);
}

void BuildPlan::lookAtHeights(const std::vector<double>& units)
{
    const auto isFirst = [&](double unit)
    {
        return unit == units.front();
    };
    const bool alike = std::all_of(units.begin(), units.end(), isFirst);
    // Each process of many looks, so thousands of files must not be read as a whole.
    const double most = std::min(8e6, 32e6 / static_cast<double>(units.size()));
    for (std::size_t i = 0; i < units.size(); ++i)
    {
        demVoids.push_back(options.allHeights ? UndeclaredVoids()
                                              : UndeclaredVoids::of(options.dems[i], most));
        if (i > 0 && alike) continue;
        heightUnits += (i > 0 ? ", that of " : "the unit of ") +
                       (alike && units.size() > 1 ? "all files" : options.dems[i]) + " is taken as " +
                       Lengths::unitInWords(units[i]);
    }
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
    return std::clamp(scheme.finestLevel - static_cast<int>(std::floor(std::log2(ratio) + DENSITY_MARGIN)), 0,
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
    for (const Footprint* print : colorPrints())
    {
        int level = 0;
        for (; level < scheme.finestLevel; ++level)
        {
            const double posts =
                static_cast<double>(scheme.intervals) * scheme.step(level) / scheme.textureIntervals(level);
            const Lattice texels = scheme.lattice(0.0, 0.0, posts, 1, 1);
            if (texels.dx <= print->stepX * 1.001 && texels.dy <= print->stepY * 1.001) break;
        }
        demandOf(*print, level);
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
        // Whole cells of the source's own level, so that a source's patch does not change with finer ones elsewhere.
        const int cell = scheme.step(levelFor(stepX, stepY));
        const auto first = [&](double posts, int last)
        {
            return static_cast<int>(std::clamp(std::floor(posts / cell) * cell, 0.0, last - 1.0));
        };
        const auto end = [&](double posts, int start, int last)
        {
            return static_cast<int>(std::clamp(std::ceil(posts / cell) * cell, start + 1.0, last * 1.0));
        };
        GroundPatch patch;
        patch.firstColumn = first((west - scheme.west) * postsX, scheme.lastColumn);
        patch.firstRow = first((south - scheme.south) * postsY, scheme.lastRow);
        patch.lastColumn = end((east - scheme.west) * postsX, patch.firstColumn, scheme.lastColumn);
        patch.lastRow = end((north - scheme.south) * postsY, patch.firstRow, scheme.lastRow);
        patch.columns = points((patch.lastColumn - patch.firstColumn) / postsX, stepX);
        patch.rows = points((patch.lastRow - patch.firstRow) / postsY, stepY);
        groundPatches.push_back(patch);
    };
    // The coarsest over the whole, then one for each denser source: its rectangle and an eighth around it.
    struct Part
    {
        double west, south, east, north, stepX, stepY;
    };
    const Layer* coarsest = &layers.front();
    for (const Layer& layer : layers)
        if (layer.stepX > coarsest->stepX) coarsest = &layer;
    Part whole{scheme.west, scheme.south, scheme.east, scheme.north, coarsest->stepX, coarsest->stepY};
    std::vector<Part> parts;
    for (const Layer& layer : layers)
        parts.push_back({layer.west, layer.south, layer.east, layer.north, layer.stepX, layer.stepY});
    if (landCoverSource)
    {
        const Footprint& print = landCoverSource->print;
        double width = 0.0;
        for (const double turn : {-360.0, 0.0, 360.0})
            if (turn == 0.0 || scheme.crs.geographic)
                width = std::max(width, std::min(print.east + turn, scheme.east) -
                                            std::max(print.west + turn, scheme.west));
        const double height = std::min(print.north, scheme.north) - std::max(print.south, scheme.south);
        if (width * height >= MOST_OF_ALL * (scheme.east - scheme.west) * (scheme.north - scheme.south))
        {
            whole.stepX = print.stepX;
            whole.stepY = print.stepY;
        }
        else
            parts.push_back({print.west, print.south, print.east, print.north, print.stepX, print.stepY});
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.stepX > b.stepX; });
    add(whole.west, whole.south, whole.east, whole.north, whole.stepX, whole.stepY);
    for (const Part& part : parts)
    {
        if (part.stepX * SAME_DENSITY > whole.stepX) continue;
        const double x = 0.125 * (part.east - part.west), y = 0.125 * (part.north - part.south);
        add(part.west - x, part.south - y, part.east + x, part.north + y, part.stepX, part.stepY);
    }
}

std::vector<const Footprint*> BuildPlan::colorPrints() const
{
    std::vector<const Footprint*> prints;
    for (const Source& image : imagerySources)
        prints.push_back(&image.print);
    if (prints.empty() && landCoverSource) prints.push_back(&landCoverSource->print);
    return prints;
}

void BuildPlan::checkColors()
{
    const auto sourceOf = [&](const std::string& file, RasterKind kind, const RasterBands& bands = {})
    {
        const RasterSource raster(file, kind, bands);
        Source source{"", raster.footprint(scheme.crs), raster.bands()};
        require(overlaps(source.print, scheme), outside(file));
        return source;
    };
    RasterBands wanted;
    for (RasterBands::Channel& channel : wanted.channels)
        channel.range = options.stretch;
    for (const auto& file : options.imagery)
        imagerySources.push_back(sourceOf(file, RasterKind::Imagery, wanted));
    if (!options.landCover.empty()) landCoverSource = sourceOf(options.landCover, RasterKind::LandCover);
    if (!options.treeCover.empty()) treeCoverSource = sourceOf(options.treeCover, RasterKind::TreeCover);
}

/// The grid is that of the first elevation. Denser ones halve its intervals, as often as they need it. So what they add
/// leaves the posts, the tiles and the levels that were there.
void BuildPlan::chooseLevels()
{
    Spacing base{_dems.front().stepX, _dems.front().stepY};
    const auto halvings = [&](const Footprint& print)
    {
        return std::log2(std::max(base.x / print.stepX, base.y / print.stepY)) - DENSITY_MARGIN;
    };
    // Files that are about as dense as the first one share its grid: that of the densest, if this makes a difference.
    const Layer& first = layers.front();
    if (std::any_of(_dems.begin(), _dems.begin() + static_cast<std::ptrdiff_t>(first.last),
                    [&](const Footprint& print) { return halvings(print) > 0.0; }))
        base = {first.stepX, first.stepY};
    const auto count = [](double extent, double step)
    {
        return std::max(1.0, std::ceil(extent / step - 1e-4));
    };
    double columns = count(scheme.east - scheme.west, base.x),
           rows = count(scheme.north - scheme.south, base.y);
    double deepest = 0.0;
    for (const Footprint& print : _dems)
        deepest = std::max(deepest, std::ceil(halvings(print)));
    scheme.intervals = options.tileSize;
    if (options.compressTextures) scheme.texelBlock = TileTextures::BLOCK;
    require(std::max(columns, rows) * std::exp2(deepest) <=
                static_cast<double>(scheme.intervals) * std::exp2(MAX_LEVEL),
            options.dems.front() + ": at its resolution the terrain would need more than " +
                std::to_string(MAX_LEVEL) + " levels; give coarser rasters or a smaller region.");
    scheme.lastColumn = static_cast<int>(columns);
    scheme.lastRow = static_cast<int>(rows);
    scheme.finestLevel = 0;
    while ((scheme.intervals << scheme.finestLevel) < std::max(scheme.lastColumn, scheme.lastRow))
        ++scheme.finestLevel;
    scheme.anchorLevel = scheme.finestLevel;
    for (; deepest > 0.0; --deepest)
        deepen();
}

void BuildPlan::deepen()
{
    ++scheme.finestLevel;
    scheme.lastColumn *= 2;
    scheme.lastRow *= 2;
}

void BuildPlan::chooseTexels()
{
    // The anchor's tiles have as many texels as the first colors have pixels, by default up to four for each interval.
    // Tiles above them keep these texels up to two for each interval, by default. Thus texels are as fine as the
    // relief asks for.
    const int limit = options.textureSize > 0 ? options.textureSize : 4 * options.tileSize;
    const std::vector<const Footprint*> colors = colorPrints();
    const std::string& named = !options.imagery.empty() ? options.imagery.front()
                               : colors.empty()         ? options.dems.front()
                                                        : options.landCover;
    const auto deepenTo = [&](int level)
    {
        require(level <= MAX_LEVEL,
                named + ": at its resolution the terrain would need more than " + std::to_string(MAX_LEVEL) +
                    " levels; give coarser rasters, a smaller region, or a larger --texture-size.");
        while (scheme.finestLevel < level)
            deepen();
    };
    // The intervals that a raster's pixels ask for on a level.
    const auto wanted = [&](const Footprint& print, int level)
    {
        const double posts = scheme.step(level);
        return scheme.intervals * posts *
               std::max((scheme.east - scheme.west) / print.stepX / scheme.lastColumn,
                        (scheme.north - scheme.south) / print.stepY / scheme.lastRow);
    };
    const auto whole = [](double value)
    {
        return std::max(2, static_cast<int>(std::ceil(value - 1e-3)));
    };
    scheme.texels = std::max(2, std::min(scheme.intervals, limit));
    if (!colors.empty())
    {
        while (whole(wanted(*colors.front(), scheme.anchorLevel)) > limit)
            deepenTo(++scheme.anchorLevel);
        scheme.texels = whole(wanted(*colors.front(), scheme.anchorLevel));
        const int rounded = (scheme.texels + TEXEL_STEP - 1) / TEXEL_STEP * TEXEL_STEP;
        if (scheme.texels > 4 * TEXEL_STEP && rounded <= limit) scheme.texels = rounded;
        // Below the anchor, tiles have no more texels than they need. If other colors are denser, they need all.
        bool denser = false;
        for (const Footprint* print : colors)
            for (; whole(wanted(*print, scheme.finestLevel)) > scheme.texels; denser = true)
                deepenTo(scheme.finestLevel + 1);
        for (const Footprint* print : colors)
            denser = denser || std::log2(std::max(colors.front()->stepX / print->stepX,
                                                  colors.front()->stepY / print->stepY)) > DENSITY_MARGIN;
        if (!denser)
            while (scheme.texels % (2 << scheme.textureHalvings) == 0 &&
                   (scheme.texels >> scheme.textureHalvings) > 2)
                ++scheme.textureHalvings;
    }
    const int most = options.textureSize > 0 ? options.textureSize : 2 * options.tileSize;
    scheme.textureDepth = 0;
    while (scheme.textureDepth < scheme.anchorLevel && (scheme.texels << (scheme.textureDepth + 1)) <= most)
        ++scheme.textureDepth;
}

void BuildPlan::chooseUnits()
{
    // A unit's textures are its largest arrays. They may have some four million texels. Bytes at a unit's border
    // depend on its place, so nothing here may depend on the machine.
    int depthLimit = 3;
    while (depthLimit > 1 && (scheme.texels << depthLimit) > 2048)
        --depthLimit;
    // Levels below the anchor get tiers of their own, so that those above have the same units without them.
    for (int root = scheme.anchorLevel; root < scheme.finestLevel;)
    {
        const int lattice = std::min(root + depthLimit, scheme.finestLevel);
        _roots.insert(_roots.begin(), root);
        _lattices.insert(_lattices.begin(), lattice);
        root = lattice;
    }
    // If the anchor is the root, the tiers below have it.
    for (int lattice = scheme.anchorLevel; lattice > 0 || _roots.empty();)
    {
        const int root = std::max(lattice - depthLimit, 0);
        _roots.push_back(root);
        _lattices.push_back(lattice);
        lattice = root;
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

int coreCount()
{
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool BuildPlan::isLeaf(const TileKey& key) const
{
    return !has(key.child(0, 0)); // the child that lies on the extent if any does
}

std::optional<Unit> BuildPlan::unitAbove(const Unit& unit) const
{
    for (std::size_t tier = 0; tier < _roots.size(); ++tier)
    {
        if (_lattices[tier] != unit.root.level || _roots[tier] == unit.root.level) continue;
        const int levels = _lattices[tier] - _roots[tier];
        const auto found = _blocks[tier].find(placeNumber(unit.root.x >> levels, unit.root.y >> levels));
        if (found != _blocks[tier].end()) return tiers[tier][found->second.unit];
    }
    return {};
}

Unit BuildPlan::sampledSquare(const Unit& unit) const
{
    const auto above = unit.depth == 0 ? unitAbove(unit) : std::nullopt;
    return above ? Unit{above->root, unit.root.level - above->root.level, true} : unit;
}

bool BuildPlan::isBesideDenser(const TileKey& key) const
{
    const int width = scheme.intervals * scheme.step(key.level);
    const int last = (scheme.lastColumn + width - 1) / width - 1;
    for (int side = 0; side < 4; ++side)
    {
        TileKey beside{key.level,
                       key.x + (side == 1   ? 1
                                : side == 3 ? -1
                                            : 0),
                       key.y + (side == 2   ? 1
                                : side == 0 ? -1
                                            : 0)};
        if (scheme.wholeCircle()) beside.x = beside.x < 0 ? last : beside.x > last ? 0 : beside.x;
        if (has(beside) && !isLeaf(beside)) return true;
    }
    return false;
}

double BuildPlan::tolerance(int level) const
{
    // A tile's children replace it at a distance of 256 of its cells. Then relief and texture ask for the children at about
    // the same distance, whatever the size of tiles. Small tiles would be too many there, and large ones hardly fit.
    const double edges = std::clamp(256.0 / scheme.intervals, 2.0, 4.0);
    return edges * options.pixelError * scheme.tileMetres(level) / options.pixelsPerRadian;
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
    const bool outer = scheme.endsAt(key, side);
    // The globe's eastern and western end are one line, however, with tiles of all levels on both sides.
    const bool seam = outer && scheme.wholeCircle() && side % 2 == 1;
    if (outer && !seam) return 0.0;

    // The camera and the pager decide which neighbour stands on the other side. It may be of any level from the
    // coarsest one on which this line divides two tiles. (On coarser levels both sides lie in one tile.)
    const int dx = side == 1 ? 1 : side == 3 ? -1 : 0, dy = side == 0 ? -1 : side == 2 ? 1 : 0;
    double other = 0.0;
    bool alike = false;
    for (TileKey self = key;; self = {self.level - 1, self.x / 2, self.y / 2})
    {
        const TileKey neighbour{self.level, self.x + dx, self.y + dy};
        const int across = scheme.tilesAcross(self.level);
        const bool there =
            neighbour.x >= 0 && neighbour.y >= 0 && neighbour.x < across && neighbour.y < across;
        // Two leaves side by side have the same posts. What they join by straight lines counts beside denser tiles.
        if (self == key) alike = there && has(neighbour) && isLeaf(key) && isLeaf(neighbour);
        if (!alike || !(self == key))
        {
            if (there) other = std::max(other, static_cast<double>(fact(neighbour).error));
            other = std::max(other, static_cast<double>(fact(self).error));
        }
        const int place = dx != 0 ? self.x : self.y;
        const bool towardsEnd = dx + dy > 0;
        if (self.level == 0 || (!seam && (place % 2 == 1) != towardsEnd)) break;
    }
    // Posts of a coarse leaf may be joined beside what a denser neighbour has between them.
    if (isLeaf(key) && !alike) other += static_cast<double>(fact(key).error);
    // In steps, since the errors of large tiles count along their whole border. A little more of an error somewhere must
    // not change all these tiles.
    return std::exp2(std::ceil(SKIRT_STEPS * std::log2(other + leastSkirt(key.level))) / SKIRT_STEPS);
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

std::string BuildPlan::newTileFile(const TileKey& parent) const
{
    return staged ? (stagedFolderOf(options.output) / "tiles" / (parent.path() + ".osgb")).string()
                  : tileFile(parent);
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
