// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// CloseUps in the fragment stage: cuts fragments away, and applies the close-up's own data, light and style.
#pragma import_defines(SLOT_DATA)
#pragma import_defines(GEOFX_HDR)

uniform sampler2D SLOT_tables;       // a row for each color table and each anchor
uniform sampler2DArray SLOT_surfaces; // values times their weight, which is the alpha
uniform vec4 SLOT_window;             // the first pixel of the camera's viewport, and half its size
uniform vec4 SLOT_quality;           // samples along a pixel's side; the layer of normals or -1; tables' width and one over it

in vec2 SLOT_surface;
in vec3 SLOT_place;
#ifdef GEOFX_AMPLIFY
flat in int SLOT_target;
#else
// The layer, if layers are drawn one by one. Some GPUs read what is the same for all fragments much faster.
uniform int SLOT_layer;
#define SLOT_target SLOT_layer
#endif

// Mask and distance as in SLOT_maskAt, to a sampler's precision.
vec2 SLOT_coverAt(int item, vec2 place)
{
    float side = SLOT_item(item, 11).z;
    vec2 texel = clamp(geofx_maskTexel(clamp(place, -1.0, 1.0), side), 0.0, side - 1.0) + 0.5;
    vec3 where = vec3(texel / float(textureSize(SLOT_masks, 0).x), SLOT_item(item, 9).x);
    vec2 value = textureLod(SLOT_masks, where, 0.0).rg;
    return SLOT_bordered(item, place, value);
}

// The largest width of a pixel. On ground seen from its edge, a pixel would be as wide as the region.
const float SLOT_widest = 0.04;

// The width of a pixel across the border. It matters only near a border, which has a line of `line` pixels. `right`
// and `up` are the changes of the place from pixel to pixel. The change of the distance would vanish on its ridges,
// such as the diagonals in a rectangle's corners. So its slope, which is 1 on both sides of a ridge, only tells the
// direction to the border.
float SLOT_pixelAt(int item, float distance, vec2 right, vec2 up, float line)
{
    vec2 halfSides = vec2(SLOT_item(item, 7).w, SLOT_item(item, 13).y);
    vec2 alongX = vec2(right.x, up.x) * halfSides.x;
    vec2 alongY = vec2(right.y, up.y) * halfSides.y;
    float most = min(length(vec4(alongX, alongY)), SLOT_widest);
    if (abs(distance) > (line + 1.0) * most) return most;
    vec2 place = SLOT_place.xy;
    vec2 x = vec2(2.0 / SLOT_item(item, 11).z, 0.0);
    vec2 y = x.yx;
    // The slopes to both sides, the steeper one first.
    vec2 slopeX = vec2(SLOT_coverAt(item, place + x).y - distance, distance - SLOT_coverAt(item, place - x).y);
    vec2 slopeY = vec2(SLOT_coverAt(item, place + y).y - distance, distance - SLOT_coverAt(item, place - y).y);
    slopeX = (abs(slopeX.x) < abs(slopeX.y) ? slopeX.yx : slopeX) / halfSides.x;
    slopeY = (abs(slopeY.x) < abs(slopeY.y) ? slopeY.yx : slopeY) / halfSides.y;
    vec2 one = vec2(slopeX.x, slopeY.y);
    vec2 other = vec2(slopeX.y, slopeY.x);
    float across = max(length(alongX * one.x + alongY * one.y) / max(length(one), 1e-9),
                       length(alongX * other.x + alongY * other.y) / max(length(other), 1e-9));
    return across > 0.0 ? min(across, SLOT_widest) : most;
}

// A layer begins where its close-up does, and has several samples for each pixel.
vec2 SLOT_pixel(vec2 pixel)
{
    vec2 corner = round(-SLOT_item(SLOT_target / 2, 14).xy * SLOT_window.zw);
    return SLOT_window.xy + corner + pixel / SLOT_quality.x;
}

int SLOT_channels()
{
    return int(SLOT_item(SLOT_target / 2, 11).w);
}

// Interpolated between the texels of a row, or the nearest one.
vec4 SLOT_rowAt(float row, float share, bool smoothly)
{
    float s = clamp(share, 0.0, 1.0) * (SLOT_quality.z - 1.0);
    int line = int(row);
    if (!smoothly) return texelFetch(SLOT_tables, ivec2(int(s + 0.5), line), 0);
    int low = int(s);
    return mix(texelFetch(SLOT_tables, ivec2(low, line), 0),
               texelFetch(SLOT_tables, ivec2(min(low + 1, int(SLOT_quality.z) - 1), line), 0), s - float(low));
}

