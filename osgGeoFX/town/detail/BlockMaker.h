// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>

#include <vector>

namespace osgGeoFX
{

/// What buildings are from afar: blocks that take in what stands close together, as high as its buildings are on average.
/// Towers stay by themselves. All buildings are in one frame. The same buildings give the same blocks.
std::vector<PlacedBuilding> makeBlocks(const std::vector<PlacedBuilding>& buildings);

/// A building with fewer corners: what departs from straight lines by less than `tolerance`, metres, is straight, and small
/// courtyards are closed.
PlacedBuilding simplified(const PlacedBuilding& building, double tolerance);

} // namespace osgGeoFX
