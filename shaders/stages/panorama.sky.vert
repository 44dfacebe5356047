#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sky of a panorama map, behind everything.
out vec2 place; // in the picture, -1 to 1

void main()
{
    place = gl_Vertex.xy;
    gl_ClipVertex = vec4(0.0); // no plane above the scene cuts the sky
    gl_Position = vec4(gl_Vertex.xy, 1.0, 1.0);
}
