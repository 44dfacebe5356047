// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/BuildStage.h>
#include <osgGeoFX/terrain/detail/GroundRaster.h>
#include <osgGeoFX/terrain/detail/ShoreDistance.h>
#include <osgGeoFX/terrain/detail/WaterFinder.h>

#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

// The rows that one worker samples at a time.
constexpr int STRIP = 64;
// Elevation below the sea gives depths only if it reaches this depth somewhere, metres. Otherwise it is noise about
// 0.
constexpr float LEAST_DEPTH = 10.0f;

std::uint8_t byteOf(double share)
{
    return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255.0));
}

std::uint16_t shoreCode(double distance)
{
    return static_cast<std::uint16_t>(std::lround(glsl::geofx_shoreCode(distance) * 65280.0));
}

// What land cover and voids say of a cell.
constexpr std::uint8_t WATER = 1, CLASSED = 2, FILLED = 4;

/// The rows of a strip: heights, likely trees, and what land cover and voids say. Each array has a row after the
/// other.
struct Strip
{
    Strip(std::size_t columns, int rows)
        : heights(columns * static_cast<std::size_t>(rows)), cells(heights.size()), kinds(heights.size())
    {
    }
    std::vector<float> heights;
    std::vector<GroundCell> cells;
    std::vector<std::uint8_t> kinds;
};

class GroundPass
{
public:
    GroundPass(const BuildPlan& plan, std::size_t patch);

    int strips() const { return (_size.rows + STRIP - 1) / STRIP; }
    std::string stripFile(int strip) const;
    /// Samples heights, classes, and what is likely to grow there.
    void writeStrip(RasterStack& rasters, int strip) const;
    /// Makes the raster of all strips.
    void writeShores();

private:
    Strip readStrip(int strip) const;
    /// The strip of a row. It stays in memory for the next rows.
    const Strip& stripOf(int row);
    std::size_t place(int row) const { return static_cast<std::size_t>(row % STRIP) * _columns; }
    void readKinds();
    void findWater();
    double treeLine(int row) const;
    /// Finest posts from point to point.
    double perColumn() const
    {
        return static_cast<double>(_size.lastColumn - _size.firstColumn) / (_size.columns - 1);
    }
    double perRow() const { return static_cast<double>(_size.lastRow - _size.firstRow) / (_size.rows - 1); }

    const BuildPlan& _plan;
    const std::size_t _patch;
    const GroundPatch _size;
    const std::size_t _columns;
    CellMetres _metres;
    std::vector<double> _latitudes; ///< by row, degrees
    // For writeShores() alone.
    std::unique_ptr<CellMask> _water, _classed; ///< by land cover; other cells go by their heights
    std::unique_ptr<CellMask> _lakes, _filled;
    Strip _strip{0, 0};
    int _stripNumber = -1;
    bool _allClassed = true, _depths = false;
};

GroundPass::GroundPass(const BuildPlan& plan, std::size_t patch)
    : _plan(plan), _patch(patch), _size(plan.groundPatches[patch]),
      _columns(static_cast<std::size_t>(_size.columns))
{
    const TilingScheme& scheme = plan.scheme;
    const double perColumn = this->perColumn(), perRow = this->perRow();
    const TransformationPtr toGeographic =
        scheme.crs.geographic
            ? nullptr
            : createTransformation(scheme.crs.srs, GridCrs::geocentric().srs, plan.options.dems.front());
    for (int row = 0; row < _size.rows; ++row)
    {
        const double y = scheme.gridY(_size.firstRow + row * perRow);
        _metres.x.push_back(scheme.metresX(y) * perColumn);
        const double before =
            row > 0 ? scheme.metresY(scheme.gridY(_size.firstRow + (row - 0.5) * perRow)) * perRow : 0.0;
        _metres.y.push_back(row > 0 ? _metres.y.back() + before : 0.0);
        double x = 0.5 * (scheme.west + scheme.east), latitude = y;
        int success = 0;
        if (toGeographic && !toGeographic->Transform(1, &x, &latitude, nullptr, &success)) latitude = 0.0;
        _latitudes.push_back(latitude);
    }
    _metres.wholeCircle =
        scheme.wholeCircle() && _size.firstColumn == 0 && _size.lastColumn == scheme.lastColumn;
}

double GroundPass::treeLine(int row) const
{
    if (_plan.options.treeLine) return *_plan.options.treeLine;
    return likelyTreeLine(_latitudes[static_cast<std::size_t>(row)]);
}

std::string GroundPass::stripFile(int strip) const
{
    return _plan.workFolder() + "/ground/strip" + std::to_string(_patch) + "-" + std::to_string(strip);
}

