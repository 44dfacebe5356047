// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/TileSight.h>

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/Transform>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// A liberty moves each part of a large tile another way, so what bounds all of it is wide. A tile that asks for finer ones is worth
/// a closer look.
constexpr int HALVINGS = 10;

} // namespace

bool tileOutOfSight(Visibility& sight, const DeformationChain& chain, const osg::LOD& node,
                    const osg::Matrixd& toView, double tileError, Visibility::Mask planes)
{
    const osg::Transform* tile = tileError > 0.0 ? TileInfo::coarseOf(node) : nullptr;
    osg::BoundingBoxd tileBox;
    if (!tile || !TileInfo::readBox(*tile, tileBox)) return false;
    osg::Matrixd placement;
    tile->computeLocalToWorldMatrix(placement, nullptr);
    const double range = static_cast<double>(node.getMaxRange(1));
    const auto radius = static_cast<double>(node.getBound().radius());
    const double error = std::max(0.0, range - radius) * tileError;
    osg::BoundingBox bounds(osg::Vec3(tileBox._min), osg::Vec3(tileBox._max));
    const osg::Vec3 more(osg::Vec3d(error, error, error));
    bounds._min -= more;
    bounds._max += more;
    return sight.outOfSight(chain, EyeBox::of(bounds, placement * toView), planes, HALVINGS);
}

} // namespace osgGeoFX
