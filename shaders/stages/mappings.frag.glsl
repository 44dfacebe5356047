// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// ProjectiveMappings in the fragment stage: draws all mappings over a fragment, the lowest first. SLOT_ stands for
// the effect's prefix. osgGeoFX/mapping/detail/MappingRecord.cpp writes the records, and
// osgGeoFX/mapping/detail/MappingIndex.cpp the grid.
#include "lib/mapping.glsl"

#pragma import_defines(GEOFX_MAPPING_CHANNELS, GEOFX_IN_PASS)
// All mappings come from pages, on which they were composed beforehand (osgGeoFX/mapping/detail/CameraPages.h). Passes
// that draw the scene again may show other ground, and some show other mappings: they go through the mappings themselves.
#pragma import_defines(SLOT_PAGES, SLOT_PAGE_BASE)
#if defined(SLOT_PAGES) && !defined(GEOFX_MAPPING_CHANNELS) && !defined(GEOFX_IN_PASS) && !defined(SLOT_COMPOSE)
#define SLOT_PAGED
#endif
// What some of the mappings need; MappingRecord.h lists these defines. Code that no mapping needs is left out, since
// compilers of CPUs run through all branches.
#pragma import_defines(SLOT_COLORS, SLOT_VALUES, SLOT_CLASSES)
#pragma import_defines(SLOT_TABLES, SLOT_MATRICES, SLOT_MASKS)
#pragma import_defines(SLOT_PROJECTIVE, SLOT_PINHOLES, SLOT_SYMBOLS)
#pragma import_defines(SLOT_FADES, SLOT_HEIGHTS, SLOT_BLENDS)
#pragma import_defines(SLOT_RANGES, SLOT_NEAREST, SLOT_PATTERNS, SLOT_LINEAR, SLOT_IN_TURN)
#pragma import_defines(SLOT_GROUND_ONLY, GEOFX_RIGID)
// If a first turn is certain, a loop has its condition at the end, for the same reason: with the condition at the
// start, those compilers run through a whole last turn that does nothing.

uniform usamplerBuffer SLOT_data;
uniform sampler2DArray SLOT_layers;
uniform sampler2D SLOT_tables;
uniform mat4 SLOT_toFrame; // from eye space
uniform vec4 SLOT_curve;   // the globe's curvature; 0 on a projected terrain
uniform vec4 SLOT_root;    // the grid's origin and one over its size
uniform vec4 SLOT_pixel;   // what a pixel spans, metres: at a metre from the eye, and at any distance beside that; opacity
uniform ivec2 SLOT_start;  // the grid's first block; the list of all mappings, if fragments test them all
uniform vec3 SLOT_quality; // probes at most; one over the pages' and tables' sides

in vec3 SLOT_position;
in vec3 SLOT_place;

#ifdef SLOT_PAGED
uniform sampler2D SLOT_pageTable; // osgGeoFX/mapping/detail/PageTable.h
uniform sampler2D SLOT_pages;      // colors times opacities, and opacities
uniform vec3 SLOT_pageFrame;  // the place of the origin, in the table's squares; one over their side
uniform vec3 SLOT_pageWindow; // the middle of the square from which squares count, in the table; the width of one
uniform vec4 SLOT_pageShape;  // the sides of a slot and of a page without its border, in the texture of pages
uniform vec2 SLOT_pageStart;  // the border
#ifdef SLOT_PAGE_BASE
// A mapping below all others that changes the scene's own color alike everywhere.
uniform vec4 SLOT_baseRed;
uniform vec4 SLOT_baseGreen;
uniform vec4 SLOT_baseBlue;
uniform float SLOT_baseStrength;
#endif

