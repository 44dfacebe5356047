// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/closeup/SurfaceData.h>
#include <osgGeoFX/geodata/MappingRaster.h>

#include <osg/Vec4f>

#include <string>

namespace osgGeoFX
{

/** Fills a SurfaceData from files: from any raster and any vector data that GDAL opens, warped into the SurfaceData's
    frame (paper: interactive close-ups, Section IV.B.2).

    The SurfaceData sets the place: its rectangle, its origin, and the number of texels of its layers. Of the
    MappingFrame only `globe` and `wkt` count, except in fromDem(), which places a new SurfaceData.

    If a method fails, it adds nothing, and a sentence in `error` names file and remedy. Several threads may read files
    at once, each into its own SurfaceData.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT SurfaceRaster
{
    /** Adds a layer from a raster: COLOR (a palette, three or more bands, or bytes as grey), HEIGHT in metres, SLOPE
        in radians, OCCLUSION, CLASS or VALUE. Classes and palettes are never interpolated. NORMAL and ASPECT are
        refused, because they are derived from heights. If there are no layers yet, the layer keeps the raster's
        resolution with at most `maxSide` texels along the longer side (1…16384). A raster without data in the
        rectangle is refused. */
    static bool addLayer(SurfaceData& data, const std::string& name, SurfaceData::Kind kind,
                         const std::string& file, const MappingFrame& frame, std::string& error,
                         int maxSide = 1024);

    struct Options
    {
        /// The rectangle in the frame, metres. If both corners are equal, it is the whole raster.
        osg::Vec2d low, high;
        int maxSide = 1024;     ///< texels along the longer side at most, 1…16384
        double radius = 2000.0; ///< of the ground that can hide the sky, metres, 0 or more
    };
    /// Makes a SurfaceData from heights in metres, with the layers "height", "normal", "slope", "aspect" and
    /// "occlusion". Ground beyond the rectangle is included, so that neighbouring rectangles match. Returns null if it
    /// fails.
    static osg::ref_ptr<SurfaceData> fromDem(const std::string& file, const MappingFrame& frame,
                                             const Options& options, std::string& error);

    /** Adds a COLOR layer from vector data, such as roads. It draws lines and the borders of areas `width` metres wide
        (up to 1e6), and points as discs. The color's channels are 0…1; its alpha is that of the whole line. All
        layers of the file are drawn. Edges are smooth, and a line narrower than a texel is fainter instead. If there
        are no layers yet, the layer has `maxSide` texels along the longer side. A file without anything in the
        rectangle is refused. */
    static bool addVectors(SurfaceData& data, const std::string& name, const std::string& file, double width,
                           const osg::Vec4f& color, const MappingFrame& frame, std::string& error,
                           int maxSide = 1024);
};

} // namespace osgGeoFX
