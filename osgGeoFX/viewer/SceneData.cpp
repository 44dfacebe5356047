// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/SceneData.h>

#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <algorithm>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// The shown rasters that are larger than memory.
std::vector<const PagedRaster*> rastersOf(EffectScene& scene)
{
    std::vector<const PagedRaster*> rasters;
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        const auto* mappings = dynamic_cast<const ProjectiveMappings*>(scene.getEffect(i));
        if (!mappings || !mappings->isActive()) continue;
        for (unsigned int k = 0; k < mappings->getNumRasters(); ++k)
            if (mappings->getRaster(k)->getMapping()->getEnabled()) rasters.push_back(mappings->getRaster(k));
    }
    return rasters;
}

} // namespace

bool hasAllData(EffectScene& scene)
{
    if (LayerPlayer* const player = LayerPlayer::of(scene))
    {
        for (unsigned int i = 0; i < player->getNumSequences(); ++i)
            if (!player->getSequence(i)->settled()) return false;
    }
    const std::vector<const PagedRaster*> rasters = rastersOf(scene);
    return std::all_of(rasters.begin(), rasters.end(),
                       [](const PagedRaster* raster) { return raster->statistics().settled; });
}

std::string faultOfData(EffectScene& scene)
{
    for (const PagedRaster* const raster : rastersOf(scene))
    {
        const std::string fault = raster->statistics().fault;
        if (!fault.empty()) return fault;
    }
    return {};
}

} // namespace osgGeoFX
