// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TilePass.h"

#include "AtomicFile.h"
#include "TileNode.h"
#include "WorkQueue.h"

#include <osgGeoFX/geodata/BuildError.h>

#include <osg/Group>
#include <osg/Math>
#include <osgDB/Registry>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>

namespace osgGeoFX
{

namespace
{

// A difference of colour that an eye would miss, of 255.
constexpr int VISIBLE_DIFFERENCE = 10;

/// Every second point of a lattice, smoothed by 1-2-1 in each direction. Points on the lattice's border are smoothed
/// along the border only: the neighbouring unit has the same points there and must come to the same result.
template<typename T, typename Sum, int Channels>
std::vector<T> halved(const std::vector<T>& values, int columns, int rows)
{
    const int halfColumns = (columns - 1) / 2 + 1, halfRows = (rows - 1) / 2 + 1;
    std::vector<T> result(static_cast<std::size_t>(halfColumns) * static_cast<std::size_t>(halfRows) * Channels);
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
            // On the west or east border: along y only; on the south or north one: along x only; a corner: itself.
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

/// Whether the finer texels show anything that the coarser ones, interpolated, do not.
bool losesDetail(const LevelArrays& fine, const LevelArrays& coarse, int x, int y, int intervals)
{
    const auto texel = [](const LevelArrays& arrays, int column, int row)
    {
        return arrays.colors.data() + 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(arrays.texelColumns) +
                                           static_cast<std::size_t>(column));
    };
    for (int row = 2 * y * intervals; row <= 2 * (y + 1) * intervals; ++row)
        for (int column = 2 * x * intervals; column <= 2 * (x + 1) * intervals; ++column)
        {
            const unsigned char* value = texel(fine, column, row);
            const unsigned char* corner[] = {texel(coarse, column / 2, row / 2), texel(coarse, (column + 1) / 2, row / 2),
                                             texel(coarse, column / 2, (row + 1) / 2),
                                             texel(coarse, (column + 1) / 2, (row + 1) / 2)};
            for (int channel = 0; channel < 3; ++channel)
                if (std::abs(value[channel] -
                             (corner[0][channel] + corner[1][channel] + corner[2][channel] + corner[3][channel]) / 4) >
                    VISIBLE_DIFFERENCE)
                    return true;
        }
    return false;
}

class UnitBuilder
{
public:
    explicit UnitBuilder(BuildPlan& plan) : _plan(plan), _factory(plan) {}

    std::uint64_t build(const Unit& unit);
    osg::ref_ptr<osg::Node> root(const std::string& file);

private:
    LevelArrays sampled(const Unit& unit);
    LevelArrays gathered(const Unit& unit);
    LevelArrays coarser(const LevelArrays& fine) const;
    void slopes(const Unit& unit, const HeightGrid& withApron, LevelArrays& arrays) const;
    std::uint64_t writeChildren(const Unit& unit, const LevelArrays& arrays);

