// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osg/Vec2d>

#include <optional>

namespace osgGeoFX
{

/// A place of the world, as it is before a panorama map deforms it, and the point of the picture where it appears, −1…1.
struct PanoramaHold
{
    osg::Vec3d world;
    osg::Vec2d picture;
};

/** Where the camera of a panorama map stands, as PanoramaManipulator moves it: the eye, a heading and a pitch, and the
    projection by which the map is as wide as it is. World and limits are those of PanoramaManipulator. */
class OSGGEOFX_EXPORT PanoramaPose
{
public:
    PanoramaPose(EffectScene& scene, PanoramaMap& map);

    /// Takes over what the scene's terrain may have become.
    void follow() { _ground = _scene->ground(); }
    void setProjection(const osg::Matrixd& projection) { _projection = projection; }

    /// From eye space to the world. A roll is lost, and what is beyond the limits.
    osg::Matrixd matrix() const;
    void setMatrix(const osg::Matrixd& matrix);

    /// Radians; about the eye's foot.
    double heading() const { return _heading; }
    void setHeading(double radians) { _heading = radians; }
    double pitch() const { return _pitch; }
    void setPitch(double radians);
    /// Half the width of the ground at the picture's base, metres; about the eye's foot.
    double radius() const;
    void setRadius(double metres);

    /// The picture's middle or, where that is sky, the middle of what is not.
    osg::Vec2d middle() const;
    /// Ground at the map's base height that appears there; below the horizon where that is sky.
    PanoramaHold holdOnBase(const osg::Vec2d& picture) const;
    /// What a camera, whose pose this is, shows there, such as a summit; ground at the base height where it shows none.
    PanoramaHold holdSeen(const osg::Vec2d& picture, const osg::Camera& camera) const;
    /// Moves the eye at its height, with its heading, until what is held appears where it is held. Where that cannot be, it stays,
    /// and this is false.
    bool keep(const PanoramaHold& hold);
    /// The same for a place that may be anywhere, in the picture's middle.
    bool setCentre(const osg::Vec3d& world);

private:
    osg::Matrixd frame() const;
    osg::Vec3d up() const;
    osg::Matrixd toEye() const { return osg::Matrixd::inverse(matrix()); }
    std::optional<glsl::geofx_Panorama> panorama() const;
    std::optional<osg::Vec3d> pick(const osg::Vec2d& picture, const osg::Camera& camera) const;
    osg::Vec3d moved(const osg::Vec3d& step) const;

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<PanoramaMap> _map;
    Ground _ground;
    osg::Matrixd _projection;
    osg::Vec3d _eye;
    double _heading = 0.0;
    double _pitch;
};

} // namespace osgGeoFX
