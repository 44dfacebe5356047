// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/EyeFrustum.h>

#include <osgGeoFX/scene/detail/MeshDepths.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

double planeDistance(const osg::Vec4d& plane, const osg::Vec3d& point)
{
    return plane.x() * point.x() + plane.y() * point.y() + plane.z() * point.z() + plane.w();
}

double cross(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The convex hull of points, counter-clockwise, by Andrew's monotone chain. Sorts the points.
std::vector<osg::Vec2d> convexOutline(std::vector<osg::Vec2d>& points)
{
    std::sort(points.begin(), points.end());
    std::vector<osg::Vec2d> outline(2 * points.size());
    std::size_t count = 0;
    for (const osg::Vec2d& point : points)
    {
        while (count >= 2 && cross(outline[count - 2], outline[count - 1], point) <= 0.0)
            --count;
        outline[count++] = point;
    }
    const std::size_t lower = count + 1;
    for (auto point = points.rbegin() + 1; point != points.rend(); ++point)
    {
        while (count >= lower && cross(outline[count - 2], outline[count - 1], *point) <= 0.0)
            --count;
        outline[count++] = *point;
    }
    outline.resize(count > 1 ? count - 1 : count);
    return outline;
}

/// The error that rounding on the GPU may add to a position.
double rounding(const osg::Vec3d& point)
{
    return 1e-6 * (std::abs(point.x()) + std::abs(point.y()) + std::abs(point.z())) + 1e-4;
}

/// The share of a box's radius by which near and far may lie farther apart than needed.
constexpr double coarse = 0.1;

/// Metres; 15 Earths. Bounds that are wider say nothing.
constexpr double BOUNDLESS = 2e8;

/// The farthest depth of a box over its nearest one, from which on its triangles are looked at.
constexpr double LOOSENESS = 1.1;

} // namespace

void EyeFrustum::set(const osg::Polytope* planes, const osg::Matrixd& projection, bool sides)
{
    _planes.clear();
    if (planes)
    {
        for (const osg::Plane& plane : planes->getPlaneList())
            _planes.push_back(plane.asVec4());
    }
    _projection = projection;
    _sides = sides;
}

EyeFrustum::Side EyeFrustum::side(const Ball& ball, Mask& mask) const
{
    const double radius = ball.radius + rounding(ball.center);
    for (std::size_t i = 0; i < _planes.size(); ++i)
    {
        if (!(mask & (1u << i))) continue;
        const double distance = planeDistance(_planes[i], ball.center);
        if (distance < -radius) return Side::Outside;
        if (distance >= radius) mask &= ~(1u << i);
    }
    return mask ? Side::Crossing : Side::Inside;
}

bool EyeFrustum::holds(const osg::Vec3d& point, Mask mask) const
{
    for (std::size_t i = 0; i < _planes.size(); ++i)
    {
        if ((mask & (1u << i)) && planeDistance(_planes[i], point) < 0.0) return false;
    }
    return true;
}

bool EyeFrustum::misses(const Hull& hull, Mask mask)
{
    int crossed = 0;
    for (std::size_t i = 0; i < _planes.size(); ++i)
    {
        if (!(mask & (1u << i))) continue;
        bool outside = true;
        bool inside = true;
        for (const osg::Vec3d& point : hull.points)
        {
            const double distance = planeDistance(_planes[i], point);
            const double slack = hull.margin + rounding(point);
            outside = outside && distance < -slack;
            inside = inside && distance > slack;
            if (!outside && !inside) break;
        }
        if (outside) return true;
        if (!inside) ++crossed;
    }
    // A hull that crosses one plane only is also on the inner side of it, and so in the picture.
    return crossed > 1 && _sides && missesPicture(hull);
}

bool EyeFrustum::missesPicture(const Hull& hull)
{
    // A hull beside a corner of the picture crosses planes and yet misses the picture. Where all of it lies before the
    // eye, its outline in the picture tells.
    const osg::Vec3d away(_projection(0, 3), _projection(1, 3), _projection(2, 3));
    const double w = away.length();
    const bool perspective = w > 0.0;
    double nearest = DBL_MAX;
    double widest = 0.0;
    _points.clear();
    for (const osg::Vec3d& point : hull.points)
    {
        const double depth = perspective ? (away * point + _projection(3, 3)) / w : 1.0;
        nearest = std::min(nearest, depth);
        if (nearest <= 0.0) return false;
        const osg::Vec3d projected = point * _projection;
        _points.emplace_back(projected.x(), projected.y());
        widest = std::max({widest, std::abs(projected.x()), std::abs(projected.y())});
    }
    // The largest size of the margin in the picture.
    const double margin = hull.margin + 1e-6 * nearest;
    if (perspective && nearest <= 2.0 * margin) return false;
    // By how much the picture's x and y change for each metre, before they are divided by the depth.
    const osg::Vec3d x(_projection(0, 0), _projection(1, 0), _projection(2, 0));
    const osg::Vec3d y(_projection(0, 1), _projection(1, 1), _projection(2, 1));
    const double zoom = std::max(x.length(), y.length()) / (perspective ? w : 1.0);
    const double slack = perspective ? margin * (zoom + widest) / (nearest - margin) : margin * zoom;
    const double edge = 1.0 + 2.0 * slack + 1e-5 * (1.0 + widest);
    const std::vector<osg::Vec2d> outline = convexOutline(_points);
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
        const osg::Vec2d along = outline[(i + 1) % outline.size()] - outline[i];
        const osg::Vec2d outward(along.y(), -along.x());
        // The corner of the widened picture that is nearest to the hull on this side.
        const double corner = -edge * (std::abs(outward.x()) + std::abs(outward.y()));
        if (corner > outward * outline[i]) return true;
    }
    return false;
}

