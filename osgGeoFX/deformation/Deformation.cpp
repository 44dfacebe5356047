// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/Deformation.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

EyeBox EyeBox::of(const osg::BoundingBox& box, const osg::Matrixd& modelView)
{
    EyeBox result;
    const osg::Vec3d low(box._min);
    const osg::Vec3d high(box._max);
    result.centre = (low + high) * 0.5 * modelView;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double half = (high[axis] - low[axis]) / 2.0;
        result.half[axis].set(half * modelView(axis, 0), half * modelView(axis, 1),
                              half * modelView(axis, 2));
    }
    return result;
}

Ball EyeBox::ball() const
{
    // Of a rectangular box, the diagonal; where a matrix shears, the longest of the four.
    double square = 0.0;
    for (const double a : {-1.0, 1.0})
    {
        for (const double b : {-1.0, 1.0})
        {
            square = std::max(square, (half[0] + half[1] * a + half[2] * b).length2());
        }
    }
    return {centre, std::sqrt(square)};
}

DeformationFrame::~DeformationFrame() = default;

Ball DeformationFrame::bound(const Ball& ball) const
{
    if (reach(ball) == Reach::Identity) return ball;
    return {roughly(ball.centre), ball.radius * lipschitz(ball) + roughness(ball)};
}

osg::Matrixd DeformationFrame::turn(const osg::Vec3d&) const
{
    return {};
}

Deformation::~Deformation() = default;

} // namespace osgGeoFX
