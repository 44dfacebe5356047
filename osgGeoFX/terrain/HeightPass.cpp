// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "AtomicFile.h"
#include "BuildPlan.h"
#include "HeightGrid.h"
#include "WorkQueue.h"

#include <osgGeoFX/geodata/BuildError.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

constexpr float NO_HEIGHT = std::numeric_limits<float>::quiet_NaN();

/// Largest vertical distance between the mesh with every `step`-th post and the full one over part of a lattice.
/// Where only one of the two has ground, `missing` stands for the distance.
float meshDeviation(const HeightGrid& grid, int column, int row, int columns, int rows, int step, float missing)
{
    float worst = 0.0f;
    const float scale = 1.0f / static_cast<float>(step);
    for (int j0 = row; j0 < row + rows; j0 += step)
        for (int i0 = column; i0 < column + columns; i0 += step)
        {
            const float sw = grid.at(i0, j0), se = grid.at(i0 + step, j0);
            const float nw = grid.at(i0, j0 + step), ne = grid.at(i0 + step, j0 + step);
            for (int j = 0; j <= step; ++j)
                for (int i = 0; i <= step; ++i)
                {
                    // The diagonal runs from south-west to north-east, as in the tiles' meshes.
                    const float u = static_cast<float>(i) * scale, v = static_cast<float>(j) * scale;
                    const float coarse = i >= j ? sw + u * (se - sw) + v * (ne - se) : sw + v * (nw - sw) + u * (ne - nw);
                    const float fine = grid.at(i0 + i, j0 + j);
                    const float difference = std::abs(fine - coarse);
                    if (difference == difference)
                        worst = std::max(worst, difference);
                    else if (std::isnan(fine) != std::isnan(coarse))
                        worst = std::max(worst, missing);
                }
        }
    return worst;
}

HeightGrid decimated(const HeightGrid& grid, int step)
{
    HeightGrid result((grid.columns - 1) / step + 1, (grid.rows - 1) / step + 1);
    for (int j = 0; j < result.rows; ++j)
        for (int i = 0; i < result.columns; ++i)
            result.at(i, j) = grid.at(i * step, j * step);
    return result;
}

/// Facts of the unit's tiles above its lattice's level, and on it where the lattice is the finest one.
void gatherFacts(BuildPlan& plan, const Unit& unit, const HeightGrid& grid)
{
    const TilingScheme& scheme = plan.scheme;
    const bool finest = unit.latticeLevel() == scheme.finestLevel;
    for (int level = unit.latticeLevel() - (finest ? 0 : 1); level >= unit.root.level; --level)
    {
        const int step = 1 << (unit.latticeLevel() - level);
        const int span = 1 << (level - unit.root.level);
        const int columns = scheme.intervalsX * step, rows = scheme.intervalsY * step;
        for (int y = 0; y < span; ++y)
            for (int x = 0; x < span; ++x)
            {
                const TileKey key{level, unit.root.x * span + x, unit.root.y * span + y};
                TileFacts facts;
                if (level == scheme.finestLevel)
                {
                    facts.minHeight = std::numeric_limits<float>::max();
                    facts.maxHeight = std::numeric_limits<float>::lowest();
                    for (int j = y * rows; j <= (y + 1) * rows; ++j)
                        for (int i = x * columns; i <= (x + 1) * columns; ++i)
                        {
                            const float height = grid.at(i, j);
                            if (std::isnan(height))
                                continue;
                            facts.any = true;
                            facts.minHeight = std::min(facts.minHeight, height);
                            facts.maxHeight = std::max(facts.maxHeight, height);
                        }
                    if (!facts.any)
                        facts = {};
                }
                else
                {
                    float below = 0.0f;
                    for (int c = 0; c < 4; ++c)
                    {
                        const TileFacts& child = plan.fact(key.child(c & 1, c >> 1));
                        if (!child.any)
                            continue;
                        facts.minHeight = facts.any ? std::min(facts.minHeight, child.minHeight) : child.minHeight;
                        facts.maxHeight = facts.any ? std::max(facts.maxHeight, child.maxHeight) : child.maxHeight;
                        facts.error = std::max(facts.error, child.error);
                        facts.any = true;
                    }
                    // The lattice of an upper tier is itself an approximation, by what its tiles' errors say.
                    if (!finest)
                        for (int j = 0; j < step; ++j)
                            for (int i = 0; i < step; ++i)
                                below = std::max(below, plan.fact({unit.latticeLevel(), key.x * step + i, key.y * step + j})
                                                            .error);
                    const float deviation = meshDeviation(grid, x * columns, y * rows, columns, rows, step,
                                                          static_cast<float>(scheme.spacingMetres(level)));
                    facts.error = std::max(facts.error, deviation + below);
                }
                plan.fact(key) = facts;
            }
    }
}

