// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>

namespace osgGeoFX
{

/** Changes from a pedestrian's view near the ground to a bird's-eye view high up, with a smooth transition.

    Below an eye height of `lowHeight` the pedestrian's view applies unchanged. Above `highHeight` the bird's-eye view
    does. Between the two heights the pedestrian's bend first flattens until, halfway, the ground is undeformed. Then
    the bird's-eye bend grows. Each view uses its own start, width and reference plane. If one of the views has no
    bend, for instance a bird's-eye view that sees the natural horizon, the ground is undeformed in its half of the
    transition.

    The curve, the styles and the levels of detail are set on this effect. The lines, distances, angles, reference
    planes and `tallest` are set on the two views. The `enabled` flags of the two views are ignored.
    @ingroup deformation */
class OSGGEOFX_EXPORT BlendedView : public PerspectiveBend
{
public:
    BlendedView();
    BlendedView(const BlendedView& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, BlendedView);

    /// Height of the eye above the ellipsoid or above map zero, metres, −12 000…1e7. It must be less than highHeight.
    /// Default: 300.
    bool setLowHeight(double metres) { return assign("lowHeight", metres); }
    double getLowHeight() const { return _lowHeight; }
    /// Height of the eye above the ellipsoid or above map zero, metres, −12 000…1e7. It must be more than lowHeight.
    /// Default: 1500.
    bool setHighHeight(double metres) { return assign("highHeight", metres); }
    double getHighHeight() const { return _highHeight; }

    /// The view is never null. A null pointer is refused with a warning: the setter returns false and keeps the former
    /// view.
    bool setBirdsEyeView(BirdsEyeView* view);
    BirdsEyeView* getBirdsEyeView() { return _birdsEye.get(); }
    const BirdsEyeView* getBirdsEyeView() const { return _birdsEye.get(); }
    /// The view is never null. A null pointer is refused in the same way.
    bool setPedestrianView(PedestrianView* view);
    PedestrianView* getPedestrianView() { return _pedestrian.get(); }
    const PedestrianView* getPedestrianView() const { return _pedestrian.get(); }

    std::vector<Part> parts() override
    {
        return {{"birdsEyeView", _birdsEye.get()}, {"pedestrianView", _pedestrian.get()}};
    }
    const Properties& properties() const override;
    std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const override;
    double mostCurvatureOf(Curve curve, const CameraRange& cameras) const override;
    double heightShare(const Ground& ground, double curvature) const override;

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
