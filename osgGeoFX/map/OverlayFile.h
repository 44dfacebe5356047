// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/mapping/GroundOverlay.h>

#include <osg/BoundingSphere>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The rasters, or the areas, lines and points, of a file, for mappings, read by the plugin `osgdb_geofxdata`, so that a program which draws needs no GDAL. Programs that
    link osgGeoFXData may call OverlayReader themselves, which says what is read.
    @ingroup map */
struct OSGGEOFXMAPS_EXPORT OverlayFile
{
    std::string file;
    bool allowOutside = false; ///< whether a KML file may name files outside of its folder, and addresses
    std::string colors;        ///< of values: an SLD file, or one that ColorRampFile reads; empty: none
    std::string layer, style;  ///< of vector data: one layer, and an SLD file; either may be empty
    std::optional<RasterBands> bands;    ///< OverlayReader::Options::bands
    int maxSide = 2048;                  ///< texels along the longer side of a raster, 1…16384
    bool paged = false;                  ///< OverlayReader::Options::paged
    bool globe = true;                   ///< the terrain is one
    osg::BoundingSphered ground;         ///< OverlayReader::Options::ground
    std::string wkt;                     ///< the coordinate system of a projected terrain
    std::vector<LocalOrigin> frames;     ///< those that there are; grows
    std::vector<GroundOverlay> overlays; ///< what was read, the lowest first
    std::vector<std::string> notices;    ///< sentences that people should know
    std::vector<std::string> files;      ///< of KML: the file itself and those on disk that it links or shows

    /// Appends the file's overlays. False, with a sentence in `error`, if it cannot.
    bool read(std::string& error);
};

} // namespace osgGeoFX
