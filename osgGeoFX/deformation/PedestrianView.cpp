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
        const Self defaults;
        list.push_back(Property::angle("bendAngle", defaults._bendAngle, 0.0, osg::PI_2)
                           .of<&Self::_bendAngle>()
                           .turnedBy(0.05));
        list.push_back(Property::number("focusDistance", defaults._focusDistance, -1e7, 1e7, "m")
                           .of<&Self::_focusDistance>());
        list.push_back(
            Property::number("zoneWidth", defaults._zoneWidth, 0.0, 1e7, "m").of<&Self::_zoneWidth>());
        return list;
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
