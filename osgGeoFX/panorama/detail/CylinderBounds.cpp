// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/CylinderBounds.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

const double nothing = glsl::GEOFX_CYLINDER_NONE, partly = glsl::GEOFX_CYLINDER_FULL;
/// Where places begin to leave the picture and where they have left it, of the angle that is not drawn.
constexpr double leaving = 0.25, gone = 0.6;
/// The largest slope of the cubic that goes from 0 to 1.
constexpr double easeSlope = 1.5;

} // namespace

CylinderBounds::CylinderBounds(const glsl::geofx_Cylinder& view, const glm::dvec2& ground, double reach)
    : sideReach(reach)
{
    if (!(view.ring > 0.0)) return;
    const double ring = view.ring;
    const double away = glm::length(ground);
    const double near = std::max(away - reach, nothing * ring);
    const double reached = away > reach ? std::asin(reach / away) : osg::PI;
    const double middle = std::abs(glsl::geofx_cylinderPlace(view, ground).x / ring - view.middle);
    const double most = std::min(middle + reached, osg::PI);
    turned = std::max(middle - reached, 0.0);
    belowEye = away + reach < nothing * ring;

    sideReach = ring * (middle + reached < osg::PI ? reached : 2.0 * osg::PI);
    sideStretch = ring / near;
    sideCurvature = 2.0 * ring / (near * near);
    curvature = 1.0 / near;
    const double nearS = std::max(away - reach - ring, 0.0);
    width = ring / (ring + nearS);
    const bool beyondBase = away + reach > ring;
    widthRate = beyondBase ? width * width / ring : 0.0;
    widthSecond = beyondBase ? 2.0 * width * width * width / (ring * ring) : 0.0;
    widthKink = beyondBase && away - reach < ring ? 1.0 / ring : 0.0;

    const double left = osg::PI - view.halfArc;
    if (most > view.halfArc + leaving * left)
    {
        leavesPicture = true;
        shownRate += easeSlope / ((gone - leaving) * left) / near;
    }
    // On the way to the seam x goes back to the middle.
    if (most > view.halfArc + gone * left) sideStretch *= 1.0 + osg::PI * easeSlope / ((1.0 - gone) * left);
    if (away - reach < partly * ring)
    {
        leavesPicture = true;
        shownRate += easeSlope / ((partly - nothing) * ring);
        if (away - reach < nothing * ring) sideStretch += osg::PI * easeSlope / nothing;
    }
}

} // namespace osgGeoFX
