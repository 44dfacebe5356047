// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// SunShadows in the vertex stage: the undeformed place, by which shadows are found. SLOT_ stands for the effect's prefix.
out vec3 SLOT_place; // in the view's eye space

void SLOT_locate(vec3 eyePosition)
{
    SLOT_place = eyePosition;
}
