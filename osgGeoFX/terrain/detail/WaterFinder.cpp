// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/WaterFinder.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr std::int64_t LAKE_CELLS = 32;
constexpr float LOW_RIM = 1.0f; // metres
constexpr int NO_LABEL = -1;

/// Whether two cells side by side belong to one area. Samples of level ground differ by the rounding of floats.
bool together(float a, float b)
{
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    if (a <= 0.0f || b <= 0.0f) return a <= 0.0f && b <= 0.0f;
    return std::abs(a - b) <= 4e-7f * std::max(a, b);
}

} // namespace

WaterFinder::WaterFinder(int columns, std::vector<double> cellArea, double lakeArea)
    : _columns(columns), _cellArea(std::move(cellArea)), _lakeArea(lakeArea)
{
}

int WaterFinder::root(int label)
{
    while (_parents[static_cast<std::size_t>(label)] != label)
        label = _parents[static_cast<std::size_t>(label)] =
            _parents[static_cast<std::size_t>(_parents[static_cast<std::size_t>(label)])];
    return label;
}

int WaterFinder::newLabel(float height, int row)
{
    if (_free.empty())
    {
        _free.push_back(static_cast<int>(_parents.size()));
        _parents.push_back(0);
        _areas.emplace_back();
    }
    const int label = _free.back();
    _free.pop_back();
    _parents[static_cast<std::size_t>(label)] = label;
    Area& area = _areas[static_cast<std::size_t>(label)];
    area.cells = area.zeros = area.rim = area.lowerRim = area.lowRim = 0;
    area.squareMetres = 0.0;
    area.height = height;
    area.lastRow = row;
    area.open = false;
    area.labels.assign(1, label);
    area.ends.clear();
    return label;
}

/// Joins the areas of two cells; `a` is the one in the newer row. Most cells are alone, and need no label.
void WaterFinder::join(int& a, int& b, float height, int row)
{
    if (b == NO_LABEL) b = a == NO_LABEL ? newLabel(height, row) : a;
    if (a == NO_LABEL) a = b;
    int keep = root(a), drop = root(b);
    if (keep != drop)
    {
        const auto size = [this](int label)
        {
            const Area& area = _areas[static_cast<std::size_t>(label)];
            return area.labels.size() + area.ends.size();
        };
        if (size(keep) < size(drop)) std::swap(keep, drop);
        Area &area = _areas[static_cast<std::size_t>(keep)], &other = _areas[static_cast<std::size_t>(drop)];
        _parents[static_cast<std::size_t>(drop)] = keep;
        area.cells += other.cells;
        area.zeros += other.zeros;
        area.rim += other.rim;
        area.lowerRim += other.lowerRim;
        area.lowRim += other.lowRim;
        area.squareMetres += other.squareMetres;
        area.open = area.open || other.open;
        area.labels.insert(area.labels.end(), other.labels.begin(), other.labels.end());
        area.ends.insert(area.ends.end(), other.ends.begin(), other.ends.end());
    }
    _areas[static_cast<std::size_t>(keep)].lastRow = row;
}

void WaterFinder::add(const std::vector<float>& heights)
{
    add(heights, std::vector<bool>(heights.size(), true));
}

void WaterFinder::add(const std::vector<float>& heights, const std::vector<bool>& measured)
{
    _ahead = heights;
    _aheadMeasured = measured;
    _aheadLabels.assign(static_cast<std::size_t>(_columns), NO_LABEL);
    for (std::size_t c = 0; c < _ahead.size(); ++c)
    {
        if (c > 0 && together(_ahead[c - 1], _ahead[c]))
            join(_aheadLabels[c], _aheadLabels[c - 1], _ahead[c], _rows);
        if (_rows > 0 && together(_here[c], _ahead[c]))
            join(_aheadLabels[c], _hereLabels[c], _ahead[c], _rows);
    }
    if (_rows > 0) count(_rows - 1);
    ++_rows;
    _behind = std::move(_here);
    _here = std::move(_ahead);
    _hereMeasured.swap(_aheadMeasured);
    _hereLabels.swap(_aheadLabels);
    if (static_cast<std::size_t>(_rows) < _cellArea.size()) return;
    _ahead.clear();
    count(_rows - 1);
}

