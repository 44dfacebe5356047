// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/Deformation.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// At most this many cells along one axis of a box.
constexpr int mostCells = 8;

double sagOf(const DeformationSnapshot::Sag& sag, int cells)
{
    return std::min(sag.curve / (8.0 * cells * cells) + sag.kink / (4.0 * cells), sag.most);
}

} // namespace

EyeBox EyeBox::of(const osg::BoundingBox& box, const osg::Matrixd& modelView)
{
    EyeBox result;
    const osg::Vec3d low(box._min);
    const osg::Vec3d high(box._max);
    result.center = (low + high) * 0.5 * modelView;
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
    return {center, std::sqrt(square)};
}

void EyeBox::corners(std::vector<osg::Vec3d>& points) const
{
    points.clear();
    for (const double a : {-1.0, 1.0})
    {
        for (const double b : {-1.0, 1.0})
        {
            for (const double c : {-1.0, 1.0})
                points.push_back(center + half[0] * a + half[1] * b + half[2] * c);
        }
    }
}

DeformationSnapshot::~DeformationSnapshot() = default;

Ball DeformationSnapshot::bound(const Ball& ball) const
{
    if (reach(ball) == Reach::Identity) return ball;
    return {roughly(ball.center), ball.radius * lipschitz(ball) + roughness(ball)};
}

void DeformationSnapshot::boundBox(const EyeBox& box, Hull& hull, double fineness) const
{
    hull.margin = 0.0;
    const Ball ball = box.ball();
    const Reach reaching = reach(ball);
    if (reaching != Reach::Curved)
    {
        // A box again, from where its middle and the ends of its axes go.
        EyeBox image = box;
        if (reaching == Reach::Affine)
        {
            image.center = roughly(box.center);
            for (int axis = 0; axis < 3; ++axis)
                image.half[axis] = roughly(box.center + box.half[axis]) - image.center;
        }
        image.corners(hull.points);
        return;
    }
    // The deformed corners of a grid: interpolation over one of its cells is off by the sum of what it is off along the
    // cell's three edges.
    std::array<int, 3> cells = {1, 1, 1};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const Sag along = sag(ball, box.half[axis] * 2.0);
        int& count = cells[axis];
        while (count < mostCells && sagOf(along, count) > fineness * ball.radius)
            ++count;
        hull.margin += sagOf(along, count);
    }
    hull.margin += roughness(ball);
    if (hull.margin >= ball.radius)
    {
        // Where derivatives bound nothing, the ball says as much.
        const Ball image = bound(ball);
        if (hull.margin >= image.radius)
        {
            hull.points.assign(1, image.center);
            hull.margin = image.radius;
            return;
        }
    }
    hull.points.clear();
    for (int i = 0; i <= cells[0]; ++i)
    {
        const osg::Vec3d atI = box.center + box.half[0] * (2.0 * i / cells[0] - 1.0);
        for (int j = 0; j <= cells[1]; ++j)
        {
            const osg::Vec3d atJ = atI + box.half[1] * (2.0 * j / cells[1] - 1.0);
            for (int k = 0; k <= cells[2]; ++k)
                hull.points.push_back(roughly(atJ + box.half[2] * (2.0 * k / cells[2] - 1.0)));
        }
    }
}

DeformationSnapshot::Sag DeformationSnapshot::sag(const Ball& ball, const osg::Vec3d& edge) const
{
    // Half the edge away from both of its ends, at the farthest.
    return {0.0, 2.0 * lipschitz(ball) * edge.length()};
}

osg::Matrixd DeformationSnapshot::turn(const osg::Vec3d&) const
{
    return {};
}

osg::Vec3d DeformationSnapshot::carried(const osg::Vec3d& position, const osg::Vec3d& offset) const
{
    return osg::Matrixd::transform3x3(offset, turn(position));
}

Deformation::~Deformation() = default;

} // namespace osgGeoFX
