// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/ProxyFrustum.h>

#include <osg/CoordinateSystemNode>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

/// Steps of refinement, and how small a box becomes, as a share of its distance.
constexpr int mostSplits = 600;
constexpr double fineness = 0.02;
/// Directions further off than this are no use in a pyramid.
constexpr double widest = 50.0;
/// For rounding in engines that compute in single precision.
constexpr double margin = 1e-3;

enum Side : std::size_t
{
    Left,
    Right,
    Bottom,
    Top,
    Near,
    Far
};

} // namespace

ProxyFrustum::ProxyFrustum(const Terrain& terrain, const OutOfSight& outOfSight, const DepthsOf& depthsOf)
    : _terrain(terrain), _outOfSight(outOfSight), _depthsOf(depthsOf)
{
    osg::BoundingBox all;
    all.expandBy(terrain.bound);
    if (!terrain.ground.ellipsoid && terrain.ground.heightsKnown)
    {
        all.zMin() = std::max(all.zMin(), static_cast<float>(terrain.ground.minHeight));
        all.zMax() = std::min(all.zMax(), static_cast<float>(terrain.ground.maxHeight));
    }
    setShapes();
    const std::optional<Cell> first = all.valid() ? cellOf(all) : std::nullopt;
    if (first) _cells.push_back(*first);
    refine();
    setProjection();
    if (terrain.ground.ellipsoid) setViewPoint();
}

std::pair<double, double> ProxyFrustum::depths() const
{
    double nearest = HUGE_VAL, farthest = -HUGE_VAL;
    for (const Cell& cell : _cells)
    {
        nearest = std::min(nearest, -cell.depths[0]);
        farthest = std::max(farthest, cell.depths[1]);
    }
    return {nearest, farthest};
}

bool ProxyFrustum::awayFromGround(const osg::BoundingBox& box) const
{
    const Ground& ground = _terrain.ground;
    if (!ground.ellipsoid || !ground.heightsKnown) return false;
    const osg::Vec3d middle = box.center();
    const double radius = static_cast<double>(box.radius());
    const double length = middle.length();
    // A surface of one height lies between two spheres.
    const double least = ground.ellipsoid->getRadiusPolar() + ground.minHeight;
    const double most = ground.ellipsoid->getRadiusEquator() + ground.maxHeight;
    if (length + radius < least || length - radius > most) return true;
    double latitude = 0.0, longitude = 0.0, height = 0.0;
    ground.ellipsoid->convertXYZToLatLongHeight(middle.x(), middle.y(), middle.z(), latitude, longitude,
                                                height);
    return height + radius < ground.minHeight || height - radius > ground.maxHeight;
}

void ProxyFrustum::setShapes()
{
    // Looking where the camera does, with level sides.
    const osg::Vec3d forward(0.0, 0.0, -1.0);
    osg::Vec3d right = forward ^ _terrain.up;
    if (right.normalize() > 1e-3)
    {
        const osg::Vec3d up = right ^ forward;
        _shapes[Level].frame =
            osg::Matrixd::inverse(osg::Matrixd(right.x(), right.y(), right.z(), 0.0, up.x(), up.y(), up.z(),
                                               0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0));
    }
    _shapes[Box].parallel = true;
}

ProxyFrustum::Reach ProxyFrustum::reachOf(const Shape& shape, const osg::BoundingBox& box) const
{
    Reach reach;
    reach.fill(-HUGE_VAL);
    const osg::Matrixd toShape = _terrain.modelView * shape.frame;
    for (unsigned int i = 0; i < 8; ++i)
    {
        const osg::Vec3d corner = osg::Vec3d(box.corner(i)) * toShape;
        const double depth = -corner.z();
        if (!shape.parallel && !(std::max(std::abs(corner.x()), std::abs(corner.y())) < widest * depth))
        {
            reach.fill(HUGE_VAL);
            return reach;
        }
        const double scale = shape.parallel ? 1.0 : 1.0 / depth;
        const Reach ofCorner = {
            -corner.x() * scale, corner.x() * scale, -corner.y() * scale, corner.y() * scale, -depth, depth};
        for (std::size_t side = 0; side < sides; ++side)
            reach[side] = std::max(reach[side], ofCorner[side]);
    }
    return reach;
}

std::optional<ProxyFrustum::Cell> ProxyFrustum::cellOf(const osg::BoundingBox& box) const
{
    if (awayFromGround(box) || _outOfSight(EyeBox::of(box, _terrain.modelView * _terrain.toView)))
        return std::nullopt;
    const double size = 2.0 * static_cast<double>(box.radius());
    const osg::Vec3d middle = osg::Vec3d(box.center()) * _terrain.modelView;
    Cell cell;
    cell.box = box;
    for (std::size_t i = 0; i < shapes; ++i)
        cell.reach[i] = reachOf(_shapes[i], box);
    cell.coarseness = size / std::max(middle.length() - 0.5 * size, 0.1 * size);
    const auto [nearest, farthest] = _depthsOf(EyeBox::of(box, _terrain.modelView * _terrain.toView));
    // What is behind the eye does not count, and what cannot be told is to be split.
    cell.depths = {std::isnan(nearest) ? HUGE_VAL : -std::max(nearest, 0.0),
                   std::isnan(farthest) ? HUGE_VAL : farthest};
    return cell;
}

