// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Compares pictures of SimGear's scenery with and without the kit's work.
#pragma once

#include <osgGeoFX/offscreen/SceneRenderer.h>

namespace flightgear
{

/** Draws the scene from random cameras within 15 km of a place, and compares:
    - an effect that hardly moves anything with the host's own picture, to a few levels of 255;
    - each deformation and the scene's own effects with culling and without it, bit for bit.
    Says what differs. Returns 0 if nothing does, else 1. */
int check(const osgGeoFX::Scene& scene, const osgGeoFX::ViewPoint& place, int cameras,
          const osgGeoFX::SceneRenderer::Options& options);

} // namespace flightgear
