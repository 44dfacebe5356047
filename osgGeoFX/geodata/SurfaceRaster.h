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

/** Fills a SurfaceData from files: any raster and any vector data that GDAL opens, warped into its frame (paper: interactive
    close-ups, Section IV.B.2).

    Files go where the SurfaceData is: to its rectangle, about its origin, in texels of its layers' number. Of the
    MappingFrame only `globe` and `wkt` count, except for fromDem(), which places a new SurfaceData.

    On failure there is nothing new, and a sentence in `error` that names file and mend. Files may be read by several threads at
    once, each into a SurfaceData of its own. */
struct OSGGEOFXDATA_EXPORT SurfaceRaster
{
    /** One more layer from a raster: COLOR (a palette, three bands or more, or bytes as grey), HEIGHT in metres, SLOPE in
        radians, OCCLUSION, CLASS or VALUE; classes and palettes are never mixed. NORMAL and ASPECT are refused: derive
        them. Where there are no layers yet, it gets as many texels as keep the raster's resolution, `maxSide` along the longer
        side at most (1…16384). Refused where it has no data in the rectangle. */
    static bool addLayer(SurfaceData& data, const std::string& name, SurfaceData::Kind kind,
                         const std::string& file, const MappingFrame& frame, std::string& error,
                         int maxSide = 1024);

    struct Options
    {
        /// The rectangle in the frame, metres; all of the raster where both are equal.
        osg::Vec2d low, high;
        int maxSide = 1024;     ///< texels along the longer side at most, 1…16384
        double radius = 2000.0; ///< of what hides the sky, metres, 0 at least
    };
    /// A SurfaceData from heights in metres, with the layers "height", "normal", "slope", "aspect" and "occlusion". Ground
    /// beyond the rectangle counts too, so that neighbouring rectangles fit together. Null where it fails.
    static osg::ref_ptr<SurfaceData> fromDem(const std::string& file, const MappingFrame& frame,
                                             const Options& options, std::string& error);

    /** One more layer of kind COLOR from vector data, such as roads: lines and the borders of areas, `width` metres wide, and
        points as discs, in one colour, 0…1; its alpha is that of the whole line. All vector layers of the file. Edges are
        smooth, and lines narrower than a texel are fainter instead. Where there are no layers yet, `maxSide` texels along
        the longer side. Refused where none of it is in the rectangle. */
    static bool addVectors(SurfaceData& data, const std::string& name, const std::string& file, double width,
                           const osg::Vec4f& color, const MappingFrame& frame, std::string& error,
                           int maxSide = 1024);
};

} // namespace osgGeoFX
