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
    service that the file describes. Nothing is fetched from a network, and files that FilesByOthers::Scope does not reach are not
    looked at. Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT FileSources
{
    /// Paths are complete; GDAL's own names (`/vsi…`, `PG:…`, network addresses) are unchanged. Sources of these
    /// sources are not listed.
    std::vector<std::string> files;
    /// The format's short name if the data are in a network or a database: "WMS", "PostGISRaster", …
    std::string service;

    /// Both members are empty for a file that GDAL does not know. Of a file whose format isFormatByOthers() does not know, only the
    /// service is found.
    static FileSources of(const std::string& file);

    /** Whether files by others (FilesByOthers::Scope) may have a format, by GDAL's short name. Left out are formats whose drivers fetch
        addresses, run programs, write files, or open files by other ways than GDAL's file systems: netCDF is read only in its classic
        format, not upon HDF5, for HDF5's files name others. */
    static bool isFormatByOthers(const std::string& format);
};

} // namespace osgGeoFX
