// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/TilePass.h>

#include <osg/CoordinateSystemNode>

namespace osgGeoFX
{

/// Of the posts with a height, the share in filled voids, and of all posts, that in voids too large to be filled.
double filledShare(const BuildPlan& plan);
double openShare(const BuildPlan& plan);

/// The node of terrain.osgb: metadata, and the root tile.
osg::ref_ptr<osg::CoordinateSystemNode> createRoot(const BuildPlan& plan, const TilePassResult& result);

/// What createRoot() has written of the textures.
TextureSummary readTextures(const osg::Object& root);

} // namespace osgGeoFX
