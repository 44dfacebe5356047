// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/lines/MapLine.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// Reads the lines of a map from any vector data that GDAL opens.
/// @ingroup geodata
struct OSGGEOFXDATA_EXPORT LineVectors
{
    struct Options
    {
        std::string layer; ///< one layer; empty: all that have lines or areas
        /// The field that names a line's style, or a tag among OpenStreetMap's further ones (`other_tags`). Empty: of style, highway, railway,
        /// aerialway, piste:type, waterway, route, boundary, natural, fclass, class, kind and type the first one that the feature has.
        std::string style;
    };

    /** Appends the lines of a file, and the borders of its areas. Parts of a multipart feature are lines of their own. Features without
        a geometry or without a place in the frame are left out; so are the parts of a line that have none.

        Places are degrees of longitude and latitude if the frame is a globe, else metres in the frame's `wkt`; the third
        coordinate is 0.

        If it fails, or if the file has no line, `lines` stays unchanged and a sentence in `error` names file and remedy. Thread-safe. */
    static bool read(const std::string& file, const Options& options, const MappingFrame& frame,
                     std::vector<MapLine>& lines, std::string& error);
};

} // namespace osgGeoFX
