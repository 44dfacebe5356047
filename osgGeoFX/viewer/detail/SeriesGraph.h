// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerSeries.h>
#include <osgGeoFX/viewer/detail/OverlayShapes.h>

#include <osg/Vec4>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Where everything is in the plot of a series: pixels of the viewport, with y up. It needs no OpenGL. */
class SeriesGraph
{
public:
    /// `width` and `height` are the viewport's. The plot lies at its left edge, above the time bar.
    SeriesGraph(double width, double height, const std::vector<LayerSeries::Point>& points,
                const LayerClock& clock, bool classes);

    double text, line, margin; ///< sizes
    PixelBox panel, graph, save, close;

    double begin = 0.0, end = 1.0; ///< of the axis of times, seconds
    double low = 0.0, high = 1.0;  ///< of the axis of values
    struct Tick
    {
        double at = 0.0;
        std::string text;
    };
    std::vector<Tick> times, values;
    /// What is drawn of a value, or of a channel of colors: lines of places. Where nothing is known is a gap.
    struct Curve
    {
        osg::Vec4 color;
        std::vector<std::vector<osg::Vec2d>> lines;
    };
    std::vector<Curve> curves;

    osg::Vec2d placeOf(double time, double value) const;
    /// The time of a place; within the axis.
    double timeAt(double x) const;
    /// The value at a time, as sequences have it between steps; nothing beside a gap. Of colors none.
    std::optional<double> valueAt(double time) const;

    /// Round times from `from` to `to`, `most` at most: seconds, minutes, hours and days.
    static std::vector<double> roundTimes(double from, double to, int most);

private:
    void findTicks(const LayerClock& clock);
    void makeCurves();

    std::vector<LayerSeries::Point> _points;
    bool _classes;
};

} // namespace osgGeoFX
