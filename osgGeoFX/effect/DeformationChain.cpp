// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/DeformationChain.h>

#include <osgGeoFX/effect/detail/AssemblyProgram.h>
#include <osgGeoFX/paging/TerrainInfo.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// A box with the axes of another one around a hull.
EyeBox around(const Hull& hull, const EyeBox& former)
{
    EyeBox box;
    osg::Vec3d axes[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        axes[axis] = former.half[axis];
        // An axis without a length gets the direction that the others leave.
        if (axes[axis].normalize() == 0.0) axes[axis] = axes[(axis + 1) % 3] ^ axes[(axis + 2) % 3];
    }
    for (int axis = 0; axis < 3; ++axis)
    {
        double low = HUGE_VAL;
        double high = -HUGE_VAL;
        for (const osg::Vec3d& point : hull.points)
        {
            const double along = (point - hull.points[0]) * axes[axis];
            low = std::min(low, along);
            high = std::max(high, along);
        }
        box.half[axis] = axes[axis] * ((high - low) / 2.0 + hull.margin);
        box.center += axes[axis] * ((high + low) / 2.0);
    }
    box.center += hull.points[0];
    return box;
}

/// The distance within which a node of another engine shows the finer one of its two levels, which need not be loaded yet; 0
/// where it has no such levels.
double rangeOfFiner(const osg::LOD& node)
{
    if (node.getRangeMode() != osg::LOD::DISTANCE_FROM_EYE_POINT || node.getNumRanges() != 2) return 0.0;
    const unsigned int finer = node.getMinRange(0) < node.getMinRange(1) ? 0 : 1;
    return node.getMinRange(finer) <= 0.0f ? static_cast<double>(node.getMaxRange(finer)) : 0.0;
}

} // namespace

DeformationChain::~DeformationChain() = default;

osg::Vec3d DeformationChain::deform(const osg::Vec3d& position) const
{
    osg::Vec3d result = position;
    for (const auto& snapshot : _snapshots)
        result = snapshot->deform(result);
    return result;
}

osg::Vec3d DeformationChain::roughly(const osg::Vec3d& position) const
{
    osg::Vec3d result = position;
    for (const auto& snapshot : _snapshots)
        result = snapshot->roughly(result);
    return result;
}

osg::Vec3d DeformationChain::undeform(const osg::Vec3d& position) const
{
    osg::Vec3d result = position;
    for (auto snapshot = _snapshots.rbegin(); snapshot != _snapshots.rend(); ++snapshot)
        result = (*snapshot)->undeform(result);
    return result;
}

osg::Vec3d DeformationChain::deformNormal(const osg::Vec3d& position, const osg::Vec3d& normal) const
{
    osg::Vec3d at = position;
    osg::Vec3d result = normal;
    for (const auto& snapshot : _snapshots)
    {
        result = snapshot->deformNormal(at, result);
        at = snapshot->deform(at);
    }
    return result;
}

double DeformationChain::style(const osg::Vec3d& position) const
{
    osg::Vec3d at = position;
    double style = 0.0;
    for (const auto& snapshot : _snapshots)
    {
        style = std::max(style, snapshot->style(at));
        at = snapshot->deform(at);
    }
    return style;
}

osg::Matrixd DeformationChain::placement(const osg::Vec3d& reference) const
{
    osg::Vec3d at = reference;
    osg::Matrixd turn;
    for (const auto& snapshot : _snapshots)
    {
        turn.postMult(snapshot->turn(at));
        at = snapshot->deform(at);
    }
    return osg::Matrixd::translate(-reference) * turn * osg::Matrixd::translate(at);
}

bool DeformationChain::leavesAlone(const Ball& ball) const
{
    return std::all_of(_snapshots.begin(), _snapshots.end(),
                       [&](const auto& snapshot)
                       { return snapshot->reach(ball) == DeformationSnapshot::Reach::Identity; });
}

bool DeformationChain::hides(const Ball& ball, const osg::Vec2d& room) const
{
    if (!_looksAtBoxes) return false;
    Ball current = ball;
    for (std::size_t i = 0; i < _snapshots.size(); ++i)
    {
        if (i > 0) current = _snapshots[i - 1]->bound(current);
        if (_snapshots[i]->hides(current, room)) return true;
        if (_coarseTiles && _snapshots[i]->isAside(current)) return true;
    }
    return false;
}

bool DeformationChain::hides(const EyeBox& box, const osg::Vec2d& room) const
{
    if (!_looksAtBoxes) return false;
    if (_snapshots.front()->hidesBox(box, room)) return true;
    if (_coarseTiles && _snapshots.front()->isAside(box.ball())) return true;
    if (_snapshots.size() == 1) return false;
    Ball current = box.ball();
    for (std::size_t i = 1; i < _snapshots.size(); ++i)
    {
        current = _snapshots[i - 1]->bound(current);
        if (_snapshots[i]->hides(current, room)) return true;
    }
    return false;
}

