// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/detail/HorizonClamp.h>

#include <osg/CoordinateSystemNode>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// How far the horizon is from a height, metres.
double horizon(double height)
{
    const double above = std::max(height, 0.0);
    return std::sqrt(above * (2.0 * osg::WGS_84_RADIUS_EQUATOR + above));
}

bool deforms(const EffectScene& scene)
{
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        if (scene.getEffect(i)->isActive() && scene.getEffect(i)->asDeformation()) return true;
    }
    return false;
}

} // namespace

HorizonClamp::HorizonClamp(const osg::Camera& camera, const EffectScene& effects, double highest)
    : _camera(&camera), _effects(&effects), _highest(highest)
{
}

HorizonClamp::~HorizonClamp() = default;

double HorizonClamp::farthest(const osg::Vec3d& eye, double highest)
{
    const osg::EllipsoidModel earth;
    double latitude, longitude, height;
    earth.convertXYZToLatLongHeight(eye.x(), eye.y(), eye.z(), latitude, longitude, height);
    return horizon(height) + horizon(highest);
}

bool HorizonClamp::clampProjectionMatrixImplementation(osg::Matrixd& projection, double& near,
                                                       double& far) const
{
    // As OSG has it: nothing was found.
    if (!(far >= near)) return false;
    const bool perspective = projection(0, 3) == 0.0 && projection(1, 3) == 0.0 && projection(3, 3) == 0.0;
    if (!perspective)
    {
        const double margin = std::max(0.02 * (far - near), 1.0);
        projection(2, 2) = -2.0 / (far - near + 2.0 * margin);
        projection(3, 2) = -(far + near) / (far - near + 2.0 * margin);
        return true;
    }
    osg::ref_ptr<const osg::Camera> camera;
    osg::ref_ptr<const EffectScene> effects;
    if (!_camera.lock(camera)) return false;
    if (_effects.lock(effects) && !deforms(*effects))
        far = std::min(far, farthest(camera->getInverseViewMatrix().getTrans(), _highest));
    const double end = 1.02 * far;
    const double begin = std::max(0.98 * near, end * camera->getNearFarRatio());
    near = begin;
    projection(2, 2) = (end + begin) / (begin - end);
    projection(2, 3) = -1.0;
    projection(3, 2) = 2.0 * end * begin / (begin - end);
    return true;
}

bool HorizonClamp::clampProjectionMatrixImplementation(osg::Matrixf& projection, double& near,
                                                       double& far) const
{
    osg::Matrixd exact(projection);
    const bool done = clampProjectionMatrixImplementation(exact, near, far);
    if (done) projection = exact;
    return done;
}

} // namespace osgGeoFX
