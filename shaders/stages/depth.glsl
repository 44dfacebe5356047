// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What depth is: the projection's, reversed or not, or a logarithmic one (osgGeoFX/effect/DepthConvention.h). All stages that place
// vertices, write a depth or compare two of them go by this file.
#pragma import_defines(GEOFX_REVERSED_DEPTH)
#pragma import_defines(GEOFX_LOG_DEPTH, GEOFX_LOG_DEPTH_OF_FRAGMENTS)

// Not functions: a program may have this text in several shaders of one stage.

// Of two depths in the buffer.
#ifdef GEOFX_REVERSED_DEPTH
#define GEOFX_FARTHEST 0.0
#define geofx_nearest(a, b) max(a, b)
#define geofx_isBehind(a, b) ((a) < (b))
#else
#define GEOFX_FARTHEST 1.0
#define geofx_nearest(a, b) min(a, b)
#define geofx_isBehind(a, b) ((a) > (b))
#endif

#ifdef GEOFX_LOG_DEPTH
uniform float geofx_logDepth; // F = 2 / log2(the far distance + 1)
#define geofx_depthOfW(w) (log2(max(1e-6, 1.0 + (w))) * geofx_logDepth)
#endif

// For clip coordinates of a vertex: gives them their depth.
#if defined(GEOFX_LOG_DEPTH) && !defined(GEOFX_LOG_DEPTH_OF_FRAGMENTS)
#define GEOFX_PUT_DEPTH(clip) clip.z = (geofx_depthOfW(clip.w) - 1.0) * clip.w
#else
#define GEOFX_PUT_DEPTH(clip)
#endif

// The z for clip coordinates `clip` that gives them the depth of `other`, as a whole: not for what is larger than a point.
#ifdef GEOFX_LOG_DEPTH
#define geofx_depthOf(other, clip) ((geofx_depthOfW(other.w) - 1.0) * clip.w)
#else
#define geofx_depthOf(other, clip) (other.z / other.w * clip.w)
#endif

// At the end of a fragment shader. The second one is for triangles so long that the depths of their vertices would not do.
#ifdef GEOFX_LOG_DEPTH
#define GEOFX_PUT_EXACT_DEPTH gl_FragDepth = 0.5 * geofx_depthOfW(1.0 / gl_FragCoord.w)
#else
#define GEOFX_PUT_EXACT_DEPTH
#endif
#ifdef GEOFX_LOG_DEPTH_OF_FRAGMENTS
#define GEOFX_PUT_FRAGMENT_DEPTH GEOFX_PUT_EXACT_DEPTH
#else
#define GEOFX_PUT_FRAGMENT_DEPTH
#endif
