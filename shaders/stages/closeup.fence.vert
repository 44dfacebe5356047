#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An anchor along a region's border. The first texture coordinate is the share of the way from the ground to the
// close-up. The second one is 1 for the line on the ground.
#include "stages/depth.glsl"
vec4 geofx_vertex(vec4 eyePosition);
void SLOT_setShare(float share);

out vec2 SLOT_fence;

void main()
{
    SLOT_setShare(gl_MultiTexCoord0.x);
    SLOT_fence = gl_MultiTexCoord0.xy;
    vec4 position = geofx_vertex(gl_ModelViewMatrix * gl_Vertex);
    // Lines lie on the ground, which must not hide them between their ends.
    if (gl_MultiTexCoord0.y > 0.5) position.xyz *= 0.9985;
    gl_Position = gl_ProjectionMatrix * position;
    GEOFX_PUT_DEPTH(gl_Position);
    gl_ClipVertex = gl_ModelViewMatrix * gl_Vertex;
}
