// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>
#include <osgGeoFX/mapping/detail/GpuStore.h>

#include <unordered_set>

namespace osgGeoFX
{

/// The changes since the last commit. Layers, tables and records tell each other and the GPU of them.
struct MappingChanges
{
    std::unordered_set<ProjectiveMapping*> mappings; ///< those whose records must be written anew
    /// Those whose layers have other pixels in the same place.
    std::unordered_set<ProjectiveMapping*> repainted;
    /// Room was made: layers and mappings that were left out are tried again.
    bool roomMade = false;
    GpuStore::Commit uploads;
};

} // namespace osgGeoFX
