// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneLoading.h"

namespace osgGeoFX
{

/// What osgdb_geofxdata is asked for under the name "surfaceData": one more picture of a file, or the first ones of a DEM.
struct SurfaceRequest
{
    const SceneSurface* surface = nullptr; ///< anything but DERIVED
    MappingFrame frame;
    osg::Vec2d low,
        high; ///< of a DEM, metres in the frame; where they are equal, all of it, about its own middle
    int maxSide = 0;
    double radius = 0.0;
    osg::ref_ptr<SurfaceData> data; ///< what gets the picture; of a DEM, the answer
    bool done = false;
};

/// Gives the close-ups of a scene what only files and the terrain know: surface data, tables, masks, places. Throws
/// SceneFailure.
void loadCloseUps(const SceneFile& scene, SceneTerrain& terrain);

} // namespace osgGeoFX