vec4 SLOT_color(vec4 color)
{
#if defined(SLOT_GROUND_ONLY) && defined(GEOFX_RIGID)
    return color; // a building
#endif
    // The other side of the globe has the same places once more.
    if (SLOT_curve.x * SLOT_position.z < -1.0) return color;
    vec2 p = SLOT_place.xy * SLOT_pageFrame.z + SLOT_pageFrame.xy;
    // The table's texel, at its middle. What lies beyond is blank, as its outermost texels are.
    vec3 word = texture(SLOT_pageTable, floor(p) * SLOT_pageWindow.z + SLOT_pageWindow.xy).xyz * 255.0 + 0.5;
    vec2 within = fract(p * intBitsToFloat(int(word.z) << 23));
    vec4 page = texture(SLOT_pages, floor(word.xy) * SLOT_pageShape.xy + (within * SLOT_pageShape.zw + SLOT_pageStart));
    vec3 below = color.rgb;
#ifdef SLOT_PAGE_BASE
    vec4 rgb = vec4(below, 1.0);
    vec3 changed = vec3(dot(SLOT_baseRed, rgb), dot(SLOT_baseGreen, rgb), dot(SLOT_baseBlue, rgb));
    below = mix(below, clamp(changed, 0.0, 1.0), SLOT_baseStrength);
#endif
    return vec4(below * (1.0 - page.a) + page.rgb, color.a);
}
#else
const uint SLOT_block = 0x80000000u;

uint SLOT_word(uvec4 words, uint which)
{
    return which < 2u ? (which == 0u ? words.x : words.y) : (which == 2u ? words.z : words.w);
}

// The list of the mappings over a place; 0 for none.
uint SLOT_find(vec2 place)
{
    vec2 p = (place - SLOT_root.xy) * SLOT_root.z;
    if (SLOT_start.x == 0 || !all(greaterThanEqual(p, vec2(0.0))) || !all(lessThan(p, vec2(1.0))))
    {
        return 0u;
    }
    uint word = SLOT_block | uint(SLOT_start.x);
    do
    {
        p *= 8.0;
        vec2 cell = min(floor(p), vec2(7.0));
        p -= cell;
        uint index = uint(cell.y) * 8u + uint(cell.x);
        uvec4 words = texelFetch(SLOT_data, int((word & ~SLOT_block) + (index >> 2u)));
        word = SLOT_word(words, index & 3u);
    } while ((word & SLOT_block) != 0u);
    return word;
}

// What a mapping needs of the fragment.
struct SLOT_Fragment
{
    vec3 place;
    vec3 across; // to the next pixel
    vec3 up;
    vec3 positionAcross; // the same of SLOT_position
    vec3 positionUp;
    vec3 eye; // in the mappings' frame
};

#ifdef SLOT_LINEAR
vec3 SLOT_linear(vec3 color)
{
    return mix(color / 12.92, pow((color + 0.055) / 1.055, vec3(2.4)), greaterThan(color, vec3(0.04045)));
}
#endif

#ifdef SLOT_PATTERNS
uniform vec4 SLOT_gridOrigin; // of the frame: longitude and latitude, degrees, or x and y, metres; each as a round number and the rest
uniform vec4 SLOT_gridGlobe;  // geofx_Graticule without its last; 0 on a projected terrain
uniform float SLOT_gridDrift; // its last

vec2 SLOT_grid(vec3 position)
{
    if (SLOT_gridGlobe.z == 0.0) return position.xy;
    return geofx_degrees(geofx_Graticule(SLOT_gridGlobe.x, SLOT_gridGlobe.y, SLOT_gridGlobe.z, SLOT_gridGlobe.w,
                                         SLOT_gridDrift), position);
}

// `how`: interval, width, and the direction across hatching.
float SLOT_pattern(uint kind, vec4 how, float index, SLOT_Fragment fragment)
{
    if (kind == 1u) return geofx_isolines(fragment.place.z, fragment.across.z, fragment.up.z, how.x, how.y, index);
    if (kind == 3u)
        return geofx_isolines(dot(fragment.place.xy, how.zw), dot(fragment.across.xy, how.zw), dot(fragment.up.xy, how.zw),
                              how.x, how.y, index);
    if (kind == 4u) return geofx_dots(fragment.place.xy, fragment.across.xy, fragment.up.xy, how.x, how.y);
    vec2 at = SLOT_grid(SLOT_position);
    vec2 across = SLOT_grid(SLOT_position + fragment.positionAcross) - at;
    vec2 up = SLOT_grid(SLOT_position + fragment.positionUp) - at;
    // So that lines have the numbers that people know, and floats enough digits.
    at += mod(SLOT_gridOrigin.xz, how.x * max(index, 1.0)) + SLOT_gridOrigin.yw;
    return max(geofx_isolines(at.x, across.x, up.x, how.x, how.y, index),
               geofx_isolines(at.y, across.y, up.y, how.x, how.y, index));
}
#endif

