// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

#include <filesystem>
#include <vector>

namespace geofx::bench
{

/// What the shadows of the sun cost in the middle of the paper's paths over a town. `terrain`: the database. Throws BenchError.
std::vector<Figure> measureTownShadows(const Settings& settings, const std::filesystem::path& terrain);

} // namespace geofx::bench
