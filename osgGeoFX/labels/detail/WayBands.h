// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <vector>

namespace osgGeoFX
{

/// Where the ways on a globe's ground (RouteMapping) run in a picture, for names to keep off. Each place of a way is as high as the place of
/// the name that is nearest to it, which is right where it counts. Ways without degrees, and those on planes, are left out.
std::vector<LabelBand> bandsOfWays(const EffectScene& scene, const DeformedView& view, const NameSet& names,
                                   const std::vector<NameSet::Seen>& seen);

} // namespace osgGeoFX
