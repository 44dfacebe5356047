// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneReach.h"

#include <algorithm>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

bool isAddress(const std::string& path)
{
    return path.find("://") != std::string::npos;
}

/// Whether an address lies below another one, after ".." in it.
bool isBelow(const std::string& address, const std::string& folder)
{
    const std::size_t start = address.find('/', address.find("://") + 3);
    const std::string root = folder + (folder.back() == '/' ? "" : "/");
    // A server decides what escaped characters mean; ".." may be among them.
    if (start == std::string::npos || address.find('%') != std::string::npos) return false;
    const std::string normal =
        address.substr(0, start) + fs::path(address.substr(start)).lexically_normal().string();
    return normal.compare(0, root.size(), root) == 0;
}

const char* const remedy =
    "put it beside the scene file or below; or, if you trust the scene, start the program with "
    "--allow-outside, or give OSG the option string \"allowOutside\".";

} // namespace

const char* const allowOutside = "allowOutside";

bool isWithin(const std::string& path, const std::string& folder)
{
    if (isAddress(folder)) return isAddress(path) && isBelow(path, folder);
    if (path.rfind("/vsi", 0) == 0 || isAddress(path)) return false;
    std::error_code code;
    const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, code);
    if (code) return false;
    const fs::path real = fs::weakly_canonical(path, code);
    if (code) return false;
    return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
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
