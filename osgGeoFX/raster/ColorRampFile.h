// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/raster/ColorTable.h>

#include <optional>
#include <string>
#include <utility>

namespace osgGeoFX
{

/** Reads and writes color tables as text files, in the formats of `gdaldem color-relief`, GRASS (r.colors), QGIS (an
    exported color map) and GMT (.cpt). Thread-safe.

    A line of the gdaldem format is `value red green blue [alpha]` or `value name [alpha]`.
    - Spaces, tabs, commas or colons separate the words.
    - Parts of colors are 0…255. Colors may be names of gdaldem, names of X11, or #rrggbb.
    - A value may be a percentage of the range of the data.
    - `nv` stands for the no-data value, `default` for values outside the table.
    - A comment begins with #.
    - If two lines have the same value, the color jumps there. Lines may ascend or descend.
    - QGIS's line `INTERPOLATION:` may be INTERPOLATED, EXACT or DISCRETE. In DISCRETE, a color reaches up to its value
      and 1/512 of the table's range beyond. Values above the last one are transparent.

    A file is read as .cpt if its name ends so, or if a comment contains COLOR_MODEL, which must be RGB. Its lines
    are `z0 color z1 color`, ascending or descending, with colors as R G B, R/G/B, a name of X11 or #rrggbb. Lines
    `value color` are classes. Its colors B (below) and F (above) begin 1/512 of the table's range outside the range, so
    that a row of 1024 texels contains them. N is the no-data color.

    @ingroup raster */
class OSGGEOFX_EXPORT ColorRampFile
{
public:
    /// Lowest and highest value.
    using Range = std::pair<double, double>;

    /// Reads a table. Its mode is EXACT if the file has classes, STEPS if it is DISCRETE, else LINEAR, because other files do
    /// not state the mode. Null, with a sentence in `error` that names file, line and remedy, if the file cannot be read, or
    /// if it has percentages and `rangeOfData` is empty.
    static osg::ref_ptr<ColorTable> read(const std::string& path, const std::optional<Range>& rangeOfData,
                                         std::string& error);

    /// Writes text for gdaldem, with colors rounded to 1/255. STEPS become jumps. For NEAREST and EXACT, a comment
    /// names the option of gdaldem. False, with a sentence in `error`, if the table has no stops or if writing fails.
    static bool write(const ColorTable& table, const std::string& path, std::string& error);
};

} // namespace osgGeoFX
