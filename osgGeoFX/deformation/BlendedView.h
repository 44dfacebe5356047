// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>

namespace osgGeoFX
{

/** A bird's-eye view from high up, a pedestrian's view near the ground, and one bend between them on the way.

    Below `lowHeight` of the eye the pedestrian's view is in force as it is, above `highHeight` the bird's-eye view.
    On the way up between them the first one's bend unfolds until, halfway, the ground lies as it is, and then the
    second one's bends it down; both smoothly, and each with its own start, width and reference plane. Where one of the
    views has no bend, as a bird's eye that sees the natural horizon, its part of the way is plain.

    Curve, styles and details are this effect's own; the two views add what is their own: lines, distances, angles,
    reference planes, `tallest`. Their `enabled` is left out of account. */
class OSGGEOFX_EXPORT BlendedView : public PerspectiveBend
{
public:
    BlendedView();
    BlendedView(const BlendedView& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, BlendedView);

    /// Height of the eye above the ellipsoid or map zero, metres; 300 and below highHeight.
    bool setLowHeight(double metres) { return assign("lowHeight", metres); }
    double getLowHeight() const { return _lowHeight; }
    /// The same; 1500 by default.
    bool setHighHeight(double metres) { return assign("highHeight", metres); }
    double getHighHeight() const { return _highHeight; }

    /// Never null; null is refused.
    bool setBirdsEyeView(BirdsEyeView* view);
    BirdsEyeView* getBirdsEyeView() { return _birdsEye.get(); }
    const BirdsEyeView* getBirdsEyeView() const { return _birdsEye.get(); }
    bool setPedestrianView(PedestrianView* view);
    PedestrianView* getPedestrianView() { return _pedestrian.get(); }
    const PedestrianView* getPedestrianView() const { return _pedestrian.get(); }

    std::vector<Part> parts() override
    {
        return {{"birdsEyeView", _birdsEye.get()}, {"pedestrianView", _pedestrian.get()}};
    }
    const Properties& properties() const override;
    std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const override;

protected:
    ~BlendedView() override;
    std::string inconsistency() const override;

private:
    double _lowHeight = 300.0;
    double _highHeight = 1500.0;
    osg::ref_ptr<BirdsEyeView> _birdsEye;
    osg::ref_ptr<PedestrianView> _pedestrian;
};

} // namespace osgGeoFX
