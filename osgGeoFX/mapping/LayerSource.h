// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <optional>
#include <string>

namespace osgGeoFX
{

/// The file from which SequenceSteps and RasterTiles have their pixels, and how they were brought into a frame: what OSG's files say of them, so that
/// they are opened again when a scene is read. A plain value.
/// @ingroup mapping
struct LayerSource
{
    std::string file;        ///< of sequences also "FILE:VARIABLE", or a folder
    bool globe = true;       ///< of the frame, as MappingFrame has it
    std::string wkt;         ///< the same
    LocalOrigin origin;      ///< the same
    int maxSide = 1024;      ///< of sequences: texels along the longer side
    std::optional<int> kind; ///< of tiles: a DataLayer::Kind; nothing if the file decides

    /// How vector data become tiles, as TiledVectors::Options has it.
    struct Vectors
    {
        std::string layer, style;
        bool allowOutside = false;
    };
    std::optional<Vectors> vectors;   ///< nothing for rasters
    std::optional<RasterBands> bands; ///< of rasters: what is shown; nothing if the file decides
    /// Of tiles of a raster: half of the side of the square around the origin that they show, metres; 0: all.
    double reach = 0.0;
};

} // namespace osgGeoFX
