// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/panorama/PanoramaComposer.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <string>

namespace osgGeoFX
{

/// The effect of a liberty that PanoramaComposer chose. `geocentric`: TerrainRelief::geocentric.
/// @ingroup viewer
OSGGEOFX_EXPORT osg::ref_ptr<RegionalLiberty> makeLiberty(const PanoramaLiberty& liberty, bool geocentric);

/// The same the other way round, for PanoramaComposer::judge(): what the effect takes at its strength.
/// @ingroup viewer
OSGGEOFX_EXPORT PanoramaLiberty libertyOf(const RegionalLiberty& liberty, bool geocentric);

/** Makes a liberty from one line: "7.66,45.98 radius=6000 enlarge=1.3 turn=10". The center is longitude and latitude in
    degrees on a globe, else the terrain's x and y in metres. The other words are properties of RegionalLiberty; `radius`
    stands for both `across` and `along`. Returns null, with a sentence in `error`, if the line is wrong.
    @ingroup viewer */
OSGGEOFX_EXPORT osg::ref_ptr<RegionalLiberty> parseLiberty(const std::string& text, bool geocentric,
                                                           std::string& error);

/// Adds a liberty to a scene after its other liberties and before its bend or panorama map, wherever these stand.
/// @ingroup viewer
OSGGEOFX_EXPORT void addLiberty(EffectScene& scene, RegionalLiberty& liberty);

} // namespace osgGeoFX
