// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/scene/CameraRole.h>

#include <osgUtil/CullVisitor>

namespace osgGeoFX
{

/** Whether it is not the view's own camera that is being culled for.

    OSG never puts the view's camera, or a slave's, on the node path, and the stage that culling begins with is that
    camera's. Parents tell nothing: the cameras of osgShadow and of other techniques have none, and a slave of a view may
    have some. */
bool isNested(osgUtil::CullVisitor& visitor);

/// The camera whose motion is that of the camera that a visitor culls for: the view's own, for itself and for slaves with
/// relative matrices. Null for all others.
const osg::Camera* leaderOf(osgUtil::CullVisitor& visitor);

/// The role of the camera that a visitor culls for, by what is known of the camera alone.
CameraRole defaultRole(osgUtil::CullVisitor& visitor);

/** The view that a camera draws, at the node that its visitor has come to. `role` must not be UNDEFORMED.

    Even a camera in the role VIEW may draw another image than its own: OSG culls each eye of a stereo pair with other
    matrices than the camera's, and the view is that of the camera. */
ViewGeometry viewOf(osgUtil::CullVisitor& visitor, const CameraRole& role, const Ground& ground);

} // namespace osgGeoFX
