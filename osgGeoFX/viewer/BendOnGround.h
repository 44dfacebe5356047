// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/PerspectiveBend.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <optional>

namespace osgGeoFX
{

/** Where the bend of a camera lies on the undeformed ground. A value, for the time when it was made.

    Places and directions are in the frame of the scene's children, metres. The bend's lines lie across `forward`: the zone
    begins `place.start` metres ahead of `foot`, and ends `place.size` metres farther.
    @ingroup viewer */
struct OSGGEOFX_EXPORT BendOnGround
{
    osg::ref_ptr<PerspectiveBend> bend; ///< the effect in the scene's list
    BendPlacement place;
    osg::Vec3d foot;               ///< the point of the reference plane below the eye
    osg::Vec3d forward, right, up; ///< unit vectors: ahead and across in the plane, and its normal

    /// A place `ahead` metres before the eye's foot, `across` metres to the right, `height` metres above the reference plane.
    osg::Vec3d at(double ahead, double across = 0.0, double height = 0.0) const
    {
        return foot + forward * ahead + right * across + up * height;
    }

    /// The bend that the camera shows; empty if it shows none, or if another projection is in force, such as a panorama map.
    static std::optional<BendOnGround> of(EffectScene& scene, const osg::Camera& camera);
    /// The same for a view matrix and a projection.
    static std::optional<BendOnGround> of(EffectScene& scene, const osg::Matrixd& view,
                                          const osg::Matrixd& projection);
};

} // namespace osgGeoFX
