// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec2d>

#include <algorithm>
#include <vector>

namespace geofx::test
{

/// How far a point lies inside of a polygon, in the units of both; negative outside.
inline double insideOf(const std::vector<osg::Vec2d>& polygon, const osg::Vec2d& point)
{
    double nearest = 1e30;
    bool within = false;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const osg::Vec2d& a = polygon[i];
        const osg::Vec2d& b = polygon[(i + 1) % polygon.size()];
        const osg::Vec2d edge = b - a;
        const double share = std::clamp((point - a) * edge / std::max(edge.length2(), 1e-12), 0.0, 1.0);
        nearest = std::min(nearest, (a + edge * share - point).length());
        const bool crosses = (a.y() > point.y()) != (b.y() > point.y()) &&
                             point.x() < a.x() + edge.x() * (point.y() - a.y()) / edge.y();
        within = within != crosses;
    }
    return within ? nearest : -nearest;
}

} // namespace geofx::test
