// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Detail of the ground below the resolution of its colors: what GroundDetail makes of waves of noise, octave by octave, and how it
// keeps borders of classes sharp. Colors are coded as in images (sRGB). On land no color changes in the mean, so detail may
// come and go with the distance; water is lighter at shores. NaN counts as the lower end of a range.
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/cover.glsl"
#include "lib/painting.glsl"
#endif

// Each octave's waves are shorter than those before by this factor. It is no whole number, so octaves do not repeat together.
const Number GEOFX_DETAIL_STEP = Number(2.3);
const int GEOFX_DETAIL_MOST = 12;
// Waves across one period of the noise, and the mean of their absolute heights. Heights have a mean of 0, and 1 is the largest.
const Number GEOFX_DETAIL_WAVES = Number(8);
const Number GEOFX_DETAIL_MEAN = Number(0.265);

// The share of an octave that a pixel can show: 1 where a wave takes 6 pixels, 0 at 2.5 and less, before it would shimmer. `footprint`: the
// longer side of the ground in a pixel.
GEOFX_INLINE Number geofx_detailFade(Length wavelength, Length footprint)
{
    return geofx_ease(wavelength / max(footprint, Number(1e-9)), Number(2.5), Number(6));
}

// The share of all detail where a texel of the ground's colors takes so many pixels, across the view: 0 up to 2, where coarser tiles give way to
// finer ones, so that no border of tiles shows; all from 5 on.
GEOFX_INLINE Number geofx_detailNearness(Number pixels)
{
    return geofx_ease(pixels, Number(2), Number(5));
}

// The share of waves that the colors do not have already: those up to 8 texels long, none of 16.
GEOFX_INLINE Number geofx_detailMissing(Length wavelength, Length texel)
{
    return 1 - geofx_ease(wavelength / max(texel, Number(1e-9)), Number(8), Number(16));
}

// How much an octave belongs to the broad, the middle and the fine waves: some 100, 15 and 2 metres. 1 in all.
GEOFX_INLINE Vector3 geofx_detailBands(Length wavelength)
{
    Number octave = log2(max(wavelength, Number(1e-6)));
    Number broad = geofx_ease(octave, Number(4.6), Number(6.4));
    Number fine = 1 - geofx_ease(octave, Number(1.4), Number(3.4));
    return Vector3(broad, 1 - broad - fine, fine);
}

// All octaves at a place, by bands.
struct geofx_DetailWaves
{
    Vector3 soft;       // heights of plain waves
    Vector3 round;      // of round ones with sharp valleys between, as crowns have; negative of sharp ridges
    Vector3 softLight;  // how they look at the light
    Vector3 roundLight;
    Vector3 shown;      // how much of an octave there is
};

GEOFX_INLINE geofx_DetailWaves geofx_detailCalm()
{
    geofx_DetailWaves waves;
    waves.soft = waves.round = waves.softLight = waves.roundLight = waves.shown = Vector3(0, 0, 0);
    return waves;
}

// One more octave: its bands times its share, its height, and its slope towards the light, both -1 to 1.
GEOFX_INLINE geofx_DetailWaves geofx_detailWith(geofx_DetailWaves waves, Vector3 bands, Number height, Number slope)
{
    Number side = height < 0 ? Number(-1) : Number(1);
    // Crowns are round, so the valley between two is no edge for the light.
    side *= geofx_share(abs(height) * 12);
    waves.soft += bands * height;
    waves.round += bands * (2 * (abs(height) - GEOFX_DETAIL_MEAN));
    waves.softLight += bands * slope;
    waves.roundLight += bands * (2 * side * slope);
    waves.shown += bands;
    return waves;
}

// What the ground is: shares, 1 in all.
struct geofx_DetailClasses
{
    Number grass;
    Number forest;
    Number rock;
    Number sand;
    Number snow;
    Number town;  // between its houses
    Number paved; // streets, runways and whatever else is smooth
};

// `color`: of the ground itself, without light. It tells green from grey where the cover has no class of its own.
GEOFX_INLINE geofx_DetailClasses geofx_detailClasses(geofx_Cover cover, Rgb color, Number steepness)
{
    Number low = min(color.x, min(color.y, color.z));
    Number green = geofx_ease(color.y - color.z - Number(1.2) * max(color.x - color.y, Number(0)), Number(0.04), Number(0.12));
    Number left = Number(1);
    geofx_DetailClasses classes;
    classes.snow = max(geofx_ease(cover.bare, Number(0.62), Number(0.9)), geofx_ease(low, Number(0.86), Number(0.93)));
    left -= classes.snow;
    Number bare = geofx_ease(cover.bare, Number(0.1), Number(0.4));
    // Woods hold on to slopes that would be rock without them.
    Number rock = max(geofx_ease(steepness, Number(0.7) + Number(0.7) * cover.trees, Number(1.2) + Number(0.9) * cover.trees),
                      bare * geofx_ease(steepness, Number(0.15), Number(0.5)));
    classes.rock = left * rock;
    left -= classes.rock;
    classes.sand = left * bare;
    left -= classes.sand;
    Number town = geofx_ease(cover.town, Number(0.3), Number(0.55));
    classes.town = left * town;
    left -= classes.town;
    Number forest = geofx_ease(cover.trees, Number(0.3), Number(0.5)) * (1 - geofx_ease(cover.town, Number(0.1), Number(0.3)));
    classes.forest = left * forest;
    left -= classes.forest;
    classes.grass = left * green;
    classes.paved = left - classes.grass;
    return classes;
}

