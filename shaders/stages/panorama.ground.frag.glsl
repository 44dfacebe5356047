// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The painting of a panorama map's ground, after Sections 3.2, 3.4 and 3.5 of Brown and Samavati (2017). SLOT_ stands for the
// effect's prefix.
#pragma import_defines(GEOFX_PAINTED, GEOFX_MIRROR)
#pragma import_defines(GEOFX_PART, GEOFX_RIGID)
#include "stages/parts.glsl"
#include "stages/panorama.water.glsl"
#include "stages/panorama.edge.glsl"

uniform sampler2D SLOT_cover;
uniform sampler2D SLOT_palette;
uniform sampler2D SLOT_brush;
uniform sampler2D SLOT_mirror; // the picture in still water; alpha: the distance of what it shows, s over the end, 1 for the sky
uniform vec4 SLOT_light;
uniform vec4 SLOT_snow;   // its line in midsummer, how much lower in midwinter, its width, the season
uniform vec4 SLOT_slopes; // of cliffs and hills; the tree line, the bottom's shade
uniform vec4 SLOT_brushX;
uniform vec4 SLOT_brushY;
uniform vec4 SLOT_hand;   // the brush's strength, the share of its larger size, the air's strength, the scene's light
uniform vec4 SLOT_water;  // where it is deep, the reflection's strength, the ripples', whether there is water
uniform vec4 SLOT_window; // the viewport's corner, one over its size
uniform vec4 SLOT_clock;  // seconds, the strength, how far the hand wanders at edges: in the brush's picture, metres
uniform vec4 SLOT_scale;
uniform vec4 SLOT_curve;
uniform vec4 SLOT_cylinder; // as in lib/cylinder.glsl
uniform vec4 SLOT_profile; // how much more heights are raised at the horizon, for each metre; the curve's first slope
uniform vec4 SLOT_knot1;   // of the bending curve, as in lib/profile.glsl
uniform vec4 SLOT_knot2;
uniform vec4 SLOT_knot3;
uniform vec4 SLOT_knot4;
uniform vec4 SLOT_knot5;
uniform vec4 SLOT_knot6;
uniform sampler2D SLOT_edgeMap; // the distance to the end of what is known, metres
uniform sampler2D SLOT_edgeSky;
uniform vec4 SLOT_edgeEye;      // as in lib/edge.glsl
uniform vec4 SLOT_edgeWays;
uniform vec4 SLOT_edgeKind;     // whether on a globe, the middle's latitude, the width, how it is drawn
uniform vec4 SLOT_edgePlace;    // the sky's, as in panorama.edge.glsl

in vec3 SLOT_place;
in vec4 SLOT_facing;
in vec4 SLOT_texels;

vec3 SLOT_shade(float light, int row)
{
    return texture(SLOT_palette, geofx_palettePlace(light, row)).rgb;
}

vec3 SLOT_ground(geofx_Classes classes, float light)
{
    vec3 color = vec3(0.0);
    if (classes.field > 0.004) color += classes.field * SLOT_shade(light, GEOFX_PALETTE_FIELD);
    if (classes.hill > 0.004) color += classes.hill * SLOT_shade(light, GEOFX_PALETTE_HILL);
    if (classes.cliff > 0.004) color += classes.cliff * SLOT_shade(light, GEOFX_PALETTE_CLIFF);
    if (classes.snow > 0.004) color += classes.snow * SLOT_shade(light, GEOFX_PALETTE_SNOW);
    if (classes.forest > 0.004) color += classes.forest * SLOT_shade(light, GEOFX_PALETTE_FOREST);
    if (classes.town > 0.004) color += classes.town * SLOT_shade(light, GEOFX_PALETTE_TOWN);
    if (classes.bare > 0.004) color += classes.bare * SLOT_shade(light, GEOFX_PALETTE_BARE);
    return color;
}

