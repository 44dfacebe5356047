// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "OffscreenView.h"
#include "Suite.h"

#include <osgGeoFX/scene/EffectScene.h>

#include <vector>

namespace geofx::bench
{

/// A layer of 1024² texels that changes in each frame, against the same at rest. The scene has a ground of 10 km, and no effects afterwards.
std::vector<Figure> liveLayers(OffscreenView& view, osgGeoFX::EffectScene& scene, const Settings& settings);

/// A raster of 60,000² pixels, larger than memory: how soon it is sharp, the longest frame, and the memory that it takes.
std::vector<Figure> pagedRaster(OffscreenView& view, osgGeoFX::EffectScene& scene, const Settings& settings);

} // namespace geofx::bench
