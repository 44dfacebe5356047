// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/BuildError.h>

#include <osg/Vec2d>

#include <functional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** A coarser copy of a part of an elevation raster, for a picture that shows less than the whole raster has.

    GDAL reads, averages and writes it, from overviews where the raster has them. Memory is bounded for rasters of any
    size. CRS, no-data, unit, scale and offset stay. All methods throw BuildError.
    @ingroup terrain */
struct OSGGEOFXDATA_EXPORT ThinnedRaster
{
    /// What a raster has.
    struct Size
    {
        int columns = 0;
        int rows = 0;
        double spacing = 0.0;  ///< metres from one sample to the next, the smaller of both directions
        bool seaFloor = false; ///< whether some heights are depths: more than 10 m below zero
    };
    /// `allHeights`: as BuildOptions::allHeights, here and below.
    static Size look(const std::string& file, bool allHeights = false);

    /// A part of a raster, and how much coarser the copy is.
    struct Cut
    {
        int left = 0, top = 0, columns = 0, rows = 0; ///< pixels of the raster; 0 columns if nothing is left
        int factor = 1;                               ///< pixels along the side of a square that becomes one
    };
    /// The part that covers places on the ground, longitude and latitude in degrees, with 16 samples more at each side.
    /// Without places it is the whole raster.
    static Cut cut(const std::string& file, const std::vector<osg::Vec2d>& places, int factor);

    /// Writes the copy as a GeoTIFF of floats: a whole file or none. If there are depths, the sea (as osggeofx_build
    /// finds it) gets the height 0: pictures that show heights as such want the surface, not the floor. Land below the
    /// sea stays. `progress` gets the finished share, and returns false to cancel, which throws.
    static void write(const std::string& file, const Cut& cut, const std::string& output,
                      const std::function<bool(double)>& progress = {}, bool allHeights = false);
};

} // namespace osgGeoFX
