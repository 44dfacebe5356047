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

/** Pictures and layers from any raster that GDAL reads, as its pixels are: nothing is warped, and no georeference is needed
    (MappingRaster is for rasters that lie where theirs says). For what OSG's own readers do not know, such as tiled
    GeoTIFFs, and for numbers with no-data, scale and offset. Thread-safe. */
struct OSGGEOFXDATA_EXPORT PictureRaster
{
    struct Options
    {
        std::optional<DataLayer::Kind> kind; ///< nothing: the file decides, as for MappingRaster
        int maxSide = 16384; ///< texels along the longer side at most; a larger raster is reduced
    };

    /// Pixels of the file's own.
    int width = 0;
    int height = 0;
    DataLayer::Kind kind = DataLayer::COLOR;
    /// Colours as RGBA bytes; values and classes as floats, with NaN where there is no data. Null where it was only looked at.
    osg::ref_ptr<osg::Image> image;

    /// Nothing, with a sentence in `error` that names file and mend, where the file is of no use.
    static std::optional<PictureRaster> read(const std::string& file, const Options& options,
                                             std::string& error);
    /// The same without its pixels.
    static std::optional<PictureRaster> look(const std::string& file, const Options& options,
                                             std::string& error);
};

} // namespace osgGeoFX
