// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/deformation/PerspectiveBend.h>

namespace osgGeoFX
{

/** The pedestrian's view: the surroundings as they are, and the ground ahead folded up like a map (paper, Section 3.2).

    The bend keeps its distance from the camera and its angle in the world, so looking up shows more of the map. It lies
    across the camera's heading, whatever the pitch. */
class OSGGEOFX_EXPORT PedestrianView : public PerspectiveBend
{
public:
    PedestrianView() = default;
    PedestrianView(const PedestrianView& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, PedestrianView);

    /// β, by which the context is folded up, radians, 0…π/2; 60° by default.
    bool setBendAngle(double angle) { return assign("bendAngle", angle); }
    double getBendAngle() const { return _bendAngle; }
    /// d_b, from the camera's foot to the line b, metres, −1e7…1e7; 300 by default.
    bool setFocusDistance(double metres) { return assign("focusDistance", metres); }
    double getFocusDistance() const { return _focusDistance; }
    /// d_s, the width of the transition zone, metres, 0…1e7; 500 by default. It is wider where `tallest` needs it.
    bool setZoneWidth(double metres) { return assign("zoneWidth", metres); }
    double getZoneWidth() const { return _zoneWidth; }

    const Properties& properties() const override;
    std::optional<BendPlacement> placementOf(Curve curve, const ViewGeometry& view) const override;

protected:
    ~PedestrianView() override;

private:
    double _bendAngle = 1.0471975511965976;
    double _focusDistance = 300.0;
    double _zoneWidth = 500.0;
};

} // namespace osgGeoFX
