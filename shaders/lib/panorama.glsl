// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The projection of panorama maps, after Section 3.1 of Brown and Samavati (2017).
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/exaggeration.glsl"
#include "lib/cylinder.glsl"
#include "lib/profile.glsl"
#endif

// A place of the map: x to the right of the middle and s away from the picture's base, along the ground, and the
// height above the sea, metres. On a globe x and s are the azimuthal equidistant projection about the point below the
// eye. In a cylindrical map x and s are those on the cylinder.
//
// A point of the picture has x and y from -1 to 1. n is the distance from the eye along its axis, and grows with s.
// Of two places at the same point of the picture, the one with the smaller s hides the other.
struct geofx_Panorama
{
    geofx_Exaggeration globe; // factor 0 and base 0: takes a position to its foot
    Vector3 right;            // in the plane of the ground below the eye, unit vectors
    Vector3 forward;
    PerMetre across;  // of the picture's x for each metre of x; 1 / (half the width of the ground shown)
    PerMetre along;   // of the picture's y for each metre up the curve (geofx_panoramaRise)
    PerMetre lift;    // of the picture's y for each metre of height, at the base
    Length base;      // the height that lies on the curve
    Length curve;     // D1, where the ground begins to curve
    Length horizon;   // D2, where it has reached the horizon; beyond, only what rises above it is seen
    Length end;       // where that has gone, too; as far again behind it, all ground is gathered in one point
    Number arch;      // 2 C: the horizon's bend, in the picture's y (Eq. 1)
    Length nearest;   // n of the base, > 0
    Vector3 origin;   // a point of the picture is a line of eye space: origin + x originX + y originY
    Vector3 originX;
    Vector3 originY;
    Vector3 direction; // + n (direction + x directionX + y directionY); the direction's z is -1
    Vector3 directionX;
    Vector3 directionY;
    Number plain;     // the share of the camera's own perspective, 0 to 1
    Number mirrored;  // 1: that perspective shows what is turned over at the height `water`, as still water does; else 0
    Length water;
    geofx_Cylinder cylinder;
    PerMetre liftGrowth; // how much more the lift is at the horizon
    geofx_Profile profile; // the curve through points that a user sets
};

// The angle over its sine, from its cosine. It stretches the orthographic projection to the equidistant one. The
// error is within 1e-4 up to 60 degrees. Beyond, the function still grows.
GEOFX_INLINE Number geofx_arcStretch(Number cosine)
{
    Number u = 1 - cosine;
    return 1 + u * (Number(1.0 / 3.0) +
                    u * (Number(2.0 / 15.0) +
                         u * (Number(2.0 / 35.0) +
                              u * (Number(8.0 / 315.0) + u * (Number(8.0 / 693.0) + u * Number(16.0 / 3003.0))))));
}

// (x, s, height) of a position, on the ground.
GEOFX_INLINE Position geofx_panoramaGround(geofx_Panorama view, Position position)
{
    geofx_Vertical vertical = geofx_exaggerationVertical(view.globe, position);
    Position foot = position - vertical.height / vertical.steepness * vertical.gradient;
    Number steepness = dot(normalize(geofx_exaggerationGradient(view.globe, foot)), view.globe.up);
    Number stretch = geofx_arcStretch(steepness);
    // The other side of the Earth must lie farther away than anything on this side.
    Length behind = view.globe.curvature > 0 ? max(-steepness, Number(0)) * 20 / view.globe.curvature : Length(0);
    return Position(stretch * dot(foot, view.right), stretch * dot(foot, view.forward) + behind,
                    vertical.height);
}

// (x, s, height) of a position.
GEOFX_INLINE Position geofx_panoramaPlace(geofx_Panorama view, Position position)
{
    Position ground = geofx_panoramaGround(view, position);
    if (!(view.cylinder.ring > 0)) return ground;
    Vector2 place = geofx_cylinderPlace(view.cylinder, Vector2(ground.x, ground.y));
    return Position(place.x, place.y, ground.z);
}

