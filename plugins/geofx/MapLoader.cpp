// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MapLoader.h"

namespace osgGeoFX
{

void loadWayInAir(const ScenePlace& place, const RoutePath& path, const RoutePath::Look& look,
                  EffectScene& scene)
{
    WayInAirRequest request{path, look, &scene, false};
    const std::optional<std::string> answer = SceneTerrain::askIfAny("wayInAir", &request, "geofxmaps");
    if (!answer)
        fail(place,
             "ways whose heights count from the ground need the OSG plugin osgdb_geofxmaps, which was not "
             "found or lacks its libraries (osgGeoFXMaps, Pango); put its folder on OSG_LIBRARY_PATH, or "
             "write inAir=\"false\".");
    if (!request.done) fail(place, *answer);
}

osg::ref_ptr<osg::Node> loadMap(const SceneMap& map, EffectScene& scene)
{
    MapRequest request;
    request.map = &map;
    request.scene = &scene;
    request.fault = map.place;
    const std::optional<std::string> answer = SceneTerrain::askIfAny("map", &request, "geofxmaps");
    if (!answer)
        fail(map.place,
             "names and lines are put onto scenes by the OSG plugin osgdb_geofxmaps, which was not found or "
             "lacks its libraries (osgGeoFXMaps, Pango); put its folder on OSG_LIBRARY_PATH, or leave the "
             "<map> "
             "out.");
    if (!request.done) fail(request.fault, *answer);
    for (const std::string& notice : request.notices)
        warn(map.place, notice);
    return request.names;
}

} // namespace osgGeoFX
