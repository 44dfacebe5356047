#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What throws shadows, undeformed, as the sun sees it. SLOT_ stands for the prefix of SunShadows.
#pragma import_defines(GEOFX_PLACED)
#include "stages/view.glsl"

#ifdef GEOFX_PLACED
uniform mat4 geofx_unplaced; // of an object that was moved as a whole: back to where it stands
#endif
uniform mat4 SLOT_light; // from the view's eye space to clip coordinates

void main()
{
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    vec3 place = eye.xyz / eye.w;
#ifdef GEOFX_PLACED
    place = (geofx_unplaced * vec4(place, 1.0)).xyz;
#endif
    gl_Position = SLOT_light * vec4(geofx_inView(place), 1.0);
}
