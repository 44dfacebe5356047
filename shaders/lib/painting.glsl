// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The painting of panorama maps, after Sections 3.2, 3.4 and 3.5 of Brown and Samavati (2017). Colors are coded as in
// images (sRGB), as a painter's are. Palettes, mixtures and HSV use no other. Heights are above the sea, and slopes
// are rise over run. NaN counts as the lower end of a range, so that a hole in the data does not spread.
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/cover.glsl"
#endif

// The palette's image. Light goes from -1 in the first column to 1 in the last. Rows count from the bottom.
const int GEOFX_PALETTE_COLUMNS = 256;
const int GEOFX_PALETTE_ROWS = 8;
const int GEOFX_PALETTE_FIELD = 0;
const int GEOFX_PALETTE_HILL = 1;
const int GEOFX_PALETTE_CLIFF = 2;
const int GEOFX_PALETTE_SNOW = 3;
const int GEOFX_PALETTE_FOREST = 4; // the floor, between the strokes
const int GEOFX_PALETTE_TREES = 5;  // the strokes
const int GEOFX_PALETTE_TOWN = 6;
const int GEOFX_PALETTE_BARE = 7;

// Below this share of the picture's height, the painting darkens towards its lower edge (paper: 20 to 25 %).
const Number GEOFX_BOTTOM_SHARE = Number(0.24);
// How bright the air makes what is darker, of its own value; and how much of the way there it goes at the most.
const Number GEOFX_AIR_LIGHT = Number(0.85);
const Number GEOFX_AIR_LIFT = Number(0.6);

// Clamped to 0 and 1; 0 for NaN.
GEOFX_INLINE Number geofx_share(Number value)
{
    return value > 0 ? min(value, Number(1)) : Number(0);
}

// 0 at `low` and below, 1 at `high` and above, smooth between. A step if high <= low.
GEOFX_INLINE Number geofx_ease(Number value, Number low, Number high)
{
    Number t = geofx_share((value - low) / max(high - low, Number(1e-6)));
    return t * t * (3 - 2 * t);
}

// Hue (0 to 1, from red over green and blue), saturation and value, each 0 to 1. Greys have hue 0, and black has
// saturation 0.
GEOFX_INLINE Vector3 geofx_toHsv(Rgb color)
{
    Number value = max(color.x, max(color.y, color.z));
    Number chroma = value - min(color.x, min(color.y, color.z));
    if (!(chroma > Number(1e-6)))
    {
        return Vector3(0, 0, value);
    }
    Number sixths = value == color.x   ? (color.y - color.z) / chroma
                    : value == color.y ? 2 + (color.z - color.x) / chroma
                                        : 4 + (color.x - color.y) / chroma;
    return Vector3(sixths < 0 ? sixths / 6 + 1 : sixths / 6, chroma / value, value);
}

// Takes any hue. Whole turns do not count.
GEOFX_INLINE Rgb geofx_fromHsv(Vector3 hsv)
{
    Number sixths = 6 * (hsv.x - floor(hsv.x));
    Number red = clamp(abs(sixths - 3) - 1, Number(0), Number(1));
    Number green = clamp(2 - abs(sixths - 2), Number(0), Number(1));
    Number blue = clamp(2 - abs(sixths - 4), Number(0), Number(1));
    return hsv.z * (Rgb(1, 1, 1) + hsv.y * (Rgb(red, green, blue) - Rgb(1, 1, 1)));
}

// --- What is painted where (Section 3.2.1) ---

struct geofx_PaintStyle
{
    Length snowLine;   // where half of the even ground is white in midsummer
    Length winterDrop; // how much lower that is in midwinter
    Length snowWidth;  // over which snow comes in
    Number cliffSlope; // steeper than this is rock
    Number hillSlope;  // less steep than this is field
    Number season;     // 0 midwinter, 1/4 spring, 1/2 midsummer, 3/4 autumn, 1 midwinter
};

// Shares of the palette's rows, none negative, 1 in all.
struct geofx_Classes
{
    Number field;
    Number hill;
    Number cliff;
    Number snow;
    Number forest;
    Number town;
    Number bare;
};

