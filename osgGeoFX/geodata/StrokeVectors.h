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

/// Reads roads, rivers and towns of a panorama map (StrokeLines) from any vector data that GDAL opens.
/// @ingroup geodata
struct OSGGEOFXDATA_EXPORT StrokeVectors
{
    /** Appends the lines of a file as ROAD or RIVER, or its areas as TOWN. It reads one layer, or all layers if
        `layer` is empty. If the frame is a globe, the points become degrees; else they become metres in the frame's
        `wkt`. The frame's origin has no effect. Lines that merely continue each other are joined. Parts without a
        valid position are left out.

        If it fails, or if the file has nothing of that kind, `lines` stays unchanged and a sentence in `error` names
        file and remedy. Thread-safe. */
    static bool read(const std::string& file, const std::string& layer, StrokeLines::Kind kind,
                     const MappingFrame& frame, std::vector<StrokeLines::Line>& lines, std::string& error);
    /// The units of the lines that read() appends for a frame.
    static StrokeLines::Units unitsOf(const MappingFrame& frame)
    {
        return frame.globe ? StrokeLines::DEGREES : StrokeLines::METRES;
    }
};

} // namespace osgGeoFX
