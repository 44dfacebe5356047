// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "HostUnits.h"

#include <osgGeoFX/effect/TextureUnits.h>

namespace osgGeoFX
{

int HostUnits::next(osgEarth::TerrainResources& resources)
{
    std::list<osgEarth::TextureImageUnitReservation> notForScenes;
    while (true)
    {
        std::list<osgEarth::TextureImageUnitReservation> one(1);
        if (!resources.reserveTextureImageUnit(one.front(), "osgGeoFX")) return -1;
        const int unit = one.front().unit();
        const bool fits =
            unit >= TextureUnits::first && unit <= TextureUnits::last && unit != TextureUnits::ofCover;
        std::list<osgEarth::TextureImageUnitReservation>& kept = fits ? _reserved : notForScenes;
        kept.splice(kept.end(), one);
        if (fits) return unit;
    }
}

bool HostUnits::reserve(osgEarth::TerrainResources& resources, EffectScene& scene, std::string& error)
{
    std::vector<int> units;
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        Effect& effect = *scene.getEffect(i);
        const auto* user = dynamic_cast<const TextureUser*>(&effect);
        if (!user) continue;
        for (const TextureUnitWish& wish : user->textureUnits())
        {
            // A unit that the file names is the author's own choice.
            if (wish.unit >= 0 && !wish.ofTerrain) continue;
            const int unit = next(resources);
            if (unit < 0)
            {
                error = "osgEarth has too few texture units left for the effects of <geofx>; leave effects "
                        "out, or layers of the map that have textures of their own.";
                break;
            }
            // osgEarth's tiles do not say what lies on the ground, so any unit does for that, which nobody else uses.
            if (!wish.ofTerrain)
                units.push_back(unit);
            else if (!effect.setProperty(wish.property, unit, error))
                break;
        }
    }
    return scene.setTextureUnits(units) && error.empty();
}

} // namespace osgGeoFX
