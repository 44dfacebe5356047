// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/Openness.h>

#include <osgGeoFX/town/detail/BuildingMesh.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double CELL = Openness::reach;
const double STEP = 2.0 * osg::PI / Openness::azimuths;

std::int32_t cellOf(double value)
{
    return static_cast<std::int32_t>(std::floor(value / CELL));
}

std::uint64_t keyOf(std::int32_t x, std::int32_t y)
{
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32) | static_cast<std::uint32_t>(x);
}

/// Where a half plane meets a building's wall.
struct Crossing
{
    int plane; ///< the half plane's number
    double distance, top;
    bool front; ///< it faces the place; else the building is left through it
    bool operator<(const Crossing& other) const
    {
        if (plane != other.plane) return plane < other.plane;
        return distance != other.distance ? distance < other.distance : top < other.top;
    }
};

/// Integrals over the elevations of one half plane. A direction counts by the cosine to the normal, `across` cos e + `up` sin e,
/// and by the solid angle, cos e.
struct HalfPlane
{
    double across, up;

    double open(double from, double to) const
    {
        if (!(to > from)) return 0.0;
        const auto at = [this](double e)
        {
            return across * (0.5 * e + 0.25 * std::sin(2.0 * e)) + 0.5 * up * std::sin(e) * std::sin(e);
        };
        return at(to) - at(from);
    }
    /// What counts by the distance of a wall, which is `distance` away.
    double wall(double distance, double from, double to) const
    {
        if (!(to > from)) return 0.0;
        // It is farther than the reach where the direction is steep.
        if (distance >= Openness::reach) return open(from, to);
        const double steep = std::acos(distance / Openness::reach);
        const auto at = [this](double e)
        {
            return across * std::sin(e) - up * std::cos(e);
        };
        const double a = std::clamp(from, -steep, steep), b = std::clamp(to, -steep, steep);
        double result = open(from, std::min(to, -steep)) + open(std::max(from, steep), to);
        if (b > a) result += distance / Openness::reach * (at(b) - at(a));
        return result;
    }
    /// What counts by the distance of the ground or a roof, `height` below; elevations below the horizon.
    double level(double height, double farthest, double from, double to) const
    {
        if (!(to > from)) return 0.0;
        if (height >= farthest) return open(from, to);
        const double share = std::max(height, 0.0) / farthest, flat = -std::asin(share);
        const auto at = [this](double e)
        {
            return across * (std::log(std::abs(std::tan(0.5 * e))) + std::cos(e)) + up * std::sin(e);
        };
        double result = open(std::max(from, flat), to);
        if (const double end = std::min(to, flat); share > 0.0 && end > from)
            result -= share * (at(end) - at(from));
        return result;
    }
};

} // namespace

std::size_t Openness::add(const PlacedBuilding& building)
{
    Prism prism;
    prism.top = meanTop(building);
    prism.low.set(HUGE_VAL, HUGE_VAL);
    prism.high.set(-HUGE_VAL, -HUGE_VAL);
    prism.rings = building.rings;
    for (const osg::Vec2d& place : building.rings.front())
        for (int axis = 0; axis < 2; ++axis)
        {
            prism.low[axis] = std::min(prism.low[axis], place[axis]);
            prism.high[axis] = std::max(prism.high[axis], place[axis]);
        }
    const auto number = static_cast<std::uint32_t>(_prisms.size());
    for (std::int32_t y = cellOf(prism.low.y()); y <= cellOf(prism.high.y()); ++y)
        for (std::int32_t x = cellOf(prism.low.x()); x <= cellOf(prism.high.x()); ++x)
            _cells[keyOf(x, y)].push_back(number);
    _prisms.push_back(std::move(prism));
    return number;
}

