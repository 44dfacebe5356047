// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What changes in a panorama map from the picture's base to its horizon. u is the distance from the base over that of
// the horizon: 0 at the base, 1 at the horizon.
#ifndef __cplusplus
#include "lib/types.glsl"
#endif

// Of the picture's y for each metre of height: `lift` at the base, `growth` more at the horizon and beyond.
GEOFX_INLINE PerMetre geofx_profileLift(PerMetre lift, PerMetre growth, Number u)
{
    Number t = clamp(u, Number(0), Number(1));
    return lift + growth * t * t * (3 - 2 * t);
}
