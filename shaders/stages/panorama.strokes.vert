#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Brush strokes of PanoramaMap, one point each (osgGeoFX/panorama/detail/TileStrokes.h lists the arrays): the place
// of a stroke and its look, which is the same for all of it. SLOT_ stands for the effect's prefix.
#include "lib/strokes.glsl"
#include "stages/view.glsl"
#include "stages/depth.glsl"

vec4 geofx_vertex(vec4 eyePosition);
// Of undeformed places in the view's eye space: pixels for each metre of the ground, the mean of across and along; the light on the ground, -1
// to 1, `y` the place's in the picture, 0 at the bottom to 1; what the air makes of a color.
float SLOT_groundScale(vec3 eyePosition);
float SLOT_strokeLight(vec3 eyePosition, vec3 eyeNormal, float y);
vec3 SLOT_strokeAir(vec3 color, vec3 eyePosition);
// 0 at the picture's base, 1 at the horizon.
float SLOT_strokeFar(vec3 eyePosition);
// The same in a map. Without its projection the camera's perspective makes strokes sparse: 0.
float SLOT_strokeDepth(vec3 eyePosition);
// The height above the sea over that of the tree line.
float SLOT_strokeTreeShare(vec3 eyePosition);
// How far the painter's hand takes a stroke from its place. `land`: metres from the shore. `scale`: pixels for each metre.
vec3 SLOT_strokeShift(vec3 eyePosition, vec3 eyeNormal, float land, float scale);
// Rise over run of the ground, and its color in a light if it is open. `bare` as in lib/cover.glsl.
float SLOT_strokeSteepness(vec3 eyePosition, vec3 eyeNormal);
vec3 SLOT_strokeOpen(vec3 eyePosition, float steepness, float bare, float light);
uniform vec4 SLOT_slopes; // x: that of cliffs
// The share of a stroke that is left behind the horizon.
float SLOT_strokeShown(vec3 eyePosition);

uniform vec4 SLOT_viewport;    // width and height in pixels, and one over each
uniform vec4 SLOT_stroke;      // size and wanted spacing in pixels, step of the lattice in metres, the share that is seen
uniform sampler2D SLOT_palette; // 8 rows, columns from light -1 to light 1

out vec3 SLOT_lightTone_in;
out vec3 SLOT_darkTone_in;
out vec4 SLOT_stamp_in;  // half its width and its height in pixels, and the direction of its height
out vec2 SLOT_traits_in; // kind and seed
out vec3 SLOT_ground_in; // where it stands on the undeformed ground, in the view's eye space

vec3 SLOT_tone(int row, float light)
{
    vec2 size = vec2(textureSize(SLOT_palette, 0));
    float column = mix(0.5, size.x - 0.5, clamp(0.5 + 0.5 * light, 0.0, 1.0)) / size.x;
    return textureLod(SLOT_palette, vec2(column, (float(row) + 0.5) / 8.0), 0.0).rgb;
}

// The place on the screen of a place in eye space, in pixels.
vec2 SLOT_pixel(vec4 clip)
{
    return 0.5 * SLOT_viewport.xy * clip.xy / max(clip.w, 1e-6);
}

