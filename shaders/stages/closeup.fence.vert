#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An anchor along a region's border. The first texture coordinate is the share of the way from the ground to the
// close-up. The second one is 1 for the line on the ground. The line is a band: the third one is -1 or 1 for its two sides, and
// the next two texture units have the neighbors of its point.
#include "stages/depth.glsl"
vec4 geofx_vertex(vec4 eyePosition);
void SLOT_setShare(float share);

uniform vec2 SLOT_band; // the line's width, as a share of the picture's width and height

out vec2 SLOT_fence;

// Lines lie on the ground, which must not hide them between their ends.
vec4 lineClip(vec4 eye)
{
    vec4 position = geofx_vertex(eye);
    position.xyz *= 0.9985;
    return gl_ProjectionMatrix * position;
}

// The direction on the screen from one place to another, in units of the band. Either may be behind the eye.
vec2 wayTo(vec4 from, vec4 to)
{
    vec2 way = (to.xy * from.w - from.xy * to.w) / SLOT_band;
    float size = length(way);
    return size > 0.0 ? way / size : vec2(0.0);
}

void main()
{
    SLOT_setShare(gl_MultiTexCoord0.x);
    SLOT_fence = gl_MultiTexCoord0.xy;
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    if (gl_MultiTexCoord0.y > 0.5)
    {
        vec4 before = lineClip(gl_ModelViewMatrix * vec4(gl_MultiTexCoord1.xyz, 1.0));
        vec4 after = lineClip(gl_ModelViewMatrix * vec4(gl_MultiTexCoord2.xyz, 1.0));
        gl_Position = lineClip(eye); // the last one, whose variables the fragments get
        vec2 onwards = wayTo(gl_Position, after), so_far = -wayTo(gl_Position, before);
        if (onwards == vec2(0.0)) onwards = so_far;
        if (so_far == vec2(0.0)) so_far = onwards;
        vec2 along = onwards + so_far;
        along = dot(along, along) > 1e-6 ? normalize(along) : onwards;
        // A mitre, cut at corners of less than 60 degrees.
        float mitre = 1.0 / max(dot(along, onwards), 0.5);
        gl_Position.xy += gl_MultiTexCoord0.z * mitre * vec2(-along.y, along.x) * SLOT_band * gl_Position.w;
    }
    else
    {
        gl_Position = gl_ProjectionMatrix * geofx_vertex(eye);
    }
    GEOFX_PUT_DEPTH(gl_Position);
    gl_ClipVertex = gl_ModelViewMatrix * gl_Vertex;
}
