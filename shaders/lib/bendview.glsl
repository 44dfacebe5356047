// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A bend placed before a camera, after Sections 3 and 4 of Lorenz et al. (2008). It takes positions in eye space to
// the bend's profile and back. The CPU computes the placement once for each camera and frame.
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/bend.glsl"
#endif

struct geofx_BendView
{
    Vector3 normal;  // n of the reference plane T, towards the sky
    Vector3 forward; // D: in T, across the parallel lines, away from the focus
    Length height;   // of the eye above T
    Length start;    // where the line b lies, along D from the point of T below the eye
    geofx_Bend bend;
};

// The profile of a position.
GEOFX_INLINE Profile geofx_bendViewProfile(geofx_BendView view, Position position)
{
    return Vector2(dot(position, view.forward) - view.start, dot(position, view.normal) + view.height);
}

// Where the view moves a position. The focus stays as it is, to the last bit.
GEOFX_INLINE Position geofx_bendViewDeform(geofx_BendView view, Position position)
{
    Profile point = geofx_bendViewProfile(view, position);
    if (!(point.x > 0))
    {
        return position;
    }
    Vector2 offset = geofx_bend(view.bend, point) - point;
    return position + offset.x * view.forward + offset.y * view.normal;
}

// The inverse of geofx_bendViewDeform, as exact as geofx_unbend.
GEOFX_INLINE Position geofx_bendViewUndeform(geofx_BendView view, Position position)
{
    Profile point = geofx_bendViewProfile(view, position);
    if (!(point.x > 0))
    {
        return position;
    }
    Vector2 offset = geofx_unbend(view.bend, point) - point;
    return position + offset.x * view.forward + offset.y * view.normal;
}

// The deformed unit normal of a surface. The position is the one before the deformation.
GEOFX_INLINE Vector3 geofx_bendViewNormal(geofx_BendView view, Position position, Vector3 normal)
{
    Profile point = geofx_bendViewProfile(view, position);
    if (!(point.x > 0))
    {
        return normal;
    }
    geofx_BendFrame frame = geofx_bendFrame(view.bend, point.x);
    Vector2 inside = Vector2(dot(normal, view.forward), dot(normal, view.normal));
    Number stretch = max(geofx_bendStretch(frame, point.y), Number(1e-3));
    Vector2 turned = geofx_bendTurn(frame, Vector2(inside.x / stretch, inside.y));
    Vector2 change = turned - inside;
    return normalize(normal + change.x * view.forward + change.y * view.normal);
}

// A vector of a thing that keeps its shape and stands at a position: turned with the ground there.
GEOFX_INLINE Vector3 geofx_bendViewTurn(geofx_BendView view, Position position, Vector3 offset)
{
    Profile point = geofx_bendViewProfile(view, position);
    if (!(point.x > 0))
    {
        return offset;
    }
    Vector2 inside = Vector2(dot(offset, view.forward), dot(offset, view.normal));
    Vector2 change = geofx_bendTurn(geofx_bendFrame(view.bend, point.x), inside) - inside;
    return offset + change.x * view.forward + change.y * view.normal;
}

// How far, at most, the image of a straight edge departs from a straight line, metres: by the bend's curvature, and by its jumps
// where the zone begins and ends: of its speed, and above and below T of its turn rate. Both are 0 outside of the zone. `rates` are what the bend has at most: the curvature; the
// change of the turn rate and its square; the turn rate; the jump of speed. The same for both directions, to the last bit.
GEOFX_INLINE Vector2 geofx_bendViewSag(geofx_BendView view, Row rates, Position from, Position to)
{
    Profile a = geofx_bendViewProfile(view, from);
    Profile b = geofx_bendViewProfile(view, to);
    Length first = min(a.x, b.x);
    Length last = max(a.x, b.x);
    if (!(last > 0) || !(first < view.bend.size))
    {
        return Vector2(0, 0);
    }
    // P = C(s) + h N(s); its second derivative along the edge.
    Vector2 edge = abs(b - a);
    Length height = max(abs(a.y), abs(b.y));
    Length curve = edge.x * (edge.x * (rates.x + height * rates.y) + 2 * edge.y * rates.z);
    bool jumps = first < 0 || last > view.bend.size;
    return Vector2(curve / 8, jumps ? edge.x * (rates.w + height * rates.z) / 4 : Number(0));
}

// q, the paper's value for blending styles: 0 in the focus, 1 in the context.
GEOFX_INLINE Number geofx_bendViewStyle(geofx_BendView view, Position position)
{
    Length s = dot(position, view.forward) - view.start;
    return s > 0 ? clamp(s / max(view.bend.size, Number(1e-3)), Number(0), Number(1)) : Number(0);
}
