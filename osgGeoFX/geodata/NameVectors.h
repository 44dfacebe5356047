// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/labels/MapName.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// Reads the names of a map from any vector data that GDAL opens.
/// @ingroup geodata
struct OSGGEOFXDATA_EXPORT NameVectors
{
    struct Options
    {
        std::string layer; ///< one layer; empty: all that have names
        /// The fields of a feature, in upper or lower case, or tags among OpenStreetMap's further ones (`other_tags`); empty: the first one that the
        /// feature has of name, label and title; of importance, rank_score and prominence; of ele, elevation and height; of style, natural,
        /// place, water, waterway and class.
        std::string name, importance, height, style;
    };

    /** Appends the names of a file's points, and of its lines and areas as names along a curve: lines as they are, areas along their
        longer axis. Each part of a multipart feature bears the name once; of lines and areas only the longest part does. Features without a
        name, without a geometry, or without a place in the frame are left out.

        Places are degrees of longitude and latitude if the frame is a globe, else metres in the frame's `wkt`; the third coordinate is the
        height, metres, from the field or the geometry, or not a number. NamePlacement makes them world coordinates. A field
        that is not a number counts as missing. A height may have a unit: "2,014 ft", "2 014 m".

        If it fails, or if the file has no name, `names` stays unchanged and a sentence in `error` names file and remedy. Thread-safe. */
    static bool read(const std::string& file, const Options& options, const MappingFrame& frame,
                     std::vector<MapName>& names, std::string& error);
};

} // namespace osgGeoFX
