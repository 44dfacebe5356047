#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A segment of a line with round ends, as a rectangle on the screen. Both ends are moved as the ground is.
layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;
#include "stages/depth.glsl"
#include "lib/lines.glsl"

vec4 geofx_vertex(vec4 eyePosition);

in vec4 geofx_linesEye[];
in float geofx_linesAlong[];
// Along and across the segment, and half the width, pixels, times w; and w. The quotients are linear on the screen. (Mesa's clipping of
// "noperspective" fails in the corners of a picture.)
out vec4 geofx_linesPlace;
flat out float geofx_linesLength;        // of the segment, pixels
out vec2 geofx_linesDash;                // metres from the beginning; pixels for each metre

uniform vec4 geofx_linesViewport; // width and height in pixels, and one over each
uniform vec4 geofx_linesWidth;    // metres; the least and the most pixels; the casing's pixels on each side
uniform vec4 geofx_linesUpward;  // the ground's upward direction in eye space, 0; on a globe, its center there, 1
uniform vec2 geofx_linesNearer;   // the share of the distance by which lines are nearer than the ground; the hand's pressure

// A place in clip coordinates. The ground's triangles need not be as fine as the line, so it comes nearer, but stays at its pixel.
vec4 placed(vec4 eye)
{
    vec4 position = geofx_vertex(eye);
    if (gl_ProjectionMatrix[3][3] == 0.0)
        position.xyz *= 1.0 - geofx_linesNearer.x;
    else
        position.z += geofx_linesNearer.x * abs(position.z);
    return gl_ProjectionMatrix * position;
}

// The way across the line on level ground, of length 1, in eye space; 0 where there is none.
vec3 across(int end)
{
    vec3 eye = geofx_linesEye[end].xyz;
    vec3 upward = geofx_linesUpward.w > 0.5 ? normalize(eye - geofx_linesUpward.xyz) : geofx_linesUpward.xyz;
    vec3 way = cross(geofx_linesEye[1].xyz - geofx_linesEye[0].xyz, upward);
    float size = length(way);
    return size > 1e-9 ? way / size : vec3(0.0);
}

// What becomes of a metre of it.
vec4 metreAcross(int end, vec4 clip)
{
    vec3 eye = geofx_linesEye[end].xyz;
    float metres = max(1.0, 0.002 * length(eye));
    return (placed(vec4(eye + metres * across(end), 1.0)) - clip) / metres;
}

// The place on level ground of a corner of a line's picture, `shift` from its end in normalized coordinates: the share of the
// segment along it, and metres across. 0 where level ground is seen too much from the edge to tell.
vec2 onGround(vec4 clip, vec4 along, vec4 sideward, vec2 shift)
{
    vec2 there = clip.xy / clip.w + shift, goal = shift * clip.w;
    vec2 a = along.xy - there * along.w, b = sideward.xy - there * sideward.w;
    float size = a.x * b.y - a.y * b.x;
    if (size == 0.0) return vec2(0.0);
    vec2 way = vec2(goal.x * b.y - goal.y * b.x, a.x * goal.y - a.y * goal.x) / size;
    float w = clip.w + way.x * along.w + way.y * sideward.w;
    return abs(w - clip.w) < 0.25 * clip.w ? way : vec2(0.0);
}

float perMetre(vec4 clip)
{
    return 0.5 * geofx_linesViewport.y * length(vec2(gl_ProjectionMatrix[0][1], gl_ProjectionMatrix[1][1])) / clip.w;
}

void main()
{
    const float least = 1e-3;
    vec4 from = placed(geofx_linesEye[0]), to = placed(geofx_linesEye[1]);
    float alongFrom = geofx_linesAlong[0], alongTo = geofx_linesAlong[1];
    if (from.w < least && to.w < least) return;
    vec4 sidewardFrom = metreAcross(0, from), sidewardTo = metreAcross(1, to);
    // A segment that begins behind the eye is cut, and its ends are not where the line's are.
    bool whole = from.w >= least && to.w >= least;
    float share = (least - from.w) / (to.w - from.w);
    if (from.w < least)
    {
        from = mix(from, to, share);
        alongFrom = mix(alongFrom, alongTo, share);
    }
    else if (to.w < least)
    {
        to = mix(from, to, share);
        alongTo = mix(alongFrom, alongTo, share);
    }
    vec2 first = 0.5 * geofx_linesViewport.xy * from.xy / from.w;
    vec2 way = 0.5 * geofx_linesViewport.xy * to.xy / to.w - first;
    float size = length(way);
    vec2 along = size > 1e-4 ? way / size : vec2(1.0, 0.0);
    vec2 leftward = vec2(-along.y, along.x);
    for (int corner = 0; corner < 4; ++corner)
    {
        bool last = corner > 1;
        vec4 clip = last ? to : from;
        float metre = perMetre(clip), at = last ? alongTo : alongFrom;
        float halfWidth = 0.5 * geofx_lineWidth(geofx_linesWidth.x, geofx_linesWidth.y, geofx_linesWidth.z, metre) *
                              geofx_linePressure(at, geofx_linesNearer.y, metre) +
                          geofx_linesWidth.w;
        float room = halfWidth + 1.0, side = (corner & 1) == 0 ? -1.0 : 1.0;
        vec2 pixels = (last ? room : -room) * along + side * room * leftward;
        vec2 shift = 2.0 * pixels * geofx_linesViewport.zw;
        vec4 sideward = last ? sidewardTo : sidewardFrom;
        vec2 beside = whole ? onGround(clip, to - from, sideward, shift) : vec2(0.0);
        vec4 ground = clip + (to - from) * beside.x + sideward * beside.y;
        // A line is a strip before the eye, but one side of it lies on ground that is nearer than its middle, and would be hidden there.
        float depth = geofx_nearest(ground.z / ground.w, clip.z / clip.w);
        gl_Position = vec4(clip.xy + shift * clip.w, depth * clip.w, clip.w);
        GEOFX_PUT_DEPTH(gl_Position);
        vec4 eye = geofx_linesEye[last ? 1 : 0];
        eye.xyz += (geofx_linesEye[1].xyz - geofx_linesEye[0].xyz) * beside.x + across(last ? 1 : 0) * beside.y;
        geofx_vertex(eye); // its variables for this vertex
        gl_ClipVertex = geofx_linesEye[last ? 1 : 0];
        geofx_linesPlace = clip.w * vec4(last ? size + room : -room, side * room, halfWidth, 1.0);
        geofx_linesLength = size;
        geofx_linesDash = vec2(at, metre);
        EmitVertex();
    }
    EndPrimitive();
}
