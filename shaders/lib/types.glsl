// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The names of types in shaders/lib, as GLSL defines them. C++ has its own definitions, in double and in float, in
// osgGeoFX/effect/GlslFunctions.h. This header also tells how a file of shaders/lib must be written.
#define GEOFX_INLINE

#define GEOFX_NEWTON_STEPS 1 // enough for floats in geofx_bendArcInverse
#define GEOFX_SERIES_TERMS 5 // and in lib/series.glsl

#define Number float   // without a unit
#define Length float   // metres
#define Angle float    // radians
#define PerMetre float // radians per metre
#define Vector2 vec2   // each component without a unit, a direction
#define Profile vec2   // a point (s, h) of a profile, metres
#define Vector3 vec3   // each component without a unit, a direction
#define Row vec4       // of a 4 x 4 matrix
#define Position vec3  // a point in eye space, metres
#define Rgb vec3       // 0 to 1
#define Rgba vec4      // 0 to 1
