// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Projective mappings, after Sections 3.1 to 3.3 and 4.3 of Trapp and Doellner (2009): the place of a raster on the
// ground, its strength, and the blending of its color with the scene's.
//
// A place is a point of the mappings' frame: x and y on the reference plane and the height above it, metres. On a
// globe the plane is the tangent plane at the frame's origin. The ellipsoid is projected onto it along the origin's
// normal (the orthographic projection of PROJ). A point above the ground has the place of its foot.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// O, and the rows that take a place to the raster, with the extra transform M_T: (u, v) = 1/2 + A d / (1 + w.d) with
// d = P - O. In the paper's printed matrices the bias has the wrong sign, and the scale is inverted.
struct geofx_Projector
{
    Vector2 center; // metres
    Vector2 rowU;   // per metre
    Vector2 rowV;   // per metre
    Vector2 rowW;   // per metre; 0 unless M_T is projective
};

// The raster coordinates of a place: 0 to 1 from the left and from the bottom. They are far outside if the projection
// has no image there.
GEOFX_INLINE Vector2 geofx_projectPlane(geofx_Projector projector, Vector2 place)
{
    Vector2 d = place - projector.center;
    Number w = 1 + dot(projector.rowW, d);
    Vector2 uv = Vector2(dot(projector.rowU, d), dot(projector.rowV, d));
    return w > Number(1e-6) ? Number(0.5) + uv / w : Vector2(-1, -1);
}

// The change of raster coordinates along a step, as a derivative at the place. The end of the step may lie behind the
// projection's horizon, so a difference would not do.
GEOFX_INLINE Vector2 geofx_projectPlaneStep(geofx_Projector projector, Vector2 place, Vector2 step)
{
    Vector2 d = place - projector.center;
    Number w = max(1 + dot(projector.rowW, d), Number(1e-6));
    Vector2 uv = Vector2(dot(projector.rowU, d), dot(projector.rowV, d)) / w;
    return (Vector2(dot(projector.rowU, step), dot(projector.rowV, step)) - uv * dot(projector.rowW, step)) / w;
}

// A camera with lens distortion after Brown: radial k1 k2 k3, tangential p1 p2, in tangents of the view's angles.
struct geofx_Pinhole
{
    Position eye;    // metres, in the mappings' frame
    Vector3 right;   // unit vector over the tangent of half the angle of view across
    Vector3 up;      // the same, upwards
    Vector3 forward; // unit vector
    Vector3 radial;
    Vector2 tangential;
    Vector2 tangents; // of half the angles of view
    Number reach;     // square of the tangents' radius to which the distortion grows with the angle
};

GEOFX_INLINE Vector2 geofx_projectPinhole(geofx_Pinhole camera, Position position)
{
    Vector3 d = position - camera.eye;
    Length depth = dot(d, camera.forward);
    if (!(depth > 0))
    {
        return Vector2(-1, -1);
    }
    Vector2 t = Vector2(dot(d, camera.right), dot(d, camera.up)) / depth * camera.tangents;
    Number r2 = dot(t, t);
    // Beyond, polynomials fold the world back into the picture.
    if (!(r2 < camera.reach))
    {
        return Vector2(-1, -1);
    }
    Number radial = 1 + r2 * (camera.radial.x + r2 * (camera.radial.y + r2 * camera.radial.z));
    Number cross = 2 * t.x * t.y;
    Vector2 bent = radial * t + Vector2(camera.tangential.x * cross + camera.tangential.y * (r2 + 2 * t.x * t.x),
                                        camera.tangential.x * (r2 + 2 * t.y * t.y) + camera.tangential.y * cross);
    return Number(0.5) + Number(0.5) * bent / camera.tangents;
}

// As geofx_projectPlaneStep.
GEOFX_INLINE Vector2 geofx_projectPinholeStep(geofx_Pinhole camera, Position position, Vector3 step)
{
    Vector3 d = position - camera.eye;
    Length depth = max(dot(d, camera.forward), Number(1e-6));
    Vector2 t = Vector2(dot(d, camera.right), dot(d, camera.up)) / depth * camera.tangents;
    Vector2 dt =
        (Vector2(dot(step, camera.right), dot(step, camera.up)) * camera.tangents - t * dot(step, camera.forward)) /
        depth;
    // The derivative of geofx_projectPinhole's polynomial.
    Number r2 = dot(t, t);
    Number dr2 = 2 * dot(t, dt);
    Number radial = 1 + r2 * (camera.radial.x + r2 * (camera.radial.y + r2 * camera.radial.z));
    Number growth = dr2 * (camera.radial.x + r2 * (2 * camera.radial.y + r2 * 3 * camera.radial.z));
    Number cross = 2 * (dt.x * t.y + t.x * dt.y);
    Vector2 tangential = Vector2(camera.tangential.x * cross + camera.tangential.y * (dr2 + 4 * t.x * dt.x),
                                 camera.tangential.x * (dr2 + 4 * t.y * dt.y) + camera.tangential.y * cross);
    return Number(0.5) * (radial * dt + growth * t + tangential) / camera.tangents;
}