// How a class looks: how much waves of each band change its color, and its light; the share of soft waves and of round ones, negative
// for ridges; and the color that high ground has more of than low one.
struct geofx_DetailLook
{
    Vector3 tone;
    Vector3 light;
    Number soft;
    Number round;
    Rgb tint;
};

GEOFX_INLINE geofx_DetailLook geofx_detailMixed(geofx_DetailLook sum, Number share, geofx_DetailLook more)
{
    sum.tone += share * more.tone;
    sum.light += share * more.light;
    sum.soft += share * more.soft;
    sum.round += share * more.round;
    sum.tint += share * more.tint;
    return sum;
}

GEOFX_INLINE geofx_DetailLook geofx_detailLook(Vector3 tone, Vector3 light, Number soft, Number round, Rgb tint)
{
    geofx_DetailLook look;
    look.tone = tone;
    look.light = light;
    look.soft = soft;
    look.round = round;
    look.tint = tint;
    return look;
}

GEOFX_INLINE geofx_DetailLook geofx_detailLookOf(geofx_DetailClasses classes)
{
    geofx_DetailLook look = geofx_detailLook(Vector3(0, 0, 0), Vector3(0, 0, 0), Number(0), Number(0), Rgb(0, 0, 0));
    look = geofx_detailMixed(look, classes.grass,
                             geofx_detailLook(Vector3(Number(0.07), Number(0.09), Number(0.16)),
                                              Vector3(Number(0.04), Number(0.08), Number(0.18)), Number(1), Number(-0.15),
                                              Rgb(Number(0.1), Number(0.03), Number(-0.05))));
    look = geofx_detailMixed(look, classes.forest,
                             geofx_detailLook(Vector3(Number(0.08), Number(0.14), Number(0.14)),
                                              Vector3(Number(0.08), Number(0.26), Number(0.2)), Number(0.35), Number(0.75),
                                              Rgb(Number(0.08), Number(0.03), Number(-0.03))));
    look = geofx_detailMixed(look, classes.rock,
                             geofx_detailLook(Vector3(Number(0.1), Number(0.14), Number(0.18)),
                                              Vector3(Number(0.12), Number(0.28), Number(0.35)), Number(0.4), Number(-0.7),
                                              Rgb(Number(0.06), Number(0.02), Number(-0.03))));
    look = geofx_detailMixed(look, classes.sand,
                             geofx_detailLook(Vector3(Number(0.05), Number(0.05), Number(0.08)),
                                              Vector3(Number(0.05), Number(0.08), Number(0.15)), Number(1), Number(0),
                                              Rgb(Number(0.04), Number(0.015), Number(-0.03))));
    look = geofx_detailMixed(look, classes.snow,
                             geofx_detailLook(Vector3(Number(0.02), Number(0.02), Number(0.03)),
                                              Vector3(Number(0.08), Number(0.1), Number(0.12)), Number(1), Number(-0.2),
                                              Rgb(Number(-0.02), Number(0), Number(0.02))));
    look = geofx_detailMixed(look, classes.town,
                             geofx_detailLook(Vector3(Number(0.03), Number(0.05), Number(0.12)),
                                              Vector3(Number(0), Number(0.03), Number(0.12)), Number(1), Number(0),
                                              Rgb(Number(0.04), Number(0.015), Number(-0.03))));
    return geofx_detailMixed(look, classes.paved,
                             geofx_detailLook(Vector3(Number(0.04), Number(0.05), Number(0.1)),
                                              Vector3(Number(0), Number(0.02), Number(0.06)), Number(0.9), Number(-0.2),
                                              Rgb(Number(0.02), Number(0), Number(-0.015))));
}

// The share of gardens between houses at a place. `green`: their share of the whole, -0.5 to 1.5. Where waves are too small to be seen, it
// is that share.
GEOFX_INLINE Number geofx_detailGardens(Number green, geofx_DetailWaves waves)
{
    Number height = waves.soft.y + Number(0.5) * waves.soft.z;
    // The height that this share is above: heights are distributed as errors are, with a deviation of about a half.
    Number share = clamp(green, Number(0.001), Number(0.999));
    Number edge = Number(0.21) * log2((1 - share) / share);
    Number patches = geofx_ease(height, edge - Number(0.2), edge + Number(0.2));
    return mix(geofx_share(green), patches, geofx_share(Number(0.8) * waves.shown.y));
}

