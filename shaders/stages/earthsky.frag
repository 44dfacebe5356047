#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sky around the Earth: air that thins out by exp(-h / H), black space, and a sea where no ground is drawn.
// Lengths are Earth radii.
uniform vec3 geofx_earthEye;   // the eye, where the Earth is a ball with radius 1
uniform float geofx_earthRise; // the square of its distance from the middle, less 1: exact near the ground
uniform vec3 geofx_earthAir;   // the color of deep air

in vec3 geofx_sight;

const float SCALE_HEIGHT = 8.0e3 / 6.378e6;
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

void main()
{
    vec3 ray = normalize(geofx_sight);
    float past = dot(geofx_earthEye, ray);                                 // of the ray's lowest point, behind the eye
    float low = 0.5 * (geofx_earthRise - past * past);                     // its height, at first for small heights
    low = sqrt(max(1.0 + geofx_earthRise - past * past, 0.0)) < 0.9 ? -1.0 : low / (0.5 + 0.5 * sqrt(1.0 + 2.0 * low));
    float height = geofx_earthRise / (1.0 + sqrt(1.0 + geofx_earthRise));
    // Along a ray the height above its lowest point grows with the square of the way. So the air's density is a bell.
    float width = sqrt(2.0 * SCALE_HEIGHT);
    float x = past / width;
    float oneSide = 0.8862269 * width; // the air on one side of a lowest point at the sea
    float air;
    bool hits = past < 0.0 && low < 0.0;
    if (past >= 0.0)
        air = oneSide * exp(-height / SCALE_HEIGHT) * tail(x);
    else if (!hits)
        air = oneSide * (2.0 * exp(-low / SCALE_HEIGHT) - exp(-height / SCALE_HEIGHT) * tail(-x));
    else
    {
        // To the sea: the bell's part between the eye and the ground.
        float ground = sqrt(max(past * past - geofx_earthRise, 0.0));
        air = oneSide * max(tail(ground / width) - exp(-height / SCALE_HEIGHT) * tail(-x), 0.0);
    }
    vec3 veil = 1.0 - exp(-air * SCATTER);
    vec3 behind = hits ? SEA : vec3(0.0);
    gl_FragColor = vec4(mix(behind, geofx_earthAir, veil), 1.0);
}
