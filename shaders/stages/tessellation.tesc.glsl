// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Divides the triangles that a deformation curves (osgGeoFX/effect/Tessellation.h), in the tessellation control stage. The number of
// parts of an edge follows from its two ends alone, so that the triangles on its two sides agree; where nothing is
// curved it is 1, as that of a neighbour that is not divided.
//
// EffectProgram puts code in the place of the words in capitals.
layout(vertices = 3) out;

in vec3 geofx_undeformed_vertex[];
in vec4 geofx_coordinates_vertex[];
out vec3 geofx_undeformed_control[];
out vec4 geofx_coordinates_control[];
GEOFX_VARYINGS
#include "stages/view.glsl"

uniform vec2 geofx_halfPicture; // pixels
vec4 geofx_textureCoordinates = vec4(0.0);
GEOFX_EFFECT_FUNCTIONS

float geofx_parts(int i, int j)
{
    vec3 from = geofx_inView(geofx_undeformed_vertex[i]);
    vec3 to = geofx_inView(geofx_undeformed_vertex[j]);
    vec3 sag = vec3(0.0);
GEOFX_SAG_CALLS
    // What lies between the ends may come nearer to the eye than they are, but not much if the edge is to be seen.
    float near = min(gl_in[i].gl_Position.w, gl_in[j].gl_Position.w);
    float far = max(gl_in[i].gl_Position.w, gl_in[j].gl_Position.w);
    mat4 projection = gl_ProjectionMatrix;
    float nearing = length(vec3(projection[0][3], projection[1][3], projection[2][3]));
    float depth = max(near - nearing * sag.x, 0.05 * max(far, 1e-3));
    vec2 pixels = geofx_halfPicture * abs(vec2(projection[0][0], projection[1][1])) / depth;
    // What a chord misses of a curve falls with the square of their number, and what it misses at a corner with their number.
    float scale = max(pixels.x, pixels.y);
    return clamp(max(sqrt(sag.y * scale), sag.z * scale), 1.0, GEOFX_MOST_PARTS);
}

void main()
{
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    geofx_undeformed_control[gl_InvocationID] = geofx_undeformed_vertex[gl_InvocationID];
    geofx_coordinates_control[gl_InvocationID] = geofx_coordinates_vertex[gl_InvocationID];
GEOFX_BUILT_INS
    GEOFX_COPY(gl_InvocationID)
    if (gl_InvocationID != 0) return;
    gl_TessLevelOuter[0] = geofx_parts(1, 2);
    gl_TessLevelOuter[1] = geofx_parts(2, 0);
    gl_TessLevelOuter[2] = geofx_parts(0, 1);
    gl_TessLevelInner[0] = max(gl_TessLevelOuter[0], max(gl_TessLevelOuter[1], gl_TessLevelOuter[2]));
}
