// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// CloseUps in the tessellation evaluation stage: places vertices between those of a triangle, on the curved surface
// that their normals describe (Boubekeur and Alexa, Phong tessellation, 2008).
layout(triangles, equal_spacing, ccw) in;

in vec2 SLOT_surface_control[];
in vec3 SLOT_located_control[];
in vec3 SLOT_bent_control[];
in vec3 SLOT_normal_control[];
out vec2 SLOT_surface_in;
out vec3 SLOT_located_in;
out vec3 SLOT_bent_in;
GEOFX_VARYINGS
#include "stages/view.glsl"

uniform float SLOT_roundness;

// The vector from a point to its foot on the tangent plane of a vertex.
vec3 SLOT_toPlane(int vertex, vec3 point)
{
    vec3 normal = SLOT_normal_control[vertex];
    float square = dot(normal, normal);
    return square > 0.0 ? normal * (dot(SLOT_located_control[vertex] - point, normal) / square) : vec3(0.0);
}

void main()
{
    vec3 w = gl_TessCoord;
    SLOT_surface_in = w.x * SLOT_surface_control[0] + w.y * SLOT_surface_control[1] + w.z * SLOT_surface_control[2];
    SLOT_located_in = w.x * SLOT_located_control[0] + w.y * SLOT_located_control[1] + w.z * SLOT_located_control[2];
    SLOT_bent_in = w.x * SLOT_bent_control[0] + w.y * SLOT_bent_control[1] + w.z * SLOT_bent_control[2];
    vec3 rise = SLOT_roundness * (w.x * SLOT_toPlane(0, SLOT_located_in) + w.y * SLOT_toPlane(1, SLOT_located_in) +
                                  w.z * SLOT_toPlane(2, SLOT_located_in));
    SLOT_located_in += rise;
    SLOT_bent_in += rise;
    gl_Position = gl_ProjectionMatrix * vec4(geofx_inEye(SLOT_bent_in), 1.0);
    gl_FrontColor = w.x * gl_in[0].gl_FrontColor + w.y * gl_in[1].gl_FrontColor + w.z * gl_in[2].gl_FrontColor;
#ifdef GEOFX_COLOR_SUM
    gl_FrontSecondaryColor = w.x * gl_in[0].gl_FrontSecondaryColor + w.y * gl_in[1].gl_FrontSecondaryColor +
                             w.z * gl_in[2].gl_FrontSecondaryColor;
#endif
#ifdef GEOFX_TWO_SIDED
    gl_BackColor = w.x * gl_in[0].gl_BackColor + w.y * gl_in[1].gl_BackColor + w.z * gl_in[2].gl_BackColor;
#endif
#if defined(GEOFX_TEXTURE_0) || defined(GEOFX_MAP)
    gl_TexCoord[0] = w.x * gl_in[0].gl_TexCoord[0] + w.y * gl_in[1].gl_TexCoord[0] + w.z * gl_in[2].gl_TexCoord[0];
#endif
#ifdef GEOFX_TEXTURE_1
    gl_TexCoord[1] = w.x * gl_in[0].gl_TexCoord[1] + w.y * gl_in[1].gl_TexCoord[1] + w.z * gl_in[2].gl_TexCoord[1];
#endif
#ifdef GEOFX_TEXTURE_2
    gl_TexCoord[2] = w.x * gl_in[0].gl_TexCoord[2] + w.y * gl_in[1].gl_TexCoord[2] + w.z * gl_in[2].gl_TexCoord[2];
#endif
#ifdef GEOFX_TEXTURE_3
    gl_TexCoord[3] = w.x * gl_in[0].gl_TexCoord[3] + w.y * gl_in[1].gl_TexCoord[3] + w.z * gl_in[2].gl_TexCoord[3];
#endif
#ifdef GEOFX_FOG
    gl_FogFragCoord = w.x * gl_in[0].gl_FogFragCoord + w.y * gl_in[1].gl_FogFragCoord + w.z * gl_in[2].gl_FogFragCoord;
#endif
    GEOFX_COPY(w)
}
