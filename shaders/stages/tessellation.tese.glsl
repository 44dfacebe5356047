// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Divides the triangles that a deformation curves (osgGeoFX/effect/Tessellation.h), in the tessellation evaluation stage: places vertices
// on the undeformed triangle, and then deforms them. The parts' lengths change smoothly with their number, so nothing
// jumps as the camera moves, and rounding between two tiles opens no crack.
//
// EffectProgram puts code in the place of the words in capitals.
layout(triangles, fractional_odd_spacing, ccw) in;

in vec3 geofx_undeformed_control[];
in vec4 geofx_coordinates_control[];
GEOFX_VARYINGS
out float geofx_styleBlend;
#include "stages/view.glsl"
#include "stages/depth.glsl"
#include "stages/planes.glsl"

vec4 geofx_textureCoordinates = vec4(0.0); // the vertex' gl_MultiTexCoord0, for the functions of effects
GEOFX_EFFECT_FUNCTIONS

void main()
{
    vec3 w = gl_TessCoord;
    // The same from both sides of an edge.
    precise vec3 eye = w.x * geofx_undeformed_control[0] + w.y * geofx_undeformed_control[1] +
                       w.z * geofx_undeformed_control[2];
    geofx_textureCoordinates = w.x * geofx_coordinates_control[0] + w.y * geofx_coordinates_control[1] +
                               w.z * geofx_coordinates_control[2];
    geofx_styleBlend = 0.0;
    vec3 former = geofx_inView(eye);
    vec3 position = former;
GEOFX_DEFORM_CALLS
    vec3 deformed = position == former ? eye : geofx_inEye(position);
    gl_Position = gl_ProjectionMatrix * vec4(deformed, 1.0);
    GEOFX_PUT_DEPTH(gl_Position);
    // The triangle's own corners lie where the vertex stage has put them, and neighbours that are not divided have theirs.
    if (w.x == 1.0) gl_Position = gl_in[0].gl_Position;
    if (w.y == 1.0) gl_Position = gl_in[1].gl_Position;
    if (w.z == 1.0) gl_Position = gl_in[2].gl_Position;
    GEOFX_CUT_BY_PLANES(vec4(eye, 1.0));
GEOFX_BUILT_INS
#ifdef GEOFX_FOG
    if (GEOFX_FOG < 4) gl_FogFragCoord = abs(deformed.z);
#endif
    GEOFX_COPY(w)
}
