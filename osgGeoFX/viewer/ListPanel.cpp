// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/ListPanel.h>

#include <algorithm>

namespace osgGeoFX
{

ListPanel::ListPanel(int toggleKey, const PanelWords& words, PanelPicture::Corner corner, osgText::Font* font)
    : _toggleKey(toggleKey), _words(words), _picture(font, corner)
{
}

ListPanel::~ListPanel() = default;

void ListPanel::choose(std::size_t number)
{
    _cursor.choose(number, size());
}

bool ListPanel::pushBeside(const Event&, osgViewer::View&)
{
    return false;
}

PanelPage ListPanel::page() const
{
    PanelPage result;
    result.first = _cursor.first;
    result.selected = _cursor.row;
    result.total = size();
    const std::size_t last = std::min(_cursor.first + PanelPicture::rows, size());
    for (std::size_t i = _cursor.first; i < last; ++i)
        result.rows.push_back(row(i));
    return result;
}

void ListPanel::hide()
{
    _shown = false;
    _picture.hide();
    forget();
}

bool ListPanel::key(int code, int modifiers)
{
    if (_cursor.key(code, size()))
    {
        choose(_cursor.row);
        return true;
    }
    return _cursor.row < size() && change(code, modifiers);
}

bool ListPanel::push(const Event& event, osgViewer::View* view)
{
    const auto spot = _picture.spotAt(static_cast<double>(event.getX()), static_cast<double>(event.getY()));
    if (!spot) return view && pushBeside(event, *view);
    if (event.getButton() == Event::LEFT_MOUSE_BUTTON && spot->row && *spot->row < size())
    {
        choose(*spot->row);
        if (spot->onBox) pressBox(_cursor.row);
    }
    return true;
}

bool ListPanel::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    const Event::EventType type = event.getEventType();
    const bool toggled = type == Event::KEYDOWN && event.getKey() == _toggleKey;
    if (!_shown && !toggled) return false;
    const bool empty = !hasRows();
    if (empty || (_shown && toggled))
    {
        if (!_shown) return false;
        hide();
        action.requestRedraw();
        return toggled;
    }
    _shown = true;
    if (changed()) list();
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    bool handled = false;
    switch (type)
    {
    case Event::KEYDOWN:
        handled = toggled || key(event.getKey(), event.getModKeyMask());
        break;
    case Event::PUSH:
    case Event::DOUBLECLICK:
        _held = handled = push(event, view);
        break;
    case Event::DRAG:
        return _held;
    case Event::RELEASE:
        // What began here is nothing for a camera manipulator.
        handled = _held;
        _held = false;
        return handled;
    case Event::SCROLL:
        handled =
            _picture.spotAt(static_cast<double>(event.getX()), static_cast<double>(event.getY())).has_value();
        if (handled) _cursor.scroll(event.getScrollingMotion(), size());
        break;
    case Event::FRAME:
        // Once, however many keys came before it.
        if (view) _picture.show(*view, page(), _words);
        return false;
    default:
        return false;
    }
    if (handled) action.requestRedraw();
    return handled;
}

} // namespace osgGeoFX
