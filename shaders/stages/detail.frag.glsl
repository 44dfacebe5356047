// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// GroundDetail in the fragment stage. SLOT_ stands for the effect's prefix.
#pragma import_defines(GEOFX_DETAIL, GEOFX_PAINTED, GEOFX_RIGID)
#pragma import_defines(GEOFX_LIGHTS, GEOFX_TEXTURE_0, GEOFX_TEXGEN_0)
#include "lib/detail.glsl"
#include "stages/shore.glsl"

uniform mat4 SLOT_toFrame;
uniform mat4 SLOT_octaves[GEOFX_DETAIL_MOST]; // from the frame to the noise
uniform vec4 SLOT_waves; // how many octaves, the longest wave, the ground's curvature, whether only known cover counts
uniform vec4 SLOT_how;   // strength, relief, edges, the tree line
uniform vec4 SLOT_sun;   // towards the light in the frame, for ground without light
uniform sampler3D SLOT_noise; // the gradient and the height of waves
uniform sampler2D SLOT_cover; // lib/cover.glsl
uniform sampler2D SLOT_colors;

in vec3 SLOT_position;
in vec3 SLOT_ground;

// Textures that only modulate can be looked up again, by coordinates that are the vertices' own.
#if defined(GEOFX_TEXTURE_0) && !defined(GEOFX_TEXGEN_0)
#define SLOT_TEXTURED ((GEOFX_TEXTURE_0 & 7) == 1)
#else
#define SLOT_TEXTURED false
#endif

vec3 SLOT_towardsLight()
{
#if defined(GEOFX_LIGHTS) && !defined(GEOFX_HOST_NORMAL) && !defined(GEOFX_CORE)
    if ((GEOFX_LIGHTS & 1) != 0)
    {
        vec4 light = gl_LightSource[0].position;
        vec3 towards = light.w == 0.0 ? mat3(SLOT_toFrame) * geofx_directionInView(light.xyz)
                                      : (SLOT_toFrame * vec4(geofx_inView(light.xyz / light.w), 1.0)).xyz - SLOT_position;
        float distance = length(towards);
        if (distance > 0.0) return towards / distance;
    }
#endif
    return SLOT_sun.xyz;
}

float SLOT_steepness()
{
#ifdef GEOFX_FRAGMENT_NORMAL
    vec3 normal = mat3(SLOT_toFrame) * geofx_eyeNormal();
    return length(normal.xy) / max(abs(normal.z), 0.02);
#else
    return SLOT_ground.z;
#endif
}

// A pixel on the ground.
struct SLOT_Pixel
{
    float metres; // its longer side
    float texel;  // metres of a texel of the colors
    float pixels; // that a texel takes across the view
    float sharp;  // and along it
};

SLOT_Pixel SLOT_pixelOf(vec2 size)
{
    vec3 right = dFdx(SLOT_position), up = dFdy(SLOT_position);
    vec2 texelRight = dFdx(SLOT_ground.xy) * size, texelUp = dFdy(SLOT_ground.xy) * size;
    SLOT_Pixel pixel;
    pixel.metres = max(length(right), length(up));
    float longer = max(length(texelRight), length(texelUp));
    float shorter = abs(texelRight.x * texelUp.y - texelRight.y * texelUp.x) / max(longer, 1e-12);
    // Without a texture a texel is as large as the ground.
    bool none = !(longer > 1e-9);
    pixel.texel = none ? 1e6 : pixel.metres / longer;
    pixel.pixels = none ? 1e6 : 1.0 / max(shorter, 1e-6);
    pixel.sharp = none ? 1e6 : 1.0 / longer;
    return pixel;
}

// The ground's own colors, and its cover, with sharp borders.
struct SLOT_Texels
{
    vec3 smoothColor;
    vec3 color;
    vec4 cover;
};