void GroundPass::writeStrip(RasterStack& rasters, int strip) const
{
    const int firstRow = strip * STRIP, rowCount = std::min(STRIP, _size.rows - firstRow);
    const TilingScheme& scheme = _plan.scheme;
    const double perColumn = this->perColumn(), perRow = this->perRow();
    const auto lattice = [&](int apron)
    {
        Lattice result = scheme.lattice(_size.firstColumn, _size.firstRow, perColumn,
                                        _size.columns + 2 * apron, rowCount + 2 * apron);
        result.dy = (scheme.north - scheme.south) * (perRow / scheme.lastRow);
        result.x0 -= apron * result.dx;
        result.y0 += (firstRow - apron) * result.dy;
        return result;
    };
    HeightGrid heights(_size.columns + 2, rowCount + 2);
    std::vector<unsigned char> filled;
    heights.values = rasters.heightsAboveSea(lattice(1), &filled);
    // A sample of the sea beside land may be off by the rounding of its place.
    for (float& height : heights.values)
        if (std::abs(height) < 1e-3f) height = 0.0f;
    const std::vector<unsigned char> classes = rasters.classes(lattice(0));

    Strip result(_columns, rowCount);
    for (int j = 0; j < rowCount; ++j)
    {
        const int row = firstRow + j;
        const double forest = treeLine(row), stepX = _metres.x[static_cast<std::size_t>(row)],
                     stepY = perRow * scheme.metresY(scheme.gridY(_size.firstRow + row * perRow));
        for (int i = 0; i < _size.columns; ++i)
        {
            const float here = heights.at(i + 1, j + 1);
            const auto rise = [&](float before, float after, double step)
            {
                if (std::isnan(before) || std::isnan(after)) return 0.0;
                return static_cast<double>(after - before) / (2.0 * step);
            };
            const std::size_t at = static_cast<std::size_t>(j) * _columns + static_cast<std::size_t>(i);
            if (filled[static_cast<std::size_t>(j + 1) * (_columns + 2) + static_cast<std::size_t>(i) + 1])
                result.kinds[at] |= FILLED;
            GroundCell cell;
            if (!std::isnan(here))
            {
                const double steepness =
                    std::hypot(rise(heights.at(i, j + 1), heights.at(i + 2, j + 1), stepX),
                               rise(heights.at(i + 1, j), heights.at(i + 1, j + 2), stepY));
                const glsl::geofx_Cover likely =
                    glsl::geofx_likelyCover(static_cast<double>(here), steepness, forest);
                cell.trees = byteOf(likely.trees);
                cell.bare = byteOf(likely.bare);
            }
            result.cells[at] = cell;
            result.heights[at] = here;
            const auto* kind = classes.empty() ? nullptr : _plan.classOf(classes[at]);
            if (kind) result.kinds[at] |= CLASSED;
            if (kind && kind->water) result.kinds[at] |= WATER;
        }
    }
    ByteWriter writer;
    writer.put(result.heights);
    writer.put(result.cells);
    writer.put(result.kinds);
    writeFileAtomically(stripFile(strip), writer.bytes().data(), writer.bytes().size());
}

Strip GroundPass::readStrip(int strip) const
{
    const std::size_t count =
        static_cast<std::size_t>(std::min(STRIP, _size.rows - strip * STRIP)) * _columns;
    Strip result(0, 0);
    ByteReader reader(stripFile(strip));
    result.heights = reader.getVector<float>();
    result.cells = reader.getVector<GroundCell>();
    result.kinds = reader.getVector<std::uint8_t>();
    if (!reader.good() || result.heights.size() != count || result.cells.size() != count ||
        result.kinds.size() != count)
        throw BuildError(stripFile(strip) + ": this work file is damaged; build again without --resume.");
    return result;
}

const Strip& GroundPass::stripOf(int row)
{
    if (_stripNumber != row / STRIP)
    {
        _strip = readStrip(row / STRIP);
        _stripNumber = row / STRIP;
    }
    return _strip;
}

/// Sets the masks, and finds out whether the water has depths.
void GroundPass::readKinds()
{
    for (auto* mask : {&_water, &_classed, &_lakes, &_filled})
        *mask = std::make_unique<CellMask>(_size.columns, _size.rows);
    float deepest = 0.0f; // in water, metres above the sea
    for (int row = 0; row < _size.rows; ++row)
    {
        const Strip& strip = stripOf(row);
        for (int i = 0; i < _size.columns; ++i)
        {
            const std::size_t at = place(row) + static_cast<std::size_t>(i);
            const std::uint8_t kind = strip.kinds[at];
            if (kind & WATER) _water->set(i, row);
            if (kind & CLASSED) _classed->set(i, row);
            if (kind & FILLED) _filled->set(i, row);
            _allClassed = _allClassed && (kind & CLASSED);
            if ((!(kind & CLASSED) || (kind & WATER)) && strip.heights[at] < deepest)
                deepest = strip.heights[at];
        }
    }
    _depths = deepest < -LEAST_DEPTH;
}

