#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sky around the Earth, behind everything: the direction of sight of a picture's point.
uniform mat3 geofx_earthTurn; // from eye space to the space where the Earth is a ball with radius 1

out vec3 geofx_sight;

void main()
{
    // Not by the inverse matrix: near and far are too far apart for its floats.
    vec2 onPlane = (gl_Vertex.xy + vec2(gl_ProjectionMatrix[2][0], gl_ProjectionMatrix[2][1])) /
                   vec2(gl_ProjectionMatrix[0][0], gl_ProjectionMatrix[1][1]);
    geofx_sight = geofx_earthTurn * vec3(onPlane, -1.0);
    gl_ClipVertex = vec4(0.0); // no plane above the scene cuts the sky
    gl_Position = vec4(gl_Vertex.xy, 0.5, 1.0);
}
