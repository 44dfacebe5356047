// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/StrokeLines.h>

#include <osg/Math>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>
#include <tuple>

namespace osgGeoFX
{

namespace
{

const double metresPerDegree = 6371008.8 * osg::PI / 180.0;
constexpr int mostCells = 256;    ///< along a side of the index
constexpr int mostLevel = 40;     ///< no line has a longer step
constexpr std::size_t rows = 128; ///< of the box of towns

bool isPlace(const osg::Vec2d& point, StrokeLines::Units units)
{
    return std::isfinite(point.x()) && std::isfinite(point.y()) &&
           (units == StrokeLines::METRES || std::abs(point.y()) <= 90.0);
}

bool apart(const osg::Vec2d& low, const osg::Vec2d& high, const osg::Vec2d& otherLow,
           const osg::Vec2d& otherHigh)
{
    return low.x() > otherHigh.x() || low.y() > otherHigh.y() || high.x() < otherLow.x() ||
           high.y() < otherLow.y();
}

/// The largest level whose step is not longer than a line, and 0 for the shortest ones.
int levelOfLength(double steps)
{
    return steps < 2.0 ? 0 : std::min(std::ilogb(steps), mostLevel);
}

} // namespace

StrokeLines::StrokeLines(const StrokeLines& other, const osg::CopyOp& copy)
    : osg::Object(other, copy), _units(other._units), _lines(other._lines), _lengths(other._lengths),
      _lows(other._lows), _highs(other._highs), _low(other._low), _cell(other._cell), _side(other._side),
      _firsts(other._firsts), _segments(other._segments)
{
}

bool StrokeLines::set(Units units, std::vector<Line> lines)
{
    for (const Line& line : lines)
    {
        if (line.points.size() < 2) return false;
        for (const osg::Vec2d& point : line.points)
            if (!isPlace(point, units)) return false;
    }
    _units = units;
    _lines = std::move(lines);
    if (_units == DEGREES)
    {
        for (Line& line : _lines)
        {
            line.points[0].x() = std::remainder(line.points[0].x(), 360.0);
            for (std::size_t i = 1; i < line.points.size(); ++i)
            {
                const double former = line.points[i - 1].x();
                line.points[i].x() = former + std::remainder(line.points[i].x() - former, 360.0);
            }
        }
    }
    index();
    return true;
}

double StrokeLines::metres(const osg::Vec2d& from, const osg::Vec2d& to) const
{
    osg::Vec2d way = to - from;
    if (_units == DEGREES)
    {
        way *= metresPerDegree;
        way.x() *= std::cos(osg::DegreesToRadians(0.5 * (from.y() + to.y())));
    }
    return way.length();
}

void StrokeLines::index()
{
    _lengths.clear();
    _lows.clear();
    _highs.clear();
    _segments.clear();
    std::vector<Segment> segments;
    osg::Vec2d high(-DBL_MAX, -DBL_MAX);
    _low.set(DBL_MAX, DBL_MAX);
    const auto widen = [](osg::Vec2d& least, osg::Vec2d& most, const osg::Vec2d& point)
    {
        least.set(std::min(least.x(), point.x()), std::min(least.y(), point.y()));
        most.set(std::max(most.x(), point.x()), std::max(most.y(), point.y()));
    };
    for (std::size_t i = 0; i < _lines.size(); ++i)
    {
        const std::vector<osg::Vec2d>& points = _lines[i].points;
        std::vector<double> lengths{0.0};
        osg::Vec2d least = points[0], most = points[0];
        for (std::size_t j = 1; j < points.size(); ++j)
        {
            lengths.push_back(lengths.back() + metres(points[j - 1], points[j]));
            widen(least, most, points[j]);
            if (_lines[i].kind != TOWN)
                segments.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j - 1)});
        }
        _lengths.push_back(std::move(lengths));
        _lows.push_back(least);
        _highs.push_back(most);
        if (_lines[i].kind == TOWN) continue;
        widen(_low, high, least);
        widen(_low, high, most);
    }
    _side = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(segments.size()))), 1, mostCells);
    _cell = segments.empty() ? osg::Vec2d(1.0, 1.0) : (high - _low) / _side;
    // A line along a meridian has no width.
    _cell.set(std::max(_cell.x(), 1e-9), std::max(_cell.y(), 1e-9));

    const auto each = [&](const Segment& segment, const auto& work)
    {
        const osg::Vec2d* ends = &_lines[segment.line].points[segment.first];
        osg::Vec2d least = ends[0], most = ends[0];
        widen(least, most, ends[1]);
        const Cells touched = cells(least, most);
        for (int row = touched.below; row <= touched.above; ++row)
            for (int column = touched.left; column <= touched.right; ++column)
                work(static_cast<std::size_t>(row * _side + column));
    };
    _firsts.assign(static_cast<std::size_t>(_side * _side) + 1, 0);
    for (const Segment& segment : segments)
        each(segment, [&](std::size_t cell) { ++_firsts[cell + 1]; });
    std::partial_sum(_firsts.begin(), _firsts.end(), _firsts.begin());
    _segments.resize(_firsts.back());
    std::vector<std::uint32_t> next = _firsts;
    for (const Segment& segment : segments)
        each(segment, [&](std::size_t cell) { _segments[next[cell]++] = segment; });
}

