// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "OffscreenView.h"
#include "Suite.h"

#include <osgGeoFX/scene/EffectScene.h>

#include <vector>

namespace geofx::bench
{

/// Patterns that are computed for each pixel, over all of the ground, against a plain color there and against nothing. The scene has a ground of
/// 10 km, and no effects afterwards.
std::vector<Figure> patternLayers(OffscreenView& view, osgGeoFX::EffectScene& scene,
                                  const Settings& settings);

} // namespace geofx::bench
