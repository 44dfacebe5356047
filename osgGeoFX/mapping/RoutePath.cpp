// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/RoutePath.h>

#include <osg/BoundingBox>
#include <osg/CoordinateSystemNode>
#include <osg/Math>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Of a way, after it is simplified; each leg is four mappings.
constexpr std::size_t mostPlaces = 20000;

/// Leaves out what lies within the tolerance of the rest (Douglas and Peucker).
std::vector<osg::Vec2d> simplified(const std::vector<osg::Vec2d>& places, double tolerance)
{
    std::vector<bool> stays(places.size());
    stays.front() = stays.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, places.size() - 1}};
    while (!open.empty())
    {
        const auto [first, last] = open.back();
        open.pop_back();
        const osg::Vec2d along = places[last] - places[first];
        double most = tolerance;
        std::size_t farthestPlace = 0;
        for (std::size_t i = first + 1; i < last; ++i)
        {
            const osg::Vec2d d = places[i] - places[first];
            const double share =
                along.length2() > 0.0 ? std::clamp(d * along / along.length2(), 0.0, 1.0) : 0.0;
            const double distance = (d - along * share).length();
            if (distance <= most) continue;
            most = distance;
            farthestPlace = i;
        }
        if (farthestPlace == 0) continue;
        stays[farthestPlace] = true;
        open.emplace_back(first, farthestPlace);
        open.emplace_back(farthestPlace, last);
    }
    std::vector<osg::Vec2d> result;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (stays[i]) result.push_back(places[i]);
    return result;
}

} // namespace

std::vector<osg::Vec2d> RoutePath::alongGreatCircles(double longest) const
{
    const osg::EllipsoidModel earth;
    std::vector<osg::Vec2d> result;
    osg::Vec3d before;
    for (const osg::Vec3d& place : places)
    {
        osg::Vec3d here;
        earth.convertLatLongHeightToXYZ(osg::DegreesToRadians(place.y()), osg::DegreesToRadians(place.x()),
                                        0.0, here.x(), here.y(), here.z());
        const int parts =
            result.empty() ? 1 : std::max(1, static_cast<int>(std::ceil((here - before).length() / longest)));
        for (int part = 1; part < parts; ++part)
        {
            const osg::Vec3d chord = before + (here - before) * (part / static_cast<double>(parts));
            double longitude = 0.0, latitude = 0.0, height = 0.0;
            earth.convertXYZToLatLongHeight(chord.x(), chord.y(), chord.z(), latitude, longitude, height);
            result.emplace_back(osg::RadiansToDegrees(longitude), osg::RadiansToDegrees(latitude));
        }
        result.emplace_back(place.x(), place.y());
        before = here;
    }
    return result;
}

RouteMapping::Style RoutePath::plainStyle()
{
    RouteMapping::Style style;
    style.context = false;
    return style;
}

bool RoutePath::showOn(ProjectiveMappings& effect, const std::vector<osg::Vec2d>& way, const Look& look) const
{
    if (way.empty()) return false;
    osg::BoundingBoxd box;
    for (const osg::Vec2d& place : way)
        box.expandBy(osg::Vec3d(place, 0.0));
    RouteMapping::Style style = look.style;
    const double width = look.width > 0.0 ? look.width : std::max(8.0, box.radius() / 60.0);
    const double scale = style.halfWidth > 0.0 ? width / 2.0 / style.halfWidth : 1.0;
    style.halfWidth *= scale;
    style.casing *= scale;
    style.pointRadius *= scale;
    if (color) style.color = *color;
    if (!wayPoints) style.pointRadius = 0.0;
    std::vector<osg::Vec2d> simple = way;
    if (wayPoints && simple.size() > mostPlaces)
    {
        OSG_WARN << "osgGeoFX: RoutePath got a way of more than " << mostPlaces
                 << " way points; it is not shown." << std::endl;
        return false;
    }
    // Way points stay. The style's own half width may be 0, of a way with marks alone.
    for (double tolerance = width / 8.0; !wayPoints; tolerance *= 2.0)
    {
        simple = simplified(simple, tolerance);
        if (simple.size() <= mostPlaces) break;
    }
    const osg::ref_ptr<RouteMapping> mapping = new RouteMapping(effect, look.order);
    if (!mapping->setStyle(style) || !mapping->setWayPoints(simple)) return false;
    mapping->leave(name);
    return true;
}

} // namespace osgGeoFX
