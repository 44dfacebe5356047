// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/TownBuilder.h>
#include <osgGeoFX/town/detail/Building.h>
#include <osgGeoFX/town/detail/TownFrame.h>

#include <functional>
#include <optional>
#include <string>

namespace osgGeoFX
{

/// Reads all buildings of a source, one after the other, and hands them out in the grid's coordinates: valid outlines, heights
/// in metres. What cannot be used is counted in the summary. `wkt` is the grid's coordinate system. Throws BuildError.
void readBuildings(const TownOptions& options, const TownGrid& grid, const std::string& wkt,
                   TownSummary& summary, const TownProgress& progress,
                   const std::function<void(Building&&)>& take);

} // namespace osgGeoFX
