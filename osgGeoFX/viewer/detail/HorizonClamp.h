// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osg/CullSettings>
#include <osg/observer_ptr>

namespace osgGeoFX
{

/** Near and far planes of a camera over a round Earth. OSG's far plane is behind the Earth, since tiles beyond the horizon
    lie in the view volume, too, and the near plane follows it and cuts off the foreground.

    Nothing is seen beyond the distance at which the highest mountain stands above the horizon. Where effects move the
    ground, the kit's own far plane holds for what is drawn, and stays. One thread for each camera. */
class HorizonClamp : public osg::CullSettings::ClampProjectionMatrixCallback
{
public:
    /// `highest`: metres above the ellipsoid. The camera's near-far ratio holds.
    HorizonClamp(const osg::Camera& camera, const EffectScene& effects, double highest);

    bool clampProjectionMatrixImplementation(osg::Matrixf& projection, double& near,
                                             double& far) const override;
    bool clampProjectionMatrixImplementation(osg::Matrixd& projection, double& near,
                                             double& far) const override;

    /// The farthest that is in sight from a place in geocentric coordinates, metres.
    static double farthest(const osg::Vec3d& eye, double highest);

protected:
    ~HorizonClamp() override;

private:
    osg::observer_ptr<const osg::Camera> _camera;
    osg::observer_ptr<const EffectScene> _effects;
    double _highest;
};

} // namespace osgGeoFX
