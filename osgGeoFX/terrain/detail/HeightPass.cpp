// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/BuildStage.h>
#include <osgGeoFX/terrain/detail/HeightGrid.h>
#include <osgGeoFX/terrain/detail/KeptFiles.h>
#include <osgGeoFX/terrain/detail/PackedArray.h>
#include <osgGeoFX/terrain/detail/UnitSources.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

/// The largest vertical distance between the mesh of every `step`-th post and the full one. If only one of them has
/// ground somewhere, the distance there is `missing`.
float meshDeviation(const HeightGrid& grid, int step, float missing)
{
    float worst = 0.0f;
    const float scale = 1.0f / static_cast<float>(step);
    for (int j0 = 0; j0 + step < grid.rows; j0 += step)
        for (int i0 = 0; i0 + step < grid.columns; i0 += step)
        {
            const float sw = grid.at(i0, j0), se = grid.at(i0 + step, j0);
            const float nw = grid.at(i0, j0 + step), ne = grid.at(i0 + step, j0 + step);
            for (int j = 0; j <= step; ++j)
                for (int i = 0; i <= step; ++i)
                {
                    const float u = static_cast<float>(i) * scale, v = static_cast<float>(j) * scale;
                    const float coarse =
                        i >= j ? sw + u * (se - sw) + v * (ne - se) : sw + v * (nw - sw) + u * (ne - nw);
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

/// Visits the tiles whose facts the unit settles. For an upper tier these do not include the lattice's own level.
template<typename Visit>
void forTiles(const Unit& unit, Visit visit)
{
    for (int level = unit.latticeLevel() - (unit.sampled ? 0 : 1); level >= unit.root.level; --level)
    {
        const int span = 1 << (level - unit.root.level);
        for (int y = 0; y < span; ++y)
            for (int x = 0; x < span; ++x)
                visit(TileKey{level, unit.root.x * span + x, unit.root.y * span + y});
    }
}

/// How far a leaf's posts, joined by straight lines, may be from what a denser neighbour samples between them, metres.
/// The elevation there is no denser than the posts. So the straight lines of its samples have one bend in a cell at
/// most, which shows in the second differences beside it.
float leafError(const BuildPlan& plan, const TileKey& key, const HeightGrid& grid, int column, int row)
{
    const int n = plan.scheme.intervals;
    float bend = 0.0f;
    const auto include = [&](float before, float here, float after)
    {
        const float each = std::abs(before - 2.0f * here + after);
        if (each > bend) bend = each; // false for a hole
    };
    for (int j = row; j <= row + n; ++j)
        for (int i = column + 1; i < column + n; ++i)
            include(grid.at(i - 1, j), grid.at(i, j), grid.at(i + 1, j));
    for (int j = row + 1; j < row + n; ++j)
        for (int i = column; i <= column + n; ++i)
            include(grid.at(i, j - 1), grid.at(i, j), grid.at(i, j + 1));
    const double cell = plan.scheme.tileMetres(key.level) / n;
    // The Earth is round: it rises by this much above a chord across a cell.
    const double sag = plan.scheme.crs.geographic ? 0.125 * cell * cell / 6378137.0 : 0.0;
    return 0.5f * bend + static_cast<float>(sag);
}

/// Of a row of `intervals` + 1 posts, metres. 0 if none has a height.
float meanHeight(const HeightGrid& grid, int column, int row, int intervals)
{
    double sum = 0.0;
    int count = 0;
    for (int i = column; i <= column + intervals; ++i)
    {
        const float height = grid.at(i, row);
        if (std::isnan(height)) continue;
        sum += static_cast<double>(height);
        ++count;
    }
    return count > 0 ? static_cast<float>(sum / count) : 0.0f;
}

TileFacts finestFacts(const BuildPlan& plan, const Unit& unit, const TileKey& key, const HeightGrid& grid)
{
    const int n = plan.scheme.intervals;
    const int column = (key.x - unit.root.x * unit.span()) * n, row = (key.y - unit.root.y * unit.span()) * n;
    TileFacts facts;
    for (int j = row; j <= row + n; ++j)
        for (int i = column; i <= column + n; ++i)
        {
            const float height = grid.at(i, j);
            if (std::isnan(height))
            {
                facts.holes = 1;
                continue;
            }
            facts.minHeight = facts.any ? std::min(facts.minHeight, height) : height;
            facts.maxHeight = facts.any ? std::max(facts.maxHeight, height) : height;
            facts.any = 1;
        }
    const int posts = plan.scheme.step(key.level);
    const int east = std::min(n, (plan.scheme.lastColumn - plan.scheme.firstColumn(key) + posts - 1) / posts);
    const int north = std::min(n, (plan.scheme.lastRow - plan.scheme.firstRow(key) + posts - 1) / posts);
    if (plan.scheme.endsAt(key, 0)) facts.ends[0] = meanHeight(grid, column, row, east);
    if (plan.scheme.endsAt(key, 2)) facts.ends[1] = meanHeight(grid, column, row + north, east);
    if (plan.isBesideDenser(key)) facts.error = leafError(plan, key, grid, column, row);
    return facts;
}

TileFacts gatheredFacts(const BuildPlan& plan, const Unit& unit, const TileKey& key)
{
    TileFacts facts;
    std::array<double, 2> ends{}, widths{};
    for (int c = 0; c < 4; ++c)
    {
        const TileKey below = key.child(c & 1, c >> 1);
        const TileFacts& child = plan.fact(below);
        if (plan.scheme.exists(below) && (!child.any || child.holes)) facts.holes = 1;
        if (!child.any) continue;
        facts.minHeight = facts.any ? std::min(facts.minHeight, child.minHeight) : child.minHeight;
        facts.maxHeight = facts.any ? std::max(facts.maxHeight, child.maxHeight) : child.maxHeight;
        facts.any = 1;
        const int column = plan.scheme.firstColumn(below);
        const double width =
            std::min(plan.scheme.intervals * plan.scheme.step(below.level), plan.scheme.lastColumn - column);
        for (std::size_t end = 0; end < 2; ++end)
        {
            if (!plan.scheme.endsAt(below, end == 0 ? 0 : 2)) continue;
            ends[end] += width * static_cast<double>(child.ends[end]);
            widths[end] += width;
        }
        // The lattice of an upper tier consists of the roots below it. The levels above use the same lattice.
        const bool root = !unit.sampled && key.level == unit.latticeLevel() - 1;
        facts.latticeError = std::max(facts.latticeError, root ? child.rootError : child.latticeError);
    }
    for (std::size_t end = 0; end < 2; ++end)
        if (widths[end] > 0.0) facts.ends[end] = static_cast<float>(ends[end] / widths[end]);
    facts.error = facts.latticeError + static_cast<float>(plan.finestError(key.level));
    return facts;
}

void settleFacts(BuildPlan& plan, const Unit& unit, const HeightGrid& grid)
{
    forTiles(unit,
             [&](const TileKey& key)
             {
                 if (!plan.has(key)) return;
                 plan.fact(key) = unit.sampled && key.level == unit.latticeLevel()
                                      ? finestFacts(plan, unit, key, grid)
                                      : gatheredFacts(plan, unit, key);
             });
    if (!plan.has(unit.root)) return;
    // The error that the next tier starts with. The border of the data may be off by a cell.
    TileFacts& root = plan.fact(unit.root);
    const double cell = plan.scheme.tileMetres(unit.root.level) / plan.scheme.intervals;
    // The Earth is round: it rises by this much above a chord across a cell.
    const double sag = plan.scheme.crs.geographic ? 0.25 * cell * cell / 6378137.0 : 0.0;
    root.rootError = 0.0f;
    if (root.any)
        root.rootError = root.latticeError + static_cast<float>(sag) +
                         meshDeviation(grid, unit.span(), static_cast<float>(cell));
}

void writeHeights(const BuildPlan& plan, const Unit& unit, const HeightGrid& grid)
{
    ByteWriter writer;
    writer.put(grid.values);
    writeFileAtomically(plan.heightFile("heights", unit), writer.bytes().data(), writer.bytes().size());
}

/// These are kept for updates, so they are packed.
void writeRoots(const BuildPlan& plan, const Unit& unit, const HeightGrid& grid)
{
    ByteWriter writer;
    writer.put(packedArray(grid.values));
    writeFileAtomically(plan.heightFile("roots", unit), writer.bytes().data(), writer.bytes().size());
}

/// Whether any post has no height although a raster covers it.
bool lacksHeights(RasterStack& rasters, const Lattice& lattice, const HeightGrid& heights)
{
    const auto isMissing = [](float height)
    {
        return std::isnan(height);
    };
    if (std::none_of(heights.values.begin(), heights.values.end(), isMissing)) return false;
    const std::vector<unsigned char> covered = rasters.covered(lattice, heights.values);
    for (std::size_t i = 0; i < covered.size(); ++i)
        if (covered[i] && isMissing(heights.values[i])) return true;
    return false;
}

void sampleUnit(BuildPlan& plan, const Unit& unit, RasterStack& rasters)
{
    const TilingScheme& scheme = plan.scheme;
    plan.startFacts(unit);
    HeightGrid grid(unit.span() * scheme.intervals + 1, unit.span() * scheme.intervals + 1);
    const int validColumns = plan.validColumns(unit), validRows = plan.validRows(unit);
    HeightGrid withApron(validColumns + 2, validRows + 2);
    const Lattice lattice = plan.postsWithApron(unit);
    withApron.values = rasters.unitHeights(unit);
    TileFacts::VoidState voids = TileFacts::NO_VOIDS;
    if (plan.voids)
        voids = TileFacts::FILLED_VOIDS;
    else if (plan.options.voids == Voids::FILL && lacksHeights(rasters, lattice, withApron))
        voids = TileFacts::HAS_VOIDS;
    for (int j = 0; j < validRows; ++j)
        for (int i = 0; i < validColumns; ++i)
            grid.at(i, j) = withApron.at(i + 1, j + 1);
    extendBeyond(grid.values, grid.columns, grid.rows, 1, validColumns, validRows);
    settleFacts(plan, unit, grid);
    TileFacts& root = plan.fact(unit.root);
    root.voids = voids;
    writeHeights(plan, unit, withApron);
    if (root.any) writeRoots(plan, unit, decimated(grid, unit.span()));
    if (voids == TileFacts::HAS_VOIDS) writeFileAtomically(VoidRaster::neededFile(plan), "", 0);
    // Facts are written last, so a unit with facts is done.
    plan.writeFacts(unit, heightsKey(plan, unit));
}

/// All units that sample go first, since voids are filled from all of them. Those with voids sample again once these
/// are filled.
class SampledHeights : public BuildStage
{
public:
    SampledHeights(BuildPlan& plan, bool again)
        : BuildStage(again ? "filled-heights" : "heights", again ? "voids" : "heights"), _plan(plan),
          _again(again), _rasters(static_cast<std::size_t>(plan.threads))
    {
        for (const auto& units : plan.tiers)
            for (const Unit& unit : units)
                if (unit.sampled) _units.push_back(&unit);
    }
    std::size_t units() const override { return _units.size(); }
    bool isNeeded() const override { return !_again || VoidRaster::isNeeded(_plan); }
    void begin() override
    {
        if (_again) _plan.voids = std::make_shared<VoidRaster>(_plan);
    }
    bool takeOver(std::size_t index) override
    {
        const Unit& unit = *_units[index];
        // One process knows the facts from the first time already.
        if (!_again || _plan.workers == BuildPlan::Workers::MANY_PROCESSES)
            if (!_plan.loadFacts(unit)) return false;
        return !_again || _plan.fact(unit.root).voids != TileFacts::HAS_VOIDS;
    }
    bool hasWork(std::size_t index) const override
    {
        return !_again || _plan.fact(_units[index]->root).voids == TileFacts::HAS_VOIDS;
    }
    /// Keeps what upper tiers gather. The heights themselves are sampled again if a tile needs them.
    bool keep(std::size_t index) override
    {
        const Unit& unit = *_units[index];
        const std::string ending = _again ? "-filled/" : "/", place = unit.root.path();
        if (!_plan.kept ||
            !_plan.kept->haveFacts(_again ? "facts-filled" : "facts", unit, heightsKey(_plan, unit)))
            return false;
        // Units without data have no roots. Facts come last, since a unit with facts is done.
        const bool roots = _plan.kept->take("roots" + ending + place);
        if (!_plan.kept->take("facts" + ending + place) || !_plan.loadFacts(unit)) return false;
        const TileFacts& root = _plan.fact(unit.root);
        if (root.any && !roots) return false;
        if (root.voids == TileFacts::HAS_VOIDS) writeFileAtomically(VoidRaster::neededFile(_plan), "", 0);
        return true;
    }
    void run(int worker, std::size_t index) override
    {
        auto& stack = _rasters[static_cast<std::size_t>(worker)];
        if (!stack) stack = std::make_unique<RasterStack>(_plan);
        sampleUnit(_plan, *_units[index], *stack);
    }

private:
    BuildPlan& _plan;
    const bool _again;
    std::vector<const Unit*> _units;
    std::vector<std::unique_ptr<RasterStack>> _rasters;
};

/// The units of an upper tier, from the roots of those below.
class GatheredHeights : public BuildStage
{
public:
    GatheredHeights(BuildPlan& plan, std::size_t tier)
        : BuildStage("heights-" + std::to_string(tier), "heights"), _plan(plan)
    {
        for (const Unit& unit : plan.tiers[tier])
            if (!unit.sampled) _units.push_back(&unit);
    }
    std::size_t units() const override { return _units.size(); }
    bool takeOver(std::size_t index) override { return _plan.loadFacts(*_units[index]); }
    void run(int, std::size_t index) override
    {
        const Unit& unit = *_units[index];
        _plan.startFacts(unit);
        const HeightGrid grid = gatherRoots(_plan, unit);
        settleFacts(_plan, unit, grid);
        if (_plan.fact(unit.root).any) writeRoots(_plan, unit, decimated(grid, unit.span()));
        _plan.writeFacts(unit, {});
    }

private:
    BuildPlan& _plan;
    std::vector<const Unit*> _units;
};

} // namespace

HeightGrid gatherRoots(const BuildPlan& plan, const Unit& unit)
{
    const TilingScheme& scheme = plan.scheme;
    const int n = scheme.intervals;
    HeightGrid grid(unit.span() * n + 1, unit.span() * n + 1);
    std::fill(grid.values.begin(), grid.values.end(), std::numeric_limits<float>::quiet_NaN());
    for (int y = 0; y < unit.span(); ++y)
        for (int x = 0; x < unit.span(); ++x)
        {
            Unit below;
            below.root = {unit.latticeLevel(), unit.root.x * unit.span() + x, unit.root.y * unit.span() + y};
            if (!plan.fact(below.root).any) continue;
            const std::string file = plan.heightFile("roots", below);
            ByteReader reader(file);
            HeightGrid part(n + 1, n + 1);
            const auto packed = reader.getVector<char>();
            if (!reader.good() ||
                !unpackBytes(packed, part.values.data(), part.values.size() * sizeof(float), sizeof(float)))
                throw BuildError(file + ": this work file is damaged; build again without --resume.");
            for (int j = 0; j <= n; ++j)
                for (int i = 0; i <= n; ++i)
                    // A neighbour without data must not delete the border that this unit has.
                    if (!std::isnan(part.at(i, j))) grid.at(x * n + i, y * n + j) = part.at(i, j);
        }
    extendBeyond(grid.values, grid.columns, grid.rows, 1, plan.validColumns(unit), plan.validRows(unit));
    return grid;
}

void addHeightStages(BuildPlan& plan, BuildStages& stages)
{
    stages.push_back(std::make_unique<SampledHeights>(plan, false));
    if (plan.options.voids == Voids::FILL)
    {
        addVoidStages(plan, stages);
        stages.push_back(std::make_unique<SampledHeights>(plan, true));
    }
    for (std::size_t tier = 1; tier < plan.tiers.size(); ++tier)
    {
        auto stage = std::make_unique<GatheredHeights>(plan, tier);
        if (stage->units() > 0) stages.push_back(std::move(stage));
    }
}

} // namespace osgGeoFX
