// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/mapping/LayerSequence.h>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Rasters in time, warped into the frame of mappings: the steps of a LayerSequence.

    They are the time dimension of a data set of several dimensions that GDAL opens (NetCDF, GRIB, Zarr, HDF5), the bands of any
    raster, or the rasters of a folder, by their dates, else by their names. Times are those of the dimension, of the bands' metadata or
    descriptions, or dates in the files' names ("rain_2026-01-12T06.tif", "20260112_0600.tif", "rain_202601.tif"); else steps are 0, 1, 2 … Each
    step lies where its georeference says; all are warped onto the rectangle of the first one.

    open() may be called from any thread; each sequence has its own datasets.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT SequenceRaster
{
    struct Options
    {
        /// Of several dimensions; empty: the first one that has a time, and rows and columns. Behind its name, brackets choose
        /// among levels, members and other dimensions, by their values: "t[level=500,number=2]".
        std::string variable;
        int maxSide = 1024; ///< texels along the longer side at most, 1…16384
        /// Of a folder of pictures: what is shown. All are as bright as the first.
        std::optional<RasterBands> bands = std::nullopt;
    };

    osg::ref_ptr<SequenceSteps> steps;
    osg::Vec2d low; ///< the rectangle's corners in the frame, metres
    osg::Vec2d high;
    /// The other parts of rasters that reach around the globe, each in a frame of its own.
    struct Part
    {
        LocalOrigin origin;
        osg::ref_ptr<SequenceSteps> steps;
        osg::Vec2d low, high;
    };
    std::vector<Part> others;
    double lowest = 0.0; ///< range of the values of some steps; both 0 if there are none
    double highest = 0.0;
    std::string variable; ///< its name; empty for files and bands
    std::string unit;     ///< of its values; empty if there is none

    /// Returns nothing, with a sentence in `error` that names file and remedy, if the files cannot be used. With `moves`, the
    /// frame's origin is moved to the middle of the rasters first. On a globe, rasters that reach farther than 60° of arc around their middle
    /// are then six parts, as OverlayReader's, of which the frame has the first; without `moves` they are the part of the frame's origin, which must be
    /// one of the six.
    static std::optional<SequenceRaster> open(const std::string& file, MappingFrame& frame, bool moves,
                                              const Options& options, std::string& error);
    /// "FILE" or "FILE:VARIABLE" in two parts.
    static std::pair<std::string, std::string> parse(const std::string& text);
};

} // namespace osgGeoFX
