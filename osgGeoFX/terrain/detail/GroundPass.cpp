// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/GroundRaster.h>
#include <osgGeoFX/terrain/detail/ShoreDistance.h>
#include <osgGeoFX/terrain/detail/WaterFinder.h>
#include <osgGeoFX/terrain/detail/WorkQueue.h>

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

class GroundPass
{
public:
    GroundPass(BuildPlan& plan, std::size_t patch);
    void run();

private:
    void sampleStrip(RasterStack& rasters, int firstRow, int rowCount);
    void findWater();
    void writeShores();
    double treeLine(int row) const;
    /// Finest posts from point to point.
    double perColumn() const
    {
        return static_cast<double>(_size.lastColumn - _size.firstColumn) / (_size.columns - 1);
    }
    double perRow() const { return static_cast<double>(_size.lastRow - _size.firstRow) / (_size.rows - 1); }

    BuildPlan& _plan;
    const std::size_t _patch;
    const GroundPatch _size;
    const std::size_t _columns;
    CellMetres _metres;
    std::vector<double> _latitudes; ///< by row, degrees
    CellMask _water, _classed;      ///< by land cover; other cells go by their heights
    CellMask _lakes, _filled;
    RowFile _heights, _cells;
    std::vector<float> _deepest; ///< by strip, in water; metres above the sea
    bool _allClassed = true, _depths = false;
};

std::string workFile(const BuildPlan& plan, const char* name)
{
    return plan.workFolder() + "/ground/" + name;
}

GroundPass::GroundPass(BuildPlan& plan, std::size_t patch)
    : _plan(plan), _patch(patch), _size(plan.groundPatches[patch]),
      _columns(static_cast<std::size_t>(_size.columns)), _water(_size.columns, _size.rows),
      _classed(_size.columns, _size.rows), _lakes(_size.columns, _size.rows),
      _filled(_size.columns, _size.rows),
      _heights(workFile(plan, "heights"), _columns * sizeof(float), RowFile::Mode::CREATE),
      _cells(workFile(plan, "cells"), _columns * sizeof(GroundCell), RowFile::Mode::CREATE)
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

/// Samples heights, classes, and what is likely to grow there.
void GroundPass::sampleStrip(RasterStack& rasters, int firstRow, int rowCount)
{
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

    std::vector<GroundCell> cells(_columns);
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
            if (filled[static_cast<std::size_t>(j + 1) * (_columns + 2) + static_cast<std::size_t>(i) + 1])
                _filled.set(i, row);
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
            cells[static_cast<std::size_t>(i)] = cell;
            const auto* kind =
                classes.empty()
                    ? nullptr
                    : _plan.classOf(
                          classes[static_cast<std::size_t>(j) * _columns + static_cast<std::size_t>(i)]);
            if (kind) _classed.set(i, row);
            if (kind && kind->water) _water.set(i, row);
            float& deepest = _deepest[static_cast<std::size_t>(firstRow / STRIP)];
            if ((!kind || kind->water) && here < deepest) deepest = here;
        }
        _cells.write(row, cells.data());
        _heights.write(row, &heights.at(1, j + 1));
    }
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
    for (int row = 0; row < _size.rows; ++row)
    {
        _heights.read(row, heights.data());
        for (int i = 0; i < _size.columns; ++i)
            measured[static_cast<std::size_t>(i)] = !_filled.at(i, row);
        finder.add(heights, measured);
    }
    for (int row = _size.rows - 1; row >= 0; --row)
    {
        _heights.read(row, heights.data());
        const std::vector<GroundKind> found = finder.mark(heights);
        for (int i = 0; i < _size.columns; ++i)
        {
            const GroundKind ground = found[static_cast<std::size_t>(i)];
            if (ground != GroundKind::LAND && !_classed.at(i, row)) _water.set(i, row);
            if (ground == GroundKind::LAKE) _lakes.set(i, row);
        }
    }
}

void GroundPass::writeShores()
{
    std::vector<float> heights(_columns);
    std::vector<GroundCell> cells(_columns);
    findShoreDistances(_water, _metres, workFile(_plan, "rows"),
                       [&](int row, const std::vector<float>& distances)
                       {
                           _cells.read(row, cells.data());
                           _heights.read(row, heights.data());
                           // Depths begin one cell away from the shore, so that the shore stays half-way between land
                           // and water.
                           const double shallows = 1.5 * _metres.x[static_cast<std::size_t>(row)];
                           for (int i = 0; i < _size.columns; ++i)
                           {
                               const auto c = static_cast<std::size_t>(i);
                               double distance = static_cast<double>(distances[c]);
                               if (_water.at(i, row))
                               {
                                   cells[c].trees = cells[c].bare = 0;
                                   const double fromDepth =
                                       -static_cast<double>(heights[c]) / glsl::GEOFX_SHORE_SLOPE;
                                   if (_depths && fromDepth > 0.0 && !_lakes.at(i, row))
                                       distance =
                                           distance < shallows ? std::min(distance, fromDepth) : fromDepth;
                               }
                               cells[c].shore = shoreCode(distance);
                           }
                           _cells.write(row, cells.data());
                       });
}

void GroundPass::run()
{
    const int strips = (_size.rows + STRIP - 1) / STRIP;
    _deepest.assign(static_cast<std::size_t>(strips), 0.0f);
    std::vector<std::unique_ptr<RasterStack>> rasters(static_cast<std::size_t>(_plan.threads));
    runOnWorkers(_plan.threads, static_cast<std::size_t>(strips),
                 [&](int worker, std::size_t strip)
                 {
                     auto& stack = rasters[static_cast<std::size_t>(worker)];
                     if (!stack) stack = std::make_unique<RasterStack>(_plan);
                     const int first = static_cast<int>(strip) * STRIP;
                     sampleStrip(*stack, first, std::min(STRIP, _size.rows - first));
                     _plan.advance("ground");
                 });
    _depths = *std::min_element(_deepest.begin(), _deepest.end()) < -LEAST_DEPTH;
    for (int row = 0; row < _size.rows && _allClassed; ++row)
        for (int i = 0; i < _size.columns; ++i)
            _allClassed = _allClassed && _classed.at(i, row);
    if (!_allClassed || _depths) findWater();
    writeShores();
    _cells.finish(GroundRaster::file(_plan, _patch));
    _plan.advance("ground");
}

} // namespace

double likelyTreeLine(double latitude)
{
    return 3800.0 * std::clamp((70.0 - std::abs(latitude)) / 45.0, 0.0, 1.0);
}

int GroundRaster::steps(const BuildPlan& plan)
{
    int count = 0;
    for (const GroundPatch& patch : plan.groundPatches)
        count += (patch.rows + STRIP - 1) / STRIP + 1;
    return count;
}

void runGroundPass(BuildPlan& plan)
{
    for (std::size_t patch = 0; patch < plan.groundPatches.size(); ++patch)
        if (plan.options.resume && std::filesystem::exists(GroundRaster::file(plan, patch)))
            for (int step = (plan.groundPatches[patch].rows + STRIP - 1) / STRIP + 1; step > 0; --step)
                plan.advance("ground");
        else
            GroundPass(plan, patch).run();
    plan.ground = std::make_shared<GroundRaster>(plan);
}

} // namespace osgGeoFX
