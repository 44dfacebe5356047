// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>

#include <cmath>

namespace osgGeoFX
{

/// The argument at which a growing function with the values 0 at 0 and `end` at `end` takes a value between them.
template<class Function>
double inverseOfGrowing(double value, double end, const Function& function)
{
    double low = 0.0, high = end;
    for (int step = 0; step < 200; ++step)
    {
        const double middle = low + 0.5 * (high - low);
        if (middle <= low || middle >= high) break;
        (function(middle) < value ? low : high) = middle;
    }
    return low + 0.5 * (high - low);
}

/// The local place that geofx_libertyWay() moves to a given one. It undoes the movements in the reverse order; those of
/// the plane do not depend on heights.
inline glm::dvec3 undoneLiberty(const glsl::geofx_Liberty& view, const glm::dvec3& drawn)
{
    const double wide = drawn.x / view.acrossRadius, deep = drawn.y / view.alongRadius;
    if (wide * wide + deep * deep >= 1.0 || view.curvature * drawn.z < -0.5) return drawn;
    const auto undone = [](double value, double other, double gain)
    {
        if (gain == 0.0) return value;
        const double end = std::sqrt(std::fmax(1.0 - other * other, 0.0));
        const double found = inverseOfGrowing(
            std::abs(value), end,
            [&](double way)
            { return way * (1.0 + gain * glsl::geofx_libertyShare(way * way + other * other)); });
        return std::copysign(found, value);
    };
    const double turnedY = undone(deep, wide, view.lengthen);
    const double turnedX = undone(wide, turnedY, view.widen);
    const double share = glsl::geofx_libertyShare(turnedX * turnedX + turnedY * turnedY);
    const double c = std::cos(view.turn * share), s = std::sin(view.turn * share);
    const glm::dvec2 place((c * turnedX - s * turnedY) * view.acrossRadius,
                           (c * turnedY + s * turnedX) * view.alongRadius);
    const double k = view.curvature / 2.0;
    const double height = drawn.z + k * (drawn.x * drawn.x + drawn.y * drawn.y);
    const double own = view.base + (height - view.base) / (1.0 + view.enlarge * share);
    return {place, own - k * glm::dot(place, place)};
}

} // namespace osgGeoFX
