#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sky of a panorama map: above the horizon as painted, below it, where there is no terrain, the sea. In the water
// it hangs from the horizon, pressed together.
uniform sampler2D geofx_sky;
uniform vec4 geofx_skyPlace; // the horizon's height in the picture, its arch, 1 in the water
uniform vec4 geofx_skyTurn;  // the heading and the part of a turn across the picture, in turns

in vec2 place;

const vec3 sea = vec3(0.20, 0.42, 0.66);

void main()
{
    float horizon = geofx_skyPlace.x - geofx_skyPlace.y * (1.0 - cos(1.5707963 * place.x));
    float above = 0.5 * place.y + 0.5 - horizon;
    float room = max(1.0 - geofx_skyPlace.x, 0.02);
    float across = geofx_skyTurn.x + 0.5 * geofx_skyTurn.y * place.x;
    if (geofx_skyPlace.z > 0.5) above = -above * room / max(geofx_skyPlace.x, 0.02);
    vec4 colour = texture(geofx_sky, vec2(across, clamp(above / room, 0.002, 0.998)));
    if (geofx_skyPlace.z < 0.5 && above < 0.0) colour.rgb = mix(sea, colour.rgb, exp(12.0 * above));
    gl_FragColor = vec4(colour.rgb, 1.0);
}
