// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/PerspectiveBend.h>

#include <atomic>

namespace osgGeoFX
{

/** The bird's-eye view shows a map below and the skyline above it in one picture (paper, Section 3.1).

    The ground up to `focusLine` (b_i in the paper) stays as it is. Behind that line the ground bends down until it
    lies along the ray of `horizonLine` (r_i). The horizon therefore stays at that line of the viewport, however the
    camera moves. Both lines are fractions of the viewport's height, measured from its bottom. If the camera rolls, the
    horizon runs through the middle of horizonLine to the vanishing point of the horizontal direction across the view,
    as a natural horizon does.

    The bend exists only if the rays of both lines meet the reference plane. They miss it if the eye is below the plane
    or if the natural horizon is below horizonLine. In these cases nothing is deformed. The bend fades out before such
    a case is reached.

    Ground may lie below the ellipsoid or map zero: coasts by 100 m, the shore of the Dead Sea by 400 m. An eye near such ground
    would be below the plane. Where the database or EffectScene::setGround() tells that the ground goes below zero, the
    level from which planeHeight counts therefore sinks before a low eye, and stays below the eye by a quarter of the eye's height
    above the lowest ground. Where nobody tells, a warning does once.

    The bend angle is at most 90°. A camera may look straight down and beyond: the bend fades out as the ray of
    horizonLine turns from straight down to 15° backwards, or as the ray of focusLine turns from 75° backwards to the
    horizontal. Every projection works: off-axis, stereo and orthographic. With an orthographic projection the bend
    fades out as the view direction comes within 3° of the horizontal.
    @ingroup deformation */
class OSGGEOFX_EXPORT BirdsEyeView : public PerspectiveBend
{
public:
    BirdsEyeView() = default;
    BirdsEyeView(const BirdsEyeView& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, BirdsEyeView);

    /// The line where the transition zone begins, 0…1. It must be less than horizonLine. Default: 0.4.
    bool setFocusLine(double fraction) { return assign("focusLine", fraction); }
    double getFocusLine() const { return _focusLine; }
    /// The line at which the horizon lies, 0…1. It must be more than focusLine. Default: 0.85.
    bool setHorizonLine(double fraction) { return assign("horizonLine", fraction); }
    double getHorizonLine() const { return _horizonLine; }
    /// Moves the axis of the bend towards the camera, as a share from 0 to 0.9. With 0, the paper's value, the viewer
    /// sees the context from its edge. A larger value lowers the context and shows more of its ground. The horizon
    /// stays. Default: 0.
    bool setContextTilt(double share) { return assign("contextTilt", share); }
    double getContextTilt() const { return _contextTilt; }

    const Properties& properties() const override;
    std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const override;
    double mostCurvatureOf(Curve curve, const CameraRange& cameras) const override;
    double heightShare(const Ground& ground, double curvature) const override;
    osg::ref_ptr<const DeformationSnapshot> snapshot(const ViewGeometry& view) const override;

protected:
    ~BirdsEyeView() override;
    std::string inconsistency() const override;
    double planeHeight(const ViewGeometry& view) const override;

private:
    /// Whether T lies lower for an eye that is low.
    bool sinks(const Ground& ground) const;

    double _focusLine = 0.4;
    double _horizonLine = 0.85;
    double _contextTilt = 0.0;
    mutable std::atomic<bool> _saidBelow{false};
};

} // namespace osgGeoFX
