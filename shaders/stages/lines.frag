#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A segment of a map's lines: smooth at its edges.
#pragma import_defines(GEOFX_SHADOWED)
#include "stages/depth.glsl"
#include "lib/lines.glsl"

vec4 geofx_fragment(vec4 color, vec4 map);
float geofx_sunlightOfLine();

in vec4 geofx_linesPlace;
flat in float geofx_linesLength;
in vec2 geofx_linesDash;

uniform vec4 geofx_linesColor;
uniform vec3 geofx_linesDashes; // dash and gap, metres; the shortest dash, pixels

// Lines have no light of their own. What lies in shadow is darker, but not as dark as level ground there: maps have paler shadows, and
// lines are to be read.
vec3 shaded(vec3 color)
{
#if defined(GEOFX_SHADOWED) && !defined(GEOFX_CORE)
    vec3 shade = gl_LightSource[0].ambient.rgb + gl_LightModel.ambient.rgb;
    vec3 all = shade + 0.5 * gl_LightSource[0].diffuse.rgb;
    vec3 dark = mix(shade / max(all, vec3(1e-3)), vec3(1.0), 0.35);
    return color * mix(dark, vec3(1.0), geofx_sunlightOfLine());
#else
    return color;
#endif
}

// As on the ground below. Which mode of osg::Fog is on a shader cannot see: it is EXP where it is not LINEAR. Without fog there are
// OpenGL's defaults.
vec3 fogged(vec3 color)
{
#ifdef GEOFX_CORE
    return color;
#else
    bool linear = gl_Fog.start != 0.0 || gl_Fog.end != 1.0;
    if (!linear && gl_Fog.density == 1.0 && gl_Fog.color == vec4(0.0)) return color;
    mat4 p = gl_ProjectionMatrix;
    float away = p[2][3] != 0.0 ? abs((1.0 / gl_FragCoord.w - p[3][3]) / p[2][3]) : 0.0;
    float clear = linear ? (gl_Fog.end - away) * gl_Fog.scale : exp(-gl_Fog.density * away);
    return mix(gl_Fog.color.rgb, color, clamp(clear, 0.0, 1.0));
#endif
}

// How much of a pixel is the segment's: of one with round ends, and of one with straight ends. Round ends of neighbours cover pixels
// twice, and so widen lines of a pixel or two. Straight ends do not, and leave gaps in the bends of wider ones.
float coverOfRound(vec3 place)
{
    float away = length(vec2(place.x - clamp(place.x, 0.0, geofx_linesLength), place.y));
    return clamp(place.z + 0.5 - away, 0.0, 1.0);
}

float coverOfStraight(vec3 place)
{
    float across = min(place.z + 0.5 - abs(place.y), 2.0 * place.z);
    float along = min(place.x + 0.5, geofx_linesLength) - max(place.x - 0.5, 0.0);
    return clamp(across, 0.0, 1.0) * clamp(along, 0.0, 1.0);
}

void main()
{
    vec3 color = fogged(shaded(geofx_linesColor.rgb));
    vec3 place = geofx_linesPlace.xyz / geofx_linesPlace.w; // along, across, half the width
    float cover = mix(coverOfStraight(place), coverOfRound(place), clamp(place.z - 0.5, 0.0, 1.0));
    cover *= geofx_lineDash(geofx_linesDash.x, geofx_linesDashes.x, geofx_linesDashes.y, geofx_linesDashes.z, geofx_linesDash.y);
    if (cover < 0.004) discard;
    gl_FragColor = geofx_fragment(vec4(color, geofx_linesColor.a * cover), vec4(0.0));
    GEOFX_PUT_FRAGMENT_DEPTH;
}
