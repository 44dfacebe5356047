#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The effects of a scene in the fragment stage. Declare and call this in a fragment shader of your own:
//
//     vec4 geofx_fragment(vec4 color, vec4 map);    // `map`: what the context shows instead, or vec4(0.0)
//
// A shader that lights fragments may ask for the shadows of SunShadows:
//
//     float geofx_sunlight();    // the share of light 0 that reaches the fragment, 0 to 1
//
// EffectScene puts the code of its effects in the place of the words in capitals.
#pragma import_defines(GEOFX_DEFORMATION)
#pragma import_defines(GEOFX_NORMAL_MAP)
#pragma import_defines(GEOFX_SHADOWED)
GEOFX_IMPORTED_EFFECTS
#include "stages/view.glsl"
in float geofx_styleBlend;
bool geofx_isLine = false; // whether it is a fragment of a line on the ground
#ifdef GEOFX_SHADOWED
in vec3 geofx_shade;
vec3 geofx_lightInShade()
{
    return geofx_shade;
}
#endif
// Where the fragment is in the camera's window, pixels. A pass may draw into a texture that begins elsewhere.
vec2 geofx_pixel();
#if defined(GEOFX_HOST_NORMAL) || defined(GEOFX_NORMAL_MAP)
// What lies on the ground is lit by normals of fragments: an engine's own (osgGeoFX/scene/ShaderHost.h), or those of a
// texture in the frame of the geometry (effect/detail/TileNormals.h).
#define GEOFX_FRAGMENT_NORMAL
in vec3 geofx_groundPlace;

vec3 geofx_ground()
{
    return geofx_inEye(geofx_groundPlace);
}
#endif
#ifdef GEOFX_HOST_NORMAL
vec3 geofx_eyeNormal()
{
    return geofx_directionInView(GEOFX_HOST_NORMAL);
}
#elif defined(GEOFX_NORMAL_MAP)
in vec2 geofx_normalPlace;
uniform sampler2D geofx_normals;

vec3 geofx_eyeNormal()
{
    vec3 texel = texture(geofx_normals, geofx_normalPlace).rgb;
    vec3 normal = (255.0 * texel - 128.0) / 127.0;
    // Without a third channel; no byte is 0.
    if (texel.b < 0.002) normal.z = sqrt(max(1.0 - dot(normal.xy, normal.xy), 0.0));
    return geofx_directionInView(gl_NormalMatrix * normalize(normal));
}

float geofx_normalSize()
{
    return length(geofx_eyeNormal());
}
#endif
GEOFX_EFFECT_FUNCTIONS
#ifdef GEOFX_FRAGMENT_NORMAL
vec3 geofx_turnedNormal()
{
    vec3 normal = normalize(geofx_eyeNormal());
#ifdef GEOFX_DEFORMATION
GEOFX_NORMAL_CALLS
#endif
    return geofx_directionInEye(normal);
}
#endif
float geofx_sunlight()
{
    float light = 1.0;
GEOFX_LIGHT_CALLS
    return light;
}

// The same for a fragment of a line.
float geofx_sunlightOfLine()
{
    geofx_isLine = true;
    return geofx_sunlight();
}

vec2 geofx_pixel()
{
    vec2 pixel = gl_FragCoord.xy;
GEOFX_PIXEL_CALLS
    return pixel;
}

// What a pass makes of a color at last: for what has its color from elsewhere.
vec4 geofx_finish(vec4 color)
{
    vec4 result = color;
GEOFX_FINISH_CALLS
    return result;
}

vec4 geofx_fragment(vec4 color, vec4 map)
{
    vec4 result = color;
GEOFX_COLOR_CALLS
    return geofx_finish(result);
}
