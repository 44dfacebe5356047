// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Close-ups, after Section II of "Interactive close-ups for digital terrain models": the place of a vertex of the
// ground, the reading of a mask, and the restyling of colors.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// The rows of a matrix from eye space to eye space. The last row is (0, 0, 0, 1), unless the close-up is drawn
// without perspective.
struct geofx_Lift
{
    Row x;
    Row y;
    Row z;
    Row w;
};

// The place of a point of the ground in the close-up.
GEOFX_INLINE Position geofx_lift(geofx_Lift lift, Position position)
{
    Row p = Row(position.x, position.y, position.z, 1);
    return Position(dot(lift.x, p), dot(lift.y, p), dot(lift.z, p)) / dot(lift.w, p);
}

// The paper's C = m M + (1 - m) I. What other deformations make of the point takes the place of I.
GEOFX_INLINE Position geofx_raise(Position ground, Position lifted, Number mask)
{
    return ground + (lifted - ground) * mask;
}

// A place of the region, -1 to 1, in texels of a picture, where whole numbers are the centers of texels.
GEOFX_INLINE Vector2 geofx_maskTexel(Vector2 place, Number side)
{
    return (place + Vector2(1, 1)) * (side / 2) - Vector2(Number(0.5), Number(0.5));
}

// Between four texels. `part` is the distance of the place from the first one.
GEOFX_INLINE Vector2 geofx_between(Vector2 lowLeft, Vector2 lowRight, Vector2 highLeft, Vector2 highRight, Vector2 part)
{
    Vector2 low = lowLeft + (lowRight - lowLeft) * part.x;
    Vector2 high = highLeft + (highRight - highLeft) * part.x;
    return low + (high - low) * part.y;
}

// The distance of a place, -1 to 1, from the edge of the region's square, negative beyond it. `halfSides` are the
// region's.
GEOFX_INLINE Number geofx_squareEdge(Vector2 place, Vector2 halfSides)
{
    Vector2 within = (Vector2(1, 1) - abs(place)) * halfSides;
    return min(within.x, within.y);
}

// The distance to a region's border at a place, in the unit of `halfSides`. `distance` is that of the nearest texels
// of a mask with `side` texels on a side. These texels end half a texel before the region does. From there on the
// border continues, as near as the region's edge is.
GEOFX_INLINE Number geofx_border(Number distance, Vector2 place, Number side, Vector2 halfSides)
{
    Number outermost = 1 - 1 / side;
    Vector2 within = clamp(place, Vector2(-outermost, -outermost), Vector2(outermost, outermost));
    return distance + (geofx_squareEdge(place, halfSides) - geofx_squareEdge(within, halfSides));
}

// The share of a pixel inside. The border is `distance` away, and a pixel is `pixel` wide.
GEOFX_INLINE Number geofx_coverage(Number distance, Number pixel)
{
    return clamp(distance / max(pixel, Number(1e-9)) + Number(0.5), Number(0), Number(1));
}

// Saturation about the grey of equal luma (ITU-R BT.709), contrast about middle grey, then brightness. The result may be
// below 0 or above 1.
GEOFX_INLINE Rgb geofx_restyleBright(Rgb color, Number saturation, Number contrast, Number brightness)
{
    Number luma = dot(color, Rgb(Number(0.2126), Number(0.7152), Number(0.0722)));
    Rgb grey = Rgb(luma, luma, luma);
    Rgb middle = Rgb(Number(0.5), Number(0.5), Number(0.5));
    Rgb result = (grey + (color - grey) * saturation - middle) * contrast + middle;
    return result + Rgb(brightness, brightness, brightness);
}

// The same, from 0 to 1.
GEOFX_INLINE Rgb geofx_restyle(Rgb color, Number saturation, Number contrast, Number brightness)
{
    return clamp(geofx_restyleBright(color, saturation, contrast, brightness), Rgb(0, 0, 0), Rgb(1, 1, 1));
}

// The light of a sun on a surface. A share of it comes from everywhere.
GEOFX_INLINE Number geofx_sunlight(Vector3 normal, Vector3 sun)
{
    Number everywhere = Number(0.35);
    return everywhere + (1 - everywhere) * max(dot(normal, sun), Number(0)) / max(sun.z, Number(0.3));
}
