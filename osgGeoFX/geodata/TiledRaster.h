// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/mapping/RasterTiles.h>

#include <optional>
#include <string>

namespace osgGeoFX
{

/** Any raster that GDAL opens as tiles for a PagedRaster, warped into the frame of mappings part by part. It accepts what
    MappingRaster accepts. Of a raster that reaches around the globe the tiles are a sixth, if the frame's origin is one of 0°, 90°, 180° and −90° on the
    equator and both poles: the part that is nearest to it. Coarse parts are read from the file's overviews, so it is never read whole; a file that is large and
    has none is refused. As long as a tiled raster lives, GDAL's cache of blocks, which is the process's, has 64 MiB at most.

    open() may be called from any thread.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT TiledRaster
{
    /// Null, with a sentence in `error` that names file and remedy, if the file cannot be used. `kind`: empty if the file decides.
    /// `bands`: what is shown. `reach`: half of the side of a square around the frame's origin, metres; the tiles are those of the square. 0: of
    /// all of the raster.
    static osg::ref_ptr<RasterTiles> open(const std::string& file, const MappingFrame& frame,
                                          std::optional<DataLayer::Kind> kind, std::string& error,
                                          const std::optional<RasterBands>& bands = std::nullopt,
                                          double reach = 0.0);
};

} // namespace osgGeoFX
