// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec3d>

#include <limits>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A name of a map and the place that bears it. A plain value.
/// @ingroup labels
struct MapName
{
    enum Kind
    {
        POINT, ///< a summit, a town: one place
        LINE   ///< a lake, a range, a river: the name follows a curve
    };

    std::string text; ///< UTF-8
    Kind kind = POINT;
    /// The place, or the curve's points in the reading direction; world coordinates, metres.
    std::vector<osg::Vec3d> places;
    /// Of two names the one with the larger importance comes first. Not a number: unknown, which comes last.
    double importance = std::numeric_limits<double>::quiet_NaN();
    /// The style's name, such as "summit" or "lake"; empty for the usual one.
    std::string style;
    /// The height that the data state, metres; not a number: none.
    double height = std::numeric_limits<double>::quiet_NaN();
};

} // namespace osgGeoFX
