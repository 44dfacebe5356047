// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The projection of panorama maps, after Section 3.1 of Brown and Samavati (2017).
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/exaggeration.glsl"
#endif
