// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TilePass.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/BuildStage.h>
#include <osgGeoFX/terrain/detail/KeptFiles.h>
#include <osgGeoFX/terrain/detail/PackedArray.h>
#include <osgGeoFX/terrain/detail/TileFile.h>
#include <osgGeoFX/terrain/detail/TileNode.h>
#include <osgGeoFX/terrain/detail/UnitSources.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <osg/Group>
#include <osg/Math>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <mutex>

namespace osgGeoFX
{

namespace
{

// A difference of color that the eye misses, of 255.
constexpr int VISIBLE_DIFFERENCE = 10;

/// Every second point of a lattice, smoothed by 1-2-1 in each direction. Points on the lattice's border are smoothed
/// along the border only. The neighbouring unit has the same points there and must get the same result.
template<typename T, typename Sum, int Channels>
std::vector<T> halved(const std::vector<T>& values, int columns, int rows)
{
    const int halfColumns = (columns - 1) / 2 + 1, halfRows = (rows - 1) / 2 + 1;
    std::vector<T> result(static_cast<std::size_t>(halfColumns) * static_cast<std::size_t>(halfRows) *
                          Channels);
    const auto at = [&](int column, int row, int channel)
    {
        return static_cast<Sum>(values[(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                        static_cast<std::size_t>(column)) *
                                           Channels +
                                       static_cast<std::size_t>(channel)]);
    };
    for (int j = 0; j < halfRows; ++j)
        for (int i = 0; i < halfColumns; ++i)
        {
            const bool insideX = i > 0 && i + 1 < halfColumns, insideY = j > 0 && j + 1 < halfRows;
            // West and east border: along y only. South and north border: along x only. A corner stays.
            const int wx[3] = {insideX ? 1 : 0, insideX ? 2 : 1, insideX ? 1 : 0};
            const int wy[3] = {insideY ? 1 : 0, insideY ? 2 : 1, insideY ? 1 : 0};
            const int total = (insideX ? 4 : 1) * (insideY ? 4 : 1);
            for (int channel = 0; channel < Channels; ++channel)
            {
                Sum sum = 0;
                for (int y = -1; y <= 1; ++y)
                    for (int x = -1; x <= 1; ++x)
                        if (const int weight = wx[x + 1] * wy[y + 1])
                            sum += static_cast<Sum>(weight) * at(2 * i + x, 2 * j + y, channel);
                if constexpr (std::is_integral_v<T>)
                    sum = (sum + total / 2) / total;
                else
                    sum /= static_cast<Sum>(total);
                result[(static_cast<std::size_t>(j) * static_cast<std::size_t>(halfColumns) +
                        static_cast<std::size_t>(i)) *
                           Channels +
                       static_cast<std::size_t>(channel)] = static_cast<T>(sum);
            }
        }
    return result;
}

/// Copies a lattice of `partColumns` columns into a larger one.
template<typename T>
void paste(const std::vector<T>& part, int partColumns, int channels, std::vector<T>& whole, int wholeColumns,
           int x0, int y0)
{
    const std::size_t run = static_cast<std::size_t>(partColumns) * static_cast<std::size_t>(channels);
    const int rows = static_cast<int>(part.size() / run);
    for (int row = 0; row < rows; ++row)
        std::copy_n(part.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * run), run,
                    whole.begin() + (static_cast<std::ptrdiff_t>(y0 + row) * wholeColumns + x0) * channels);
}

/// A tile's slopes with so many intervals along its edge. A tile without finer ones may have fewer, between which the
/// ground is straight.
std::vector<float> denser(const std::vector<float>& slopes, int intervals)
{
    const auto columns = static_cast<int>(std::lround(std::sqrt(static_cast<double>(slopes.size()))));
    if (columns == intervals + 1) return slopes;
    const auto at = [&](int column, int row)
    {
        return static_cast<double>(slopes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                          static_cast<std::size_t>(column)]);
    };
    const double scale = (columns - 1.0) / intervals;
    std::vector<float> result;
    for (int row = 0; row <= intervals; ++row)
        for (int column = 0; column <= intervals; ++column)
        {
            const double x = column * scale, y = row * scale;
            const int i = std::min(static_cast<int>(x), columns - 2),
                      j = std::min(static_cast<int>(y), columns - 2);
            const double u = x - i, v = y - j;
            result.push_back(static_cast<float>((at(i, j) * (1.0 - u) + at(i + 1, j) * u) * (1.0 - v) +
                                                (at(i, j + 1) * (1.0 - u) + at(i + 1, j + 1) * u) * v));
        }
    return result;
}

std::string rootTileFile(const BuildPlan& plan, const TileKey& key)
{
    return plan.workFolder() + "/nodes/" + key.path() + ".osgb";
}

