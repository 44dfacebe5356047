// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a panorama map's strokes ask of the ground that they stand on, in the vertex stage. SLOT_ stands for the effect's prefix.
#include "lib/painting.glsl"

uniform vec4 SLOT_viewport;
uniform vec4 SLOT_strokeView; // without the projection: the pixels of a metre at a distance of one; else 0
uniform vec4 SLOT_slopes;
uniform vec4 SLOT_hand;

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
    return 0.5 * sqrt(SLOT_viewport.x * view.across * SLOT_viewport.y * view.along * max(slope, 0.06));
}

float SLOT_strokeLight(vec3 position, vec3 normal, float y)
{
    vec3 vertical = normalize(geofx_exaggerationGradient(SLOT_view().globe, position));
    vec3 steep = normalize(normal + (1.0 / SLOT_light.w - 1.0) * dot(normal, vertical) * vertical);
    vec3 towards = SLOT_hand.w > 0.5 ? normalize(gl_LightSource[0].position.xyz) : SLOT_light.xyz;
    return geofx_paintLight(dot(steep, towards), y, SLOT_slopes.w);
}

float SLOT_strokeFar(vec3 position)
{
    geofx_Panorama view = SLOT_view();
    return clamp(SLOT_placeOf(position).y / view.horizon, 0.0, 1.0);
}

float SLOT_strokeShown(vec3 position)
{
    if (SLOT_strokeView.x > 0.0) return 1.0;
    geofx_Panorama view = SLOT_view();
    return geofx_panoramaFade(view, SLOT_placeOf(position).y);
}

vec3 SLOT_strokeAir(vec3 colour, vec3 position)
{
    return geofx_atmosphere(colour, geofx_airColour(), geofx_airAmount(SLOT_strokeFar(position), SLOT_hand.z));
}
