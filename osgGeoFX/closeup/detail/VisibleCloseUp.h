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
    PixelRectangle part;                  ///< of the picture that its layers cover
    std::optional<PixelRectangle> lifted; ///< and of that, the close-up without its anchor
    int layer = 0;                        ///< the anchor's is the next one
    /// The close-up's and the anchor's; null where nothing is drawn into the layer alone.
    osgUtil::RenderStage* stages[2] = {nullptr, nullptr};
};

} // namespace osgGeoFX