/// The root tile of a unit, of this build, or of the former database if the unit has left it as it was.
osg::ref_ptr<osg::Node> readRootTile(const BuildPlan& plan, const TileKey& key)
{
    std::string file = rootTileFile(plan, key);
    const bool former = plan.kept && !std::filesystem::exists(file);
    if (former)
        file = key.level == 0 ? plan.options.output + "/terrain.osgb"
                              : plan.tileFile({key.level - 1, key.x / 2, key.y / 2});
    // Without a path in the options, OSG leaves the file names in the tile as they were written.
    std::ifstream stream(file, std::ios::binary);
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    const osg::ref_ptr<osgDB::Options> withoutPath = new osgDB::Options;
    osg::ref_ptr<osg::Node> node;
    if (stream && reader) node = reader->readNode(stream, withoutPath).getNode();
    if (!former && node) return node;
    if (former && node && node->asGroup())
        for (unsigned int i = 0; i < node->asGroup()->getNumChildren(); ++i)
            if (node->asGroup()->getChild(i)->getName() == "tile " + key.path())
                return node->asGroup()->getChild(i);
    throw BuildError(file + (former ? ": this tile is damaged; build the database again with --anew."
                                    : ": this work file is damaged; build again without --resume."));
}

/// Whether the finer texels show anything that the coarser ones, interpolated, do not.
bool losesDetail(const LevelArrays& fine, const LevelArrays& coarse, int x, int y, int intervals)
{
    const auto texel = [](const LevelArrays& arrays, int column, int row)
    {
        return arrays.colors.data() +
               3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(arrays.texelColumns) +
                    static_cast<std::size_t>(column));
    };
    for (int row = 2 * y * intervals; row <= 2 * (y + 1) * intervals; ++row)
        for (int column = 2 * x * intervals; column <= 2 * (x + 1) * intervals; ++column)
        {
            const unsigned char* value = texel(fine, column, row);
            const unsigned char* corner[] = {
                texel(coarse, column / 2, row / 2), texel(coarse, (column + 1) / 2, row / 2),
                texel(coarse, column / 2, (row + 1) / 2), texel(coarse, (column + 1) / 2, (row + 1) / 2)};
            for (int channel = 0; channel < 3; ++channel)
                if (std::abs(value[channel] - (corner[0][channel] + corner[1][channel] + corner[2][channel] +
                                               corner[3][channel]) /
                                                  4) > VISIBLE_DIFFERENCE)
                    return true;
        }
    return false;
}

/// What a unit's last work file starts with.
struct UnitFigures
{
    std::uint64_t ownTiles = 0, tiles = 0; ///< of the unit, and with all units below it
    TextureFigures textures;               ///< with all units below it
    float skirtBelow = 0.0f;               ///< of the unit's root (TileFacts)
    std::int32_t normals = 0;              ///< intervals of the root's normals along its edge
};

/// The record of a unit that is done.
UnitRecord readRecord(const BuildPlan& plan, const Unit& unit)
{
    const std::string file = plan.workFile(UNIT_RECORDS, unit);
    const auto record = UnitRecord::read(file);
    if (!record) throw BuildError(file + ": this work file is damaged; build again without --resume.");
    return *record;
}

/// The unit that has made a tile of an upper unit's lattice.
Unit unitBelow(const Unit& unit, int x, int y)
{
    Unit below;
    below.root = {unit.latticeLevel(), unit.root.x * unit.span() + x, unit.root.y * unit.span() + y};
    return below;
}

/// Of all that a unit reads. Stages before must be done, and the units below.
Digest unitKey(const BuildPlan& plan, const Unit& unit)
{
    const TilingScheme& scheme = plan.scheme;
    ContentHash hash;
    hash.add(unit.root.level).add(unit.depth).add(unit.sampled).add(plan.factsDigest(unit));
    hash.add(plan.isWholeEarth());
    if (unit.sampled)
    {
        const int width = unit.span() * scheme.intervals * scheme.step(unit.latticeLevel());
        const int column = scheme.firstColumn(unit.root), row = scheme.firstRow(unit.root);
        hash.add(heightsKey(plan, unit)).add(surfaceSources(plan, unit));
        return hash.add(plan.ground->digest(column, row, column + width, row + width)).digest();
    }
    hash.add(gatherRoots(plan, unit).values);
    for (int y = 0; y < unit.span(); ++y)
        for (int x = 0; x < unit.span(); ++x)
        {
            const Unit below = unitBelow(unit, x, y);
            if (!plan.fact(below.root).any) continue;
            const UnitRecord record = readRecord(plan, below);
            hash.add(x).add(y).add(record.root).add(record.handedOn);
        }
    return hash.digest();
}

