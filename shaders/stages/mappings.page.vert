#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Parts of pages of composed mappings: where they are in the texture of pages, -1 to 1, and the place on the plane, metres.
out vec3 SLOT_position;
out vec3 SLOT_place;

void main()
{
    SLOT_place = vec3(gl_Vertex.zw, 0.0);
    SLOT_position = SLOT_place;
    gl_ClipVertex = vec4(0.0); // no plane above the scene cuts them
    gl_Position = vec4(gl_Vertex.xy, 0.0, 1.0);
}
