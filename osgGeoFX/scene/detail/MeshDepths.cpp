// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/MeshDepths.h>

#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

double product(const osg::Vec4d& plane, const osg::Vec3d& point)
{
    return plane.x() * point.x() + plane.y() * point.y() + plane.z() * point.z() + plane.w();
}

using Polygon = std::vector<osg::Vec3d>;

/// The part of a polygon on the inner side of a plane.
void clip(Polygon& polygon, const osg::Vec4d& plane, Polygon& inside)
{
    inside.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const osg::Vec3d& a = polygon[i];
        const osg::Vec3d& b = polygon[(i + 1) % polygon.size()];
        const double ofA = product(plane, a), ofB = product(plane, b);
        if (ofA >= 0.0) inside.push_back(a);
        if ((ofA < 0.0) != (ofB < 0.0)) inside.push_back(a + (b - a) * (ofA / (ofA - ofB)));
    }
    polygon.swap(inside);
}

} // namespace

MeshDepths::MeshDepths(const osg::Drawable& drawable, const osg::Matrixd& modelView,
                       const DeformationChain& chain, const std::vector<osg::Vec4d>& planes,
                       const osg::Vec4d& depths)
{
    if (RigidParts::of(drawable)) return;
    const DrawableTriangles triangles(drawable);
    if (!triangles.tellAll()) return;
    struct Vertex
    {
        osg::Vec3d place;
        double depth;
        unsigned int outside; ///< a bit for each plane
    };
    std::vector<Vertex> vertices;
    vertices.reserve(triangles.positions().size());
    for (const osg::Vec3d& position : triangles.positions())
    {
        const osg::Vec3d place = chain.deform(position * modelView);
        Vertex vertex = {place, product(depths, place), 0};
        if (!std::isfinite(vertex.depth)) return;
        for (std::size_t i = 0; i < planes.size(); ++i)
            vertex.outside |= product(planes[i], place) < 0.0 ? 1u << i : 0u;
        vertices.push_back(vertex);
    }
    known = true;
    const auto include = [this](double depth)
    {
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    };
    Polygon polygon, other;
    const std::vector<unsigned int>& corners = triangles.corners();
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    {
        const Vertex* triangle[3] = {&vertices[corners[i]], &vertices[corners[i + 1]],
                                     &vertices[corners[i + 2]]};
        const auto [first, last] = std::minmax({triangle[0]->depth, triangle[1]->depth, triangle[2]->depth});
        if (first >= nearest && last <= farthest) continue;
        if (triangle[0]->outside & triangle[1]->outside & triangle[2]->outside) continue;
        const unsigned int crossed = triangle[0]->outside | triangle[1]->outside | triangle[2]->outside;
        if (crossed == 0)
        {
            include(first);
            include(last);
            continue;
        }
        polygon.assign({triangle[0]->place, triangle[1]->place, triangle[2]->place});
        for (std::size_t j = 0; j < planes.size() && !polygon.empty(); ++j)
            if (crossed & (1u << j)) clip(polygon, planes[j], other);
        for (const osg::Vec3d& place : polygon)
            include(product(depths, place));
    }
}

} // namespace osgGeoFX
