// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/mapping/GroundOverlay.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Reads whatever lies on the ground: the ground overlays of a KML or KMZ file (KmlOverlays), any raster with
    a georeference that GDAL opens (MappingRaster), also MBTiles files and descriptions of WMTS and XYZ services, and the areas, lines
    and points of any vector data (TiledVectors), also of KML files without ground overlays. Areas and lines always have tiles; points are symbols.

    On a globe, rasters near each other share a frame. A raster gets a frame of its own where its texels are too small for the
    distance (float has 24 bits) or where it lies more than 60° of arc away; there are at most seven frames. So corners lie
    exactly anywhere on the globe, over the antimeridian and at the poles, too. A raster that reaches farther than 60° of arc around its middle, up to all of the
    globe, becomes six overlays, each in a frame of its own, which overlap by some texels; or, if Options::ground is smaller than 2,000 km, one overlay
    around the ground.

    One thread at a time; several readers may read at once.
    @ingroup geodata */
class OSGGEOFXDATA_EXPORT OverlayReader
{
public:
    struct Options
    {
        bool allowOutside = false; ///< KmlOverlays' reach
        /// Colors of values: an SLD file (SldColors), or one that ColorRampFile reads. Empty: none.
        std::string colors;
        /// Of rasters and pictures: what is shown. What is left open, an SLD file of `colors` decides, then the raster itself.
        std::optional<RasterBands> bands = std::nullopt;
        int maxSide = 2048; ///< texels along the longer side of a raster, 1…16384
        /// Whether a raster with a georeference that has more pixels than `maxSide` along a side gives its tiles, too
        /// (GroundOverlay::tiles); its layer is a coarse picture then.
        bool paged = false;
        std::string
            layer; ///< of vector data: one layer; of a raster: a variable or table; empty: all, or the first
        std::string style; ///< of vector data: an SLD file; empty: what TiledVectors says
        /// Of a file's overlays together, a picture that several of them show counted once; those that come later are left out, with a
        /// notice. 2^27 texels have 512 MiB.
        double maxTexels = 134217728.0;
        /// Around the ground of a globe, Earth-centered coordinates, metres. The parts of a raster around the globe that lie beside it are
        /// left out. An invalid sphere is all of the globe.
        osg::BoundingSphered ground = {};
        /// Of KML: the pictures that were read before, which are not read again; grows. Null: those of one file are shared.
        OverlayRaster::Pictures* pictures = nullptr;
    };

    /// Of the terrain: a globe, or a plane with a coordinate system.
    bool globe = true;
    std::string wkt;
    std::vector<LocalOrigin> frames; ///< those that there are; grows
    std::vector<GroundOverlay> overlays;
    std::vector<std::string> notices; ///< sentences that people should know
    std::vector<std::string> files;   ///< of KML: the file itself and those on disk that it links or shows

    /// Appends the overlays of a file, the lowest first. Returns false, with a sentence in `error` that names file and remedy,
    /// if the file cannot be used; nothing else changes then.
    bool read(const std::string& file, const Options& options, std::string& error);
};

} // namespace osgGeoFX