// The share of a pixel within the raster along one axis: 0 at its edge, 1 from a pixel inwards on. `width` is the
// pixel's, in raster coordinates.
GEOFX_INLINE Number geofx_edge(Number coordinate, Number width)
{
    Number inwards = Number(0.5) - abs(coordinate - Number(0.5));
    return clamp(inwards / max(width, Number(1e-9)), Number(0), Number(1));
}

// 0 at `none`, 1 at `full` and beyond, linear between them. A step if both are equal.
GEOFX_INLINE Number geofx_ramp(Number value, Number none, Number full)
{
    if (none == full)
    {
        return value >= full ? Number(1) : Number(0);
    }
    return clamp((value - none) / (full - none), Number(0), Number(1));
}

// The share of a pixel that is within a line, whose middle is so many pixels away.
GEOFX_INLINE Number geofx_lineCover(Number away, Number width)
{
    return clamp(Number(0.5) * width + Number(0.5) - away, Number(0), min(width, Number(1)));
}

// Lines that lie closer together than twice their width are none, and from four times on all of it is there.
GEOFX_INLINE Number geofx_lineRoom(Number spacing, Number width)
{
    return clamp(spacing / (2 * width) - 1, Number(0), Number(1));
}

// Lines at the multiples of `interval`, of something that changes by `across` and `up` to the next pixels. Each line that has a
// number divisible by `index` is twice as wide; 0: none is.
GEOFX_INLINE Number geofx_isolines(Number value, Number across, Number up, Number interval, Number width, Number index)
{
    Number slope = max(sqrt(across * across + up * up), interval * Number(1e-6)); // in a pixel
    Number away = abs(value - interval * floor(value / interval + Number(0.5))) / slope;
    Number cover = geofx_lineCover(away, width) * geofx_lineRoom(interval / slope, width);
    if (index > 0)
    {
        Number coarse = interval * index;
        Number beside = abs(value - coarse * floor(value / coarse + Number(0.5))) / slope;
        cover = max(cover, geofx_lineCover(beside, 2 * width) * geofx_lineRoom(coarse / slope, 2 * width));
    }
    // Level ground has no lines, not even at their height.
    return slope > interval * Number(2e-6) ? cover : Number(0);
}

// Discs of `width` pixels at the corners of squares, metres. `across` and `up` are the place's changes to the next pixels.
GEOFX_INLINE Number geofx_dots(Vector2 place, Vector2 across, Vector2 up, Number interval, Number width)
{
    Vector2 d = place - interval * floor(place / interval + Number(0.5));
    Number area = across.x * up.y - across.y * up.x;
    Number size = max(abs(area), Number(1e-12) * interval * interval);
    Vector2 pixels = Vector2(d.x * up.y - d.y * up.x, across.x * d.y - across.y * d.x) / size;
    Number largest = sqrt(max(max(dot(across, across), dot(up, up)), Number(1e-24)));
    return geofx_lineCover(length(pixels), width) * geofx_lineRoom(interval / largest, width);
}

// What turns places of a frame on an ellipsoid into degrees, about the frame's origin: the sine and cosine of its latitude, its distance
// from the axis and the radius of its meridian's curve, metres, and how that grows to the north.
struct geofx_Graticule
{
    Number sine;
    Number cosine;
    Length axis;
    Length meridian;
    Number drift;
};

// Degrees of longitude and latitude from the origin's. Exact in longitude; in latitude to a part in a million of what is asked for near the
// origin, and to a tenth of a kilometre ten degrees away.
GEOFX_INLINE Vector2 geofx_degrees(geofx_Graticule frame, Position position)
{
    Number axis = frame.axis + position.z * frame.cosine - position.y * frame.sine;
    // Differences of large numbers would lose the metres.
    Number bulge = position.x * position.x / max(sqrt(position.x * position.x + axis * axis) + axis, Number(1));
    Number latitude = atan(position.y - frame.sine * bulge, frame.meridian + position.z + frame.cosine * bulge);
    latitude -= frame.drift * latitude * latitude;
    return Vector2(atan(position.x, axis), latitude) * Number(57.295779513082321);
}