// The height above which snow lies all year: 5000 m in the tropics, 2900 m in the Alps, the sea at the poles.
GEOFX_INLINE Length geofx_snowLine(Angle latitude)
{
    Number c = max(cos(latitude), Number(0));
    return 5000 * c * sqrt(c);
}

// How much lower snow reaches in midwinter than in midsummer: not at all at the equator, 2000 m in the Alps.
GEOFX_INLINE Length geofx_winterDrop(Angle latitude)
{
    Number s = sin(latitude);
    return 4000 * s * s;
}

// The snow line of a season. It goes from midsummer's to midwinter's and back as the sun's height does.
GEOFX_INLINE Length geofx_snowLineNow(geofx_PaintStyle style)
{
    return style.snowLine - style.winterDrop * Number(0.5) * (1 + cos(Number(6.283185307179586) * style.season));
}

// What is painted on ground of a `cover`, `height` and `steepness`. `noise`, -1 to 1, frays the borders. The result
// is smooth in all of them. Each class covers those after it: snow, rock, towns, forest, bare ground, and at last
// hills or fields.
GEOFX_INLINE geofx_Classes geofx_classify(geofx_Cover cover, Length height, Number steepness, Number noise,
                                          geofx_PaintStyle style)
{
    Number trees = geofx_share(cover.trees);
    Number slope = steepness * (1 + Number(0.25) * noise);

    // Snow slides off cliffs and lies between trees. Ice stays in all seasons.
    Length line = geofx_snowLineNow(style) + Number(0.5) * noise * style.snowWidth;
    Number white = geofx_ease(height, line - Number(0.5) * style.snowWidth, line + Number(0.5) * style.snowWidth);
    Number slides = geofx_ease(slope, style.cliffSlope, Number(1.9) * style.cliffSlope);
    Number ice = geofx_ease(cover.bare, Number(0.62), Number(0.9));
    Number snow = max(white * (1 - slides) * (1 - Number(0.45) * trees), ice);

    // With woods, slopes stay green that would be rock without them.
    Number hold = style.cliffSlope * (1 + Number(0.7) * trees);
    Number cliff = geofx_ease(slope, Number(0.75) * hold, Number(1.3) * hold);
    Number town = geofx_ease(cover.town + Number(0.2) * noise, Number(0.25), Number(0.75));
    Number forest = geofx_ease(trees + Number(0.2) * noise, Number(0.25), Number(0.75));
    Number bare = geofx_ease(cover.bare + Number(0.08) * noise, Number(0.1), Number(0.42));
    Number hill = geofx_ease(slope, Number(0.4) * style.hillSlope, Number(1.6) * style.hillSlope);

    geofx_Classes classes;
    classes.snow = snow;
    Number left = 1 - snow;
    classes.cliff = left * cliff;
    left = left * (1 - cliff);
    classes.town = left * town;
    left = left * (1 - town);
    classes.forest = left * forest;
    left = left * (1 - forest);
    classes.bare = left * bare;
    left = left * (1 - bare);
    classes.hill = left * hill;
    classes.field = left * (1 - hill);
    return classes;
}

// The share, 0 to 1, of the way that a hand may go astray at an edge. `reach`: the whole way, metres. It keeps away from
// the shore, or else the sea's bed would come on land, and trees would stand in the water. On steep ground a way on
// the map is a long way up.
GEOFX_INLINE Number geofx_handShare(Length shore, Number steepness, Length reach)
{
    return geofx_share(-shore / max(reach, Number(1e-3))) * (1 - geofx_ease(steepness, Number(0.5), Number(1.3)));
}

// The way that a hand strays, from the brush's picture (each part -1 to 1): broad in its tones and ripples, fine in its slopes. No
// part is longer than 2, and on average it is none, so what edges enclose keeps its area.
GEOFX_INLINE Vector2 geofx_handWay(Rgba brush)
{
    return Vector2(brush.z + Number(0.5) * brush.x, Number(1.3) * brush.w + Number(0.5) * brush.y);
}

