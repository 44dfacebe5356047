// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/TileTextures.h>

#include <osg/Node>

#include <cstdint>

namespace osgGeoFX
{

struct TilePassResult
{
    std::uint64_t tiles = 0;
    std::uint64_t tilesReused = 0; ///< taken over from an interrupted build
    TextureFigures textures;
    osg::ref_ptr<osg::Node> root; ///< the root tile, for terrain.osgb
};

/// Pass 2: writes the tiles' files. It needs the results of pass 1.
TilePassResult runTilePass(BuildPlan& plan);

} // namespace osgGeoFX
