// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/BoundingBox>
#include <osg/Matrixd>
#include <osg/Node>
#include <osg/NodeVisitor>
#include <osg/Vec3d>

#include <optional>

namespace osgGeoFX
{

/** Whether a tile of a terrain engine is out of sight, so that finer tiles need not be loaded for it.

    For engines below an EffectScene that choose levels of detail by themselves, and ask a callback for each tile, as osgEarth
    does (`TerrainEngine::setComputeTileRangeCallback`): a range of 0 keeps such a tile as it is. The engine's own frustum and
    distances know less. A deformation may need a much wider frustum than the picture, and the levels of a panorama map
    do not fall with the distance.

    `tile`: its bounding sphere is in the frame of the visitor's current modelview matrix. `visitor`: the cull visitor that
    the engine is traversed by. False for visitors of another kind than the scene's own, so the callback may stay where
    effects are off. In a pass, such as a close-up's, the tile is out of sight where the pass needs nothing of it.

    Threads: as for the visitor.

    @ingroup scene */
OSGGEOFX_EXPORT bool isTileOutOfSight(const osg::Node& tile, osg::NodeVisitor& visitor);

/** Whether a box of an engine's tile is out of sight, so that it need not be drawn. A tile's box knows more than its
    sphere, since tiles are flat.

    `box`: metres, in a frame of its own. `placement`: from there to the frame of the visitor's current modelview matrix. All
    else is as for isTileOutOfSight().

    @ingroup scene */
OSGGEOFX_EXPORT bool isBoxOutOfSight(const osg::BoundingBox& box, const osg::Matrixd& placement,
                                     osg::NodeVisitor& visitor);

/** How large the deformed picture shows a tile's bounding sphere, for engines that choose levels by that: pixels, as
    osg::CullStack::clampedPixelSize() measures them, over the visitor's LOD scale. What the engine's own culling stack says is of
    its frustum and not of the picture (`TerrainEngine::setComputeTilePixelSizeCallback`).

    0 where isTileOutOfSight() is true. Negative for visitors that are not the scene's own, and where nothing is deformed.

    @ingroup scene */
OSGGEOFX_EXPORT double tilePixelSize(const osg::Node& tile, osg::NodeVisitor& visitor);

/** Whether effects move what is below a node up and down at most, so that distances to it are nearly those of what is undeformed, by
    which an engine may blend its levels of detail. True where nothing is deformed, and false in passes, such as a close-up's.

    `node`: as the tile of isTileOutOfSight(), which may be the whole terrain. True for visitors that are not the scene's own.

    @ingroup scene */
OSGGEOFX_EXPORT bool isMovedVertically(const osg::Node& node, osg::NodeVisitor& visitor);

/** A view point from which all ground that the deformed picture shows is above the horizon, for things of an engine that are culled by
    the horizon of an undeformed globe, such as osgEarth's annotations: metres, in the frame of the scene's children. EffectScene::OPEN and
    PROXY need it.

    Empty for visitors that are not the scene's own, and where nothing is deformed.

    @ingroup scene */
OSGGEOFX_EXPORT std::optional<osg::Vec3d> raisedViewPoint(osg::NodeVisitor& visitor);

} // namespace osgGeoFX
