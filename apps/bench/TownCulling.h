// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

#include <filesystem>
#include <vector>

namespace geofx::bench
{

/// How long culling a town takes, against OSG's own for the same drawables. `terrain`: the database. Throws BenchError.
std::vector<Figure> measureTownCulling(const Settings& settings, const std::filesystem::path& terrain);

} // namespace geofx::bench
