// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/PerspectiveBend.h>

namespace osgGeoFX
{

/** The bird's-eye view: a map below, and the skyline above it in the same picture (paper, Section 3.1).

    The ground up to `focusLine` (b_i in the paper) is drawn as ever. Behind it the ground bends down until it lies along
    the ray of `horizonLine` (r_i), so that the horizon stays on that line of the picture, whatever the camera does.
    Lines are fractions of the picture's height from its bottom. With a rolled camera the line runs through the
    middle of horizonLine to the vanishing point of the level direction across the view, as a real horizon does.

    The view is there where the rays of both lines meet the reference plane; where they do not (the eye is below it, or the
    natural horizon is below horizonLine) nothing is deformed, and the bend fades out before. It bends by 90° at most, and
    fades where the horizon's ray points backwards by up to 15°, or the focus line's by more than 75°; so a camera may
    look straight down and beyond. Any projection: off axis, orthographic (fading below a pitch of 3°), stereo. */
class OSGGEOFX_EXPORT BirdsEyeView : public PerspectiveBend
{
public:
    BirdsEyeView() = default;
    BirdsEyeView(const BirdsEyeView& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, BirdsEyeView);

    /// Where the transition zone begins, 0…1 and below horizonLine; 0.4 by default.
    bool setFocusLine(double fraction) { return assign("focusLine", fraction); }
    double getFocusLine() const { return _focusLine; }
    /// Where the horizon lies, 0…1; 0.85 by default.
    bool setHorizonLine(double fraction) { return assign("horizonLine", fraction); }
    double getHorizonLine() const { return _horizonLine; }
    /// Moves the axis nearer, from 0 (the paper's; the context is seen from its edge) to 0.9, so that the context lies
    /// lower and some of its ground shows; the horizon stays. 0 by default.
    bool setContextTilt(double share) { return assign("contextTilt", share); }
    double getContextTilt() const { return _contextTilt; }

    const Properties& properties() const override;
    std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const override;

protected:
    ~BirdsEyeView() override;
    std::string inconsistency() const override;

private:
    double _focusLine = 0.4;
    double _horizonLine = 0.85;
    double _contextTilt = 0.0;
};

} // namespace osgGeoFX
