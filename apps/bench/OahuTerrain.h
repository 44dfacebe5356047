// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"
#include "WorkFolder.h"

namespace geofx::bench
{

/// The database to draw: what the settings name, or Oahu's, built in the work folder. Throws BenchError.
std::filesystem::path terrainToDraw(const Settings& settings, const WorkFolder& folder);

/// The database to draw: what the settings name, or that of the paper's 1621 x 1621 samples over Honolulu and the Koolau, in
/// small tiles, as a user would build it for a screen of so many pixels for each radian. Throws BenchError.
std::filesystem::path windowToDraw(const Settings& settings, const std::filesystem::path& folder,
                                   double pixelsPerRadian);

} // namespace geofx::bench
