// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/detail/CurveGraph.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Steps of the curve that is drawn.
constexpr int steps = 96;
/// Points keep this distance from each other, from the base and from the horizon, so that hands can part them.
constexpr double apart = 0.01;
constexpr double leastHeight = 0.01;
constexpr double mostExaggeration = 20.0;

// In heights of the text.
constexpr double widthOfAll = 32.0;
constexpr double heightOfGraph = 13.0;
constexpr double scaleLeft = 10.5, scaleRight = 23.5;
/// Title, what is held, the names of the axis, two exaggerations, two lines of help with a gap.
constexpr double otherLines = 7.3;

} // namespace

CurveState CurveState::of(const PanoramaMap& map)
{
    CurveState state;
    state.points = map.getCurvePoints();
    state.horizonLine = map.getHorizonLine();
    state.exaggeration = map.getExaggeration();
    state.horizonExaggeration = map.getHorizonExaggeration();
    for (int step = 0; step <= steps; ++step)
        state.heights.push_back(map.curveHeight(static_cast<double>(step) / steps));
    return state;
}

bool CurveState::operator==(const CurveState& other) const
{
    return points == other.points && horizonLine == other.horizonLine && exaggeration == other.exaggeration &&
           horizonExaggeration == other.horizonExaggeration && heights == other.heights;
}

double CurveState::heightAt(double distance) const
{
    if (heights.size() < 2) return 0.0;
    const double place = std::clamp(distance, 0.0, 1.0) * static_cast<double>(heights.size() - 1);
    const std::size_t before = std::min(static_cast<std::size_t>(place), heights.size() - 2);
    return heights[before] + (place - static_cast<double>(before)) * (heights[before + 1] - heights[before]);
}

CurveGraph::CurveGraph(double width, double height)
{
    text = std::round(std::clamp(std::min(height / 52.0, width / 64.0), 8.0, 48.0));
    line = std::round(text * 1.5);
    margin = std::round(text * 0.7);
    panel.width = std::round(widthOfAll * text) + 2.0 * margin;
    panel.height = std::round(heightOfGraph * text + otherLines * line) + 2.0 * margin;
    panel.left = width - panel.width - margin;
    panel.bottom = margin;
    graph.left = panel.left + margin + text;
    graph.width = panel.width - 2.0 * (margin + text);
    graph.height = std::round(heightOfGraph * text);
    graph.bottom = panel.bottom + panel.height - margin - 2.0 * line - graph.height;
    const auto scale = [&](int number)
    {
        return Box{panel.left + margin + scaleLeft * text, lineBottom(number),
                   (scaleRight - scaleLeft) * text, line};
    };
    nearScale = scale(3);
    farScale = scale(4);
    reset = Box{panel.left + panel.width - margin - 5.0 * text, panel.bottom + margin, 5.0 * text, line};
}

double CurveGraph::lineBottom(int number) const
{
    const double top = panel.bottom + panel.height - margin;
    if (number < 2) return top - (number + 1) * line;
    return graph.bottom - (number - 1) * line;
}

osg::Vec2d CurveGraph::placeOf(double distance, double height) const
{
    return {graph.left + distance * graph.width, graph.bottom + height * graph.height};
}

// Small factors have more room than large ones.
osg::Vec2d CurveGraph::placeOf(const Box& scale, double exaggeration) const
{
    const double share = std::sqrt(std::clamp(exaggeration / mostExaggeration, 0.0, 1.0));
    return {scale.left + share * scale.width, scale.bottom + 0.5 * scale.height};
}

double CurveGraph::exaggerationAt(const Box& scale, const osg::Vec2d& place) const
{
    const double share = std::clamp((place.x() - scale.left) / scale.width, 0.0, 1.0);
    return std::round(mostExaggeration * share * share * 100.0) / 100.0;
}

std::optional<CurveGraph::Handle> CurveGraph::handleAt(const osg::Vec2d& place, const CurveState& state) const
{
    double nearest = reach();
    std::optional<Handle> found;
    for (std::size_t i = 0; i < state.points.size(); ++i)
    {
        const osg::Vec2d at = placeOf(state.points[i].x(), state.points[i].y() * state.horizonLine);
        const double away = (place - at).length();
        if (away > nearest) continue;
        nearest = away;
        found = Handle{Handle::POINT, i};
    }
    if (found) return found;
    const auto onScale = [&](const Box& scale)
    {
        Box wider = scale;
        wider.left -= reach();
        wider.width += 2.0 * reach();
        return wider.has(place);
    };
    if (onScale(nearScale)) return Handle{Handle::NEAR_SCALE};
    if (onScale(farScale)) return Handle{Handle::FAR_SCALE};
    if (reset.has(place)) return Handle{Handle::RESET};
    // The way to a steep curve is shorter than that up or down to it.
    const int pieces = 2 * steps;
    for (int i = 0; i <= pieces; ++i)
    {
        const double distance = static_cast<double>(i) / pieces;
        const osg::Vec2d at = placeOf(distance, state.heightAt(distance) * state.horizonLine);
        if ((place - at).length() <= reach()) return Handle{Handle::CURVE};
    }
    return std::nullopt;
}

std::optional<std::size_t> CurveGraph::insert(const osg::Vec2d& place, CurveState& state) const
{
    if (state.points.size() >= PanoramaMap::mostCurvePoints) return std::nullopt;
    const double distance = (place.x() - graph.left) / graph.width;
    std::size_t index = 0;
    while (index < state.points.size() && state.points[index].x() < distance)
        ++index;
    const double before = index > 0 ? state.points[index - 1].x() : 0.0;
    const double after = index < state.points.size() ? state.points[index].x() : 1.0;
    if (distance < before + apart || distance > after - apart) return std::nullopt;
    state.points.insert(state.points.begin() + static_cast<std::ptrdiff_t>(index),
                        osg::Vec2d(distance, std::clamp(state.heightAt(distance), leastHeight, 1.0)));
    return index;
}

void CurveGraph::drag(const Handle& handle, const osg::Vec2d& place, CurveState& state) const
{
    if (handle.kind == Handle::NEAR_SCALE) state.exaggeration = exaggerationAt(nearScale, place);
    if (handle.kind == Handle::FAR_SCALE) state.horizonExaggeration = exaggerationAt(farScale, place);
    if (handle.kind != Handle::POINT || handle.point >= state.points.size()) return;
    const bool first = handle.point == 0, last = handle.point + 1 == state.points.size();
    const osg::Vec2d before = first ? osg::Vec2d() : state.points[handle.point - 1];
    const osg::Vec2d after = last ? osg::Vec2d(1.0, 1.0) : state.points[handle.point + 1];
    const double distance = (place.x() - graph.left) / graph.width;
    const double height = (place.y() - graph.bottom) / graph.height / state.horizonLine;
    // Points that a program has set may be nearer to each other than hands set them.
    const auto between = [](double value, double low, double high)
    {
        return low < high ? std::clamp(value, low, high) : 0.5 * (low + high);
    };
    state.points[handle.point].set(between(distance, before.x() + apart, after.x() - apart),
                                   between(height, std::max(before.y(), leastHeight), after.y()));
}

bool CurveGraph::remove(const Handle& handle, CurveState& state)
{
    if (handle.kind == Handle::FAR_SCALE && state.horizonExaggeration >= 0.0)
    {
        state.horizonExaggeration = -1.0;
        return true;
    }
    if (handle.kind != Handle::POINT || handle.point >= state.points.size()) return false;
    state.points.erase(state.points.begin() + static_cast<std::ptrdiff_t>(handle.point));
    return true;
}

} // namespace osgGeoFX
