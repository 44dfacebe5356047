// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a panorama map's strokes need of the ground that they stand on, in the vertex stage. SLOT_ stands for the
// effect's prefix.
#include "lib/painting.glsl"
#include "stages/panorama.edge.glsl"

uniform vec4 SLOT_strokeView; // without the projection: the pixels of a metre at a distance of one, else 0; the picture's width and height in pixels
uniform vec4 SLOT_slopes;
uniform vec4 SLOT_hand;
uniform sampler2D SLOT_edgeMap;
uniform sampler2D SLOT_edgeSky;
uniform vec4 SLOT_edgeEye;
uniform vec4 SLOT_edgeWays;
uniform vec4 SLOT_edgeKind;
uniform vec4 SLOT_edgePlace;

vec3 SLOT_move(vec3 located, vec3 bent)
{
    return bent;
}

// Pixels for each metre of the ground, the mean of across and along.
float SLOT_groundScale(vec3 position)
{
    if (SLOT_strokeView.x > 0.0) return SLOT_strokeView.x / max(length(position), 1e-3);
    geofx_Panorama view = SLOT_view();
    float slope = geofx_panoramaSlope(view, SLOT_placeOf(position).y);
    return 0.5 * sqrt(SLOT_strokeView.y * view.across * SLOT_strokeView.z * view.along * max(slope, 0.06));
}

float SLOT_strokeLight(vec3 position, vec3 normal, float y)
{
    vec3 vertical = normalize(geofx_exaggerationGradient(SLOT_view().globe, position));
    vec3 steep = normalize(normal + (1.0 / SLOT_light.w - 1.0) * dot(normal, vertical) * vertical);
#ifdef GEOFX_CORE
    vec3 towards = SLOT_light.xyz;
#else
    vec3 towards = SLOT_hand.w > 0.5 ? normalize(gl_LightSource[0].position.xyz) : SLOT_light.xyz;
#endif
    return geofx_paintLight(dot(steep, towards), y, SLOT_slopes.w);
}

float SLOT_strokeFar(vec3 position)
{
    geofx_Panorama view = SLOT_view();
    return clamp(SLOT_placeOf(position).y / view.horizon, 0.0, 1.0);
}

float SLOT_strokeDepth(vec3 position)
{
    return SLOT_strokeView.x > 0.0 ? 0.0 : SLOT_strokeFar(position);
}

float SLOT_strokeTreeShare(vec3 position)
{
    return SLOT_placeOf(position).z / max(SLOT_slopes.z, 1.0);
}

// How far the ground below is gone at the end of the terrain.
float SLOT_strokeGone(vec3 position)
{
    if (SLOT_edgeKind.w == GEOFX_EDGE_NONE || SLOT_edgeKind.w == GEOFX_EDGE_UNKNOWN) return 0.0;
    geofx_Edge edge = geofx_edgeOf(SLOT_edgeEye, SLOT_edgeWays, SLOT_edgeKind);
    vec3 place = SLOT_placeOf(position);
    float lift = geofx_profileLift(SLOT_scale.z, SLOT_profile.x, place.y / SLOT_curve.y);
    float along = SLOT_scale.y * geofx_edgeSlope(SLOT_bendingCurve(), SLOT_curve, place.y);
    return geofx_edgeGone(SLOT_edgeMap, edge, SLOT_edgeKind, place, lift, along, 0.0, 0.0, 0.0).x;
}

float SLOT_strokeShown(vec3 position)
{
    // Strokes get sparse and small before the ground is gone.
    float left = 1.0 - geofx_ease(SLOT_strokeGone(position), 0.1, 0.8);
    if (SLOT_strokeView.x > 0.0) return left;
    geofx_Panorama view = SLOT_view();
    return left * geofx_panoramaFade(view, SLOT_placeOf(position).y);
}

vec3 SLOT_strokeAir(vec3 color, vec3 position)
{
    vec3 far = geofx_atmosphere(color, geofx_airColor(), geofx_airAmount(SLOT_strokeFar(position), SLOT_hand.z));
    float gone = SLOT_strokeGone(position);
    if (gone <= 0.0) return far;
    bool map = SLOT_edgeKind.w < GEOFX_EDGE_LAND;
    vec2 picture = map ? geofx_panoramaPicture(SLOT_view(), SLOT_placeOf(position)).xy : vec2(0.0);
    return mix(far, geofx_edgeColor(SLOT_edgeSky, SLOT_edgePlace, picture.x, 0.5 + 0.5 * picture.y, map ? 1.0 : 0.0), gone);
}
