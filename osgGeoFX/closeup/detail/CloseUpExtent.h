// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/closeup/detail/CloseUpLayers.h>
#include <osgGeoFX/effect/PassEffect.h>

#include <optional>

namespace osgGeoFX
{

/// The part of a camera's picture in which a close-up may show, with its anchor and line or without. Its ground lies
/// between two heights, metres above the region's base. Stretched triangles reach up to `beyond` metres out of the
/// region on the ground. Companions reach up to `margin` pixels out of what they belong to. Nothing if it is out of sight.
std::optional<PixelRectangle> partOf(const ScenePass& pass, const CloseUpItem& item, double lowest,
                                     double highest, double beyond, double margin, bool withAnchor);

/// Moves the camera's near and far planes apart, so that the close-up lies between them.
void widenDepths(const ScenePass& pass, const CloseUpItem& item, double lowest, double highest,
                 double beyond);

} // namespace osgGeoFX
