#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The effects of a scene in the vertex stage. Declare and call these in a vertex shader of your own:
//
//     vec4 geofx_vertex(vec4 eyePosition);                    // where it goes, in eye space; sets what fragments need
//     vec3 geofx_normal(vec4 eyePosition, vec3 eyeNormal);    // the normal to light with
//
// The tessellation evaluation and the geometry stage have them, too, and one more, since attributes do not reach them:
//
//     void geofx_texture(vec4 coordinates);    // the vertex' gl_MultiTexCoord0, before geofx_vertex(); vec4(0.0) if not called
//
// Call them in one stage: the last one that places vertices.
//
// EffectScene puts the code of its effects in the place of the words in capitals.
#pragma import_defines(GEOFX_DEFORMATION)
#pragma import_defines(GEOFX_PLACED)
#pragma import_defines(GEOFX_NEARER)
#pragma import_defines(GEOFX_NORMAL_MAP)
#pragma import_defines(GEOFX_RIGID)
#pragma import_defines(GEOFX_SHADOWED)
GEOFX_IMPORTED_EFFECTS
#include "stages/view.glsl"
#ifdef GEOFX_HOST_NORMAL
#undef GEOFX_NORMAL_MAP
#endif
#ifdef GEOFX_LATER_STAGE
#undef GEOFX_NORMAL_MAP
#undef GEOFX_RIGID
vec4 geofx_textureCoordinates = vec4(0.0);
void geofx_texture(vec4 coordinates)
{
    geofx_textureCoordinates = coordinates;
}
#endif
#ifdef GEOFX_RIGID
layout(location = 13) in vec4 geofx_reference; // of the thing that the vertex belongs to: effect/RigidParts.h
#endif
out float geofx_styleBlend;
#ifdef GEOFX_SHADOWED
out vec3 geofx_shade; // the color without the sun, where vertices are lit
void geofx_setShade(vec3 color)
{
    geofx_shade = color;
}
#endif
#if defined(GEOFX_HOST_NORMAL) || defined(GEOFX_NORMAL_MAP)
#define GEOFX_FRAGMENT_NORMAL // of which fragments take care
out vec3 geofx_groundPlace;   // undeformed, in the view's eye space
#endif
#ifdef GEOFX_NORMAL_MAP
out vec2 geofx_normalPlace; // in the texture of normals
#endif
#ifdef GEOFX_PLACED
uniform mat4 geofx_unplaced; // of an object that was moved as a whole: back to where it stands
#endif
#ifdef GEOFX_NEARER
uniform float geofx_nearer; // of a thing that is drawn before others at its place: the share of its distance
#endif
// A place in the view's eye space in the camera's.
vec4 geofx_drawnAt(vec3 position)
{
#ifdef GEOFX_NEARER
    return vec4(geofx_nearer * geofx_inEye(position), 1.0);
#else
    return vec4(geofx_inEye(position), 1.0);
#endif
}
GEOFX_EFFECT_FUNCTIONS
vec4 geofx_vertex(vec4 eyePosition)
{
    geofx_styleBlend = 0.0;
#ifdef GEOFX_SHADOWED
    geofx_shade = vec3(0.0);
#endif
#ifdef GEOFX_NORMAL_MAP
    geofx_normalPlace = (gl_TextureMatrix[2] * gl_MultiTexCoord0).xy;
#endif
#ifdef GEOFX_FRAGMENT_NORMAL
    geofx_groundPlace = geofx_inView(eyePosition.xyz / eyePosition.w);
#endif
    vec3 located = eyePosition.xyz / eyePosition.w;
#ifdef GEOFX_PLACED
    located = (geofx_unplaced * vec4(located, 1.0)).xyz;
#endif
    located = geofx_inView(located);
GEOFX_LOCATE_CALLS
    vec3 position = geofx_inView(eyePosition.xyz / eyePosition.w);
#ifdef GEOFX_IMAGE
    vec3 former = position;
#endif
#ifdef GEOFX_DEFORMATION
#ifdef GEOFX_RIGID
    // The reference moves, and the rest keeps its place about it.
    vec3 undeformed = position;
    vec3 reference = geofx_inView((gl_ModelViewMatrix * vec4(geofx_reference.xyz, 1.0)).xyz);
    vec3 offset = position - reference;
    position = reference;
#endif
GEOFX_DEFORM_CALLS
#ifdef GEOFX_RIGID
    position = position == reference ? undeformed : position + offset;
#endif
#endif
GEOFX_MOVE_CALLS
#if defined(GEOFX_IMAGE) && !defined(GEOFX_NEARER)
    // Not by way of the view: what stays where it is goes exactly where others put it.
    if (position == former) return eyePosition;
#endif
#if defined(GEOFX_DEFORMATION) || defined(GEOFX_NEARER)
    return geofx_drawnAt(position);
#else
    return eyePosition;
#endif
}

vec3 geofx_normal(vec4 cameraPosition, vec3 cameraNormal)
{
    vec3 eyeNormal = geofx_directionInView(cameraNormal);
GEOFX_FACE_CALLS
#if defined(GEOFX_DEFORMATION) && !defined(GEOFX_RIGID)
    vec3 position = geofx_inView(cameraPosition.xyz / cameraPosition.w);
    vec3 normal = eyeNormal;
GEOFX_NORMAL_CALLS
    return geofx_directionInEye(normal);
#else
    return cameraNormal;
#endif
}
