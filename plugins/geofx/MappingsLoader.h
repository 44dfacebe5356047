// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneFile.h"

#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/scene/EffectScene.h>

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

/** Gives the mappings of a scene what only files and the terrain know: pictures, tables, places. The terrain is a child
    of the scene's node already. False, with a sentence in `error`. */
bool loadMappings(const SceneFile& scene, const EffectScene& node, const osg::Node& terrain,
                  std::string& error);

} // namespace osgGeoFX