struct SLOT_Slot
{
    float page;
    float last;  // level
    vec2 corner; // texels
    vec2 size;
};

SLOT_Slot SLOT_slotOf(uvec4 words)
{
    return SLOT_Slot(float(words.x & 0xffffu), float(words.x >> 16u), vec2(words.y & 0xffffu, words.y >> 16u),
                     vec2(words.z & 0xffffu, words.z >> 16u));
}

// 2 to the power of a whole number.
float SLOT_power(float exponent)
{
    return intBitsToFloat((int(exponent) + 127) << 23);
}

#if defined(SLOT_VALUES) || defined(SLOT_CLASSES)
// The value of a texel, whose four bytes are those of a float.
float SLOT_texel(SLOT_Slot slot, ivec2 texel, int level)
{
    ivec2 most = max((ivec2(slot.size) - 1) >> level, ivec2(0));
    ivec2 corner = ivec2(slot.corner) >> level;
    vec4 bytes = texelFetch(SLOT_layers, ivec3(corner + clamp(texel, ivec2(0), most), int(slot.page)), level);
    uvec4 b = uvec4(bytes * 255.0 + 0.5);
    return uintBitsToFloat(b.x | b.y << 8u | b.z << 16u | b.w << 24u);
}

// x: the sum of the weighted values that are data. y: the sum of their weights.
vec2 SLOT_weighted(float value, float weight)
{
    // The bits tell, since compilers may assume that there are no NaNs.
    return (floatBitsToUint(value) & 0x7f800000u) == 0x7f800000u ? vec2(0.0) : vec2(value * weight, weight);
}

vec2 SLOT_valueOf(SLOT_Slot slot, vec2 at, float level, bool smoothly)
{
    int whole = int(level + 0.5);
    at = clamp(at, vec2(0.0), slot.size) * SLOT_power(float(-whole));
    if (!smoothly)
    {
        return SLOT_weighted(SLOT_texel(slot, ivec2(floor(at)), whole), 1.0);
    }
    at -= 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 t = at - vec2(low);
    return SLOT_weighted(SLOT_texel(slot, low, whole), (1.0 - t.x) * (1.0 - t.y)) +
           SLOT_weighted(SLOT_texel(slot, low + ivec2(1, 0), whole), t.x * (1.0 - t.y)) +
           SLOT_weighted(SLOT_texel(slot, low + ivec2(0, 1), whole), (1.0 - t.x) * t.y) +
           SLOT_weighted(SLOT_texel(slot, low + ivec2(1, 1), whole), t.x * t.y);
}
#endif

// A color with the share of the place that has data. Averages of colors are weighted by their alphas.
struct SLOT_Sample
{
    vec4 color;
    float value; // of value layers
    float cover;
};

// `at` in texels.
SLOT_Sample SLOT_sample(SLOT_Slot slot, uint flags, vec2 at, geofx_Filter how)
{
    uint kind = flags & 3u;
    bool smoothly = (flags & 4u) != 0u;
    float level = smoothly ? how.level : floor(how.level + 0.5);
    at -= how.step * (0.5 * (how.probes - 1.0));
    float left = how.probes;
    SLOT_Sample result = SLOT_Sample(vec4(1.0), 0.0, 0.0);
#ifdef SLOT_COLORS
    if (kind == 1u)
    {
        // The place stays half a texel away from the borders of its level, so that nothing of neighbouring slots is
        // mixed in. If a level's texel is larger than the picture, the place is the texel's middle.
        float inset = 0.5 * SLOT_power(ceil(level));
        vec2 low = slot.corner + inset;
        vec2 high = max(slot.corner + slot.size - inset, low);
        vec4 sum = vec4(0.0);
        do
        {
            vec2 there = slot.corner + at;
#ifdef SLOT_NEAREST
            float texel = SLOT_power(level);
            if (!smoothly) there = slot.corner + (floor(clamp(at, vec2(0.0), slot.size) / texel) + 0.5) * texel;
#endif
            vec4 found = textureLod(SLOT_layers, vec3(clamp(there, low, high) * SLOT_quality.y, slot.page), level);
            sum += vec4(found.rgb * found.a, found.a);
            at += how.step;
        } while (--left > 0.0);
        result.color = vec4(sum.rgb / max(sum.a, 1e-6), sum.a / how.probes);
        result.cover = 1.0;
    }
#endif
#if defined(SLOT_VALUES) || defined(SLOT_CLASSES)
    if (kind > 1u)
    {
        vec2 values = vec2(0.0);
        do
        {
            values += SLOT_valueOf(slot, at, level, smoothly);
            at += how.step;
        } while (--left > 0.0);
        result.cover = values.y / how.probes;
        result.value = values.y > 0.0 ? values.x / values.y : 0.0;
    }
#endif
    return result;
}

