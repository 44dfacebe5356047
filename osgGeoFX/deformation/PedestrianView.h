// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/PerspectiveBend.h>

namespace osgGeoFX
{

/** The pedestrian's view keeps the surroundings as they are and folds up the ground ahead like a map (paper, Section
    3.2).

    The bend keeps its distance from the camera and its angle in the world. A camera that looks up therefore sees more
    of the map. The axis of the bend is perpendicular to the camera's heading, whatever the pitch.
    @ingroup deformation */
class OSGGEOFX_EXPORT PedestrianView : public PerspectiveBend
{
public:
    PedestrianView() = default;
    PedestrianView(const PedestrianView& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, PedestrianView);

    /// The angle β by which the context is folded up, radians, 0…π/2. Default: π/3 (60°).
    bool setBendAngle(double angle) { return assign("bendAngle", angle); }
    double getBendAngle() const { return _bendAngle; }
    /// The distance d_b from the point below the camera to the line b, metres, −1e7…1e7. Default: 300.
    bool setFocusDistance(double metres) { return assign("focusDistance", metres); }
    double getFocusDistance() const { return _focusDistance; }
    /// The width d_s of the transition zone, metres, 0…1e7. The zone becomes wider if `tallest` requires it. Default:
    /// 500.
    bool setZoneWidth(double metres) { return assign("zoneWidth", metres); }
    double getZoneWidth() const { return _zoneWidth; }

    const Properties& properties() const override;
    std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const override;
    double mostCurvatureOf(Curve curve, const CameraRange& cameras) const override;

protected:
    ~PedestrianView() override;

private:
    double _bendAngle = 1.0471975511965976;
    double _focusDistance = 300.0;
    double _zoneWidth = 500.0;
};

} // namespace osgGeoFX
