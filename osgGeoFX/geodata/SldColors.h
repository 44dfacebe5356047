// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/raster/ColorTable.h>

#include <string>

namespace osgGeoFX
{

/** Reads the first ColorMap of an SLD file (OGC Styled Layer Descriptor, 1.0 and 1.1), as GeoServer and QGIS write them, as a color table.

    - `ramp`, the default, becomes LINEAR: below the first quantity its color stays, and above the last one that one's.
    - `intervals` becomes STEPS: a color holds below its quantity, down to the quantity before; at the last quantity and
      above, nothing is drawn. QGIS's last quantity is `inf`: that color holds above all others.
    - `values` becomes EXACT: a color holds at its quantity alone.

    An entry has `color` (#rrggbb), `quantity` and `opacity` (0…1, 1 if there is none). Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT SldColors
{
    /// Null, with a sentence in `error` that names file, line and remedy, if there is no color map, or if it cannot be used.
    static osg::ref_ptr<ColorTable> read(const std::string& file, std::string& error);
    /// Whether a file's name ends with `.sld` or `.xml`.
    static bool isSld(const std::string& file);
};

} // namespace osgGeoFX
