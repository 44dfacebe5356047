// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Drawable>
#include <osg/TriangleFunctor>
#include <osgGeoFX/effect/DeformationChain.h>

#include <algorithm>
#include <cfloat>
#include <vector>

namespace geofx::test
{

struct DepthSpan
{
    double nearest = DBL_MAX;
    double farthest = -DBL_MAX;
};

/// The depths of those parts of deformed triangles that are in the picture. A depth is w in clip coordinates.
struct ClippedTriangles
{
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false)
    {
        std::vector<osg::Vec4d> polygon;
        for (const osg::Vec3& vertex : {a, b, c})
            polygon.push_back(osg::Vec4d(chain->deform(osg::Vec3d(vertex) * modelView), 1.0) * projection);
        for (const osg::Vec4d& plane : {osg::Vec4d(1, 0, 0, 1), osg::Vec4d(-1, 0, 0, 1),
                                        osg::Vec4d(0, 1, 0, 1), osg::Vec4d(0, -1, 0, 1)})
        {
            std::vector<osg::Vec4d> inside;
            for (std::size_t i = 0; i < polygon.size(); ++i)
            {
                const osg::Vec4d& from = polygon[i];
                const osg::Vec4d& to = polygon[(i + 1) % polygon.size()];
                const double ofFrom = plane * from, ofTo = plane * to;
                if (ofFrom >= 0.0) inside.push_back(from);
                if ((ofFrom >= 0.0) != (ofTo >= 0.0))
                    inside.push_back(from + (to - from) * (ofFrom / (ofFrom - ofTo)));
            }
            polygon = inside;
        }
        for (const osg::Vec4d& corner : polygon)
        {
            span.nearest = std::min(span.nearest, corner.w());
            span.farthest = std::max(span.farthest, corner.w());
        }
    }

    const osgGeoFX::DeformationChain* chain = nullptr;
    osg::Matrixd modelView, projection;
    DepthSpan span;
};

/// Adds the depths of a drawable to a span.
inline void include(DepthSpan& span, const osg::Drawable& drawable, const osg::Matrixd& modelView,
                    const osg::Matrixd& projection, const osgGeoFX::DeformationChain& chain)
{
    osg::TriangleFunctor<ClippedTriangles> triangles;
    triangles.chain = &chain;
    triangles.modelView = modelView;
    triangles.projection = projection;
    triangles.span = span;
    drawable.accept(triangles);
    span = triangles.span;
}

} // namespace geofx::test