#ifdef GEOFX_TEXTURE_0
// The texels of one side of the shore around a place, the nearest ones above all; as they were where there are none. `water`: 1 for the sea's.
SLOT_Texels SLOT_texelsOfSide(SLOT_Texels texels, vec2 at, float water)
{
    ivec2 last = textureSize(SLOT_colors, 0) - 1, low = ivec2(floor(at));
    vec3 color = vec3(0.0), cover = vec3(0.0);
    float all = 0.0;
    for (int i = 0; i < 16; ++i)
    {
        ivec2 place = low + ivec2(i & 3, i >> 2) - 1;
        if (any(lessThan(place, ivec2(0))) || any(greaterThan(place, last))) continue;
        vec4 here = texelFetch(SLOT_cover, place, 0);
        if (step(128.0 / 255.0, here.a) != water) continue;
        vec2 way = vec2(place) - at;
        float weight = exp2(-4.0 * dot(way, way));
        color += weight * texelFetch(SLOT_colors, place, 0).rgb;
        cover += weight * here.rgb;
        all += weight;
    }
    if (all <= 0.0) return texels;
    texels.color = mix(texels.color, color / all, SLOT_how.z);
    texels.cover.rgb = mix(texels.cover.rgb, cover / all, SLOT_how.z);
    return texels;
}
#endif

// `cover`: as it is without them. `none`: the color where there is no texture.
SLOT_Texels SLOT_texelsAt(vec4 cover, vec2 stray, SLOT_Pixel pixel, vec3 none)
{
    SLOT_Texels result;
    result = SLOT_Texels(none, none, cover);
#ifdef GEOFX_TEXTURE_0
    if (SLOT_TEXTURED)
    {
        ivec2 size = textureSize(SLOT_colors, 0);
        ivec2 last = size - 1;
        // Beyond its border a texture begins again.
        vec2 place = SLOT_ground.xy;
        if (any(greaterThan(abs(place - 0.5), vec2(0.501)))) place = fract(place);
        vec2 at = clamp(place * vec2(size) - 0.5, vec2(0.0), vec2(last));
        result.smoothColor = textureLod(SLOT_colors, SLOT_ground.xy, 0.0).rgb;
        // A tile ends with texels that its neighbors have, too: nothing strays there, so there is no seam.
        vec2 room = min(at, vec2(last) - at);
        at += stray * geofx_share(min(room.x, room.y));
        ivec2 low = ivec2(floor(clamp(at, vec2(0.0), vec2(last) - 0.001)));
        ivec2 high = min(low + 1, last);
        vec2 t = at - vec2(low);
        vec3 a = texelFetch(SLOT_colors, low, 0).rgb;
        vec3 b = texelFetch(SLOT_colors, ivec2(high.x, low.y), 0).rgb;
        vec3 c = texelFetch(SLOT_colors, ivec2(low.x, high.y), 0).rgb;
        vec3 d = texelFetch(SLOT_colors, high, 0).rgb;
        vec4 weights = vec4((1.0 - t.x) * (1.0 - t.y), t.x * (1.0 - t.y), (1.0 - t.x) * t.y, t.x * t.y);
        weights = mix(weights, geofx_crispWeights(weights, a, b, c, d, pixel.sharp), SLOT_how.z);
        float water = step(128.0 / 255.0, cover.a);
        bool across = false;
        if (textureSize(SLOT_cover, 0) == size)
        {
            vec4 coverA = texelFetch(SLOT_cover, low, 0);
            vec4 coverB = texelFetch(SLOT_cover, ivec2(high.x, low.y), 0);
            vec4 coverC = texelFetch(SLOT_cover, ivec2(low.x, high.y), 0);
            vec4 coverD = texelFetch(SLOT_cover, high, 0);
            // The shore is the line where its distance is none, and each side has the colors of its own.
            vec4 wet = step(vec4(128.0 / 255.0), vec4(coverA.a, coverB.a, coverC.a, coverD.a));
            vec4 ashore = weights * (1.0 - abs(wet - water));
            float all = dot(ashore, vec4(1.0));
            across = all <= 1e-3;
            if (!across) weights = mix(weights, ashore / all, SLOT_how.z);
            result.cover.rgb = weights.x * coverA.rgb + weights.y * coverB.rgb + weights.z * coverC.rgb + weights.w * coverD.rgb;
        }
        result.color = weights.x * a + weights.y * b + weights.z * c + weights.w * d;
        // The shore is smooth, and samples stray, so all four may lie on the other side.
        if (across) result = SLOT_texelsOfSide(result, at, water);
    }
#endif
    return result;
}

