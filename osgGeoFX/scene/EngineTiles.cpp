// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/EngineTiles.h>

#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

namespace osgGeoFX
{

bool isTileOutOfSight(const osg::Node& tile, osg::NodeVisitor& visitor)
{
    auto* const ours = dynamic_cast<CompensatingCullVisitor*>(&visitor);
    return ours && ours->leavesOut(tile);
}

bool isBoxOutOfSight(const osg::BoundingBox& box, const osg::Matrixd& placement, osg::NodeVisitor& visitor)
{
    auto* const ours = dynamic_cast<CompensatingCullVisitor*>(&visitor);
    return ours && ours->leavesOut(box, placement);
}

double tilePixelSize(const osg::Node& tile, osg::NodeVisitor& visitor)
{
    auto* const ours = dynamic_cast<CompensatingCullVisitor*>(&visitor);
    return ours ? ours->pixelSize(tile) : -1.0;
}

bool isMovedVertically(const osg::Node& node, osg::NodeVisitor& visitor)
{
    auto* const ours = dynamic_cast<CompensatingCullVisitor*>(&visitor);
    return !ours || ours->movesVertically(node);
}

std::optional<osg::Vec3d> raisedViewPoint(osg::NodeVisitor& visitor)
{
    auto* const ours = dynamic_cast<CompensatingCullVisitor*>(&visitor);
    return ours ? ours->highPoint() : std::nullopt;
}

} // namespace osgGeoFX