    BuildPlan& _plan;
    TileNodeFactory _factory;
    std::unique_ptr<RasterStack> _rasters;
};

void UnitBuilder::slopes(const Unit& unit, const HeightGrid& withApron, LevelArrays& arrays) const
{
    const TilingScheme& scheme = _plan.scheme;
    const Lattice lattice = scheme.lattice(unit.latticeLevel(), unit.root.x * unit.span(), unit.root.y * unit.span(),
                                           unit.span(), scheme.intervalsX, scheme.intervalsY);
    arrays.slopeX.resize(arrays.heights.values.size());
    arrays.slopeY.resize(arrays.heights.values.size());
    const auto rise = [](float before, float here, float after, double distance)
    {
        const bool hasBefore = !std::isnan(before), hasAfter = !std::isnan(after);
        if (std::isnan(here) || (!hasBefore && !hasAfter))
            return 0.0f;
        const float difference = (hasAfter ? after : here) - (hasBefore ? before : here);
        return static_cast<float>(static_cast<double>(difference) / (distance * (hasBefore && hasAfter ? 2.0 : 1.0)));
    };
    for (int j = 0; j < arrays.heights.rows; ++j)
    {
        double metresX = lattice.dx * scheme.crs.metresPerUnit, metresY = lattice.dy * scheme.crs.metresPerUnit;
        if (scheme.crs.geographic)
        {
            const double latitude = std::clamp(lattice.y0 + j * lattice.dy, -89.9, 89.9);
            const double sine = std::sin(osg::DegreesToRadians(latitude));
            const double a = GeographicLib::Constants::WGS84_a(), f = GeographicLib::Constants::WGS84_f();
            const double e2 = f * (2.0 - f), w2 = 1.0 - e2 * sine * sine;
            metresX = lattice.dx * osg::DegreesToRadians(a / std::sqrt(w2) * std::cos(osg::DegreesToRadians(latitude)));
            metresY = lattice.dy * osg::DegreesToRadians(a * (1.0 - e2) / (w2 * std::sqrt(w2)));
        }
        for (int i = 0; i < arrays.heights.columns; ++i)
        {
            const std::size_t index = static_cast<std::size_t>(j) * static_cast<std::size_t>(arrays.heights.columns) +
                                      static_cast<std::size_t>(i);
            const float here = withApron.at(i + 1, j + 1);
            arrays.slopeX[index] = rise(withApron.at(i, j + 1), here, withApron.at(i + 2, j + 1), metresX);
            arrays.slopeY[index] = rise(withApron.at(i + 1, j), here, withApron.at(i + 1, j + 2), metresY);
        }
    }
}

LevelArrays UnitBuilder::sampled(const Unit& unit)
{
    const TilingScheme& scheme = _plan.scheme;
    const int x = unit.root.x * unit.span(), y = unit.root.y * unit.span();
    LevelArrays arrays;
    arrays.level = unit.latticeLevel();

    HeightGrid withApron(unit.span() * scheme.intervalsX + 3, unit.span() * scheme.intervalsY + 3);
    ByteReader reader(_plan.workFile("heights", unit));
    const std::size_t expected = withApron.values.size();
    withApron.values = reader.getVector<float>();
    if (!reader.good() || withApron.values.size() != expected)
        throw BuildError(_plan.workFile("heights", unit) +
                         ": this work file is damaged; build again without --resume.");
    arrays.heights = HeightGrid(withApron.columns - 2, withApron.rows - 2);
    for (int j = 0; j < arrays.heights.rows; ++j)
        for (int i = 0; i < arrays.heights.columns; ++i)
            arrays.heights.at(i, j) = withApron.at(i + 1, j + 1);
    slopes(unit, withApron, arrays);

    const Lattice texels = scheme.lattice(arrays.level, x, y, unit.span(), scheme.textureIntervals,
                                          scheme.textureIntervals);
    arrays.texelColumns = texels.columns;
    arrays.texelRows = texels.rows;
    if (!_rasters)
        _rasters = std::make_unique<RasterStack>(_plan);
    arrays.colors = _rasters->colors(texels);
    arrays.classes = _rasters->classes(texels);
    arrays.textureError.assign(static_cast<std::size_t>(unit.span()) * static_cast<std::size_t>(unit.span()), 0.0f);
    return arrays;
}

LevelArrays UnitBuilder::gathered(const Unit& unit)
{
    const TilingScheme& scheme = _plan.scheme;
    const int nx = scheme.intervalsX, ny = scheme.intervalsY, m = scheme.textureIntervals, span = unit.span();
    LevelArrays arrays;
    arrays.level = unit.latticeLevel();
    arrays.heights = HeightGrid(span * nx + 1, span * ny + 1);
    arrays.slopeX.resize(arrays.heights.values.size());
    arrays.slopeY.resize(arrays.heights.values.size());
    arrays.texelColumns = arrays.texelRows = span * m + 1;
    const std::size_t texels = static_cast<std::size_t>(arrays.texelColumns) * static_cast<std::size_t>(arrays.texelRows);
    arrays.colors.assign(3 * texels, 128);
    if (!_plan.options.landCover.empty())
        arrays.classes.assign(texels, 0);
    arrays.textureError.assign(static_cast<std::size_t>(span) * static_cast<std::size_t>(span), 0.0f);
    std::fill(arrays.heights.values.begin(), arrays.heights.values.end(), std::nanf(""));

    const auto paste = [](const auto& part, int partColumns, int channels, auto& whole, int wholeColumns, int x0, int y0)
    {
        const std::size_t run = static_cast<std::size_t>(partColumns) * static_cast<std::size_t>(channels);
        const int rows = static_cast<int>(part.size() / run);
        for (int row = 0; row < rows; ++row)
            std::copy_n(part.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * run), run,
                        whole.begin() + (static_cast<std::ptrdiff_t>(y0 + row) * wholeColumns + x0) * channels);
    };
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
        {
            Unit below;
            below.root = {arrays.level, unit.root.x * span + x, unit.root.y * span + y};
            if (!_plan.fact(below.root).any)
                continue;
            ByteReader reader(_plan.workFile("tiles", below));
            reader.get<std::uint64_t>();
            const auto heights = reader.getVector<float>();
            const auto slopeX = reader.getVector<float>();
            const auto slopeY = reader.getVector<float>();
            const auto colors = reader.getVector<unsigned char>();
            const auto classes = reader.getVector<unsigned char>();
            arrays.textureError[static_cast<std::size_t>(y * span + x)] = reader.get<float>();
            if (!reader.good())
                throw BuildError(_plan.workFile("tiles", below) +
                                 ": this work file is damaged; build again without --resume.");
            paste(heights, nx + 1, 1, arrays.heights.values, arrays.heights.columns, x * nx, y * ny);
            paste(slopeX, nx + 1, 1, arrays.slopeX, arrays.heights.columns, x * nx, y * ny);
            paste(slopeY, nx + 1, 1, arrays.slopeY, arrays.heights.columns, x * nx, y * ny);
            paste(colors, m + 1, 3, arrays.colors, arrays.texelColumns, x * m, y * m);
            paste(classes, m + 1, 1, arrays.classes, arrays.texelColumns, x * m, y * m);
        }
    return arrays;
}

LevelArrays UnitBuilder::coarser(const LevelArrays& fine) const
{
    const int m = _plan.scheme.textureIntervals;
    LevelArrays coarse;
    coarse.level = fine.level - 1;
    coarse.heights = HeightGrid((fine.heights.columns - 1) / 2 + 1, (fine.heights.rows - 1) / 2 + 1);
    for (int j = 0; j < coarse.heights.rows; ++j)
        for (int i = 0; i < coarse.heights.columns; ++i)
            coarse.heights.at(i, j) = fine.heights.at(2 * i, 2 * j);
    coarse.slopeX = halved<float, float, 1>(fine.slopeX, fine.heights.columns, fine.heights.rows);
    coarse.slopeY = halved<float, float, 1>(fine.slopeY, fine.heights.columns, fine.heights.rows);
    coarse.texelColumns = (fine.texelColumns - 1) / 2 + 1;
    coarse.texelRows = (fine.texelRows - 1) / 2 + 1;
    coarse.colors = halved<unsigned char, int, 3>(fine.colors, fine.texelColumns, fine.texelRows);
    if (!fine.classes.empty())
    {
        coarse.classes.reserve(static_cast<std::size_t>(coarse.texelColumns) * static_cast<std::size_t>(coarse.texelRows));
        for (int j = 0; j < fine.texelRows; j += 2)
            for (int i = 0; i < fine.texelColumns; i += 2)
                coarse.classes.push_back(fine.classes[static_cast<std::size_t>(j) * static_cast<std::size_t>(fine.texelColumns) +
                                                      static_cast<std::size_t>(i)]);
    }
    const int span = (coarse.texelColumns - 1) / m;
    const auto texelMetres = static_cast<float>(
        _plan.scheme.spacingMetres(coarse.level) * std::max(_plan.scheme.intervalsX, _plan.scheme.intervalsY) / m);
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
        {
            float error = 0.0f;
            for (int c = 0; c < 4; ++c)
                error = std::max(error, fine.textureError[static_cast<std::size_t>((2 * y + (c >> 1)) * 2 * span + 2 * x + (c & 1))]);
            if (losesDetail(fine, coarse, x, y, m))
                error = texelMetres;
            coarse.textureError.push_back(error);
        }
    return coarse;
}

std::uint64_t UnitBuilder::writeChildren(const Unit& unit, const LevelArrays& arrays)
{
    const int parentLevel = arrays.level - 1, span = 1 << (parentLevel - unit.root.level);
    std::uint64_t tiles = 0;
    for (int y = 0; y < span; ++y)
        for (int x = 0; x < span; ++x)
        {
            const TileKey parent{parentLevel, unit.root.x * span + x, unit.root.y * span + y};
            if (!_plan.fact(parent).any)
                continue;
            osg::ref_ptr<osg::Group> group = new osg::Group;
            for (int c = 0; c < 4; ++c)
            {
                const TileKey key = parent.child(c & 1, c >> 1);
                const auto tile = _factory.create(key, arrays, 2 * x + (c & 1), 2 * y + (c >> 1),
                                                  "../../" + key.path() + ".osgb");
                if (!tile)
                    continue;
                group->addChild(tile);
                ++tiles;
            }
            writeNodeAtomically(*group, _plan.tileFile(parent));
        }
    return tiles;
}

std::uint64_t UnitBuilder::build(const Unit& unit)
{
    LevelArrays arrays = unit.tier == 0 ? sampled(unit) : gathered(unit);
    std::uint64_t tiles = 0;
    for (int level = unit.latticeLevel(); level > unit.root.level; --level)
    {
        LevelArrays next = coarser(arrays);
        tiles += writeChildren(unit, arrays);
        arrays = std::move(next);
    }
    ByteWriter writer;
    writer.put(tiles);
    writer.put(arrays.heights.values);
    writer.put(arrays.slopeX);
    writer.put(arrays.slopeY);
    writer.put(arrays.colors);
    writer.put(arrays.classes);
    writer.put(arrays.textureError.front());
    writeFileAtomically(_plan.workFile("tiles", unit), writer.bytes().data(), writer.bytes().size());
    return tiles;
}

osg::ref_ptr<osg::Node> UnitBuilder::root(const std::string& file)
{
    // What the last unit left is the root's arrays: a lattice of one tile.
    Unit top = _plan.tiers.back().front();
    Unit whole;
    whole.root = {0, 0, 0};
    whole.depth = 0;
    whole.tier = top.tier + 1;
    return _factory.create(whole.root, gathered(whole), 0, 0, file);
}

} // namespace