// The close-up's layer of surface data as a color with straight alpha. Kinds: 0 colors; values in a table, 1 a smooth one and
// 2 another one; 3 normals; 4 aspects; 5 classes.
vec4 SLOT_surfaceColor(int item)
{
    vec4 data = SLOT_item(item, 10);
    vec4 range = SLOT_item(item, 11);
    int kind = int(data.y);
    vec3 place = vec3(SLOT_surface, data.x);
    vec4 texel = texture(SLOT_surfaces, place);
    if (kind == 5)
    {
        vec2 size = vec2(textureSize(SLOT_surfaces, 0).xy);
        texel = texelFetch(SLOT_surfaces, ivec3(clamp(SLOT_surface * size, vec2(0.0), size - 1.0), int(data.x)), 0);
    }
    vec2 within = abs(SLOT_surface - 0.5);
    if (texel.a < 0.004 || max(within.x, within.y) > 0.5) return vec4(0.0);
    vec4 value = vec4(texel.rgb / texel.a, texel.a);
    if (kind == 0) return value;
    if (kind == 3) return vec4(0.5 * value.rgb + 0.5, value.a);
    float number = kind == 4 ? mod(atan(value.g, value.b), 6.28318531) : value.r;
    vec4 color = SLOT_rowAt(data.z, (number - range.x) * range.y, kind == 1 || kind == 4);
    return vec4(color.rgb, color.a * value.a);
}

vec4 SLOT_finish(vec4 color)
{
    int item = SLOT_target / 2;
    vec4 kinds = SLOT_item(item, 9);
    vec4 tint = SLOT_item(item, 8);
    vec4 anchor = SLOT_item(item, 13);
    vec2 right = dFdx(SLOT_place.xy);
    vec2 up = dFdy(SLOT_place.xy);
    if (SLOT_target != 2 * item)
    {
        if (SLOT_place.z < 0.0001 || SLOT_place.z > 0.9999) discard;
        float veil = SLOT_rowAt(anchor.z, SLOT_place.z, true).r;
        if (veil < 0.002) discard;
        return vec4(tint.rgb, veil * anchor.w);
    }

    float cover = 1.0;
    float line = 0.0;
    bool sharp = kinds.y < 0.5 && kinds.z < 0.5;
    if (sharp && tint.w > 0.5)
    {
        // Each side of a rectangle counts by itself: in a corner the nearest side need not be the one at the fewest
        // pixels.
        vec2 halfSides = vec2(SLOT_item(item, 7).w, SLOT_item(item, 13).y);
        vec2 within = (1.0 - abs(SLOT_place.xy)) * halfSides;
        vec2 pixels = min(vec2(length(vec2(right.x, up.x)), length(vec2(right.y, up.y))) * halfSides, SLOT_widest);
        cover = geofx_coverage(within.x, pixels.x) * geofx_coverage(within.y, pixels.y);
        line = 1.0 - geofx_coverage(within.x - anchor.x * pixels.x, pixels.x) *
                         geofx_coverage(within.y - anchor.x * pixels.y, pixels.y);
    }
    else if (kinds.y < 0.5)
    {
        vec2 mask = SLOT_coverAt(item, SLOT_place.xy);
        float pixel = sharp ? SLOT_pixelAt(item, mask.y, right, up, anchor.x) : 0.0;
        cover = sharp ? geofx_coverage(mask.y, pixel) : mask.x;
        line = 1.0 - geofx_coverage(mask.y - anchor.x * pixel, pixel);
    }
    else if (SLOT_place.z < 0.9999)
        cover = 0.0;
    if (cover <= 0.0) discard;

    vec4 style = SLOT_item(item, 12);
    vec3 result = color.rgb;
    float opacity = color.a;
#ifdef SLOT_DATA
    vec4 data = SLOT_item(item, 10);
    if (data.x >= 0.0)
    {
        vec4 surface = SLOT_surfaceColor(item);
        result = mix(result, surface.rgb, surface.a * data.w);
        opacity = mix(opacity, 1.0, surface.a * data.w);
    }
    if (kinds.w > 0.5 && SLOT_quality.y >= 0.0)
    {
        vec4 texel = texture(SLOT_surfaces, vec3(SLOT_surface, SLOT_quality.y));
        vec3 sun = vec3(SLOT_item(item, 7).xyz);
        if (texel.a > 0.004) result *= geofx_sunlight(normalize(texel.rgb / texel.a), sun);
    }
#endif
#ifdef GEOFX_HDR
    result = max(geofx_restyleBright(max(result, vec3(0.0)), style.x, style.y, style.z), vec3(0.0));
    opacity = clamp(opacity, 0.0, 1.0);
#else
    result = geofx_restyle(clamp(result, vec3(0.0), vec3(1.0)), style.x, style.y, style.z);
#endif
    // The line around the close-up has the color of its region.
    if (anchor.x > 0.0 && sharp) result = mix(result, tint.rgb, line);
    return vec4(result, opacity * cover * style.w);
}

// The color of an anchor with a geometry of its own.
vec4 SLOT_fenceColor(vec2 fence)
{
    int item = SLOT_target / 2;
    vec3 tint = SLOT_item(item, 8).rgb;
    if (fence.y > 0.5) return vec4(tint, 1.0);
    vec4 anchor = SLOT_item(item, 13);
    float veil = SLOT_rowAt(anchor.z, fence.x, true).r * anchor.w;
    if (veil < 0.002) discard;
    return vec4(tint, veil);
}
