// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What all stages of CloseUps share: the close-ups' parameters and masks. SLOT_ stands for the effect's prefix.
#include "lib/closeup.glsl"
#pragma import_defines(SLOT_MASKED)

// 16 vectors for each close-up; CloseUpItem::values() tells which is which.
layout(std140) uniform SLOT_Items
{
    vec4 SLOT_items[1024];
};
uniform sampler2DArray SLOT_masks; // red the mask, green the distance to the border

vec4 SLOT_item(int item, int row)
{
    return SLOT_items[item * 16 + row];
}

geofx_Lift SLOT_liftOf(int item)
{
    return geofx_Lift(SLOT_item(item, 0), SLOT_item(item, 1), SLOT_item(item, 2), SLOT_item(item, 3));
}

// The place in the region, -1 to 1, of a point of the ground, and its height above the region's base.
vec3 SLOT_placeOf(int item, vec3 located)
{
    vec4 point = vec4(located, 1.0);
    return vec3(dot(SLOT_item(item, 4), point), dot(SLOT_item(item, 5), point), dot(SLOT_item(item, 6), point));
}

// Mask and distance at a place whose texels say `value`. Outside of the region there is no mask, and the distance
// continues from the region's own border.
vec2 SLOT_bordered(int item, vec2 place, vec2 value)
{
    vec2 halfSides = vec2(SLOT_item(item, 7).w, SLOT_item(item, 13).y);
    bool outside = max(abs(place.x), abs(place.y)) > 1.0;
    return vec2(outside ? 0.0 : value.x, geofx_border(value.y, place, SLOT_item(item, 11).z, halfSides));
}

// Mask and distance, interpolated between texels in floats. A sampler would round the shares.
vec2 SLOT_maskAt(int item, vec2 place)
{
    float side = SLOT_item(item, 11).z;
    ivec2 last = ivec2(int(side) - 1);
    int layer = int(SLOT_item(item, 9).x);
    vec2 texel = geofx_maskTexel(clamp(place, -1.0, 1.0), side);
    ivec2 low = ivec2(floor(texel));
    ivec2 a = clamp(low, ivec2(0), last);
    ivec2 b = clamp(low + 1, ivec2(0), last);
    vec2 value = geofx_between(texelFetch(SLOT_masks, ivec3(a, layer), 0).rg,
                         texelFetch(SLOT_masks, ivec3(b.x, a.y, layer), 0).rg,
                         texelFetch(SLOT_masks, ivec3(a.x, b.y, layer), 0).rg,
                         texelFetch(SLOT_masks, ivec3(b, layer), 0).rg, texel - vec2(low));
    return SLOT_bordered(item, place, value);
}

// Where a point goes in a layer, 0 the close-up's and 1 its anchor's. `place` gets its place and its share of the
// way.
vec3 SLOT_moved(int item, int layer, vec3 located, vec3 bent, out vec3 place)
{
    place.xy = SLOT_placeOf(item, located).xy;
#ifdef SLOT_MASKED
    place.z = SLOT_maskAt(item, place.xy).x;
    // A close-up that fragments cut is lifted as a whole.
    bool whole = layer == 0 && SLOT_item(item, 9).y < 0.5;
    return geofx_raise(bent, geofx_lift(SLOT_liftOf(item), located), whole ? 1.0 : place.z);
#else
    place.z = 1.0;
    return geofx_lift(SLOT_liftOf(item), located);
#endif
}
