// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

namespace osgGeoFX
{

/// The schema of scene files: geofx.xsd.in with the properties of the classes (reference.cpp).
extern const char* const sceneSchema;

} // namespace osgGeoFX
