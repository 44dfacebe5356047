// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/SceneRoutes.h>

#include <osgGeoFX/map/RouteFile.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Between places farther apart than this, metres, a way is given more of them.
constexpr double longestLeg = 20000.0;
/// Of a way, after it is simplified; each leg is four mappings.
constexpr std::size_t mostPlaces = 20000;
constexpr double farthest = 0.79; // radians of arc, from an effect's origin
constexpr std::size_t mostEffects = 3;

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

SceneRoutes::SceneRoutes(osg::Node& node, EffectScene& scene)
    : _scene(&scene), _ellipsoid(scene.ground().ellipsoid)
{
    if (!_ellipsoid) _reference = Georeference::create(&node, _referenceError);
}

RouteMapping::Style SceneRoutes::plainStyle()
{
    RouteMapping::Style style;
    style.context = false;
    return style;
}

bool SceneRoutes::placeOf(const RoutePath& route, Way& way, std::string& error)
{
    const auto worldOf = [&](double longitude, double latitude, osg::Vec3d& world)
    {
        const double x = osg::DegreesToRadians(longitude);
        const double y = osg::DegreesToRadians(latitude);
        if (!_ellipsoid) return _reference->toWorld(x, y, 0.0, world);
        _ellipsoid->convertLatLongHeightToXYZ(y, x, 0.0, world.x(), world.y(), world.z());
        return true;
    };
    if (!_ellipsoid && !_reference)
    {
        error = _referenceError;
        return false;
    }
    osg::EllipsoidModel earth;
    osg::Vec3d before;
    for (std::size_t i = 0; i < route.places.size(); ++i)
    {
        osg::Vec3d here;
        earth.convertLatLongHeightToXYZ(osg::DegreesToRadians(route.places[i].y()),
                                        osg::DegreesToRadians(route.places[i].x()), 0.0, here.x(), here.y(),
                                        here.z());
        const int parts = i == 0 ? 1 : std::max(1, static_cast<int>((here - before).length() / longestLeg));
        for (int part = 1; part <= parts; ++part)
        {
            double longitude = osg::DegreesToRadians(route.places[i].x());
            double latitude = osg::DegreesToRadians(route.places[i].y());
            double height = 0.0;
            if (part < parts)
            {
                const osg::Vec3d chord = before + (here - before) * (part / static_cast<double>(parts));
                earth.convertXYZToLatLongHeight(chord.x(), chord.y(), chord.z(), latitude, longitude, height);
            }
            osg::Vec3d world;
            if (!worldOf(osg::RadiansToDegrees(longitude), osg::RadiansToDegrees(latitude), world))
            {
                error = "The way \"" + route.name + "\" leaves the terrain's projection; cut it.";
                return false;
            }
            way.world.push_back(world);
        }
        before = here;
    }
    osg::BoundingBoxd box;
    for (const osg::Vec3d& world : way.world)
        box.expandBy(world);
    way.middle = box.center();
    for (const osg::Vec3d& world : way.world)
        way.radius = std::max(way.radius, (world - way.middle).length());
    return true;
}

ProjectiveMappings* SceneRoutes::effectFor(const Way& way, std::string& error)
{
    const auto angle = [](const osg::Vec3d& a, const osg::Vec3d& b)
    {
        return std::acos(std::clamp(a * b / (a.length() * b.length()), -1.0, 1.0));
    };
    double own = 0.0;
    for (const osg::ref_ptr<ProjectiveMappings>& effect : _effects)
    {
        if (!_ellipsoid) return effect;
        const osg::Vec3d origin = effect->frameToWorld(_ellipsoid).getTrans();
        double most = 0.0;
        for (const osg::Vec3d& world : way.world)
            most = std::max(most, angle(world, origin));
        if (most < farthest) return effect;
    }
    for (const osg::Vec3d& world : way.world)
        own = std::max(own, _ellipsoid ? angle(world, way.middle) : 0.0);
    if (own > 1.2 || _effects.size() >= mostEffects)
    {
        error = "its ways reach around too much of the globe; show a part of them.";
        return nullptr;
    }
    osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
    effect->setName("routes");
    if (_ellipsoid)
    {
        double longitude = 0.0, latitude = 0.0, height = 0.0;
        _ellipsoid->convertXYZToLatLongHeight(way.middle.x(), way.middle.y(), way.middle.z(), latitude,
                                              longitude, height);
        effect->setLocalOrigin(LocalOrigin::onGlobe(longitude, latitude));
    }
    else
        effect->setLocalOrigin(LocalOrigin::onPlane({way.middle.x(), way.middle.y()}));
    _scene->addEffect(effect);
    _effects.push_back(effect);
    return effect;
}

bool SceneRoutes::add(const RoutePath& route, const Options& options, std::string& error)
{
    Way way;
    if (!placeOf(route, way, error)) return false;
    ProjectiveMappings* const effect = effectFor(way, error);
    if (!effect) return false;
    RouteMapping::Style style = options.style;
    const double width = options.width > 0.0 ? options.width : std::max(8.0, way.radius / 60.0);
    const double scale = style.halfWidth > 0.0 ? width / 2.0 / style.halfWidth : 1.0;
    style.halfWidth *= scale;
    style.casing *= scale;
    style.pointRadius *= scale;
    if (route.color) style.color = *route.color;
    if (!route.wayPoints) style.pointRadius = 0.0;
    std::vector<osg::Vec2d> places;
    for (const osg::Vec3d& world : way.world)
    {
        const osg::Vec3d place = effect->placeOf(world, _ellipsoid);
        places.emplace_back(place.x(), place.y());
    }
    double tolerance = style.halfWidth / 4.0;
    // Way points stay.
    if (!route.wayPoints)
        while ((places = simplified(places, tolerance)).size() > mostPlaces)
            tolerance *= 2.0;
    const osg::ref_ptr<RouteMapping> mapping = new RouteMapping(*effect);
    if (!mapping->setStyle(style) || !mapping->setWayPoints(places))
    {
        error = "the look of the way \"" + route.name + "\" is out of range; give another width.";
        return false;
    }
    mapping->leave(route.name);
    return true;
}

bool SceneRoutes::add(const std::string& file, const Options& options, std::string& error)
{
    RouteFile request;
    request.file = file;
    request.layer = options.layer;
    if (!request.read(error)) return false;
    for (const RoutePath& route : request.routes)
    {
        if (add(route, options, error)) continue;
        error = file + ": " + error;
        return false;
    }
    return true;
}

} // namespace osgGeoFX
