// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/raster/ColorTable.h>
#include <osgGeoFX/raster/RasterBands.h>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Reads the RasterSymbolizer of an SLD file (OGC Styled Layer Descriptor, 1.0 and 1.1), as GeoServer and QGIS write them. Its first ColorMap
    becomes a color table:

    - `ramp`, the default, becomes LINEAR: below the first quantity its color stays, and above the last one that one's.
    - `intervals` becomes STEPS: a color holds below its quantity, down to the quantity before; at the last quantity and
      above, nothing is drawn. QGIS's last quantity is `inf`: that color holds above all others.
    - `values` becomes EXACT: a color holds at its quantity alone.

    An entry has `color` (#rrggbb), `quantity` and `opacity` (0…1, 1 if there is none). The symbolizer's own Opacity counts, too.

    ChannelSelection names the bands of red, green and blue, or of grey; with a ColorMap, the band of grey has the values. The ContrastEnhancement
    Normalize with `minValue` and `maxValue` tells which numbers are black and white. Other enhancements, gamma and shaded relief are left out, with a
    notice. Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT SldColors
{
    osg::ref_ptr<ColorTable> table; ///< null without a ColorMap
    RasterBands bands;
    bool hasBands = false;            ///< whether there is a ChannelSelection or a range
    double opacity = 1.0;             ///< of what is shown without a table
    std::vector<std::string> notices; ///< on what is left out

    /// Nothing, with a sentence in `error` that names file, line and remedy, if there is neither a ColorMap nor a ChannelSelection, or if it cannot
    /// be used.
    static std::optional<SldColors> readAll(const std::string& file, std::string& error);
    /// The color table alone. Null, with a sentence in `error` that names file, line and remedy, if there is no color map, or if it cannot be used.
    static osg::ref_ptr<ColorTable> read(const std::string& file, std::string& error);
    /// Whether a file's name ends with `.sld` or `.xml`.
    static bool isSld(const std::string& file);
};

} // namespace osgGeoFX
