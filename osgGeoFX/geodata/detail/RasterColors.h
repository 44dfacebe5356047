// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <string>

namespace osgGeoFX
{

/** The colors of a raster, in one place for all that read them.

    Red, green and blue are the bands that have this color interpretation, else those with these names, else the first three. One band, or
    one with alpha, is grey. Bytes stay as they are. Of larger numbers 2 to 98 % go from black to white, the same for all three bands, unless
    they fill half of their range (that of the type, or of the metadata item NBITS) already: then it is their whole range. */
struct RasterColors
{
    /// Whether a raster of unknown kind is a picture: one that has a palette, bands of red, green and blue, or at least three of bytes or of
    /// unsigned numbers with 16 bits.
    static bool areIn(GDALDataset& raster);

    /// Puts red, green, blue and alpha, bytes, on top of a chain. `bands`: what is wanted, and then what was taken. Says in a line what was
    /// guessed. `file` is for messages. Throws BuildError.
    static void add(DatasetChain& chain, RasterBands& bands, const std::string& file);
};

} // namespace osgGeoFX
