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
uniform vec2 geofx_linesNearer;   // the share of the distance by which lines are nearer than the ground; the hand's pressure

// An end in clip coordinates. The ground's triangles need not be as fine as the line, so it comes nearer, but stays at its pixel.
vec4 placed(int end)
{
    vec4 position = geofx_vertex(geofx_linesEye[end]);
    if (gl_ProjectionMatrix[3][3] == 0.0)
        position.xyz *= 1.0 - geofx_linesNearer.x;
    else
        position.z += geofx_linesNearer.x * abs(position.z);
    return gl_ProjectionMatrix * position;
}

float perMetre(vec4 clip)
{
    return 0.5 * geofx_linesViewport.y * length(vec2(gl_ProjectionMatrix[0][1], gl_ProjectionMatrix[1][1])) / clip.w;
}

void main()
{
    const float least = 1e-3;
    vec4 from = placed(0), to = placed(1);
    float alongFrom = geofx_linesAlong[0], alongTo = geofx_linesAlong[1];
    if (from.w < least && to.w < least) return;
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
    vec2 across = vec2(-along.y, along.x);
    for (int corner = 0; corner < 4; ++corner)
    {
        bool last = corner > 1;
        vec4 clip = last ? to : from;
        float metre = perMetre(clip), at = last ? alongTo : alongFrom;
        float halfWidth = 0.5 * geofx_lineWidth(geofx_linesWidth.x, geofx_linesWidth.y, geofx_linesWidth.z, metre) *
                              geofx_linePressure(at, geofx_linesNearer.y, metre) +
                          geofx_linesWidth.w;
        float room = halfWidth + 1.0, side = (corner & 1) == 0 ? -1.0 : 1.0;
        geofx_vertex(geofx_linesEye[last ? 1 : 0]); // its variables for this vertex
        vec2 pixels = (last ? room : -room) * along + side * room * across;
        gl_Position = clip + vec4(2.0 * pixels * geofx_linesViewport.zw * clip.w, 0.0, 0.0);
        GEOFX_PUT_DEPTH(gl_Position);
        gl_ClipVertex = geofx_linesEye[last ? 1 : 0];
        geofx_linesPlace = clip.w * vec4(last ? size + room : -room, side * room, halfWidth, 1.0);
        geofx_linesLength = size;
        geofx_linesDash = vec2(at, metre);
        EmitVertex();
    }
    EndPrimitive();
}
