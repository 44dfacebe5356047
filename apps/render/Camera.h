// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/viewer/CameraPath.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/AnimationPath>
#include <osg/Matrixd>

#include <optional>
#include <string>

/// The cameras of osggeofx_render.
namespace geofx::render
{

/// What is said of the camera, as it is written.
struct CameraOptions
{
    std::string view;         ///< LON,LAT,HEIGHT,HEADING,PITCH[,ROLL], or
    std::string eye, look;    ///< X,Y,Z of the world
    std::string up;           ///< empty for away from the ground
    std::string path;         ///< a file, FILE.csv or FILE.path
    std::string frames;       ///< N pictures along the path, or those from A to B: A-B
    double framesASecond = 0; ///< 0: not said
};

/// One view matrix for each picture, and its time. All of it throws std::runtime_error with a sentence.
class Camera
{
public:
    /// `fieldOfView`: vertical, degrees. `aspect`: the picture's width over its height.
    Camera(const CameraOptions& options, const osgGeoFX::Scene& scene, double fieldOfView, double aspect);

    /// The numbers of the pictures.
    unsigned int first() const { return _first; }
    unsigned int last() const { return _last; }
    /// What a picture shows follows from its number alone.
    double time(unsigned int frame) const;
    osg::Matrixd view(unsigned int frame) const;

private:
    void readPath(const CameraOptions& options);
    void countFrames(const CameraOptions& options);
    void lookAt(const CameraOptions& options);
    void requireReference(const std::string& what) const;
    osg::Matrixd matrixOf(const osgGeoFX::ViewPoint& point) const;

    const osgGeoFX::Scene& _scene;
    std::optional<osgGeoFX::CameraPath> _path;   ///< over the ground, or
    osg::ref_ptr<osg::AnimationPath> _animation; ///< in the world
    osg::Matrixd _single;                        ///< without a path
    double _start = 0.0, _end = 0.0;             ///< seconds
    double _framesASecond = 0.0;                 ///< 0: evenly from the start to the end
    unsigned int _count = 1;                     ///< of the whole path
    unsigned int _first = 0, _last = 0;
};

} // namespace geofx::render