// --- Light (Section 3.2.2) ---

// The light that a palette is asked for, -1 to 1. `lambert` is the cosine of the angle between normal and light,
// negative in the shade. `y` is the place's height in the picture, 0 at its lower edge to 1. At the lower edge the
// light is less by `bottomShade`.
GEOFX_INLINE Number geofx_paintLight(Number lambert, Number y, Number bottomShade)
{
    Number low = geofx_share(1 - y / GEOFX_BOTTOM_SHARE);
    return 2 * geofx_share(Number(0.5) * (lambert - bottomShade * low + 1)) - 1;
}

// The texture coordinates of a light in a row of the palette: from the middle of the first texel to that of the last.
GEOFX_INLINE Vector2 geofx_palettePlace(Number light, int row)
{
    Number column = geofx_share(Number(0.5) * (light + 1));
    return Vector2((column * Number(GEOFX_PALETTE_COLUMNS - 1) + Number(0.5)) / Number(GEOFX_PALETTE_COLUMNS),
                   (Number(row) + Number(0.5)) / Number(GEOFX_PALETTE_ROWS));
}

// --- Water (Section 3.4) ---

// The relative depth: 0 at the shore and on land, 1 from `deepShore` metres on. It follows a sigmoid, so most water
// is either pale or deep.
GEOFX_INLINE Number geofx_waterDepth(Length shore, Length deepShore)
{
    Number t = geofx_share(shore / max(deepShore, Number(1e-3)));
    // The logistic function between t = 0 and 1, stretched to be 0 and 1 there.
    Number low = 1 / (1 + exp(Number(2)));
    Number high = 1 / (1 + exp(Number(-7)));
    return (1 / (1 + exp(2 - 9 * t)) - low) / (high - low);
}

// The color of water of relative depth t, 0 to 1: from white over ever more saturated and darker colors to `deep`.
GEOFX_INLINE Rgb geofx_waterColor(Rgb deep, Number t)
{
    Vector3 hsv = geofx_toHsv(deep);
    return geofx_fromHsv(Vector3(hsv.x, hsv.y * t, mix(Number(1), hsv.z, t)));
}

// A reflection on water. It has its own hue, the lower saturation, and the mean value. Then `strength` (0 to 1) of it
// is mixed into the water's own color. This second step mixes RGB, so that no hues between the two appear.
GEOFX_INLINE Rgb geofx_waterMix(Rgb own, Rgb reflection, Number strength)
{
    Vector3 hsv = geofx_toHsv(own);
    Vector3 seen = geofx_toHsv(reflection);
    Rgb both =
        geofx_fromHsv(Vector3(seen.x, min(hsv.y, seen.y), Number(0.5) * (hsv.z + seen.z)));
    return mix(own, both, strength);
}

// --- Air (Section 3.5) ---

// The air's color.
GEOFX_INLINE Rgb geofx_airColor()
{
    return Rgb(Number(0.47), Number(0.62), Number(0.86));
}

// The share of the air's color. `s` goes from 0 at the painting's base to 1 at the horizon, where the share is
// `strength` (0 to 1). Half-way it is a quarter of that.
GEOFX_INLINE Number geofx_airAmount(Number s, Number strength)
{
    Number t = geofx_share(s);
    return strength * t * t;
}

// Far ground takes the air's hue. It keeps its own value (V of HSV), and with it everything that light and shade
// draw, but for the dark: air before a shade is brighter than the shade, so far ridges turn blue and not black.
GEOFX_INLINE Rgb geofx_atmosphere(Rgb color, Rgb air, Number amount)
{
    Rgb mixed = mix(color, air, amount);
    Number value = max(color.x, max(color.y, color.z));
    Number brightest = GEOFX_AIR_LIGHT * max(air.x, max(air.y, air.z));
    value += GEOFX_AIR_LIFT * amount * max(brightest - value, Number(0));
    Number now = max(mixed.x, max(mixed.y, mixed.z));
    return now > Number(1e-6) ? mixed * (value / now) : color;
}