bool DeformationChain::isBeyond(const osg::Vec3d& position) const
{
    osg::Vec3d at = position;
    for (const auto& snapshot : _snapshots)
    {
        if (snapshot->isBeyond(at)) return true;
        at = snapshot->deform(at);
    }
    return false;
}

double DeformationChain::lodLimit(const osg::LOD& node, const Ball& ball) const
{
    if (_tileEdge <= 0.0 || _snapshots.empty()) return HUGE_VAL;
    // To ask for a tile is to look at a child, which lies elsewhere in memory. Most nodes are told by less.
    if (TileInfo::meshesOf(node)) return blockLimit(node, ball);
    const double share = longestEdge(ball) / (_tileEdge * ball.radius);
    if (!(share < 1.0)) return HUGE_VAL;
    double range = 0.0;
    if (TileInfo::coarseOf(node))
        range = static_cast<double>(node.getMaxRange(1));
    else if (!_ownTiles)
        range = rangeOfFiner(node);
    if (!(range > 0.0)) return HUGE_VAL;
    // An edge misses its curve by its square. So to a pager the finer tiles are as urgent as those of relief that is as many times
    // too coarse; a sea far too coarse for a bend that is new would else wait for relief that is nearly right.
    constexpr double least = 0.001, most = 0.999;
    return std::clamp(share * share, least, most) * range;
}

/// Within it, the block's mesh has edges that are short enough.
double DeformationChain::blockLimit(const osg::LOD& node, const Ball& ball) const
{
    const osg::Vec2Array* meshes = TileInfo::meshesOf(node);
    if (!meshes) return HUGE_VAL;
    const double longest = longestEdge(ball);
    unsigned int child = node.getNumChildren();
    while (child > 0 && static_cast<double>((*meshes)[child - 1].x()) > longest)
        --child;
    if (child == node.getNumChildren()) return HUGE_VAL;
    constexpr double within = 0.999;
    return within * static_cast<double>(node.getMaxRange(std::max(child, 1u) - 1));
}

double DeformationChain::longestEdge(const Ball& ball) const
{
    Ball current = ball;
    double longest = HUGE_VAL;
    double growth = 1.0;
    for (std::size_t i = 0; i < _snapshots.size(); ++i)
    {
        if (i > 0)
        {
            growth *= _snapshots[i - 1]->lipschitz(current);
            current = _snapshots[i - 1]->bound(current);
        }
        longest = std::min(longest, _snapshots[i]->longestEdge(current, _tileError) / growth);
    }
    return longest;
}

double DeformationChain::verticalMovement(double lowest, double highest) const
{
    double movement = 0.0;
    for (const auto& snapshot : _snapshots)
    {
        const std::optional<double> low = snapshot->movedHeight(lowest),
                                    high = snapshot->movedHeight(highest);
        if (!low || !high) continue;
        movement += std::max(std::abs(*low - lowest), std::abs(*high - highest));
        lowest = *low;
        highest = *high;
    }
    return movement;
}

bool DeformationChain::movesVertically(const Ball& ball) const
{
    Ball current = ball;
    for (const auto& snapshot : _snapshots)
    {
        if (snapshot->reach(current) == DeformationSnapshot::Reach::Identity) continue;
        if (!snapshot->movedHeight(0.0)) return false;
        current = snapshot->bound(current);
    }
    return true;
}

Ball DeformationChain::bound(const Ball& ball) const
{
    Ball result = ball;
    for (const auto& snapshot : _snapshots)
        result = snapshot->bound(result);
    return result;
}

void DeformationChain::bound(const EyeBox& box, Hull& hull, double fineness) const
{
    if (_snapshots.empty())
    {
        hull.margin = hull.slack = 0.0;
        box.corners(hull.points);
        return;
    }
    EyeBox current = box;
    // What a hull is too wide, the next one is, too.
    double slack = 0.0;
    for (std::size_t i = 0; i < _snapshots.size(); ++i)
    {
        if (i > 0) current = around(hull, current);
        hull.slack = 0.0;
        _snapshots[i]->boundBox(current, hull, fineness);
        hull.slack += slack;
        slack = hull.slack + hull.margin;
    }
}

double DeformationChain::growthOf(const DeformationSnapshot& snapshot, const Ball& ball) const
{
    return _ownTiles ? snapshot.lipschitz(ball) : snapshot.groundStretch(ball);
}

double DeformationChain::detail(const Ball& ball) const
{
    Ball current = ball;
    double detail = 1.0;
    for (const auto& snapshot : _snapshots)
    {
        detail *= snapshot->detail(current) * snapshot->lipschitz(current);
        current = snapshot->bound(current);
    }
    return detail;
}

