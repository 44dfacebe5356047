// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Brush strokes of panorama maps, after Section 3.3 of Brown and Samavati (2017): trees, cliffs and houses, and roads
// and rivers in the same hand.
//
// Strokes stand on a lattice that covers the ground. Those of a level 0, 1/2, 1, 3/2 ... and all higher ones stand at
// a spacing of 2^level steps. Each half level has as many strokes as all levels above it. `wanted` is the level, with
// fractions, whose spacing looks right on the screen.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

const int GEOFX_STROKE_TREE = 0;
const int GEOFX_STROKE_CLIFF = 1;
const int GEOFX_STROKE_HOUSE = 2;
const int GEOFX_STROKE_ROAD = 3;
const int GEOFX_STROKE_RIVER = 4;
const int GEOFX_STROKE_CONIFER = 5; // what a tree may be drawn as
const int GEOFX_STROKE_BLOCK = 6;   // what a house may be drawn as: one of several storeys,
const int GEOFX_STROKE_TOWER = 7;   // and what one sees from afar

// Half of the range of levels over which a stroke disappears.
const Number GEOFX_STROKE_WINDOW = Number(0.06);

// The level whose spacing is `pixels` on the screen. A metre of the ground has `pixelsPerMetre`.
GEOFX_INLINE Number geofx_strokeWanted(Number pixels, Length step, Number pixelsPerMetre)
{
    return log2(max(pixels, Number(1e-6)) / max(step * pixelsPerMetre, Number(1e-12)));
}

// The wanted level at which a stroke disappears, from its own level and its threshold, 0 to 1. The strokes of a half
// level disappear one by one, so that the density falls with the square of the wanted spacing. All are gone when the
// next ones begin to disappear.
GEOFX_INLINE Number geofx_strokeEnd(Number level, Number threshold)
{
    return level + Number(0.5) - Number(0.5) * log2(1 + threshold);
}

// The size of a stroke, 0 to 1. It shrinks to 0, and does not pop.
GEOFX_INLINE Number geofx_strokeScale(Number level, Number threshold, Number wanted)
{
    Number left = (geofx_strokeEnd(level, threshold) - wanted) / (2 * GEOFX_STROKE_WINDOW) + Number(0.5);
    Number t = clamp(left, Number(0), Number(1));
    return t * t * (3 - 2 * t);
}

// The growth of strokes where even the finest ones stand too far apart, so that the forest keeps its look a while.
GEOFX_INLINE Number geofx_strokeGrowth(Number wanted)
{
    return clamp(exp(Number(-0.6931471805599453) * wanted), Number(1), Number(3));
}

// The size of strokes, and of the distance between them, at a share of the way to the horizon. Painters set them smaller and
// denser there, and so tell the distance.
GEOFX_INLINE Number geofx_strokeShrink(Number far)
{
    return 1 - Number(0.42) * clamp(far, Number(0), Number(1));
}

// The strokes of roads and rivers disappear level by level. The remaining ones are long enough by then to cover their
// places.
GEOFX_INLINE bool geofx_strokeOfLine(Number level, Number wanted)
{
    return level >= floor(wanted);
}

// Half of their length on the ground, from the step of the lattice and the finest level that there is. They overlap.
GEOFX_INLINE Length geofx_strokeReach(Length step, Number finest, Number wanted)
{
    return Number(0.65) * step * exp(Number(0.6931471805599453) * max(wanted, finest));
}

// One of several random numbers, 0 to 1, from the seed of a stroke, which has 15 bits.
GEOFX_INLINE Number geofx_strokeRandom(Number seed, Number which)
{
    return fract(seed * (Number(61) + Number(38.6) * which) + Number(0.618034) * which);
}

// What a tree is drawn as. `share`: its height above the sea over that of the tree line. Conifers stand above broadleaves, and
// the border between them is loose.
GEOFX_INLINE int geofx_strokeTree(Number share, Number seed)
{
    return share + Number(0.4) * (geofx_strokeRandom(seed, Number(6)) - Number(0.5)) > Number(0.45) ? GEOFX_STROKE_CONIFER
                                                                                                   : GEOFX_STROKE_TREE;
}

// The share of open ground that has strokes along its fall line, 0 to 1: few on hills, most of it on cliffs. `cliff`: the slope of
// those. Far tiles have lost the steepest of their slopes, so this begins far below it.
GEOFX_INLINE Number geofx_strokeSlopes(Number steepness, Number cliff)
{
    Number t = clamp((steepness / max(cliff, Number(1e-3)) - Number(0.22)) / Number(0.6), Number(0), Number(1));
    return Number(0.85) * t * (2 - t);
}

