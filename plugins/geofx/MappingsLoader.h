// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneLoading.h"

namespace osgGeoFX
{

/// What osgdb_geofxdata is asked for under the name "mappingRaster", and its answer.
struct MappingRasterRequest
{
    std::string file;
    MappingFrame frame;
    bool hasOrigin = true; ///< without, the frame's origin becomes the raster's middle
    MappingRaster::Options options;
    MappingRaster raster;
};

/// Gives the mappings of a scene what only files and the terrain know: pictures, tables, places. Throws SceneFailure.
void loadMappings(const SceneFile& scene, SceneTerrain& terrain);

} // namespace osgGeoFX
