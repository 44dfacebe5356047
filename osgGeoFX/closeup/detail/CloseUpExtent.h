// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/closeup/detail/CloseUpLayers.h>
#include <osgGeoFX/effect/PassEffect.h>

#include <optional>

namespace osgGeoFX
{

/// The part of a camera's picture in which a close-up of ground between two heights, metres above its region's base, may
/// show, with its anchor and line or without; nothing where it is out of sight. What is stretched reaches `beyond` metres out of
/// the region on the ground.
std::optional<PixelRectangle> partOf(const ScenePass& pass, const CloseUpItem& item, double lowest,
                                     double highest, double beyond, bool withAnchor);

/// Makes the camera's near and far planes contain it.
void widenDepths(const ScenePass& pass, const CloseUpItem& item, double lowest, double highest,
                 double beyond);

} // namespace osgGeoFX
