// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneLoading.h"

namespace osgGeoFX
{

/// What osgdb_geofxdata is asked for under the name "strokeVectors", and its answer.
struct StrokeVectorsRequest
{
    std::string file, layer;
    StrokeLines::Kind kind = StrokeLines::ROAD;
    MappingFrame frame;
    std::vector<StrokeLines::Line> lines;
    bool done = false;
};

/// Gives the panorama maps of a scene the pictures and vector data that it names. Throws SceneFailure.
void loadPanoramas(const SceneFile& scene, SceneTerrain& terrain);

} // namespace osgGeoFX
