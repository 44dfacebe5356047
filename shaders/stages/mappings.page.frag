#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// All mappings over a place of a page, composed into one color: what lies below counts by 1 - alpha, and the rest is added.
#define SLOT_COMPOSE
#include "stages/mappings.frag.glsl"

void main()
{
    vec4 composed = SLOT_color(vec4(0.0, 0.0, 0.0, 1.0));
    gl_FragColor = vec4(composed.rgb, 1.0 - composed.a);
}
