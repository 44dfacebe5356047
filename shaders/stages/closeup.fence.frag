#version 330 compatibility
// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "stages/depth.glsl"
vec4 SLOT_fenceColor(vec2 fence);

in vec2 SLOT_fence;

void main()
{
    gl_FragColor = SLOT_fenceColor(SLOT_fence);
    GEOFX_PUT_EXACT_DEPTH;
}