/// Of all that the bytes of a tile follow from, beside what all units depend on (BuildPlan::common). x and y are its place
/// in the arrays.
Digest tileKey(const BuildPlan& plan, const TileKey& key, const LevelArrays& arrays, int x, int y)
{
    const TilingScheme& scheme = plan.scheme;
    const TileFacts& facts = plan.fact(key);
    ContentHash hash;
    for (const float each :
         {facts.minHeight, facts.maxHeight, facts.latticeError, facts.error, facts.skirtBelow,
          arrays.textureError[static_cast<std::size_t>(y * arrays.span + x)]})
        hash.add(each);
    hash.add(plan.isLeaf(key)).add(plan.isWholeEarth()).add(arrays.normals);
    for (int side = 0; side < 4; ++side)
        hash.add(plan.skirt(key, side)).add(plan.poleHeight(key, side).value_or(0.0));
    // The tile's part of a lattice, with the points on its border.
    const auto add = [&](const auto& values, int columns, int channels)
    {
        const int intervals = (columns - 1) / arrays.span;
        hash.add(intervals);
        if (values.empty()) return;
        for (int row = y * intervals; row <= (y + 1) * intervals; ++row)
            hash.add(values.data() + (static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                      static_cast<std::size_t>(x * intervals)) *
                                         static_cast<std::size_t>(channels),
                     static_cast<std::size_t>((intervals + 1) * channels) * sizeof(values.front()));
    };
    add(arrays.heights.values, arrays.heights.columns, 1);
    for (const auto* slopes : {&arrays.slopeX, &arrays.slopeY})
        add(*slopes, arrays.span * scheme.intervals + 1, 1);
    for (const auto* slopes : {&arrays.texelSlopeX, &arrays.texelSlopeY})
        add(*slopes, arrays.span * arrays.normals + 1, 1);
    add(arrays.colors, arrays.texelColumns, 3);
    add(arrays.classes, arrays.texelColumns, 1);
    add(arrays.cover, arrays.texelColumns, 4);
    return hash.digest();
}

/// The figures of a unit that is done; false if it is not.
bool readFigures(const BuildPlan& plan, const Unit& unit, UnitFigures& figures)
{
    std::ifstream stream(plan.workFile("tiles", unit), std::ios::binary);
    return static_cast<bool>(stream.read(reinterpret_cast<char*>(&figures), sizeof(figures)));
}

/// Whether the former database has a unit's root tile, in a file that is as large as it was written.
bool hasFormerRoot(const BuildPlan& plan, const Unit& unit)
{
    const auto above = plan.unitAbove(unit);
    if (!above) return unit.root.level == 0;
    const auto record = plan.kept->record(*above);
    if (!record) return false;
    const TileKey parent{unit.root.level - 1, unit.root.x / 2, unit.root.y / 2};
    const int levels = parent.level - above->root.level;
    const auto* group =
        record->group(levels, parent.x - (above->root.x << levels), parent.y - (above->root.y << levels));
    return group && plan.kept->hasTiles(*group, parent);
}

/// The texels of a square (BuildPlan::sampledSquare).
struct Surface
{
    TileKey root;
    int level = 0;
    std::vector<unsigned char> colors, classes, cover;
};

class UnitBuilder
{
public:
    explicit UnitBuilder(BuildPlan& plan) : _plan(plan), _factory(plan) {}

    /// Writes the files of all groups of four tiles in the unit. Writes the unit's root for the next tier. Leaves files as
    /// they are that the former database has already. Returns the number of their tiles.
    std::uint64_t build(const Unit& unit);

private:
    LevelArrays sampled(const Unit& unit);
    void sampleSurface(const Unit& square);
    LevelArrays gathered(const Unit& unit, UnitFigures& figures);
    void chooseSkirts(const Unit& unit);
    /// Makes the next coarser level. It may take over texels and slopes of the finer one, which is not used
    /// afterwards.
    LevelArrays coarser(LevelArrays& fine) const;
    void slopes(const Unit& unit, const HeightGrid& withApron, LevelArrays& arrays) const;
    void writeGroups(const Unit& unit, const LevelArrays& arrays, UnitFigures& figures);
    void writeRoot(const Unit& unit, const LevelArrays& arrays);
    UnitRecord::Group writeGroup(const Unit& unit, const LevelArrays& arrays, int x, int y,
                                 const Digest& key);
    Digest groupKey(const Unit& unit, const LevelArrays& arrays, int x, int y) const;

    BuildPlan& _plan;
    TileNodeFactory _factory;
    std::unique_ptr<RasterStack> _rasters;
    std::optional<Surface> _surface; ///< of which more tiles may come
    // Of the unit in work.
    std::optional<UnitRecord> _former; ///< of the former database; empty if it has none
    UnitRecord _record;
    std::uint64_t _kept = 0; ///< tiles that stay
};

