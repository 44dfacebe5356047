// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The water of panorama maps, after Section 3.4 of Brown and Samavati (2017): on the ground, and where there is no
// ground.
#pragma import_defines(GEOFX_HDR)
#include "lib/painting.glsl"

const vec3 geofx_deepWater = vec3(0.07, 0.32, 0.60);
const vec3 geofx_shallowWater = vec3(0.05, 0.58, 0.68);

// A place of the water.
struct geofx_WaterPlace
{
    float shore;  // metres to the shore
    vec2 picture; // 0 to 1
    vec2 brush;   // in the brush's picture
    float lift;   // how much higher its reflection lies in the picture than that of water at height 0
    float s;      // from the base, over the end of what shows
    float far;    // 0 at the base, 1 at the horizon
};

// The water's own color, by its depth.
vec3 geofx_waterBody(float shore, float deepShore)
{
    // Not quite white at the shore: rivers and ponds are pale blue.
    float t = mix(0.16, 1.0, geofx_waterDepth(shore, deepShore));
    return geofx_waterColor(mix(geofx_shallowWater, geofx_deepWater, t), t);
}

// The same with what it reflects. `water`: the distance at which it is deep, the strength of the reflection, that of
// the ripples. The mirror's alpha is s of what it shows, 1 for the sky.
vec3 geofx_water(geofx_WaterPlace place, vec4 water, float seconds, sampler2D brush, sampler2D mirror)
{
    // Ripples are the brush's slopes, which slopes of the same brush move, so that nothing repeats. They are calmer
    // towards the horizon.
    vec2 first = texture(brush, 1.3 * place.brush + seconds * vec2(0.006, 0.011)).rg - 0.5;
    vec2 ripple = texture(brush, 0.9 * place.brush + 0.08 * first - seconds * vec2(0.009, 0.004)).rg - 0.5;
    float calm = water.z * mix(1.0, 0.3, place.far);
    vec2 at = place.picture + calm * vec2(0.006, 0.016) * ripple - vec2(0.0, place.lift);
    vec3 seen = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 5; ++i)
    {
        // A soft brush, drawn downwards. It leaves out what stands before the water.
        float step = float(i) - 2.0;
        vec2 offset = vec2(0.003 * (step * step - 2.0), 0.009 * step) * (1.0 - 0.4 * place.far);
        vec4 texel = texture(mirror, clamp(at + offset, vec2(0.002), vec2(0.998)));
        float weight = (3.0 - abs(step)) * (texel.a + 0.01 >= place.s ? 1.0 : 0.02);
        seen += weight * texel.rgb;
        weights += weight;
    }
    // The flatter the view, the more of the sky shows.
    float grazing = place.far * place.far;
    float strength = clamp(water.y * (1.0 + 0.7 * calm * ripple.y + 0.8 * grazing * grazing), 0.0, 1.0);
    // White clouds have hardly any hue. In water they are blue.
    vec3 cool = seen / weights * vec3(0.80, 0.95, 1.15);
#ifndef GEOFX_HDR
    cool = min(cool, vec3(1.0));
#endif
    // The brush shows, and the picture's base is darker, as on land.
    float tone = (1.0 + 0.28 * calm * ripple.x) * (1.0 - 0.28 * geofx_share(1.0 - place.picture.y / GEOFX_BOTTOM_SHARE));
    return tone * geofx_waterMix(geofx_waterBody(place.shore, water.x), cool, strength);
}
