// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>

namespace osgGeoFX
{

/// How far a raster reaches on the globe. Throws BuildError, naming file and remedy, where no part of it lies there.
GroundReach reachOf(const FrameRaster& raster);

} // namespace osgGeoFX
