#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sky of a panorama map, behind everything.
uniform vec4 geofx_skyPart; // corners of the part of the picture that is drawn, -1 to 1

out vec2 place; // in the picture, -1 to 1

void main()
{
    place = mix(geofx_skyPart.xy, geofx_skyPart.zw, 0.5 * gl_Vertex.xy + 0.5);
    gl_ClipVertex = vec4(0.0); // no plane above the scene cuts the sky
    gl_Position = vec4(gl_Vertex.xy, 0.5, 1.0); // anywhere: the range of depths is the far plane alone
}