StrokeLines::Cells StrokeLines::cells(const osg::Vec2d& low, const osg::Vec2d& high) const
{
    const auto cell = [&](double at, int axis)
    {
        const double place = std::floor((at - _low[axis]) / _cell[axis]);
        return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(_side - 1)));
    };
    return {cell(low.x(), 0), cell(high.x(), 0), cell(low.y(), 1), cell(high.y(), 1)};
}

std::vector<StrokeLines::Mark> StrokeLines::marks(const osg::Vec2d& low, const osg::Vec2d& high, double step,
                                                  int level) const
{
    std::vector<Segment> touched;
    if (!_segments.empty())
    {
        const Cells box = cells(low, high);
        for (int row = box.below; row <= box.above; ++row)
        {
            for (int column = box.left; column <= box.right; ++column)
            {
                const auto cell = static_cast<std::size_t>(row * _side + column);
                for (std::uint32_t i = _firsts[cell]; i < _firsts[cell + 1]; ++i)
                    touched.push_back(_segments[i]);
            }
        }
    }
    const auto order = [](const Segment& s)
    {
        return std::make_tuple(s.line, s.first);
    };
    std::sort(touched.begin(), touched.end(),
              [&](const Segment& a, const Segment& b) { return order(a) < order(b); });
    touched.erase(std::unique(touched.begin(), touched.end(),
                              [&](const Segment& a, const Segment& b) { return order(a) == order(b); }),
                  touched.end());

    std::vector<Mark> marks;
    const std::int64_t stride = std::int64_t{1} << std::clamp(level, 0, mostLevel);
    for (const Segment& segment : touched)
    {
        const std::vector<osg::Vec2d>& points = _lines[segment.line].points;
        const osg::Vec2d from = points[segment.first], way = points[segment.first + 1] - from;
        if (apart(low, high, _lows[segment.line], _highs[segment.line])) continue;
        const double begin = _lengths[segment.line][segment.first] / step;
        const double end = _lengths[segment.line][segment.first + 1] / step;
        // Both ends are there for as long as the line is longer than a step.
        const int most = levelOfLength(_lengths[segment.line].back() / step);
        const auto put = [&](double at, std::int64_t index, int itsLevel)
        {
            const osg::Vec2d place = from + way * (end > begin ? (at - begin) / (end - begin) : 0.0);
            if (itsLevel >= level && !apart(low, high, place, place))
                marks.push_back({place, way, index, itsLevel, segment.line});
        };
        const auto first = static_cast<std::int64_t>(std::ceil(begin / static_cast<double>(stride))) * stride;
        for (std::int64_t k = first; static_cast<double>(k) < end; k += stride)
        {
            int its = 0;
            while (its < most && (k >> its & 1) == 0)
                ++its;
            put(static_cast<double>(k), k, its);
        }
        if (segment.first + 2 == points.size()) put(end, -1, most);
    }
    return marks;
}

StrokeLines::Towns::Towns(const StrokeLines& lines, const osg::Vec2d& low, const osg::Vec2d& high)
    : _south(low.y()), _rowHeight(std::max((high.y() - low.y()) / static_cast<double>(rows), 1e-12))
{
    for (std::size_t i = 0; i < lines._lines.size(); ++i)
    {
        if (lines._lines[i].kind != TOWN || apart(low, high, lines._lows[i], lines._highs[i])) continue;
        _rows.resize(rows);
        const std::vector<osg::Vec2d>& points = lines._lines[i].points;
        for (std::size_t j = 0; j < points.size(); ++j)
        {
            const Edge edge{static_cast<std::uint32_t>(i), points[j], points[(j + 1) % points.size()]};
            const double least = std::min(edge.from.y(), edge.to.y());
            const double most = std::max(edge.from.y(), edge.to.y());
            if (most < low.y() || least > high.y()) continue;
            for (std::size_t row = rowOf(least); row <= rowOf(most); ++row)
                _rows[row].push_back(edge);
        }
    }
}

std::size_t StrokeLines::Towns::rowOf(double y) const
{
    return static_cast<std::size_t>(
        std::clamp(std::floor((y - _south) / _rowHeight), 0.0, static_cast<double>(rows - 1)));
}

bool StrokeLines::Towns::contain(const osg::Vec2d& place) const
{
    if (_rows.empty()) return false;
    bool within = false;
    std::uint32_t town = 0;
    for (const Edge& edge : _rows[rowOf(place.y())])
    {
        if (edge.town != town && within) return true;
        town = edge.town;
        if ((edge.from.y() > place.y()) == (edge.to.y() > place.y())) continue;
        const double t = (place.y() - edge.from.y()) / (edge.to.y() - edge.from.y());
        if (edge.from.x() + t * (edge.to.x() - edge.from.x()) > place.x()) within = !within;
    }
    return within;
}

} // namespace osgGeoFX