geofx_Profile SLOT_bendingCurve()
{
    return geofx_Profile(SLOT_profile.y, SLOT_knot1.xyz, SLOT_knot2.xyz, SLOT_knot3.xyz, SLOT_knot4.xyz,
                         SLOT_knot5.xyz, SLOT_knot6.xyz);
}

// Of the picture's y for each metre of height.
float SLOT_lift()
{
    geofx_Cylinder cylinder = geofx_Cylinder(SLOT_cylinder.x, SLOT_cylinder.y, SLOT_cylinder.z);
    return geofx_profileLift(SLOT_scale.z, SLOT_profile.x, SLOT_place.y / SLOT_curve.y) *
           geofx_cylinderWidth(cylinder, SLOT_place.y);
}

// `noise`, -1 to 1: a hand lays shallows down broader here than there.
vec3 SLOT_wet(float shore, vec2 picture, float far, float noise)
{
    shore *= exp(0.8 * noise);
#ifdef GEOFX_MIRROR
    return geofx_waterBody(max(shore, 0.0), SLOT_water.x);
#else
    // The mirror is at height 0. The reflection in a lake lies higher by twice the lake's height.
    float lift = SLOT_lift();
    geofx_WaterPlace place = geofx_WaterPlace(max(shore, 0.0), picture, SLOT_texels.zw, lift * SLOT_place.z,
                                              SLOT_place.y / SLOT_curve.z, far);
    return geofx_water(place, SLOT_water, SLOT_clock.x, SLOT_brush, SLOT_mirror);
#endif
}

// The share of haze or paper on the ground, and whether the ground is gone.
vec2 SLOT_gone(float noise, float y, float wet, float shore)
{
    if (SLOT_edgeKind.w == GEOFX_EDGE_NONE || SLOT_edgeKind.w == GEOFX_EDGE_UNKNOWN) return vec2(0.0);
    geofx_Edge edge = geofx_edgeOf(SLOT_edgeEye, SLOT_edgeWays, SLOT_edgeKind, SLOT_cylinder);
    vec3 place = vec3(SLOT_place.x / SLOT_scale.x, SLOT_place.yz);
    float along = SLOT_scale.y * geofx_edgeSlope(SLOT_bendingCurve(), SLOT_curve, place.y);
    // A lake runs out as the land around it does, and so does the shore.
    float sea = wet * (1.0 - geofx_ease(SLOT_place.z, 10.0, 30.0)) * geofx_ease(shore, 0.0, 0.2 * SLOT_edgeKind.z);
    return geofx_edgeGone(SLOT_edgeMap, edge, SLOT_edgeKind, place, SLOT_lift(), along, sea, noise,
                          mix(0.3, 0.2, geofx_edgePaper(y)));
}

// As in SLOT_face().
vec4 SLOT_facingHere()
{
#ifdef GEOFX_FRAGMENT_NORMAL
    vec3 vertical = normalize(SLOT_facing.xyz);
    vec3 normal = normalize(geofx_eyeNormal());
    float upward = dot(normal, vertical);
    float level = length(normal - upward * vertical);
    return vec4(normalize(normal + (1.0 / SLOT_light.w - 1.0) * upward * vertical), level / max(abs(upward), 0.02));
#else
    return vec4(normalize(SLOT_facing.xyz), SLOT_facing.w);
#endif
}

