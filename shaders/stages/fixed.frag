#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// OpenGL's fixed fragment stage: texture environments, the separate specular color and fog, after OpenGL 2.1,
// Sections 3.8 to 3.10. The effects come before the fog. If a texture has the normals, this stage computes the
// lighting, too.
#pragma import_defines(GEOFX_TEXTURE_0, GEOFX_TEXTURE_1, GEOFX_TEXTURE_2, GEOFX_TEXTURE_3)
#pragma import_defines(GEOFX_COLOR_SUM, GEOFX_FOG, GEOFX_MAP, GEOFX_PAINTED, GEOFX_FADING)
#pragma import_defines(GEOFX_LIGHTS, GEOFX_TWO_SIDED, GEOFX_NORMAL_MAP)
#pragma import_defines(GEOFX_NORMALIZE, GEOFX_RESCALE)
#pragma import_defines(GEOFX_HDR, GEOFX_RIGID)
#pragma import_defines(GEOFX_PART, GEOFX_MIRROR, GEOFX_SHADOWED, GEOFX_GROUND_SHADE)

// OpenGL bounds the colors of fragments where the frame buffer does, too (ARB_color_buffer_float).
#ifdef GEOFX_HDR
#define bounded(color) (color)
#else
#define bounded(color) clamp(color, 0.0, 1.0)
#endif

// What is painted anew needs no light and no textures, unless the painting is only fading in.
#if defined(GEOFX_PAINTED) && !defined(GEOFX_FADING)
#undef GEOFX_LIGHTS
#undef GEOFX_COLOR_SUM
#undef GEOFX_TEXTURE_0
#undef GEOFX_TEXTURE_1
#undef GEOFX_TEXTURE_2
#undef GEOFX_TEXTURE_3
#undef GEOFX_MAP
#undef GEOFX_FOG
#endif

#include "stages/depth.glsl"
#include "stages/parts.glsl"
vec4 geofx_fragment(vec4 color, vec4 map);

#if defined(GEOFX_LIGHTS) && defined(GEOFX_NORMAL_MAP)
#define GEOFX_LIT_HERE
vec3 geofx_ground(); // the undeformed place in eye space
float geofx_normalSize(); // a normal's length in eye space
vec3 geofx_turnedNormal(); // the texture's normal after the effects, of length 1
#include "stages/fixed.light.glsl"
#endif

#if defined(GEOFX_SHADOWED) && defined(GEOFX_LIGHTS)
#if (GEOFX_LIGHTS & 1) != 0
#define GEOFX_SHADES
float geofx_sunlight(); // the share of light 0 that reaches the fragment
vec3 geofx_lightInShade(); // what the vertices have of the others
#endif
#endif

// On terrain seen from its edge, coordinates change by more than the whole texture within a pixel, and go to infinity
// beyond a triangle's border. Only the coarsest level shows there. But Mesa's llvmpipe, in anisotropic filtering,
// would visit every texel between the neighbours, for minutes.
vec4 tame(vec4 coordinates)
{
    vec2 place = coordinates.xy / coordinates.w;
    return all(lessThan(fwidth(place), vec2(4.0))) ? coordinates : vec4(clamp(place, 0.0, 1.0), 0.0, 1.0);
}

// The environments of OpenGL 2.1, Tables 3.22 and 3.23. `code` is 1 modulate, 2 replace, 3 decal, 4 blend, 5 add. It
// has 8 more for base formats without alpha, 16 more for alpha alone, 24 more for intensity, and 32 more for depths that are compared.
vec4 environment(int code, vec4 color, vec4 texel, vec4 constant)
{
    int mode = code & 7;
    int format = (code >> 3) & 3;
    if (mode == 2) return vec4(format == 2 ? color.rgb : texel.rgb, format == 1 ? color.a : texel.a);
    if (mode == 3) return vec4(mix(color.rgb, texel.rgb, texel.a), color.a);
    float alpha = color.a * texel.a;
    if (mode == 4)
    {
        if (format == 3) alpha = mix(color.a, constant.a, texel.a);
        return vec4(mix(color.rgb, constant.rgb, texel.rgb), alpha);
    }
    if (mode == 5)
    {
        if (format == 3) alpha = color.a + texel.a;
        return clamp(vec4(color.rgb + texel.rgb, alpha), 0.0, 1.0);
    }
    return vec4(format == 2 ? color.rgb : color.rgb * texel.rgb, alpha);
}

