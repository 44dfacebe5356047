// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The painting of panorama maps, after Sections 3.2, 3.4 and 3.5 of Brown and Samavati (2017).
#ifndef __cplusplus
#include "lib/types.glsl"
#include "lib/cover.glsl"
#endif
