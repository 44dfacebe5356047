// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/panorama/StrokeLines.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// Roads, rivers and towns of a panorama map from any vector data that GDAL opens.
struct OSGGEOFXDATA_EXPORT StrokeVectors
{
    /** Appends the lines of a file as ROAD or RIVER, or its areas as TOWN: of one layer, or of all where `layer` is empty.
        They are brought into degrees where the frame is a globe, else into its `wkt`, in metres; its origin does not
        count. Lines that only continue each other become one. What has no place there is left out.

        On failure `lines` stay as they are, and a sentence in `error` names file and mend; so too where nothing
        of the kind is in the file. Thread-safe. */
    static bool read(const std::string& file, const std::string& layer, StrokeLines::Kind kind,
                     const MappingFrame& frame, std::vector<StrokeLines::Line>& lines, std::string& error);
    /// Of the lines that read() appends for a frame.
    static StrokeLines::Units unitsOf(const MappingFrame& frame)
    {
        return frame.globe ? StrokeLines::DEGREES : StrokeLines::METRES;
    }
};

} // namespace osgGeoFX
