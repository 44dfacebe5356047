// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/CellMask.h>

#include <functional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Where the cells of a mask lie; row 0 is the southernmost.
struct CellMetres
{
    std::vector<double> x;    ///< by row: from cell to cell to the east, metres
    std::vector<double> y;    ///< by row: place to the north, metres, rising
    bool wholeCircle = false; ///< the last column lies on the first
};

/** Distances from the shore in metres, over water; negative over land; ±1,000 km where there is no shore.

    Exact between the centers of cells on a plane with the metres of each row (Felzenszwalb and Huttenlocher: Distance
    transforms of sampled functions, 2012), less half a cell: the shore lies between the centers. `visit` gets all
    rows, from the northernmost on. `workFile` takes two bytes for each cell. Up to 65,535 rows. Throws BuildError. */
void findShoreDistances(const CellMask& water, const CellMetres& metres, const std::string& workFile,
                        const std::function<void(int row, const std::vector<float>& distances)>& visit);

} // namespace osgGeoFX
