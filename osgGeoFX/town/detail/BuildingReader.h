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

/// A length in words, metres: "12", "12.5 m", "40 ft", "40'"; a number without a unit is in `unit`. Nothing if it is none.
std::optional<double> lengthInWords(const std::string& text, HeightUnit unit);

} // namespace osgGeoFX
