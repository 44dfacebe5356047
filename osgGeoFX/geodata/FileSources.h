// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** The files and services from which a raster or vector file takes its data, as far as GDAL can tell without reading
    the data. Examples are the files that a virtual raster names, an image's world file, the parts of a shapefile, or a
    service that the file describes. Nothing is fetched from a network. Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT FileSources
{
    /// Paths are complete; GDAL's own names (`/vsi…`, `PG:…`, network addresses) are unchanged. Sources of these
    /// sources are not listed.
    std::vector<std::string> files;
    /// The format's short name if the data are in a network or a database: "WMS", "PostGISRaster", …
    std::string service;

    /// Both members are empty for a file that GDAL does not know.
    static FileSources of(const std::string& file);
};

} // namespace osgGeoFX