/// Writes the finest heights along all tile borders of a unit, from which the skirts follow.
void writeBorders(const BuildPlan& plan, const Unit& unit, const HeightGrid& grid)
{
    std::vector<float> along;
    for (int line = 0; line <= unit.span(); ++line)
        for (int i = 0; i < grid.columns; ++i)
            along.push_back(grid.at(i, line * plan.scheme.intervalsY));
    for (int line = 0; line <= unit.span(); ++line)
        for (int j = 0; j < grid.rows; ++j)
            along.push_back(grid.at(line * plan.scheme.intervalsX, j));
    ByteWriter writer;
    writer.put(along);
    writeFileAtomically(plan.workFile("borders", unit), writer.bytes().data(), writer.bytes().size());
}

bool loadUnit(BuildPlan& plan, const Unit& unit)
{
    ByteReader reader(plan.workFile("facts", unit));
    if (!reader.good())
        return false;
    const auto facts = reader.getVector<TileFacts>();
    std::size_t next = 0;
    const int lowest = unit.latticeLevel() - (unit.tier == 0 ? 0 : 1);
    for (int level = unit.root.level; level <= lowest; ++level)
    {
        const int span = 1 << (level - unit.root.level);
        for (int y = 0; y < span; ++y)
            for (int x = 0; x < span; ++x)
            {
                if (next == facts.size())
                    return false;
                plan.fact({level, unit.root.x * span + x, unit.root.y * span + y}) = facts[next++];
            }
    }
    return next == facts.size();
}

void writeFacts(BuildPlan& plan, const Unit& unit)
{
    std::vector<TileFacts> facts;
    const int lowest = unit.latticeLevel() - (unit.tier == 0 ? 0 : 1);
    for (int level = unit.root.level; level <= lowest; ++level)
    {
        const int span = 1 << (level - unit.root.level);
        for (int y = 0; y < span; ++y)
            for (int x = 0; x < span; ++x)
                facts.push_back(plan.fact({level, unit.root.x * span + x, unit.root.y * span + y}));
    }
    ByteWriter writer;
    writer.put(facts);
    writeFileAtomically(plan.workFile("facts", unit), writer.bytes().data(), writer.bytes().size());
}

void sampleUnit(BuildPlan& plan, const Unit& unit, RasterStack& rasters)
{
    const TilingScheme& scheme = plan.scheme;
    const Lattice lattice =
        scheme.lattice(unit.latticeLevel(), unit.root.x * unit.span(), unit.root.y * unit.span(), unit.span(),
                       scheme.intervalsX, scheme.intervalsY, 1);
    HeightGrid withApron(lattice.columns, lattice.rows);
    withApron.values = rasters.heights(lattice);
    ByteWriter writer;
    writer.put(withApron.values);
    writeFileAtomically(plan.workFile("heights", unit), writer.bytes().data(), writer.bytes().size());

    HeightGrid grid(lattice.columns - 2, lattice.rows - 2);
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i)
            grid.at(i, j) = withApron.at(i + 1, j + 1);
    gatherFacts(plan, unit, grid);
    writeBorders(plan, unit, grid);
    ByteWriter root;
    root.put(decimated(grid, unit.span()).values);
    writeFileAtomically(plan.workFile("roots", unit), root.bytes().data(), root.bytes().size());
}

