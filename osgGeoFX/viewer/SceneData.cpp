// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/SceneData.h>

#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>

namespace osgGeoFX
{

bool hasAllData(EffectScene& scene)
{
    if (LayerPlayer* const player = LayerPlayer::of(scene))
    {
        for (unsigned int i = 0; i < player->getNumSequences(); ++i)
            if (!player->getSequence(i)->settled()) return false;
    }
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        const auto* mappings = dynamic_cast<const ProjectiveMappings*>(scene.getEffect(i));
        if (!mappings || !mappings->isActive()) continue;
        for (unsigned int k = 0; k < mappings->getNumRasters(); ++k)
        {
            const PagedRaster& raster = *mappings->getRaster(k);
            if (raster.getMapping()->getEnabled() && !raster.statistics().settled) return false;
        }
    }
    return true;
}

} // namespace osgGeoFX
