// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <string>
#include <utility>

namespace osgGeoFX
{

/** A raster by the name that people give it: a file, one of GDAL's names, or a variable or table of a file, "FILE:VARIABLE". Behind a variable
    brackets choose among times, levels and other dimensions, by their values: "f.nc:t[level=500]". */
struct RasterFile
{
    /// "FILE" or "FILE:VARIABLE" in two parts. Names of GDAL's own, such as `NETCDF:"FILE":VARIABLE` and addresses, are left whole.
    static std::pair<std::string, std::string> parse(const std::string& name);

    /** The file, with virtual datasets on top that choose its first step of time, level or field where it has several, and name WGS 84 where it has
        degrees along both axes and no coordinate reference system. A warning states both, once. Throws BuildError, naming file and remedy, where it
        is no raster. `options`: open options of GDAL; may be null. */
    static DatasetChain open(const std::string& name, const char* const* options = nullptr);

    /// The raster as GDAL has it, with all its bands. `name`: one that GDAL knows. Throws BuildError, naming file and remedy, where it is none.
    static DatasetPtr openPlain(const std::string& name, const char* const* options = nullptr);

    /// Whether GDAL opens a file as a raster, or as several.
    static bool isRaster(const std::string& file);

    /// Whether places of the raster's pixels are in arrays of their own, as of a curved grid, which GDAL's transformers go by.
    static bool hasPlaces(GDALDataset& raster);

    /// The warning of a file whose axes have degrees.
    static void remarkDegrees(const std::string& name);
};

} // namespace osgGeoFX
