// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

namespace osgGeoFX
{

/// The radius of a sphere within all ground that is ever drawn of a globe, as a share of the globe's polar radius. On the Earth that is
/// 64 km below the poles: deep seas and the triangles of coarse meshes, where they are drawn, stay outside.
constexpr double INNER_SHARE = 0.99;

} // namespace osgGeoFX
