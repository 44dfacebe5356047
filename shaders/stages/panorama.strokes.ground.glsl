// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a panorama map's strokes need of the ground that they stand on, in the vertex stage. SLOT_ stands for the
// effect's prefix.
#include "lib/painting.glsl"
#include "stages/panorama.edge.glsl"

uniform vec4 SLOT_stroke;     // as in panorama.strokes.vert
uniform vec4 SLOT_strokeView; // without the projection: the pixels of a metre at a distance of one, else 0; the picture's width and height in pixels
uniform vec4 SLOT_slopes;
uniform vec4 SLOT_hand;
uniform vec4 SLOT_clock; // as in panorama.ground.frag.glsl
uniform sampler2D SLOT_brush;
uniform sampler2D SLOT_palette;
uniform vec4 SLOT_snow;
uniform sampler2D SLOT_edgeMap;
uniform sampler2D SLOT_edgeSky;
uniform vec4 SLOT_edgeEye;
uniform vec4 SLOT_edgeWays;
uniform vec4 SLOT_edgeKind;
uniform vec4 SLOT_edgePlace;

vec3 SLOT_move(vec3 located, vec3 bent)
{
    return bent;
}

// Pixels for each metre of the ground, the mean of across and along.
float SLOT_groundScale(vec3 position)
{
    if (SLOT_strokeView.x > 0.0) return SLOT_strokeView.x / max(length(position), 1e-3);
    geofx_Panorama view = SLOT_view();
    float s = SLOT_placeOf(position).y;
    float slope = geofx_panoramaSlope(view, s);
    return 0.5 * sqrt(SLOT_strokeView.y * view.across * geofx_cylinderWidth(view.cylinder, s) * SLOT_strokeView.z * view.along * max(slope, 0.06));
}

float SLOT_strokeLight(vec3 position, vec3 normal, float y)
{
    vec3 vertical = normalize(geofx_exaggerationGradient(SLOT_view().globe, position));
    vec3 steep = normalize(normal + (1.0 / SLOT_light.w - 1.0) * dot(normal, vertical) * vertical);
#ifdef GEOFX_CORE
    vec3 towards = SLOT_light.xyz;
#else
    vec3 towards = SLOT_hand.w > 0.5 ? normalize(gl_LightSource[0].position.xyz) : SLOT_light.xyz;
#endif
    return geofx_paintLight(dot(steep, towards), y, SLOT_slopes.w);
}

float SLOT_strokeSteepness(vec3 position, vec3 normal)
{
    vec3 vertical = normalize(geofx_exaggerationGradient(SLOT_view().globe, position));
    float upward = max(dot(normal, vertical), 0.05);
    return length(normal - upward * vertical) / upward;
}

// As the ground has it there, whose fragments take the brush's picture as fine as pixels are.
vec2 SLOT_handWay(vec2 at, float detail)
{
    vec4 brush = mix(textureLod(SLOT_brush, at, detail), textureLod(SLOT_brush, 0.5 * at, detail - 1.0), SLOT_hand.y);
    return geofx_handWay(2.0 * brush - 1.0);
}

// A stroke stands where the ground shows what lies at its place: the ground wanders, so the stroke wanders the other way.
// `land`: metres from the shore. `scale`: pixels for each metre.
vec3 SLOT_strokeShift(vec3 position, vec3 normal, float land, float scale)
{
    float steepness = SLOT_strokeSteepness(position, normal);
    float share = geofx_handShare(-land, steepness, SLOT_clock.w);
    vec2 at = vec2(dot(position, SLOT_brushX.xyz) + SLOT_brushX.w, dot(position, SLOT_brushY.xyz) + SLOT_brushY.w);
    float texels = float(textureSize(SLOT_brush, 0).x) * length(SLOT_brushX.xyz) / max(scale, 1e-9);
    float detail = log2(max(texels, 1.0));
    // The way from where the stroke will stand.
    vec2 there = at;
    for (int i = 0; i < 2; ++i)
        there = at - share * SLOT_clock.z * SLOT_handWay(there, detail);
    vec2 way = SLOT_handWay(there, detail);
    vec3 vertical = normalize(geofx_exaggerationGradient(SLOT_view().globe, position));
    vec3 level = way.x * normalize(SLOT_brushX.xyz) + way.y * normalize(SLOT_brushY.xyz);
    vec3 along = level - dot(level, normal) / max(dot(normal, vertical), 0.1) * vertical; // on the slope
    vec3 shift = -SLOT_clock.w * share * along;
    // A slope ends at its crest, and no stroke may float above the ground. So on steep ground strokes stay near their places.
    float perMetre = SLOT_strokeView.x > 0.0 ? scale : 0.5 * SLOT_strokeView.z * geofx_panoramaLift(SLOT_view(), SLOT_placeOf(position).y);
    float rise = length(shift) * steepness * perMetre; // pixels
    return shift * min(1.0, 0.25 * SLOT_stroke.x / max(rise, 1e-6));
}

