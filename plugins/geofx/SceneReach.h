// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneFile.h"

#include <osgDB/Options>

namespace osgGeoFX
{

/* A scene is often somebody else's, so it may name files beside itself and below, and nothing else: no other folder, no link that
   leads to one, no address, none of GDAL's file systems and services. A program consents to more with the option string
   "allowOutside". What files hold in their turn is followed as far as GDAL tells (sourcesOf()). The database, its tiles and the scene's
   pictures are read through FilesByOthers. */

/// The option string by which a program consents.
extern const char* const allowOutside;

/// Whether the options hold the program's consent.
bool isAllowedOutside(const osgDB::Options* options);

/// FilesByOthers::isWithin().
bool isWithin(const std::string& path, const std::string& folder);

/// One sentence for each path that leads out of the scene's folder, the cache among them.
std::vector<std::string> outsidePaths(const SceneFile& scene, const std::string& folder);

/// One sentence for each file of a scene on a web server that is not fetched from there: all but the database.
std::vector<std::string> unfetchedPaths(const SceneFile& scene);

/// One sentence for each file of the scene that takes its data from outside the folder, such as a GDAL virtual raster. They are asked
/// of osgdb_geofxdata; without it nothing is known, and nothing of the kind can be read.
std::vector<std::string> outsideSources(const SceneFile& scene, const std::string& folder);

/// The text of a scene's file; longer than largestScene where the file is. Empty where it cannot be read.
std::string readSceneText(const std::string& path);

/// One sentence for each file of the scene that cannot be used: outside the folder without the program's consent in the
/// options, or missing. Files that lie elsewhere are not even looked for.
std::vector<std::string> faultsOfFiles(const SceneFile& scene, const std::string& folder,
                                       const osgDB::Options* options);

} // namespace osgGeoFX
