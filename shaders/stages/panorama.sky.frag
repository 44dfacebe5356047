#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What shows behind a panorama map's terrain. Above the horizon it is the painted sky. Below it, without terrain, it
// is the sea, or haze and paper if that is not known. In the water the sky hangs from the horizon.
#pragma import_defines(GEOFX_MIRROR, GEOFX_CURVE_POINTS)
#include "stages/panorama.water.glsl"
#include "stages/panorama.edge.glsl"

uniform sampler2D geofx_sky;
uniform sampler2D geofx_skyMirror;
uniform sampler2D geofx_skyBrush;
uniform vec4 geofx_skyPlace; // the horizon's height in the picture, its arch; the heading, the part across, in turns
uniform vec4 geofx_skyCurve; // the picture's y for a metre up the curve, D1, D2, the end of what shows
uniform vec4 geofx_skyAxisX; // from x and s to the brush's picture: of a picture's x, of a metre, the base's
uniform vec4 geofx_skyAxisY;
uniform vec4 geofx_skyWater; // as in panorama.ground.frag.glsl
uniform vec4 geofx_skyClock; // seconds, the air's strength, whether there is a reflection, the map's strength
uniform sampler2D geofx_skyEdge; // the distances to the end of what is known: on the ground, and where there is none
uniform vec4 geofx_skyEdgeEye;   // as in lib/edge.glsl
uniform vec4 geofx_skyEdgeWays;
uniform vec4 geofx_skyEdgeKind;  // whether on a globe, the middle's latitude, the width, how it is drawn
uniform vec4 geofx_skyCylinder;  // as in lib/cylinder.glsl
#ifdef GEOFX_CURVE_POINTS
uniform vec4 geofx_skyKnots[7]; // of the curve: its first slope; the knots, as in lib/profile.glsl
#endif

in vec2 place; // -1 to 1

// The distance of the ground at a height of the picture above its base: the curve's inverse.
float distanceAt(float rise)
{
#ifdef GEOFX_CURVE_POINTS
    geofx_Profile profile = geofx_Profile(geofx_skyKnots[0].x, geofx_skyKnots[1].xyz, geofx_skyKnots[2].xyz,
                                          geofx_skyKnots[3].xyz, geofx_skyKnots[4].xyz, geofx_skyKnots[5].xyz,
                                          geofx_skyKnots[6].xyz);
    return geofx_skyCurve.z * geofx_profileDistance(profile, rise / geofx_skyCurve.z);
#else
    float width = max(geofx_skyCurve.z - geofx_skyCurve.y, 1e-3);
    float bent = clamp((rise - geofx_skyCurve.y) / width, 0.0, 0.5);
    return min(rise, geofx_skyCurve.y) + width * (1.0 - sqrt(1.0 - 2.0 * bent));
#endif
}

// The distance of what lies below a point of the picture without terrain, and its place in the brush's picture.
float groundAt(float horizonDrop, out vec2 brush)
{
    float s = distanceAt((place.y + 1.0 + 2.0 * horizonDrop) / geofx_skyCurve.x);
    vec2 ground = vec2(place.x, s);
    if (geofx_skyCylinder.x > 0.0)
    {
        geofx_Cylinder cylinder = geofx_Cylinder(geofx_skyCylinder.x, geofx_skyCylinder.y, geofx_skyCylinder.z);
        ground = geofx_cylinderGround(cylinder, vec2(place.x * geofx_skyAxisX.w, s)) / vec2(geofx_skyAxisX.w, 1.0);
    }
    brush = vec2(geofx_skyAxisX.x * ground.x + geofx_skyAxisX.y * ground.y + geofx_skyAxisX.z,
                 geofx_skyAxisY.x * ground.x + geofx_skyAxisY.y * ground.y + geofx_skyAxisY.z);
    return s;
}

vec3 sea(float s, vec2 brush)
{
    float far = clamp(s / geofx_skyCurve.z, 0.0, 1.0);
    vec3 color = geofx_waterBody(2.0 * geofx_skyWater.x, geofx_skyWater.x);
    if (geofx_skyClock.z > 0.5)
    {
        geofx_WaterPlace here = geofx_WaterPlace(2.0 * geofx_skyWater.x, 0.5 * place + 0.5, brush, 0.0,
                                                 s / geofx_skyCurve.w, far);
        color = geofx_water(here, geofx_skyWater, geofx_skyClock.x, geofx_skyBrush, geofx_skyMirror);
    }
    return geofx_atmosphere(color, geofx_airColor(), geofx_airAmount(far, geofx_skyClock.y));
}

// The share of what lies below that is not known to be sea.
float unknown(float s)
{
    float kind = geofx_skyEdgeKind.w;
    if (kind != GEOFX_EDGE_MAPPED) return kind == GEOFX_EDGE_UNKNOWN || kind == GEOFX_EDGE_LAND ? 1.0 : 0.0;
    geofx_Edge edge = geofx_edgeOf(geofx_skyEdgeEye, geofx_skyEdgeWays, geofx_skyEdgeKind, geofx_skyCylinder);
    vec2 at = geofx_edgePlace(edge, vec2(place.x * geofx_skyAxisX.w, s));
    float width = geofx_skyEdgeKind.z;
    return geofx_edgeAmount(geofx_edgeSeaReach(texture(geofx_skyEdge, at).g, width), width, 0.0, 0.0);
}

void main()
{
    float above = geofx_skyAbove(geofx_skyPlace, place.x, 0.5 * place.y + 0.5);
#ifdef GEOFX_MIRROR
    gl_FragColor = vec4(geofx_skyColor(geofx_sky, geofx_skyPlace, place.x, -above), 1.0);
#else
    float edge = 0.5 * fwidth(above);
    vec3 color = vec3(0.0);
    if (above > -edge) color = geofx_skyColor(geofx_sky, geofx_skyPlace, place.x, max(above, 0.0));
    if (above < edge)
    {
        vec2 brush;
        float s = groundAt(geofx_skyPlace.y * (1.0 - cos(1.5707963 * place.x)), brush);
        float haze = unknown(s);
        vec3 below = vec3(0.0);
        if (haze < 1.0) below = sea(s, brush);
        if (haze > 0.0)
        {
            float paper = geofx_skyEdgeKind.w < GEOFX_EDGE_LAND ? 1.0 : 0.0;
            vec3 gone = geofx_edgeColor(geofx_sky, geofx_skyPlace, place.x, 0.5 * place.y + 0.5, paper);
            below = mix(below, gone, haze);
        }
        color = mix(below, color, clamp(0.5 + 0.5 * above / edge, 0.0, 1.0));
    }
    gl_FragColor = vec4(color, geofx_skyClock.w);
#endif
}
