// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/RoutePath.h>

#include <osgGeoFX/mapping/detail/RouteGround.h>

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

/// Farther apart on the globe, radians, the shortest way is no small change of the circle.
constexpr double nearlyOpposite = 3.0;

osg::Vec3d worldOf(const osg::EllipsoidModel& earth, const osg::Vec2d& degrees)
{
    osg::Vec3d world;
    earth.convertLatLongHeightToXYZ(osg::DegreesToRadians(degrees.y()), osg::DegreesToRadians(degrees.x()),
                                    0.0, world.x(), world.y(), world.z());
    return world;
}

double angleBetween(const osg::Vec3d& a, const osg::Vec3d& b)
{
    return std::atan2((a ^ b).length(), a * b);
}

/// The point of the ellipsoid in the direction of one from its center.
osg::Vec3d onEllipsoid(const osg::EllipsoidModel& earth, const osg::Vec3d& place)
{
    const double a = earth.getRadiusEquator(), b = earth.getRadiusPolar();
    return place / std::sqrt((place.x() * place.x() + place.y() * place.y()) / (a * a) +
                             place.z() * place.z() / (b * b));
}

/// Moves points between the ends across their line until it has no curvature on the ellipsoid: a step of Newton's method for
/// Jacobi's equation, which says how neighbouring geodesics part.
void straighten(const osg::EllipsoidModel& earth, std::vector<osg::Vec3d>& points)
{
    const std::size_t last = points.size() - 1;
    const double curvature = 1.0 / (earth.getRadiusEquator() * earth.getRadiusPolar());
    std::vector<osg::Vec3d> across(points.size());
    // The equations' upper diagonal and right side, after those before have been taken out (Thomas).
    std::vector<double> upper(points.size()), right(points.size());
    for (std::size_t i = 1; i < last; ++i)
    {
        const osg::Vec3d up = earth.computeLocalUpVector(points[i].x(), points[i].y(), points[i].z());
        const osg::Vec3d along = points[i + 1] - points[i - 1];
        across[i] = up ^ along;
        across[i].normalize();
        const double bend = (points[i + 1] - points[i] * 2.0 + points[i - 1]) * across[i];
        const double diagonal = -2.0 + along.length2() / 4.0 * curvature - upper[i - 1];
        upper[i] = 1.0 / diagonal;
        right[i] = (-bend - right[i - 1]) / diagonal;
    }
    double shift = 0.0;
    for (std::size_t i = last - 1; i > 0; --i)
    {
        shift = right[i] - upper[i] * shift;
        points[i] = onEllipsoid(earth, points[i] + across[i] * shift);
    }
}

/// Points on the geodesic between two of the ellipsoid, with the ends.
std::vector<osg::Vec3d> geodesic(const osg::EllipsoidModel& earth, const osg::Vec3d& from,
                                 const osg::Vec3d& to, double longest)
{
    const double angle = angleBetween(from, to);
    const int parts = std::max(1, static_cast<int>(std::ceil(angle * earth.getRadiusEquator() / longest)));
    osg::Vec3d start = from, side = to - from * (from * to / from.length2());
    start.normalize();
    side.normalize();
    std::vector<osg::Vec3d> points = {from};
    for (int part = 1; part < parts; ++part)
    {
        const double turn = angle * part / parts;
        points.push_back(onEllipsoid(earth, start * std::cos(turn) + side * std::sin(turn)));
    }
    points.push_back(to);
    for (int i = 0; i < 3 && points.size() > 2 && angle < nearlyOpposite; ++i)
        straighten(earth, points);
    return points;
}

} // namespace

double RoutePath::distance(const osg::Vec2d& from, const osg::Vec2d& to)
{
    const osg::EllipsoidModel earth;
    return angleBetween(worldOf(earth, from), worldOf(earth, to)) * earth.getRadiusEquator();
}

std::vector<osg::Vec2d> RoutePath::alongGeodesics(double longest) const
{
    const osg::EllipsoidModel earth;
    std::vector<osg::Vec2d> result;
    osg::Vec3d before;
    for (const osg::Vec3d& place : places)
    {
        const osg::Vec3d here = worldOf(earth, {place.x(), place.y()});
        const std::vector<osg::Vec3d> points =
            result.empty() ? std::vector<osg::Vec3d>() : geodesic(earth, before, here, longest);
        for (std::size_t i = 1; i + 1 < points.size(); ++i)
        {
            const osg::Vec3d& point = points[i];
            double longitude = 0.0, latitude = 0.0, height = 0.0;
            earth.convertXYZToLatLongHeight(point.x(), point.y(), point.z(), latitude, longitude, height);
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

bool RoutePath::showOn(ProjectiveMappings& effect, const osg::EllipsoidModel* ellipsoid,
                       const Georeference* reference, const Look& look, std::string& error) const
{
    std::vector<osg::Vec2d> degrees, way;
    for (const osg::Vec3d& place : places)
        degrees.emplace_back(place.x(), place.y());
    if (!wayPoints) degrees = alongGeodesics();
    if (degrees.empty())
    {
        error = "it has no place; give it some.";
        return false;
    }
    if (!RouteGround(effect, ellipsoid, reference).placesOf(degrees, way, error)) return false;
    osg::BoundingBoxd box;
    for (const osg::Vec2d& place : way)
        box.expandBy(osg::Vec3d(place, 0.0));
    RouteMapping::Style style = look.style;
    const double extent =
        look.groundExtent > 0.0 ? std::min(2.0 * box.radius(), look.groundExtent) : 2.0 * box.radius();
    const double width = look.width > 0.0 ? look.width : std::max(8.0, extent / 120.0);
    const double scale = style.halfWidth > 0.0 ? width / 2.0 / style.halfWidth : 1.0;
    style.halfWidth *= scale;
    style.casing *= scale;
    style.pointRadius *= scale;
    if (color) style.color = *color;
    if (!wayPoints) style.pointRadius = 0.0;
    // Way points stay. The style's own half width may be 0, of a way with marks alone.
    for (double tolerance = width / 8.0; !wayPoints; tolerance *= 2.0)
    {
        const std::vector<std::size_t> kept = keptWithin(way, tolerance);
        if (kept.size() > RouteGround::mostWayPoints) continue;
        std::vector<osg::Vec2d> simple;
        for (const std::size_t i : kept)
            simple.push_back(degrees[i]);
        degrees = std::move(simple);
        break;
    }
    const osg::ref_ptr<RouteMapping> route = new RouteMapping;
    route->setName(name);
    if (!route->setStyle(style) || !route->setOrder(look.order))
    {
        error = "its width or order is out of range; give another one.";
        return false;
    }
    if (!route->setProperties(look.properties, error)) return false;
    effect.addRoute(route);
    if (route->setGeographicWayPoints(degrees, ellipsoid, reference, error)) return true;
    effect.removeRoute(route);
    return false;
}

} // namespace osgGeoFX
