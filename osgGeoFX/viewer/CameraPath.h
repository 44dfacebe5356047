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

/** A camera's way over the ground: view points at rising times, seconds, linearly interpolated.

    The file is CSV with the header `time,lon,lat,alt,heading,pitch[,roll]`, degrees and metres as in
    ViewPoint::parse; empty lines and lines that begin with # are skipped. */
class OSGGEOFX_EXPORT CameraPath
{
public:
    /// Nothing, with a sentence in `error` that names the file and the line, if the file is not such a path.
    static std::optional<CameraPath> read(const std::string& file, std::string& error);
    /// `name` stands for the file in messages.
    static std::optional<CameraPath> read(std::istream& stream, const std::string& name, std::string& error);

    double startTime() const { return _times.front(); }
    double endTime() const { return _times.back(); }

    /// At a time; before the start and after the end the first and the last point hold.
    ViewPoint at(double time) const;

    /// Time of one of `count` frames that divide the path evenly, the first at its start, the last at its end.
    double timeOfFrame(unsigned int frame, unsigned int count) const;

private:
    std::vector<double> _times;
    std::vector<ViewPoint> _points;
};

} // namespace osgGeoFX
