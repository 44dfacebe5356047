// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The kit's effects from the words of a command line.
#pragma once

#include <osgGeoFX/effect/Effect.h>

#include <osg/Image>
#include <osg/ref_ptr>

#include <string>
#include <vector>

namespace flightgear
{

// All throw std::runtime_error with a sentence.

/// An effect from "KIND PROPERTY=VALUE ...". A panorama map finds the covers where Ground has them.
osg::ref_ptr<osgGeoFX::Effect> makeEffect(const std::string& line);

/// Close-ups from lines "LON,LAT,SIZE,HEIGHT,SCALE": degrees, metres, metres above its place, and a factor.
osg::ref_ptr<osgGeoFX::Effect> makeCloseUps(const std::vector<std::string>& lines);

/// A picture on the ground, half transparent, from "LON,LAT,WIDTH,HEADING,FILE": of its middle, degrees; metres; degrees.
osg::ref_ptr<osgGeoFX::Effect> makeMapping(const std::string& line);
osg::ref_ptr<osgGeoFX::Effect> makeMapping(double longitude, double latitude, double width, double heading,
                                           osg::Image& picture);

} // namespace flightgear
