// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <osg/Vec2d>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Values of an elevation raster that are no heights, though its file does not declare them as no-data.

    Two kinds are plain. A single value is as far from all others as these are from each other, and 500 m at least: −9999,
    32767, 3.4e38. Between −500 and 9,000 m, where dry ground lies, it stands along the raster's border, too. Or one value fills all that lies around a turned quadrilateral, as a survey leaves it that was rotated or
    reprojected, and the heights begin with a step there. A coast is neither: its land has no four straight sides, and begins
    at the height of the sea. */
class UndeclaredVoids
{
public:
    /// None.
    UndeclaredVoids() = default;
    /** Looks at the first band of an elevation raster: at all of its pixels up to `most`, else at about as many, in blocks all
        over it. A warning for each file states the kinds found, once. Nothing is found in a raster that cannot be opened or
        read. Any thread may call it. */
    static UndeclaredVoids of(const std::string& file, double most = 8e6);

    bool isEmpty() const { return _values.empty() && !_around; }
    /// Whether a pixel of the band is no height; `value`: that of the file, before scale, offset and unit.
    bool has(double value, int column, int row) const;
    /// What stands for no data, as a clause; empty for none.
    std::string text() const;

private:
    /// Four corners, in the order in which they go around, pixels from the raster's corner.
    using Quadrilateral = std::array<osg::Vec2d, 4>;
    struct Look;
    struct Surroundings
    {
        double value = 0.0;
        Quadrilateral inside; ///< what lies nearer to a side than `margin`, or beyond, is around it
        double margin = 0.0;  ///< pixels
    };
    static std::optional<Quadrilateral> quadrilateralAround(std::vector<osg::Vec2d> points);
    static double depthIn(const Quadrilateral& area, const osg::Vec2d& place);

    std::vector<double> _values; ///< no heights wherever they stand
    std::optional<Surroundings> _around;
};

} // namespace osgGeoFX
