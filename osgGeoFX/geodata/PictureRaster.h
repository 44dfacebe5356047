// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/DataLayer.h>

#include <osg/Image>

#include <optional>
#include <string>

namespace osgGeoFX
{

/** Reads an image or a layer from any raster that GDAL opens, pixel by pixel. It neither warps the pixels nor needs a
    georeference (MappingRaster is for rasters that lie where their georeference says). It serves files that OSG's own
    readers do not read, such as tiled GeoTIFFs, and numbers with no-data, scale and offset. Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT PictureRaster
{
    struct Options
    {
        std::optional<DataLayer::Kind> kind; ///< empty: the file decides, as for MappingRaster
        int maxSide = 16384; ///< texels along the longer side at most, 1 or more; larger rasters are reduced
    };

    /// The size of the file in pixels, before any reduction.
    int width = 0;
    int height = 0;
    DataLayer::Kind kind = DataLayer::COLOR;
    /// RGBA bytes for colors. Floats for values and classes, with NaN where there is no data. Null after look().
    osg::ref_ptr<osg::Image> image;

    /// Returns nothing, with a sentence in `error` that names file and remedy, if the file cannot be used.
    static std::optional<PictureRaster> read(const std::string& file, const Options& options,
                                             std::string& error);
    /// The same without reading the pixels.
    static std::optional<PictureRaster> look(const std::string& file, const Options& options,
                                             std::string& error);
};

} // namespace osgGeoFX
