// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneLoading.h"

namespace osgGeoFX
{

/// What osgdb_geofxmaps is asked for under the name "map", and its answer: the names and lines of a scene.
struct MapRequest
{
    const SceneMap* map = nullptr;
    EffectScene* scene = nullptr;     ///< with its terrain; it gets the lines
    osg::ref_ptr<osg::Node> names;    ///< to stand beside the scene; null where there are none
    std::vector<std::string> notices; ///< what people should know, as sentences
    ScenePlace fault;                 ///< where the reason of a failure is
    bool done = false;
};

/// What osgdb_geofxmaps is asked for under the name "wayInAir": a way whose heights or curtain count from the ground. The scene gets its nodes.
struct WayInAirRequest
{
    RoutePath path;
    RoutePath::Look look;
    EffectScene* scene = nullptr; ///< with its terrain
    bool done = false;
};

/// Puts such a way into the scene. Throws SceneFailure.
void loadWayInAir(const ScenePlace& place, const RoutePath& path, const RoutePath::Look& look,
                  EffectScene& scene);

/// Puts the lines of a scene file into the scene. The node of its names, to stand beside the scene; null if there are none. Throws
/// SceneFailure.
osg::ref_ptr<osg::Node> loadMap(const SceneMap& map, EffectScene& scene);

} // namespace osgGeoFX
