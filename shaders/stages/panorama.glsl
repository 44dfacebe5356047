// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// PanoramaMap's projection in the vertex stage. SLOT_ stands for the effect's prefix.
#include "lib/panorama.glsl"

uniform vec4 SLOT_up;
uniform vec4 SLOT_axis;
uniform vec4 SLOT_right;
uniform vec4 SLOT_forward;
uniform vec4 SLOT_scale;
uniform vec4 SLOT_curve;
uniform vec4 SLOT_origin;
uniform vec4 SLOT_originX;
uniform vec4 SLOT_originY;
uniform vec4 SLOT_direction;
uniform vec4 SLOT_directionX;
uniform vec4 SLOT_directionY;
uniform vec4 SLOT_cylinder;
uniform vec4 SLOT_profile; // how much more heights are raised at the horizon, for each metre; the curve's first slope
uniform vec4 SLOT_knot1;   // of the bending curve, as in lib/profile.glsl
uniform vec4 SLOT_knot2;
uniform vec4 SLOT_knot3;
uniform vec4 SLOT_knot4;
uniform vec4 SLOT_knot5;
uniform vec4 SLOT_knot6;

geofx_Profile SLOT_bendingCurve()
{
    return geofx_Profile(SLOT_profile.y, SLOT_knot1.xyz, SLOT_knot2.xyz, SLOT_knot3.xyz, SLOT_knot4.xyz,
                         SLOT_knot5.xyz, SLOT_knot6.xyz);
}

geofx_Panorama SLOT_view()
{
    geofx_Exaggeration globe = geofx_Exaggeration(SLOT_up.xyz, SLOT_axis.xyz, SLOT_up.w, SLOT_right.w, SLOT_axis.w,
                                                  SLOT_forward.w, 0.0, 0.0);
    return geofx_Panorama(globe, SLOT_right.xyz, SLOT_forward.xyz, SLOT_scale.x, SLOT_scale.y, SLOT_scale.z,
                          SLOT_scale.w, SLOT_curve.x, SLOT_curve.y, SLOT_curve.z, SLOT_curve.w, SLOT_origin.w,
                          SLOT_origin.xyz, SLOT_originX.xyz, SLOT_originY.xyz, SLOT_direction.xyz,
                          SLOT_directionX.xyz, SLOT_directionY.xyz, SLOT_originX.w, SLOT_originY.w, SLOT_direction.w,
                          geofx_Cylinder(SLOT_cylinder.x, SLOT_cylinder.y, SLOT_cylinder.z),
                          SLOT_profile.x, SLOT_bendingCurve());
}

// The place of the last position. The painting and the projection mostly ask for the same one.
vec3 SLOT_knownPosition = vec3(1e30);
vec3 SLOT_knownPlace;

vec3 SLOT_placeOf(vec3 position)
{
    if (position != SLOT_knownPosition)
    {
        SLOT_knownPosition = position;
        SLOT_knownPlace = geofx_panoramaPlace(SLOT_view(), position);
    }
    return SLOT_knownPlace;
}

// An engine leaves tiles coarse that are out of sight. A triangle of theirs would lead from ground beside the picture or behind the
// eye to the one point in which all ground far ahead is gathered, right across the picture. So such ground ends at the eye itself: a
// triangle from there is seen from its edge. Only far away, where no triangle of the picture ends. Not with an orthographic camera.
#ifdef GEOFX_HOST_COARSE_TILES
bool SLOT_isAside(vec3 place)
{
    geofx_Panorama view = SLOT_view();
    bool hasEye = length(view.directionX) > 1e-4;
    bool gathered = place.y > 2.0 * view.end - view.horizon;
    return hasEye && view.plain == 0.0 && !gathered &&
           (abs(place.x) > geofx_panoramaAside(view) || -place.y > geofx_panoramaBehind(view));
}
#endif

vec3 SLOT_deform(vec3 position)
{
#ifdef GEOFX_HOST_COARSE_TILES
    if (SLOT_isAside(SLOT_placeOf(position))) return vec3(0.0);
#endif
    return geofx_panoramaDraw(SLOT_view(), position, SLOT_placeOf(position));
}

// A map shows all things in its own projection.
vec3 SLOT_carried(vec3 position, vec3 offset)
{
    return SLOT_deform(position + offset) - SLOT_deform(position);
}

// The ground is lit as it lies.
vec3 SLOT_normal(vec3 position, vec3 normal)
{
    return normal;
}

float SLOT_style(vec3 position)
{
    return 0.0;
}
