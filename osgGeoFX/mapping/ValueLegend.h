// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/raster/ColorTable.h>

#include <osg/Group>
#include <osg/Vec2d>
#include <osgText/Font>

#include <map>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// The texts, sizes and colors of a legend. Sizes are in pixels. Colors are sRGB-coded, 0…1.
/// @ingroup mapping
struct LegendStyle
{
    std::string title; ///< in UTF-8, like all texts
    std::string unit;  ///< follows the title
    double width = 300.0;
    double barHeight = 16.0;
    double textSize = 14.0;
    osg::ref_ptr<osgText::Font> font; ///< null: OSG's own font
    osg::Vec4 textColor = {0.1f, 0.1f, 0.1f, 1.0f};
    osg::Vec4 background = {1.0f, 1.0f, 1.0f, 0.85f};
    int mostTicks = 6; ///< largest number of ticks
    /// Texts in place of numbers, for instance the names of classes.
    std::map<double, std::string> names;
};

/** Round numbers from low to high, in steps of 1, 2 or 5 times a power of ten. There are at most `most` of them, and
    at least two if the range allows it. The result is empty if low is not less than high. */
OSGGEOFX_EXPORT std::vector<double> roundTicks(double low, double high, int most);
/// The text of a tick, with as many digits as it needs to differ from ticks `step` away.
OSGGEOFX_EXPORT std::string tickText(double value, double step);

/** Makes a legend for a table's colors from low to high. A program puts it into a camera whose unit is the pixel. The
    legend has a title with a unit, a bar with the map's own colors on a checkered ground (which shows opacity), and
    ticks at round numbers. For a table of the mode EXACT it instead has a named field for each stop from low to high,
    one below the other.

    The lower left corner lies at the origin, x points to the right and y up. The user values "width" and "height"
    (double) give its size in pixels. The result is null, with a warning, if low is not less than high or if a size is
    not within 1…10000. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Group> makeLegend(const ColorTable& colors, double low, double high,
                                                    const LegendStyle& style);

} // namespace osgGeoFX
