// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneLoading.h"
#include "SceneReach.h"

#include <osgGeoFX/map/SourceFiles.h>
#include <osgGeoFX/paging/RemoteFiles.h>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/fstream>

#include <map>
#include <set>

namespace osgGeoFX
{

namespace
{

/// Virtual files upon virtual files; more than these are no person's.
constexpr std::size_t mostFiles = 10000;

/// The files in a folder of rasters; none of a Zarr, which takes data from nowhere else.
std::vector<std::string> filesIn(const std::string& folder)
{
    std::vector<std::string> files;
    if (osgDB::fileType(folder) != osgDB::DIRECTORY) return files;
    for (const std::string& name : osgDB::getDirectoryContents(folder))
    {
        if (name == ".zgroup" || name == ".zarray" || name == ".zmetadata") return {};
        const std::string file = osgDB::concatPaths(folder, name);
        if (osgDB::fileType(file) == osgDB::REGULAR_FILE) files.push_back(file);
    }
    return files;
}

/// What keeps a file from being read; empty where all that it takes its data from lies within the folder.
std::string faultOf(const std::string& file, const std::string& folder)
{
    std::set<std::string> known{file};
    std::vector<std::string> open{file};
    for (const std::string& each : filesIn(file))
    {
        known.insert(each);
        open.push_back(each);
    }
    while (!open.empty())
    {
        SourceFiles request;
        request.file = open.back();
        open.pop_back();
        SceneTerrain::askIfAny("sources", &request);
        if (!request.service.empty()) return "takes its data from elsewhere (" + request.service + ")";
        for (const std::string& source : request.files)
        {
            if (!isWithin(source, folder)) return "takes data from \"" + source + "\"";
            if (known.insert(source).second) open.push_back(source);
        }
        if (known.size() > mostFiles) return "takes its data from more than 10,000 files";
    }
    return {};
}

} // namespace

std::vector<std::string> outsideSources(const SceneFile& scene, const std::string& folder)
{
    std::vector<std::string> errors;
    std::map<std::string, std::string> faults; // of each file once
    for (const ScenePath& path : filesOf(scene))
    {
        // GDAL does not read databases.
        if (scene.database && path.path == scene.database->path) continue;
        const auto [known, isNew] = faults.emplace(osgDB::getRealPath(path.path), std::string());
        if (isNew) known->second = faultOf(path.path, folder);
        const std::string& fault = known->second;
        if (fault.empty()) continue;
        errors.push_back(path.place.message("the file \"" + path.path + "\" " + fault +
                                            ", which lies outside the scene's folder; convert it to GeoTIFF "
                                            "with gdal_translate (vector data: to "
                                            "GeoPackage with ogr2ogr); or, if you trust the scene, start the "
                                            "program with --allow-outside, or give "
                                            "OSG the option string \"allowOutside\"."));
    }
    return errors;
}

std::string readSceneText(const std::string& path)
{
    osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
    std::string text(largestScene + 1, '\0'); // one more: what is too long is seen to be
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
}

std::vector<std::string> faultsOfFiles(const SceneFile& scene, const std::string& folder,
                                       const osgDB::Options* options)
{
    const bool anywhere = isAllowedOutside(options);
    std::vector<std::string> errors;
    if (!anywhere) errors = outsidePaths(scene, folder);
    if (!errors.empty()) return errors;
    if (RemoteFiles::isRemote(folder)) return unfetchedPaths(scene);
    errors = missingFiles(scene);
    if (errors.empty() && !anywhere) errors = outsideSources(scene, folder);
    return errors;
}

} // namespace osgGeoFX
