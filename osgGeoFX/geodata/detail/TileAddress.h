// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/** Rasters in square tiles that GDAL reads only through a description of them: addresses with `{z}`, `{x}` and `{y}`, or `{-y}` for rows that
    count from the south, and tile sets with a `tilemapresource.xml`, by that file or by its folder. Both may be in a folder, at a file's path, or on
    a server. Thread-safe. */
struct TileAddress
{
    /// Whether a name is such an address, or has such a file. Of names that are addresses nothing is fetched.
    static bool is(const std::string& name);

    /** The name by which GDAL opens a raster: a description for its driver of services, or else the name itself.

        An address has the tiles of web maps (EPSG:3857, 256 pixels a side): in a folder down to the deepest level there is, on a server down to
        level 18. `{s}` becomes the subdomain `a`, and `{r}` nothing. Throws BuildError for a tilemapresource.xml that cannot be used. */
    static std::string forGdal(const std::string& name);
};

} // namespace osgGeoFX