#ifdef SLOT_TABLES
// A color table's entry for a value; w is negative for no entry. `row` in rows.
vec4 SLOT_entry(float value, vec4 range, float row, uint flags)
{
    float share = (value - range.x) * range.y;
    if ((flags & 0x100000u) != 0u && clamp(share, 0.0, 1.0) != share) return vec4(-1.0);
    float t = clamp(share, 0.0, 1.0) * (1.0 - SLOT_quality.z) + 0.5 * SLOT_quality.z;
    if ((flags & 0x10000u) != 0u) t = (floor(t / SLOT_quality.z) + 0.5) * SLOT_quality.z;
    return textureLod(SLOT_tables, vec2(t, row / float(textureSize(SLOT_tables, 0).y)), 0.0);
}

#ifdef SLOT_CLASSES
// The colors of classes may be averaged, but classes have no values in between.
SLOT_Sample SLOT_classes(SLOT_Slot slot, uint flags, vec2 at, geofx_Filter how, vec4 range, float row)
{
    float level = floor(how.level + 0.5);
    at -= how.step * (0.5 * (how.probes - 1.0));
    float left = how.probes;
    vec4 sum = vec4(0.0);
    float count = 0.0;
    do
    {
        vec2 value = SLOT_valueOf(slot, at, level, false);
        vec4 entry = value.y > 0.0 ? SLOT_entry(value.x, range, row, flags) : vec4(-1.0);
        if (entry.a >= 0.0)
        {
            sum += vec4(entry.rgb * entry.a, entry.a);
            ++count;
        }
        at += how.step;
    } while (--left > 0.0);
    return SLOT_Sample(vec4(sum.rgb / max(sum.a, 1e-6), sum.a / max(count, 1.0)), 0.0, count / how.probes);
}
#endif
#endif

// A mapping at the fragment.
struct SLOT_Mapping
{
    int record;
    uint flags;
    float opacity;
    vec2 uv; // raster coordinates at the fragment: 0 to 1 within the raster
    vec2 across; // the change of these to the next pixel
    vec2 up;
    float pixels; // the width of a symbol
};

