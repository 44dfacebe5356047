// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

namespace osgGeoFX
{

/// The state that all buildings of a town share.
struct TownState
{
    /// The name of the texture at unit 0.
    static constexpr const char* texture = "geofx windows";
};

} // namespace osgGeoFX
