// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

namespace osgGeoFX
{

/// data/geofx.xsd as it was when the plugin was built.
extern const char* const sceneSchema;

} // namespace osgGeoFX
