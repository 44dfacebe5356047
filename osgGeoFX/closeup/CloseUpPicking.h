// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUps.h>

#include <osg/Camera>
#include <osg/Vec2d>

#include <optional>

/// What pixels show of close-ups, both ways (paper: interactive close-ups, Section III.B). World coordinates are those of
/// the scene's children; pixels count from the lower left corner of the camera's viewport, and the middle of the first one
/// is (0.5, 0.5). `time` is the simulation's, seconds. To be used where the scene graph may be read: in event and update
/// traversals.
namespace osgGeoFX
{

class EffectScene;

struct CloseUpHit
{
    CloseUp* closeUp = nullptr; ///< never null
    bool onRegion = false;      ///< the pixel shows the region on the ground, not the close-up
    osg::Vec3d world;           ///< the place of the ground, undeformed
    osg::Vec2d place;           ///< the same in the region, −1…1
    osg::Vec3d drawn;           ///< where the picture has it, in the world
};

/** The close-up that a pixel shows, or the region of the ground, the last one where regions overlap. Nothing for the sky, for
    other ground, and where `closeUps`, an effect of the scene, draws nothing.

    Anchors are seen through, and so are close-ups that show their region only. Levels of detail and edges PRIMITIVES are those
    of the pipeline that drew last, with tessellation as fine as it can be; roundness is left out. */
OSGGEOFX_EXPORT std::optional<CloseUpHit> pickCloseUp(EffectScene& scene, CloseUps& closeUps,
                                                      const osg::Camera& camera, double x, double y,
                                                      double time = 0.0);

/// The pixel at which a close-up shows a place of the ground, if nothing hides it; nothing where that is behind the eye.
OSGGEOFX_EXPORT std::optional<osg::Vec2d> projectCloseUp(EffectScene& scene, const CloseUp& closeUp,
                                                         const osg::Camera& camera, const osg::Vec3d& world,
                                                         double time = 0.0);

/// By how much a close-up's offset must change, metres in the region's axes, for what is drawn at a place of the world to
/// appear at a pixel: in the plane through it parallel to the picture. Nothing where the place is behind the eye.
OSGGEOFX_EXPORT std::optional<osg::Vec3d> dragCloseUp(EffectScene& scene, const CloseUp& closeUp,
                                                      const osg::Camera& camera, const osg::Vec3d& drawn,
                                                      double x, double y, double time = 0.0);

} // namespace osgGeoFX
