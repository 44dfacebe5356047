// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/Footprint.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double farthest = 1e15;
constexpr double roundingShare =
    1e-12; // of the squared extent: what counts as no area, or as a straight corner

double cross(const osg::Vec2d& a, const osg::Vec2d& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

/// Whether a footprint of this area is all of the box around it.
bool fills(const osg::Vec2d& low, const osg::Vec2d& high, double area)
{
    return std::abs(area) >= (1.0 - roundingShare) * (high.x() - low.x()) * (high.y() - low.y());
}

} // namespace

PlaneFootprint PlaneFootprint::box(const osg::Vec2d& low, const osg::Vec2d& high)
{
    return {{low, osg::Vec2d(high.x(), low.y()), high, osg::Vec2d(low.x(), high.y())}};
}

double PlaneFootprint::signedArea() const
{
    return cross(corners[2] - corners[0], corners[3] - corners[1]) / 2;
}

bool PlaneFootprint::valid() const
{
    for (const osg::Vec2d& corner : corners)
    {
        // Written so that NaN fails.
        if (!(std::abs(corner.x()) <= farthest && std::abs(corner.y()) <= farthest)) return false;
    }
    const double area = signedArea();
    const double extent2 = std::max((corners[2] - corners[0]).length2(), (corners[3] - corners[1]).length2());
    const double rounding = roundingShare * extent2;
    if (!(std::abs(area) > rounding)) return false;
    for (unsigned int i = 0; i < 4; ++i)
    {
        const osg::Vec2d before = corners[(i + 1) % 4] - corners[i];
        const osg::Vec2d after = corners[(i + 2) % 4] - corners[(i + 1) % 4];
        if (cross(before, after) * (area > 0 ? 1.0 : -1.0) < -rounding) return false;
    }
    return true;
}

FootprintShape::FootprintShape(const PlaneFootprint& footprint)
    : _low(footprint.corners[0]), _high(footprint.corners[0])
{
    for (const osg::Vec2d& corner : footprint.corners)
    {
        _low.set(std::min(_low.x(), corner.x()), std::min(_low.y(), corner.y()));
        _high.set(std::max(_high.x(), corner.x()), std::max(_high.y(), corner.y()));
    }
    const double area = footprint.signedArea();
    _width = std::sqrt(std::abs(area));
    if (fills(_low, _high, area)) return;
    for (unsigned int i = 0; i < 4; ++i)
    {
        const osg::Vec2d along = footprint.corners[(i + 1) % 4] - footprint.corners[i];
        const double length = along.length();
        if (length <= 0.0) continue;
        Edge& edge = _edges[_edgeCount];
        edge.normal = osg::Vec2d(along.y(), -along.x()) * ((area > 0 ? 1.0 : -1.0) / length);
        edge.reach = std::abs(edge.normal.x()) + std::abs(edge.normal.y());
        // Of all corners, so that a normal that is not exact does not cut anything off.
        edge.limit = edge.normal * footprint.corners[0];
        for (const osg::Vec2d& corner : footprint.corners)
        {
            edge.limit = std::max(edge.limit, edge.normal * corner);
        }
        ++_edgeCount;
    }
}

bool FootprintShape::overlaps(const PlaneSquare& square, double margin) const
{
    const osg::Vec2d& origin = square.origin;
    if (_low.x() - margin > origin.x() + square.size || _high.x() + margin < origin.x() ||
        _low.y() - margin > origin.y() + square.size || _high.y() + margin < origin.y())
    {
        return false;
    }
    const double half = square.size / 2;
    const osg::Vec2d middle = origin + osg::Vec2d(half, half);
    for (unsigned int i = 0; i < _edgeCount; ++i)
    {
        const Edge& edge = _edges[i];
        if (edge.normal * middle - edge.reach * half > edge.limit + margin) return false;
    }
    return true;
}

bool FootprintShape::covers(const PlaneSquare& square, double margin) const
{
    const osg::Vec2d& origin = square.origin;
    if (_low.x() + margin > origin.x() || _high.x() - margin < origin.x() + square.size ||
        _low.y() + margin > origin.y() || _high.y() - margin < origin.y() + square.size)
    {
        return false;
    }
    const double half = square.size / 2;
    const osg::Vec2d middle = origin + osg::Vec2d(half, half);
    for (unsigned int i = 0; i < _edgeCount; ++i)
    {
        const Edge& edge = _edges[i];
        if (edge.normal * middle + edge.reach * half > edge.limit - margin) return false;
    }
    return true;
}

} // namespace osgGeoFX
