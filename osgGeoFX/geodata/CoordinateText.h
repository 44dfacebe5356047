// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>

class OGRSpatialReference;

namespace osgGeoFX
{

/** Sets a coordinate system from a text that may be somebody else's: WKT, PROJJSON, a PROJ string (`+proj=…`), or
    `AUTHORITY:CODE` such as EPSG:32604, EPSG:32604+5773 or ESRI:102007. Nothing is fetched, and no file is read but those of PROJ itself.
    False, and nothing is set, for all other texts: addresses, names of files, texts that name files of grids by their paths.
    Thread-safe for different objects.
    @ingroup geodata */
OSGGEOFXDATA_EXPORT bool setCoordinateSystem(OGRSpatialReference& system, const std::string& text);

} // namespace osgGeoFX
