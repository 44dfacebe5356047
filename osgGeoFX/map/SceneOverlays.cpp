// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/SceneOverlays.h>

#include <osgGeoFX/map/OverlayFile.h>
#include <osgGeoFX/map/detail/SceneCrs.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/BoundingSphere>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Around the rectangle of an overlay in the frame of an origin, world coordinates.
osg::BoundingSphered sphereOf(const GroundOverlay& overlay, const LocalOrigin& origin,
                              const osg::EllipsoidModel* ellipsoid)
{
    const osg::Matrixd toWorld = origin.toWorld(ellipsoid);
    osg::BoundingSphered sphere;
    for (const osg::Vec2d& corner : overlay.corners)
    {
        // The ground falls away from the frame's plane.
        const double radius = osg::WGS_84_RADIUS_EQUATOR;
        const double down =
            ellipsoid ? std::sqrt(std::max(radius * radius - corner.length2(), 0.0)) - radius : 0.0;
        sphere.expandBy(osg::Vec3d(corner, down) * toWorld);
    }
    return sphere;
}

} // namespace

SceneOverlays::SceneOverlays(osg::Node& node, EffectScene& scene) : _node(node), _scene(&scene)
{
    if (!scene.ground().ellipsoid) _wkt = crsOfScene(node);
}

bool SceneOverlays::add(const std::string& file, const Options& options, std::vector<std::string>& notices,
                        std::string& error)
{
    OverlayFile request;
    request.file = file;
    request.allowOutside = options.allowOutside;
    request.colors = options.colors;
    request.layer = options.layer;
    request.style = options.style;
    request.bands = options.bands;
    request.maxSide = options.maxSide;
    request.paged = options.paged;
    request.globe = _scene->ground().ellipsoid.valid();
    request.wkt = _wkt;
    for (const osg::ref_ptr<ProjectiveMappings>& effect : _effects)
        request.frames.push_back(effect->getLocalOrigin());
    const osg::BoundingSphere bound = _node.getBound();
    const osg::BoundingSphered ground(bound.center(), static_cast<double>(bound.radius()));
    if (request.globe) request.ground = ground;
    if (!request.read(error)) return false;

    const osg::ref_ptr<const osg::EllipsoidModel> ellipsoid = _scene->ground().ellipsoid;
    const bool isBeside = std::none_of(
        request.overlays.begin(), request.overlays.end(),
        [&](const GroundOverlay& overlay)
        { return ground.intersects(sphereOf(overlay, request.frames[overlay.frame], ellipsoid)); });
    if (isBeside && ground.valid())
        notices.push_back(file +
                          ": it lies beside the terrain, so that nothing of it is seen; check its coordinate "
                          "reference system, or whether it is the right file.");
    giveHeights(request);
    // The parts of one file share its memory.
    const auto tiled = std::count_if(request.overlays.begin(), request.overlays.end(),
                                     [](const GroundOverlay& overlay) { return overlay.tiles.valid(); });
    PagedRaster::Options paging = options.paging;
    paging.megabytes = std::max(32, paging.megabytes / std::max(1, static_cast<int>(tiled)));
    struct Part
    {
        osg::ref_ptr<ProjectiveMapping> mapping;
        osg::ref_ptr<PagedRaster> raster; ///< in its place
        std::size_t frame = 0;
    };
    std::vector<Part> parts;
    for (const GroundOverlay& overlay : request.overlays)
    {
        Part part{nullptr, nullptr, overlay.frame};
        if (overlay.tiles)
        {
            part.raster = PagedRaster::create(overlay.tiles, paging, error);
            if (!part.raster) return false;
            overlay.setLook(*part.raster->getMapping());
        }
        else
            part.mapping = overlay.makeMapping();
        if (!part.raster && !part.mapping)
        {
            error = file + ": the overlay \"" + overlay.name +
                    "\" covers no area on the ground; correct its corners.";
            return false;
        }
        parts.push_back(part);
    }
    while (_effects.size() < request.frames.size())
    {
        const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
        effect->setName("overlays");
        effect->setLocalOrigin(request.frames[_effects.size()]);
        _scene->addEffect(effect);
        _effects.push_back(effect);
    }
    for (const Part& part : parts)
    {
        if (part.raster)
            _effects[part.frame]->addRaster(part.raster);
        else
            _effects[part.frame]->addMapping(part.mapping);
    }
    _files.insert(_files.end(), request.files.begin(), request.files.end());
    notices.insert(notices.end(), request.notices.begin(), request.notices.end());
    return true;
}

void SceneOverlays::giveHeights(OverlayFile& request) const
{
    const bool any =
        std::any_of(request.overlays.begin(), request.overlays.end(),
                    [](const GroundOverlay& each) { return each.symbol && !each.symbol->height; });
    if (!any) return;
    constexpr int cells = 512;
    std::string error;
    const std::optional<TerrainRelief> relief =
        TerrainRelief::read(_node, _scene->ground().ellipsoid, cells, error);
    if (!relief) return;
    for (GroundOverlay& each : request.overlays)
    {
        if (!each.symbol || each.symbol->height) continue;
        osg::Vec2d place(each.symbol->longitude, each.symbol->latitude);
        if (!relief->geocentric)
            place = (each.corners[0] + each.corners[2]) / 2.0 + request.frames[each.frame].place();
        const double height = relief->heightAt(place.x(), place.y());
        if (std::isfinite(height)) each.symbol->height = height;
    }
}

} // namespace osgGeoFX
