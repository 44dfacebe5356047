// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The liberties that painters of maps take: a region enlarged, widened or turned, and the ground around it as it was.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// Local places are (across, along, up) from the region's center at height 0, metres; the ground below a place lies on a
// paraboloid. Each of the movements takes a plane or a line onto itself and keeps the border, so all together stay one to one.
struct geofx_Liberty
{
    Position center; // at height 0
    Vector3 across;  // unit vectors
    Vector3 along;
    Vector3 up;
    Length acrossRadius; // half the region's width
    Length alongRadius;
    PerMetre curvature; // of the ground at height 0
    Length base;        // the height that stays
    Number enlarge;     // what is added to the factor of heights, 1, in the middle; > -1
    Number widen;       // and to that of widths across, -0.9 to 1.2
    Number lengthen;    // and along, -0.9 to 1.2
    Angle turn;         // of the middle, clockwise from above
};

// The share of the effect at a squared distance from the middle, 1 at the border.
GEOFX_INLINE Number geofx_libertyShare(Number squared)
{
    Number left = max(1 - squared, Number(0));
    return left * left;
}

GEOFX_INLINE Vector3 geofx_libertyLocal(geofx_Liberty view, Position position)
{
    Vector3 away = position - view.center;
    return Vector3(dot(away, view.across), dot(away, view.along), dot(away, view.up));
}

// How far a local place moves: not at all outside the region, and on the other side of the Earth.
GEOFX_INLINE Vector3 geofx_libertyWay(geofx_Liberty view, Vector3 local)
{
    Number x = local.x / view.acrossRadius;
    Number y = local.y / view.alongRadius;
    Number squared = x * x + y * y;
    if (squared >= 1 || view.curvature * local.z < Number(-0.5)) return Vector3(0, 0, 0);
    Number share = geofx_libertyShare(squared);
    Number c = cos(view.turn * share);
    Number s = sin(view.turn * share);
    Number turnedX = c * x + s * y;
    Number turnedY = c * y - s * x;
    Number wide = turnedX * (1 + view.widen * share);
    Number deep = turnedY * (1 + view.lengthen * geofx_libertyShare(wide * wide + turnedY * turnedY));
    Length acrossWay = (wide - x) * view.acrossRadius;
    Length alongWay = (deep - y) * view.alongRadius;
    Length height = local.z + view.curvature / 2 * (local.x * local.x + local.y * local.y);
    Length upWay = view.enlarge * share * (height - view.base) -
                   view.curvature / 2 * (acrossWay * (2 * local.x + acrossWay) + alongWay * (2 * local.y + alongWay));
    return Vector3(acrossWay, alongWay, upWay);
}

GEOFX_INLINE Position geofx_liberty(geofx_Liberty view, Position position)
{
    Vector3 way = geofx_libertyWay(view, geofx_libertyLocal(view, position));
    return position + way.x * view.across + way.y * view.along + way.z * view.up;
}

// The angle by which a thing that keeps its shape turns about the vertical where it stands, counter-clockwise from above.
GEOFX_INLINE Angle geofx_libertyTurn(geofx_Liberty view, Position position)
{
    Vector3 local = geofx_libertyLocal(view, position);
    Length step = Number(0.0005) * min(view.acrossRadius, view.alongRadius);
    Vector3 alongX = Vector3(step, 0, 0);
    Vector3 alongY = Vector3(0, step, 0);
    Vector3 x = (geofx_libertyWay(view, local + alongX) - geofx_libertyWay(view, local - alongX)) / (2 * step);
    Vector3 y = (geofx_libertyWay(view, local + alongY) - geofx_libertyWay(view, local - alongY)) / (2 * step);
    return atan(x.y - y.x, 2 + x.x + y.y);
}

// The deformed unit normal of a surface: that of the cofactors of the movement's derivatives.
GEOFX_INLINE Vector3 geofx_libertyNormal(geofx_Liberty view, Position position, Vector3 normal)
{
    Vector3 local = geofx_libertyLocal(view, position);
    Number x = local.x / view.acrossRadius;
    Number y = local.y / view.alongRadius;
    Number squared = x * x + y * y;
    if (squared >= 1 || view.curvature * local.z < Number(-0.5)) return normal;
    // Each row has the derivatives by x and by y, in half widths.
    Number share = geofx_libertyShare(squared);
    Vector2 shareSlope = -4 * (1 - squared) * Vector2(x, y);
    Number c = cos(view.turn * share);
    Number s = sin(view.turn * share);
    Number turnedX = c * x + s * y;
    Number turnedY = c * y - s * x;
    Vector2 slopeX = Vector2(c, s) + turnedY * view.turn * shareSlope;
    Vector2 slopeY = Vector2(-s, c) - turnedX * view.turn * shareSlope;
    Number wide = turnedX * (1 + view.widen * share);
    Vector2 wideSlope = (1 + view.widen * share) * slopeX + turnedX * view.widen * shareSlope;
    Number left = max(1 - wide * wide - turnedY * turnedY, Number(0));
    Number deepShare = left * left;
    Vector2 deepShareSlope = -4 * left * (wide * wideSlope + turnedY * slopeY);
    Number deep = turnedY * (1 + view.lengthen * deepShare);
    Vector2 deepSlope = (1 + view.lengthen * deepShare) * slopeY + turnedY * view.lengthen * deepShareSlope;
    // In metres. A height has no influence on the place.
    Vector2 perMetre = Vector2(1 / view.acrossRadius, 1 / view.alongRadius);
    Vector2 acrossSlope = view.acrossRadius * wideSlope * perMetre;
    Vector2 alongSlope = view.alongRadius * deepSlope * perMetre;
    Number rise = 1 + view.enlarge * share;
    Length height = local.z + view.curvature / 2 * (local.x * local.x + local.y * local.y);
    Vector2 upSlope = view.enlarge * (height - view.base) * shareSlope * perMetre +
                      view.curvature * (rise * Vector2(local.x, local.y) - wide * view.acrossRadius * acrossSlope -
                                        deep * view.alongRadius * alongSlope);
    Number acrossPart = dot(normal, view.across);
    Number alongPart = dot(normal, view.along);
    Number upPart = dot(normal, view.up);
    // The columns' cross products: (across, along, up) of the surface that the three derivatives span.
    Vector3 byX = Vector3(acrossSlope.x, alongSlope.x, upSlope.x);
    Vector3 byY = Vector3(acrossSlope.y, alongSlope.y, upSlope.y);
    Vector3 byZ = Vector3(0, 0, rise);
    Vector3 turned = acrossPart * cross(byY, byZ) + alongPart * cross(byZ, byX) + upPart * cross(byX, byY);
    return normalize(turned.x * view.across + turned.y * view.along + turned.z * view.up);
}
