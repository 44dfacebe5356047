// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// ProjectiveMappings in the vertex stage: the place of a vertex in the mappings' frame, before any deformation. SLOT_
// stands for the effect's prefix.
#include "lib/exaggeration.glsl"

uniform mat4 SLOT_toFrame; // from eye space
uniform vec4 SLOT_globe;   // the ellipsoid's axis and flattening; lib/exaggeration.glsl
uniform vec4 SLOT_curve;   // its curvature and scale; 0 on a projected terrain

out vec3 SLOT_position;
out vec3 SLOT_place;

void SLOT_locate(vec3 eyePosition)
{
    SLOT_position = (SLOT_toFrame * vec4(eyePosition, 1.0)).xyz;
    SLOT_place = SLOT_position;
    if (SLOT_curve.x > 0.0)
    {
        geofx_Exaggeration globe = geofx_Exaggeration(vec3(0.0, 0.0, 1.0), SLOT_globe.xyz, 0.0, SLOT_curve.x,
                                                      SLOT_globe.w, SLOT_curve.y, 0.0, 0.0);
        SLOT_place.xy = geofx_exaggerate(globe, SLOT_position).xy;
        SLOT_place.z = geofx_exaggerationHeight(globe, SLOT_position);
    }
}
