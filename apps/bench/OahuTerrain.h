// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"
#include "WorkFolder.h"

namespace geofx::bench
{

/// The database to draw: what the settings name, or Oahu's, built in the work folder. Throws BenchError.
std::filesystem::path terrainToDraw(const Settings& settings, const WorkFolder& folder);

} // namespace geofx::bench