// The color of a comparison. Samplers of GLSL 1.30 and later know nothing of the depth texture's mode.
vec4 compared(int code, float passed)
{
    int format = (code >> 3) & 3;
    return format == 2 ? vec4(0.0, 0.0, 0.0, passed) : vec4(vec3(passed), format == 3 ? passed : 1.0);
}

#ifdef GEOFX_TEXTURE_0
#if (GEOFX_TEXTURE_0 & 32) != 0
uniform sampler2DShadow geofx_texture0;
#define geofx_texel0 compared(GEOFX_TEXTURE_0, textureProj(geofx_texture0, gl_TexCoord[0]))
#else
uniform sampler2D geofx_texture0;
#define geofx_texel0 texture2DProj(geofx_texture0, tame(gl_TexCoord[0]))
#endif
#endif
#ifdef GEOFX_TEXTURE_1
#if (GEOFX_TEXTURE_1 & 32) != 0
uniform sampler2DShadow geofx_texture1;
#define geofx_texel1 compared(GEOFX_TEXTURE_1, textureProj(geofx_texture1, gl_TexCoord[1]))
#else
uniform sampler2D geofx_texture1;
#define geofx_texel1 texture2DProj(geofx_texture1, tame(gl_TexCoord[1]))
#endif
#endif
#ifdef GEOFX_TEXTURE_2
#if (GEOFX_TEXTURE_2 & 32) != 0
uniform sampler2DShadow geofx_texture2;
#define geofx_texel2 compared(GEOFX_TEXTURE_2, textureProj(geofx_texture2, gl_TexCoord[2]))
#else
uniform sampler2D geofx_texture2;
#define geofx_texel2 texture2DProj(geofx_texture2, tame(gl_TexCoord[2]))
#endif
#endif
#ifdef GEOFX_TEXTURE_3
#if (GEOFX_TEXTURE_3 & 32) != 0
uniform sampler2DShadow geofx_texture3;
#define geofx_texel3 compared(GEOFX_TEXTURE_3, textureProj(geofx_texture3, gl_TexCoord[3]))
#else
uniform sampler2D geofx_texture3;
#define geofx_texel3 texture2DProj(geofx_texture3, tame(gl_TexCoord[3]))
#endif
#endif
#ifdef GEOFX_MAP
uniform sampler2D geofx_map;
#endif

#ifdef GEOFX_FOG
vec4 fogged(vec4 color)
{
    // 1 linear, 2 exp, 3 exp2; 4 more if the distance comes with the vertex.
    float distance = gl_FogFragCoord;
    float clear = 1.0;
    if ((GEOFX_FOG & 3) == 1) clear = (gl_Fog.end - distance) * gl_Fog.scale;
    if ((GEOFX_FOG & 3) == 2) clear = exp(-gl_Fog.density * distance);
    if ((GEOFX_FOG & 3) == 3) clear = exp(-gl_Fog.density * gl_Fog.density * distance * distance);
#ifdef GEOFX_GROUND_SHADE
    color.a *= clamp(clear, 0.0, 1.0); // fog is not darkened
#endif
    return vec4(mix(gl_Fog.color.rgb, bounded(color.rgb), clamp(clear, 0.0, 1.0)), color.a);
}
#endif