/// Slopes at the posts, from their neighbours. The apron has the neighbours of posts on the border.
void UnitBuilder::slopes(const Unit& unit, const HeightGrid& withApron, LevelArrays& arrays) const
{
    const TilingScheme& scheme = _plan.scheme;
    arrays.slopeX.resize(arrays.heights.values.size());
    arrays.slopeY.resize(arrays.heights.values.size());
    const auto rise = [](float before, float here, float after, double distance)
    {
        const bool hasBefore = !std::isnan(before), hasAfter = !std::isnan(after);
        if (std::isnan(here) || (!hasBefore && !hasAfter)) return 0.0f;
        const float difference = (hasAfter ? after : here) - (hasBefore ? before : here);
        return static_cast<float>(static_cast<double>(difference) /
                                  (distance * (hasBefore && hasAfter ? 2.0 : 1.0)));
    };
    const int validColumns = withApron.columns - 2, validRows = withApron.rows - 2;
    const int step = scheme.step(unit.latticeLevel());
    for (int j = 0; j < validRows; ++j)
    {
        const double y = scheme.gridY(scheme.firstRow(unit.root) + j * step);
        const double metresX = step * scheme.metresX(y), metresY = step * scheme.metresY(y);
        for (int i = 0; i < validColumns; ++i)
        {
            const std::size_t index =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(arrays.heights.columns) +
                static_cast<std::size_t>(i);
            const float here = withApron.at(i + 1, j + 1);
            arrays.slopeX[index] = rise(withApron.at(i, j + 1), here, withApron.at(i + 2, j + 1), metresX);
            arrays.slopeY[index] = rise(withApron.at(i + 1, j), here, withApron.at(i + 1, j + 2), metresY);
        }
    }
    extendBeyond(arrays.slopeX, arrays.heights.columns, arrays.heights.rows, 1, validColumns, validRows);
    extendBeyond(arrays.slopeY, arrays.heights.columns, arrays.heights.rows, 1, validColumns, validRows);
    arrays.texelSlopeX = arrays.slopeX;
    arrays.texelSlopeY = arrays.slopeY;
    arrays.normals = scheme.intervals;
}

LevelArrays UnitBuilder::sampled(const Unit& unit)
{
    const TilingScheme& scheme = _plan.scheme;
    const int level = unit.latticeLevel(), m = scheme.textureIntervals(level);
    const int span = unit.span(), posts = span * scheme.intervals + 1, texels = span * m + 1;
    LevelArrays arrays;
    arrays.level = level;
    arrays.span = span;

    if (!_rasters) _rasters = std::make_unique<RasterStack>(_plan);
    HeightGrid withApron(_plan.validColumns(unit) + 2, _plan.validRows(unit) + 2);
    const std::string file = _plan.heightFile("heights", unit);
    const std::size_t expected = withApron.values.size();
    if (std::filesystem::exists(file))
    {
        ByteReader reader(file);
        withApron.values = reader.getVector<float>();
        if (!reader.good() || withApron.values.size() != expected)
            throw BuildError(file + ": this work file is damaged; build again without --resume.");
    }
    else // an update kept the facts
        withApron.values = _rasters->unitHeights(unit);
    arrays.heights = HeightGrid(posts, posts);
    for (int j = 0; j < withApron.rows - 2; ++j)
        for (int i = 0; i < withApron.columns - 2; ++i)
            arrays.heights.at(i, j) = withApron.at(i + 1, j + 1);
    extendBeyond(arrays.heights.values, posts, posts, 1, withApron.columns - 2, withApron.rows - 2);
    slopes(unit, withApron, arrays);

    const Unit square = _plan.sampledSquare(unit);
    if (!_surface || !(_surface->root == square.root) || _surface->level != level) sampleSurface(square);
    const int across = square.span() * m + 1;
    const int x = (unit.root.x - square.root.x * (square.span() / span)) * span * m,
              y = (unit.root.y - square.root.y * (square.span() / span)) * span * m;
    const auto cut = [&](const std::vector<unsigned char>& whole, std::size_t channels)
    {
        if (across == texels) return whole;
        std::vector<unsigned char> part;
        for (int row = 0; row < texels; ++row)
        {
            const auto start =
                whole.begin() + static_cast<std::ptrdiff_t>(
                                    (static_cast<std::size_t>(y + row) * static_cast<std::size_t>(across) +
                                     static_cast<std::size_t>(x)) *
                                    channels);
            part.insert(part.end(), start,
                        start + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(texels) * channels));
        }
        return part;
    };
    arrays.texelColumns = texels;
    arrays.colors = cut(_surface->colors, 3);
    if (!_surface->classes.empty()) arrays.classes = cut(_surface->classes, 1);
    arrays.cover = cut(_surface->cover, 4);
    // One tile of a square is followed by the next one.
    if (across == texels) _surface.reset();
    arrays.textureError.assign(static_cast<std::size_t>(span) * static_cast<std::size_t>(span), 0.0f);
    return arrays;
}

