// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/CellMask.h>

#include <functional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// The places of a mask's cells. Row 0 is the southernmost.
struct CellMetres
{
    std::vector<double> x;    ///< by row: from cell to cell to the east, metres
    std::vector<double> y;    ///< by row: place to the north, metres, rising
    bool wholeCircle = false; ///< the last column lies on the first
};

/** Distances from the shore in metres, over water. They are negative over land, and ±1,000 km without a shore.

    They are exact between the centers of cells, on a plane with the metres of each row (Felzenszwalb and
    Huttenlocher: Distance transforms of sampled functions, 2012), less half a cell, since the shore lies between
    centers. `visit` gets all rows, the northernmost first. A temporary file beside
    `workFile` takes two bytes for each cell. At most 65,535
    rows. Throws BuildError. */
void findShoreDistances(const CellMask& water, const CellMetres& metres, const std::string& workFile,
                        const std::function<void(int row, const std::vector<float>& distances)>& visit);

} // namespace osgGeoFX
