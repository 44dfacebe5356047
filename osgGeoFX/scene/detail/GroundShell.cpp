// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/GroundShell.h>

#include <osgGeoFX/scene/detail/GlobeHorizon.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Of a whole globe, around and from pole to pole.
constexpr int AROUND = 8, UPWARD = 4;
/// Places along each horizontal side of a block.
constexpr std::size_t PLACES = 3;

} // namespace

GroundShell::GroundShell(const osg::BoundingSphere& bound, const Ground& ground)
    : _bound(bound), _ellipsoid(ground.ellipsoid.get()), _lowest(ground.minHeight), _highest(ground.maxHeight)
{
    if (ground.heightsKnown) return;
    const double unknown =
        _ellipsoid ? GlobeHorizon::UNKNOWN_SHARE * _ellipsoid->getRadiusEquator() : HUGE_VAL;
    _lowest = -unknown;
    _highest = unknown;
}

std::vector<GroundShell::Block> GroundShell::blocks() const
{
    if (!_bound.valid()) return {};
    const osg::Vec3d center(_bound.center());
    const auto radius = static_cast<double>(_bound.radius());
    if (!_ellipsoid)
    {
        const osg::Vec3d low = center - osg::Vec3d(radius, radius, radius);
        const osg::Vec3d high = center + osg::Vec3d(radius, radius, radius);
        return {{{low.x(), low.y(), std::clamp(_lowest, low.z(), high.z())},
                 {high.x(), high.y(), std::clamp(_highest, low.z(), high.z())}}};
    }
    std::vector<Block> all;
    const double east = 2.0 * osg::PI / AROUND, north = osg::PI / UPWARD;
    for (int x = 0; x < AROUND; ++x)
    {
        for (int y = 0; y < UPWARD; ++y)
            all.push_back({{x * east - osg::PI, y * north - 0.5 * osg::PI, _lowest},
                           {(x + 1) * east - osg::PI, (y + 1) * north - 0.5 * osg::PI, _highest}});
    }
    return all;
}

std::optional<EyeBox> GroundShell::boxOf(const Block& block) const
{
    EyeBox box;
    if (_ellipsoid)
        box = boxOnGlobe(block);
    else
    {
        box.center = (block.low + block.high) * 0.5;
        for (int axis = 0; axis < 3; ++axis)
            box.half[axis][axis] = 0.5 * (block.high - block.low)[axis];
    }
    const Ball ball = box.ball();
    const double apart = (ball.center - osg::Vec3d(_bound.center())).length();
    if (apart > ball.radius + static_cast<double>(_bound.radius())) return std::nullopt;
    return box;
}

EyeBox GroundShell::boxOnGlobe(const Block& block) const
{
    const double equator = _ellipsoid->getRadiusEquator(), polar = _ellipsoid->getRadiusPolar();
    const double squash = polar * polar / (equator * equator);
    std::array<osg::Vec2d, PLACES> longitudes, latitudes; // cosine and sine
    std::array<double, PLACES> normals{};                 // from the axis to the surface, along the vertical
    const osg::Vec2d first(block.low.x(), block.low.y()), last(block.high.x(), block.high.y());
    const osg::Vec2d step = (last - first) / static_cast<double>(PLACES - 1);
    for (std::size_t i = 0; i < PLACES; ++i)
    {
        const double longitude = first.x() + step.x() * static_cast<double>(i),
                     latitude = first.y() + step.y() * static_cast<double>(i);
        longitudes[i].set(std::cos(longitude), std::sin(longitude));
        latitudes[i].set(std::cos(latitude), std::sin(latitude));
        normals[i] = equator / std::sqrt(1.0 - (1.0 - squash) * latitudes[i].y() * latitudes[i].y());
    }
    const osg::Vec2d& lon = longitudes[PLACES / 2];
    const osg::Vec2d& lat = latitudes[PLACES / 2];
    EyeBox box;
    const osg::Vec3d axes[3] = {osg::Vec3d(-lon.y(), lon.x(), 0.0),
                                osg::Vec3d(-lat.y() * lon.x(), -lat.y() * lon.y(), lat.x()),
                                osg::Vec3d(lat.x() * lon.x(), lat.x() * lon.y(), lat.y())};
    osg::Vec3d low(HUGE_VAL, HUGE_VAL, HUGE_VAL), high(-HUGE_VAL, -HUGE_VAL, -HUGE_VAL);
    for (std::size_t y = 0; y < PLACES; ++y)
    {
        for (const double height : {block.low.z(), block.high.z()})
        {
            const double out = (normals[y] + height) * latitudes[y].x();
            const double up = (normals[y] * squash + height) * latitudes[y].y();
            for (std::size_t x = 0; x < PLACES; ++x)
            {
                const osg::Vec3d place(out * longitudes[x].x(), out * longitudes[x].y(), up);
                for (int axis = 0; axis < 3; ++axis)
                {
                    low[axis] = std::min(low[axis], place * axes[axis]);
                    high[axis] = std::max(high[axis], place * axes[axis]);
                }
            }
        }
    }
    // Between places a step apart, a circle leaves their line by an eighth of its radius times the step's square.
    constexpr double room = 1.05;
    const double bulge = room * (equator + std::max(block.high.z(), 0.0)) * step.length2() / 8.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        box.center += axes[axis] * (0.5 * (low[axis] + high[axis]));
        box.half[axis] = axes[axis] * (0.5 * (high[axis] - low[axis]) + bulge);
    }
    return box;
}

std::pair<GroundShell::Block, GroundShell::Block> GroundShell::halvesOf(const Block& block) const
{
    const osg::Vec3d middle = (block.low + block.high) * 0.5;
    osg::Vec3d size = block.high - block.low;
    if (_ellipsoid)
    {
        const double radius = _ellipsoid->getRadiusEquator();
        size.x() *= radius * std::cos(middle.y());
        size.y() *= radius;
    }
    int axis = size.x() >= size.y() ? 0 : 1;
    if (size.z() > size[axis]) axis = 2;
    Block first = block, second = block;
    first.high[axis] = second.low[axis] = middle[axis];
    return {first, second};
}

} // namespace osgGeoFX
