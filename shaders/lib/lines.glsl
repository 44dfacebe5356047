// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Lines of maps: roads, rivers, lifts, borders. Widths go by the distance, as in paintings; dashes and the pressure of the hand lie
// on the ground, so they stand still while the camera moves. `perMetre`: pixels for each metre at a place of the picture.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// The width in pixels of a line that is `ground` metres wide; `least` to `most` pixels. Lines of 0 metres have `most` everywhere.
GEOFX_INLINE Number geofx_lineWidth(Length ground, Number least, Number most, Number perMetre)
{
    return ground > 0 ? clamp(ground * perMetre, min(least, most), most) : most;
}

// 1 in a dash and 0 in a gap. `along`: metres from the line's beginning. `dash` and `gap` are metres; both are doubled as often as a
// dash is shorter than `shortest` pixels. Lines without dash or gap are all dash.
GEOFX_INLINE Number geofx_lineDash(Length along, Length dash, Length gap, Number shortest, Number perMetre)
{
    if (!(dash > 0 && gap > 0)) return Number(1);
    Number level = max(ceil(log2(shortest / max(dash * perMetre, Number(1e-12)))), Number(0));
    Length period = (dash + gap) * exp(level * Number(0.69314718056));
    return fract(along / period) * (dash + gap) < dash ? Number(1) : Number(0);
}

// One wave of a hand's pressure: 1 in the mean.
GEOFX_INLINE Number geofx_lineWave(Length along, Length wave)
{
    Number turn = Number(6.28318530718) * fract(along / (8 * wave));
    return 1 + Number(0.6) * sin(8 * turn) + Number(0.4) * sin(3 * turn + Number(1.7));
}

// The factor of a width that a hand draws: 1 - hand to 1 + hand, 1 in the mean, smooth along the line. `hand`: 0 to 1. A wave is some
// 90 pixels long at any zoom, for waves of one zoom turn into those of the next.
GEOFX_INLINE Number geofx_linePressure(Length along, Number hand, Number perMetre)
{
    Number level = log2(90 / max(perMetre, Number(1e-12)));
    Number whole = floor(level);
    Length wave = exp(whole * Number(0.69314718056));
    Number fine = geofx_lineWave(along, wave);
    Number coarse = geofx_lineWave(along, 2 * wave);
    return 1 + hand * (mix(fine, coarse, level - whole) - 1);
}
