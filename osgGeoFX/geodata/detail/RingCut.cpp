// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/RingCut.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Keeps what has a coordinate of at least (`sign` 1) or at most (−1) a limit.
std::vector<osg::Vec2d> cut(const std::vector<osg::Vec2d>& ring, int axis, double limit, double sign)
{
    std::vector<osg::Vec2d> result;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
        const osg::Vec2d& a = ring[i];
        const osg::Vec2d& b = ring[(i + 1) % ring.size()];
        const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
        if (da >= 0.0) result.push_back(a);
        if ((da < 0.0) == (db < 0.0)) continue;
        osg::Vec2d between = a + (b - a) * (da / (da - db));
        between[axis] = limit;
        result.push_back(between);
    }
    return result;
}

bool isOutside(const std::vector<osg::Vec2d>& places, const osg::Vec2d& low, const osg::Vec2d& high)
{
    bool left = true, right = true, below = true, above = true;
    for (const osg::Vec2d& place : places)
    {
        left = left && place.x() < low.x();
        right = right && place.x() > high.x();
        below = below && place.y() < low.y();
        above = above && place.y() > high.y();
    }
    return left || right || below || above;
}

bool isInside(const std::vector<osg::Vec2d>& places, const osg::Vec2d& low, const osg::Vec2d& high)
{
    return std::all_of(places.begin(), places.end(),
                       [&](const osg::Vec2d& place) {
                           return place.x() >= low.x() && place.x() <= high.x() && place.y() >= low.y() &&
                                  place.y() <= high.y();
                       });
}

/// Puts places between those that are more than a degree apart.
std::vector<osg::Vec2d> divided(const std::vector<osg::Vec2d>& places, bool closed)
{
    std::vector<osg::Vec2d> result;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        result.push_back(places[i]);
        if (!closed && i + 1 == places.size()) break;
        const osg::Vec2d way = places[(i + 1) % places.size()] - places[i];
        const double parts = std::ceil(way.length());
        for (double part = 1.0; part < parts; part += 1.0)
            result.push_back(places[i] + way * (part / parts));
    }
    return result;
}

} // namespace

std::vector<osg::Vec2d> ringWithin(const std::vector<osg::Vec2d>& ring, const osg::Vec2d& low,
                                   const osg::Vec2d& high)
{
    if (isOutside(ring, low, high)) return {};
    if (isInside(ring, low, high)) return ring;
    std::vector<osg::Vec2d> result = ring;
    for (int axis = 0; axis < 2; ++axis)
    {
        result = cut(result, axis, low[axis], 1.0);
        result = cut(result, axis, high[axis], -1.0);
    }
    return result;
}

std::vector<std::vector<osg::Vec2d>> lineWithin(const std::vector<osg::Vec2d>& line, const osg::Vec2d& low,
                                                const osg::Vec2d& high, std::vector<double>* starts)
{
    std::vector<std::vector<osg::Vec2d>> pieces;
    if (isOutside(line, low, high)) return pieces;
    std::vector<osg::Vec2d> piece;
    double along = 0.0;
    const auto finish = [&]()
    {
        if (piece.size() > 1)
            pieces.push_back(piece);
        else if (starts && !piece.empty())
            starts->pop_back();
        piece.clear();
    };
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
    {
        const osg::Vec2d way = line[i + 1] - line[i];
        const double length = way.length();
        double from = 0.0, to = 1.0;
        for (int axis = 0; axis < 2; ++axis)
        {
            const double a = line[i][axis], d = way[axis];
            if (d == 0.0)
            {
                if (a < low[axis] || a > high[axis]) to = -1.0;
                continue;
            }
            const double first = ((d > 0.0 ? low : high)[axis] - a) / d;
            const double last = ((d > 0.0 ? high : low)[axis] - a) / d;
            from = std::max(from, first);
            to = std::min(to, last);
        }
        if (from <= to)
        {
            if (piece.empty() || from > 0.0)
            {
                finish();
                piece.push_back(line[i] + way * from);
                if (starts) starts->push_back(along + from * length);
            }
            piece.push_back(line[i] + way * to);
            if (to < 1.0) finish();
        }
        else
            finish();
        along += length;
    }
    finish();
    return pieces;
}

std::vector<std::vector<osg::Vec2d>> cutToBox(const std::vector<std::vector<osg::Vec2d>>& parts, bool area,
                                              const DegreeBox& box)
{
    std::vector<std::vector<osg::Vec2d>> result;
    // A box around the globe has each longitude once, wherever it is counted.
    const bool around = box.east - box.west >= 360.0;
    for (const double turn : {0.0, -360.0, 360.0})
    {
        if (around && turn != 0.0) continue;
        const osg::Vec2d low(around ? -1e3 : box.west + turn, box.south);
        const osg::Vec2d high(around ? 1e3 : box.east + turn, box.north);
        for (const std::vector<osg::Vec2d>& part : parts)
        {
            if (area)
            {
                const std::vector<osg::Vec2d> ring = ringWithin(part, low, high);
                if (ring.size() > 2) result.push_back(divided(ring, true));
                continue;
            }
            for (const std::vector<osg::Vec2d>& piece : lineWithin(part, low, high))
                result.push_back(divided(piece, false));
        }
    }
    return result;
}

} // namespace osgGeoFX