void DepthRange::clear(const osg::Vec4d& depths, Meshes meshes, const EyeFrustum* frustum)
{
    _depths = depths;
    _meshes = meshes;
    _frustum = frustum;
    _candidates.clear();
    _nearest = DBL_MAX;
    _farthest = -DBL_MAX;
}

void DepthRange::include(double nearest, double farthest)
{
    // As in OSG, things behind the eye do not count.
    if (farthest < 0.0) return;
    _nearest = std::min(_nearest, nearest);
    _farthest = std::max(_farthest, farthest);
}

void DepthRange::include(const Ball& ball)
{
    include(depthOf(ball.center) - ball.radius, depthOf(ball.center) + ball.radius);
}

void DepthRange::add(const EyeBox& box, const Ball& deformed, const DeformationChain& chain, const Mesh& mesh,
                     double margin)
{
    const double depth = depthOf(deformed.center);
    if (!std::isfinite(depth) || !std::isfinite(deformed.radius)) return;
    if (_meshes != Meshes::No && mesh.drawable)
    {
        // Nothing of it is certain, but that a box whose middle shows is about that far away.
        const bool isShown = _frustum && _frustum->holds(deformed.center, _frustum->all());
        if (_meshes == Meshes::Loosely && isShown) include(depth, depth);
        if (!covers(deformed))
            _candidates.push_back(
                {box, &chain, depth - deformed.radius, depth + deformed.radius, margin, mesh});
        return;
    }
    // The middle is certain. After a few boxes, most others lie between the depths that are certain.
    include(depth, depth);
    if (depth - deformed.radius >= _nearest && depth + deformed.radius <= _farthest) return;
    if (chain.leavesAlone(box.ball()))
    {
        const osg::Vec3d along(_depths.x(), _depths.y(), _depths.z());
        const double half =
            std::abs(box.half[0] * along) + std::abs(box.half[1] * along) + std::abs(box.half[2] * along);
        include(depth - half, depth + half);
        return;
    }
    _candidates.push_back({box, &chain, depth - deformed.radius, depth + deformed.radius, margin, mesh});
}

void DepthRange::measure(Candidate& candidate)
{
    const bool mesh = _meshes != Meshes::No && candidate.mesh.drawable;
    double nearest = candidate.nearest;
    double farthest = candidate.farthest;
    const auto measureMesh = [&]
    {
        if (!candidate.mesh.drawable || !_frustum) return false;
        const MeshDepths measured(*candidate.mesh.drawable, candidate.mesh.modelView, *candidate.chain,
                                  _frustum->planes(), _depths);
        if (!measured.known) return false;
        nearest = measured.nearest;
        farthest = measured.farthest;
        return true;
    };
    bool isKnown = true;
    if (!candidate.ofBox)
    {
        candidate.chain->bound(candidate.box, _hull, coarse);
        _hull.margin += candidate.margin;
        nearest = DBL_MAX;
        farthest = -DBL_MAX;
        for (const osg::Vec3d& point : _hull.points)
        {
            nearest = std::min(nearest, depthOf(point) - _hull.margin);
            farthest = std::max(farthest, depthOf(point) + _hull.margin);
        }
        // A projection has no bounds for what lies on the far side of the Earth. The triangles tell where they are drawn.
        const bool isBounded = nearest > -BOUNDLESS && farthest < BOUNDLESS;
        if (mesh)
        {
            // The triangles follow, where the box still counts.
            candidate.ofBox = true;
            candidate.nearest = std::max(candidate.nearest, nearest);
            candidate.farthest = std::min(candidate.farthest, farthest);
            // By its own depths alone, so that the result does not depend on what else there is.
            const bool isTight = nearest > 0.0 && farthest <= LOOSENESS * nearest;
            if (_meshes == Meshes::NearAndFar || !isTight) return;
            if (_meshes == Meshes::Near)
            {
                _farthest = std::max(_farthest, candidate.farthest);
                candidate.farthest = -DBL_MAX;
                return;
            }
        }
        isKnown = isBounded || measureMesh();
    }
    else
    {
        isKnown = measureMesh() || nearest > -BOUNDLESS;
    }
    if (isKnown && nearest <= farthest) include(nearest, farthest);
    // The candidate is done.
    candidate.nearest = DBL_MAX;
    candidate.farthest = -DBL_MAX;
}

void DepthRange::settle()
{
    // The farthest-reaching candidates come first. After them few others can still change the result.
    const auto nearer = [](const Candidate& a, const Candidate& b)
    {
        return a.nearest < b.nearest;
    };
    const auto farther = [](const Candidate& a, const Candidate& b)
    {
        return a.farthest < b.farthest;
    };
    while (!_candidates.empty())
    {
        Candidate& first = *std::min_element(_candidates.begin(), _candidates.end(), nearer);
        if (first.nearest >= _nearest) break;
        measure(first);
    }
    while (!_candidates.empty())
    {
        Candidate& last = *std::max_element(_candidates.begin(), _candidates.end(), farther);
        if (last.farthest <= _farthest) break;
        measure(last);
    }
    _candidates.clear();
}

} // namespace osgGeoFX
