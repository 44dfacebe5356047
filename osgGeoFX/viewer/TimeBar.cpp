// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/TimeBar.h>

#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/detail/OverlayShapes.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

const osg::Vec4 field(0.28f, 0.31f, 0.36f, 0.95f);
const osg::Vec4 past(0.95f, 0.72f, 0.30f, 1.0f);
constexpr double mostSpeed = 1e9;

/// What a second of the program brings: "6 h/s".
std::string speedText(double speed)
{
    const double size = std::abs(speed);
    const char* unit = "s";
    double value = speed;
    for (const auto& [name, seconds] :
         {std::pair("min", 60.0), std::pair("h", 3600.0), std::pair("d", 86400.0)})
    {
        if (size < 2.0 * seconds) break;
        unit = name;
        value = speed / seconds;
    }
    char text[48];
    std::snprintf(text, sizeof text, "%.3g %s/s", value, unit);
    return text;
}

} // namespace

/// Where everything is, pixels from the window's lower left corner.
struct TimeBar::Layout
{
    Layout(double width, double height)
    {
        text = overlayTextSize(height);
        const double reach = std::min(width - 2.0 * text, 52.0 * text);
        panel = {std::round(0.5 * (width - reach)), std::round(1.2 * text), std::round(reach), 3.4 * text};
        button = {panel.left + 0.5 * text, panel.bottom + 0.6 * text, 2.0 * text, 2.2 * text};
        const double begin = button.right() + text;
        track = {begin, panel.bottom + 0.75 * text, panel.right() - text - begin, 0.4 * text};
        // Easier to hit than to see.
        reachOfTrack = {track.left - 0.5 * text, panel.bottom, track.width + text, 1.7 * text};
        loop = {panel.right() - 16.0 * text, reachOfTrack.top(), 16.0 * text, 1.7 * text};
    }

    double text;
    PixelBox panel, button, track, reachOfTrack, loop;
};

struct TimeBar::Content
{
    std::string time, speed;
    double share = 0.0; ///< of the range
    bool playing = false;
    bool operator==(const Content& other) const
    {
        return time == other.time && speed == other.speed && share == other.share && playing == other.playing;
    }
};

TimeBar::TimeBar(LayerClock& clock, osgText::Font* font) : _clock(&clock), _font(font) {}

TimeBar::~TimeBar() = default;

void TimeBar::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F3", "Toggle the bar of the layers' time: drag it, click its button");
    usage.addKeyboardMouseBinding("y", "Let the layers' time go on, or pause it");
    usage.addKeyboardMouseBinding("x and X", "Double and halve the speed of the layers' time");
}

TimeBar::Content TimeBar::content() const
{
    const LayerClock& clock = *_clock;
    Content now;
    const double length = clock.getEnd() - clock.getBegin();
    now.time = clock.text(clock.getTime());
    now.speed = speedText(clock.getSpeed()) + (clock.getLoop() ? ", again and again" : ", once");
    now.share = length > 0.0 ? std::clamp((clock.getTime() - clock.getBegin()) / length, 0.0, 1.0) : 0.0;
    now.playing = clock.getPlaying();
    return now;
}

std::string TimeBar::text() const
{
    if (!_shown) return {};
    const Content now = content();
    return now.time + "\t" + now.speed + (now.playing ? "" : "\tpaused");
}

bool TimeBar::key(int code)
{
    const auto scale = [&](double factor)
    {
        _clock->setSpeed(std::clamp(_clock->getSpeed() * factor, -mostSpeed, mostSpeed));
    };
    switch (code)
    {
    case Event::KEY_F3:
        _shown = !_shown;
        if (!_shown) letGo();
        if (!_shown && _overlay) _overlay->setNodeMask(0u);
        return true;
    case 'y':
        _clock->setPlaying(!_clock->getPlaying());
        return true;
    case 'X':
        scale(0.5);
        return true;
    case 'x':
        scale(2.0);
        return true;
    default:
        return false;
    }
}

