// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/ProjectiveMapping.h>

#include <osg/Vec2d>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The rasters in time of a file or a folder, read by the plugin `osgdb_geofxdata`, so that a program which draws needs no GDAL. Programs that
    link osgGeoFXData may call SequenceRaster themselves, which says what is read.
    @ingroup map */
struct OSGGEOFXMAPS_EXPORT SequenceFile
{
    std::string file;   ///< "FILE", "FILE:VARIABLE" or a folder
    std::string colors; ///< of values: an SLD file, or one that ColorRampFile reads; empty: none
    int maxSide = 1024; ///< texels along the longer side, 1…16384
    std::optional<RasterBands> bands; ///< of a folder of pictures: what is shown
    bool globe = true;                ///< the terrain is one
    std::string wkt;                  ///< the coordinate system of a projected terrain
    bool moves = true;                ///< whether the origin is moved to the middle of the rasters
    LocalOrigin origin;               ///< of the frame

    osg::ref_ptr<SequenceSteps> steps;
    osg::Vec2d low, high; ///< the rectangle's corners in the frame, metres
    /// The other parts of rasters that reach around the globe, each in a frame of its own.
    struct Part
    {
        LocalOrigin origin;
        osg::ref_ptr<SequenceSteps> steps;
        osg::Vec2d low, high;
    };
    std::vector<Part> others;
    double lowest = 0.0, highest = 0.0; ///< of the values
    osg::ref_ptr<ColorTable> table;
    std::string variable, unit;

    /// False, with a sentence in `error`, if it cannot be read.
    bool read(std::string& error);
};

} // namespace osgGeoFX
