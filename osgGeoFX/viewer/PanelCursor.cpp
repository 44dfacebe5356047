// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/PanelCursor.h>

#include <osgGeoFX/viewer/PanelPicture.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

constexpr std::size_t pageRows = PanelPicture::rows;
constexpr std::size_t wheelRows = 3;

} // namespace

void PanelCursor::choose(std::size_t wanted, std::size_t total)
{
    row = std::min(wanted, total == 0 ? 0 : total - 1);
    first = std::min({first, row, total - std::min(total, pageRows)});
    if (row >= first + pageRows) first = row - pageRows + 1;
}

bool PanelCursor::key(int code, std::size_t total)
{
    switch (code)
    {
    case Event::KEY_Up:
        choose(row > 0 ? row - 1 : 0, total);
        return true;
    case Event::KEY_Down:
        choose(row + 1, total);
        return true;
    case Event::KEY_Page_Up:
        choose(row > pageRows ? row - pageRows : 0, total);
        return true;
    case Event::KEY_Page_Down:
        choose(row + pageRows, total);
        return true;
    case Event::KEY_Home:
        choose(0, total);
        return true;
    case Event::KEY_End:
        choose(total, total);
        return true;
    default:
        return false;
    }
}

void PanelCursor::scroll(Event::ScrollingMotion motion, std::size_t total)
{
    const std::size_t last = total - std::min(total, pageRows);
    if (motion == Event::SCROLL_UP)
        first -= std::min(first, wheelRows);
    else if (motion == Event::SCROLL_DOWN)
        first = std::min(first + wheelRows, last);
}

} // namespace osgGeoFX
