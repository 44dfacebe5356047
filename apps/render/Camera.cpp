// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "render/Camera.h"

#include <osg/Math>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace geofx::render
{

namespace
{

constexpr double mostFrames = 1e6;

using Fault = std::runtime_error;

osg::Vec3d vectorOf(const std::string& option, const std::string& text)
{
    const auto numbers = osgGeoFX::parseNumbers(text);
    if (!numbers || numbers->size() != 3) throw Fault(option + " " + text + ": write three numbers, X,Y,Z.");
    return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

/// A path that a viewer of OpenSceneGraph's has recorded: time, position and rotation in each line.
osg::ref_ptr<osg::AnimationPath> readAnimation(const std::string& file)
{
    std::ifstream stream(file);
    if (!stream) throw Fault("The path \"" + file + "\" cannot be opened; check its name and permissions.");
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    // As a viewer would go from the last point to the first one.
    path->setLoopMode(osg::AnimationPath::NO_LOOPING);
    int number = 0;
    for (std::string line; std::getline(stream, line);)
    {
        ++number;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.find_first_not_of(" \t") == std::string::npos) continue;
        std::string numbers = std::regex_replace(line, std::regex("^[ \t]+|[ \t]+$"), "");
        numbers = std::regex_replace(numbers, std::regex("[ \t]+"), ",");
        const auto values = osgGeoFX::parseNumbers(numbers);
        if (!values || values->size() != 8)
            throw Fault("The path \"" + file + "\", line " + std::to_string(number) +
                        ": eight numbers are expected, as viewers record them: time, position, rotation.");
        const std::vector<double>& v = *values;
        if (!path->empty() && v[0] <= path->getLastTime())
            throw Fault("The path \"" + file + "\", line " + std::to_string(number) +
                        ": the time must be later than that of the line before.");
        path->insert(v[0], osg::AnimationPath::ControlPoint(osg::Vec3d(v[1], v[2], v[3]),
                                                            osg::Quat(v[4], v[5], v[6], v[7])));
    }
    if (path->empty()) throw Fault("The path \"" + file + "\" has no points; record another one.");
    return path;
}

unsigned int numberOf(const std::string& text)
{
    // The pattern has seen to it that it is a number.
    return static_cast<unsigned int>(std::min(std::stod(text), mostFrames + 1.0));
}

} // namespace

Camera::Camera(const CameraOptions& options, const osgGeoFX::Scene& scene, double fieldOfView, double aspect)
    : _scene(scene)
{
    std::string error;
    if (!options.path.empty())
    {
        readPath(options);
        countFrames(options);
    }
    else if (!options.view.empty())
    {
        const auto point = osgGeoFX::ViewPoint::parse(options.view, error);
        if (!point) throw Fault("--view: " + error);
        requireReference("--view");
        _single = matrixOf(*point);
    }
    else if (!options.eye.empty())
        lookAt(options);
    else
    {
        if (scene.settings.homeView) requireReference("The scene's home view");
        _single = scene.homeViewMatrix(osg::DegreesToRadians(fieldOfView), aspect);
    }
}

void Camera::readPath(const CameraOptions& options)
{
    if (osgDB::getLowerCaseFileExtension(options.path) == "path")
    {
        _animation = readAnimation(options.path);
        _start = _animation->getFirstTime();
        _end = _animation->getLastTime();
        return;
    }
    std::string error;
    _path = osgGeoFX::CameraPath::read(options.path, error);
    if (!_path) throw Fault(error);
    requireReference("--path");
    _start = _path->startTime();
    _end = _path->endTime();
}

void Camera::countFrames(const CameraOptions& options)
{
    std::smatch parts;
    const bool part =
        std::regex_match(options.frames, parts, std::regex("([0-9]+)-([0-9]+)")); // else a number, or nothing
    if (!part && !options.frames.empty() && !std::regex_match(options.frames, std::regex("[0-9]+")))
        throw Fault("--frames " + options.frames + ": write a number, or the first and the last one: 0-99.");
    double count = 0.0;
    if (options.framesASecond > 0.0)
    {
        if (!part && !options.frames.empty())
            throw Fault("--frames " + options.frames +
                        ": with --fps, the path has a number of its own; take a part of it, such as 0-99, or "
                        "leave --fps out.");
        // A path's end is a picture, too, where rounding puts it a little too late.
        count = std::floor((_end - _start) * options.framesASecond + 1e-6) + 1.0;
    }
    else
    {
        if (part)
            throw Fault("--frames " + options.frames + ": say how many there are in a second, with --fps.");
        count = numberOf(options.frames);
    }
    if (count < 1.0 || count > mostFrames)
        throw Fault("--frames: a path has 1 to 1000000 pictures, not " +
                    std::to_string(static_cast<long long>(std::min(count, 1e15))) + ".");
    _framesASecond = options.framesASecond;
    _count = static_cast<unsigned int>(count);
    _last = _count - 1;
    if (!part) return;
    const unsigned int first = numberOf(parts[1]), last = numberOf(parts[2]);
    if (first > last || last > _last)
        throw Fault("--frames " + options.frames + ": the path has the pictures 0 to " +
                    std::to_string(_last) + "; name the first one first.");
    _first = first;
    _last = last;
}

double Camera::time(unsigned int frame) const
{
    if (_framesASecond > 0.0) return std::min(_start + frame / _framesASecond, _end);
    return _count < 2 ? _start : _start + (_end - _start) * frame / (_count - 1.0);
}

osg::Matrixd Camera::view(unsigned int frame) const
{
    if (_path) return matrixOf(_path->at(time(frame)));
    if (!_animation) return _single;
    osg::AnimationPath::ControlPoint point;
    _animation->getInterpolatedControlPoint(time(frame), point);
    osg::Matrixd view;
    point.getInverse(view);
    return view;
}

void Camera::requireReference(const std::string& what) const
{
    if (!_scene.reference) throw Fault(what + " cannot be used: " + _scene.referenceError);
}

osg::Matrixd Camera::matrixOf(const osgGeoFX::ViewPoint& point) const
{
    osg::Matrixd view;
    if (!point.viewMatrix(*_scene.reference, view))
        throw Fault("The camera's longitude and latitude lie outside the scene's projection; move it nearer "
                    "to the terrain.");
    return view;
}

void Camera::lookAt(const CameraOptions& options)
{
    const osg::Vec3d eye = vectorOf("--eye", options.eye);
    const osg::Vec3d look = vectorOf("--look", options.look);
    osg::Vec3d up = options.up.empty() ? osg::Vec3d(0.0, 0.0, 1.0) : vectorOf("--up", options.up);
    if (options.up.empty() && _scene.reference && _scene.reference->isGeocentric()) up = eye;
    if (((look - eye) ^ up).length2() == 0.0)
        throw Fault("--eye, --look and --up do not make a camera: it must not look along its upward "
                    "direction; give another --up.");
    _single = osg::Matrixd::lookAt(eye, look, up);
}

} // namespace geofx::render
