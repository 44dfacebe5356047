// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Vertical exaggeration in eye space, above a plane or an ellipsoid of revolution.
//
// No number here is as large as the Earth, so floats suffice. Positions are relative to the eye's foot on the
// ellipsoid, q. There the ellipsoid is F(q) = 2 n.q + k (q.q + e (q.p)^2) = 0, in metres, with the normal n, the axis
// of revolution p, k = 1/(a^2 |grad|) and e = a^2/b^2 - 1. A plane has k = 0. The height follows from F and its
// gradient. It is exact for a plane and for a sphere, and for the Earth within a millimetre at 9 km.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

struct geofx_Exaggeration
{
    Vector3 up;         // n at the eye's foot
    Vector3 axis;       // p; any unit vector for a plane
    Length height;      // of the eye above its foot
    PerMetre curvature; // k
    Number flattening;  // e
    PerMetre scale;     // relates F to the ellipsoid's equation; about 1/radius, 0 for a plane
    Number factor;      // > 0; 1 changes nothing
    Length base;        // the height that stays as it is
};

// Half of F's gradient. It is vertical, and has the length 1 at the eye's foot.
GEOFX_INLINE Vector3 geofx_exaggerationGradient(geofx_Exaggeration view, Position position)
{
    Vector3 q = position + view.height * view.up;
    return view.up + view.curvature * (q + view.flattening * dot(q, view.axis) * view.axis);
}

// The vertical through a position.
struct geofx_Vertical
{
    Vector3 gradient; // as above
    Number steepness; // its length; at least 0.1, since a point near the Earth's center has no useful height
    Length height;    // above the plane or ellipsoid
};

GEOFX_INLINE geofx_Vertical geofx_exaggerationVertical(geofx_Exaggeration view, Position position)
{
    Vector3 q = position + view.height * view.up;
    Length along = dot(q, view.axis);
    Length value = 2 * (dot(position, view.up) + view.height) +
                   view.curvature * (dot(q, q) + view.flattening * along * along);
    Number surface = sqrt(max(1 + value * view.scale, Number(0.01)));
    geofx_Vertical vertical;
    vertical.gradient = geofx_exaggerationGradient(view, position);
    vertical.steepness = max(length(vertical.gradient), Number(0.1));
    vertical.height = value / (vertical.steepness * (1 + 1 / surface));
    return vertical;
}

// Height above the plane or ellipsoid.
GEOFX_INLINE Length geofx_exaggerationHeight(geofx_Exaggeration view, Position position)
{
    return geofx_exaggerationVertical(view, position).height;
}

GEOFX_INLINE Position geofx_exaggerate(geofx_Exaggeration view, Position position)
{
    geofx_Vertical vertical = geofx_exaggerationVertical(view, position);
    Length lift = (view.factor - 1) * (vertical.height - view.base);
    return position + lift / vertical.steepness * vertical.gradient;
}

// The inverse, by Newton's method. The derivative is that of a sphere: `factor` along the vertical, and across it the
// spreading of the verticals times the lift. The ellipsoid's flattening changes this spreading by a share of 1e-2, so
// each step gains two digits or more. On a plane the first step is exact.
GEOFX_INLINE Position geofx_unexaggerate(geofx_Exaggeration view, Position position)
{
    Position original = position;
    for (int i = 0; i < 8; ++i)
    {
        geofx_Vertical vertical = geofx_exaggerationVertical(view, original);
        Vector3 up = vertical.gradient / vertical.steepness;
        Length lift = (view.factor - 1) * (vertical.height - view.base);
        Position error = original + lift * up - position;
        Length excess = dot(error, up);
        Number spread = max(1 + lift * view.curvature / vertical.steepness, Number(0.1));
        original -= (error - excess * up) / spread + excess / view.factor * up;
    }
    return original;
}

// The deformed unit normal of a surface.
GEOFX_INLINE Vector3 geofx_exaggerationNormal(geofx_Exaggeration view, Position position, Vector3 normal)
{
    Vector3 up = normalize(geofx_exaggerationGradient(view, position));
    return normalize(normal + (1 / view.factor - 1) * dot(normal, up) * up);
}
