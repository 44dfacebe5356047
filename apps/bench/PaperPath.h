// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <osg/Matrixd>

#include <array>
#include <string>
#include <vector>

namespace geofx::bench
{

/// A camera's way over Honolulu with an effect, as the paper on multi-perspective views measures them.
struct PaperPath
{
    /// Frames a second, without and with the deformation.
    struct Speed
    {
        double straight, bent;
    };

    std::string name;   ///< birdsEye-3 …: the paper's number of the path is behind the effect
    std::string what;   ///< for people
    std::string effect; ///< as on the command line
    /// The camera is led evenly from one to the next.
    std::vector<osgGeoFX::ViewPoint> places;
    double leastSpeed = 0.0;          ///< frames a second with the deformation over those without, at least
    double mostBytes = 0.0;           ///< bytes a frame with the deformation over those without, at most
    bool below = false;               ///< they must be fewer
    std::array<Speed, 3> paperSpeeds; ///< by size, the largest first
    double paperStraightBytes, paperBentBytes; ///< a frame, at the largest size

    /// World to eye; `share` of the way, 0 to 1. Throws BenchError where the database has no such place.
    osg::Matrixd view(double share, const osgGeoFX::Georeference& reference) const;
};

/// The paper's four paths over Honolulu: two for each effect.
const std::vector<PaperPath>& paperPaths();

} // namespace geofx::bench
