// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/LayerSource.h>
#include <osgGeoFX/mapping/RasterTiles.h>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <string>

namespace osgGeoFX
{

/// What osgdb_geofxdata is asked for under the name "layerSteps", and its answer.
struct LayerStepsRequest
{
    LayerSource source;
    osg::ref_ptr<SequenceSteps> steps;
};

/// The same for "layerTiles".
struct LayerTilesRequest
{
    LayerSource source;
    osg::ref_ptr<RasterTiles> tiles;
};

/// False, with a sentence in `error`, if the plugin is not there or cannot open the file.
bool askForLayer(const std::string& service, void* request, std::string& error);

void writeSource(osgDB::OutputStream& stream, const LayerSource& source);
LayerSource readSource(osgDB::InputStream& stream);

} // namespace osgGeoFX