/// Samples the texels of a square.
void UnitBuilder::sampleSurface(const Unit& square)
{
    const TilingScheme& scheme = _plan.scheme;
    const int level = square.latticeLevel(), m = scheme.textureIntervals(level);
    const int texels = square.span() * m + 1;
    const int column = scheme.firstColumn(square.root), row = scheme.firstRow(square.root);
    const int tilePosts = scheme.intervals * scheme.step(level);
    const double spacing = static_cast<double>(tilePosts) / m;
    const auto valid = [&](int last)
    {
        return std::min(texels, static_cast<int>(std::floor(last / spacing)) + 1);
    };
    const int validColumns = valid(scheme.lastColumn - column), validRows = valid(scheme.lastRow - row);
    const Lattice lattice = scheme.lattice(column, row, spacing, validColumns, validRows);
    const auto widened = [&](const std::vector<unsigned char>& part, int channels)
    {
        std::vector<unsigned char> whole(static_cast<std::size_t>(texels) * static_cast<std::size_t>(texels) *
                                         static_cast<std::size_t>(channels));
        paste(part, validColumns, channels, whole, texels, 0, 0);
        extendBeyond(whole, texels, texels, channels, validColumns, validRows);
        return whole;
    };
    _surface.emplace();
    _surface->root = square.root;
    _surface->level = level;
    _surface->colors = widened(_rasters->colors(lattice), 3);
    if (!_plan.options.landCover.empty()) _surface->classes = widened(_rasters->classes(lattice), 1);
    _surface->cover = widened(
        _rasters->cover(lattice, _plan.ground->sample({column, row, tilePosts, m}, validColumns, validRows)),
        4);
}

LevelArrays UnitBuilder::gathered(const Unit& unit, UnitFigures& figures)
{
    const TilingScheme& scheme = _plan.scheme;
    const int n = scheme.intervals, span = unit.span(), posts = span * n + 1;
    const int m = scheme.textureIntervals(unit.latticeLevel()), texelColumns = span * m + 1;
    LevelArrays arrays;
    arrays.level = unit.latticeLevel();
    arrays.span = span;
    arrays.heights = gatherRoots(_plan, unit);
    arrays.slopeX.resize(arrays.heights.values.size());
    arrays.slopeY.resize(arrays.heights.values.size());
    // Normals are as dense as the densest part has them.
    arrays.normals = n;
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
        {
            const Unit below = unitBelow(unit, x, y);
            UnitFigures part;
            if (_plan.fact(below.root).any && readFigures(_plan, below, part))
                arrays.normals = std::max(arrays.normals, part.normals);
        }
    const int normals = arrays.normals, normalColumns = span * normals + 1;
    arrays.texelSlopeX.resize(static_cast<std::size_t>(normalColumns) *
                              static_cast<std::size_t>(normalColumns));
    arrays.texelSlopeY.resize(arrays.texelSlopeX.size());
    arrays.texelColumns = texelColumns;
    const std::size_t count = static_cast<std::size_t>(texelColumns) * static_cast<std::size_t>(texelColumns);
    arrays.colors.assign(3 * count, 128);
    if (!_plan.options.landCover.empty()) arrays.classes.assign(count, 0);
    arrays.cover.assign(4 * count, 0);
    arrays.textureError.assign(static_cast<std::size_t>(span) * static_cast<std::size_t>(span), 0.0f);
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
        {
            const Unit below = unitBelow(unit, x, y);
            if (!_plan.fact(below.root).any) continue;
            ByteReader reader(_plan.workFile("tiles", below));
            bool good = true;
            const auto take = [&](auto type, std::size_t most)
            {
                using Value = decltype(type);
                const auto size = reader.get<std::size_t>();
                const auto packed = reader.getVector<char>();
                std::optional<std::vector<Value>> values;
                if (reader.good() && size <= most) values = unpackedArray<Value>(packed, size);
                good = good && values;
                return std::move(values).value_or(std::vector<Value>());
            };
            const auto part = reader.get<UnitFigures>();
            figures.tiles += part.tiles;
            figures.textures.add(part.textures);
            _plan.fact(below.root).skirtBelow = part.skirtBelow;
            arrays.textureError[static_cast<std::size_t>(y * span + x)] = reader.get<float>();
            const auto squared = [](int intervals)
            {
                return static_cast<std::size_t>(intervals + 1) * static_cast<std::size_t>(intervals + 1);
            };
            const auto slopeX = take(0.0f, squared(n)), slopeY = take(0.0f, squared(n));
            const auto texelSlopeX = take(0.0f, squared(normals)), texelSlopeY = take(0.0f, squared(normals));
            const std::size_t texels = squared(m);
            const unsigned char byte = 0;
            const auto colors = take(byte, 3 * texels), classes = take(byte, texels),
                       cover = take(byte, 4 * texels);
            if (!good || !reader.good())
                throw BuildError(_plan.workFile("tiles", below) +
                                 ": this work file is damaged; build again without --resume.");
            paste(slopeX, n + 1, 1, arrays.slopeX, posts, x * n, y * n);
            paste(slopeY, n + 1, 1, arrays.slopeY, posts, x * n, y * n);
            paste(denser(texelSlopeX, normals), normals + 1, 1, arrays.texelSlopeX, normalColumns,
                  x * normals, y * normals);
            paste(denser(texelSlopeY, normals), normals + 1, 1, arrays.texelSlopeY, normalColumns,
                  x * normals, y * normals);
            paste(colors, m + 1, 3, arrays.colors, texelColumns, x * m, y * m);
            paste(classes, m + 1, 1, arrays.classes, texelColumns, x * m, y * m);
            paste(cover, m + 1, 4, arrays.cover, texelColumns, x * m, y * m);
        }
    return arrays;
}