double DeformationChain::lodDistance(const Ball& ball, const osg::Vec3d& viewPoint, const Ball* bound) const
{
    Ball current = ball;
    double detail = 1.0;
    for (const auto& snapshot : _snapshots)
    {
        if (snapshot->reach(current) == DeformationSnapshot::Reach::Identity) continue;
        if (const std::optional<double> distance = snapshot->viewDistance(current))
            return ball.radius + *distance / (detail * snapshot->detail(current));
        detail *= snapshot->detail(current) * growthOf(*snapshot, current);
        current = bound && _snapshots.size() == 1 ? *bound : snapshot->bound(current);
    }
    const double distance = (current.center - viewPoint).length();
    if (detail == 1.0 && current.radius == ball.radius) return distance;
    // A range is the ball's radius and what must lie between it and the eye. What lies between is divided.
    const double gap = distance - current.radius;
    return gap > 0.0 ? ball.radius + gap / detail : distance * ball.radius / std::max(current.radius, 1e-30);
}

void DeformationSwitch::meet(const osg::StateSet* state)
{
    if (!state) return;
    const osg::StateSet::RefAttributePair* attribute =
        state->getAttributeList().empty() ? nullptr : state->getAttributePair(osg::StateAttribute::PROGRAM);
    if (!attribute) attribute = AssemblyProgram::of(*state);
    if (attribute && (!programOverridden || (attribute->second & osg::StateAttribute::PROTECTED)))
    {
        program = attribute->first;
        programOverridden = (attribute->second & osg::StateAttribute::OVERRIDE) != 0;
    }
    if (state->getDefineList().empty()) return;
    const osg::StateSet::DefinePair* define = state->getDefinePair("GEOFX_DEFORMATION");
    if (!define || (overridden && !(define->second & osg::StateAttribute::PROTECTED))) return;
    on = (define->second & osg::StateAttribute::ON) != 0;
    overridden = (define->second & osg::StateAttribute::OVERRIDE) != 0;
}

double largestScale(const osg::Matrixd& matrix)
{
    osg::Vec3d rows[3];
    for (int row = 0; row < 3; ++row)
        rows[row].set(matrix(row, 0), matrix(row, 1), matrix(row, 2));
    // The root of the largest eigenvalue of the matrix times its transpose, which is symmetric.
    const double diagonal[3] = {rows[0].length2(), rows[1].length2(), rows[2].length2()};
    const double beside[3] = {rows[1] * rows[2], rows[2] * rows[0], rows[0] * rows[1]};
    const double largest = std::max({diagonal[0], diagonal[1], diagonal[2]});
    const double square = beside[0] * beside[0] + beside[1] * beside[1] + beside[2] * beside[2];
    double eigenvalue = largest;
    // Most are turns and equal scales, whose rows stand upright on each other.
    if (square > 1e-18 * largest * largest)
    {
        // In closed form; Smith, Eigenvalues of a symmetric 3 × 3 matrix, 1961.
        const double mean = (diagonal[0] + diagonal[1] + diagonal[2]) / 3.0;
        const double x = diagonal[0] - mean;
        const double y = diagonal[1] - mean;
        const double z = diagonal[2] - mean;
        const double spread = std::sqrt((x * x + y * y + z * z + 2.0 * square) / 6.0);
        const double determinant = x * (y * z - beside[0] * beside[0]) -
                                   beside[2] * (beside[2] * z - beside[0] * beside[1]) +
                                   beside[1] * (beside[2] * beside[0] - y * beside[1]);
        const double share = std::clamp(determinant / (2.0 * spread * spread * spread), -1.0, 1.0);
        eigenvalue = std::max(largest, mean + 2.0 * spread * std::cos(std::acos(share) / 3.0));
    }
    return std::sqrt(eigenvalue) * (1.0 + 1e-6);
}

osg::Matrixd rigidPlacement(const DeformationChain& chain, const osg::Vec3d& reference, bool turn)
{
    return turn ? chain.placement(reference) : osg::Matrixd::translate(chain.deform(reference) - reference);
}

osg::Matrixd billboardModelView(const DeformationChain& chain, const osg::Billboard& billboard,
                                unsigned int drawable, const osg::Matrixd& modelView)
{
    // Children that were added as to any group have none.
    const bool placed = drawable < billboard.getPositionList().size();
    const osg::Vec3 position = placed ? billboard.getPosition(drawable) : osg::Vec3();
    const osg::Vec3d place = osg::Vec3d(position) * modelView;
    const bool moved = !chain.leavesAlone({place, 0.0});
    const osg::Matrixd placement = moved ? chain.placement(place) : osg::Matrixd();
    osg::Matrixd turned = moved ? modelView * placement : modelView;
    const osg::Vec3 eye(osg::Matrixd::inverse(turned).getTrans());
    billboard.computeMatrix(turned, eye, position);
    if (moved) turned.postMult(osg::Matrixd::inverse(placement));
    return turned;
}

} // namespace osgGeoFX
