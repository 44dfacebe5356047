// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// PerspectiveBend in the vertex stage. SLOT_ stands for the effect's prefix; SLOT_curve is a constant.
#include "lib/bendview.glsl"

uniform vec4 SLOT_plane;
uniform vec4 SLOT_forward;
uniform vec4 SLOT_bend;
uniform vec4 SLOT_angle;
uniform vec4 SLOT_end;
#ifdef SLOT_COVER_MAP
out vec2 SLOT_mapPlace; // in the tile's texture of what lies on the ground
#endif
#ifdef SLOT_ZONE_LINES
out float SLOT_ahead; // of where the zone begins, metres
#endif

geofx_BendView SLOT_view()
{
    geofx_Bend bend = geofx_Bend(SLOT_curve, SLOT_bend.x, SLOT_bend.y, SLOT_angle.xy, SLOT_angle.zw, SLOT_bend.z,
                                 SLOT_bend.w, SLOT_end.xy);
    return geofx_BendView(SLOT_plane.xyz, SLOT_forward.xyz, SLOT_plane.w, SLOT_forward.w, bend);
}

vec3 SLOT_deform(vec3 position)
{
    return geofx_bendViewDeform(SLOT_view(), position);
}

vec3 SLOT_carried(vec3 position, vec3 offset)
{
    return geofx_bendViewTurn(SLOT_view(), position, offset);
}

// The ground is lit as it lies, not as it is bent.
vec3 SLOT_normal(vec3 position, vec3 normal)
{
    return normal;
}

float SLOT_style(vec3 position)
{
#ifdef SLOT_COVER_MAP
    SLOT_mapPlace = gl_MultiTexCoord0.xy;
#endif
#ifdef SLOT_ZONE_LINES
    SLOT_ahead = geofx_bendViewProfile(SLOT_view(), position).x;
#endif
    return geofx_bendViewStyle(SLOT_view(), position);
}