/// Ends what a button that is held does.
void TimeBar::letGo()
{
    if (_dragged) _clock->setPlaying(_plays);
    _held = _dragged = false;
}

void TimeBar::drag(double x, const Layout& layout)
{
    const double share = std::clamp((x - layout.track.left) / layout.track.width, 0.0, 1.0);
    _clock->setTime(_clock->getBegin() + share * (_clock->getEnd() - _clock->getBegin()));
}

bool TimeBar::push(const Event& event, double x, double y, const Layout& layout)
{
    if (!layout.panel.has({x, y})) return false;
    if (event.getButton() == Event::RIGHT_MOUSE_BUTTON) _clock->setSpeed(-_clock->getSpeed());
    if (event.getButton() != Event::LEFT_MOUSE_BUTTON) return true;
    if (layout.button.has({x, y}))
        _clock->setPlaying(!_clock->getPlaying());
    else if (layout.reachOfTrack.has({x, y}))
    {
        _dragged = true;
        _plays = _clock->getPlaying();
        _clock->setPlaying(false);
        drag(x, layout);
    }
    else if (layout.loop.has({x, y}))
        _clock->setLoop(!_clock->getLoop());
    return true;
}

bool TimeBar::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    if (event.getEventType() == Event::KEYDOWN)
    {
        const bool used = key(event.getKey());
        if (used) action.requestRedraw();
        return used;
    }
    const osg::Viewport* const port = view ? view->getCamera()->getViewport() : nullptr;
    if (!_shown || !port) return false;
    const Layout layout(port->width(), port->height());
    const double x = static_cast<double>(event.getX()) - port->x();
    const double y = static_cast<double>(event.getY()) - port->y();
    switch (event.getEventType())
    {
    case Event::PUSH:
    case Event::DOUBLECLICK:
        _held = push(event, x, y, layout);
        break;
    case Event::DRAG:
        if (_held && _dragged) drag(x, layout);
        break;
    case Event::RELEASE:
    {
        const bool held = _held;
        letGo();
        // What began here is nothing for a camera manipulator.
        return held;
    }
    case Event::SCROLL:
        return layout.panel.has({x, y});
    case Event::FRAME:
        show(*view);
        return false;
    default:
        return false;
    }
    if (_held) action.requestRedraw();
    return _held;
}

void TimeBar::show(osgViewer::View& view)
{
    if (!_overlay && !_font) _font = osgText::readRefFontFile("fonts/arial.ttf");
    const bool fresh = showOverlay(view, _overlay, 8);
    const Content now = content();
    if (!fresh && _drawn && *_drawn == now) return;
    const Layout layout(_overlay->getViewport()->width(), _overlay->getViewport()->height());
    const PixelBox &panel = layout.panel, &track = layout.track, &button = layout.button;
    OverlayShapes shapes(_font);
    shapes.box(panel, overlay::background);
    shapes.box(track, field);
    // These move by less than a pixel.
    const double at = track.left + now.share * track.width, thumb = 0.3 * layout.text;
    shapes.box({track.left, track.bottom}, {at, track.top()}, past);
    shapes.box({at - thumb, track.bottom - thumb}, {at + thumb, track.top() + thumb}, overlay::bright);
    if (now.playing)
        for (const double left : {button.left, button.right() - 0.35 * button.width})
            shapes.box(PixelBox{left, button.bottom, 0.35 * button.width, button.height}, overlay::bright);
    else
        shapes.polygon({{button.left, button.bottom},
                        {button.right(), button.middle().y()},
                        {button.left, button.top()}},
                       overlay::bright);
    const double base = layout.reachOfTrack.top() + 0.35 * layout.text;
    shapes.text(now.time, {track.left, base}, layout.text, overlay::bright, osgText::Text::LEFT_BASE_LINE);
    shapes.text(now.speed, {track.right(), base}, layout.text, overlay::bright,
                osgText::Text::RIGHT_BASE_LINE);
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(shapes.group());
    _drawn = std::make_unique<Content>(now);
}

} // namespace osgGeoFX