LevelArrays UnitBuilder::coarser(LevelArrays& fine) const
{
    const int posts = (fine.span * _plan.scheme.intervals) + 1;
    LevelArrays coarse;
    coarse.level = fine.level - 1;
    coarse.span = fine.span / 2;
    coarse.heights = std::move(fine.heights);
    coarse.slopeX = halved<float, float, 1>(fine.slopeX, posts, posts);
    coarse.slopeY = halved<float, float, 1>(fine.slopeY, posts, posts);
    if (2 * fine.normals <= _plan.scheme.intervals << TilingScheme::normalDepth)
    {
        coarse.normals = 2 * fine.normals;
        coarse.texelSlopeX = std::move(fine.texelSlopeX);
        coarse.texelSlopeY = std::move(fine.texelSlopeY);
    }
    else
    {
        coarse.normals = fine.normals;
        const int columns = fine.span * fine.normals + 1;
        coarse.texelSlopeX = halved<float, float, 1>(fine.texelSlopeX, columns, columns);
        coarse.texelSlopeY = halved<float, float, 1>(fine.texelSlopeY, columns, columns);
    }
    const int span = coarse.span;
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
        {
            float error = 0.0f;
            for (int c = 0; c < 4; ++c)
                error = std::max(error, fine.textureError[static_cast<std::size_t>(
                                            (2 * y + (c >> 1)) * 2 * span + 2 * x + (c & 1))]);
            coarse.textureError.push_back(error);
        }
    if (_plan.scheme.keepsTexels(coarse.level))
    {
        coarse.texelColumns = fine.texelColumns;
        coarse.colors = std::move(fine.colors);
        coarse.classes = std::move(fine.classes);
        coarse.cover = std::move(fine.cover);
        return coarse;
    }
    coarse.texelColumns = (fine.texelColumns - 1) / 2 + 1;
    coarse.colors = halved<unsigned char, int, 3>(fine.colors, fine.texelColumns, fine.texelColumns);
    coarse.cover = halved<unsigned char, int, 4>(fine.cover, fine.texelColumns, fine.texelColumns);
    if (!fine.classes.empty())
        for (int j = 0; j < fine.texelColumns; j += 2)
            for (int i = 0; i < fine.texelColumns; i += 2)
                coarse.classes.push_back(
                    fine.classes[static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.texelColumns) +
                                 static_cast<std::size_t>(i)]);
    const int intervals = _plan.scheme.textureIntervals(coarse.level);
    const auto texelMetres = static_cast<float>(_plan.scheme.tileMetres(coarse.level) / intervals);
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
            if (losesDetail(fine, coarse, x, y, intervals))
                coarse.textureError[static_cast<std::size_t>(y * span + x)] = texelMetres;
    return coarse;
}

/// Whether a tile of a unit was made by a unit below: the finest tiles of an upper tier, which are made from denser
/// heights.
bool isMadeBelow(const Unit& unit, const TileKey& key)
{
    return !unit.sampled && key.level == unit.latticeLevel();
}

Digest UnitBuilder::groupKey(const Unit& unit, const LevelArrays& arrays, int x, int y) const
{
    const TileKey parent{arrays.level - 1, unit.root.x * arrays.span / 2 + x,
                         unit.root.y * arrays.span / 2 + y};
    ContentHash hash;
    for (int c = 0; c < 4; ++c)
    {
        const TileKey key = parent.child(c & 1, c >> 1);
        hash.add(_plan.fact(key).any);
        if (!_plan.fact(key).any) continue;
        const int tileX = 2 * x + (c & 1), tileY = 2 * y + (c >> 1);
        hash.add(isMadeBelow(unit, key) ? readRecord(_plan, unitBelow(unit, tileX, tileY)).root
                                        : tileKey(_plan, key, arrays, tileX, tileY));
    }
    return hash.digest();
}

