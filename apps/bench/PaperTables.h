// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

#include <filesystem>
#include <vector>

namespace geofx::bench
{

/** The tables of the paper on multi-perspective views: frames a second, and bytes read for each frame, along paths over a paged
    town with and without the deformation. `terrain`: the database. A file is written into `folder`. Throws BenchError. */
std::vector<Figure> measurePaperTables(const Settings& settings, const std::filesystem::path& terrain,
                                       const std::filesystem::path& folder);

} // namespace geofx::bench