void gatherUnit(BuildPlan& plan, const Unit& unit)
{
    HeightGrid grid(unit.span() * plan.scheme.intervalsX + 1, unit.span() * plan.scheme.intervalsY + 1);
    for (int y = 0; y < unit.span(); ++y)
        for (int x = 0; x < unit.span(); ++x)
        {
            Unit below;
            below.root = {unit.latticeLevel(), unit.root.x * unit.span() + x, unit.root.y * unit.span() + y};
            ByteReader reader(plan.workFile("roots", below));
            HeightGrid part(plan.scheme.intervalsX + 1, plan.scheme.intervalsY + 1);
            part.values = reader.getVector<float>();
            if (!reader.good() || part.values.size() != static_cast<std::size_t>(part.columns) * part.rows)
                throw BuildError(plan.workFile("roots", below) +
                                 ": this work file is damaged; build again without --resume.");
            for (int j = 0; j < part.rows; ++j)
                for (int i = 0; i < part.columns; ++i)
                    grid.at(x * plan.scheme.intervalsX + i, y * plan.scheme.intervalsY + j) = part.at(i, j);
        }
    gatherFacts(plan, unit, grid);
    ByteWriter root;
    root.put(decimated(grid, unit.span()).values);
    writeFileAtomically(plan.workFile("roots", unit), root.bytes().data(), root.bytes().size());
}

/// Sets the skirts along one grid line of the finest level from the finest heights on it.
void skirtsAlong(const BuildPlan& plan, int line, int intervals, const std::vector<float>& heights,
                 std::vector<std::vector<float>>& skirts)
{
    const int finest = plan.scheme.finestLevel;
    int coarsest = finest; // the first level on which the line is a border between tiles
    while (coarsest > 0 && ((line >> (finest - coarsest)) & 1) == 0)
        --coarsest;

    std::vector<std::vector<float>> profiles; // by level from the coarsest, at each finest post
    std::vector<float> lowest(heights.size(), std::numeric_limits<float>::max());
    for (int level = coarsest; level <= finest; ++level)
    {
        const std::size_t step = std::size_t{1} << (finest - level);
        auto& profile = profiles.emplace_back(heights.size(), NO_HEIGHT);
        for (std::size_t start = 0; start + step < heights.size(); start += step)
        {
            const float a = heights[start], b = heights[start + step];
            for (std::size_t i = 0; i <= step; ++i)
            {
                const float height = a + (b - a) * (static_cast<float>(i) / static_cast<float>(step));
                profile[start + i] = height;
                if (height < lowest[start + i])
                    lowest[start + i] = height;
            }
        }
    }
    const auto sag = static_cast<float>(plan.scheme.chordSag(coarsest));
    for (int level = coarsest; level <= finest; ++level)
    {
        const auto& profile = profiles[static_cast<std::size_t>(level - coarsest)];
        const std::size_t posts = static_cast<std::size_t>(intervals) << (finest - level);
        const auto across = static_cast<std::size_t>(plan.scheme.tilesAcross(level));
        // Rounding alone opens hair lines between meshes of different density, even in a plain.
        const float least = 0.5f + 0.02f * static_cast<float>(plan.scheme.spacingMetres(level)) + sag;
        for (std::size_t tile = 0; tile < across; ++tile)
        {
            float depth = 0.0f;
            for (std::size_t i = tile * posts; i <= (tile + 1) * posts; ++i)
                if (!std::isnan(profile[i]))
                    depth = std::max(depth, profile[i] - lowest[i]);
            skirts[static_cast<std::size_t>(level)]
                  [static_cast<std::size_t>(line >> (finest - level)) * across + tile] = depth + least;
        }
    }
}