// How much light and shade of such a stroke differ, 0 to 1: a breath on a hill, all of it on a cliff.
GEOFX_INLINE Number geofx_strokeDepth(Number steepness, Number cliff)
{
    return clamp(Number(0.25) + Number(0.75) * steepness / max(cliff, Number(1e-3)), Number(0), Number(1));
}

// How much of a city's middle a place is, 0 to 1. Blocks stand where the cover says that there is most town, on even ground, and
// rather at the harbor than far from it. `shore`: metres from it, negative over land. Suburbs climb the slopes.
GEOFX_INLINE Number geofx_townMiddle(Number town, Number steepness, Length shore)
{
    Number dense = clamp((town - Number(0.5)) / Number(0.5), Number(0), Number(1));
    Number even = clamp((Number(0.16) - steepness) / Number(0.12), Number(0), Number(1));
    Number harbor = exp(Number(-1.0 / 1500.0) * clamp(-shore, Length(0), Length(20000)));
    return clamp(town, Number(0), Number(1)) * (Number(0.3) + dense * even * (Number(0.15) + Number(0.55) * harbor));
}

// What a house is drawn as, by how much of the city's middle its place is. Few are towers. In the suburbs gardens have trees.
GEOFX_INLINE int geofx_strokeHouse(Number middle, Number seed)
{
    Number lot = geofx_strokeRandom(seed, Number(7));
    if (lot < Number(0.03) * clamp(Number(1.2) * middle - Number(0.2), Number(0), Number(1))) return GEOFX_STROKE_TOWER;
    if (lot < Number(0.04) + Number(0.3) * clamp(1 - 2 * middle, Number(0), Number(1))) return GEOFX_STROKE_TREE;
    return lot > 1 - clamp(Number(1.25) * middle - Number(0.75), Number(0), Number(0.45)) ? GEOFX_STROKE_BLOCK : GEOFX_STROKE_HOUSE;
}

// The height of a house, block or tower over that of its shape.
GEOFX_INLINE Number geofx_strokeStoreys(int kind, Number middle, Number seed)
{
    if (kind == GEOFX_STROKE_HOUSE) return Number(0.85) + Number(0.3) * middle;
    Number high = geofx_strokeRandom(seed, Number(8));
    return Number(0.5) + Number(0.5) * clamp(middle, Number(0), Number(1)) * (Number(0.3) + Number(0.7) * high);
}

// The variation of one stroke.
struct geofx_StrokeShape
{
    Vector2 size; // half its width and its height, for strokes that are 1 wide on average
    Angle lean;   // clockwise from upright or from the fall line
    Number tone;  // what is added to the light, which runs from -1 to 1
};

GEOFX_INLINE geofx_StrokeShape geofx_strokeShape(int kind, Number seed)
{
    Number size = Number(0.72) + Number(0.56) * geofx_strokeRandom(seed, Number(1));
    Number slim = geofx_strokeRandom(seed, Number(2));
    Number turn = geofx_strokeRandom(seed, Number(3)) - Number(0.5);
    geofx_StrokeShape shape;
    if (kind == GEOFX_STROKE_ROAD || kind == GEOFX_STROKE_RIVER)
    {
        // Half the width. The length comes from the ground.
        shape.size = Vector2(Number(kind == GEOFX_STROKE_ROAD ? 0.26 : 0.22), Number(0));
        shape.lean = Angle(0);
        shape.tone = Number(0);
        return shape;
    }
    shape.tone = Number(0.36) * (geofx_strokeRandom(seed, Number(4)) - Number(0.5));
    if (kind == GEOFX_STROKE_CLIFF)
    {
        shape.size = Vector2(Number(0.24) + Number(0.12) * slim, size * (Number(0.8) + Number(0.6) * slim));
        shape.lean = Number(0.3) * turn;
        shape.tone = Number(1.4) * shape.tone;
    }
    else if (kind == GEOFX_STROKE_HOUSE)
    {
        shape.size = Vector2(size * (Number(0.34) + Number(0.1) * slim), size * Number(0.34));
        shape.lean = Number(0.05) * turn;
    }
    else if (kind == GEOFX_STROKE_BLOCK)
    {
        shape.size = Vector2(Number(0.27) + Number(0.13) * slim, size * Number(0.62));
        shape.lean = Angle(0);
    }
    else if (kind == GEOFX_STROKE_TOWER)
    {
        shape.size = Vector2(Number(0.22) + Number(0.05) * slim, Number(0.9) + Number(0.2) * slim);
        shape.lean = Angle(0);
    }
    else if (kind == GEOFX_STROKE_CONIFER)
    {
        shape.size = Vector2(size * (Number(0.36) - Number(0.06) * slim), size * (Number(0.66) + Number(0.2) * slim));
        shape.lean = Number(0.06) * turn;
        shape.tone -= Number(0.12);
    }
    else
    {
        shape.size = Vector2(size * (Number(0.46) - Number(0.08) * slim), size * (Number(0.54) + Number(0.14) * slim));
        shape.lean = Number(0.22) * turn + Number(0.06);
    }
    return shape;
}

