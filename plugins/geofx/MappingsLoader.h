// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneLoading.h"

#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/mapping/GroundOverlay.h>
#include <osgGeoFX/mapping/LayerSequence.h>

#include <osg/BoundingSphere>

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

/// What osgdb_geofxdata is asked for under the name "sceneOverlays", and its answer.
struct SceneOverlaysRequest
{
    std::string file;
    bool globe = true;
    std::string wkt;
    std::string colors;
    std::string layer, style;         ///< of vector data
    std::optional<RasterBands> bands; ///< of rasters
    osg::BoundingSphered ground;      ///< OverlayReader::Options::ground
    int maxSide = 0;
    double maxTexels = 0.0;                      ///< of KML's pictures together
    OverlayRaster::Pictures* pictures = nullptr; ///< of the scene's KML files
    std::vector<LocalOrigin> frames;             ///< those that there are; grows
    std::vector<GroundOverlay> overlays;
    std::vector<std::string> notices;
};

/// What osgdb_geofxdata is asked for under the name "sceneSequence", and its answer.
struct SceneSequenceRequest
{
    std::string file; ///< with the variable behind a colon
    std::string colors;
    int maxSide = 0;
    std::optional<RasterBands> bands;
    bool globe = true;
    std::string wkt;
    bool moves = true; ///< the frame's origin becomes the rasters' middle
    LocalOrigin origin;
    osg::ref_ptr<SequenceSteps> steps;
    osg::Vec2d low, high;
    double lowest = 0.0, highest = 0.0;
    osg::ref_ptr<ColorTable> table;
    std::string variable, unit;
};

/// What osgdb_geofxdata is asked for under the name "sceneRoutes", and its answer.
struct SceneRoutesRequest
{
    std::string file;
    std::string layer;
    std::vector<RoutePath> routes;
};

/// What osgdb_geofxdata is asked for under the name "colors", and its answer: an SLD file's.
struct ColorsRequest
{
    std::string file;
    osg::ref_ptr<ColorTable> table;
};

/// Gives the mappings of a scene what only files and the terrain know: pictures, tables, places. Throws SceneFailure.
/// `node` gets what is no mapping: ways in the air.
void loadMappings(const SceneFile& scene, SceneTerrain& terrain, EffectScene& node);

} // namespace osgGeoFX
