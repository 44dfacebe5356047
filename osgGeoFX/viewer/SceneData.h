// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>

namespace osgGeoFX
{

class EffectScene;

/// Whether the last frame had all that the scene's effects read while it is shown: the tiles of rasters that are larger than memory
/// (PagedRaster), and the steps of layers in time (LayerSequence). What a pager reads is PagerMonitor's matter. Between frames.
/// @ingroup viewer
OSGGEOFX_EXPORT bool hasAllData(EffectScene& scene);

/// Why the last frame lacks a part of a raster that is larger than memory, as a sentence (PagedRaster::Statistics); empty if none does. Between
/// frames.
/// @ingroup viewer
OSGGEOFX_EXPORT std::string faultOfData(EffectScene& scene);

} // namespace osgGeoFX
