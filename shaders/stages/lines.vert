#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Points of a map's lines (osgGeoFX/lines/MapLines.h). The geometry stage places them. The texture coordinate is the way from the
// line's beginning, metres.
out vec4 geofx_linesEye;
out float geofx_linesAlong;

void main()
{
    geofx_linesEye = gl_ModelViewMatrix * gl_Vertex;
    geofx_linesAlong = gl_MultiTexCoord0.x;
    gl_Position = gl_ProjectionMatrix * geofx_linesEye;
}
