// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/ProxyFrustum.h>

#include <osg/CoordinateSystemNode>

#include <algorithm>
#include <cmath>
#include <functional>

namespace osgGeoFX
{

namespace
{

/// Steps of refinement, and how small a box becomes, as a share of its distance.
constexpr int mostSplits = 600;
constexpr double fineness = 0.02;
/// Of the terrain's radius, which is 6 m on the Earth. A smaller box around the eye does not count.
constexpr double smallest = 1e-6;
/// Directions further off than this are no use in a pyramid.
constexpr double widest = 50.0;
/// For rounding in engines that compute in single precision.
constexpr double margin = 1e-4;

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

ProxyFrustum::ProxyFrustum(const Terrain& terrain, const OutOfSight& outOfSight, const DepthsOf& depthsOf,
                           const MovesVertically& movesVertically)
    : _terrain(terrain), _outOfSight(outOfSight), _depthsOf(depthsOf), _movesVertically(movesVertically),
      _shell(terrain.bound, terrain.ground)
{
    setShapes();
    for (const GroundShell::Block& block : _shell.blocks())
        add(block);
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

double ProxyFrustum::farthestGround() const
{
    return reachOf(Own)[Far];
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

ProxyFrustum::Reach ProxyFrustum::reachOf(const Shape& shape, const std::vector<osg::Vec3d>& corners)
{
    Reach reach;
    reach.fill(-HUGE_VAL);
    for (const osg::Vec3d& each : corners)
    {
        const osg::Vec3d corner = each * shape.frame;
        const double depth = -corner.z();
        const bool ahead =
            shape.parallel || std::max(std::abs(corner.x()), std::abs(corner.y())) < widest * depth;
        const double scale = shape.parallel ? 1.0 : 1.0 / depth;
        const osg::Vec2d at =
            ahead ? osg::Vec2d(corner.x() * scale, corner.y() * scale) : osg::Vec2d(HUGE_VAL, HUGE_VAL);
        const Reach ofCorner = {
            ahead ? -at.x() : HUGE_VAL, at.x(), ahead ? -at.y() : HUGE_VAL, at.y(), -depth, depth};
        for (std::size_t side = 0; side < sides; ++side)
            reach[side] = std::max(reach[side], ofCorner[side]);
    }
    return reach;
}

void ProxyFrustum::cutToPicture(Reach& own) const
{
    const double nearest = -own[Near];
    if (!(nearest > 0.0) && _terrain.movement > 0.0) return;
    // What is seen at a depth z from the eye has come from as much as the movement farther to the side, and from as much nearer.
    const double beside = _terrain.movement > 0.0 ? _terrain.movement / nearest : 0.0;
    for (std::size_t side = Left; side <= Top; ++side)
    {
        const double seen = _terrain.picture[side];
        own[side] = std::min(own[side], seen + (1.0 + std::abs(seen)) * beside);
    }
    own[Near] = std::min(own[Near], 0.0);
}

void ProxyFrustum::add(const GroundShell::Block& block)
{
    const std::optional<EyeBox> box = _shell.boxOf(block);
    if (!box) return;
    const auto placed = [](const EyeBox& from, const osg::Matrixd& matrix)
    {
        EyeBox to;
        to.center = from.center * matrix;
        for (int axis = 0; axis < 3; ++axis)
            to.half[axis] = osg::Matrixd::transform3x3(from.half[axis], matrix);
        return to;
    };
    Cell cell;
    cell.block = block;
    cell.box = placed(*box, _terrain.modelView);
    const EyeBox inView = placed(cell.box, _terrain.toView);
    if (_outOfSight(inView)) return;
    std::vector<osg::Vec3d> corners;
    cell.box.corners(corners);
    for (std::size_t i = 0; i < shapes; ++i)
        cell.reach[i] = reachOf(_shapes[i], corners);
    if (std::isfinite(_terrain.picture[Left]) && _movesVertically(inView)) cutToPicture(cell.reach[Own]);
    const double radius = cell.box.ball().radius;
    const double away = cell.box.center.length() - radius;
    // No tile is as small as what is around the eye then.
    if (away < 0.0 && radius < smallest * static_cast<double>(_terrain.bound.radius())) return;
    cell.coarseness = 2.0 * radius / std::max(away, 0.2 * radius);
    const auto [nearest, farthest] = _depthsOf(inView);
    // What is behind the eye does not count, and what cannot be told is to be split.
    cell.depths = {std::isnan(nearest) ? HUGE_VAL : -std::max(nearest, 0.0),
                   std::isnan(farthest) ? HUGE_VAL : farthest};
    _cells.push_back(cell);
}

std::vector<std::size_t> ProxyFrustum::worstCells() const
{
    constexpr std::size_t ofShapes = Box * sides, measures = ofShapes + 2;
    const auto reach = [](const Cell& cell, std::size_t measure)
    {
        return measure < ofShapes ? cell.reach[measure / sides][measure % sides]
                                  : cell.depths[measure - ofShapes];
    };
    std::vector<std::size_t> worst, deepest;
    bool endless = false;
    for (std::size_t measure = 0; measure < measures && !_cells.empty(); ++measure)
    {
        std::size_t furthest = 0;
        for (std::size_t j = 1; j < _cells.size(); ++j)
        {
            const double further = reach(_cells[j], measure) - reach(_cells[furthest], measure);
            if (further > 0.0 || (!(further < 0.0) && _cells[j].coarseness > _cells[furthest].coarseness))
                furthest = j;
        }
        if (!(_cells[furthest].coarseness > fineness)) continue;
        if (measure >= ofShapes)
        {
            deepest.push_back(furthest);
            continue;
        }
        // As long as something has no end on a side, no other side matters.
        const bool hasNoEnd = std::isinf(reach(_cells[furthest], measure));
        if (hasNoEnd && !endless) worst.clear();
        endless = endless || hasNoEnd;
        if (hasNoEnd == endless) worst.push_back(furthest);
    }
    // The coarsest ones first, so that no side uses up the steps of another one. Depths take few.
    double coarsest = 0.0;
    for (const std::size_t each : worst)
        coarsest = std::max(coarsest, _cells[each].coarseness);
    worst.erase(std::remove_if(worst.begin(), worst.end(),
                               [&](std::size_t each) { return _cells[each].coarseness < 0.5 * coarsest; }),
                worst.end());
    worst.insert(worst.end(), deepest.begin(), deepest.end());
    std::sort(worst.begin(), worst.end(), std::greater<>());
    worst.erase(std::unique(worst.begin(), worst.end()), worst.end());
    return worst;
}

void ProxyFrustum::refine()
{
    for (int splits = 0; splits < mostSplits;)
    {
        const std::vector<std::size_t> worst = worstCells();
        if (worst.empty()) break;
        splits += static_cast<int>(worst.size());
        std::vector<GroundShell::Block> blocks;
        for (const std::size_t each : worst)
        {
            blocks.push_back(_cells[each].block);
            std::swap(_cells[each], _cells.back());
            _cells.pop_back();
        }
        for (const GroundShell::Block& block : blocks)
        {
            const auto [first, second] = _shell.halvesOf(block);
            add(first);
            add(second);
        }
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

ProxyFrustum::Reach ProxyFrustum::withRoom(Reach reach)
{
    for (std::size_t side = Left; side <= Top; ++side)
        reach[side] += margin;
    return reach;
}

ProxyFrustum::Reach ProxyFrustum::withPicture(const Reach& own) const
{
    // Less than from a picture's edge to its outermost pixel centers.
    constexpr double slack = 0.3 * margin;
    Reach reach = withRoom(own);
    for (std::size_t side = Left; side <= Top; ++side)
    {
        const double seen = _terrain.picture[side];
        if (std::isfinite(seen)) reach[side] = own[side] <= seen + slack ? seen : reach[side];
    }
    return reach;
}

osg::Matrixd ProxyFrustum::projectionOf(std::size_t shape, const Reach& most) const
{
    if (_shapes[shape].parallel)
    {
        const double room =
            margin * std::max({most[Left] + most[Right], most[Bottom] + most[Top], most[Near] + most[Far]});
        return _shapes[shape].frame * osg::Matrixd::ortho(-most[Left] - room, most[Right] + room,
                                                          -most[Bottom] - room, most[Top] + room,
                                                          -most[Near] - room, most[Far] + room);
    }
    const double nearest = std::max(-most[Near] * (1.0 - margin), 1e-6 * most[Far]);
    return _shapes[shape].frame * osg::Matrixd::frustum(-most[Left] * nearest, most[Right] * nearest,
                                                        -most[Bottom] * nearest, most[Top] * nearest, nearest,
                                                        most[Far] * (1.0 + margin));
}

void ProxyFrustum::setProjection()
{
    // With nothing to see: a look at a place where nothing is.
    _projection = osg::Matrixd::frustum(-1e-6, 1e-6, -1e-6, 1e-6, 1e9, 2e9);
    if (_cells.empty()) return;
    const auto sizeOf = [](const Reach& reach)
    {
        return (reach[Left] + reach[Right]) * (reach[Bottom] + reach[Top]);
    };
    const Reach own = reachOf(Own);
    const Reach level = reachOf(Level);
    // Own sides have the advantage, so that rounding does not decide where the two are alike.
    constexpr double muchNarrower = 0.8;
    if (sizeOf(level) < muchNarrower * sizeOf(own))
        _projection = projectionOf(Level, withRoom(level));
    else if (std::isfinite(sizeOf(own)))
        _projection = projectionOf(Own, withPicture(own));
    else
        _projection = projectionOf(Box, reachOf(Box));
}

void ProxyFrustum::setViewPoint()
{
    const osg::Vec3d center = osg::Vec3d() * _terrain.modelView;
    osg::Vec3d up = -center;
    const double height = up.normalize();
    if (height == 0.0) return;
    // The widest angle at the Earth's center between the eye and what is shown, on a sphere below all ground.
    double angle = 0.0;
    for (const Cell& cell : _cells)
    {
        const osg::Vec3d middle = cell.box.center - center;
        const double length = middle.length(), radius = cell.box.ball().radius;
        if (radius >= length) return;
        angle = std::max(angle,
                         std::acos(std::clamp(up * middle / length, -1.0, 1.0)) + std::asin(radius / length));
    }
    constexpr double most = 1.5;
    if (angle > most) return;
    const double distance = (1.0 + margin) * _terrain.ground.ellipsoid->getRadiusEquator() / std::cos(angle);
    _viewPoint = center + up * std::max(distance, height);
}

} // namespace osgGeoFX
