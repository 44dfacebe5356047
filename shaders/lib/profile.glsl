// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What changes in a panorama map from the picture's base to its horizon. u is the distance from the base over that of
// the horizon: 0 at the base, 1 at the horizon.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// Of the picture's y for each metre of height: `lift` at the base, `growth` more at the horizon and beyond.
GEOFX_INLINE PerMetre geofx_profileLift(PerMetre lift, PerMetre growth, Number u)
{
    Number t = clamp(u, Number(0), Number(1));
    return lift + growth * t * t * (3 - 2 * t);
}

// The bending curve through points that a user sets: a monotone cubic after Steffen (1990). A knot has u, the height
// there as a share of the horizon line's, and the slope of the curve. Knots that are not used are (1, 1, 0), the horizon.
struct geofx_Profile
{
    Number first; // the slope at the base; 0: there are no points, and D1 and D2 give the curve
    Vector3 knot1;
    Vector3 knot2;
    Vector3 knot3;
    Vector3 knot4;
    Vector3 knot5;
    Vector3 knot6;
};

// From one knot to the next: a cubic of t, 0 to 1.
struct geofx_ProfilePart
{
    Number begin; // u
    Number width;
    Number height; // at its beginning
    Number slope;  // the coefficients of t, t * t and t * t * t
    Number second;
    Number third;
};

GEOFX_INLINE geofx_ProfilePart geofx_profileBetween(Vector3 from, Vector3 to)
{
    Number width = max(to.x - from.x, Number(1e-6));
    Number rise = to.y - from.y;
    Number a = from.z * width;
    Number b = to.z * width;
    geofx_ProfilePart part;
    part.begin = from.x;
    part.width = width;
    part.height = from.y;
    part.slope = a;
    part.second = 3 * rise - 2 * a - b;
    part.third = a + b - 2 * rise;
    return part;
}

GEOFX_INLINE geofx_ProfilePart geofx_profilePart(geofx_Profile profile, Number u)
{
    Vector3 from = Vector3(Number(0), Number(0), profile.first);
    Vector3 to = profile.knot1;
    if (u >= to.x) { from = to; to = profile.knot2; }
    if (u >= to.x) { from = to; to = profile.knot3; }
    if (u >= to.x) { from = to; to = profile.knot4; }
    if (u >= to.x) { from = to; to = profile.knot5; }
    if (u >= to.x) { from = to; to = profile.knot6; }
    if (u >= to.x) { from = to; to = Vector3(Number(1), Number(1), Number(0)); }
    return geofx_profileBetween(from, to);
}

// The height of the ground at u, of the horizon line's. Before the base the curve goes straight on.
GEOFX_INLINE Number geofx_profileRise(geofx_Profile profile, Number u)
{
    if (u <= 0) return profile.first * u;
    if (u >= 1) return Number(1);
    geofx_ProfilePart part = geofx_profilePart(profile, u);
    Number t = (u - part.begin) / part.width;
    return part.height + t * (part.slope + t * (part.second + t * part.third));
}

// Its derivative, which is never negative.
GEOFX_INLINE Number geofx_profileSlope(geofx_Profile profile, Number u)
{
    if (u <= 0) return profile.first;
    if (u >= 1) return Number(0);
    geofx_ProfilePart part = geofx_profilePart(profile, u);
    Number t = (u - part.begin) / part.width;
    return max(part.slope + t * (2 * part.second + 3 * t * part.third), Number(0)) / part.width;
}

// The inverse of geofx_profileRise, up to the horizon, by Newton's method within narrowing bounds.
GEOFX_INLINE Number geofx_profileDistance(geofx_Profile profile, Number height)
{
    if (height <= 0) return height / profile.first;
    if (height >= 1) return Number(1);
    Vector3 from = Vector3(Number(0), Number(0), profile.first);
    Vector3 to = profile.knot1;
    if (height > to.y) { from = to; to = profile.knot2; }
    if (height > to.y) { from = to; to = profile.knot3; }
    if (height > to.y) { from = to; to = profile.knot4; }
    if (height > to.y) { from = to; to = profile.knot5; }
    if (height > to.y) { from = to; to = profile.knot6; }
    if (height > to.y) { from = to; to = Vector3(Number(1), Number(1), Number(0)); }
    geofx_ProfilePart part = geofx_profileBetween(from, to);
    Number low = Number(0);
    Number high = Number(1);
    Number t = Number(0.5);
    for (int i = 0; i < 60; ++i)
    {
        Number error = part.height + t * (part.slope + t * (part.second + t * part.third)) - height;
        if (error < 0)
            low = t;
        else
            high = t;
        Number slope = part.slope + t * (2 * part.second + 3 * t * part.third);
        Number next = t - error / max(slope, Number(1e-6));
        if (next <= low || next >= high) next = Number(0.5) * (low + high);
        if (next == t) break;
        t = next;
    }
    return part.begin + t * part.width;
}