// The bristles of the brush, 0 to 1, across the stroke.
GEOFX_INLINE Number geofx_strokeBristle(Number across, Number seed)
{
    Number phase = Number(40) * seed;
    return Number(0.5) + Number(0.3) * sin(Number(9) * across + phase) + Number(0.2) * sin(Number(23) * across - 3 * phase);
}

// A point of a stroke, x and y -1 to 1 over its size: positive inside and 0 on its edge.
GEOFX_INLINE Number geofx_strokeInside(int kind, Vector2 point, Number seed)
{
    Number x = point.x;
    Number y = point.y;
    if (kind == GEOFX_STROKE_HOUSE)
    {
        Number roof = Number(0.95) - Number(0.6) * max(y, Number(0));
        Number sides = (y > 0 ? roof : Number(0.74)) - abs(x);
        return min(sides, min(Number(0.85) - y, y + Number(0.85)));
    }
    if (kind == GEOFX_STROKE_BLOCK) return min(Number(0.8) - abs(x), Number(0.85) - abs(y));
    if (kind == GEOFX_STROKE_TOWER)
    {
        // A spire above, or a flat roof.
        Number spire = seed > Number(0.6) ? Number(0.8) - Number(1.1) * max(y - Number(0.1), Number(0)) : Number(0.62);
        return min(spire - abs(x), Number(0.85) - abs(y));
    }
    if (kind == GEOFX_STROKE_ROAD || kind == GEOFX_STROKE_RIVER) return 1 - max(abs(x), abs(y));
    Number bristle = geofx_strokeBristle(x, seed);
    if (kind == GEOFX_STROKE_CLIFF)
    {
        // The brush sets down hard at the top, and runs dry downwards.
        Number width = (1 - y * y) * (Number(0.75) + Number(0.25) * y);
        return width - abs(x + Number(0.2) * sin(Number(3) * y + Number(40) * seed)) -
               bristle * Number(0.5) * clamp(-y, Number(0), Number(1));
    }
    if (kind == GEOFX_STROKE_CONIFER)
    {
        // A pointed top, and branches in tiers.
        Number down = Number(0.5) * (Number(0.95) - y);
        Number tier = Number(0.26) * (fract(Number(3) * down + seed) - Number(0.5));
        Number width = down * (Number(0.92) + tier + Number(0.12) * bristle);
        return min(min(width, Number(0.8)) - abs(x), Number(0.45) * (y + Number(0.8)));
    }
    // A drop with a ragged edge. Its foot is broader than its top.
    x = x * (Number(1.04) + Number(0.24) * y);
    Number radius = sqrt(x * x + y * y);
    Number scale = 1 / max(radius, Number(1e-3));
    Number wobble = Number(0.07) * sin(Number(4.7) * x * scale + Number(31) * seed) +
                    Number(0.05) * sin(Number(7.3) * y * scale - Number(53) * seed);
    Number dry = bristle * Number(0.3) * clamp(-y - Number(0.25), Number(0), Number(1));
    return Number(0.9) + wobble - dry - radius;
}

// The share of the light side at a point of a stroke, 0 to 1. `light` is the direction to the light on the screen.
GEOFX_INLINE Number geofx_strokeLit(Vector2 point, Vector2 light, Number seed)
{
    Number bristle = geofx_strokeBristle(point.x - Number(0.3) * point.y, seed) - Number(0.5);
    // The foot is dark, so that strokes stand out from those behind them.
    Number t = clamp(Number(0.5) + Number(0.6) * dot(point, light) + Number(0.35) * point.y + Number(0.35) * bristle,
                     Number(0), Number(1));
    return t * t * (3 - 2 * t);
}
