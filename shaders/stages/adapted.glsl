// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Around an application's program that knows nothing of the effects (EffectScene::adapt): where it has put a vertex in clip space,
// where in eye space that is, and where the effects move it. In the last stage before the picture: vertices', tessellation's or
// geometry's.
//
// scene/detail/AdaptedPrograms.cpp says what the application's text does: GEOFX_HOST_VERTEX, it reads gl_Vertex;
// GEOFX_HOST_NORMAL, it reads gl_Normal; GEOFX_HOST_CLIPS, it writes what clip planes cut; GEOFX_HOST_LOG, it works with logarithms;
// GEOFX_HOST_DEPTH, its fragments have a depth of their own; GEOFX_HOST_TEXTURE, it writes gl_TexCoord in a later stage.
#include "stages/depth.glsl"
#ifdef GEOFX_EVALUATION
#include "stages/planes.glsl"
#endif
vec4 geofx_vertex(vec4 eyePosition);
vec3 geofx_normal(vec4 eyePosition, vec3 eyeNormal);
#ifdef GEOFX_LATER_STAGE
void geofx_texture(vec4 coordinates);
#endif

#ifdef GEOFX_HOST_DEPTH
out vec2 geofx_hostPlace; // z and w as the application has them
#endif

// Parallel projections have the same w everywhere.
bool geofx_isParallel()
{
    mat4 p = gl_ProjectionMatrix;
    return p[0].w == 0.0 && p[1].w == 0.0 && p[2].w == 0.0;
}

// What the projection takes there. Where w tells the distance, the depth does not count: it may be of any kind, and far away w is
// the more precise one.
vec4 geofx_eyeOf(vec4 clip)
{
    mat4 p = gl_ProjectionMatrix;
    bool parallel = geofx_isParallel();
    vec3 x = parallel ? p[0].xyz : p[0].xyw;
    vec3 y = parallel ? p[1].xyz : p[1].xyw;
    vec3 z = parallel ? p[2].xyz : p[2].xyw;
    vec3 known = parallel ? clip.xyz * (p[3].w / clip.w) - p[3].xyz : clip.xyw - p[3].xyw;
    vec3 across = cross(y, z);
    return vec4(vec3(dot(known, across), dot(x, cross(known, z)), dot(x, cross(y, known))) / dot(x, across), 1.0);
}

#ifdef GEOFX_HOST_VERTEX
// Whether it is gl_Vertex, as well as rounding tells. Then the effects get what they get of geometry without a program, to the last
// bit, and no gap opens between neighbours.
bool geofx_isGiven(vec4 clip)
{
    mat4 m = gl_ModelViewProjectionMatrix;
    vec4 size = abs(m[0] * gl_Vertex.x) + abs(m[1] * gl_Vertex.y) + abs(m[2] * gl_Vertex.z) + abs(m[3] * gl_Vertex.w);
    bvec4 near = lessThanEqual(abs(clip - ftransform()), 1e-6 * size);
    return near.x && near.y && near.w && (near.z || !geofx_isParallel()) && gl_Vertex.w != 0.0;
}
#endif

#ifdef GEOFX_HOST_LOG
float geofx_logarithm(float w)
{
    return log2(max(1e-6, 1.0 + w));
}
#endif

// The depth of a vertex that has moved, for a depth that the application has written in its former place: `from`, the depth that the
// projection gives to that place; `to`, to the new one.
float geofx_depth(vec4 written, vec4 from, vec4 to)
{
    float difference = abs(written.z - from.z) / (abs(from.z) + abs(from.w));
    if (difference <= 1e-6) return to.z;
#ifdef GEOFX_REVERSED_DEPTH
    // A sky, at the far plane, which glClipControl may have moved from -w to 0.
    if (written.z == 0.0 || written.z == -written.w) return written.z == 0.0 ? 0.0 : -to.w;
#else
    if (written.z == written.w) return to.w; // a sky, at the far plane
#endif
#ifdef GEOFX_HOST_LOG
    // (log2(1 + w) F - 1) w with the F that it wrote.
    if (difference > 1e-5 && abs(written.w) > 1e-4)
        return ((written.z / written.w + 1.0) * geofx_logarithm(to.w) / geofx_logarithm(written.w) - 1.0) * to.w;
#endif
    // As much nearer or farther than the projection has it; not beyond the far plane for that.
    float shifted = to.z + (written.z / written.w - from.z / from.w) * to.w;
#ifdef GEOFX_REVERSED_DEPTH
    if (written.z < -written.w) return shifted;
    return max(shifted, min(to.z, written.z < 0.0 ? -to.w : 0.0));
#else
    return written.z <= written.w ? min(shifted, max(to.z, to.w)) : shifted;
#endif
}

void geofx_moveHost()
{
    vec4 written = gl_Position;
#ifdef GEOFX_HOST_DEPTH
    geofx_hostPlace = written.zw;
#endif
    vec4 eye = geofx_eyeOf(written);
#ifdef GEOFX_HOST_VERTEX
    if (geofx_isGiven(written)) eye = gl_ModelViewMatrix * gl_Vertex;
#endif
    // Clip planes cut the ground as it lies.
#if !defined(GEOFX_HOST_CLIPS) && defined(GEOFX_EVALUATION)
    GEOFX_CUT_BY_PLANES(eye);
#elif !defined(GEOFX_HOST_CLIPS)
    gl_ClipVertex = eye;
#endif
#ifdef GEOFX_HOST_TEXTURE
    geofx_texture(gl_TexCoord[0]);
#endif
    vec4 moved = geofx_vertex(eye);
#ifdef GEOFX_HOST_NORMAL
    // Effects that look at normals are told.
    vec3 normal = gl_NormalMatrix * gl_Normal;
    if (dot(normal, normal) > 0.0) geofx_normal(eye, normalize(normal));
#endif
    if (moved == eye) return;
    vec4 to = gl_ProjectionMatrix * moved;
    to.z = geofx_depth(written, gl_ProjectionMatrix * eye, to);
    gl_Position = to;
}
