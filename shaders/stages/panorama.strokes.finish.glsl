// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Strokes have their color from their own stage, so this stage does nothing. SLOT_ stands for the effect's prefix.
vec4 SLOT_finish(vec4 color)
{
    return color;
}

vec2 SLOT_pixel(vec2 pixel)
{
    return pixel;
}

int SLOT_channels()
{
    return 0;
}
