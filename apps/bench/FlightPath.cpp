// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "FlightPath.h"

#include "BenchError.h"

#include <osgGeoFX/viewer/ViewPoint.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace geofx::bench
{

namespace
{

// Off Waianae, towards the south-east.
constexpr double START_EAST = -158.24, START_NORTH = 21.46;
constexpr double METRES_PER_DEGREE = 111320.0;
/// Of the curves: radians from the mean heading, seconds from one to the next.
constexpr double MEAN_HEADING = 1.75, CURVE = 0.5, PERIOD = 40.0;
constexpr double PITCH = -0.17;
/// The ground is taken as even over so many seconds of flight, as a pilot would.
constexpr double SMOOTH = 5.0;

double headingAt(double seconds)
{
    return MEAN_HEADING + CURVE * std::sin(2.0 * osg::PI * seconds / PERIOD);
}

} // namespace

FlightPath::Pose FlightPath::at(double seconds) const
{
    // The way is added up in fixed steps, so that every frame of every run finds the same.
    constexpr double step = 0.05;
    osg::Vec2d place(START_EAST, START_NORTH);
    const auto add = [&](double from, double duration)
    {
        const double heading = headingAt(from + 0.5 * duration), way = SPEED * duration;
        place.x() +=
            way * std::sin(heading) / (METRES_PER_DEGREE * std::cos(osg::DegreesToRadians(START_NORTH)));
        place.y() += way * std::cos(heading) / METRES_PER_DEGREE;
    };
    const int whole = static_cast<int>(std::floor(seconds / step));
    for (int i = 0; i < whole; ++i)
        add(i * step, step);
    add(whole * step, seconds - whole * step);
    return {place, headingAt(seconds)};
}

double FlightPath::ground(const osg::Vec2d& place) const
{
    const double x = (place.x() - _relief.west) / (_relief.east - _relief.west) * _relief.columns - 0.5;
    const double y = (place.y() - _relief.south) / (_relief.north - _relief.south) * _relief.rows - 0.5;
    const auto height = [&](int column, int row)
    {
        const float found = _relief.heights[_relief.index(std::clamp(column, 0, _relief.columns - 1),
                                                          std::clamp(row, 0, _relief.rows - 1))];
        return std::isfinite(found) ? std::max(0.0, static_cast<double>(found)) : 0.0;
    };
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const double u = x - column, v = y - row;
    return (1.0 - v) * ((1.0 - u) * height(column, row) + u * height(column + 1, row)) +
           v * ((1.0 - u) * height(column, row + 1) + u * height(column + 1, row + 1));
}

osg::Matrixd FlightPath::view(double seconds) const
{
    const Pose pose = at(seconds);
    double sum = 0.0;
    constexpr int samples = 20;
    for (int i = 0; i <= samples; ++i)
        sum += ground(at(std::max(0.0, seconds + SMOOTH * (static_cast<double>(i) / samples - 0.5))).place);
    osgGeoFX::ViewPoint point;
    point.longitude = osg::DegreesToRadians(pose.place.x());
    point.latitude = osg::DegreesToRadians(pose.place.y());
    point.height = HEIGHT + sum / (samples + 1);
    point.heading = pose.heading;
    point.pitch = PITCH;
    osg::Matrixd view;
    if (!point.viewMatrix(_reference, view)) throw BenchError("The flight leaves the database's projection.");
    return view;
}

} // namespace geofx::bench
