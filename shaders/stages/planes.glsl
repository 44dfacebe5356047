// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// GEOFX_CUT_BY_PLANES(eye): clip planes cut the ground where it lies, undeformed; for the tessellation evaluation stage, in which
// NVIDIA's compiler knows no gl_ClipVertex. A plane that is off cuts nothing. A core profile has no such planes.
#ifdef GEOFX_CORE
#define GEOFX_CUT_BY_PLANES(eye)
#else
#define GEOFX_CUT_BY_PLANES(eye)                     \
    gl_ClipDistance[0] = dot(gl_ClipPlane[0], eye);  \
    gl_ClipDistance[1] = dot(gl_ClipPlane[1], eye);  \
    gl_ClipDistance[2] = dot(gl_ClipPlane[2], eye);  \
    gl_ClipDistance[3] = dot(gl_ClipPlane[3], eye);  \
    gl_ClipDistance[4] = dot(gl_ClipPlane[4], eye);  \
    gl_ClipDistance[5] = dot(gl_ClipPlane[5], eye)
#endif
