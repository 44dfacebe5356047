// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/mapping/RasterTiles.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace osgGeoFX
{

/// A raster of a file, ready to be put on the ground by a mapping. A plain value.
/// @ingroup mapping
struct OSGGEOFX_EXPORT GroundOverlay
{
    std::string name;
    std::size_t frame = 0; ///< in which of several frames the corners are
    osg::ref_ptr<DataLayer> layer;
    /// Lower left, lower right, upper right, upper left; metres in the frame. Any convex quadrilateral.
    std::array<osg::Vec2d, 4> corners;
    double opacity = 1.0; ///< 0…1
    int order = 0;        ///< the file's own; the higher one lies on top
    bool visible = true;
    double pixelsNone = 0.0, pixelsFull = 0.0; ///< ProjectiveMapping::setPixels()
    double lowest = 0.0, highest = 0.0;        ///< range of a layer of values; both 0 if there are none
    osg::ref_ptr<ColorTable> table; ///< colors of values; null: greys from the lowest to the highest

    /// All of the raster, for a PagedRaster, where the layer has only a coarse picture of it; null where the layer is all there is.
    osg::ref_ptr<RasterTiles> tiles;

    /// A point of vector data, whose symbol the layer is.
    struct Symbol
    {
        double longitude = 0.0, latitude = 0.0; ///< degrees
        std::optional<double> height; ///< metres; nothing: whoever shows it gives it that of the ground
        double pixels =
            0.0; ///< its size on the screen, turned towards the eye; 0: it lies on the ground in metres
    };
    std::optional<Symbol> symbol;

    /// A mapping of it, of order 0. Null, with a warning, if the corners span no area.
    osg::ref_ptr<ProjectiveMapping> makeMapping() const;
    /// Gives a mapping that has its place and its layer all else.
    void setLook(ProjectiveMapping& mapping) const;
};

} // namespace osgGeoFX