void ProxyFrustum::split(std::size_t index)
{
    const osg::BoundingBox whole = _cells[index].box;
    const osg::Vec3 size = whole._max - whole._min;
    int axis = size.x() >= size.y() ? 0 : 1;
    if (size.z() > size[axis]) axis = 2;
    const float middle = 0.5f * (whole._min[axis] + whole._max[axis]);
    osg::BoundingBox low = whole, high = whole;
    low._max[axis] = middle;
    high._min[axis] = middle;
    const std::optional<Cell> first = cellOf(low), second = cellOf(high);
    if (first)
        _cells[index] = *first;
    else
        std::swap(_cells[index], _cells.back());
    if (!first) _cells.pop_back();
    if (second) _cells.push_back(*second);
}

std::size_t ProxyFrustum::worstCell() const
{
    constexpr std::size_t ofShapes = Box * sides, measures = ofShapes + 2;
    const auto reach = [](const Cell& cell, std::size_t measure)
    {
        return measure < ofShapes ? cell.reach[measure / sides][measure % sides]
                                  : cell.depths[measure - ofShapes];
    };
    std::size_t worst = 0;
    for (std::size_t measure = 0; measure < measures; ++measure)
    {
        std::size_t furthest = 0;
        for (std::size_t j = 1; j < _cells.size(); ++j)
        {
            const double further = reach(_cells[j], measure) - reach(_cells[furthest], measure);
            if (further > 0.0 || (!(further < 0.0) && _cells[j].coarseness > _cells[furthest].coarseness))
                furthest = j;
        }
        if (_cells[furthest].coarseness > _cells[worst].coarseness || measure == 0) worst = furthest;
    }
    return worst;
}

void ProxyFrustum::refine()
{
    for (int step = 0; step < mostSplits && !_cells.empty(); ++step)
    {
        const std::size_t worst = worstCell();
        if (_cells[worst].coarseness <= fineness) break;
        split(worst);
    }
}

ProxyFrustum::Reach ProxyFrustum::reachOf(std::size_t shape) const
{
    Reach most;
    most.fill(-HUGE_VAL);
    for (const Cell& cell : _cells)
    {
        for (std::size_t side = 0; side < sides; ++side)
            most[side] = std::max(most[side], cell.reach[shape][side]);
    }
    return most;
}

osg::Matrixd ProxyFrustum::projectionOf(std::size_t shape) const
{
    const Reach most = reachOf(shape);
    if (_shapes[shape].parallel)
    {
        const double room =
            margin * std::max({most[Left] + most[Right], most[Bottom] + most[Top], most[Near] + most[Far]});
        return _shapes[shape].frame * osg::Matrixd::ortho(-most[Left] - room, most[Right] + room,
                                                          -most[Bottom] - room, most[Top] + room,
                                                          -most[Near] - room, most[Far] + room);
    }
    const double nearest = std::max(-most[Near] * (1.0 - margin), 1e-6 * most[Far]);
    return _shapes[shape].frame *
           osg::Matrixd::frustum(-(most[Left] + margin) * nearest, (most[Right] + margin) * nearest,
                                 -(most[Bottom] + margin) * nearest, (most[Top] + margin) * nearest, nearest,
                                 most[Far] * (1.0 + margin));
}

void ProxyFrustum::setProjection()
{
    // With nothing to see: a look at a place where nothing is.
    _projection = osg::Matrixd::frustum(-1e-6, 1e-6, -1e-6, 1e-6, 1e9, 2e9);
    if (_cells.empty()) return;
    // The narrower one of the two pyramids.
    std::size_t best = Box;
    double least = HUGE_VAL;
    for (const std::size_t shape : {Own, Level})
    {
        const Reach reach = reachOf(shape);
        const double size = (reach[Left] + reach[Right]) * (reach[Bottom] + reach[Top]);
        if (!(size < least)) continue;
        least = size;
        best = shape;
    }
    _projection = projectionOf(best);
}

void ProxyFrustum::setViewPoint()
{
    const osg::Vec3d eye = osg::Vec3d() * osg::Matrixd::inverse(_terrain.modelView);
    osg::Vec3d up = eye;
    if (up.normalize() == 0.0) return;
    // The widest angle at the Earth's center between the eye and what is shown, on a sphere below all ground.
    double angle = 0.0;
    for (const Cell& cell : _cells)
    {
        const osg::Vec3d middle = cell.box.center();
        const double length = middle.length(), radius = static_cast<double>(cell.box.radius());
        if (radius >= length) return;
        angle = std::max(angle,
                         std::acos(std::clamp(up * middle / length, -1.0, 1.0)) + std::asin(radius / length));
    }
    constexpr double most = 1.5;
    if (angle > most) return;
    const double distance = (1.0 + margin) * _terrain.ground.ellipsoid->getRadiusEquator() / std::cos(angle);
    _viewPoint = up * std::max(distance, eye.length()) * _terrain.modelView;
}

} // namespace osgGeoFX