SLOT_Mapping SLOT_mappingAt(int record, SLOT_Fragment fragment)
{
    uvec4 head = texelFetch(SLOT_data, record + 1);
    vec4 rows = uintBitsToFloat(texelFetch(SLOT_data, record));
    geofx_Projector projector = geofx_Projector(uintBitsToFloat(head.xy), rows.xy, rows.zw, vec2(0.0));
    SLOT_Mapping result;
    result.record = record;
    result.flags = head.w;
    result.opacity = uintBitsToFloat(head.z);
    result.pixels = 0.0;
#ifdef SLOT_SYMBOLS
    if ((result.flags & 0x6c0u) != 0u) // fades by distance and size, size in pixels, turned to the camera
    {
        vec4 symbol = uintBitsToFloat(texelFetch(SLOT_data, record + 10)); // center, its height, half size
        vec3 way = fragment.eye - symbol.xyz;
        float metres = max(length(way) * SLOT_pixel.x + SLOT_pixel.y, 1e-9); // that a pixel spans there
        result.pixels = 2.0 * symbol.w / metres;
        float wanted = uintBitsToFloat(texelFetch(SLOT_data, record + 12).z);
        if ((result.flags & 0x200u) != 0u)
        {
            // Never larger than the footprint, which the grid knows.
            float scale = max(result.pixels / wanted, 1.0);
            projector.rowU *= scale;
            projector.rowV *= scale;
            result.pixels = min(result.pixels, wanted);
        }
        if ((result.flags & 0x400u) != 0u)
        {
            vec2 north = normalize(-way.xy + vec2(0.0, 1e-6));
            vec2 u = projector.rowU;
            vec2 v = projector.rowV;
            projector.rowU = vec2(u.x * north.y + u.y * north.x, u.y * north.y - u.x * north.x);
            projector.rowV = vec2(v.x * north.y + v.y * north.x, v.y * north.y - v.x * north.x);
        }
    }
#endif
#ifdef SLOT_PINHOLES
    if ((result.flags & 0x20u) != 0u)
    {
        vec4 eye = uintBitsToFloat(texelFetch(SLOT_data, record + 16));
        vec4 right = uintBitsToFloat(texelFetch(SLOT_data, record + 17));
        vec4 upwards = uintBitsToFloat(texelFetch(SLOT_data, record + 18));
        vec4 forward = uintBitsToFloat(texelFetch(SLOT_data, record + 19));
        vec4 radial = uintBitsToFloat(texelFetch(SLOT_data, record + 20));
        vec4 more = uintBitsToFloat(texelFetch(SLOT_data, record + 21));
        geofx_Pinhole camera = geofx_Pinhole(eye.xyz, right.xyz, upwards.xyz, forward.xyz, radial.xyz, more.xy,
                                             more.zw, radial.w);
        result.uv =
            distance(camera.eye, SLOT_position) <= eye.w ? geofx_projectPinhole(camera, SLOT_position) : vec2(-1.0);
        result.across = geofx_projectPinholeStep(camera, SLOT_position, fragment.positionAcross);
        result.up = geofx_projectPinholeStep(camera, SLOT_position, fragment.positionUp);
        return result;
    }
#endif
#ifdef SLOT_PROJECTIVE
    if ((result.flags & 0x10u) != 0u)
    {
        projector.rowW = uintBitsToFloat(texelFetch(SLOT_data, record + 9).xy);
        result.uv = geofx_projectPlane(projector, fragment.place.xy);
        result.across = geofx_projectPlaneStep(projector, fragment.place.xy, fragment.across.xy);
        result.up = geofx_projectPlaneStep(projector, fragment.place.xy, fragment.up.xy);
        return result;
    }
#endif
    vec2 d = fragment.place.xy - projector.center;
    result.uv = 0.5 + vec2(dot(projector.rowU, d), dot(projector.rowV, d));
    result.across = vec2(dot(projector.rowU, fragment.across.xy), dot(projector.rowV, fragment.across.xy));
    result.up = vec2(dot(projector.rowU, fragment.up.xy), dot(projector.rowV, fragment.up.xy));
    return result;
}

// Whether the fragment lies within the mapping, and takes it.
bool SLOT_meets(SLOT_Mapping mapping)
{
#ifdef GEOFX_MAPPING_CHANNELS
    if (((mapping.flags >> 24u) & uint(GEOFX_MAPPING_CHANNELS)) == 0u) return false;
#endif
    return all(greaterThanEqual(mapping.uv, vec2(0.0))) && all(lessThanEqual(mapping.uv, vec2(1.0)));
}

#ifdef SLOT_FADES
float SLOT_fade(SLOT_Mapping mapping, SLOT_Fragment fragment)
{
    float strength = 1.0;
    vec4 fade = uintBitsToFloat(texelFetch(SLOT_data, mapping.record + 11));
    if ((mapping.flags & 0x40u) != 0u)
    {
        float away = distance(fragment.eye, SLOT_position);
        float soft = uintBitsToFloat(texelFetch(SLOT_data, mapping.record + 12).w);
        strength *= geofx_ramp(away, fade.x * (1.0 - soft), fade.x) * geofx_ramp(-away, -fade.y * (1.0 + soft), -fade.y);
    }
    if ((mapping.flags & 0x80u) != 0u) strength *= geofx_ramp(mapping.pixels, fade.z, fade.w);
    if ((mapping.flags & 0x100u) != 0u)
    {
        vec3 normal = cross(fragment.across, fragment.up);
        float cosine = abs(normal.z) / max(length(normal), 1e-12);
        vec2 slope = uintBitsToFloat(texelFetch(SLOT_data, mapping.record + 12).xy);
        strength *= geofx_ramp(cosine, slope.x, slope.y);
    }
    return strength;
}
#endif

