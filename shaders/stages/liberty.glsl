// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// RegionalLiberty in the vertex stage. SLOT_ stands for the effect's prefix.
#include "lib/liberty.glsl"

uniform vec4 SLOT_center; // w: the curvature
uniform vec4 SLOT_across; // w: half the width across
uniform vec4 SLOT_along;  // w: half the width along
uniform vec4 SLOT_up;     // w: the height that stays
uniform vec4 SLOT_taken;  // enlarge, widen, lengthen, turn

geofx_Liberty SLOT_view()
{
    return geofx_Liberty(SLOT_center.xyz, SLOT_across.xyz, SLOT_along.xyz, SLOT_up.xyz, SLOT_across.w, SLOT_along.w,
                         SLOT_center.w, SLOT_up.w, SLOT_taken.x, SLOT_taken.y, SLOT_taken.z, SLOT_taken.w);
}

vec3 SLOT_deform(vec3 position)
{
    return geofx_liberty(SLOT_view(), position);
}

vec3 SLOT_carried(vec3 position, vec3 offset)
{
    geofx_Liberty view = SLOT_view();
    float angle = geofx_libertyTurn(view, position);
    float c = cos(angle);
    float s = sin(angle);
    return c * offset + s * cross(view.up, offset) + (1.0 - c) * dot(view.up, offset) * view.up;
}

vec3 SLOT_normal(vec3 position, vec3 normal)
{
    return geofx_libertyNormal(SLOT_view(), position, normal);
}

float SLOT_style(vec3 position)
{
    return 0.0;
}
