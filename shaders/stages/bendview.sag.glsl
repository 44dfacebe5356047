// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// PerspectiveBend in the tessellation control stage, behind stages/bendview.glsl. Without tessellation both are 0.
uniform vec4 SLOT_rates;   // as geofx_bendViewSag() has them
uniform vec4 SLOT_allowed; // one over the pixels

vec3 SLOT_sag(vec3 from, vec3 to)
{
    vec2 sag = geofx_bendViewSag(SLOT_view(), SLOT_rates, from, to);
    // At its jumps ground slides along itself, which no outline shows: twice as much is allowed.
    return vec3(sag.x + sag.y, vec2(1.0, 0.5) * sag * SLOT_allowed.x);
}
