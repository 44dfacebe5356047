// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Cylindrical panorama maps, which show an arc of the horizon or all of it. A place on the ground is (x, s): metres to the
// right of the eye's foot, and away from it. A place on the cylinder is (x, s), too: x follows the circle that is the
// picture's base, and s goes away from this circle.
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/series.glsl"
#endif

// How far from the eye's foot ground begins to be drawn, and from where on it is drawn in full; of the circle's radius.
const Number GEOFX_CYLINDER_NONE = Number(0.1);
const Number GEOFX_CYLINDER_FULL = Number(0.3);

struct geofx_Cylinder
{
    Length ring;  // the radius of the circle that is the picture's base; 0: the base is a straight line, and nothing here acts
    Angle middle; // of the part that is drawn, clockwise from the heading
    Angle halfArc;   // the half of this part's arc, with some room
};

// From 0 at `from` to 1 at `to`, smoothly.
GEOFX_INLINE Number geofx_cylinderEase(Number value, Number from, Number to)
{
    Number t = clamp((value - from) / (to - from), Number(0), Number(1));
    return t * t * (3 - 2 * t);
}

// Clockwise from the heading, from -pi to pi. The eye's foot itself is straight ahead.
GEOFX_INLINE Angle geofx_cylinderAzimuth(Vector2 ground)
{
    Length side = abs(ground.x);
    Length ahead = abs(ground.y);
    if (side + ahead <= 0) return Angle(0);
    Number small = min(side, ahead) / max(side, ahead);
    Angle angle = small * geofx_atanc(small);
    if (side > ahead) angle = Angle(1.5707963267948966) - angle;
    if (ground.y < 0) angle = Angle(3.141592653589793) - angle;
    return ground.x < 0 ? -angle : angle;
}

// The place on the cylinder of a place on the ground. The seam lies opposite of the part that is drawn.
GEOFX_INLINE Vector2 geofx_cylinderPlace(geofx_Cylinder view, Vector2 ground)
{
    Angle turned = geofx_cylinderAzimuth(ground) - view.middle;
    if (turned > Angle(3.141592653589793)) turned -= Angle(6.283185307179586);
    if (turned < Angle(-3.141592653589793)) turned += Angle(6.283185307179586);
    return Vector2(view.ring * (view.middle + turned), length(ground) - view.ring);
}

// The inverse.
GEOFX_INLINE Vector2 geofx_cylinderGround(geofx_Cylinder view, Vector2 place)
{
    Angle azimuth = place.x / view.ring;
    Length away = place.y + view.ring;
    return Vector2(away * sin(azimuth), away * cos(azimuth));
}

// The scale of widths at a distance s, as a share of the base's.
GEOFX_INLINE Number geofx_cylinderWidth(geofx_Cylinder view, Length s)
{
    return view.ring > 0 ? view.ring / (view.ring + max(s, Length(0))) : Number(1);
}

// How a place is kept out of the picture, if it lies opposite of what is drawn or right below the eye. The first number is
// the share of its depth: 1 in sight. At 0 it lies at the eye itself, so a triangle from there into the picture is seen from
// its edge. The second one is the share of its way to the side; it is 0 at the seam, so that nothing jumps.
GEOFX_INLINE Vector2 geofx_cylinderShown(geofx_Cylinder view, Vector2 place)
{
    Angle turned = abs(place.x / view.ring - view.middle);
    Angle left = Angle(3.141592653589793) - view.halfArc;
    Number away = place.y / view.ring + 1;
    Number near = geofx_cylinderEase(away, GEOFX_CYLINDER_NONE, GEOFX_CYLINDER_FULL);
    Number beside = 1 - geofx_cylinderEase(turned, view.halfArc + Number(0.25) * left, view.halfArc + Number(0.6) * left);
    Number seam = 1 - geofx_cylinderEase(turned, view.halfArc + Number(0.6) * left, Angle(3.141592653589793));
    return Vector2(near * beside, geofx_cylinderEase(away, Number(0), GEOFX_CYLINDER_NONE) * seam);
}
