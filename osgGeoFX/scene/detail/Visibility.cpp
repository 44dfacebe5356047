// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/Visibility.h>

#include <osg/CullingSet>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

void Visibility::set(const Camera& camera)
{
    const osg::Viewport* viewport = camera.viewport;
    const bool sized = viewport && viewport->width() >= 1.0 && viewport->height() >= 1.0;
    const osg::Matrixd toEye = camera.image ? camera.image->toEye : osg::Matrixd();
    const osg::Matrixd toClip = camera.image ? toEye * camera.projection : camera.projection;
    const auto setPicture = [this](const osg::Matrixd& projection)
    {
        osg::Polytope sides;
        sides.setToUnitFrustum(false, false);
        sides.transformProvidingInverse(projection);
        _picture.set(&sides, projection, true);
    };
    if (camera.reach > 0.0 && sized)
    {
        // The picture is made wider, so that an object beside it is drawn as long as it reaches into the camera's
        // picture.
        _room.set(2.0 * camera.reach / viewport->width(), 2.0 * camera.reach / viewport->height());
        const osg::Matrixd wider =
            toClip * osg::Matrixd::scale(1.0 / (1.0 + _room.x()), 1.0 / (1.0 + _room.y()), 1.0);
        osg::Polytope planes;
        planes.setToUnitFrustum(camera.nearPlane, camera.farPlane);
        planes.transformProvidingInverse(wider);
        _frustum.set(camera.planes ? &planes : nullptr, wider, camera.sides);
        setPicture(wider);
    }
    else
    {
        _room.set(0.0, 0.0);
        osg::Polytope planes;
        if (camera.planes && camera.image)
        {
            planes = *camera.planes;
            planes.transformProvidingInverse(toEye);
        }
        _frustum.set(camera.planes && camera.image ? &planes : camera.planes, toClip, camera.sides);
        setPicture(toClip);
    }
    _depths.set(-toEye(0, 2), -toEye(1, 2), -toEye(2, 2), -toEye(3, 2));
    // What a view hides can be seen from elsewhere, or its shadow can. In a part of the picture the room has other lengths.
    _hides = !camera.image || (toEye.getTrans().length2() == 0.0 && camera.reach <= 0.0);
    _smallPixels = viewport && viewport->height() > 0.0 ? camera.smallPixels : 0.0;
    if (viewport && viewport->height() > 0.0)
        _pixelSize = osg::CullingSet::computePixelSizeVector(*viewport, camera.projection, toEye);
}

double Visibility::radiusOfPixel(const osg::Vec3d& point) const
{
    return _pixelSize.x() * point.x() + _pixelSize.y() * point.y() + _pixelSize.z() * point.z() +
           _pixelSize.w();
}

bool Visibility::tooSmall(const Ball& deformed) const
{
    return _smallPixels > 0.0 && radiusOfPixel(deformed.center) * _smallPixels > deformed.radius;
}

bool Visibility::outOfSight(const Ball& deformed, Mask& planes, bool mayBeSmall) const
{
    return _frustum.side(deformed, planes) == EyeFrustum::Side::Outside ||
           (!mayBeSmall && tooSmall(deformed));
}

std::pair<double, double> Visibility::depthsOf(const DeformationChain& chain, const EyeBox& box)
{
    chain.bound(box, _hull);
    double nearest = HUGE_VAL, farthest = -HUGE_VAL;
    for (const osg::Vec3d& point : _hull.points)
    {
        const double depth = _depths * osg::Vec4d(point, 1.0);
        nearest = std::min(nearest, depth - _hull.margin);
        farthest = std::max(farthest, depth + _hull.margin);
    }
    return {nearest, farthest};
}

bool Visibility::misses(const DeformationChain& chain, const EyeBox& box, Mask planes, double margin)
{
    chain.bound(box, _hull);
    _hull.margin += margin;
    return _frustum.misses(_hull, planes);
}

bool Visibility::outOfSight(const DeformationChain& chain, const EyeBox& box, Mask planes, int halvings)
{
    if (hides(chain, box)) return true;
    const Ball deformed = chain.bound(box.ball());
    const EyeFrustum::Side side = _frustum.side(deformed, planes);
    if (side != EyeFrustum::Side::Crossing) return side == EyeFrustum::Side::Outside;
    if (_frustum.holds(deformed.center, planes)) return false;
    if (misses(chain, box, planes)) return true;
    // A hull that is tight for its box would not become much tighter.
    constexpr double loose = 0.03;
    if (halvings == 0 || _hull.margin + _hull.slack < loose * box.ball().radius) return false;
    const osg::Vec3d* longest =
        std::max_element(box.half, box.half + 3,
                         [](const osg::Vec3d& a, const osg::Vec3d& b) { return a.length2() < b.length2(); });
    for (const double share : {-0.5, 0.5})
    {
        EyeBox part = box;
        part.center += *longest * share;
        part.half[longest - box.half] *= 0.5;
        if (!outOfSight(chain, part, planes, halvings - 1)) return false;
    }
    return true;
}

} // namespace osgGeoFX