// The cover as a hand paints it: what lies a little beside the place, as the brush's picture has it. So no edge is that of the
// raster's cells. Strokes are moved the other way (panorama.strokes.ground.glsl). The shore is the data's.
vec4 SLOT_handCover(vec4 here, vec2 way, float steepness)
{
    vec2 coverX = dFdx(SLOT_texels.xy), coverY = dFdy(SLOT_texels.xy);
    vec2 brushX = dFdx(SLOT_texels.zw), brushY = dFdy(SLOT_texels.zw);
    // From the brush's picture to the cover, on the ground. Ground that is seen from its edge tells it badly.
    float area = brushX.x * brushY.y - brushX.y * brushY.x;
    float sure = geofx_ease(abs(area), 0.002 * (dot(brushX, brushX) + dot(brushY, brushY)),
                            0.01 * (dot(brushX, brushX) + dot(brushY, brushY)));
    float over = area < 0.0 ? min(area, -1e-20) : max(area, 1e-20);
    vec2 perX = SLOT_clock.z * (coverX * brushY.y - coverY * brushX.y) / over;
    vec2 perY = SLOT_clock.z * (coverY * brushX.x - coverX * brushY.x) / over;
    // A tile ends with texels that its neighbors have, too. There is no wandering there, so there is no seam.
    vec2 texel = 0.5 / vec2(textureSize(SLOT_cover, 0));
    vec2 room = min(SLOT_texels.xy, 1.0 - SLOT_texels.xy) - texel;
    vec2 reach = 0.8 * (abs(perX) + abs(perY)) + 1e-9;
    float inside = geofx_share(min(room.x / reach.x, room.y / reach.y));
    float share = sure * inside * geofx_handShare(geofx_coverOf(here).shore, steepness, SLOT_clock.w);
    vec2 at = SLOT_texels.xy + share * (perX * way.x + perY * way.y);
    at = inside > 0.0 ? clamp(at, texel, 1.0 - texel) : SLOT_texels.xy;
    vec4 there = textureGrad(SLOT_cover, at, coverX, coverY);
    return vec4(there.rgb, here.a);
}

#if defined(GEOFX_PART) && !defined(GEOFX_MIRROR)
#define SLOT_PARTED
uniform vec4 SLOT_up; // as in panorama.glsl

// What would be there without the forest: the other classes in its place.
geofx_Classes SLOT_cleared(geofx_Classes classes)
{
    float share = 1.0 / max(1.0 - classes.forest, 0.02);
    classes.hill *= share;
    classes.cliff *= share;
    classes.snow *= share;
    classes.town *= share;
    classes.bare *= share;
    classes.forest = 0.0;
    classes.field = 1.0 - classes.hill - classes.cliff - classes.snow - classes.town - classes.bare;
    return classes;
}

// Numbers as PictureLayers names them.
float SLOT_largestClass(geofx_Classes classes, float wet)
{
    float shares[7] = float[7](classes.field, classes.hill, classes.cliff, classes.snow, classes.forest, classes.town,
                               classes.bare);
    int largest = 0;
    for (int i = 1; i < 7; ++i)
        if (shares[i] > shares[largest]) largest = i;
    return (wet > 0.5 ? 8.0 : float(largest + 1)) / 255.0;
}
#endif

