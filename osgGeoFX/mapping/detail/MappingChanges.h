// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/mapping/detail/GpuStore.h>

#include <unordered_set>

namespace osgGeoFX
{

/// What has changed since the last commit: layers, tables and records tell each other and the GPU of it.
struct MappingChanges
{
    std::unordered_set<ProjectiveMapping*> mappings; ///< whose records are to be written anew
    /// Something was taken off: layers and mappings that were left out are tried again.
    bool roomMade = false;
    GpuStore::Commit uploads;
};

} // namespace osgGeoFX
