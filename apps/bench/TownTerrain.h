// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

#include <filesystem>

namespace geofx::bench
{

/** Oahu with a made-up town of 16,000 buildings below an aerial picture of 420 MB that is made up, too: the database that the
    settings name, if it has a town, or one that is built in `folder`. Throws BenchError. */
std::filesystem::path townToDraw(const Settings& settings, const std::filesystem::path& folder);

} // namespace geofx::bench
