// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Where a raster or vector file takes its data from, as far as GDAL tells without reading them: the files that a virtual raster
    names, an image's world file, the layers of a shapefile; or a service, which the file only describes. Nothing is fetched
    from a network to find out. Thread-safe. */
struct OSGGEOFXDATA_EXPORT FileSources
{
    /// Complete paths where they are paths; GDAL's own names (`/vsi…`, `PG:…`, addresses) as they stand. Sources of sources are not
    /// among them.
    std::vector<std::string> files;
    /// The format's name, where the data lie in a network or a data base: "WMS", "PostGISRaster", …
    std::string service;

    /// Both are empty for a file that GDAL does not know.
    static FileSources of(const std::string& file);
};

} // namespace osgGeoFX
