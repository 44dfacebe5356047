// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpLayers.h>

#include <optional>

namespace osgGeoFX
{

/// A close-up that is in sight: its part of the picture, its layers, and the stages that draw into them.
struct VisibleCloseUp
{
    std::size_t item = 0;
    PixelRectangle part;                  ///< the part of the picture that its layers cover
    std::optional<PixelRectangle> lifted; ///< the part with the close-up, without its anchor
    int layer = 0;                        ///< the anchor's is the next one
    /// The stages of the close-up and of its anchor. Null for a layer that has no stage of its own.
    osgUtil::RenderStage* stages[2] = {nullptr, nullptr};
};

} // namespace osgGeoFX
