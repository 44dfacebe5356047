// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// CloseUps in the vertex stage. With GEOFX_AMPLIFY the geometry stage moves the vertices. With GEOFX_TESSELLATE two
// more stages come before that one.
#include "lib/exaggeration.glsl"
#pragma import_defines(SLOT_DATA, SLOT_ROUND)

uniform int SLOT_layer;        // twice the item, and 1 more for its anchor
uniform mat4 SLOT_toSurface;   // from eye space to the frame of the surface data
uniform vec4 SLOT_globe;       // the ellipsoid's axis and flattening; lib/exaggeration.glsl
uniform vec4 SLOT_curve;       // its curvature and scale
uniform vec4 SLOT_surfaceArea; // the pictures' corner and one over their size

#if defined(GEOFX_TESSELLATE)
#define SLOT_surface SLOT_surface_vertex
#define SLOT_located SLOT_located_vertex
#define SLOT_bent SLOT_bent_vertex
out vec3 SLOT_normal_vertex;
#elif defined(GEOFX_AMPLIFY)
#define SLOT_surface SLOT_surface_in
#define SLOT_located SLOT_located_in
#define SLOT_bent SLOT_bent_in
#endif
out vec2 SLOT_surface;
#ifdef GEOFX_AMPLIFY
out vec3 SLOT_located;
out vec3 SLOT_bent;
#else
out vec3 SLOT_place;
#endif

vec2 SLOT_surfacePlace(vec3 located)
{
    vec3 position = (SLOT_toSurface * vec4(located, 1.0)).xyz;
#ifdef SLOT_ROUND
    geofx_Exaggeration globe = geofx_Exaggeration(vec3(0.0, 0.0, 1.0), SLOT_globe.xyz, 0.0, SLOT_curve.x,
                                                  SLOT_globe.w, SLOT_curve.y, 0.0, 0.0);
    position = geofx_exaggerate(globe, position);
#endif
    return (position.xy - SLOT_surfaceArea.xy) * SLOT_surfaceArea.zw;
}

float SLOT_share = -1.0; // share of the way, if the geometry gives it itself; else negative

// For anchors with a geometry of their own.
void SLOT_setShare(float share)
{
    SLOT_share = share;
}

vec3 SLOT_move(vec3 located, vec3 bent)
{
#ifdef SLOT_DATA
    SLOT_surface = SLOT_surfacePlace(located);
#else
    SLOT_surface = vec2(0.0);
#endif
#ifdef GEOFX_AMPLIFY
    SLOT_located = located;
    SLOT_bent = bent;
#ifdef GEOFX_TESSELLATE
    SLOT_normal_vertex = geofx_directionInView(gl_NormalMatrix * gl_Normal);
#endif
    return bent;
#else
    int item = SLOT_layer / 2;
    if (SLOT_share >= 0.0)
    {
        SLOT_place = vec3(SLOT_placeOf(item, located).xy, SLOT_share);
        return geofx_raise(bent, geofx_lift(SLOT_liftOf(item), located), SLOT_share);
    }
    return SLOT_moved(item, SLOT_layer - 2 * item, located, bent, SLOT_place);
#endif
}
