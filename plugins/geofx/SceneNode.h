// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneFile.h"

#include <osg/Group>

namespace osgGeoFX
{

/// Gives an EffectScene the effects of a scene, with what only files and the terrain know. The terrain is a child of the node
/// already. False, with a sentence in `error`, where something is missing.
bool addEffects(const SceneFile& scene, EffectScene& node, const osg::Node& terrain, std::string& error);

/** The node of a scene: a group named "osgGeoFX scene" with the terrain and, for a sun, a directional light
   with number 0, which takes the place of a viewer's headlight. Where the scene has effects, names, lines or a sky, the group is an
   EffectScene. Where it has lines, they are below the EffectScene; where it has names, the node is a group of the EffectScene and the
   names (MapLabels), for names stand beside the scene.

    For programs it carries user values: string "geofx.homeView" = "LON,LAT,HEIGHT,HEADING,PITCH,ROLL" (degrees
   and metres), double "geofx.homeFov" (vertical, degrees; only where the scene says it), string
   "geofx.background" = "R,G,B" (0…1), bool "geofx.hasLight" = true where there is a sun, double
   "geofx.visibility" (metres; only where there is haze), bool
   "geofx.hasSky" = true where there is a sky, which is beside the rest in a group of both.

    Mappings get their pictures, tables and places here.

    Null, with a sentence in `error`, where the sun's direction cannot be told, where a sky has no round Earth, or where a mapping or
   the map lacks something. */
osg::ref_ptr<osg::Group> createSceneNode(const SceneFile& scene, osg::Node* terrain, std::string& error);

} // namespace osgGeoFX
