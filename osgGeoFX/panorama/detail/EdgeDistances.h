// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/// Distances from the middle of each cell of a square, `side` by `side`, to where marks begin or end. They are
/// positive outside of marks, in the unit of the cells' width and height.
std::vector<float> signedDistances(const std::vector<char>& marks, std::size_t side, double stepX,
                                   double stepY);

} // namespace osgGeoFX
