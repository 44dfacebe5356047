// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/RouteGround.h>

#include <osgGeoFX/mapping/RoutePath.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Of dense places, metres: what a leg may lie off them.
constexpr double tolerance = 0.5;
/// Of all legs together. Longer ones have longer pieces.
constexpr double mostPieces = 2e5;
/// Two dense places so far apart on a map, metres, lie on two sides of its edge.
constexpr double jump = 5e6;
/// Where the frame's plane is seen from its edge, a place has no x and y to go by.
constexpr double nearlyBeyond = 0.05;

bool isPlace(const osg::Vec2d& degrees)
{
    return std::abs(degrees.x()) <= 360.0 && std::abs(degrees.y()) <= 90.0;
}

RoutePath pathOf(const std::vector<osg::Vec2d>& degrees)
{
    RoutePath path;
    for (const osg::Vec2d& place : degrees)
        path.places.emplace_back(place, 0.0);
    return path;
}

} // namespace

std::vector<std::size_t> keptWithin(const std::vector<osg::Vec2d>& places, double most)
{
    std::vector<bool> stays(places.size());
    stays.front() = stays.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, places.size() - 1}};
    while (!open.empty())
    {
        const auto [first, last] = open.back();
        open.pop_back();
        const osg::Vec2d along = places[last] - places[first];
        double largest = most;
        std::size_t farthestPlace = 0;
        for (std::size_t i = first + 1; i < last; ++i)
        {
            const osg::Vec2d d = places[i] - places[first];
            const double share =
                along.length2() > 0.0 ? std::clamp(d * along / along.length2(), 0.0, 1.0) : 0.0;
            const double distance = (d - along * share).length();
            if (distance <= largest) continue;
            largest = distance;
            farthestPlace = i;
        }
        if (farthestPlace == 0) continue;
        stays[farthestPlace] = true;
        open.emplace_back(first, farthestPlace);
        open.emplace_back(farthestPlace, last);
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (stays[i]) kept.push_back(i);
    return kept;
}

bool RouteGround::placeOf(const osg::Vec2d& degrees, osg::Vec2d& place, std::string& error) const
{
    if (!isPlace(degrees))
    {
        error = "a way point is no place; give degrees of longitude, from -360 to 360, and latitude.";
        return false;
    }
    const double longitude = osg::DegreesToRadians(degrees.x());
    const double latitude = osg::DegreesToRadians(degrees.y());
    osg::Vec3d world;
    if (_ellipsoid)
    {
        _ellipsoid->convertLatLongHeightToXYZ(latitude, longitude, 0.0, world.x(), world.y(), world.z());
        const osg::Vec3d there = _ellipsoid->computeLocalUpVector(world.x(), world.y(), world.z());
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Z_AXIS, _effect.frameToWorld(_ellipsoid));
        if (there * up < nearlyBeyond)
        {
            error = "it lies on the other side of the globe from the effect's origin; give the effect "
                    "a longitude and latitude near it.";
            return false;
        }
    }
    else if (!_reference)
    {
        error = "degrees on a projected terrain need the terrain's georeference; give it.";
        return false;
    }
    else if (!_reference->toWorld(longitude, latitude, 0.0, world))
    {
        error = "it leaves the terrain's projection; cut it.";
        return false;
    }
    const osg::Vec3d found = _effect.placeOf(world, _ellipsoid);
    place.set(found.x(), found.y());
    return true;
}

bool RouteGround::placesOf(const std::vector<osg::Vec2d>& degrees, std::vector<osg::Vec2d>& places,
                           std::string& error) const
{
    for (const osg::Vec2d& each : degrees)
    {
        osg::Vec2d place;
        if (!placeOf(each, place, error)) return false;
        if (!_ellipsoid && !places.empty() && (place - places.back()).length() > jump)
        {
            error = "it crosses the edge of the terrain's projection; cut it there.";
            return false;
        }
        places.push_back(place);
    }
    return true;
}

bool RouteGround::lay(const std::vector<osg::Vec2d>& degrees, RouteMapping::Way& way,
                      std::string& error) const
{
    if (degrees.size() > mostWayPoints)
    {
        error = "it has more than " + std::to_string(mostWayPoints) + " way points; give a track, or cut it.";
        return false;
    }
    double length = 0.0;
    for (std::size_t i = 1; i < degrees.size(); ++i)
        length += isPlace(degrees[i - 1]) && isPlace(degrees[i])
                      ? RoutePath::distance(degrees[i - 1], degrees[i])
                      : 0.0;
    const double longest = std::max(step, length / mostPieces);
    RouteMapping::Way result;
    for (const osg::Vec2d& wayPoint : degrees)
    {
        std::vector<osg::Vec2d> leg = {wayPoint}, places;
        if (!result.degrees.empty() && isPlace(wayPoint))
            leg = pathOf({result.degrees.back(), wayPoint}).alongGeodesics(longest);
        if (!placesOf(leg, places, error)) return false;
        if (!result.line.empty() && (places.back() - result.line.back()).length() <= 1e-3) continue;
        for (const std::size_t i : keptWithin(places, tolerance))
            if (result.line.empty() || i > 0) result.line.push_back(places[i]);
        result.wayPoints.push_back(static_cast<unsigned int>(result.line.size() - 1));
        result.degrees.push_back(wayPoint);
    }
    way = std::move(result);
    return true;
}

} // namespace osgGeoFX
