// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/ViewPoint.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace osgGeoFX
{

namespace
{

const double radians = osg::DegreesToRadians(1.0);

double alongShorterArc(double a, double b, double t)
{
    return a + t * std::remainder(b - a, 2.0 * osg::PI);
}

} // namespace

std::optional<std::vector<double>> parseNumbers(const std::string& text)
{
    std::vector<double> numbers;
    std::istringstream fields(text);
    std::string field;
    while (std::getline(fields, field, ','))
    {
        std::istringstream stream(field);
        // A user's locale must not decide what a decimal point is.
        stream.imbue(std::locale::classic());
        double number = 0.0;
        if (!(stream >> number) || !(stream >> std::ws).eof() || !std::isfinite(number))
        {
            return std::nullopt;
        }
        numbers.push_back(number);
    }
    if (!text.empty() && text.back() == ',')
    {
        return std::nullopt;
    }
    return numbers;
}

std::optional<ViewPoint> ViewPoint::fromNumbers(const std::vector<double>& numbers, std::string& error)
{
    if (numbers.size() != 5 && numbers.size() != 6)
    {
        error = "A view needs five or six numbers, LON,LAT,HEIGHT,HEADING,PITCH[,ROLL].";
        return std::nullopt;
    }
    if (std::abs(numbers[1]) > 90.0 || std::abs(numbers[4]) > 90.0)
    {
        error = std::string("The ") + (std::abs(numbers[1]) > 90.0 ? "latitude" : "pitch") +
                " of a view must lie between -90 and 90 degrees.";
        return std::nullopt;
    }
    ViewPoint point;
    point.longitude = numbers[0] * radians;
    point.latitude = numbers[1] * radians;
    point.height = numbers[2];
    point.heading = numbers[3] * radians;
    point.pitch = numbers[4] * radians;
    point.roll = numbers.size() == 6 ? numbers[5] * radians : 0.0;
    return point;
}

std::optional<ViewPoint> ViewPoint::parse(const std::string& text, std::string& error)
{
    const std::optional<std::vector<double>> numbers = parseNumbers(text);
    if (!numbers)
    {
        error =
            "\"" + text + "\" is not a view; write five or six numbers, LON,LAT,HEIGHT,HEADING,PITCH[,ROLL].";
        return std::nullopt;
    }
    return fromNumbers(*numbers, error);
}

bool ViewPoint::viewMatrix(const Georeference& reference, osg::Matrixd& view) const
{
    osg::Matrixd frame;
    if (!reference.localToWorld(longitude, latitude, height, frame))
    {
        return false;
    }
    const osg::Vec3d forward(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                             std::sin(pitch));
    const osg::Vec3d level(std::cos(heading), -std::sin(heading), 0.0);
    const osg::Vec3d zenith = level ^ forward;
    const osg::Vec3d right = level * std::cos(roll) - zenith * std::sin(roll);
    const osg::Vec3d up = zenith * std::cos(roll) + level * std::sin(roll);
    const osg::Matrixd camera(right.x(), right.y(), right.z(), 0.0, up.x(), up.y(), up.z(), 0.0, -forward.x(),
                              -forward.y(), -forward.z(), 0.0, 0.0, 0.0, 0.0, 1.0);
    view = osg::Matrixd::inverse(camera * frame);
    return true;
}

ViewPoint interpolate(const ViewPoint& a, const ViewPoint& b, double t)
{
    ViewPoint point;
    point.longitude = alongShorterArc(a.longitude, b.longitude, t);
    point.latitude = a.latitude + t * (b.latitude - a.latitude);
    point.height = a.height + t * (b.height - a.height);
    point.heading = alongShorterArc(a.heading, b.heading, t);
    point.pitch = a.pitch + t * (b.pitch - a.pitch);
    point.roll = alongShorterArc(a.roll, b.roll, t);
    return point;
}

osg::Matrixd viewOfPoints(const std::vector<osg::Vec3d>& points, const osg::Vec3d& center,
                          const Georeference* reference, double fieldOfView, double aspect)
{
    osg::Matrixd frame = osg::Matrixd::translate(center);
    // Near the Earth's own center, where a whole globe has its middle, no direction is up.
    if (reference && reference->isGeocentric() && center.length() > 1e6)
    {
        double longitude = 0.0;
        double latitude = 0.0;
        double height = 0.0;
        reference->toGeodetic(center, longitude, latitude, height);
        reference->localToWorld(longitude, latitude, height, frame);
    }
    const double elevation = osg::DegreesToRadians(35.0);
    const osg::Vec3d backwards(0.0, -std::cos(elevation), std::sin(elevation));
    const osg::Vec3d upwards(0.0, std::sin(elevation), std::cos(elevation));
    const osg::Matrixd toFrame = osg::Matrixd::inverse(frame);
    const double tanVertical = std::tan(fieldOfView / 2.0);
    const double tanHorizontal = tanVertical * aspect;
    double distance = 1e-3;
    for (const osg::Vec3d& point : points)
    {
        const osg::Vec3d p = point * toFrame;
        const double needed = std::max(std::abs(p.x()) / tanHorizontal, std::abs(p * upwards) / tanVertical);
        distance = std::max(distance, p * backwards + needed);
    }
    const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), frame);
    return osg::Matrixd::lookAt((backwards * (1.05 * distance)) * frame, center, up);
}

} // namespace osgGeoFX
