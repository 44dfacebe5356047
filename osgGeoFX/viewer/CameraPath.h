// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <istream>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The path of a camera over the ground: view points at increasing times, seconds, with linear interpolation between
    them.

    The file is CSV with the header `time,lon,lat,alt,heading,pitch[,roll]`, in degrees and metres as in
    ViewPoint::parse. Empty lines and lines that begin with # are skipped.
    @ingroup viewer */
class OSGGEOFX_EXPORT CameraPath
{
public:
    /// Returns nothing, with a sentence in `error` that names the file and the line, if the file is not a valid path.
    static std::optional<CameraPath> read(const std::string& file, std::string& error);
    /// `name` stands for the file in messages.
    static std::optional<CameraPath> read(std::istream& stream, const std::string& name, std::string& error);

    double startTime() const { return _times.front(); }
    double endTime() const { return _times.back(); }

    /// The view point at a time. Before the start it is the first point, after the end the last point.
    ViewPoint at(double time) const;

    /// The time of one of `count` frames at equal intervals: frame 0 at the start, the last frame at the end.
    double timeOfFrame(unsigned int frame, unsigned int count) const;

private:
    std::vector<double> _times;
    std::vector<ViewPoint> _points;
};

} // namespace osgGeoFX
