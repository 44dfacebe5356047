// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneReach.h"

#include <osgGeoFX/paging/FilesByOthers.h>

#include <sstream>

namespace osgGeoFX
{

namespace
{

const char* const remedy =
    "put it beside the scene file or below; or, if you trust the scene, start the program with "
    "--allow-outside, or give OSG the option string \"allowOutside\".";

} // namespace

const char* const allowOutside = "allowOutside";

bool isAllowedOutside(const osgDB::Options* options)
{
    std::istringstream words(options ? options->getOptionString() : std::string());
    for (std::string word; words >> word;)
        if (word == allowOutside) return true;
    return false;
}

bool isWithin(const std::string& path, const std::string& folder)
{
    return FilesByOthers::isWithin(path, folder);
}

std::vector<std::string> unfetchedPaths(const SceneFile& scene)
{
    std::vector<std::string> errors;
    for (const ScenePath& path : filesOf(scene))
    {
        if (scene.database && path.path == scene.database->path) continue;
        errors.push_back(path.place.message(path.attribute + "=\"" + path.path +
                                            "\" is not fetched: of the files that a scene on a web server "
                                            "names, only the <database> is; build "
                                            "rasters into a database with osggeofx_build, or copy the scene "
                                            "and its files onto this machine."));
    }
    if (scene.rasters && errors.empty())
        errors.push_back(scene.rasters->place.message("a scene on a web server needs a <database>."));
    return errors;
}

std::vector<std::string> outsidePaths(const SceneFile& scene, const std::string& folder)
{
    std::vector<ScenePath> paths = filesOf(scene);
    if (scene.rasters && !scene.rasters->cache.empty())
        paths.push_back({scene.rasters->cache, scene.rasters->place, "cache"});
    std::vector<std::string> errors;
    for (const ScenePath& path : paths)
    {
        if (isWithin(path.path, folder)) continue;
        errors.push_back(path.place.message(path.attribute + "=\"" + path.path +
                                            "\" leads out of the scene's folder; " + remedy));
    }
    return errors;
}

} // namespace osgGeoFX
