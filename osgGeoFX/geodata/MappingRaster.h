// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/ProjectiveMapping.h>

#include <osg/Vec2d>

#include <optional>
#include <string>

namespace osgGeoFX
{

/// The frame of a ProjectiveMappings, in the words of coordinate systems.
struct MappingFrame
{
    bool globe = true;
    double longitude = 0.0; ///< the origin on a globe, radians
    double latitude = 0.0;
    osg::Vec2d origin; ///< the origin on a projected terrain, metres
    std::string wkt;   ///< the projected terrain's coordinate system
};

/** A raster with a georeference, made ready for a mapping: warped into the frame, so that it lies exactly, with its
    rectangle there.

    Any raster that GDAL opens: any coordinate system on Earth, rotated geotransform or ground control points, no-data,
    masks, palettes, scale and offset. Palettes and three or more bands become colours with alpha; one band becomes
    values, with NaN where there is no data. Only as much as is needed is read, from overviews where the file has some.

    Thread-safe: files may be read by several threads at once. */
struct OSGGEOFXDATA_EXPORT MappingRaster
{
    struct Options
    {
        std::optional<DataLayer::Kind> kind; ///< nothing: the file decides
        int maxSide = 2048;                  ///< texels along the longer side at most, 1…16384
    };

    osg::ref_ptr<DataLayer> layer;
    osg::Vec2d low; ///< the rectangle's corners in the frame, metres
    osg::Vec2d high;
    double lowest = 0.0; ///< of the values; both 0 where there are none
    double highest = 0.0;

    /// Gives a mapping the layer and the rectangle. False where it is refused, with a warning. (Inline: the plugin of
    /// scene files does without this library.)
    bool apply(ProjectiveMapping& mapping) const
    {
        const osg::Vec2d half = (high - low) / 2.0;
        return mapping.setRectangle(low + half, half.x(), half.y()) && mapping.setLayer(layer);
    }

    /// Nothing, with a sentence in `error` that names file and mend, where the file is of no use.
    static std::optional<MappingRaster> read(const std::string& file, const MappingFrame& frame,
                                             const Options& options, std::string& error);
    /// Moves a frame's origin into the middle of a raster. False, with a sentence in `error`, as above.
    static bool moveToMiddle(const std::string& file, MappingFrame& frame, std::string& error);
};

} // namespace osgGeoFX
