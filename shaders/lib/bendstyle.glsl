// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The styles of a bent view, which are blended from the focus to the context (Lorenz et al. 2008, Section 3.3). Colors are coded as in
// images.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

struct geofx_BendStyle
{
    Number contextSaturation;
    Number contextBrightness;
    Number focusSaturation;
    Number focusBrightness;
    Number map;        // 1 if there is a map
    Number mapInFocus; // 1 if the focus shows it, 0 if the context does
    Number blocks;     // how far buildings of the context become blocks
};

// The color of a fragment. `map`: what it has on the map in its light; of a building, what it would be without its texture. Alpha is 0 if there
// is no such thing. `style`: 0 in the focus to 1 in the context.
GEOFX_INLINE Rgb geofx_bendRestyle(geofx_BendStyle styles, Rgb color, Rgba map, bool building, Number style)
{
    Number share = styles.map * mix(style, 1 - style, styles.mapInFocus);
    Rgb other = Rgb(map.x, map.y, map.z);
    if (building)
    {
        share = max(share, styles.blocks * style);
        // A little darker than paper, or their roofs would be lost on it.
        other *= Rgb(Number(0.9), Number(0.885), Number(0.86));
    }
    Rgb result = mix(color, other, share * map.w);
    Number grey = dot(result, Rgb(Number(0.2126), Number(0.7152), Number(0.0722)));
    Number saturation = mix(styles.focusSaturation, styles.contextSaturation, style);
    Number brightness = mix(styles.focusBrightness, styles.contextBrightness, style);
    return (grey + (result - grey) * saturation) * brightness;
}
