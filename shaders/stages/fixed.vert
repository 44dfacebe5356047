#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// OpenGL's fixed vertex stage, for geometry without a shader of its own, after OpenGL 2.1, Section 2.14, with the
// effects in between. scene/detail/FixedFunctionLook.cpp sets the defines from the modes in force.
#pragma import_defines(GEOFX_SPECULAR)
#pragma import_defines(GEOFX_LIGHTS, GEOFX_TWO_SIDED, GEOFX_LOCAL_VIEWER)
#pragma import_defines(GEOFX_COLOR_MATERIAL, GEOFX_COLOR_SUM)
#pragma import_defines(GEOFX_NORMALIZE, GEOFX_RESCALE, GEOFX_FOG, GEOFX_POINT_SIZE)
#pragma import_defines(GEOFX_TEXTURE_0, GEOFX_TEXTURE_1, GEOFX_TEXTURE_2, GEOFX_TEXTURE_3)
#pragma import_defines(GEOFX_TEXGEN_0, GEOFX_TEXGEN_1, GEOFX_TEXGEN_2, GEOFX_TEXGEN_3)
#pragma import_defines(GEOFX_MAP, GEOFX_PAINTED, GEOFX_FADING, GEOFX_NORMAL_MAP)
#pragma import_defines(GEOFX_NO_NORMAL, GEOFX_SHADOWED)

// What is painted anew needs no light and no textures, unless the painting is only fading in.
#if defined(GEOFX_PAINTED) && !defined(GEOFX_FADING)
#undef GEOFX_LIGHTS
#undef GEOFX_COLOR_SUM
#undef GEOFX_TEXTURE_0
#undef GEOFX_TEXTURE_1
#undef GEOFX_TEXTURE_2
#undef GEOFX_TEXTURE_3
#undef GEOFX_MAP
#undef GEOFX_FOG
#endif

// If fragments have normals of their own, the fragment stage lights them.
#ifdef GEOFX_NORMAL_MAP
#undef GEOFX_LIGHTS
#endif

#if defined(GEOFX_TEXGEN_0) || defined(GEOFX_TEXGEN_1) || defined(GEOFX_TEXGEN_2) || defined(GEOFX_TEXGEN_3)
#define GEOFX_GENERATES
#endif

vec4 geofx_vertex(vec4 eyePosition);
vec3 geofx_normal(vec4 eyePosition, vec3 eyeNormal);
#ifdef GEOFX_SHADOWED
void geofx_setShade(vec3 color);
#endif

#include "stages/fixed.light.glsl"
#include "stages/depth.glsl"

#ifdef GEOFX_GENERATES
// Generated texture coordinates, OpenGL 2.1, Section 2.11.4. `code` is 1 object linear, 2 eye linear, 3 sphere map, 4
// normal map, 5 reflection map, with 8 more for s, 16 for t, 32 for r, and 64 for q.
vec4 generated(int unit, int code, vec4 given, vec4 eye, vec3 normal)
{
    int mode = code & 7;
    vec4 made;
    if (mode == 1)
    {
        made = vec4(dot(gl_Vertex, gl_ObjectPlaneS[unit]), dot(gl_Vertex, gl_ObjectPlaneT[unit]),
                    dot(gl_Vertex, gl_ObjectPlaneR[unit]), dot(gl_Vertex, gl_ObjectPlaneQ[unit]));
    }
    else if (mode == 2)
    {
        made = vec4(dot(eye, gl_EyePlaneS[unit]), dot(eye, gl_EyePlaneT[unit]), dot(eye, gl_EyePlaneR[unit]),
                    dot(eye, gl_EyePlaneQ[unit]));
    }
    else if (mode == 4)
    {
        made = vec4(normal, given.w);
    }
    else
    {
        made = vec4(reflect(normalize(eye.xyz), normal), given.w);
        if (mode == 3) made.xyz = made.xyz / (2.0 * length(made.xyz + vec3(0.0, 0.0, 1.0))) + 0.5;
    }
    return vec4((code & 8) != 0 ? made.x : given.x, (code & 16) != 0 ? made.y : given.y,
                (code & 32) != 0 ? made.z : given.z, (code & 64) != 0 ? made.w : given.w);
}
#endif