UnitRecord::Group UnitBuilder::writeGroup(const Unit& unit, const LevelArrays& arrays, int x, int y,
                                          const Digest& key)
{
    const TileKey parent{arrays.level - 1, unit.root.x * arrays.span / 2 + x,
                         unit.root.y * arrays.span / 2 + y};
    UnitRecord::Group result;
    result.key = key;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int c = 0; c < 4; ++c)
    {
        const TileKey child = parent.child(c & 1, c >> 1);
        if (!_plan.fact(child).any) continue;
        const int tileX = 2 * x + (c & 1), tileY = 2 * y + (c >> 1);
        TextureFigures& textures = result.textures[static_cast<std::size_t>(c)];
        if (isMadeBelow(unit, child))
        {
            group->addChild(readRootTile(_plan, child));
            textures = readRecord(_plan, unitBelow(unit, tileX, tileY)).rootTextures;
            continue;
        }
        _factory.textures().forget();
        group->addChild(_factory.create(child, arrays, tileX, tileY));
        textures = _factory.textures().figures();
    }
    result.bytes = writeNodeAtomically(*group, _plan.newTileFile(parent));
    return result;
}

void UnitBuilder::writeGroups(const Unit& unit, const LevelArrays& arrays, UnitFigures& figures)
{
    const int levels = arrays.level - 1 - unit.root.level, span = arrays.span / 2;
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
        {
            const TileKey parent{arrays.level - 1, unit.root.x * span + x, unit.root.y * span + y};
            if (!_plan.fact(parent).any) continue;
            const Digest key = groupKey(unit, arrays, x, y);
            const UnitRecord::Group* former = _former ? _former->group(levels, x, y) : nullptr;
            UnitRecord::Group& group = _record.groups[UnitRecord::place(levels, x, y)];
            const bool stays = former && former->key == key && _plan.kept->hasTiles(*former, parent);
            group = stays ? *former : writeGroup(unit, arrays, x, y, key);
            for (int c = 0; c < 4; ++c)
            {
                const TileKey child = parent.child(c & 1, c >> 1);
                // What another unit has made counts there.
                if (!_plan.fact(child).any || isMadeBelow(unit, child)) continue;
                figures.textures.add(group.textures[static_cast<std::size_t>(c)]);
                ++figures.ownTiles;
                _kept += stays ? 1 : 0;
            }
        }
}

void UnitBuilder::writeRoot(const Unit& unit, const LevelArrays& arrays)
{
    _record.root = tileKey(_plan, unit.root, arrays, 0, 0);
    if (_former && _former->root == _record.root && hasFormerRoot(_plan, unit))
    {
        _record.rootTextures = _former->rootTextures;
        ++_kept;
        return;
    }
    _factory.textures().forget();
    writeNodeAtomically(*_factory.create(unit.root, arrays, 0, 0), rootTileFile(_plan, unit.root));
    _record.rootTextures = _factory.textures().figures();
}

/// The depths that the walls of the tiles and of all tiles below them reach.
void UnitBuilder::chooseSkirts(const Unit& unit)
{
    for (int level = unit.latticeLevel() - (unit.sampled ? 0 : 1); level >= unit.root.level; --level)
    {
        const int span = 1 << (level - unit.root.level);
        for (int y = 0; y < span; ++y)
            for (int x = 0; x < span; ++x)
            {
                const TileKey key{level, unit.root.x * span + x, unit.root.y * span + y};
                if (!_plan.fact(key).any) continue;
                TileFacts& facts = _plan.fact(key);
                // The depth that the walls of its coarsest meshes reach.
                facts.skirtBelow =
                    static_cast<float>(2.0 * _plan.largestError(level) + _plan.leastSkirt(level)) +
                    facts.latticeError;
                for (int side = 0; side < 4; ++side)
                    facts.skirtBelow =
                        std::max(facts.skirtBelow,
                                 static_cast<float>(_plan.largestError(level) + _plan.skirt(key, side)));
                for (int c = 0; c < 4; ++c)
                    facts.skirtBelow =
                        std::max(facts.skirtBelow, _plan.fact(key.child(c & 1, c >> 1)).skirtBelow);
            }
    }
}

