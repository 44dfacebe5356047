// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/CameraPath.h>

#include <algorithm>
#include <fstream>

namespace osgGeoFX
{

namespace
{

bool isBlank(const std::string& line)
{
    const std::size_t first = line.find_first_not_of(" \t");
    return first == std::string::npos || line[first] == '#';
}

std::string withoutSpaces(std::string text)
{
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t'; }),
               text.end());
    return text;
}

} // namespace

std::optional<CameraPath> CameraPath::read(const std::string& file, std::string& error)
{
    std::ifstream stream(file);
    if (!stream)
    {
        error = "The path \"" + file + "\" cannot be opened; check its name and permissions.";
        return std::nullopt;
    }
    return read(stream, file, error);
}

std::optional<CameraPath> CameraPath::read(std::istream& stream, const std::string& name, std::string& error)
{
    CameraPath path;
    std::size_t columns = 0;
    int lineNumber = 0;
    const auto fail = [&](const std::string& what)
    {
        error = "The path \"" + name + "\", line " + std::to_string(lineNumber) + ": " + what;
        return std::nullopt;
    };
    for (std::string line; std::getline(stream, line);)
    {
        ++lineNumber;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (isBlank(line)) continue;
        if (columns == 0)
        {
            const std::string header = withoutSpaces(line);
            columns = header == "time,lon,lat,alt,heading,pitch"        ? 6
                      : header == "time,lon,lat,alt,heading,pitch,roll" ? 7
                                                                        : 0;
            if (columns == 0) return fail("the header must be time,lon,lat,alt,heading,pitch[,roll].");
            continue;
        }
        std::optional<std::vector<double>> numbers = parseNumbers(line);
        if (!numbers || numbers->size() != columns)
        {
            return fail(std::to_string(columns) + " numbers are expected, as in the header.");
        }
        const double time = numbers->front();
        if (!path._times.empty() && time <= path._times.back())
        {
            return fail("the time must be later than that of the line before.");
        }
        numbers->erase(numbers->begin());
        std::string fault;
        const std::optional<ViewPoint> point = ViewPoint::fromNumbers(*numbers, fault);
        if (!point) return fail(fault);
        path._times.push_back(time);
        path._points.push_back(*point);
    }
    if (path._points.empty())
    {
        error = "The path \"" + name + "\" has no points; write a header and at least one line below it.";
        return std::nullopt;
    }
    return path;
}

ViewPoint CameraPath::at(double time) const
{
    const auto after = std::upper_bound(_times.begin(), _times.end(), time);
    if (after == _times.begin()) return _points.front();
    if (after == _times.end()) return _points.back();
    const std::size_t i = static_cast<std::size_t>(after - _times.begin());
    return interpolate(_points[i - 1], _points[i], (time - _times[i - 1]) / (_times[i] - _times[i - 1]));
}

double CameraPath::timeOfFrame(unsigned int frame, unsigned int count) const
{
    if (count < 2) return startTime();
    return startTime() +
           (endTime() - startTime()) * static_cast<double>(frame) / static_cast<double>(count - 1);
}

} // namespace osgGeoFX
