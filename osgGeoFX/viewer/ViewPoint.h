// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/Georeference.h>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The position and direction of a camera relative to the ground.

    Angles are radians, lengths are metres. The height is above the database's zero height. The heading turns
    clockwise from north. The pitch is negative downwards (−π/2…π/2). The roll is positive with the right wing down.
    @ingroup viewer */
struct OSGGEOFX_EXPORT ViewPoint
{
    double longitude = 0.0;
    double latitude = 0.0;
    double height = 0.0;
    double heading = 0.0;
    double pitch = 0.0;
    double roll = 0.0;

    /// Reads "LON,LAT,HEIGHT,HEADING,PITCH[,ROLL]" in degrees and metres. Returns nothing, with a sentence in `error`, if
    /// the text is wrong.
    static std::optional<ViewPoint> parse(const std::string& text, std::string& error);

    /// The same from five or six numbers in that order. Latitude and pitch must lie within ±90 degrees.
    static std::optional<ViewPoint> fromNumbers(const std::vector<double>& numbers, std::string& error);

    /// World to eye space. Returns false if the place lies outside the database's projection.
    bool viewMatrix(const Georeference& reference, osg::Matrixd& view) const;
};

/// Interpolates between two view points. Longitude, heading and roll take the shorter arc. `t` is 0…1.
OSGGEOFX_EXPORT ViewPoint interpolate(const ViewPoint& a, const ViewPoint& b, double t);

/** The view matrix of a view from the south, 35° downwards, that shows all points as large as possible.

    The view looks at `center` (world coordinates). `fieldOfView` is vertical, in radians; `aspect` is width / height.
    Up is z or, if the reference is geocentric, the ellipsoid's normal. The reference may be null. */
OSGGEOFX_EXPORT osg::Matrixd viewOfPoints(const std::vector<osg::Vec3d>& points, const osg::Vec3d& center,
                                          const Georeference* reference, double fieldOfView, double aspect);

/// Reads comma-separated numbers. Returns nothing if one of them is not a finite number.
OSGGEOFX_EXPORT std::optional<std::vector<double>> parseNumbers(const std::string& text);

} // namespace osgGeoFX
