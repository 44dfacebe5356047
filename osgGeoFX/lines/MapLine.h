// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec3d>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// A line of a map: a road, a lift, a river, a border. A plain value.
/// @ingroup lines
struct MapLine
{
    std::string style; ///< the style's name, such as "motorway" or "river"; empty for the usual one
    std::string name;  ///< UTF-8; empty for none
    /// At least two; as vector data have them (LineFile), or world coordinates on the ground (LinePlacement), metres.
    std::vector<osg::Vec3d> places;
};

} // namespace osgGeoFX
