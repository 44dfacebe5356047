// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Strokes have their colour from their own stage. SLOT_ stands for the effect's prefix.
vec4 SLOT_finish(vec4 colour)
{
    return colour;
}

int SLOT_channels()
{
    return 0;
}
