// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/ShadowCascades.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Sines of directions that were turned to eye space and back differ by less.
constexpr double sameDirection = 1e-9;
/// The first map reaches so many times as far as the eye is high: to the lower edge of usual pictures.
constexpr double reachOfHeight = 1.2;
/// How far ahead of the eye the middle of a map lies, in its radii, where the eye looks along the ground.
constexpr double ahead = 0.5;
/// A low sun's rays cross the ground of a map on a long way; below 3° they leave it.
constexpr double longest = 20.0;

osg::Vec3d unit(osg::Vec3d vector)
{
    vector.normalize();
    return vector;
}

/// The part of a vector across a direction.
osg::Vec3d across(const osg::Vec3d& vector, const osg::Vec3d& direction)
{
    return vector - direction * (vector * direction);
}

} // namespace

void ShadowGrid::turn(const osg::Vec3d& towards, const osg::Vec3d& here)
{
    if (_known && (towards - _towards).length() < sameDirection) return;
    const osg::Vec3d axis =
        std::abs(towards.z()) < 0.9 ? osg::Vec3d(0.0, 0.0, 1.0) : osg::Vec3d(0.0, 1.0, 0.0);
    // The axes turn as little as they can, so none of them jumps where the sun passes through the zenith.
    osg::Vec3d right = _known ? across(_right, towards) : axis ^ towards;
    if (right.length() < 0.1) right = axis ^ towards;
    right.normalize();
    const osg::Vec3d up = towards ^ right;
    if (_known)
    {
        const osg::Vec3d way = here - _origin;
        _origin = here - right * (way * _right) - up * (way * _up);
    }
    _towards = towards;
    _right = right;
    _up = up;
    _known = true;
}

osg::Vec3d ShadowGrid::snapped(const osg::Vec3d& place, double step, double along) const
{
    const osg::Vec3d way = place - _origin;
    const auto rest = [&](const osg::Vec3d& axis, double size)
    {
        const double at = way * axis;
        return at - std::floor(at / size) * size;
    };
    return place - _right * rest(_right, step) - _up * rest(_up, step) - _towards * rest(_towards, along);
}

ShadowCascades::ShadowCascades(const ViewGeometry& view, const GroundBelow& ground, ShadowGrid& grid,
                               const osg::Vec3d& towards, double nearest, int count, int texels)
{
    const osg::Matrixd toWorld = osg::Matrixd::inverse(view.modelView);
    grid.turn(unit(osg::Matrixd::transform3x3(towards, toWorld)), toWorld.getTrans());
    _towards = osg::Matrixd::transform3x3(grid.towards(), view.modelView);
    _right = osg::Matrixd::transform3x3(grid.right(), view.modelView);
    _up = osg::Matrixd::transform3x3(grid.up(), view.modelView);

    const double height = ground.drawn;
    double radius = nearest;
    if (nearest <= 0.0)
    {
        const double least = std::log(smallest) / std::log(step);
        const double level =
            std::max(std::log(std::max(reachOfHeight * height, 1.0)) / std::log(step), least);
        _firstShare = 1.0 - (level - std::floor(level));
        radius = std::pow(step, std::floor(level));
    }
    const double sine = _towards * view.up;
    const double length = std::min(1.0 + 1.0 / std::max(sine, 1e-3), longest);
    const osg::Vec3d forward = across(osg::Vec3d(0.0, 0.0, -1.0), view.up);
    for (int i = 0; i < std::clamp(count, 1, most); ++i, radius *= step)
    {
        ShadowCascade cascade;
        cascade.radius = radius;
        cascade.texel = 2.0 * radius / texels;
        const double along = 0.25 * radius;
        cascade.depth = (std::ceil((radius * length + height) / along) + 1.0) * along;
        const osg::Vec3d place = forward * (ahead * radius) - view.up * (ground.undeformed - 0.5 * height);
        cascade.center = grid.snapped(place * toWorld, stride * cascade.texel, along) * view.modelView;
        const auto row = [&](int column, const osg::Vec3d& axis, double half)
        {
            for (int j = 0; j < 3; ++j)
                cascade.toMap(j, column) = 0.5 * axis[j] / half;
            cascade.toMap(3, column) = 0.5 - 0.5 * (cascade.center * axis) / half;
        };
        row(0, _right, radius);
        row(1, _up, radius);
        row(2, -_towards, cascade.depth);
        _all.push_back(cascade);
    }
}

bool ShadowCascades::outside(std::size_t cascade, const Ball& ball) const
{
    const ShadowCascade& box = _all[cascade];
    const osg::Vec3d way = ball.center - box.center;
    // What stands nearer to the sun throws its shadow into the box, however far away it is.
    return std::abs(way * _right) > box.radius + ball.radius ||
           std::abs(way * _up) > box.radius + ball.radius || way * _towards < -box.depth - ball.radius;
}

} // namespace osgGeoFX
