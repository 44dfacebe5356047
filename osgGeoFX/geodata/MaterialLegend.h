// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/panorama/MaterialCover.h>

#include <osg/ref_ptr>

#include <string>

namespace osgGeoFX
{

/// What lies on materials that bear the names of a land-cover table's classes. With "flightgear", they are those of
/// FlightGear's terrain. `file` and errors are those of readLandCoverTable(). `unit`: the texture unit, as
/// PanoramaMap::coverUnit has it. Thread-safe.
/// @ingroup geodata
OSGGEOFXDATA_EXPORT osg::ref_ptr<MaterialCover> readMaterialCover(const std::string& file,
                                                                  unsigned int unit = 7);

} // namespace osgGeoFX
