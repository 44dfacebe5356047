// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpExtent.h>

#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

std::optional<PixelRectangle> partOf(const ScenePass& pass, const CloseUpItem& item, double lowest,
                                     double highest, double beyond, double margin, bool withAnchor)
{
    const osg::Viewport& viewport = *pass.outer.getViewport();
    const auto width = static_cast<int>(viewport.width());
    const auto height = static_cast<int>(viewport.height());
    const PixelRectangle whole = {0, 0, width, height};
    if (!pass.compensate) return whole;
    double low[2] = {1e30, 1e30};
    double high[2] = {-1e30, -1e30};
    bool behind = false;
    const osg::Matrixd toClip = pass.view.image.toClip();
    const auto include = [&](const osg::Vec3d& point)
    {
        const osg::Vec4d clip = osg::Vec4d(point, 1.0) * toClip;
        // Near planes are found later; what lies beside the eye may be anywhere.
        if (!(clip.w() > 1e-3)) behind = true;
        const double place[2] = {clip.x() / clip.w(), clip.y() / clip.w()};
        for (int axis = 0; axis < 2; ++axis)
        {
            low[axis] = std::min(low[axis], place[axis]);
            high[axis] = std::max(high[axis], place[axis]);
        }
    };
    for (const osg::Vec3d& corner : item.liftedCorners(lowest, highest))
        include(corner);
    const double line = item.closeUp().getAnchor()->getLineWidth();
    if (withAnchor && (item.stretched() || item.fenced() || line > 0.0))
    {
        Hull hull;
        pass.chain.bound(item.groundBox(lowest, highest, beyond), hull);
        for (const osg::Vec3d& point : hull.points)
        {
            for (const double x : {-hull.margin, hull.margin})
            {
                for (const double y : {-hull.margin, hull.margin})
                {
                    for (const double z : {-hull.margin, hull.margin})
                        include(point + osg::Vec3d(x, y, z));
                }
            }
        }
    }
    if (behind) return whole;
    const double border = 2.0 + std::max(line, margin);
    const double size[2] = {viewport.width(), viewport.height()};
    int first[2], last[2];
    for (int axis = 0; axis < 2; ++axis)
    {
        const double from = (low[axis] + 1.0) / 2.0 * size[axis] - border;
        const double to = (high[axis] + 1.0) / 2.0 * size[axis] + border;
        if (!(from < size[axis] && to > 0.0)) return std::nullopt;
        first[axis] = static_cast<int>(std::max(std::floor(from), 0.0));
        last[axis] = static_cast<int>(std::min(std::ceil(to), size[axis]));
    }
    return PixelRectangle{first[0], first[1], last[0] - first[0], last[1] - first[1]};
}

void widenDepths(const ScenePass& pass, const CloseUpItem& item, double lowest, double highest, double beyond)
{
    if (pass.outer.getComputeNearFarMode() == osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR) return;
    double nearest = 1e30;
    double farthest = 0.0;
    for (const osg::Vec3d& corner : item.liftedCorners(lowest, highest))
    {
        nearest = std::min(nearest, -corner.z());
        farthest = std::max(farthest, -corner.z());
    }
    // Anchors end on the ground, which may lie outside the picture.
    Hull hull;
    pass.chain.bound(item.groundBox(lowest, highest, beyond), hull);
    for (const osg::Vec3d& point : hull.points)
        farthest = std::max(farthest, hull.margin - point.z());
    if (farthest <= 0.0) return;
    constexpr double share = 0.001; // of the far plane; it holds where the eye is within a close-up
    nearest = std::max(nearest, share * farthest);
    pass.outer.setCalculatedNearPlane(std::min(pass.outer.getCalculatedNearPlane(), nearest));
    pass.outer.setCalculatedFarPlane(std::max(pass.outer.getCalculatedFarPlane(), farthest));
}

} // namespace osgGeoFX