/// Borders of one row (or column) of units, end to end: a line of finest heights for each of its tile borders.
std::vector<std::vector<float>> borderLines(const BuildPlan& plan, int index, bool horizontal)
{
    const int across = plan.scheme.tilesAcross(plan.tiers[0][0].root.level);
    const int span = plan.tiers[0][0].span();
    const auto lengthX = static_cast<std::size_t>(span * plan.scheme.intervalsX + 1);
    const auto lengthY = static_cast<std::size_t>(span * plan.scheme.intervalsY + 1);
    const std::size_t length = horizontal ? lengthX : lengthY;
    std::vector<std::vector<float>> lines(static_cast<std::size_t>(span) + 1);
    for (int other = 0; other < across; ++other)
    {
        Unit unit = plan.tiers[0][0];
        unit.root.x = horizontal ? other : index;
        unit.root.y = horizontal ? index : other;
        ByteReader reader(plan.workFile("borders", unit));
        const auto values = reader.getVector<float>();
        if (!reader.good() || values.size() != lines.size() * (lengthX + lengthY))
            throw BuildError(plan.workFile("borders", unit) +
                             ": this work file is damaged; build again without --resume.");
        for (std::size_t line = 0; line < lines.size(); ++line)
        {
            const auto* first = values.data() + (horizontal ? 0 : lines.size() * lengthX) + line * length;
            // The first post of a unit is the last one of the unit before it.
            lines[line].insert(lines[line].end(), first + (other > 0 ? 1 : 0), first + length);
        }
    }
    return lines;
}

void gatherSkirts(BuildPlan& plan)
{
    const int across = plan.scheme.tilesAcross(plan.tiers[0][0].root.level);
    const int span = plan.tiers[0][0].span();
    for (const bool horizontal : {true, false})
        for (int index = 0; index < across; ++index)
        {
            const auto lines = borderLines(plan, index, horizontal);
            const int last = index + 1 == across ? span : span - 1;
            for (int line = 0; line <= last; ++line)
                skirtsAlong(plan, index * span + line, horizontal ? plan.scheme.intervalsX : plan.scheme.intervalsY,
                            lines[static_cast<std::size_t>(line)],
                            horizontal ? plan.horizontalSkirts : plan.verticalSkirts);
        }
    for (int level = plan.scheme.finestLevel; level >= 0; --level)
        for (int y = 0; y < plan.scheme.tilesAcross(level); ++y)
            for (int x = 0; x < plan.scheme.tilesAcross(level); ++x)
            {
                float& depth = plan.fact({level, x, y}).skirtBelow;
                depth = std::max({plan.horizontalSkirt(level, y, x), plan.horizontalSkirt(level, y + 1, x),
                                  plan.verticalSkirt(level, x, y), plan.verticalSkirt(level, x + 1, y)});
                if (level < plan.scheme.finestLevel)
                    for (int c = 0; c < 4; ++c)
                        depth = std::max(depth, plan.fact({level + 1, 2 * x + (c & 1), 2 * y + (c >> 1)}).skirtBelow);
            }
}

} // namespace

void runHeightPass(BuildPlan& plan)
{
    std::vector<std::unique_ptr<RasterStack>> rasters(static_cast<std::size_t>(plan.threads));
    for (const auto& units : plan.tiers)
        runOnWorkers(plan.threads, units.size(),
                     [&](int worker, std::size_t index)
                     {
                         const Unit& unit = units[index];
                         if (!plan.options.resume || !loadUnit(plan, unit))
                         {
                             auto& stack = rasters[static_cast<std::size_t>(worker)];
                             if (unit.tier == 0 && !stack)
                                 stack = std::make_unique<RasterStack>(plan);
                             if (unit.tier == 0)
                                 sampleUnit(plan, unit, *stack);
                             else
                                 gatherUnit(plan, unit);
                             // Written last: a unit with facts is a unit that is done.
                             writeFacts(plan, unit);
                         }
                         plan.advance("heights");
                     });
    if (!plan.facts[0][0].any)
        throw BuildError(plan.options.dems.front() +
                         ": the elevation has no data at all; check its no-data value with gdalinfo -stats.");
    gatherSkirts(plan);
}

} // namespace osgGeoFX
