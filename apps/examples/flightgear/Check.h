// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Compares pictures of SimGear's scenery with and without the kit's work.
#pragma once

#include "Drawing.h"

#include <osgGeoFX/viewer/ViewPoint.h>

namespace flightgear
{

/** Draws the scene from random cameras within 10 km of a place, and compares:
    - effects that do nothing, or move things by a millimetre, with the host's own picture;
    - each of the kit's effects that needs nothing else, and the scene's own, with culling and without.
    Says what differs. Returns 0 if nothing does, else 1. `folder`: where pictures that differ go; empty for nowhere. */
int check(const osgGeoFX::Scene& scene, const osgGeoFX::ViewPoint& place, int cameras, const Frame& frame,
          const std::string& folder);

} // namespace flightgear
