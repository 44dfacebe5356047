// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osgGA/GUIEventAdapter>

#include <cstddef>

namespace osgGeoFX
{

/// The selected row of a panel's list and the first row that is shown.
/// @ingroup viewer
struct OSGGEOFX_EXPORT PanelCursor
{
    std::size_t first = 0;
    std::size_t row = 0;

    /// Selects the wanted row, or the last row if that is larger, and scrolls it into sight.
    void choose(std::size_t wanted, std::size_t total);
    /// Handles Up, Down, Page Up, Page Down, Home and End. Returns false for all other keys.
    bool key(int code, std::size_t total);
    /// Scrolls by the wheel. The selected row may go out of sight.
    void scroll(osgGA::GUIEventAdapter::ScrollingMotion motion, std::size_t total);
};

} // namespace osgGeoFX
