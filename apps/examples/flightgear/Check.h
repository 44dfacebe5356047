// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Compares pictures of SimGear's scenery with and without the kit's work.
#pragma once

#include "Drawing.h"
#include "Ground.h"

#include <osgGeoFX/viewer/ViewPoint.h>

namespace flightgear
{

struct CheckOptions
{
    int cameras = 50;
    double nearest = 0.0; ///< for which large triangles are split, metres; 0: 1000
    std::string folder;   ///< where pictures that differ go; empty for nowhere
};

/** Draws the scene from random cameras within 10 km of a place, and compares:
    - effects that do nothing, or move things by a millimetre, with the host's own picture;
    - each of the kit's effects, or the scene's own where it has any, with culling and without.
    Says what differs. Returns 0 if nothing does, else 1. */
int check(const osgGeoFX::Scene& scene, Ground& ground, const osgGeoFX::ViewPoint& place,
          const CheckOptions& options, const Frame& frame);

} // namespace flightgear
