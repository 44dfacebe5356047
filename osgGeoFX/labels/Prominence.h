// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/// Heights on a raster, for computeSummits(). Rows count from the south.
/// @ingroup labels
struct HeightField
{
    int columns = 0;
    int rows = 0;
    std::vector<float> heights; ///< metres, row by row; not a number where there is no ground
    /// Whether the eastern border continues at the western one, as on a raster of the whole Earth.
    bool wraps = false;
};

/// A summit: a cell, or a plateau of cells of one height, that has no higher neighbor.
/// @ingroup labels
struct Summit
{
    int column = 0; ///< of the plateau's first cell
    int row = 0;
    float height = 0.0f;
    /// The topographic prominence, metres: how far one must descend at least on the way to higher ground. Of the highest summit of
    /// connected ground: its height above the lowest ground there.
    float prominence = 0.0f;
};

/** The summits of a raster whose prominence is at least `least`, metres; the most prominent one first. Summits of equal
    prominence are in the order of their cells.

    All eight neighbors of a cell count. Cells without ground separate. A pass is as high as its highest way's lowest cell, so
    the result equals that of flooding. It takes time n log n and 16 bytes for each cell. Thread-safe.
    @ingroup labels */
OSGGEOFXMAPS_EXPORT std::vector<Summit> computeSummits(const HeightField& field, float least);

} // namespace osgGeoFX
