// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/detail/VectorShapes.h>

#include <vector>

namespace osgGeoFX
{

/// What of a closed ring lies within a half plane or a rectangle: Sutherland and Hodgman's way, whose edges along the border enclose nothing.
std::vector<osg::Vec2d> ringWithin(const std::vector<osg::Vec2d>& ring, const osg::Vec2d& low,
                                   const osg::Vec2d& high);

/// What of a line lies within a rectangle, piece by piece. `starts`: how far along the line each piece begins; may be null.
std::vector<std::vector<osg::Vec2d>> lineWithin(const std::vector<osg::Vec2d>& line, const osg::Vec2d& low,
                                                const osg::Vec2d& high,
                                                std::vector<double>* starts = nullptr);

/// The parts of a shape in degrees that lie in a box, whose longitudes may lie a full turn away; edges are a degree long at most.
std::vector<std::vector<osg::Vec2d>> cutToBox(const std::vector<std::vector<osg::Vec2d>>& parts, bool area,
                                              const DegreeBox& box);

} // namespace osgGeoFX