/// Counts the cells of a row and the cells around them. Both rows beside it are known now.
void WaterFinder::count(int row)
{
    const std::size_t columns = _here.size();
    for (std::size_t begin = 0, end = 1; begin < columns; begin = end, ++end)
    {
        while (end < columns && together(_here[end - 1], _here[end]))
            ++end;
        if (_hereLabels[begin] == NO_LABEL) continue;
        Area& area = _areas[static_cast<std::size_t>(root(_hereLabels[begin]))];
        bool goesOn = false;
        const auto look = [&](float here, float there)
        {
            if (together(here, there)) return true;
            if (std::isnan(there)) area.open = true;
            if (std::isnan(there)) return false;
            ++area.rim;
            area.lowerRim += there < here ? 1 : 0;
            area.lowRim += there <= LOW_RIM ? 1 : 0;
            return false;
        };
        for (std::size_t c = begin; c < end; ++c)
        {
            if (_hereMeasured[c])
            {
                ++area.cells;
                area.zeros += _here[c] == 0.0f ? 1 : 0;
                area.squareMetres += _cellArea[static_cast<std::size_t>(row)];
            }
            if (!_behind.empty()) look(_here[c], _behind[c]);
            if (!_ahead.empty()) goesOn = look(_here[c], _ahead[c]) || goesOn;
        }
        if (begin > 0) look(_here[begin], _here[begin - 1]);
        if (end < columns) look(_here[end - 1], _here[end]);
        area.open = area.open || begin == 0 || end == columns || _behind.empty() || _ahead.empty();
        if (!goesOn) area.ends.push_back({row, static_cast<int>(begin), GroundKind::LAND});
    }
    for (const int label : _hereLabels)
        if (label != NO_LABEL && _areas[static_cast<std::size_t>(root(label))].lastRow == row)
            decide(root(label));
}

/// Decides about an area that does not go on. If it is water, its ends are kept. Its labels become free.
void WaterFinder::decide(int label)
{
    Area& area = _areas[static_cast<std::size_t>(label)];
    const GroundKind ground = groundOf(area);
    if (ground != GroundKind::LAND)
        for (const End& end : area.ends)
            _ends.push_back({end.row, end.column, ground});
    area.lastRow = -1;
    _free.insert(_free.end(), area.labels.begin(), area.labels.end());
}

GroundKind WaterFinder::groundOf(const Area& area) const
{
    if (std::isnan(area.height))
        return 3 * area.lowRim >= std::max<std::int64_t>(area.rim, 1) ? GroundKind::SEA : GroundKind::LAND;
    if (area.cells == 0) return GroundKind::LAND;
    const bool large = area.squareMetres >= _lakeArea && area.cells >= LAKE_CELLS;
    if (area.height <= 0.0f)
        return area.open || (large && 2 * area.zeros >= area.cells) ? GroundKind::SEA : GroundKind::LAND;
    return large && area.rim > 0 && 5 * area.lowerRim <= area.rim ? GroundKind::LAKE : GroundKind::LAND;
}

std::vector<GroundKind> WaterFinder::mark(const std::vector<float>& heights)
{
    if (!_sorted)
        std::sort(_ends.begin(), _ends.end(),
                  [](const End& a, const End& b)
                  { return std::pair(a.row, -a.column) < std::pair(b.row, -b.column); });
    _sorted = true;
    --_rows;
    std::vector<GroundKind> result(heights.size(), GroundKind::LAND);
    for (std::size_t begin = 0, end = 1; begin < heights.size(); begin = end, ++end)
    {
        while (end < heights.size() && together(heights[end - 1], heights[end]))
            ++end;
        GroundKind ground = GroundKind::LAND;
        if (!_ends.empty() && _ends.back().row == _rows && _ends.back().column == static_cast<int>(begin))
        {
            ground = _ends.back().ground;
            _ends.pop_back();
        }
        for (std::size_t c = begin; c < end && ground == GroundKind::LAND && !_marked.empty(); ++c)
            if (together(heights[c], _markedHeights[c])) ground = _marked[c];
        std::fill(result.begin() + static_cast<std::ptrdiff_t>(begin),
                  result.begin() + static_cast<std::ptrdiff_t>(end), ground);
    }
    _markedHeights = heights;
    _marked = result;
    return result;
}

} // namespace osgGeoFX
