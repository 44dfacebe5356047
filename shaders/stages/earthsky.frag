#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sky around the Earth: air and haze that thin out by exp(-h / H), black space, and a sea where no ground is drawn.
// Lengths are Earth radii.
uniform vec3 geofx_earthEye;   // the eye, where the Earth is a ball with radius 1
uniform float geofx_earthRise; // the square of its distance from the middle, less 1: exact near the ground
uniform vec3 geofx_earthAir;   // the color of deep air, and of haze
uniform float geofx_earthHaze; // what haze at the sea scatters, to an Earth radius, of all colors alike

in vec3 geofx_sight;

// Of air and of haze: where there is 1/e of what is at the sea.
const float AIR_HEIGHT = 8.0e3 / 6.378e6, HAZE_HEIGHT = 1.2e3 / 6.378e6;
// Of air at the sea, for red, green and blue, to an Earth radius: Rayleigh's scattering, with more of it so that the
// zenith is as bright as it looks to an eye that is used to it.
const vec3 SCATTER = 2.5 * 6.378e6 * vec3(5.8e-6, 13.5e-6, 33.1e-6);
const vec3 SEA = vec3(0.10, 0.19, 0.33);

// exp(x * x) * (1 - erf(x)) for x from 0 on; to 2 % (Abramowitz and Stegun, 7.1.25 and its limit).
float tail(float x)
{
    if (x > 3.0) return 0.5641896 / x * (1.0 - 0.5 / (x * x));
    float t = 1.0 / (1.0 + 0.47047 * x);
    return t * (0.3480242 + t * (-0.0958798 + t * 0.7478556));
}

// What a ray meets, as a way through what is at the sea. `past`: of the ray's lowest point, behind the eye; `low`: that point's height.
float met(float scale, float past, float low, float height, bool hits)
{
    // Along a ray the height above its lowest point grows with the square of the way. So the density is a bell.
    float width = sqrt(2.0 * scale);
    float x = past / width;
    float oneSide = 0.8862269 * width; // what is on one side of a lowest point at the sea
    float there = exp(-height / scale);
    if (past >= 0.0) return oneSide * there * tail(x);
    if (!hits) return oneSide * (2.0 * exp(-low / scale) - there * tail(-x));
    // To the sea: the bell's part between the eye and the ground.
    float ground = sqrt(max(past * past - geofx_earthRise, 0.0));
    return oneSide * max(tail(ground / width) - there * tail(-x), 0.0);
}

void main()
{
    vec3 ray = normalize(geofx_sight);
    float past = dot(geofx_earthEye, ray);
    float low = 0.5 * (geofx_earthRise - past * past); // at first for small heights
    low = sqrt(max(1.0 + geofx_earthRise - past * past, 0.0)) < 0.9 ? -1.0 : low / (0.5 + 0.5 * sqrt(1.0 + 2.0 * low));
    float height = geofx_earthRise / (1.0 + sqrt(1.0 + geofx_earthRise));
    bool hits = past < 0.0 && low < 0.0;
    vec3 veil = 1.0 - exp(-met(AIR_HEIGHT, past, low, height, hits) * SCATTER -
                          met(HAZE_HEIGHT, past, low, height, hits) * geofx_earthHaze);
    vec3 behind = hits ? SEA : vec3(0.0);
    gl_FragColor = vec4(mix(behind, geofx_earthAir, veil), 1.0);
}
