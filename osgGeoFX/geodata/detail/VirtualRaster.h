// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// Puts a virtual dataset on top of the chain, as gdal_translate makes it of the one below with these arguments. False where it makes
/// none; GDAL has said why then.
bool addVirtualRaster(DatasetChain& chain, const std::vector<std::string>& arguments);

/// Does so for a raster with this name. Throws BuildError, naming it and the remedy, where GDAL makes none.
void addVirtualRaster(DatasetChain& chain, const std::vector<std::string>& arguments,
                      const std::string& name);

} // namespace osgGeoFX