void main()
{
    vec4 primary = gl_Color;
    vec4 secondary = gl_SecondaryColor;
#ifdef GEOFX_SHADES
    float sunlight = geofx_sunlight();
#ifdef GEOFX_LIT_HERE
    sunShare = sunlight;
#elif defined(GEOFX_TWO_SIDED)
    if (gl_FrontFacing) primary.rgb = mix(geofx_lightInShade(), primary.rgb, sunlight);
#else
    primary.rgb = mix(geofx_lightInShade(), primary.rgb, sunlight);
    secondary.rgb *= sunlight;
#endif
#endif
#ifdef GEOFX_LIT_HERE
    vec3 normal = geofx_turnedNormal();
#ifndef GEOFX_NORMALIZE
    // OpenGL lights with the length that a normal has in eye space.
    normal *= geofx_normalSize();
#ifdef GEOFX_RESCALE
    normal *= gl_NormalScale;
#endif
#endif
#ifdef GEOFX_TWO_SIDED
    if (gl_FrontFacing)
        illuminate(geofx_ground(), normal, colored(gl_FrontMaterial), primary, secondary);
    else
        illuminate(geofx_ground(), -normal, colored(gl_BackMaterial), primary, secondary);
#else
    illuminate(geofx_ground(), normal, colored(gl_FrontMaterial), primary, secondary);
#endif
#endif
    vec4 color = primary;
#ifdef GEOFX_TEXTURE_0
    color = environment(GEOFX_TEXTURE_0, color, geofx_texel0, gl_TextureEnvColor[0]);
#endif
#ifdef GEOFX_TEXTURE_1
    color = environment(GEOFX_TEXTURE_1, color, geofx_texel1, gl_TextureEnvColor[1]);
#endif
#ifdef GEOFX_TEXTURE_2
    color = environment(GEOFX_TEXTURE_2, color, geofx_texel2, gl_TextureEnvColor[2]);
#endif
#ifdef GEOFX_TEXTURE_3
    color = environment(GEOFX_TEXTURE_3, color, geofx_texel3, gl_TextureEnvColor[3]);
#endif
#ifdef GEOFX_COLOR_SUM
    color.rgb = bounded(color.rgb + secondary.rgb);
#endif
#if defined(GEOFX_FOG) && defined(GEOFX_PAINTED) && defined(GEOFX_FADING)
    color = fogged(color); // a painting has no fog
#endif
#ifdef GEOFX_RIGID
    color = geofx_fragment(color, vec4(primary.rgb, 1.0)); // a building without its texture
#elif defined(GEOFX_MAP)
    color = geofx_fragment(color, primary * texture2DProj(geofx_map, tame(gl_TexCoord[0])));
#else
    color = geofx_fragment(color, vec4(primary.rgb, -1.0)); // the light alone
#endif
#if defined(GEOFX_FOG) && !(defined(GEOFX_PAINTED) && defined(GEOFX_FADING))
    color = fogged(color);
#endif
#if defined(GEOFX_PART) && !defined(GEOFX_MIRROR)
#if GEOFX_PART == GEOFX_PART_NOTHING || defined(GEOFX_GROUND_SHADE)
    discard;
#elif GEOFX_PART == GEOFX_PART_BLACK || GEOFX_PART == GEOFX_PART_WHITE
    color.rgb = vec3(GEOFX_PART == GEOFX_PART_WHITE ? 1.0 : 0.0);
#elif (GEOFX_PART == GEOFX_PART_SHARES || GEOFX_PART == GEOFX_PART_CLASSES) && !defined(GEOFX_PAINTED)
    color.rgb = vec3(0.0, 0.0, GEOFX_PART == GEOFX_PART_SHARES ? 1.0 : 0.0);
#endif
#endif
    gl_FragColor = color;
    GEOFX_PUT_FRAGMENT_DEPTH;
#if defined(GEOFX_GROUND_SHADE) && defined(GEOFX_LOG_DEPTH_OF_FRAGMENTS)
    gl_FragDepth -= 4.0 * fwidth(gl_FragDepth); // osgGeoFX/effect/GroundShade.cpp
#endif
}
