// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/TileTextures.h>

#include <osg/Node>

#include <cstdint>

namespace osgGeoFX
{

/// What the stages of tiles leave for the root's file.
struct TilePassResult
{
    std::uint64_t tiles = 0;
    std::uint64_t tilesReused = 0; ///< taken over from an interrupted build
    std::uint64_t tilesKept = 0;   ///< of the former database, by the units that were done or kept
    std::uint64_t units = 0, unitsKept = 0;
    TextureFigures textures;
    osg::ref_ptr<osg::Node> root; ///< the root tile, for terrain.osgb
};

/// Takes the result from the work files of the last unit. What counts units and tiles by their origin stays. Throws BuildError.
void readTilePassResult(const BuildPlan& plan, TilePassResult& result);

} // namespace osgGeoFX