// OpenGL's blend functions, numbered as osgGeoFX/mapping/ColorTransfer.h does.
GEOFX_INLINE Rgb geofx_blendFactor(int factor, Rgba source, Rgba destination, Rgba constant)
{
    Rgb one = Rgb(1, 1, 1);
    if (factor == 0) return Rgb(0, 0, 0);
    if (factor == 1) return one;
    if (factor == 2) return Rgb(source.x, source.y, source.z);
    if (factor == 3) return one - Rgb(source.x, source.y, source.z);
    if (factor == 4) return Rgb(destination.x, destination.y, destination.z);
    if (factor == 5) return one - Rgb(destination.x, destination.y, destination.z);
    if (factor == 6) return source.w * one;
    if (factor == 7) return (1 - source.w) * one;
    if (factor == 8) return destination.w * one;
    if (factor == 9) return (1 - destination.w) * one;
    if (factor == 10) return Rgb(constant.x, constant.y, constant.z);
    if (factor == 11) return one - Rgb(constant.x, constant.y, constant.z);
    if (factor == 12) return constant.w * one;
    if (factor == 13) return (1 - constant.w) * one;
    return min(source.w, 1 - destination.w) * one; // GL_SRC_ALPHA_SATURATE
}

GEOFX_INLINE Number geofx_overlay(Number source, Number destination)
{
    return destination <= Number(0.5) ? 2 * source * destination : 1 - 2 * (1 - source) * (1 - destination);
}

// Blend equations: OpenGL's five, and multiply, screen and overlay. These three take the source's alpha as their
// share.
GEOFX_INLINE Rgb geofx_blend(int equation, int sourceFactor, int destinationFactor, Rgba source, Rgba destination,
                             Rgba constant)
{
    Rgb s = Rgb(source.x, source.y, source.z);
    Rgb d = Rgb(destination.x, destination.y, destination.z);
    Rgb result = d;
    if (equation < 3)
    {
        Rgb first = s * geofx_blendFactor(sourceFactor, source, destination, constant);
        Rgb second = d * geofx_blendFactor(destinationFactor, source, destination, constant);
        result = equation == 0 ? first + second : equation == 1 ? first - second : second - first;
    }
    else if (equation == 3)
    {
        result = min(s, d);
    }
    else if (equation == 4)
    {
        result = max(s, d);
    }
    else if (equation == 5)
    {
        result = mix(d, s * d, source.w);
    }
    else if (equation == 6)
    {
        result = mix(d, s + d - s * d, source.w);
    }
    else
    {
        Rgb over = Rgb(geofx_overlay(s.x, d.x), geofx_overlay(s.y, d.y), geofx_overlay(s.z, d.z));
        result = mix(d, over, source.w);
    }
    return clamp(result, Number(0), Number(1));
}

// The filtering of a raster: the level of the pyramid, and the number of probes along an axis (texels).
struct geofx_Filter
{
    Number level;
    Number probes;
    Vector2 step; // from probe to probe
};

// `across` and `up` are the changes of the raster's texel coordinates from pixel to pixel.
GEOFX_INLINE geofx_Filter geofx_filter(Vector2 across, Vector2 up, Number mostProbes, Number lastLevel)
{
    // The pixel's footprint is an ellipse. The eigenvalues of its matrix are the squares of the half axes.
    Number p = across.x * across.x + up.x * up.x;
    Number q = across.x * across.y + up.x * up.y;
    Number r = across.y * across.y + up.y * up.y;
    Number mean = (p + r) / 2;
    Number root = sqrt((p - r) * (p - r) / 4 + q * q);
    Number longest2 = mean + root;
    // If texels are larger than pixels, one probe sees everything.
    Number shortest2 = max(mean - root, Number(1));
    geofx_Filter result;
    result.probes = clamp(floor(sqrt(longest2 / shortest2) + Number(0.5)), Number(1), mostProbes);
    Number share = 1 / result.probes;
    Vector2 axis = p > r ? Vector2(longest2 - r, q) : Vector2(q, longest2 - p);
    result.level = clamp(log2(max(longest2 * share * share, Number(1e-12))) / 2, Number(0), lastLevel);
    result.step = axis * (share * sqrt(longest2 / max(dot(axis, axis), Number(1e-18))));
    return result;
}
