#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Behind a panorama map's terrain: above the horizon the sky as it is painted, below it, where there is no terrain, the sea.
// In the water the sky hangs from the horizon.
#pragma import_defines(GEOFX_MIRROR)
#include "stages/panorama.water.glsl"

uniform sampler2D geofx_sky;
uniform sampler2D geofx_skyMirror;
uniform sampler2D geofx_skyBrush;
uniform vec4 geofx_skyPlace; // the horizon's height in the picture, its arch; the heading, the part across, in turns
uniform vec4 geofx_skyCurve; // the picture's y for a metre at the base, D1, D2, the end of what shows
uniform vec4 geofx_skyAxisX; // from x and s to the brush's picture: of a picture's x, of a metre, the base's
uniform vec4 geofx_skyAxisY;
uniform vec4 geofx_skyWater; // as in panorama.ground.frag.glsl
uniform vec4 geofx_skyClock; // seconds, the air's strength, whether there is a reflection

in vec2 place; // -1 to 1

vec3 sky(float above)
{
    float room = 1.0 - geofx_skyPlace.x + geofx_skyPlace.y;
    float across = geofx_skyPlace.z + 0.5 * geofx_skyPlace.w * place.x;
    float height = above / max(room, 0.02);
    vec3 colour = texture(geofx_sky, vec2(across, clamp(height, 0.002, 0.998))).rgb;
    // Higher than it is painted, the sky is even: the mean of its upper edge.
    if (height > 0.75)
    {
        vec3 even = textureLod(geofx_sky, vec2(0.5, 0.95), 6.0).rgb;
        colour = mix(colour, even, clamp(4.0 * height - 3.0, 0.0, 1.0));
    }
    return colour;
}

// How far away the ground is that a height of the picture above its base shows: the curve's inverse.
float distanceAt(float rise)
{
    float width = max(geofx_skyCurve.z - geofx_skyCurve.y, 1e-3);
    float bent = clamp((rise - geofx_skyCurve.y) / width, 0.0, 0.5);
    return min(rise, geofx_skyCurve.y) + width * (1.0 - sqrt(1.0 - 2.0 * bent));
}

vec3 sea(float horizonDrop)
{
    float s = distanceAt((place.y + 1.0 + 2.0 * horizonDrop) / geofx_skyCurve.x);
    float far = clamp(s / geofx_skyCurve.z, 0.0, 1.0);
    vec2 brush = vec2(geofx_skyAxisX.x * place.x + geofx_skyAxisX.y * s + geofx_skyAxisX.z,
                      geofx_skyAxisY.x * place.x + geofx_skyAxisY.y * s + geofx_skyAxisY.z);
    vec3 colour = geofx_waterBody(2.0 * geofx_skyWater.x, geofx_skyWater.x);
    if (geofx_skyClock.z > 0.5)
    {
        geofx_WaterPlace here = geofx_WaterPlace(2.0 * geofx_skyWater.x, 0.5 * place + 0.5, brush, 0.0,
                                                 s / geofx_skyCurve.w, far);
        colour = geofx_water(here, geofx_skyWater, geofx_skyClock.x, geofx_skyBrush, geofx_skyMirror);
    }
    return geofx_atmosphere(colour, geofx_airColour(), geofx_airAmount(far, geofx_skyClock.y));
}

void main()
{
    float drop = geofx_skyPlace.y * (1.0 - cos(1.5707963 * place.x));
    float above = 0.5 * place.y + 0.5 - geofx_skyPlace.x + drop;
#ifdef GEOFX_MIRROR
    gl_FragColor = vec4(sky(-above), 1.0);
#else
    float edge = 0.5 * fwidth(above);
    vec3 colour = vec3(0.0);
    if (above > -edge) colour = sky(max(above, 0.0));
    if (above < edge) colour = mix(sea(drop), colour, clamp(0.5 + 0.5 * above / edge, 0.0, 1.0));
    gl_FragColor = vec4(colour, 1.0);
#endif
}
