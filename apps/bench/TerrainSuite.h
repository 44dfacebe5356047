// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

#include <filesystem>
#include <string>
#include <vector>

namespace geofx::bench
{

/// Building a terrain database from rasters, and drawing it.
Suite terrainSuite();

/// Figures memory, linearity and threads: how osggeofx_build behaves on large sources. `folder` is for its
/// files.
std::vector<Figure> measureBuilding(const Settings& settings, const std::filesystem::path& folder);

/// Figures speed and outline of three views: the paged database against one mesh.
std::vector<Figure> measureDrawing(const Settings& settings, const std::filesystem::path& folder);

/// The command line of osggeofx_build; throws BenchError where there is none.
std::vector<std::string> builderCommand(const Settings& settings, const std::filesystem::path& dem,
                                        const std::filesystem::path& output, int threads,
                                        int memoryMiB = 512);

} // namespace geofx::bench
