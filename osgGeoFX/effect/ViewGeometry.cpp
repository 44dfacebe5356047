// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osgGeoFX/effect/DepthConvention.h>

#include <osg/Vec2d>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// The normal of the ellipsoid below a place, and the height above it. Bowring's formula without the angles: every camera
/// asks in every frame.
osg::Vec3d normalBelow(const osg::EllipsoidModel& ellipsoid, const osg::Vec3d& place, double& height)
{
    const double a = ellipsoid.getRadiusEquator();
    const double b = ellipsoid.getRadiusPolar();
    const double share = 1.0 - b * b / (a * a); // e²
    const double across = std::sqrt(place.x() * place.x() + place.y() * place.y());
    // The parametric latitude, then the geodetic one.
    osg::Vec2d parametric(across * b, place.z() * a);
    if (parametric.normalize() == 0.0) parametric.set(0.0, 1.0);
    const double cosine = parametric.x();
    const double sine = parametric.y();
    osg::Vec2d geodetic(std::max(0.0, across - share * a * cosine * cosine * cosine),
                        place.z() + (a * a / b - b) * sine * sine * sine);
    if (geodetic.normalize() == 0.0) geodetic.set(0.0, 1.0);
    height = across * geodetic.x() + place.z() * geodetic.y() -
             a * std::sqrt(1.0 - share * geodetic.y() * geodetic.y());
    const double outward = across > 0.0 ? geodetic.x() / across : 0.0;
    return {place.x() * outward, place.y() * outward, geodetic.y()};
}

} // namespace

ViewGeometry::ViewGeometry(const osg::Matrixd& modelViewMatrix, const osg::Matrixd& projectionMatrix,
                           const Ground& theGround)
    : ground(theGround), modelView(modelViewMatrix), projection(projectionMatrix)
{
    image.projection = projection;
    inverseProjection.invert(projection);
    osg::Matrixd toWorld;
    toWorld.invert(modelView);
    const osg::Vec3d eye = toWorld.getTrans();
    osg::Vec3d normal(0.0, 0.0, 1.0);
    eyeHeight = eye.z();
    if (ground.ellipsoid) normal = normalBelow(*ground.ellipsoid, eye, eyeHeight);
    up = osg::Matrixd::transform3x3(normal, modelView);
    up.normalize();
    polarAxis = up;
    if (ground.ellipsoid)
    {
        polarAxis = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), modelView);
        polarAxis.normalize();
    }
}

void ViewGeometry::setImage(const osg::Matrixd& cameraModelView, const osg::Matrixd& cameraProjection)
{
    image.ofView = false;
    image.projection = cameraProjection;
    image.toEye.makeIdentity();
    image.toView.makeIdentity();
    // A part of the picture from the same eye gets the same positions, to the last bit.
    if (cameraModelView == modelView) return;
    image.toEye = osg::Matrixd::inverse(modelView) * cameraModelView;
    image.toView = osg::Matrixd::inverse(cameraModelView) * modelView;
}

void ViewGeometry::picturePart(osg::Vec2d& low, osg::Vec2d& high) const
{
    low.set(-1.0, -1.0);
    high.set(1.0, 1.0);
    if (image.ofView) return;
    const osg::Matrixd toPicture = osg::Matrixd::inverse(image.projection) * image.toView * projection;
    // The far plane stands for infinity. A reversed depth there may be 0 or −1; infinity itself has one depth.
    double farthest = 1.0;
    if (CameraDepth::reverses(image.projection))
        farthest = image.projection(3, 3) == 0.0 ? -image.projection(2, 2) : 0.0;
    const osg::Vec4d first = osg::Vec4d(-1.0, -1.0, farthest, 1.0) * toPicture;
    const osg::Vec4d last = osg::Vec4d(1.0, 1.0, farthest, 1.0) * toPicture;
    if (!(first.w() > 0.0) || !(last.w() > 0.0)) return;
    const osg::Vec2d from(first.x() / first.w(), first.y() / first.w());
    const osg::Vec2d to(last.x() / last.w(), last.y() / last.w());
    if (!(from.x() < to.x()) || !(from.y() < to.y())) return;
    low = from;
    high = to;
}

void ViewGeometry::ray(double x, double y, osg::Vec3d& origin, osg::Vec3d& direction) const
{
    ray(projection, inverseProjection, x, y, origin, direction);
}

void ViewGeometry::ray(const osg::Matrixd& projection, const osg::Matrixd& inverse, double x, double y,
                       osg::Vec3d& origin, osg::Vec3d& direction)
{
    if (!CameraDepth::reverses(projection))
    {
        origin = osg::Vec3d(x, y, -1.0) * inverse;
        const osg::Vec4d last = osg::Vec4d(x, y, 1.0, 1.0) * inverse;
        const osg::Vec3d along(last.x(), last.y(), last.z());
        // The far plane may be at infinity, and a little beyond.
        direction = last.w() > 0.0 ? osg::Vec3d(x, y, 1.0) * inverse - origin : along - origin * last.w();
        return;
    }
    // The far plane may be anywhere, and at infinity.
    origin = osg::Vec3d(x, y, 1.0) * inverse;
    direction = projection(3, 3) == 0.0 ? origin : osg::Vec3d(x, y, -1.0) * inverse - origin;
}

} // namespace osgGeoFX
