// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/detail/RasterSource.h>

#include <osg/Vec2d>

#include <functional>
#include <vector>

namespace osgGeoFX
{

/** How much heights of a layer count where coarser ones lie below: 0 at the end of the layer's data and at the border of
    its voids, 1 from the width of the blend on.

    It looks at the data on a lattice, a sixth of the width from point to point. So voids that are smaller leave no
    trace. Reading is thread-safe. */
class BlendMask
{
public:
    /// In the grid's CRS.
    struct Area
    {
        double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
    };
    /// Heights on a lattice, NaN for none.
    using Heights = std::function<std::vector<float>(const Lattice&)>;

    BlendMask(const Area& area, const osg::Vec2d& width, const Heights& heights);

    /// The share at a place of the grid, 0…1.
    double share(double x, double y) const;

private:
    Lattice _lattice;
    std::vector<float> _shares;
};

} // namespace osgGeoFX
