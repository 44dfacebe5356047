// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// GEOFX_CUT_BY_PLANES(eye): clip planes cut the ground where it lies, undeformed; for the tessellation evaluation stage, in which
// NVIDIA's compiler knows no gl_ClipVertex. It alone has gl_ClipDistance instead: Mesa's llvmpipe goes by that also for planes that
// are off. A core profile has no such planes.
#if defined(GEOFX_CORE)
#define GEOFX_CUT_BY_PLANES(eye)
#elif defined(GL_NV_gpu_shader5)
#define GEOFX_PLANE(i, eye) gl_ClipDistance[i] = dot(gl_ClipPlane[i], eye)
#define GEOFX_CUT_BY_PLANES(eye) GEOFX_PLANE(0, eye); GEOFX_PLANE(1, eye); GEOFX_PLANE(2, eye); GEOFX_PLANE(3, eye); GEOFX_PLANE(4, eye); GEOFX_PLANE(5, eye)
#else
#define GEOFX_CUT_BY_PLANES(eye) gl_ClipVertex = eye
#endif