// The inverse of geofx_panoramaPlace, up to 60 degrees from the eye's foot.
GEOFX_INLINE Position geofx_panoramaPosition(geofx_Panorama view, Position seen)
{
    Position place = seen;
    if (view.cylinder.ring > 0)
    {
        Vector2 plane = geofx_cylinderGround(view.cylinder, Vector2(seen.x, seen.y));
        place = Position(plane.x, plane.y, seen.z);
    }
    Vector3 ground = place.x * view.right + place.y * view.forward;
    Position position = ground + (place.z - view.globe.height) * view.globe.up;
    // Each step leaves a share of the last error: about the square of the angle.
    for (int i = 0; i < 24; ++i)
    {
        Position error = place - geofx_panoramaGround(view, position);
        Vector3 up = normalize(geofx_exaggerationGradient(view.globe, position));
        position += error.x * view.right + error.y * view.forward;
        position += (error.z - dot(error.x * view.right + error.y * view.forward, up)) * up;
    }
    return position;
}

// The distance up the curve at a distance s: metres at the scale of the base (paper, Figure 5), or of the mean with
// points that a user sets.
GEOFX_INLINE Length geofx_panoramaRise(geofx_Panorama view, Length s)
{
    if (view.profile.first > 0) return view.horizon * geofx_profileRise(view.profile, s / view.horizon);
    Length bent = clamp(s - view.curve, Length(0), view.horizon - view.curve);
    return min(s, view.curve) + bent - bent * bent / (2 * max(view.horizon - view.curve, Length(1e-3)));
}

// The scale of ground along the view at a distance s: the derivative of geofx_panoramaRise.
GEOFX_INLINE Number geofx_panoramaSlope(geofx_Panorama view, Length s)
{
    if (view.profile.first > 0) return geofx_profileSlope(view.profile, s / view.horizon);
    return clamp((view.horizon - s) / max(view.horizon - view.curve, Length(1e-3)), Number(0), Number(1));
}

// 1 up to `from`. 0 as far behind it as the end is behind the horizon.
GEOFX_INLINE Number geofx_panoramaFadeFrom(geofx_Panorama view, Length from, Length s)
{
    Number t = clamp(1 - (s - from) / max(view.end - view.horizon, Length(1e-3)), Number(0), Number(1));
    return t * t * (3 - 2 * t);
}

// How far behind the eye nothing is drawn of an engine's coarse tiles.
GEOFX_INLINE Length geofx_panoramaBehind(geofx_Panorama view)
{
    return 3 * view.horizon + 2 / view.across + Length(2e5);
}

// How far to each side nothing is drawn of them. Such ground comes into the picture behind the end alone, where it is gathered. Its
// height has shrunk to less than a twentieth then.
GEOFX_INLINE Length geofx_panoramaAside(geofx_Panorama view)
{
    Length behind = geofx_panoramaBehind(view);
    return view.cylinder.ring > 0 ? behind : min(behind, 20 / view.across);
}

// The share of its height that an object at a distance s shows: 1 up to the horizon.
GEOFX_INLINE Number geofx_panoramaFade(geofx_Panorama view, Length s)
{
    return geofx_panoramaFadeFrom(view, view.horizon, s);
}

// Of the picture's y for each metre of height at a distance s, without what has faded. In a cylindrical map heights get smaller
// with the distance as widths do.
GEOFX_INLINE PerMetre geofx_panoramaLift(geofx_Panorama view, Length s)
{
    return geofx_profileLift(view.lift, view.liftGrowth, s / view.horizon) * geofx_cylinderWidth(view.cylinder, s);
}