// The factor of a ground's color. `relief`: how much light and shade waves make.
GEOFX_INLINE Rgb geofx_detailFactor(geofx_DetailClasses classes, geofx_Cover cover, geofx_DetailWaves waves, Number relief)
{
    geofx_DetailLook look = geofx_detailLookOf(classes);
    Vector3 height = look.soft * waves.soft + look.round * waves.round;
    Vector3 slope = look.soft * waves.softLight + look.round * waves.roundLight;
    Number tone = dot(look.tone, height);
    Number light = relief * dot(look.light, slope);
    Number hue = waves.soft.x + Number(0.5) * waves.soft.y;
    // Suburbs have more green than the middle of a town.
    Number green = Number(0.45) - Number(0.8) * (cover.town - Number(0.5));
    Number garden = classes.town * (geofx_detailGardens(green, waves) - geofx_share(green));
    Rgb factor = Rgb(1, 1, 1) + hue * look.tint + garden * Rgb(Number(-0.34), Number(-0.12), Number(-0.36));
    return max(factor * (1 + tone) * max(1 + light, Number(0.25)), Rgb(0, 0, 0));
}

// --- Water ---

// The color of water: lighter and greener above shallows, with white where waves break. `color`: of deep water, in its light. `light`: how
// bright the light is, 0 to 1. `sea`: 1 for the sea, 0 for lakes and streams. `relief`: as for the ground.
GEOFX_INLINE Rgb geofx_detailWater(Rgb color, Length shore, Number sea, geofx_DetailWaves waves, Number relief, Number light)
{
    Number shallow = sea * exp(-max(shore, Length(0)) / Length(55)) * (1 + Number(0.5) * waves.soft.x);
    Rgb lagoon = light * Rgb(Number(0.3), Number(0.62), Number(0.62));
    Rgb result = mix(color, lagoon, geofx_share(Number(0.62) * shallow));
    // Wind makes patches.
    result *= 1 + Number(0.12) * waves.soft.x + Number(0.08) * waves.soft.y;
    Number crests = dot(Vector3(Number(0.12), Number(0.3), Number(0.3)), waves.softLight);
    result += relief * light * crests * Rgb(Number(0.13), Number(0.15), Number(0.16));
    // Foam reaches as far as the last wave has run.
    Length reach = Length(7) + Length(9) * waves.soft.y + Length(6) * waves.soft.z;
    Number foam = sea * geofx_share(waves.shown.y) * geofx_share(1 - max(shore, Length(0)) / max(reach, Length(0.5)));
    result = mix(result, light * Rgb(Number(0.93), Number(0.95), Number(0.94)), Number(0.75) * foam);
    return max(result, Rgb(0, 0, 0));
}

// --- Sharp borders of classes ---

// How alike two colors are: 1 for one class, 0 for two.
GEOFX_INLINE Number geofx_crispAlike(Rgb a, Rgb b)
{
    Rgb way = a - b;
    return 1 - geofx_ease(dot(way, way), Number(0.0004), Number(0.0036));
}

// One side of the border that runs through the middle between texels: 0 or 1, smooth over a pixel. `support`: of the side's texels, their
// bilinear weights. `pixels`: those of a texel.
GEOFX_INLINE Number geofx_crispSide(Number support, Number pixels)
{
    return geofx_share((support - Number(0.5)) * pixels + Number(0.5));
}

// The weights of the four texels around a place in place of the bilinear ones (x, y, z, w: lower left, lower right, upper left, upper
// right), 1 in all. Texels of one color belong together. The one side that has more weight takes all. So the border of two classes is a smooth line
// and not a blur, and no staircase. Where all four differ, as in photos, the weights stay.
GEOFX_INLINE Rgba geofx_crispWeights(Rgba weights, Rgb a, Rgb b, Rgb c, Rgb d, Number pixels)
{
    Number ab = geofx_crispAlike(a, b);
    Number ac = geofx_crispAlike(a, c);
    Number ad = geofx_crispAlike(a, d);
    Number bc = geofx_crispAlike(b, c);
    Number bd = geofx_crispAlike(b, d);
    Number cd = geofx_crispAlike(c, d);
    Rgba support = Rgba(weights.x + ab * weights.y + ac * weights.z + ad * weights.w,
                        weights.y + ab * weights.x + bc * weights.z + bd * weights.w,
                        weights.z + ac * weights.x + bc * weights.y + cd * weights.w,
                        weights.w + ad * weights.x + bd * weights.y + cd * weights.z);
    Rgba sharp = Rgba(weights.x * geofx_crispSide(support.x, pixels) / max(support.x, Number(1e-6)),
                      weights.y * geofx_crispSide(support.y, pixels) / max(support.y, Number(1e-6)),
                      weights.z * geofx_crispSide(support.z, pixels) / max(support.z, Number(1e-6)),
                      weights.w * geofx_crispSide(support.w, pixels) / max(support.w, Number(1e-6)));
    Number total = sharp.x + sharp.y + sharp.z + sharp.w;
    sharp += max(1 - total, Number(0)) * weights;
    sharp = sharp / (sharp.x + sharp.y + sharp.z + sharp.w);
    // Two pairs, or three and one: two classes.
    Number pairs = geofx_share((ab + ac + ad + bc + bd + cd) * Number(0.5));
    return mix(weights, sharp, pairs);
}