float SLOT_strokeFar(vec3 position)
{
    geofx_Panorama view = SLOT_view();
    return clamp(SLOT_placeOf(position).y / view.horizon, 0.0, 1.0);
}

float SLOT_strokeDepth(vec3 position)
{
    return SLOT_strokeView.x > 0.0 ? 0.0 : SLOT_strokeFar(position);
}

float SLOT_strokeTreeShare(vec3 position)
{
    return SLOT_placeOf(position).z / max(SLOT_slopes.z, 1.0);
}

// Open ground of a share of bare ground, in a light: what the ground itself would be painted, but that it has no trees and no houses.
vec3 SLOT_strokeOpen(vec3 position, float steepness, float bare, float light)
{
    geofx_PaintStyle style = geofx_PaintStyle(SLOT_snow.x, SLOT_snow.y, SLOT_snow.z, SLOT_slopes.x, SLOT_slopes.y, SLOT_snow.w);
    geofx_Cover cover = geofx_Cover(0.0, 0.0, bare, -1000.0);
    geofx_Classes classes = geofx_classify(cover, SLOT_placeOf(position).z, steepness, 0.0, style);
    float shares[5] = float[5](classes.field, classes.hill, classes.cliff, classes.snow, classes.bare);
    int rows[5] = int[5](GEOFX_PALETTE_FIELD, GEOFX_PALETTE_HILL, GEOFX_PALETTE_CLIFF, GEOFX_PALETTE_SNOW, GEOFX_PALETTE_BARE);
    vec3 color = vec3(0.0);
    for (int i = 0; i < 5; ++i)
        if (shares[i] > 0.004) color += shares[i] * textureLod(SLOT_palette, geofx_palettePlace(light, rows[i]), 0.0).rgb;
    return color;
}

// How far the ground below is gone at the end of the terrain.
float SLOT_strokeGone(vec3 position)
{
    if (SLOT_edgeKind.w == GEOFX_EDGE_NONE || SLOT_edgeKind.w == GEOFX_EDGE_UNKNOWN) return 0.0;
    geofx_Edge edge = geofx_edgeOf(SLOT_edgeEye, SLOT_edgeWays, SLOT_edgeKind, SLOT_cylinder);
    vec3 place = SLOT_placeOf(position);
    float lift = geofx_panoramaLift(SLOT_view(), place.y);
    float along = SLOT_scale.y * geofx_edgeSlope(SLOT_bendingCurve(), SLOT_curve, place.y);
    return geofx_edgeGone(SLOT_edgeMap, edge, SLOT_edgeKind, place, lift, along, 0.0, 0.0, 0.0).x;
}

float SLOT_strokeShown(vec3 position)
{
    // Strokes get sparse and small before the ground is gone.
    float left = 1.0 - geofx_ease(SLOT_strokeGone(position), 0.1, 0.8);
    if (SLOT_strokeView.x > 0.0) return left;
    geofx_Panorama view = SLOT_view();
    return left * geofx_panoramaFade(view, SLOT_placeOf(position).y);
}

vec3 SLOT_strokeAir(vec3 color, vec3 position)
{
    vec3 far = geofx_atmosphere(color, geofx_airColor(), geofx_airAmount(SLOT_strokeFar(position), SLOT_hand.z));
    float gone = SLOT_strokeGone(position);
    if (gone <= 0.0) return far;
    bool map = SLOT_edgeKind.w < GEOFX_EDGE_LAND;
    vec2 picture = map ? geofx_panoramaPicture(SLOT_view(), SLOT_placeOf(position)).xy : vec2(0.0);
    return mix(far, geofx_edgeColor(SLOT_edgeSky, SLOT_edgePlace, picture.x, 0.5 + 0.5 * picture.y, map ? 1.0 : 0.0), gone);
}
