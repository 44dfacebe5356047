// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The painting of a panorama map's ground. SLOT_ stands for the effect's prefix.
#include "lib/painting.glsl"

uniform sampler2D SLOT_cover;
uniform vec4 SLOT_light;

in vec3 SLOT_place;
in vec4 SLOT_facing;
in vec2 SLOT_coverPlace;

vec4 SLOT_colour(vec4 colour)
{
    float light = dot(normalize(SLOT_facing.xyz), SLOT_light.xyz);
    vec3 lit = mix(vec3(0.35, 0.4, 0.6), vec3(0.85, 0.75, 0.45), light * 0.5 + 0.5);
    if (SLOT_place.z <= 0.0) lit = vec3(0.3, 0.5, 0.8);
    return vec4(lit, 1.0);
}