void main()
{
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    vec3 ground = geofx_inView(eye.xyz);
    vec3 normal = geofx_directionInView(normalize(gl_NormalMatrix * gl_Normal));
    float seed = gl_MultiTexCoord0.x / 32767.0;
    float level = 0.5 * gl_MultiTexCoord0.y;
    int kind = int(gl_MultiTexCoord0.z + 0.5);
    float threshold = gl_MultiTexCoord0.w / 32767.0;
    bool isLine = kind == GEOFX_STROKE_ROAD || kind == GEOFX_STROKE_RIVER;
    if (!isLine)
    {
        ground += SLOT_strokeShift(ground, normal, gl_MultiTexCoord2.y, SLOT_groundScale(ground));
        eye.xyz = geofx_inEye(ground);
    }
    SLOT_ground_in = ground;

    float groundScale = SLOT_groundScale(ground);
    float shrink = isLine ? 1.0 : geofx_strokeShrink(SLOT_strokeDepth(ground));
    float wanted = geofx_strokeWanted(SLOT_stroke.y * shrink, SLOT_stroke.z, groundScale);
    float size = SLOT_stroke.x * shrink * geofx_strokeGrowth(wanted);
    if (kind == GEOFX_STROKE_TREE) kind = geofx_strokeTree(SLOT_strokeTreeShare(ground), seed);
    if (isLine)
        size *= geofx_strokeOfLine(level, wanted) ? 1.0 - 0.4 * SLOT_strokeFar(ground) : 0.0;
    else
        size *= geofx_strokeScale(level, threshold, wanted);
    float shown = SLOT_strokeShown(ground);
    size *= shown;

    // Of a house: how much of the city's middle it is. Of a cliff: how bare the ground is, as in lib/cover.glsl.
    float ofKind = gl_MultiTexCoord2.x / 32767.0;
    bool isBuilding = kind == GEOFX_STROKE_HOUSE;
    if (isBuilding) kind = geofx_strokeHouse(ofKind, seed);
    isBuilding = isBuilding && kind != GEOFX_STROKE_TREE;
    geofx_StrokeShape shape = geofx_strokeShape(kind, seed);
    if (isBuilding) shape.size.y *= geofx_strokeStoreys(kind, ofKind, seed);
    vec2 axis = vec2(0.0, 1.0);
    float lineLength = 0.0; // half of it, pixels
    if (isLine && size > 0.0)
    {
        float reach = geofx_strokeReach(SLOT_stroke.z, 0.5 * gl_MultiTexCoord0.w, wanted);
        vec3 along = reach * normalize(gl_NormalMatrix * gl_MultiTexCoord1.xyz);
        vec2 way = 0.5 * (SLOT_pixel(gl_ProjectionMatrix * geofx_vertex(vec4(eye.xyz + along, 1.0))) -
                          SLOT_pixel(gl_ProjectionMatrix * geofx_vertex(vec4(eye.xyz - along, 1.0))));
        axis = length(way) > 0.05 ? normalize(way) : axis;
        lineLength = max(length(way), size * shape.size.x);
    }
    if (kind == GEOFX_STROKE_CLIFF && size > 0.0)
    {
        // The fall line on the screen, upwards: it ends at a place a little down the slope.
        vec3 downhill = normalize(gl_NormalMatrix * gl_MultiTexCoord1.xyz);
        vec4 below = vec4(eye.xyz + downhill * (0.5 * SLOT_stroke.y / max(groundScale, 1e-9)), 1.0);
        vec2 way = SLOT_pixel(gl_ProjectionMatrix * geofx_vertex(eye)) - SLOT_pixel(gl_ProjectionMatrix * geofx_vertex(below));
        axis = length(way) > 0.05 ? normalize(way) : axis;
        // A slope that falls away from the viewer is seen from its end.
        shape.size.y *= clamp(length(way) / (0.35 * SLOT_stroke.y), 0.35, 1.0);
    }
    float c = cos(shape.lean);
    float s = sin(shape.lean);
    vec2 extent = isLine ? vec2(size * shape.size.x, shown * lineLength) : size * shape.size;
    SLOT_stamp_in = vec4(extent, axis.x * c + axis.y * s, axis.y * c - axis.x * s);
    SLOT_traits_in = vec2(float(kind), seed);

    // Ground that rises behind a stroke must not cut it off. So the stroke gets the depth of a place that is nearer
    // by about its height.
    vec4 moved = geofx_vertex(eye);
    vec4 nearer = moved;
    float height = 1.4 * SLOT_stamp_in.y + (isLine ? 2.0 * SLOT_stroke.x : 0.0); // trees must not hide lines
    nearer.z += min(height / max(groundScale, 1e-9), 0.5 * abs(moved.z));
    nearer = gl_ProjectionMatrix * nearer;
    gl_Position = gl_ProjectionMatrix * moved;
    if (nearer.w > 0.0) gl_Position.z = geofx_depthOf(nearer, gl_Position);
    vec4 picture = geofx_inPicture(moved);
    float y = 0.5 + 0.5 * picture.y / max(picture.w, 1e-6);
    float light = SLOT_strokeLight(ground, normal, y) +
                  shape.tone * (kind == GEOFX_STROKE_CLIFF ? 0.5 : 1.0) * (1.0 - 0.6 * SLOT_strokeFar(ground));
    if (isBuilding)
    {
        // Walls have the town's color, those of the middle are paler. Roofs are of tiles or slate, and flat ones in their shade.
        float hue = geofx_strokeRandom(seed, 5.0);
        SLOT_lightTone_in = mix(SLOT_tone(6, light), vec3(1.0), kind == GEOFX_STROKE_HOUSE ? 0.25 : 0.3 + 0.3 * hue);
        vec3 tiles = mix(vec3(0.84, 0.47, 0.31), vec3(0.68, 0.43, 0.36), fract(7.0 * hue));
        vec3 roof = kind == GEOFX_STROKE_HOUSE ? (hue < 0.6 ? tiles : vec3(0.56, 0.56, 0.62)) : vec3(0.55, 0.52, 0.66);
        SLOT_darkTone_in = roof * (0.75 + 0.3 * light);
    }
    else if (kind == GEOFX_STROKE_ROAD)
    {
        SLOT_lightTone_in = vec3(0.98, 0.91, 0.72) * (0.88 + 0.12 * light);
        SLOT_darkTone_in = vec3(0.52, 0.40, 0.36) * (0.88 + 0.12 * light);
    }
    else if (kind == GEOFX_STROKE_RIVER)
    {
        SLOT_lightTone_in = vec3(0.70, 0.84, 0.90);
        SLOT_darkTone_in = vec3(0.42, 0.64, 0.80);
    }
    else if (kind == GEOFX_STROKE_CLIFF)
    {
        float steepness = SLOT_strokeSteepness(ground, normal);
        // Far away, light and shade come nearer to each other, but ridges keep their lines.
        float contrast = 0.22 * geofx_strokeDepth(steepness, SLOT_slopes.x) * (1.0 - 0.3 * SLOT_strokeFar(ground));
        SLOT_lightTone_in = SLOT_strokeOpen(ground, steepness, ofKind, light + contrast);
        SLOT_darkTone_in = SLOT_strokeOpen(ground, steepness, ofKind, light - contrast);
    }
    else
    {
        float contrast = 0.24 * (1.0 - 0.6 * SLOT_strokeFar(ground));
        SLOT_lightTone_in = SLOT_tone(5, light + contrast);
        SLOT_darkTone_in = SLOT_tone(5, light - contrast);
        if (kind == GEOFX_STROKE_CONIFER)
        {
            // Needles are darker than leaves, and bluer.
            SLOT_lightTone_in *= vec3(0.84, 0.90, 0.96);
            SLOT_darkTone_in *= vec3(0.74, 0.84, 0.94);
        }
    }
    SLOT_lightTone_in = SLOT_strokeAir(SLOT_lightTone_in, ground);
    SLOT_darkTone_in = SLOT_strokeAir(SLOT_darkTone_in, ground);
}
