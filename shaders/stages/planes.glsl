// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// GEOFX_CUT_BY_PLANES(eye): clip planes cut the ground where it lies, undeformed; for the tessellation evaluation stage, in which
// NVIDIA's compiler knows no gl_ClipVertex. A plane that is off cuts nothing. A core profile has no such planes.
#ifdef GEOFX_CORE
#define GEOFX_CUT_BY_PLANES(eye)
#else
#define GEOFX_PLANE(i, eye) gl_ClipDistance[i] = dot(gl_ClipPlane[i], eye)
#define GEOFX_CUT_BY_PLANES(eye) GEOFX_PLANE(0, eye); GEOFX_PLANE(1, eye); GEOFX_PLANE(2, eye); GEOFX_PLANE(3, eye); GEOFX_PLANE(4, eye); GEOFX_PLANE(5, eye)
#endif