void main()
{
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    vec4 deformed = geofx_vertex(eye);
    // A vertex that stays where it is goes exactly where OpenGL's own stage would put it.
    gl_Position = deformed == eye ? ftransform() : gl_ProjectionMatrix * deformed;
    GEOFX_PUT_DEPTH(gl_Position);
    gl_ClipVertex = eye;

    vec3 normal = gl_NormalMatrix * gl_Normal;
#ifdef GEOFX_RESCALE
    normal *= gl_NormalScale;
#endif
    // The effects turn a normal of length 1. Without GL_NORMALIZE, OpenGL lights with the length that the normal has.
    float size = length(normal);
    normal = size > 0.0 ? normal / size : normal;
#ifndef GEOFX_NO_NORMAL
    // One that was left over tells effects nothing.
    normal = size > 0.0 ? geofx_normal(eye, normal) : normal;
#endif
#ifndef GEOFX_NORMALIZE
    normal *= size;
#endif

    // Only outputs that are read are written. Each of them goes through clipping and set-up with every triangle.
    vec4 primary = gl_Color;
    vec4 secondary = gl_SecondaryColor;
#ifdef GEOFX_LIGHTS
#ifdef GEOFX_SHADOWED
    sunShare = 0.0;
    illuminate(eye.xyz, normal, colored(gl_FrontMaterial), primary, secondary);
    geofx_setShade(primary.rgb);
    sunShare = 1.0;
#endif
    illuminate(eye.xyz, normal, colored(gl_FrontMaterial), primary, secondary);
#endif
    gl_FrontColor = primary;
#ifdef GEOFX_COLOR_SUM
    gl_FrontSecondaryColor = secondary;
#endif
#ifdef GEOFX_TWO_SIDED
#ifdef GEOFX_LIGHTS
    illuminate(eye.xyz, -normal, colored(gl_BackMaterial), primary, secondary);
#endif
    gl_BackColor = primary;
#ifdef GEOFX_COLOR_SUM
    gl_BackSecondaryColor = secondary;
#endif
#endif

#if defined(GEOFX_TEXTURE_0) || defined(GEOFX_MAP)
    gl_TexCoord[0] = gl_TextureMatrix[0] * gl_MultiTexCoord0;
#ifdef GEOFX_TEXGEN_0
    gl_TexCoord[0] = gl_TextureMatrix[0] * generated(0, GEOFX_TEXGEN_0, gl_MultiTexCoord0, eye, normal);
#endif
#endif
#ifdef GEOFX_TEXTURE_1
    gl_TexCoord[1] = gl_TextureMatrix[1] * gl_MultiTexCoord1;
#ifdef GEOFX_TEXGEN_1
    gl_TexCoord[1] = gl_TextureMatrix[1] * generated(1, GEOFX_TEXGEN_1, gl_MultiTexCoord1, eye, normal);
#endif
#endif
#ifdef GEOFX_TEXTURE_2
    gl_TexCoord[2] = gl_TextureMatrix[2] * gl_MultiTexCoord2;
#ifdef GEOFX_TEXGEN_2
    gl_TexCoord[2] = gl_TextureMatrix[2] * generated(2, GEOFX_TEXGEN_2, gl_MultiTexCoord2, eye, normal);
#endif
#endif
#ifdef GEOFX_TEXTURE_3
    gl_TexCoord[3] = gl_TextureMatrix[3] * gl_MultiTexCoord3;
#ifdef GEOFX_TEXGEN_3
    gl_TexCoord[3] = gl_TextureMatrix[3] * generated(3, GEOFX_TEXGEN_3, gl_MultiTexCoord3, eye, normal);
#endif
#endif
#ifdef GEOFX_FOG
    gl_FogFragCoord = GEOFX_FOG >= 4 ? gl_FogCoord : abs(deformed.z);
#endif
#ifdef GEOFX_POINT_SIZE
    float far = abs(deformed.z); // Section 3.3 allows it in place of the distance, and Mesa uses it
    float fading = gl_Point.distanceConstantAttenuation +
                   far * (gl_Point.distanceLinearAttenuation + far * gl_Point.distanceQuadraticAttenuation);
    gl_PointSize = clamp(gl_Point.size * inversesqrt(fading), gl_Point.sizeMin, gl_Point.sizeMax);
#endif
}
