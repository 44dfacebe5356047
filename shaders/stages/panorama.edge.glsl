// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The sky of panorama maps, and the haze and the paper that their land ends in. Ground and sky get the same color for
// the same point of the picture, so that no border shows between them.
#include "lib/edge.glsl"
#include "lib/profile.glsl"

const vec3 geofx_paper = vec3(0.985, 0.968, 0.930);
const vec3 geofx_haze = vec3(0.90, 0.925, 0.945);

// How the terrain's edge is drawn.
const float GEOFX_EDGE_NONE = 0.0;     // not at all: the sea behind the land
const float GEOFX_EDGE_MAPPED = 1.0;   // as the picture of the terrain's extent tells
const float GEOFX_EDGE_UNKNOWN = 2.0;  // no such picture: haze behind the land
const float GEOFX_EDGE_LAND = 3.0;     // a perspective picture of land: haze behind it
const float GEOFX_EDGE_ISLAND = 4.0;   // of an island: the sea behind it

// The sea runs out over less than half the land's width, and is gone where land is gone. This is the distance for
// geofx_edgeAmount.
float geofx_edgeSeaReach(float reach, float width)
{
    return (reach - 0.16 * width) / 0.45 + 0.16 * width;
}

geofx_Edge geofx_edgeOf(vec4 eye, vec4 ways, vec4 kind, vec4 cylinder)
{
    return geofx_Edge(kind.x, eye.xy, ways.xy, ways.zw, eye.zw, kind.y,
                      geofx_Cylinder(cylinder.x, cylinder.y, cylinder.z));
}

// The slope of a map's ground at a distance, for geofx_edgeGone. `curve` is the projection's.
float geofx_edgeSlope(geofx_Profile profile, vec4 curve, float s)
{
    if (profile.first > 0.0) return max(geofx_profileSlope(profile, s / curve.y), 0.1);
    return clamp((curve.y - s) / max(curve.y - curve.x, 1e-3), 0.1, 1.0);
}

// The share of haze or paper on a place of the ground, and the share of that which is gone wholly: at 1, what lies
// behind it shows. `place` is x, s and height. `lift` and `along` tell
// how much the picture's y grows there for each metre of height and of s.
//
// Land that comes in from the picture's base does so as one wash, over ridges and over the valleys behind them. There
// the distance to the end is that of land at the border's own height at the same point of the picture. Otherwise
// ridges would be white before valleys. `sea`, 0 to 1: whether it is sea, which hides nothing and stays itself nearly
// to the end.
vec2 geofx_edgeGone(sampler2D map, geofx_Edge edge, vec4 kind, vec3 place, float lift, float along, float sea,
                    float noise, float rough)
{
    vec2 at = geofx_edgePlace(edge, place.xy);
    vec3 here = textureLod(map, at, 0.0).rgb;
    float width = kind.z;
    float reach = here.r;
    rough *= 1.0 - sea;
    if (kind.w != GEOFX_EDGE_MAPPED) return vec2(geofx_edgeAmount(reach, width, noise, rough), 0.0);
    if (reach > 6.0 * width) return vec2(0.0);
    // The part of the way to the end that leads back to the picture's base.
    float aside = max(0.35 * width, 1.0);
    vec2 ahead = (geofx_edgePlace(edge, place.xy + vec2(0.0, aside)) - at) / aside;
    float grows = textureLod(map, at + aside * ahead, 0.0).r - textureLod(map, at - aside * ahead, 0.0).r;
    float before = geofx_ease(grows / (2.0 * aside), 0.0, 0.5);
    float rise = lift * (place.z - here.b) / along;
    rise = (1.0 - sea) * before * clamp(rise, -5.0 * width, 1.5 * width);
    float seen = textureLod(map, at + rise * ahead, 0.0).r;
    seen = mix(seen, geofx_edgeSeaReach(seen, width), sea);
    float cut = geofx_edgeAmount(reach, width, 0.0, 0.0);
    return vec2(max(geofx_edgeAmount(seen, width, noise, rough), geofx_ease(cut, 0.8, 1.0)), cut);
}

// How far above the horizon a point is. `place` is the horizon's height in the picture, its arch, the heading and the
// part across, in turns. x is the picture's, -1 to 1; y is 0 to 1.
float geofx_skyAbove(vec4 place, float x, float y)
{
    return y - place.x + place.y * (1.0 - cos(1.5707963 * x));
}

vec3 geofx_skyColor(sampler2D sky, vec4 place, float x, float above)
{
    float room = 1.0 - place.x + place.y;
    float across = place.z + 0.5 * place.w * x;
    float height = above / max(room, 0.02);
    vec3 color = texture(sky, vec2(across, clamp(height, 0.002, 0.998))).rgb;
    // Above its painted height the sky is even: the mean of its upper edge.
    if (height > 0.75)
    {
        vec3 even = textureLod(sky, vec2(0.5, 0.95), 6.0).rgb;
        color = mix(color, even, clamp(4.0 * height - 3.0, 0.0, 1.0));
    }
    return color;
}

// The color of a point of the picture where the land is gone.
vec3 geofx_edgeColor(sampler2D sky, vec4 place, float x, float y, float paper)
{
    float above = geofx_skyAbove(place, x, y);
    vec3 color = geofx_skyColor(sky, place, x, max(above, 0.0));
    if (above >= 0.0) return color;
    // Below the horizon the sky's light turns into haze.
    vec3 low = textureLod(sky, vec2(place.z + 0.5 * place.w * x, 0.02), 5.0).rgb;
    float depth = -above / max(place.x, 0.05);
    color = mix(color, low, smoothstep(0.0, 0.06, depth));
    color = mix(color, geofx_haze, 0.65 * smoothstep(0.02, 0.35, depth));
    color = mix(color, geofx_paper, paper * geofx_edgePaper(y));
    // Such an even wash would show the steps of its bytes.
    float grain = fract(52.9829189 * fract(dot(vec2(x, y), vec2(53.7, 41.9) * 1.9)));
    return color + (grain - 0.5) * (2.0 / 255.0);
}
