// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The styles of a bent view, which are blended from the focus to the context (Lorenz et al. 2008, Section 3.3). Colors are coded as in
// images.
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/cover.glsl"
#include "lib/painting.glsl"
#endif

// Light as maps have it: what is in the shade is not dark. 0.7 to 1.06.
GEOFX_INLINE Number geofx_bendShade(Rgb light)
{
    return Number(0.7) + Number(0.36) * min(dot(light, Rgb(Number(0.2126), Number(0.7152), Number(0.0722))), Number(1));
}

// The map that is made of what lies on the ground, in pale colors. `wet`: the share of water. `light`: on the ground.
GEOFX_INLINE Rgb geofx_bendMap(geofx_Cover cover, Number wet, Rgb light)
{
    Rgb color = Rgb(Number(0.95), Number(0.94), Number(0.88));
    color = mix(color, Rgb(Number(0.93), Number(0.89), Number(0.78)), geofx_ease(cover.bare, Number(0.1), Number(0.4)));
    color = mix(color, Rgb(Number(0.76), Number(0.85), Number(0.68)), geofx_ease(cover.trees, Number(0.25), Number(0.5)));
    color = mix(color, Rgb(Number(0.94), Number(0.92), Number(0.89)), geofx_ease(cover.town, Number(0.2), Number(0.5)));
    color = mix(color, Rgb(Number(0.62), Number(0.77), Number(0.88)), wet);
    return color * geofx_bendShade(light);
}

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
        // Warmer than paper, and a little darker, or their roofs would be lost on it.
        other = geofx_bendShade(other) * Rgb(Number(0.93), Number(0.87), Number(0.78));
    }
    Rgb result = mix(color, other, share * map.w);
    Number grey = dot(result, Rgb(Number(0.2126), Number(0.7152), Number(0.0722)));
    Number saturation = mix(styles.focusSaturation, styles.contextSaturation, style);
    Number brightness = mix(styles.focusBrightness, styles.contextBrightness, style);
    return (grey + (result - grey) * saturation) * brightness;
}