std::uint64_t UnitBuilder::build(const Unit& unit)
{
    _former = _plan.kept ? _plan.kept->record(unit) : std::nullopt;
    _record = {};
    _record.key = unitKey(_plan, unit);
    _record.groups.resize(UnitRecord::place(unit.depth, 0, 0));
    _kept = 0;
    UnitFigures figures;
    LevelArrays arrays = unit.sampled ? sampled(unit) : gathered(unit, figures);
    chooseSkirts(unit);
    for (int level = unit.latticeLevel(); level > unit.root.level; --level)
    {
        writeGroups(unit, arrays, figures);
        arrays = coarser(arrays);
    }
    writeRoot(unit, arrays);
    ++figures.ownTiles;
    figures.tiles += figures.ownTiles;
    figures.textures.add(_record.rootTextures);
    figures.skirtBelow = _plan.fact(unit.root).skirtBelow;
    figures.normals = arrays.normals;
    ByteWriter writer;
    writer.put(figures);
    writer.put(arrays.textureError.front());
    const auto put = [&](const auto& values)
    {
        writer.put(values.size());
        writer.put(packedArray(values));
    };
    for (const auto* slopes : {&arrays.slopeX, &arrays.slopeY, &arrays.texelSlopeX, &arrays.texelSlopeY})
        put(*slopes);
    for (const auto* bytes : {&arrays.colors, &arrays.classes, &arrays.cover})
        put(*bytes);
    // A unit with this file is done, so it comes last.
    _record.handedOn = ContentHash().add(writer.bytes()).digest();
    _record.write(_plan.workFile(UNIT_RECORDS, unit));
    writeFileAtomically(_plan.workFile("tiles", unit), writer.bytes().data(), writer.bytes().size());
    return _kept;
}

/// The units of a tier. They use the roots of the tiers below.
class Tiles : public BuildStage
{
public:
    Tiles(BuildPlan& plan, std::size_t tier, TilePassResult& result)
        : BuildStage("tiles-" + std::to_string(tier), "tiles"), _plan(plan), _units(plan.tiers[tier]),
          _builders(static_cast<std::size_t>(plan.threads)), _result(result)
    {
    }
    std::size_t units() const override { return _units.size(); }
    void begin() override
    {
        if (VoidRaster::isNeeded(_plan) && !_plan.voids) _plan.voids = std::make_shared<VoidRaster>(_plan);
        if (!_plan.ground) _plan.ground = std::make_shared<GroundRaster>(_plan);
    }
    bool takeOver(std::size_t index) override
    {
        UnitFigures figures;
        if (!hasWork(index)) return true;
        if (!readFigures(_plan, _units[index], figures)) return false;
        const std::lock_guard<std::mutex> lock(_mutex);
        _result.tilesReused += figures.ownTiles;
        return true;
    }
    bool hasWork(std::size_t index) const override { return _plan.fact(_units[index].root).any; }
    bool keep(std::size_t index) override
    {
        const Unit& unit = _units[index];
        if (!_plan.kept) return false;
        const auto former = _plan.kept->record(unit);
        if (!former || former->key != unitKey(_plan, unit)) return false;
        for (int levels = 0; levels < unit.depth; ++levels)
            for (int y = 0; y < 1 << levels; ++y)
                for (int x = 0; x < 1 << levels; ++x)
                {
                    const TileKey parent{unit.root.level + levels, (unit.root.x << levels) + x,
                                         (unit.root.y << levels) + y};
                    const auto* group = former->group(levels, x, y);
                    if (group && !_plan.kept->hasTiles(*group, parent)) return false;
                }
        // A unit with the last of these is done.
        UnitFigures figures;
        if (!hasFormerRoot(_plan, unit) || !_plan.kept->take(UNIT_RECORDS + ("/" + unit.root.path())) ||
            !_plan.kept->take("tiles/" + unit.root.path()) || !readFigures(_plan, unit, figures))
            return false;
        const std::lock_guard<std::mutex> lock(_mutex);
        _result.tilesKept += figures.ownTiles;
        ++_result.units;
        ++_result.unitsKept;
        return true;
    }
    void run(int worker, std::size_t index) override
    {
        auto& builder = _builders[static_cast<std::size_t>(worker)];
        if (!builder) builder = std::make_unique<UnitBuilder>(_plan);
        const std::uint64_t kept = builder->build(_units[index]);
        const std::lock_guard<std::mutex> lock(_mutex);
        _result.tilesKept += kept;
        ++_result.units;
    }

private:
    BuildPlan& _plan;
    const std::vector<Unit>& _units;
    std::vector<std::unique_ptr<UnitBuilder>> _builders;
    TilePassResult& _result;
    std::mutex _mutex;
};

} // namespace

void addTileStages(BuildPlan& plan, BuildStages& stages, TilePassResult& result)
{
    for (std::size_t tier = 0; tier < plan.tiers.size(); ++tier)
        if (!plan.tiers[tier].empty()) stages.push_back(std::make_unique<Tiles>(plan, tier, result));
}

void readTilePassResult(const BuildPlan& plan, TilePassResult& result)
{
    const Unit& whole = plan.tiers.back().front();
    UnitFigures figures;
    if (!readFigures(plan, whole, figures))
        throw BuildError(plan.workFile("tiles", whole) +
                         ": this work file is damaged; build again without --resume.");
    result.tiles = figures.tiles;
    result.textures = figures.textures;
    result.root = readRootTile(plan, whole.root);
}

} // namespace osgGeoFX
