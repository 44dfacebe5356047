// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/DepthConvention.h>

#include <osg/Texture>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

bool isPerspective(const osg::Matrixd& projection)
{
    return projection(3, 3) == 0.0;
}

/// The distance of a projection's far plane; not positive, or no number, where there is none.
double farPlaneOf(const osg::Matrixd& projection)
{
    return projection(3, 2) / (1.0 + projection(2, 2));
}

void define(osg::StateSet& state, const char* name, bool on)
{
    state.setDefine(name, on ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
}

} // namespace

std::string DepthConvention::fault() const
{
    if (std::isfinite(farDistance) && farDistance >= 0.0) return {};
    return "The far distance of logarithmic depths must be a number of metres above 0, or 0 for the "
           "projection's.";
}

CameraDepth::CameraDepth(const DepthConvention& convention, const osg::Matrixd& projection)
{
    if (convention.kind != DepthConvention::OF_PROJECTION && isPerspective(projection))
    {
        const double farthest =
            convention.farDistance > 0.0 ? convention.farDistance : farPlaneOf(projection);
        if (farthest > 0.0 && std::isfinite(farthest)) _factor = 2.0 / std::log2(farthest + 1.0);
    }
    _byFragment = logarithmic() && convention.kind == DepthConvention::LOGARITHMIC_BY_FRAGMENT;
    _reversed = !logarithmic() && reverses(projection);
}

bool CameraDepth::reverses(const osg::Matrixd& projection)
{
    // At a distance d the depth is b / d - a, or b - a d.
    return isPerspective(projection) ? projection(3, 2) > 0.0 : projection(2, 2) > 0.0;
}

double CameraDepth::logarithmicDepth(double w) const
{
    return 0.5 * std::log2(std::max(1e-6, 1.0 + w)) * _factor;
}

GLenum CameraDepth::format() const
{
    return _reversed ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24;
}

void CameraDepth::put(osg::StateSet& state) const
{
    define(state, "GEOFX_REVERSED_DEPTH", _reversed);
    define(state, "GEOFX_LOG_DEPTH", logarithmic());
    define(state, "GEOFX_LOG_DEPTH_OF_FRAGMENTS", _byFragment);
    if (logarithmic())
        state.getOrCreateUniform("geofx_logDepth", osg::Uniform::FLOAT)->set(static_cast<float>(_factor));
}

} // namespace osgGeoFX
