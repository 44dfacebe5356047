// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <osg/Vec2d>

#include <optional>
#include <string>

namespace osgGeoFX
{

/// The frame of a ProjectiveMappings, described as a coordinate system.
/// @ingroup geodata
struct MappingFrame
{
    bool globe = true;
    LocalOrigin origin;
    std::string wkt; ///< the coordinate system of the projected terrain
};

/** A georeferenced raster, warped into the frame of a mapping so that it lies exactly, with its rectangle in that
    frame.

    It accepts any raster that GDAL opens: any coordinate system on Earth, rotated geotransforms or ground control
    points, no-data, masks, palettes, scale and offset. A palette, bands of red, green and blue, or three or more bands of bytes or of
    unsigned numbers with 16 bits become colors with alpha. Otherwise the first band becomes values, with NaN where there is no data. Of colors
    with more than 8 bits, 2 to 98 % of the numbers go from black to white, unless they fill half of their type's range already. It reads only as much as it needs,
    from overviews if the file has any.

    Thread-safe: several threads may read files at once.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT MappingRaster
{
    /// A part of the frame, metres.
    struct Window
    {
        osg::Vec2d low;
        osg::Vec2d high;
        double texel = 0.0; ///< the size of texels that keeps the raster's resolution
    };
    struct Options
    {
        std::optional<DataLayer::Kind> kind;         ///< empty: the file decides
        int maxSide = 2048;                          ///< texels along the longer side at most, 1…16384
        std::optional<Window> window = std::nullopt; ///< empty: all of the raster
        RasterBands bands = {};                      ///< what is shown
    };

    osg::ref_ptr<DataLayer> layer;
    osg::Vec2d low; ///< the rectangle's corners in the frame, metres
    osg::Vec2d high;
    double lowest = 0.0; ///< range of the values; both 0 if there are none
    double highest = 0.0;

    /// Gives a mapping the layer and the rectangle. Returns false, with a warning, if the mapping refuses them.
    /// (Inline, so that the plugin of scene files does not need this library.)
    bool apply(ProjectiveMapping& mapping) const
    {
        const osg::Vec2d half = (high - low) / 2.0;
        return mapping.setRectangle(low + half, half.x(), half.y()) && mapping.setLayer(layer);
    }

    /// Returns nothing, with a sentence in `error` that names file and remedy, if the file cannot be used.
    static std::optional<MappingRaster> read(const std::string& file, const MappingFrame& frame,
                                             const Options& options, std::string& error);
    /// Moves a frame's origin to the middle of a raster. Returns false, with a sentence in `error`, if the file cannot
    /// be used.
    static bool moveToMiddle(const std::string& file, MappingFrame& frame, std::string& error);
};

} // namespace osgGeoFX