// How far Eq. 1 lowers a point of the picture. Beside the picture the bend goes on straight. A cosine would rise again there,
// and an edge of a triangle from the picture to such a place would lie above the horizon.
GEOFX_INLINE Number geofx_panoramaArch(geofx_Panorama view, Number x)
{
    Number quarter = Number(1.5707963267948966);
    Number within = min(abs(x), Number(1));
    return view.arch * (1 - cos(within * quarter) + (abs(x) - within) * quarter);
}

// n of a place, without what keeps it out of a cylinder's picture.
GEOFX_INLINE Length geofx_panoramaDepth(geofx_Panorama view, Length s)
{
    return s > 0 ? view.nearest + s : view.nearest * view.nearest / (view.nearest - s);
}

// The point (x, y) of the picture and n, of a place.
GEOFX_INLINE Position geofx_panoramaPicture(geofx_Panorama view, Position place)
{
    Length side = place.x;
    Length n = geofx_panoramaDepth(view, place.y);
    if (view.cylinder.ring > 0)
    {
        Vector2 shown = geofx_cylinderShown(view.cylinder, Vector2(place.x, place.y));
        Length middle = view.cylinder.ring * view.cylinder.middle;
        side = middle + shown.y * (side - middle);
        n *= shown.x;
    }
    Number x = side * view.across * geofx_panoramaFadeFrom(view, view.end, place.y);
    Number y = view.along * geofx_panoramaRise(view, place.y) - 1 +
               geofx_panoramaLift(view, place.y) * (place.z - view.base) * geofx_panoramaFade(view, place.y) -
               geofx_panoramaArch(view, x);
    return Position(x, y, n);
}

// The inverse of geofx_panoramaPicture, if a height shows at all.
GEOFX_INLINE Position geofx_panoramaPlaceAt(geofx_Panorama view, Position picture)
{
    Length s = picture.z > view.nearest ? picture.z - view.nearest
                                        : view.nearest - view.nearest * view.nearest / picture.z;
    Number y = picture.y + 1 + geofx_panoramaArch(view, picture.x) - view.along * geofx_panoramaRise(view, s);
    Number lift = geofx_panoramaLift(view, s) * max(geofx_panoramaFade(view, s), Number(1e-6));
    return Position(picture.x / view.across, s, view.base + y / lift);
}

GEOFX_INLINE Position geofx_panoramaEye(geofx_Panorama view, Position picture)
{
    return view.origin + picture.x * view.originX + picture.y * view.originY +
           picture.z * (view.direction + picture.x * view.directionX + picture.y * view.directionY);
}

// The inverse of geofx_panoramaEye. It needs a projection that separates x and y, as frusta and boxes do.
GEOFX_INLINE Position geofx_panoramaPictureAt(geofx_Panorama view, Position eye)
{
    Length n = view.origin.z - eye.z;
    Vector3 middle = view.origin + n * view.direction;
    Vector3 right = view.originX + n * view.directionX;
    Vector3 up = view.originY + n * view.directionY;
    return Position((eye.x - middle.x) / right.x, (eye.y - middle.y) / up.y, n);
}

// Where a position with a known place is drawn.
GEOFX_INLINE Position geofx_panoramaDraw(geofx_Panorama view, Position position, Position place)
{
    Position drawn = geofx_panoramaEye(view, geofx_panoramaPicture(view, place));
    if (view.plain > 0)
    {
        Position own = position;
        if (view.mirrored > 0)
            own += 2 * (view.water - place.z) * normalize(geofx_exaggerationGradient(view.globe, position));
        drawn += view.plain * (own - drawn);
    }
    return drawn;
}

GEOFX_INLINE Position geofx_panoramaDeform(geofx_Panorama view, Position position)
{
    return geofx_panoramaDraw(view, position, geofx_panoramaPlace(view, position));
}

// The inverse of geofx_panoramaDeform, without a share of the camera's own perspective.
GEOFX_INLINE Position geofx_panoramaUndeform(geofx_Panorama view, Position position)
{
    return geofx_panoramaPosition(view, geofx_panoramaPlaceAt(view, geofx_panoramaPictureAt(view, position)));
}
