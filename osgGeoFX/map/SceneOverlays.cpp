// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/SceneOverlays.h>

#include <osgGeoFX/map/OverlayFile.h>
#include <osgGeoFX/map/detail/SceneCrs.h>

#include <utility>

namespace osgGeoFX
{

SceneOverlays::SceneOverlays(osg::Node& node, EffectScene& scene) : _scene(&scene)
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
    request.maxSide = options.maxSide;
    request.paged = options.paged;
    request.globe = _scene->ground().ellipsoid.valid();
    request.wkt = _wkt;
    for (const osg::ref_ptr<ProjectiveMappings>& effect : _effects)
        request.frames.push_back(effect->getLocalOrigin());
    if (!request.read(error)) return false;

    std::vector<std::pair<std::size_t, osg::ref_ptr<ProjectiveMapping>>> mappings;
    std::vector<std::pair<std::size_t, osg::ref_ptr<PagedRaster>>> rasters;
    for (const GroundOverlay& overlay : request.overlays)
    {
        if (overlay.tiles)
        {
            const osg::ref_ptr<PagedRaster> raster =
                PagedRaster::create(overlay.tiles, options.paging, error);
            if (!raster) return false;
            overlay.setLook(*raster->getMapping());
            rasters.emplace_back(overlay.frame, raster);
            continue;
        }
        const osg::ref_ptr<ProjectiveMapping> mapping = overlay.makeMapping();
        if (!mapping)
        {
            error = file + ": the overlay \"" + overlay.name +
                    "\" covers no area on the ground; correct its corners.";
            return false;
        }
        mappings.emplace_back(overlay.frame, mapping);
    }
    while (_effects.size() < request.frames.size())
    {
        const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
        effect->setName("overlays");
        effect->setLocalOrigin(request.frames[_effects.size()]);
        _scene->addEffect(effect);
        _effects.push_back(effect);
    }
    for (const auto& [frame, mapping] : mappings)
        _effects[frame]->addMapping(mapping);
    for (const auto& [frame, raster] : rasters)
        _effects[frame]->addRaster(raster);
    _files.insert(_files.end(), request.files.begin(), request.files.end());
    notices.insert(notices.end(), request.notices.begin(), request.notices.end());
    return true;
}

} // namespace osgGeoFX
