// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/TileNode.h>

#include <osg/StateSet>

namespace osgGeoFX
{

/** Binds a tile's texture of normals (effect/detail/TileNormals.h). It is made of the slopes in `arrays`; x and y
    count tiles from the arrays' south-west corner. Texels lie on posts, also on the tile's borders, so tiles of a
    level meet without a seam. A texture of two channels can be compressed. */
void addNormalMap(osg::StateSet& state, TileTextures& textures, const TilingScheme& scheme,
                  const TileKey& key, const LevelArrays& arrays, int x, int y);

/** Sets the program that draws tiles in programs without the kit. OpenGL's fixed functions process vertices, and the
    program repeats their lighting for each fragment. It is for a state set above tiles and nothing else. */
void addTileProgram(osg::StateSet& state);

/// The alpha of a tile's color. Lighting replaces it by the material's alpha, so a fragment can see whether lighting
/// is on.
constexpr float UNLIT_ALPHA = 254.0f / 255.0f;

} // namespace osgGeoFX
