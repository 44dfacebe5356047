// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUps.h>

#include <osg/Camera>
#include <osg/Vec2d>

#include <optional>

/// Picking of close-ups: from a pixel to the ground and from the ground to a pixel (paper: interactive close-ups,
/// Section III.B). World coordinates are those of the scene's children. Pixels count from the lower left corner of the
/// camera's viewport, and the middle of the first pixel is (0.5, 0.5). `time` is the simulation time, seconds. A
/// program calls the functions where it may read the scene graph: in event and update traversals.
namespace osgGeoFX
{

class EffectScene;

/// The place of a pixel on a close-up or on its region.
/// @ingroup closeup
struct CloseUpHit
{
    CloseUp* closeUp = nullptr; ///< never null
    bool onRegion = false;      ///< the pixel shows the region on the ground, not the close-up
    osg::Vec3d world;           ///< the place on the ground, undeformed, world coordinates
    osg::Vec2d place;           ///< the same place in the region, −1…1
    osg::Vec3d drawn;           ///< where the place is drawn, world coordinates
};

/** The close-up, or the region on the ground, that a pixel shows. If regions overlap, the last one counts. The result
    is empty over the sky, over other ground, and if `closeUps`, an effect of the scene, draws nothing.

    Anchors are ignored, and so are close-ups that show only their region. The levels of detail and the edges
    PRIMITIVES are those of the pipeline that drew last, with the finest possible tessellation. Roundness is ignored.
    @ingroup closeup */
OSGGEOFX_EXPORT std::optional<CloseUpHit> pickCloseUp(EffectScene& scene, CloseUps& closeUps,
                                                      const osg::Camera& camera, double x, double y,
                                                      double time = 0.0);

/// The pixel at which a close-up shows a place of the ground, if nothing hides it. Empty if the place is behind the
/// eye.
/// @ingroup closeup
OSGGEOFX_EXPORT std::optional<osg::Vec2d> projectCloseUp(EffectScene& scene, const CloseUp& closeUp,
                                                         const osg::Camera& camera, const osg::Vec3d& world,
                                                         double time = 0.0);

/// The change of a close-up's offset, metres along the region's axes, that moves the drawn position `drawn` (world) to
/// a pixel, in the plane parallel to the image plane. Empty if the position is behind the eye.
/// @ingroup closeup
OSGGEOFX_EXPORT std::optional<osg::Vec3d> dragCloseUp(EffectScene& scene, const CloseUp& closeUp,
                                                      const osg::Camera& camera, const osg::Vec3d& drawn,
                                                      double x, double y, double time = 0.0);

} // namespace osgGeoFX
