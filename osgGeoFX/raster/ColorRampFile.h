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

/** Color tables as text files: those of `gdaldem color-relief`, and GMT's .cpt.

    A line of the first is `value red green blue [alpha]` or `value name [alpha]`, apart by spaces, tabs, commas or
    colons; parts of colours are 0…255; a value may be a percentage of the data's range; `nv` is no-data's; what follows
    # is a comment. Of two lines with one value, the colour jumps. A file is taken as .cpt by its name or by a comment with
    COLOR_MODEL, which must be RGB; its lines are `z0 colour z1 colour` with colours as R G B or R/G/B. Its colours
    B and F begin 1/512 of the table's range outside it, so that a row of 1024 texels has them. Thread-safe. */
class OSGGEOFX_EXPORT ColorRampFile
{
public:
    /// Lowest and highest value.
    using Range = std::pair<double, double>;

    /// The mode is LINEAR: the files do not tell. Null, with a sentence that names file, line and mend in `error`, for
    /// what cannot be read, and for percentages where the data's range is not given.
    static osg::ref_ptr<ColorTable> read(const std::string& path, const std::optional<Range>& rangeOfData,
                                         std::string& error);

    /// Text for gdaldem, with colours rounded to 1/255. STEPS are written as jumps; for NEAREST and EXACT a comment names
    /// gdaldem's option. False, with a sentence in `error`, for a table without stops and where writing fails.
    static bool write(const ColorTable& table, const std::string& path, std::string& error);
};

} // namespace osgGeoFX