void Openness::at(const osg::Vec2d& place, const osg::Vec3d& normal, double ground, const double* heights,
                  double* results, std::size_t count, std::size_t except) const
{
    // Azimuths are counted from the normal's, so that a wall looks the same whichever way it faces.
    const double across = std::sqrt(normal.x() * normal.x() + normal.y() * normal.y());
    const osg::Vec2d facing =
        across > 0.0 ? osg::Vec2d(normal.x(), normal.y()) / across : osg::Vec2d(1.0, 0.0);
    const bool upright = normal.z() < 1e-9; // and so what is behind it does not matter
    static const std::vector<osg::Vec2d> ways = []
    {
        std::vector<osg::Vec2d> result;
        for (int k = 0; k < azimuths; ++k)
            result.emplace_back(std::cos((k + 0.5) * STEP), std::sin((k + 0.5) * STEP));
        return result;
    }();
    const auto turned = [&](const osg::Vec2d& from)
    {
        const osg::Vec2d to = from - place;
        return osg::Vec2d(to * facing, facing.x() * to.y() - facing.y() * to.x());
    };
    const double lowest = *std::min_element(heights, heights + count);
    std::vector<std::uint32_t> near;
    for (std::int32_t y = cellOf(place.y() - reach); y <= cellOf(place.y() + reach); ++y)
        for (std::int32_t x = cellOf(place.x() - reach); x <= cellOf(place.x() + reach); ++x)
            if (const auto cell = _cells.find(keyOf(x, y)); cell != _cells.end())
                for (const std::uint32_t each : cell->second)
                    if (each != except && _prisms[each].top > ground) near.push_back(each);
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());

    std::vector<Crossing> crossings;
    const auto cross = [&](const osg::Vec2d& a, const osg::Vec2d& b, double top)
    {
        if (upright && a.x() <= 0.0 && b.x() <= 0.0) return;
        const osg::Vec2d side = b - a;
        const double area = a.x() * side.y() - a.y() * side.x();
        if (area == 0.0 || a.length2() == 0.0 || b.length2() == 0.0) return;
        // The solid is on its left. Seen from outside, from a to b is clockwise.
        const bool front = area < 0.0;
        const osg::Vec2d& start = front ? b : a;
        const double first = std::atan2(start.y(), start.x()) / STEP - 0.5;
        const double turn = std::atan2(std::abs(area), a * b) / STEP;
        for (double k = std::ceil(first); k <= first + turn; k += 1.0)
        {
            const int plane = ((static_cast<int>(k) % azimuths) + azimuths) % azimuths;
            const osg::Vec2d& way = ways[static_cast<std::size_t>(plane)];
            const double along = way.x() * side.y() - way.y() * side.x();
            if (along == 0.0) continue;
            const double distance = area / along;
            if (!(distance > 0.0)) continue;
            crossings.push_back({plane, distance, top, front});
        }
    };
    double shut = -HUGE_VAL; // the top of what stands over the place
    for (const std::uint32_t number : near)
    {
        const Prism& prism = _prisms[number];
        if (prism.low.x() > place.x() + reach || prism.high.x() < place.x() - reach ||
            prism.low.y() > place.y() + reach || prism.high.y() < place.y() - reach)
            continue;
        // A level roof sees only what is higher.
        if (across < 1e-9 && prism.top <= lowest) continue;
        if (prism.top > shut && prism.low.x() <= place.x() && prism.high.x() >= place.x() &&
            prism.low.y() <= place.y() && prism.high.y() >= place.y() && isWithin(prism.rings, place))
            shut = prism.top;
        for (const Ring& ring : prism.rings)
            for (std::size_t i = 0; i < ring.size(); ++i)
                cross(turned(ring[i]), turned(ring[(i + 1) % ring.size()]), prism.top);
    }
    // Most roofs: nothing is higher.
    if (crossings.empty() && across < 1e-9)
    {
        for (std::size_t i = 0; i < count; ++i)
            results[i] = heights[i] < shut ? 0.0 : 1.0;
        return;
    }
    std::sort(crossings.begin(), crossings.end());

    for (std::size_t i = 0; i < count; ++i)
    {
        const double above = heights[i] - ground;
        double sum = 0.0, whole = 0.0;
        std::size_t next = 0;
        for (int k = 0; k < azimuths; ++k)
        {
            const std::size_t first = next;
            while (next < crossings.size() && crossings[next].plane == k)
                ++next;
            const HalfPlane half{across * ways[static_cast<std::size_t>(k)].x(), upright ? 0.0 : normal.z()};
            // The elevations above the surface.
            if (half.up <= 0.0 && half.across <= 0.0) continue;
            const double from = half.up > 1e-9 ? std::atan(-half.across / half.up) : -0.5 * osg::PI;
            const double zenith = 0.5 * osg::PI;
            whole += half.open(from, zenith);
            if (heights[i] < shut) continue;
            double done = from; // the skyline so far
            double slope = upright ? -HUGE_VAL : std::tan(from);
            for (std::size_t c = first; c < next; ++c)
            {
                const Crossing& each = crossings[c];
                const double rise = (each.top - heights[i]) / each.distance;
                if (rise <= slope || (!each.front && rise >= 0.0)) continue;
                const double top = std::atan(rise);
                slope = rise;
                if (!each.front)
                {
                    // Its roof, seen from above up to here.
                    sum += half.level(heights[i] - each.top, reach, done, top);
                    done = top;
                    continue;
                }
                const double foot = -std::atan2(above, each.distance);
                sum += half.level(above, groundReach, done, std::min({top, foot, 0.0}));
                sum += half.wall(each.distance, std::max(done, foot), top);
                done = std::max(done, top);
            }
            sum += half.level(above, groundReach, done, 0.0);
            sum += half.open(std::max(done, 0.0), zenith);
        }
        results[i] = whole > 0.0 ? std::clamp(sum / whole, 0.0, 1.0) : 1.0;
    }
}

} // namespace osgGeoFX