vec4 SLOT_apply(SLOT_Mapping mapping, vec4 color, SLOT_Fragment fragment)
{
    int record = mapping.record;
    uint flags = mapping.flags;
    vec2 uv = mapping.uv;
    float strength = mapping.opacity * SLOT_pixel.z;
    uvec4 slotWords = texelFetch(SLOT_data, record + 2);
    uint codes = slotWords.w;
#if defined(SLOT_HEIGHTS) || defined(SLOT_TABLES)
    vec3 more = uintBitsToFloat(texelFetch(SLOT_data, record + 3).xyz);
#endif
#ifdef SLOT_HEIGHTS
    if ((flags & 0x2000u) != 0u && !(fragment.place.z >= more.x && fragment.place.z <= more.y)) return color;
#endif
    if ((flags & 0x1000u) != 0u)
    {
        vec2 width = max(abs(mapping.across), abs(mapping.up));
        strength *= geofx_edge(uv.x, width.x) * geofx_edge(uv.y, width.y);
    }
#ifdef SLOT_FADES
    if ((flags & 0x1c0u) != 0u) strength *= SLOT_fade(mapping, fragment);
#endif
    if (strength <= 0.0) return color;

    uint sourceOf = (codes >> 12u) & 3u;
#ifdef SLOT_COMPOSE
    if (sourceOf == 2u) return color; // which the scene's color must be known for
#endif
    uint alphaOf = (codes >> 14u) & 3u;
    vec4 constant = vec4(0.0);
    vec4 range = vec4(0.0, 1.0, 0.0, 1.0);
#ifdef SLOT_RANGES
    if ((flags & 0x8000u) != 0u)
    {
        range = uintBitsToFloat(texelFetch(SLOT_data, record + 4));
        constant = uintBitsToFloat(texelFetch(SLOT_data, record + 8));
    }
#endif
    uint kind = flags & 3u;
    bool coloredClasses = kind == 3u && sourceOf == 1u;
    SLOT_Sample found = SLOT_Sample(vec4(1.0), 0.0, 1.0);
#if defined(SLOT_COLORS) || defined(SLOT_VALUES) || defined(SLOT_CLASSES)
    if (kind != 0u)
    {
        SLOT_Slot slot = SLOT_slotOf(slotWords);
        float probes = kind == 1u ? SLOT_quality.x : kind == 2u || coloredClasses ? min(SLOT_quality.x, 4.0) : 1.0;
        geofx_Filter how = geofx_filter(mapping.across * slot.size, mapping.up * slot.size, probes, slot.last);
#if defined(SLOT_CLASSES) && defined(SLOT_TABLES)
        if (coloredClasses)
            found = SLOT_classes(slot, flags, uv * slot.size, how, range, more.z);
        else
#endif
            found = SLOT_sample(slot, flags, uv * slot.size, how);
        if (found.cover <= 0.0) return color;
    }
#endif
    vec4 source = found.color;
#if defined(SLOT_RANGES) || defined(SLOT_TABLES)
    float grey = kind == 1u ? dot(found.color.rgb, vec3(0.2126, 0.7152, 0.0722)) : found.value;
#endif
#ifdef SLOT_TABLES
    if (sourceOf == 1u && !coloredClasses)
    {
        vec4 entry = SLOT_entry(grey, range, more.z, flags);
        if (entry.a < 0.0) return color;
        // The table gives the color. The layer gives the share.
        source = vec4(entry.rgb, entry.a * (kind == 1u ? source.a : 1.0));
    }
#endif
#ifdef SLOT_RANGES
    if (kind > 1u && sourceOf == 0u) source = vec4(vec3(clamp((grey - range.x) * range.y, 0.0, 1.0)), 1.0);
    if (sourceOf == 3u) source.rgb = constant.rgb;
#endif
    if (sourceOf == 2u) source = vec4(color.rgb, 1.0);
#ifdef SLOT_LINEAR
    if (sourceOf != 2u) source.rgb = SLOT_linear(source.rgb);
#endif
#ifdef SLOT_MATRICES
    if ((flags & 8u) != 0u)
    {
        vec4 red = uintBitsToFloat(texelFetch(SLOT_data, record + 5));
        vec4 green = uintBitsToFloat(texelFetch(SLOT_data, record + 6));
        vec4 blue = uintBitsToFloat(texelFetch(SLOT_data, record + 7));
        vec4 rgb = vec4(source.rgb, 1.0);
        source.rgb = clamp(vec3(dot(red, rgb), dot(green, rgb), dot(blue, rgb)), 0.0, 1.0);
    }
#endif
    if (alphaOf == 0u) source.a = 1.0;
#ifdef SLOT_MASKS
    if (alphaOf == 2u)
    {
        SLOT_Slot slot = SLOT_slotOf(texelFetch(SLOT_data, record + 13));
        uint maskKind = (flags >> 17u) & 7u; // as the layer's own
        float probes = (maskKind & 3u) == 3u ? 1.0 : min(SLOT_quality.x, 4.0);
        geofx_Filter how = geofx_filter(mapping.across * slot.size, mapping.up * slot.size, probes, slot.last);
        SLOT_Sample mask = SLOT_sample(slot, maskKind, uv * slot.size, how);
        float share = mask.value;
        if ((maskKind & 3u) == 1u) share = dot(mask.color.rgb, vec3(0.2126, 0.7152, 0.0722)) * mask.color.a;
        source.a = mask.cover * geofx_ramp(share, range.z, range.w);
    }
#endif
#ifdef SLOT_RANGES
    if (alphaOf == 3u) source.a = geofx_ramp(grey, range.z, range.w);
#endif
    strength *= found.cover;
#ifdef SLOT_PATTERNS
    uint pattern = (codes >> 16u) & 7u;
    if (pattern != 0u)
        source.a *= SLOT_pattern(pattern, uintBitsToFloat(texelFetch(SLOT_data, record + 13)), float((codes >> 19u) & 31u),
                                 fragment);
#endif

#ifdef SLOT_BLENDS
    int equation = int((codes >> 8u) & 15u);
    if (equation == 8)
    {
        if (strength * source.a >= 0.5) discard;
        return color;
    }
    if ((codes & 0xfffu) != 0x076u)
    {
        vec3 blended = geofx_blend(equation, int(codes & 15u), int((codes >> 4u) & 15u), source, color, constant);
        return vec4(mix(color.rgb, blended, strength), color.a);
    }
#endif
    // The usual case: source over destination.
#ifdef SLOT_COMPOSE
    return mix(color, vec4(source.rgb, 0.0), strength * source.a); // alpha: the share of what lies below
#else
    return vec4(mix(color.rgb, source.rgb, strength * source.a), color.a);
#endif
}

