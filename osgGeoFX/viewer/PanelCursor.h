// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osgGA/GUIEventAdapter>

#include <cstddef>

namespace osgGeoFX
{

/// Which row of a panel's list is selected, and the uppermost one that is shown.
struct OSGGEOFX_EXPORT PanelCursor
{
    std::size_t first = 0;
    std::size_t row = 0;

    /// The row or the list's last one; it is shown.
    void choose(std::size_t wanted, std::size_t total);
    /// Up, Down, Page Up, Page Down, Home and End; false for all other keys.
    bool key(int code, std::size_t total);
    /// By the wheel; the selected row may go out of sight.
    void scroll(osgGA::GUIEventAdapter::ScrollingMotion motion, std::size_t total);
};

} // namespace osgGeoFX
