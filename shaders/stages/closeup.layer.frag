#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "stages/depth.glsl"
uniform sampler2DArray geofx_layerColors;
uniform sampler2DArray geofx_layerDepths;
uniform ivec4 geofx_layerOrigin; // the layer's first pixel, the layer, and samples along a pixel's side
uniform float geofx_layerOpacity;
uniform vec2 geofx_layerAlphas; // pixels above the first and up to the second

// The close-ups that are put into the picture after this one and overlap it.
const int geofx_mostOthers = 16;
uniform int geofx_others;
uniform ivec4 geofx_otherOrigins[geofx_mostOthers]; // their first pixels and layers; anchors have the next layer
uniform ivec4 geofx_otherParts[geofx_mostOthers];   // the first pixels of their parts of the window, and the first ones beyond
uniform float geofx_otherCovers[geofx_mostOthers];  // the alphas above which they hide what is behind them
// Which fragments of this layer to show: 0 all, 1 those without one of the others behind them, 2 those with one.
uniform int geofx_layerTurn;
uniform int geofx_layerAnchor; // the anchor's layer, or -1

// The layer's premultiplied color, with the nearest depth.
vec4 geofx_layerAt(ivec3 origin, out float depth)
{
    int samples = geofx_layerOrigin.w;
    ivec2 first = (ivec2(floor(gl_FragCoord.xy)) - origin.xy) * samples;
    vec4 sum = vec4(0.0);
    depth = GEOFX_FARTHEST;
    for (int y = 0; y < samples; ++y)
    {
        for (int x = 0; x < samples; ++x)
        {
            ivec3 texel = ivec3(first + ivec2(x, y), origin.z);
            vec4 color = texelFetch(geofx_layerColors, texel, 0);
            sum += vec4(color.rgb * color.a, color.a);
            if (color.a > 0.0) depth = geofx_nearest(depth, texelFetch(geofx_layerDepths, texel, 0).r);
        }
    }
    return sum / float(samples * samples);
}

// Whether an anchor or a soft edge of another close-up is farther away than `depth`.
bool geofx_othersBehind(float depth)
{
    ivec2 pixel = ivec2(floor(gl_FragCoord.xy));
    for (int i = 0; i < geofx_others; ++i)
    {
        ivec4 part = geofx_otherParts[i];
        if (any(lessThan(pixel, part.xy)) || any(greaterThanEqual(pixel, part.zw))) continue;
        ivec3 origin = geofx_otherOrigins[i].xyz;
        float edge, anchor;
        float edgeAlpha = geofx_layerAt(origin, edge).a;
        bool anchored = geofx_layerAt(origin + ivec3(0, 0, 1), anchor).a > 0.0;
        // An edge lies over its own anchor, wherever the anchor is.
        if (anchored) edge = geofx_nearest(edge, anchor);
        bool edged = edgeAlpha > 0.0 && edgeAlpha <= geofx_otherCovers[i];
        if ((anchored && geofx_isBehind(anchor, depth)) || (edged && geofx_isBehind(edge, depth))) return true;
    }
    return false;
}

void main()
{
    float depth;
    vec4 sum = geofx_layerAt(geofx_layerOrigin.xyz, depth);
    if (sum.a <= geofx_layerAlphas.x || sum.a > geofx_layerAlphas.y) discard;
    if (geofx_layerTurn > 0)
    {
        float anchor;
        float from = depth;
        if (geofx_layerAnchor >= 0 &&
            geofx_layerAt(ivec3(geofx_layerOrigin.xy, geofx_layerAnchor), anchor).a > 0.0)
            from = geofx_nearest(from, anchor);
        if (geofx_othersBehind(from) != (geofx_layerTurn == 2)) discard;
    }
    gl_FragColor = sum * geofx_layerOpacity;
    gl_FragDepth = depth;
}
