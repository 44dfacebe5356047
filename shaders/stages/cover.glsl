// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What lies on the ground, of the tiles (lib/cover.glsl): one declaration for all effects that look at it.
uniform sampler2D geofx_cover;