void GroundPass::findWater()
{
    std::vector<double> areas;
    for (std::size_t row = 0; row < _metres.y.size(); ++row)
    {
        const std::size_t south = row > 0 ? row - 1 : 0;
        areas.push_back(_metres.x[row] * (_metres.y[south + 1] - _metres.y[south]));
    }
    WaterFinder finder(_size.columns, std::move(areas), _plan.options.lakeArea);
    std::vector<float> heights(_columns);
    std::vector<bool> measured(_columns);
    const auto read = [&](int row)
    {
        std::copy_n(stripOf(row).heights.begin() + static_cast<std::ptrdiff_t>(place(row)), _columns,
                    heights.begin());
    };
    for (int row = 0; row < _size.rows; ++row)
    {
        read(row);
        for (int i = 0; i < _size.columns; ++i)
            measured[static_cast<std::size_t>(i)] = !_filled->at(i, row);
        finder.add(heights, measured);
    }
    for (int row = _size.rows - 1; row >= 0; --row)
    {
        read(row);
        const std::vector<GroundKind> found = finder.mark(heights);
        for (int i = 0; i < _size.columns; ++i)
        {
            const GroundKind ground = found[static_cast<std::size_t>(i)];
            if (ground != GroundKind::LAND && !_classed->at(i, row)) _water->set(i, row);
            if (ground == GroundKind::LAKE) _lakes->set(i, row);
        }
    }
}

void GroundPass::writeShores()
{
    readKinds();
    if (!_allClassed || _depths) findWater();
    const std::string result = GroundRaster::file(_plan, _patch);
    RowFile file(result, _columns * sizeof(GroundCell), RowFile::Mode::TEMPORARY);
    std::vector<GroundCell> cells(_columns);
    findShoreDistances(
        *_water, _metres, _plan.workFolder() + "/ground/rows",
        [&](int row, const std::vector<float>& distances)
        {
            const Strip& strip = stripOf(row);
            // Depths begin one cell away from the shore, so that the shore stays half-way between land and water.
            const double shallows = 1.5 * _metres.x[static_cast<std::size_t>(row)];
            for (int i = 0; i < _size.columns; ++i)
            {
                const auto c = static_cast<std::size_t>(i);
                cells[c] = strip.cells[place(row) + c];
                double distance = static_cast<double>(distances[c]);
                if (_water->at(i, row))
                {
                    cells[c].trees = cells[c].bare = 0;
                    const double fromDepth =
                        -static_cast<double>(strip.heights[place(row) + c]) / glsl::GEOFX_SHORE_SLOPE;
                    if (_depths && fromDepth > 0.0 && !_lakes->at(i, row))
                        distance = distance < shallows ? std::min(distance, fromDepth) : fromDepth;
                }
                cells[c].shore = shoreCode(distance);
            }
            file.write(row, cells.data());
        });
    file.finish(result);
}

/// Samples strips of rows of all patches.
class GroundStrips : public BuildStage
{
public:
    explicit GroundStrips(BuildPlan& plan)
        : BuildStage("ground", "ground"), _plan(plan), _rasters(static_cast<std::size_t>(plan.threads))
    {
        for (std::size_t patch = 0; patch < plan.groundPatches.size(); ++patch)
        {
            _passes.push_back(std::make_unique<GroundPass>(plan, patch));
            for (int strip = 0; strip < _passes.back()->strips(); ++strip)
                _units.emplace_back(patch, strip);
        }
    }
    std::size_t units() const override { return _units.size(); }
    void begin() override
    {
        if (!_plan.whole().any)
            throw BuildError(
                _plan.options.dems.front() +
                ": the elevation has no data at all; check its no-data value with gdalinfo -stats.");
        if (VoidRaster::isNeeded(_plan) && !_plan.voids) _plan.voids = std::make_shared<VoidRaster>(_plan);
    }
    bool takeOver(std::size_t unit) override
    {
        const auto& [patch, strip] = _units[unit];
        return std::filesystem::exists(GroundRaster::file(_plan, patch)) ||
               std::filesystem::exists(_passes[patch]->stripFile(strip));
    }
    void run(int worker, std::size_t unit) override
    {
        auto& stack = _rasters[static_cast<std::size_t>(worker)];
        if (!stack) stack = std::make_unique<RasterStack>(_plan);
        const auto& [patch, strip] = _units[unit];
        _passes[patch]->writeStrip(*stack, strip);
    }

private:
    BuildPlan& _plan;
    std::vector<std::unique_ptr<GroundPass>> _passes;
    std::vector<std::pair<std::size_t, int>> _units; ///< patch and strip
    std::vector<std::unique_ptr<RasterStack>> _rasters;
};

/// Finds water, and measures the distances from its shores. A unit is a patch.
class Shores : public BuildStage
{
public:
    explicit Shores(BuildPlan& plan) : BuildStage("shores", "ground"), _plan(plan) {}
    std::size_t units() const override { return _plan.groundPatches.size(); }
    /// Its masks are large.
    int threads(int) const override { return 1; }
    bool takeOver(std::size_t patch) override
    {
        return std::filesystem::exists(GroundRaster::file(_plan, patch));
    }
    void run(int, std::size_t patch) override { GroundPass(_plan, patch).writeShores(); }

private:
    BuildPlan& _plan;
};

} // namespace

double likelyTreeLine(double latitude)
{
    return 3800.0 * std::clamp((70.0 - std::abs(latitude)) / 45.0, 0.0, 1.0);
}

void addGroundStages(BuildPlan& plan, BuildStages& stages)
{
    stages.push_back(std::make_unique<GroundStrips>(plan));
    stages.push_back(std::make_unique<Shores>(plan));
}

} // namespace osgGeoFX
