// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The shore's code (lib/cover.glsl) at a place of a tile's texture, without the staircase of the cells that it was measured from: a mean over a
// texel and a half. At the borders of tiles, which have no texels of their neighbors, the mean shrinks, so that both have the same line there.
float geofx_smoothShore(sampler2D cover, vec2 place)
{
    vec2 size = vec2(textureSize(cover, 0));
    vec2 room = min(place, 1.0 - place) * size - 0.5;
    vec2 way = clamp(min(room.x, room.y), 0.0, 0.75) / size;
    return 0.25 * (textureLod(cover, place - way, 0.0).a + textureLod(cover, place + way, 0.0).a +
                   textureLod(cover, place + vec2(way.x, -way.y), 0.0).a + textureLod(cover, place + vec2(-way.x, way.y), 0.0).a);
}
