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

/// A place of the world before a panorama map deforms it, and the point of the picture where it appears (x, y: −1…1).
/// @ingroup panorama
struct PanoramaHold
{
    osg::Vec3d world;
    osg::Vec2d picture;
};

/** The pose of a panorama map's camera, as PanoramaManipulator moves it: the eye, a heading and a pitch, and the
    projection that sets the map's width. World coordinates and limits are those of PanoramaManipulator.
    @ingroup panorama */
class OSGGEOFX_EXPORT PanoramaPose
{
public:
    PanoramaPose(EffectScene& scene, PanoramaMap& map);

    /// Updates the terrain's frame and heights from the scene.
    void follow() { _ground = _scene->ground(); }
    void setProjection(const osg::Matrixd& projection) { _projection = projection; }

    /// From eye space to the world. setMatrix() drops the roll and clamps pitch and height to the limits.
    osg::Matrixd matrix() const;
    void setMatrix(const osg::Matrixd& matrix);

    /// Radians. The camera turns about the point below the eye.
    double heading() const { return _heading; }
    void setHeading(double radians) { _heading = radians; }
    double pitch() const { return _pitch; }
    void setPitch(double radians);
    /// Half the width of the ground at the picture's base, metres. The point below the eye stays.
    double radius() const;
    void setRadius(double metres);

    /// The middle of the picture, or the point at 70 % of the horizon's height if the middle is higher than that.
    osg::Vec2d middle() const;
    /// The ground at the map's base height that appears at a point of the picture; below the horizon if the point is
    /// sky.
    PanoramaHold holdOnBase(const osg::Vec2d& picture) const;
    /// The place that a camera with this pose shows there, such as a summit; ground at the base height if it shows
    /// none.
    PanoramaHold holdSeen(const osg::Vec2d& picture, const osg::Camera& camera) const;
    /// Moves the eye, at its height and heading, until the held place appears at its point of the picture. Returns
    /// false if that is impossible; the eye then stays. In a cylindrical map the eye moves towards the place or away from
    /// it, and turns.
    bool keep(const PanoramaHold& hold);
    /// Whether the map is cylindrical.
    bool isCylindrical() const { return _map->getHorizontalAngle() > 0.0; }
    /// The same as keep() for any place, and the middle of the picture.
    bool setCenter(const osg::Vec3d& world);

private:
    osg::Matrixd frame() const;
    osg::Vec3d up() const;
    osg::Matrixd toEye() const { return osg::Matrixd::inverse(matrix()); }
    std::optional<glsl::geofx_Panorama> panorama() const;
    std::optional<osg::Vec3d> pick(const osg::Vec2d& picture, const osg::Camera& camera) const;
    osg::Vec3d moved(const osg::Vec3d& step) const;
    bool keepAround(const PanoramaHold& hold);

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<PanoramaMap> _map;
    Ground _ground;
    osg::Matrixd _projection;
    osg::Vec3d _eye;
    double _heading = 0.0;
    double _pitch;
};

} // namespace osgGeoFX
