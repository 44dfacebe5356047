// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What lies on the ground: trees, towns, bare ground and water, after Section 3.2.1 of Brown and Samavati (2017). The
// tiles of a terrain database have it in a texture beside their colors. A texel may be filtered like a color. The
// shore is a signed distance, so it stays sharp at any magnification.
//
// Red is the share of trees, and green that of buildings. Blue is 0 for fields, 1/2 for bare ground, and 1 for ice
// that stays. Alpha is the distance to the shore. The texel (0, 0, 0, 1), which a texture unit without a texture
// gives, says that nothing is known.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// The distance from the shore that is coded half-way to the end of alpha's range.
const Length GEOFX_SHORE_SCALE = Length(500);
// The estimated depth of water for each metre from the shore, for water that nobody measured (paper, Section 3.4.2).
const Number GEOFX_SHORE_SLOPE = Number(0.02);

struct geofx_Cover
{
    Number trees; // 0 to 1
    Number town;  // 0 to 1
    Number bare;  // 0 field, 1/2 bare ground, 1 ice
    Length shore; // from the nearest shore, over water; negative over land. If the depth is known, it is depth / GEOFX_SHORE_SLOPE
};

// Whether a texel says anything.
GEOFX_INLINE bool geofx_coverKnown(Rgba texel)
{
    return texel.w < Number(0.998);
}

// 0 to 254/255, 128/255 at the shore.
GEOFX_INLINE Number geofx_shoreCode(Length shore)
{
    return (128 + 126 * shore / (abs(shore) + GEOFX_SHORE_SCALE)) / 255;
}

GEOFX_INLINE Length geofx_shoreDistance(Number code)
{
    Number share = clamp((code * 255 - 128) / 126, Number(-0.999), Number(0.999));
    return GEOFX_SHORE_SCALE * share / (1 - abs(share));
}

GEOFX_INLINE Rgba geofx_coverTexel(geofx_Cover cover)
{
    return Rgba(cover.trees, cover.town, cover.bare, geofx_shoreCode(cover.shore));
}

GEOFX_INLINE geofx_Cover geofx_coverOf(Rgba texel)
{
    geofx_Cover cover;
    cover.trees = texel.x;
    cover.town = texel.y;
    cover.bare = texel.z;
    cover.shore = geofx_shoreDistance(texel.w);
    return cover;
}

// The likely cover of ground that nothing is known of: the sea at height 0 and below, trees below the tree line on
// ground that is not too steep, bare ground above. `steepness` is rise over run. Heights are above the sea.
GEOFX_INLINE geofx_Cover geofx_likelyCover(Length height, Number steepness, Length treeLine)
{
    Number below = clamp((treeLine - height) / (treeLine / 5 + 1), Number(0), Number(1));
    Number gentle = clamp((Number(1.1) - steepness) / Number(0.5), Number(0), Number(1));
    // Plains are fields. The hills above them have the woods.
    Number hilly = clamp((steepness - Number(0.05)) / Number(0.15), Number(0), Number(1));
    geofx_Cover cover;
    cover.trees = below * gentle * (Number(0.15) + Number(0.7) * hilly);
    cover.town = Number(0);
    cover.bare = Number(0.5) * (1 - below);
    cover.shore = height > 0 ? -GEOFX_SHORE_SCALE : GEOFX_SHORE_SCALE * 2;
    return cover;
}
