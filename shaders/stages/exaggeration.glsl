// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// VerticalExaggeration in the vertex stage. SLOT_ stands for the effect's prefix.
#include "lib/exaggeration.glsl"

uniform vec4 SLOT_up;
uniform vec4 SLOT_axis;
uniform vec4 SLOT_scale;
uniform vec4 SLOT_relight;

geofx_Exaggeration SLOT_view()
{
    return geofx_Exaggeration(SLOT_up.xyz, SLOT_axis.xyz, SLOT_up.w, SLOT_scale.x, SLOT_axis.w, SLOT_scale.y,
                              SLOT_scale.z, SLOT_scale.w);
}

vec3 SLOT_deform(vec3 position)
{
    return geofx_exaggerate(SLOT_view(), position);
}

vec3 SLOT_normal(vec3 position, vec3 normal)
{
    return SLOT_relight.x > 0.5 ? geofx_exaggerationNormal(SLOT_view(), position, normal) : normal;
}

float SLOT_style(vec3 position)
{
    return 0.0;
}
