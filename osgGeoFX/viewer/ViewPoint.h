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

/** Where a camera stands and how it looks, relative to the ground.

    Radians and metres. Altitude is above the database's zero height; heading turns clockwise from north; pitch is
    negative downwards (−π/2…π/2); roll is positive with the right wing down. */
struct OSGGEOFX_EXPORT ViewPoint
{
    double longitude = 0.0;
    double latitude = 0.0;
    double altitude = 0.0;
    double heading = 0.0;
    double pitch = 0.0;
    double roll = 0.0;

    /// From "LON,LAT,ALT,HEADING,PITCH[,ROLL]" in degrees and metres; nothing, and a sentence in `error`, if it
    /// is not that.
    static std::optional<ViewPoint> parse(const std::string& text, std::string& error);

    /// From the same numbers, in the same order; the values are checked.
    static std::optional<ViewPoint> fromNumbers(const std::vector<double>& numbers, std::string& error);

    /// World to eye; false where the place lies outside the database's projection.
    bool viewMatrix(const Georeference& reference, osg::Matrixd& view) const;
};

/// Interpolates a view point; angles take the shorter arc. `t` is 0…1.
OSGGEOFX_EXPORT ViewPoint interpolate(const ViewPoint& a, const ViewPoint& b, double t);

/** A view that shows all of the points, obliquely from the south, as large as the picture allows.

    It looks at `center`. `fieldOfView` is the vertical one in radians, `aspect` the picture's width / height. The
    sky is up along z, or along the ellipsoid's normal if the reference (which may be null) is geocentric. */
OSGGEOFX_EXPORT osg::Matrixd viewOfPoints(const std::vector<osg::Vec3d>& points, const osg::Vec3d& center,
                                          const Georeference* reference, double fieldOfView, double aspect);

/// Comma-separated numbers; nothing if one of them is not a finite number.
OSGGEOFX_EXPORT std::optional<std::vector<double>> parseNumbers(const std::string& text);

} // namespace osgGeoFX
