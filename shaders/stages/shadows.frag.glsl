// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// SunShadows in the fragment stage. SLOT_ stands for the effect's prefix.
#pragma import_defines(GEOFX_NORMAL_MAP)

uniform mat4 SLOT_maps[6];    // from the view's eye space to each map: 0 to 1 across and along the sun's rays
uniform float SLOT_texels[6]; // metres of a texel of each
uniform vec4 SLOT_cascades;   // how many, the texels along a side, how much the first one counts, the strength
uniform vec4 SLOT_towards;    // the sun, in the view's eye space; w: whether there is one
uniform vec4 SLOT_upward;     // up; with w = 1, away from this place
uniform sampler2DShadow SLOT_depths;

in vec3 SLOT_place;

// The share of the sun's light at a place in a map: four by four texels, weighted by a tent that is three texels wide. Each of
// the four fetches has the right share of four texels.
float SLOT_lit(int map, vec3 place)
{
    float size = SLOT_cascades.y;
    ivec2 whole = textureSize(SLOT_depths, 0);
    int columns = whole.x / int(size);
    vec2 tile = vec2(map % columns, map / columns);
    vec2 scale = 1.0 / vec2(whole);
    vec2 texel = place.xy * size;
    vec2 corner = floor(texel + 0.5);
    vec2 part = texel + 0.5 - corner;
    corner += tile * size - 0.5;
    vec2 lowWeight = 3.0 - 2.0 * part, highWeight = 1.0 + 2.0 * part;
    vec2 low = (corner + (2.0 - part) / lowWeight - 1.0) * scale;
    vec2 high = (corner + part / highWeight + 1.0) * scale;
    float sum = lowWeight.x * lowWeight.y * textureLod(SLOT_depths, vec3(low, place.z), 0.0);
    sum += highWeight.x * lowWeight.y * textureLod(SLOT_depths, vec3(high.x, low.y, place.z), 0.0);
    sum += lowWeight.x * highWeight.y * textureLod(SLOT_depths, vec3(low.x, high.y, place.z), 0.0);
    sum += highWeight.x * highWeight.y * textureLod(SLOT_depths, vec3(high, place.z), 0.0);
    return sum / 16.0;
}

float SLOT_sunlight()
{
    // Before anything returns, since it needs the neighboring pixels.
    vec3 right = dFdx(SLOT_place), above = dFdy(SLOT_place);
    if (SLOT_towards.w == 0.0) return 1.0;
    vec3 up = SLOT_upward.w > 0.0 ? normalize(SLOT_place - SLOT_upward.xyz) : SLOT_upward.xyz;
    vec3 ground = SLOT_place;
    vec3 normal = cross(right, above);
    float size = length(normal);
    normal = size > 0.0 ? normal / size : up;
    // The walls between tiles end at the ground, and bends open gaps of some pixels. There the wall is as light as the ground.
#ifdef GEOFX_NORMAL_MAP
    float pixels = 1.0 + 6.0 * (1.0 - smoothstep(0.1, 0.3, abs(dot(normal, up))));
    ground += up * (pixels * min(length(right), length(above)));
#endif
    float clearance = 0.0;
    if (geofx_isLine)
    {
        // The line lies near the ground, not on it.
        normal = up;
        clearance = 0.5 + max(length(right), length(above));
    }
    float facing = dot(normal, SLOT_towards.xyz);
    if (facing < 0.0) normal = -normal;
    // A surface must not shade itself: its place is raised by as much as a texel's neighbors rise above its plane.
    float slant = sqrt(max(1.0 - facing * facing, 0.0));

    float light = 1.0;
    float open = 1.0; // the share that no map has answered for yet
    for (int i = 0; i < int(SLOT_cascades.x); ++i)
    {
        vec3 raised = ground + normal * (clearance + SLOT_texels[i] * (0.3 + 2.0 * slant));
        vec3 place = (SLOT_maps[i] * vec4(raised, 1.0)).xyz;
        vec3 room = 0.5 - abs(place - 0.5);
        float share = clamp(12.0 * min(room.x, room.y) - 0.25, 0.0, 1.0) * step(0.0, room.z);
        if (i == 0) share *= SLOT_cascades.z;
        if (share <= 0.0) continue;
        light -= open * share * (1.0 - SLOT_lit(i, place));
        open *= 1.0 - share;
        if (open <= 0.0) break;
    }
    // The Earth shades what the sun has not risen for.
    light *= smoothstep(0.0, 0.01, dot(up, SLOT_towards.xyz));
    return 1.0 - SLOT_cascades.w * (1.0 - light);
}

vec4 SLOT_color(vec4 color)
{
    return color;
}
