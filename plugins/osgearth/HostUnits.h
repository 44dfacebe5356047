// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osgEarth/TerrainResources>

#include <list>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Texture units of osgEarth's that a scene's effects may have. They are given back with this object.
class HostUnits
{
public:
    /** Reserves the units that the effects of a scene ask for, and gives them to the scene. A panorama map's coverUnit is
        one of them, since osgEarth's tiles have no such texture and may have another one at that unit. False, with a
        sentence in `error`, where osgEarth has too few left; the scene leaves effects out then. */
    bool reserve(osgEarth::TerrainResources& resources, EffectScene& scene, std::string& error);

private:
    /// The next free unit that a scene may have; −1 if there is none.
    int next(osgEarth::TerrainResources& resources);

    std::list<osgEarth::TextureImageUnitReservation> _reserved; ///< they cannot be copied
};

} // namespace osgGeoFX