vec4 SLOT_color(vec4 color)
{
#ifndef GEOFX_PAINTED
    return color;
#else
    vec4 facing = SLOT_facingHere();
    vec4 fine = texture(SLOT_brush, SLOT_texels.zw);
    vec4 coarse = texture(SLOT_brush, 0.5 * SLOT_texels.zw);
    vec4 brush = 2.0 * mix(fine, coarse, SLOT_hand.y) - 1.0;

    vec4 texel = SLOT_handCover(texture(SLOT_cover, SLOT_texels.xy), geofx_handWay(brush), facing.w);
    geofx_Cover cover;
    if (geofx_coverKnown(texel))
        cover = geofx_coverOf(texel);
    else
        cover = geofx_likelyCover(SLOT_place.z, facing.w, SLOT_slopes.z);
    float edge = max(fwidth(texel.a), 1e-4);
    // Half a pixel more than there is, so that rivers stay in sight.
    float wet = geofx_coverKnown(texel) ? clamp((texel.a - 128.0 / 255.0) / edge + 0.9, 0.0, 1.0)
                                        : step(0.0, cover.shore);
    wet *= SLOT_water.w;
#ifdef GEOFX_RIGID
    wet = 0.0; // a building
#endif

#if defined(GEOFX_HOST_NORMAL) || defined(GEOFX_CORE)
    vec3 towards = SLOT_light.xyz; // the lights are those of an engine, or of a program of the application
#else
    vec3 towards = SLOT_hand.w > 0.5 ? normalize(gl_LightSource[0].position.xyz) : SLOT_light.xyz;
#endif
    vec3 turned = normalize(facing.xyz + SLOT_hand.x * (brush.x * normalize(SLOT_brushX.xyz) +
                                                    brush.y * normalize(SLOT_brushY.xyz)));
    vec2 picture = (geofx_pixel() - SLOT_window.xy) * SLOT_window.zw;
    float light = geofx_paintLight(dot(turned, towards), picture.y, SLOT_slopes.w);

    geofx_PaintStyle style = geofx_PaintStyle(SLOT_snow.x, SLOT_snow.y, SLOT_snow.z, SLOT_slopes.x, SLOT_slopes.y,
                                              SLOT_snow.w);
    float far = clamp(SLOT_place.y / SLOT_curve.y, 0.0, 1.0);
    vec3 painted = vec3(0.0);
#ifdef SLOT_PARTED
    geofx_Classes classes = geofx_classify(cover, SLOT_place.z, facing.w, brush.z, style);
#if GEOFX_PART == GEOFX_PART_FLAT
    painted = SLOT_ground(SLOT_cleared(classes), geofx_paintLight(dot(SLOT_up.xyz, towards), 1.0, 0.0)); // of level ground
#elif GEOFX_PART == GEOFX_PART_WOODS
    painted = SLOT_ground(classes, light);
#else
    painted = SLOT_ground(SLOT_cleared(classes), light);
#endif
#elif defined(GEOFX_RIGID)
    // Walls are no cliffs, and roofs no fields: a town's color with a share of their own.
    painted = SLOT_shade(light, GEOFX_PALETTE_TOWN) * (0.35 + 0.8 * color.rgb);
#else
    if (wet < 1.0)
        painted = SLOT_ground(geofx_classify(cover, SLOT_place.z, facing.w, brush.z, style), light);
    if (wet > 0.0) painted = mix(painted, SLOT_wet(cover.shore, picture, far, brush.z), wet);
#endif
    painted = geofx_atmosphere(painted, geofx_airColor(), geofx_airAmount(far, SLOT_hand.z));
    vec2 gone = SLOT_gone(brush.z, picture.y, wet, cover.shore);
#ifdef GEOFX_MIRROR
    // Water does not reflect ground below the water, other water, or ground that is gone.
    if (SLOT_place.z <= 0.0 || wet > 0.5 || max(gone.x, gone.y) > 0.5) discard;
    return vec4(painted, clamp(SLOT_place.y / SLOT_curve.z, 0.0, 0.98));
#else
    // What lies behind the ground shows, and the border leaves no trace.
    if (gone.y >= 1.0 && SLOT_clock.y >= 1.0) discard;
    if (gone.x > 0.0)
    {
        float paper = SLOT_edgeKind.w < GEOFX_EDGE_LAND ? 1.0 : 0.0;
        painted = mix(painted, geofx_edgeColor(SLOT_edgeSky, SLOT_edgePlace, 2.0 * picture.x - 1.0, picture.y, paper), gone.x);
    }
#if defined(SLOT_PARTED) && GEOFX_PART == GEOFX_PART_SHARES
    return vec4((1.0 - gone.x) * SLOT_clock.y * vec2(wet, classes.forest), 1.0, 1.0);
#elif defined(SLOT_PARTED) && GEOFX_PART == GEOFX_PART_CLASSES
    return vec4(vec3(SLOT_largestClass(classes, wet)), 1.0);
#else
    return mix(color, vec4(painted, 1.0), SLOT_clock.y);
#endif
#endif
#endif
}
