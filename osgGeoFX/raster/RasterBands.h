// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

namespace osgGeoFX
{

/// Which bands of a raster are shown, and which of their numbers are black and white. The raster's file and its numbers decide on
/// what is left open. A plain value.
/// @ingroup raster
struct OSGGEOFX_EXPORT RasterBands
{
    struct Channel
    {
        int band = 0; ///< from 1 on; 0: the file decides
        /// The numbers, as the file stores them, that are black and white. What is beyond them is black or white, too. Nothing: the
        /// numbers decide.
        std::optional<std::pair<double, double>> range;
    };
    std::array<Channel, 3>
        channels; ///< red, green and blue; the first one has the band of values and of classes

    /// Sets the range of all three by two different numbers with a comma between them, as options have it. False, and nothing is set, for
    /// another text.
    bool setRange(const std::string& text);
};

} // namespace osgGeoFX
