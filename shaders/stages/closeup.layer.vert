#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A layer of CloseUps on its way into the picture: the vertices of the part of the picture that it covers.
uniform vec4 geofx_layerPart; // its corners, -1 to 1

void main()
{
    // The layer's content has been clipped already. With 0, no plane above the scene cuts it.
    gl_ClipVertex = vec4(0.0);
    gl_Position = vec4(mix(geofx_layerPart.xy, geofx_layerPart.zw, gl_Vertex.xy), 0.0, 1.0);
}
