// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Island.h"

#include <osgGeoFX/mapping/ValueLegend.h>

namespace figure3
{

/// From where a figure is seen, and what lies over it.
struct Shot
{
    std::string view;          ///< see osgGeoFX::ViewPoint::parse()
    double fieldOfView = 38.0; ///< vertical, degrees
    std::vector<std::string> effects;
    osg::ref_ptr<osg::Node> legend;
};

/// A: fictive data: noise by day around the airport and the roads.
Shot noiseMap(Island& island);
/// B: a route along the roads with landmarks; what is away from it is dark and grey.
Shot route(Island& island);
/// C: three textures of the terrain by masks: relief, land cover, heights.
Shot textures(Island& island);
/// D: a town of houses within a mask, and a generalised one around it.
Shot towns(Island& island);
/// E: symbols on a generalised map.
Shot symbols(Island& island);
/// F: the ranges of transmitters, lobes and shadows, and where they overlap.
Shot transmitters(Island& island);

} // namespace figure3
