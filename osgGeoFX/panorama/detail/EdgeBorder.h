// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/detail/EdgeExtent.h>

namespace osgGeoFX
{

/// What lies beyond the border of an extent, by what it is along it.
class EdgeBorder
{
public:
    explicit EdgeBorder(const EdgeExtent& extent);

    /// Of a cell outside of the extent, in cells of it: the farther off, the more of the border says what is there, so that a bay
    /// closes.
    bool sea(int column, int row) const;
    /// The share of it that is sea.
    double share() const { return static_cast<double>(_sums[length]) / length; }

    /// How high the land along the border lies, smoothed along it and in the same way away from it, so that it tells of none of its
    /// mountains; 0 where there is none. `distances`: to where what is known ends, in cells.
    static std::vector<float> heights(const EdgeExtent& extent, const std::vector<float>& distances);

private:
    static constexpr int length = 4 * EdgeExtent::within;
    std::vector<int> _sums; ///< of the border's cells that are sea, three times around
};

} // namespace osgGeoFX
