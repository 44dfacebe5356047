// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUps.h>
#include <tools/RandomSamples.h>

namespace geofx::test
{

/// Where random close-ups are, and how large.
struct CloseUpPlan
{
    bool globe = false;
    osg::Vec2d center;    ///< metres; longitude and latitude, radians, on a globe
    double reach = 800.0; ///< of the regions' centers to all four sides, metres
    double size = 500.0;  ///< of a region as a rule, metres
    double rise = 400.0;  ///< of a close-up above its region as a rule, metres
    bool anchors = true;
    bool oriented = true; ///< also those that turn with the camera
};

/// Every shape, soft and sharp, with masks of 32 to 128 texels.
osg::ref_ptr<osgGeoFX::RegionOfInterest> randomRegion(Random& random, const CloseUpPlan& plan);
/// Every orientation, edge, anchor and style; most have sensible numbers.
osg::ref_ptr<osgGeoFX::CloseUp> randomCloseUp(Random& random, const CloseUpPlan& plan);

/// "color", "height", "normal" and "class" over ± half metres about an origin as the plan has it.
osg::ref_ptr<osgGeoFX::SurfaceData> makeSurfaceData(const CloseUpPlan& plan, double half, int side = 64);

} // namespace geofx::test
