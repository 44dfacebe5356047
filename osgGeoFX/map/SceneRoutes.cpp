// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/SceneRoutes.h>

#include <osgGeoFX/labels/FinestGround.h>
#include <osgGeoFX/map/RouteFile.h>
#include <osgGeoFX/mapping/PathRibbon.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr double farthest = 0.79; // radians of arc, from an effect's origin
constexpr std::size_t mostEffects = 3;
/// Of all ways together. A leg has four; more of them take minutes and memory.
constexpr std::size_t mostMappings = 400000;

} // namespace

/// The ground of the scene as its database has it, above its zero height.
class SceneRoutes::Heights
{
public:
    static std::shared_ptr<Heights> of(const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid,
                                       const Georeference& reference, std::string& error)
    {
        std::optional<TerrainRelief> relief = TerrainRelief::read(terrain, ellipsoid, reliefCells, error);
        if (!relief) return nullptr;
        return std::make_shared<Heights>(terrain, ellipsoid, reference, std::move(*relief));
    }
    Heights(const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid, const Georeference& reference,
            TerrainRelief relief)
        : _relief(std::move(relief)), _ground(terrain, ellipsoid, _relief), _reference(reference),
          _globe(ellipsoid != nullptr)
    {
    }
    double at(double longitude, double latitude) const
    {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        osg::Vec2d place(longitude, latitude);
        osg::Vec3d world;
        const double x = osg::DegreesToRadians(longitude), y = osg::DegreesToRadians(latitude);
        if (!_globe)
        {
            if (!_reference.toWorld(x, y, 0.0, world)) return none;
            place.set(world.x(), world.y());
        }
        double height = _ground.finest(place.x(), place.y());
        // A ray may slip through exactly between triangles.
        const double step = _globe ? 1e-7 : 1e-2;
        for (int i = 1; i <= 4 && !std::isfinite(height); ++i)
            height = _ground.finest(place.x() + step * i, place.y() + step * (i % 2));
        if (!std::isfinite(height)) height = _ground.coarse(place.x(), place.y());
        if (!std::isfinite(height)) return none;
        double back = 0.0, east = 0.0, north = 0.0;
        world = _ground.world(place.x(), place.y(), height);
        return _reference.toGeodetic(world, east, north, back) ? back : none;
    }

private:
    static constexpr int reliefCells = 256;
    const TerrainRelief _relief;
    const FinestGround _ground;
    const Georeference& _reference;
    const bool _globe;
};

SceneRoutes::SceneRoutes(osg::Node& node, EffectScene& scene)
    : _node(node), _scene(&scene), _groundExtent(2.0 * static_cast<double>(node.getBound().radius())),
      _ellipsoid(scene.ground().ellipsoid)
{
    _reference = Georeference::create(&node, _referenceError);
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
    const auto isPlace = [](const osg::Vec3d& place)
    {
        return std::abs(place.x()) <= 360.0 && std::abs(place.y()) <= 90.0 && std::isfinite(place.z());
    };
    if (route.places.empty() || !std::all_of(route.places.begin(), route.places.end(), isPlace))
    {
        error = "The way \"" + route.name +
                "\" has no place, or one that is none; give degrees of longitude and latitude, and metres.";
        return false;
    }
    for (const osg::Vec2d& place : route.alongGeodesics())
    {
        osg::Vec3d world;
        if (!worldOf(place.x(), place.y(), world))
        {
            error = "The way \"" + route.name + "\" leaves the terrain's projection; cut it.";
            return false;
        }
        way.world.push_back(world);
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
    effect->setGroundOnly(true); // a wall beside a way is no part of it
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
    Options limited = options;
    if (!(limited.look.groundExtent > 0.0)) limited.look.groundExtent = _groundExtent;
    if (options.onGround && !addMappings(route, way, limited, error)) return false;
    if (route.altitude == RoutePath::CLAMPED || !options.ribbons) return true;
    return addRibbons(route, limited, error);
}

bool SceneRoutes::addMappings(const RoutePath& route, const Way& way, const Options& options,
                              std::string& error)
{
    ProjectiveMappings* const effect = effectFor(way, error);
    if (!effect) return false;
    std::size_t mappings = 0;
    for (const osg::ref_ptr<ProjectiveMappings>& each : _effects)
    {
        for (unsigned int i = 0; i < each->getNumRoutes(); ++i)
            mappings += each->getRoute(i)->getNumMappings();
    }
    if (mappings >= mostMappings)
    {
        error = "the ways have too many places to be shown together; simplify them, or show fewer.";
        return false;
    }
    std::string fault;
    if (route.showOn(*effect, _ellipsoid, _reference, options.look, fault)) return true;
    error = "the way \"" + route.name + "\" cannot be shown: " + fault;
    return false;
}

bool SceneRoutes::addRibbons(const RoutePath& route, const Options& options, std::string& error)
{
    if (!_reference)
    {
        error = _referenceError;
        return false;
    }
    const bool onGround = route.altitude == RoutePath::ABOVE_GROUND;
    if ((onGround || route.extruded) && !_heights)
    {
        std::string fault;
        _heights = Heights::of(_node, _ellipsoid, *_reference, fault);
        if (!_heights && onGround)
        {
            error = "the heights of the way \"" + route.name +
                    "\" count from the ground, and there is none: " + fault;
            return false;
        }
    }
    PathRibbon::Ground ground;
    if (_heights)
        ground = [this](double longitude, double latitude)
        {
            return _heights->at(longitude, latitude);
        };
    // Ways in the air are no ground.
    const auto show = [&](bool on)
    {
        for (const osg::ref_ptr<osg::Node>& each : _ribbons)
            each->setNodeMask(on ? ~0u : 0u);
    };
    show(false);
    const std::vector<osg::ref_ptr<osg::Node>> nodes =
        PathRibbon::nodesOf(route, options.look, *_reference, error, ground);
    show(true);
    for (const osg::ref_ptr<osg::Node>& node : nodes)
        _scene->addChild(node);
    _ribbons.insert(_ribbons.end(), nodes.begin(), nodes.end());
    return !nodes.empty();
}

bool SceneRoutes::add(const std::string& file, const Options& options, std::string& error)
{
    RouteFile request;
    request.file = file;
    request.layer = options.layer;
    if (!request.read(error)) return false;
    _files.insert(_files.end(), request.files.begin(), request.files.end());
    for (const RoutePath& route : request.routes)
    {
        if (add(route, options, error)) continue;
        error.insert(0, file + ": ");
        return false;
    }
    return true;
}

} // namespace osgGeoFX
