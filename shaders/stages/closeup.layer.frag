#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
uniform sampler2DArray geofx_layerColours;
uniform sampler2DArray geofx_layerDepths;
uniform ivec4 geofx_layerOrigin; // the layer's first pixel, the layer, and samples along a pixel's side
uniform float geofx_layerOpacity;
uniform vec2 geofx_layerAlphas; // pixels above the first and up to the second

void main()
{
    int samples = geofx_layerOrigin.w;
    ivec2 first = (ivec2(floor(gl_FragCoord.xy)) - geofx_layerOrigin.xy) * samples;
    vec4 sum = vec4(0.0);
    float depth = 1.0;
    for (int y = 0; y < samples; ++y)
    {
        for (int x = 0; x < samples; ++x)
        {
            ivec3 texel = ivec3(first + ivec2(x, y), geofx_layerOrigin.z);
            vec4 colour = texelFetch(geofx_layerColours, texel, 0);
            sum += vec4(colour.rgb * colour.a, colour.a);
            if (colour.a > 0.0) depth = min(depth, texelFetch(geofx_layerDepths, texel, 0).r);
        }
    }
    sum /= float(samples * samples);
    if (sum.a <= geofx_layerAlphas.x || sum.a > geofx_layerAlphas.y) discard;
    gl_FragColor = sum * geofx_layerOpacity;
    gl_FragDepth = depth;
}