void writeNodeAtomically(const osg::Node& node, const std::string& path)
{
    osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    if (!writer)
        throw BuildError(path + ": OpenSceneGraph's plugin osgdb_osg cannot be found; install openscenegraph's plugins, "
                                "or name their folder in OSG_LIBRARY_PATH.");
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("Compressor=zlib WriteImageHint=IncludeData");
    std::ostringstream stream(std::ios::binary);
    const auto result = writer->writeNode(node, stream, options);
    if (!result.success())
        throw BuildError(path + ": OpenSceneGraph cannot write the tile (" + result.statusMessage() + ").");
    const std::string bytes = stream.str();
    writeFileAtomically(path, bytes.data(), bytes.size());
}

TilePassResult runTilePass(BuildPlan& plan)
{
    std::vector<std::unique_ptr<UnitBuilder>> builders(static_cast<std::size_t>(plan.threads));
    std::atomic<std::uint64_t> tiles{0}, reused{0};
    for (const auto& units : plan.tiers)
        runOnWorkers(plan.threads, units.size(),
                     [&](int worker, std::size_t index)
                     {
                         const Unit& unit = units[index];
                         if (plan.fact(unit.root).any)
                         {
                             ByteReader reader(plan.options.resume ? plan.workFile("tiles", unit) : std::string());
                             if (reader.good())
                             {
                                 const auto before = reader.get<std::uint64_t>();
                                 tiles += before;
                                 reused += before;
                             }
                             else
                             {
                                 auto& builder = builders[static_cast<std::size_t>(worker)];
                                 if (!builder)
                                     builder = std::make_unique<UnitBuilder>(plan);
                                 tiles += builder->build(unit);
                             }
                         }
                         plan.advance("tiles");
                     });
    TilePassResult result;
    result.tiles = tiles + 1;
    result.tilesReused = reused;
    result.root = UnitBuilder(plan).root("tiles/0/0/0.osgb");
    return result;
}

} // namespace osgGeoFX
