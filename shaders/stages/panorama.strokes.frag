#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Brush strokes of PanoramaMap: the mask of the brush and its two tones. Colors are premultiplied. Depth is written,
// so strokes need no order. Fragments that are less than half covered are left out: the soft edge of a near stroke
// would hide a far one behind it. With multisampling, GL_SAMPLE_ALPHA_TO_COVERAGE may take the place of blending.
#pragma import_defines(GEOFX_LAYER)
#include "lib/strokes.glsl"

vec4 geofx_finish(vec4 color);

uniform vec4 SLOT_stroke; // w: the share that is seen
uniform vec4 SLOT_light; // xyz: unit vector to the light in eye space

flat in vec3 SLOT_lightTone;
flat in vec3 SLOT_darkTone;
flat in vec4 SLOT_stamp;
flat in vec2 SLOT_traits;
in vec2 SLOT_point;

void main()
{
    int kind = int(SLOT_traits.x + 0.5);
    float seed = SLOT_traits.y;
    float inside = geofx_strokeInside(kind, SLOT_point, seed);
    float cover = clamp(0.5 + inside / max(fwidth(inside), 1e-4), 0.0, 1.0);
    if (cover < 0.4) discard;

    vec3 color;
    if (kind == GEOFX_STROKE_HOUSE)
    {
        float gable = SLOT_point.x * (SLOT_light.x < 0.0 ? -1.0 : 1.0) < -0.1 ? 0.8 : 1.0;
        color = gable * (SLOT_point.y > 0.0 ? SLOT_darkTone : SLOT_lightTone);
    }
    else if (kind == GEOFX_STROKE_BLOCK || kind == GEOFX_STROKE_TOWER)
    {
        // A side in the light and one in the shade, rows of windows, a roof.
        float side = SLOT_point.x * (SLOT_light.x < 0.0 ? 1.0 : -1.0);
        vec3 wall = mix(SLOT_lightTone, SLOT_darkTone, side > 0.2 ? 0.62 : 0.0);
        float row = fract(1.5 * SLOT_stamp.y / max(SLOT_stamp.x, 0.5) * (0.5 + 0.5 * SLOT_point.y));
        wall = mix(wall, SLOT_darkTone, 0.28 * step(0.55, row) * clamp(SLOT_stamp.x - 2.0, 0.0, 1.0));
        color = SLOT_point.y > 0.66 ? mix(SLOT_lightTone, vec3(1.0), 0.3) : wall;
    }
    else if (kind == GEOFX_STROKE_ROAD || kind == GEOFX_STROKE_RIVER)
    {
        color = mix(SLOT_lightTone, SLOT_darkTone, smoothstep(0.5, 0.85, abs(SLOT_point.x)));
    }
    else
    {
        // The light's direction in the frame of the stroke.
        vec2 light = SLOT_light.xy / max(length(SLOT_light.xy), 0.25);
        light = vec2(dot(light, vec2(SLOT_stamp.w, -SLOT_stamp.z)), dot(light, SLOT_stamp.zw));
        color = mix(SLOT_darkTone, SLOT_lightTone, geofx_strokeLit(SLOT_point, light, seed));
    }
    vec4 finished = geofx_finish(vec4(color, 1.0));
#ifdef GEOFX_LAYER
    // A layer has the color of what is nearest, with straight alpha. It is not blended.
    if (cover < 0.5) discard;
    gl_FragColor = finished;
#else
    gl_FragColor = vec4(finished.rgb, 1.0) * (finished.a * cover * SLOT_stroke.w);
#endif
}
