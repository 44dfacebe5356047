// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/detail/SeriesGraph.h>

#include <osgGeoFX/effect/ClockTime.h>
#include <osgGeoFX/mapping/ValueLegend.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

const osg::Vec4 valueColor(1.0f, 0.83f, 0.45f, 1.0f);
const osg::Vec4 channelColors[3] = {
    {1.0f, 0.40f, 0.36f, 1.0f}, {0.45f, 0.85f, 0.45f, 1.0f}, {0.45f, 0.65f, 1.0f, 1.0f}};
constexpr double day = 86400.0;

/// What a tick of a date says: the hour, or at midnight the day; the year, where the axis is longer than one.
std::string dateText(double time, double step, double length)
{
    const std::string text = textOf(ClockTime{time, 0}); // 2026-01-12T06:00:00Z
    const bool midnight = std::fmod(time, day) == 0.0;
    constexpr double year = 366.0 * day;
    if (step >= day && length > year) return text.substr(0, 10);
    if (step >= day || midnight) return text.substr(5, 5);
    return text.substr(11, step < 60.0 ? 8 : 5);
}

} // namespace

SeriesGraph::SeriesGraph(double width, double height, const std::vector<LayerSeries::Point>& points,
                         const LayerClock& clock, bool classes)
    : _points(points), _classes(classes)
{
    text = overlayTextSize(height);
    line = std::round(1.5 * text);
    margin = std::round(0.8 * text);
    panel.left = margin;
    panel.bottom = std::round(6.5 * text);
    panel.width =
        std::clamp(std::round(0.42 * width), 20.0 * text, std::max(20.0 * text, width - 2.0 * margin));
    panel.height = std::round(16.0 * text);
    const double labels = std::round(5.5 * text);
    graph = {panel.left + labels, panel.bottom + 1.6 * line, panel.width - labels - 2.0 * margin,
             panel.height - 4.1 * line};
    close = {panel.right() - margin - 1.4 * text, panel.top() - margin - 1.4 * text, 1.4 * text, 1.4 * text};
    save = {close.left - 4.5 * text, close.bottom, 4.0 * text, close.height};

    if (!_points.empty())
    {
        begin = _points.front().time;
        end = _points.back().time;
    }
    if (!(begin < end)) end = begin + 1.0;
    findTicks(clock);
    makeCurves();
}

osg::Vec2d SeriesGraph::placeOf(double time, double value) const
{
    return {graph.left + graph.width * (time - begin) / (end - begin),
            graph.bottom + graph.height * (value - low) / (high - low)};
}

double SeriesGraph::timeAt(double x) const
{
    return begin + std::clamp((x - graph.left) / graph.width, 0.0, 1.0) * (end - begin);
}

std::optional<double> SeriesGraph::valueAt(double time) const
{
    const auto after = std::find_if(_points.begin(), _points.end(),
                                    [&](const LayerSeries::Point& point) { return point.time > time; });
    if (after == _points.begin()) return std::nullopt;
    const LayerSeries::Point& before = *std::prev(after);
    if (after == _points.end()) return before.value;
    const double share = (time - before.time) / (after->time - before.time);
    // As LayerSequence: where one of both has no data, the nearer one counts, and classes are never mixed.
    if (_classes || !before.value || !after->value) return share < 0.5 ? before.value : after->value;
    return *before.value + share * (*after->value - *before.value);
}

std::vector<double> SeriesGraph::roundTimes(double from, double to, int most)
{
    constexpr double minute = 60.0, hour = 3600.0;
    static constexpr double steps[] = {
        15.0,          30.0, minute,     2.0 * minute, 5.0 * minute, 10.0 * minute, 15.0 * minute,
        30.0 * minute, hour, 2.0 * hour, 3.0 * hour,   6.0 * hour,   12.0 * hour,   day};
    const auto count = [&](double step)
    {
        return std::floor(to / step) - std::ceil(from / step) + 1.0;
    };
    const auto* const step =
        std::find_if(std::begin(steps), std::end(steps), [&](double each) { return count(each) <= most; });
    // Finer than these and coarser than a day it goes by tens.
    if (step == std::begin(steps)) return roundTicks(from, to, most);
    std::vector<double> result;
    if (step == std::end(steps))
    {
        result = roundTicks(from / day, to / day, most);
        for (double& each : result)
            each *= day;
        return result;
    }
    for (double each = std::ceil(from / *step) * *step; each <= to; each += *step)
        result.push_back(each);
    return result;
}

void SeriesGraph::findTicks(const LayerClock& clock)
{
    bool any = false;
    bool colors = false;
    for (const LayerSeries::Point& point : _points)
    {
        colors = colors || point.color.has_value();
        if (!point.value) continue;
        low = any ? std::min(low, *point.value) : *point.value;
        high = any ? std::max(high, *point.value) : *point.value;
        any = true;
    }
    if (colors && !any) high = 255.0;
    // What never changes is a line in the middle.
    if (!(low < high))
    {
        const double about = std::max(1.0, 0.1 * std::abs(low));
        low -= about;
        high += about;
    }
    const double room = 0.05 * (high - low);
    low -= any ? room : 0.0;
    high += any ? room : 0.0;

    const int lines = std::max(2, static_cast<int>(graph.height / (1.6 * text)));
    const std::vector<double> numbers = roundTicks(low, high, lines);
    for (const double number : numbers)
        values.push_back({number, tickText(number, numbers.size() > 1 ? numbers[1] - numbers[0] : 1.0)});

    const int most = std::max(2, static_cast<int>(graph.width / (5.5 * text)));
    const std::vector<double> moments = roundTimes(begin, end, most);
    const double step = moments.size() > 1 ? moments[1] - moments[0] : day;
    for (const double moment : moments)
        times.push_back(
            {moment, clock.getDated() ? dateText(moment, step, end - begin) : clock.text(moment)});
}

void SeriesGraph::makeCurves()
{
    const auto add = [&](const osg::Vec4& color, const auto& valueOf)
    {
        Curve curve{color, {}};
        bool gap = true;
        for (const LayerSeries::Point& point : _points)
        {
            const std::optional<double> value = valueOf(point);
            if (value)
            {
                if (gap) curve.lines.emplace_back();
                std::vector<osg::Vec2d>& piece = curve.lines.back();
                const osg::Vec2d place = placeOf(point.time, *value);
                // Classes change in the middle between steps.
                if (_classes && !piece.empty())
                {
                    const double middle = 0.5 * (piece.back().x() + place.x());
                    piece.emplace_back(middle, piece.back().y());
                    piece.emplace_back(middle, place.y());
                }
                piece.push_back(place);
            }
            gap = !value;
        }
        if (!curve.lines.empty()) curves.push_back(std::move(curve));
    };
    add(valueColor, [](const LayerSeries::Point& point) { return point.value; });
    for (unsigned int channel = 0; channel < 3; ++channel)
        add(channelColors[channel],
            [&](const LayerSeries::Point& point) -> std::optional<double>
            {
                if (!point.color) return std::nullopt;
                return 255.0 * (*point.color)[channel];
            });
}

} // namespace osgGeoFX