vec4 SLOT_color(vec4 color)
{
#if defined(SLOT_GROUND_ONLY) && defined(GEOFX_RIGID)
    return color; // a building
#endif
    SLOT_Fragment fragment = SLOT_Fragment(SLOT_place, dFdx(SLOT_place), dFdy(SLOT_place), dFdx(SLOT_position),
                                           dFdy(SLOT_position), SLOT_toFrame[3].xyz);
    uint list = SLOT_start.y != 0 ? uint(SLOT_start.y) : SLOT_find(SLOT_place.xy);
    if (list == 0u) return color;
    // The other side of the globe has the same places once more.
    if (SLOT_curve.x * SLOT_position.z < -1.0) return color;
    uint count = texelFetch(SLOT_data, int(list)).x;
    uint i = 0u;
    do
    {
        // Goes on to the next mapping over the fragment before the work, so that the work is done as often as the
        // fragment has mappings. In very long lists each mapping has a turn of one loop instead: some compilers count
        // the turns of all loops.
        SLOT_Mapping mapping;
        bool met;
#ifndef SLOT_IN_TURN
        do
#endif
        {
            ++i;
            uvec4 words = texelFetch(SLOT_data, int(list + (i >> 2u)));
            mapping = SLOT_mappingAt(int(SLOT_word(words, i & 3u)), fragment);
            met = SLOT_meets(mapping);
        }
#ifndef SLOT_IN_TURN
        while (!met && i < count);
#endif
        if (met) color = SLOT_apply(mapping, color, fragment);
    } while (i < count);
    return color;
}
#endif
