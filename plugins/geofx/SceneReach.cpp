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

const char* const remedy =
    "put it beside the scene file or below; or, if you trust the scene, start the program with "
    "--allow-outside, or give OSG the option string \"allowOutside\".";

} // namespace

const char* const allowOutside = "allowOutside";

bool isWithin(const std::string& path, const std::string& folder)
{
    if (path.rfind("/vsi", 0) == 0 || path.find("://") != std::string::npos) return false;
    std::error_code code;
    const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, code);
    if (code) return false;
    const fs::path real = fs::weakly_canonical(path, code);
    if (code) return false;
    return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
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