vec4 SLOT_color(vec4 color)
{
#if !defined(GEOFX_DETAIL) || defined(GEOFX_PAINTED) || defined(GEOFX_RIGID)
    return color;
#else
    // Here, since it may need differences between neighboring pixels, and some of these return below.
    float steepness = SLOT_steepness();
    vec2 size = vec2(1.0);
#ifdef GEOFX_TEXTURE_0
    if (SLOT_TEXTURED) size = vec2(textureSize(SLOT_colors, 0));
#endif
    if (size == vec2(1.0)) size = vec2(textureSize(SLOT_cover, 0));
    if (size == vec2(1.0)) size = vec2(0.0);
    SLOT_Pixel pixel = SLOT_pixelOf(size);
    float nearness = SLOT_how.x * geofx_detailNearness(pixel.pixels);
    if (nearness <= 0.0) return color;
    vec4 known = textureLod(SLOT_cover, SLOT_ground.xy, 0.0);
    bool sure = geofx_coverKnown(known);
    if (!sure && SLOT_waves.w > 0.5) return color;
    if (sure) known.a = mix(known.a, geofx_smoothShore(SLOT_cover, SLOT_ground.xy), SLOT_how.z);

    // Light that falls straight down sees no waves.
    vec3 towards = SLOT_towardsLight();
    vec3 level = vec3(towards.xy, 0.0) / max(towards.z, 0.35);
    geofx_DetailWaves waves = geofx_detailCalm();
    vec2 stray = vec2(0.0);
    float wavelength = SLOT_waves.y;
    for (int i = 0; i < int(SLOT_waves.x); ++i)
    {
        float share = geofx_detailFade(wavelength, pixel.metres);
        if (share <= 0.0) break;
        share *= geofx_detailMissing(wavelength, pixel.texel);
        vec4 wave = (255.0 * textureLod(SLOT_noise, (SLOT_octaves[i] * vec4(SLOT_position, 1.0)).xyz, 0.0) - 128.0) / 127.0;
        vec3 light = mat3(SLOT_octaves[i]) * level * (GEOFX_DETAIL_WAVES * wavelength);
        waves = geofx_detailWith(waves, share * geofx_detailBands(wavelength), wave.w, -dot(wave.xyz, light));
        stray += share * min(wavelength / pixel.texel, 1.5) * wave.xy;
        wavelength /= GEOFX_DETAIL_STEP;
    }
    // Streets are straight; the edge of a wood is not.
    stray *= 0.3 * (1.0 - 0.85 * geofx_share(2.0 * known.g));
    SLOT_Texels texels = SLOT_texelsAt(known, stray, pixel, color.rgb);

    geofx_Cover cover;
    float height = SLOT_position.z + 0.5 * SLOT_waves.z * dot(SLOT_position.xy, SLOT_position.xy);
    if (sure)
        cover = geofx_coverOf(texels.cover);
    else
        cover = geofx_likelyCover(height, steepness, SLOT_how.w);
    // The light on the ground, from what it has made of the colors.
    vec3 lit = clamp(color.rgb / max(texels.smoothColor, vec3(0.03)), 0.0, 2.0);
    vec3 own = SLOT_TEXTURED ? lit * texels.color : color.rgb;
    float wet = sure ? geofx_share(cover.shore / max(pixel.metres, 0.01) + 0.5) : step(0.0, cover.shore);
    vec3 detailed = vec3(0.0);
    if (wet < 1.0)
        detailed = own * geofx_detailFactor(geofx_detailClasses(cover, texels.color, steepness), cover, waves, SLOT_how.y);
    if (wet > 0.0)
    {
        float bright = SLOT_TEXTURED ? clamp(dot(lit, vec3(0.3333)), 0.0, 1.0) : 1.0;
        float sea = 1.0 - geofx_ease(abs(height), 2.0, 6.0);
        detailed = mix(detailed, geofx_detailWater(own, cover.shore, sea, waves, SLOT_how.y, bright), wet);
    }
    return vec4(mix(color.rgb, detailed, nearness), color.a);
#endif
}
