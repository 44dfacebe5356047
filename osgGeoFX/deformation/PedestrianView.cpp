// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/PedestrianView.h>

#include <osgGeoFX/effect/GlslFunctions.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

PedestrianView::PedestrianView(const PedestrianView& other, const osg::CopyOp& copy)
    : PerspectiveBend(other, copy), _bendAngle(other._bendAngle), _focusDistance(other._focusDistance),
      _zoneWidth(other._zoneWidth)
{
}

PedestrianView::~PedestrianView() = default;

const Properties& PedestrianView::properties() const
{
    using Self = PedestrianView;
    static const Properties all = []
    {
        Properties list = bendProperties();
        list.insert(
            list.end(),
            {Property::angle("bendAngle", "the angle by which the ground ahead is folded up", 0.0, osg::PI_2)
                 .of<&Self::_bendAngle>()
                 .turnedBy(0.05),
             Property::number(
                 "focusDistance",
                 "the distance from the point below the camera to where the transition zone begins", -1e7,
                 1e7, "m")
                 .of<&Self::_focusDistance>(),
             Property::number("zoneWidth",
                              "the width of the transition zone, which is wider where tallest needs it", 0.0,
                              1e7, "m")
                 .of<&Self::_zoneWidth>()});
        return withDefaultsOf(new Self, std::move(list));
    }();
    return all;
}

std::optional<BendPlacement> PedestrianView::placementOf(Curve curve, const ViewGeometry& view) const
{
    BendPlacement place;
    place.planeHeight = planeHeight(view);
    place.start = _focusDistance;
    place.angle = _bendAngle;
    // Every curve's curvature is its angle's share of 1/d.
    const double curvature = glsl::geofx_bendCurvature(glsl::geofx_makeBend(curve, 1.0, _bendAngle));
    place.size = std::max(_zoneWidth, curvature / mostCurvature(view, 1.0, 0.0));
    return place;
}

} // namespace osgGeoFX
