// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// PerspectiveBend in the fragment stage: the styles of context and focus (paper, Section 3.3).
#pragma import_defines(GEOFX_RIGID)
#include "lib/bendstyle.glsl"
#include "stages/shore.glsl"
#include "stages/cover.glsl"

uniform vec4 SLOT_look;      // of the context: saturation, brightness, whether there is a map, blocks
uniform vec4 SLOT_focusLook; // saturation, brightness, whether the map is here

#ifdef SLOT_COVER_MAP
in vec2 SLOT_mapPlace;

// `bare`: the map that the ground has, alpha above 0; or its light alone, alpha below 0; or nothing.
vec4 SLOT_map(vec4 bare)
{
    vec4 texel = texture(geofx_cover, SLOT_mapPlace);
    float shore = geofx_smoothShore(geofx_cover, SLOT_mapPlace);
    float wet = clamp((shore - 128.0 / 255.0) / max(fwidth(shore), 1e-4) + 0.5, 0.0, 1.0);
    if (bare.a > 0.0 || !geofx_coverKnown(texel)) return bare;
    // A program of an application tells no light.
    vec3 light = bare.a < 0.0 ? bare.rgb : vec3(1.0);
    return vec4(geofx_bendMap(geofx_coverOf(texel), wet, light), 1.0);
}
#endif

#ifdef SLOT_ZONE_LINES
uniform vec4 SLOT_bend; // the zone's width first
in float SLOT_ahead;

// Two pixels wide, between dark edges, so that they are seen on any ground.
vec3 SLOT_withLines(vec3 color)
{
    float pixel = max(length(vec2(dFdx(SLOT_ahead), dFdy(SLOT_ahead))), 1e-6);
    float first = abs(SLOT_ahead) / pixel;
    float last = abs(SLOT_ahead - SLOT_bend.x) / pixel;
    color = mix(color, vec3(0.06, 0.07, 0.09), 0.6 * (1.0 - smoothstep(2.0, 3.2, min(first, last))));
    color = mix(color, vec3(0.45, 0.74, 1.0), 1.0 - smoothstep(1.0, 2.0, last));
    return mix(color, vec3(0.98, 0.72, 0.28), 1.0 - smoothstep(1.0, 2.0, first));
}
#endif

vec4 SLOT_restyle(vec4 color, vec4 map, float style)
{
    geofx_BendStyle styles = geofx_BendStyle(SLOT_look.x, SLOT_look.y, SLOT_focusLook.x, SLOT_focusLook.y, SLOT_look.z,
                                             SLOT_focusLook.z, SLOT_look.w);
#ifdef GEOFX_RIGID
    const bool building = true;
#else
    const bool building = false;
#ifdef SLOT_COVER_MAP
    map = SLOT_map(map);
#endif
#endif
    map.a = max(map.a, 0.0);
    vec3 restyled = geofx_bendRestyle(styles, color.rgb, map, building, style);
#if defined(SLOT_ZONE_LINES) && !defined(GEOFX_RIGID)
    restyled = SLOT_withLines(restyled);
#endif
    return vec4(restyled, color.a);
}
