// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where a terrain ends, and what a panorama map shows there. A picture of the terrain's extent, and of some land
// around it, has the distance of each place to the end of what is known.
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/series.glsl"
#include "lib/painting.glsl"
#include "lib/cylinder.glsl"
#endif

// The place of a panorama map in this picture.
struct geofx_Edge
{
    Number globe;     // 1 on a globe, 0 on a plane
    Vector2 origin;   // plane: the eye's foot from the extent's middle, metres; globe: its longitude from there and its
                      // latitude, radians
    Vector2 right;    // east and north for each metre to the right: plane: metres, globe: radians
    Vector2 forward;  // the same for each metre away from the base
    Vector2 scale;    // of the picture, for each of these metres or radians
    Angle latitude;   // of the extent's middle
    geofx_Cylinder cylinder;
};

// The place (x, s) of a panorama map in the picture, 0 to 1; other numbers lie outside of it. On a globe the way is a
// great circle of the sphere that touches it below the eye. The error is less than 1e-3 of the distance up to 500 km.
GEOFX_INLINE Vector2 geofx_edgePlace(geofx_Edge edge, Vector2 seen)
{
    Vector2 place = seen;
    if (edge.cylinder.ring > 0) place = geofx_cylinderGround(edge.cylinder, seen);
    Vector2 way = place.x * edge.right + place.y * edge.forward;
    if (edge.globe < Number(0.5))
    {
        Vector2 plane = (edge.origin + way) * edge.scale;
        return Vector2(plane.x + Number(0.5), plane.y + Number(0.5));
    }
    Angle arc = length(way);
    Number cosine = cos(min(arc, Number(3.1)));
    // The sine over the arc, in halves, since its series reaches to pi / 2.
    Angle halfArc = Number(0.5) * min(arc, Number(3.1));
    Number sine = geofx_sinc(halfArc) * cos(halfArc);
    Number sine0 = sin(edge.origin.y);
    Number cosine0 = cos(edge.origin.y);
    Number y = way.x * sine;
    Number x = cosine * cosine0 - way.y * sine * sine0;
    Number z = cosine * sine0 + way.y * sine * cosine0;
    Number level = sqrt(x * x + y * y);
    Angle east = edge.origin.x + (x > abs(y) ? y / x * geofx_atanc(y / x) : atan(y, x));
    // North of the eye's foot. This form stays exact for short ways.
    Number rise = z * cosine0 - level * sine0;
    Number run = level * cosine0 + z * sine0;
    Angle north = run > abs(rise) ? rise / run * geofx_atanc(rise / run) : atan(rise, run);
    if (east > Number(3.141592653589793)) east -= Number(6.283185307179586);
    if (east < Number(-3.141592653589793)) east += Number(6.283185307179586);
    return Vector2(Number(0.5) + east * edge.scale.x,
                   Number(0.5) + (edge.origin.y + north - edge.latitude) * edge.scale.y);
}

// The share of haze or paper at a place, 0 to 1. `distance` goes to the end of what is known, negative beyond it. The
// share is 1 a little before the end, so that no border shows. `noise`, -1 to 1, frays it, by `rough`, 0 to 1.
GEOFX_INLINE Number geofx_edgeAmount(Length distance, Length width, Number noise, Number rough)
{
    Number t = 1 - geofx_share(distance / max(width, Number(1e-3)));
    t += 2 * rough * noise * t * max(Number(0.84) - t, Number(0));
    return geofx_ease(t, Number(0.04), Number(0.84));
}

// The share of paper in the haze. `y` is the height in the picture, 0 at its base to 1.
GEOFX_INLINE Number geofx_edgePaper(Number y)
{
    return 1 - geofx_ease(y, Number(0.08), Number(0.5));
}
