// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/ViewGeometry.h>

#include <cmath>

namespace osgGeoFX
{

ViewGeometry::ViewGeometry(const osg::Matrixd& modelView, const osg::Matrixd& projectionMatrix,
                           const Ground& theGround)
    : ground(theGround), projection(projectionMatrix)
{
    inverseProjection.invert(projection);
    osg::Matrixd toWorld;
    toWorld.invert(modelView);
    const osg::Vec3d eye = toWorld.getTrans();
    osg::Vec3d normal(0.0, 0.0, 1.0);
    eyeHeight = eye.z();
    if (ground.ellipsoid)
    {
        double latitude = 0.0;
        double longitude = 0.0;
        ground.ellipsoid->convertXYZToLatLongHeight(eye.x(), eye.y(), eye.z(), latitude, longitude,
                                                    eyeHeight);
        normal.set(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                   std::sin(latitude));
    }
    up = osg::Matrixd::transform3x3(normal, modelView);
    up.normalize();
    polarAxis = up;
    if (ground.ellipsoid)
    {
        polarAxis = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), modelView);
        polarAxis.normalize();
    }
}

void ViewGeometry::ray(double x, double y, osg::Vec3d& origin, osg::Vec3d& direction) const
{
    origin = osg::Vec3d(x, y, -1.0) * inverseProjection;
    direction = osg::Vec3d(x, y, 1.0) * inverseProjection - origin;
}

} // namespace osgGeoFX
