// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DepthConvention.h>

#include <osg/Geometry>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

namespace osgGeoFX
{

/// When the effects' own images are drawn, among OSG's stages before the camera's: before the application's as a rule. What
/// stands in the water comes first, since the ground in a close-up shows it, too.
constexpr int mirrorOrder = -12, layerOrder = -10;

/// A square in the plane z = 0 from (low, low) to (1, 1). A program can fill the viewport, or a part of it, with it.
osg::ref_ptr<osg::Geometry> createSquare(float low);

/** A stage with a camera of its own, a copy of the camera that a pass is drawn for. Engines keep what they draw by
    camera, as osgEarth's terrain does, so a pass with the camera itself would take away what that one draws. The camera
    has no buffers and no callbacks, and sets nothing up. */
osg::ref_ptr<osgUtil::RenderStage> createStage();

/// Empties a stage of createStage() that draws into images of its own. The stage gets the camera's lights and view. It clears color
/// and depth.
void startStage(osgUtil::RenderStage& stage, osgUtil::CullVisitor& outer, const CameraDepth& depth,
                const osg::Vec4& clearColor);

} // namespace osgGeoFX
