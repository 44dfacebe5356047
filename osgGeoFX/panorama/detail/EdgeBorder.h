// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/detail/EdgeExtent.h>

namespace osgGeoFX
{

/// What lies beyond the border of an extent, as the border itself tells.
class EdgeBorder
{
public:
    explicit EdgeBorder(const EdgeExtent& extent);

    /// Whether a cell outside the extent is sea. Columns and rows are those of the extent. The farther off the cell
    /// is, the more of the border decides, so bays close.
    bool sea(int column, int row) const;
    /// The share of the border that is sea.
    double share() const { return static_cast<double>(_sums[length]) / length; }

    /// The height of the land along the border, smoothed along the border and away from it, so that no single
    /// mountain shows; 0 without land. `distances`: to the end of the known ground, in cells.
    static std::vector<float> heights(const EdgeExtent& extent, const std::vector<float>& distances);

private:
    static constexpr int length = 4 * EdgeExtent::within;
    std::vector<int> _sums; ///< sums of the border's sea cells, three times around
};

} // namespace osgGeoFX
