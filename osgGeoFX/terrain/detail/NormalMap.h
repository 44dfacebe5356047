// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/TileNode.h>

#include <osg/StateSet>

namespace osgGeoFX
{

/** Binds a tile's texture of normals (effect/detail/TileNormals.h), made of the slopes in `arrays`; x and y count tiles from
    the arrays' south-west corner. Texels lie on posts, those of the tile's borders included, so tiles of a level meet without
    a seam. Those of two channels can be compressed. */
void addNormalMap(osg::StateSet& state, TileTextures& textures, const TilingScheme& scheme,
                  const TileKey& key, const LevelArrays& arrays, int x, int y);

/** Sets the program that draws tiles in hosts without the kit: OpenGL's fixed functions as far as vertices go, then
    their lighting once more for each fragment. For a state set that stands above tiles and nothing else. */
void addTileProgram(osg::StateSet& state);

/// The alpha of a tile's color. Lighting replaces it by the material's, so a fragment sees whether there is any.
constexpr float UNLIT_ALPHA = 254.0f / 255.0f;

} // namespace osgGeoFX
