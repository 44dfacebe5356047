// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/RandomSamples.h>

#include <osg/Matrixd>
#include <osgGeoFX/viewer/Scene.h>

#include <optional>
#include <ostream>
#include <string>

namespace geofx::test
{

/// A database of Oahu, "oahu" (geocentric) or "oahu_projected", as the fixture oahu_database builds them. Nothing, after a
/// failure of the test, where it is not there.
std::optional<osgGeoFX::Scene> loadOahu(const std::string& name);

/// Perspective mostly, of any field of view and aspect; some off axis, some orthographic.
osg::Matrixd randomProjection(Random& random);

/// A camera over Oahu, world to eye: 100 m to 30 km high, some rolled, some looking straight down.
osg::Matrixd randomOahuView(Random& random, const osgGeoFX::Georeference& reference);

/// Puts random effects in the place of a scene's: each kind alone, and bends after exaggeration.
void addRandomEffects(osgGeoFX::EffectScene& scene, Random& random);

/// Puts a random panorama map in the place of a scene's effects: the projection alone, or with all that it paints.
void addRandomPanorama(osgGeoFX::EffectScene& scene, Random& random);
void addRandomPainting(osgGeoFX::EffectScene& scene, Random& random);

/// Puts some random liberties with regions of Oahu in the place of a scene's effects, often before a bend or the projection
/// of a panorama map.
void addRandomLiberties(osgGeoFX::EffectScene& scene, Random& random);

/// A parameter of tests: which effects, of which database.
struct OahuCase
{
    const char* name;
    const char* database;
    void (*addEffects)(osgGeoFX::EffectScene& scene, Random& random);
    int few, many; ///< cameras on each change, and in ./tests/run --full
};

inline std::ostream& operator<<(std::ostream& out, const OahuCase& each)
{
    return out << each.name;
}

} // namespace geofx::test
