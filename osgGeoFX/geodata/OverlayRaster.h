// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/KmlOverlays.h>
#include <osgGeoFX/geodata/MappingRaster.h>

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace osgGeoFX
{

/// How far a raster reaches on the globe.
/// @ingroup geodata
struct GroundReach
{
    osg::Vec2d middle;   ///< longitude and latitude, degrees
    double radius = 0.0; ///< of a circle about the middle that has all of it in it, radians of arc
    double texel = 0.0;  ///< about the size of its texels, metres
};

/** A picture that lies between four corners in degrees, brought into the frame of mappings.

    Where the frame's projection is straight enough for its texels (a quarter of one), the picture stays as it is, and the four
    corners alone are brought into the frame. Otherwise it is resampled by GDAL's warper, texel by texel: so the picture lies
    exactly, however large it is, up to 85° of arc around the frame's origin.

    Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT OverlayRaster
{
    /// Pictures as they were read, by file and maxSide.
    using Pictures = std::map<std::pair<std::string, int>, osg::ref_ptr<DataLayer>>;

    struct Options
    {
        int maxSide = 2048; ///< texels along the longer side at most, 1…16384
        /// Whether pictures may be of any format that GDAL knows, also those that name further files.
        bool anyFormat = false;
        /// A part of the frame, to be resampled. Empty: all of the picture.
        std::optional<MappingRaster::Window> window = std::nullopt;
        /// Those that were read before, which are not read again; grows. Where a picture stays as it is, its overlays share the layer.
        /// Null: none are kept.
        Pictures* pictures = nullptr;
        RasterBands bands = {}; ///< what pictures show
    };

    osg::ref_ptr<DataLayer> layer;
    /// Metres in the frame: lower left, lower right, upper right, upper left.
    std::array<osg::Vec2d, 4> corners;

    /// Returns nothing, with a sentence in `error` that names file and remedy, if the picture cannot be used.
    static std::optional<OverlayRaster> read(const KmlOverlay& overlay, const MappingFrame& frame,
                                             const Options& options, std::string& error);
    /// The reach of an overlay; opens its picture for the size of its texels. Returns nothing, with a sentence in `error`, if
    /// it cannot be opened.
    static std::optional<GroundReach> reachOf(const KmlOverlay& overlay, const Options& options,
                                              std::string& error);
    /// The same of a raster with a georeference.
    static std::optional<GroundReach> reachOf(const std::string& file, std::string& error);
    /// From degrees to metres in a frame; nothing of what has no place there. Throws BuildError, naming `file`, where the frame has no coordinate system.
    static std::function<std::optional<osg::Vec2d>(const osg::Vec2d&)> placer(const MappingFrame& frame,
                                                                              const std::string& file);
    /// Moves a frame's origin to a reach's middle. Returns false, with a sentence in `error` that names `file`, if a projected
    /// terrain has no place for it.
    static bool moveToMiddle(const GroundReach& reach, const std::string& file, MappingFrame& frame,
                             std::string& error);
};

} // namespace osgGeoFX
