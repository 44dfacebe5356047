// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// PerspectiveBend in the fragment stage: the styles of context and focus (paper, Section 3.3).
#pragma import_defines(GEOFX_RIGID)
#include "lib/bendstyle.glsl"

uniform vec4 SLOT_look;      // of the context: saturation, brightness, whether there is a map, blocks
uniform vec4 SLOT_focusLook; // saturation, brightness, whether the map is here

vec4 SLOT_restyle(vec4 color, vec4 map, float style)
{
    geofx_BendStyle styles = geofx_BendStyle(SLOT_look.x, SLOT_look.y, SLOT_focusLook.x, SLOT_focusLook.y, SLOT_look.z,
                                             SLOT_focusLook.z, SLOT_look.w);
#ifdef GEOFX_RIGID
    const bool building = true;
#else
    const bool building = false;
#endif
    return vec4(geofx_bendRestyle(styles, color.rgb, map, building, style), color.a);
}
