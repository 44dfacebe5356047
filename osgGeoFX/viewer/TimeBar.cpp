// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/TimeBar.h>

#include <osgGeoFX/viewer/Overlay.h>

#include <osg/Geometry>
#include <osgText/Text>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

const osg::Vec4 background(0.06f, 0.07f, 0.09f, 0.85f);
const osg::Vec4 field(0.28f, 0.31f, 0.36f, 0.95f);
const osg::Vec4 past(0.95f, 0.72f, 0.30f, 1.0f);
const osg::Vec4 bright(0.95f, 0.95f, 0.95f, 1.0f);
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
    struct Box
    {
        double left = 0.0, bottom = 0.0, right = 0.0, top = 0.0;
        bool has(double x, double y) const { return x >= left && x <= right && y >= bottom && y <= top; }
    };

    Layout(double width, double height)
    {
        text = std::clamp(std::round(height / 50.0), 11.0, 22.0);
        const double reach = std::min(width - 2.0 * text, 52.0 * text);
        const double low = std::round(1.2 * text);
        panel = {std::round(0.5 * (width - reach)), low, std::round(0.5 * (width + reach)), low + 3.4 * text};
        button = {panel.left + 0.5 * text, panel.bottom + 0.6 * text, panel.left + 2.5 * text,
                  panel.top - 0.6 * text};
        track = {button.right + text, panel.bottom + 0.75 * text, panel.right - text,
                 panel.bottom + 1.15 * text};
        // Easier to hit than to see.
        reachOfTrack = {track.left - 0.5 * text, panel.bottom, track.right + 0.5 * text,
                        panel.bottom + 1.7 * text};
        loop = {panel.right - 16.0 * text, reachOfTrack.top, panel.right, panel.top};
    }

    double text;
    Box panel, button, track, reachOfTrack, loop;
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
    usage.addKeyboardMouseBinding("< and >", "Halve and double the speed of the layers' time");
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
    case '<':
        scale(0.5);
        return true;
    case '>':
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
    const double share =
        std::clamp((x - layout.track.left) / (layout.track.right - layout.track.left), 0.0, 1.0);
    _clock->setTime(_clock->getBegin() + share * (_clock->getEnd() - _clock->getBegin()));
}

bool TimeBar::push(const Event& event, double x, double y, const Layout& layout)
{
    if (!layout.panel.has(x, y)) return false;
    if (event.getButton() == Event::RIGHT_MOUSE_BUTTON) _clock->setSpeed(-_clock->getSpeed());
    if (event.getButton() != Event::LEFT_MOUSE_BUTTON) return true;
    if (layout.button.has(x, y))
        _clock->setPlaying(!_clock->getPlaying());
    else if (layout.reachOfTrack.has(x, y))
    {
        _dragged = true;
        _plays = _clock->getPlaying();
        _clock->setPlaying(false);
        drag(x, layout);
    }
    else if (layout.loop.has(x, y))
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
        return layout.panel.has(x, y);
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
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    const auto triangle =
        [&](const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c, const osg::Vec4& color)
    {
        for (const osg::Vec2d& corner : {a, b, c})
        {
            corners->push_back(osg::Vec3(osg::Vec3d(corner.x(), corner.y(), 0.0)));
            colors->push_back(color);
        }
    };
    const auto box = [&](double left, double bottom, double right, double top, const osg::Vec4& color)
    {
        triangle({left, bottom}, {right, bottom}, {right, top}, color);
        triangle({left, bottom}, {right, top}, {left, top}, color);
    };
    const Layout::Box& panel = layout.panel;
    const Layout::Box& track = layout.track;
    const Layout::Box& button = layout.button;
    box(panel.left, panel.bottom, panel.right, panel.top, background);
    box(track.left, track.bottom, track.right, track.top, field);
    const double at = track.left + now.share * (track.right - track.left);
    box(track.left, track.bottom, at, track.top, past);
    const double thumb = 0.3 * layout.text;
    box(at - thumb, track.bottom - thumb, at + thumb, track.top + thumb, bright);
    const double width = button.right - button.left;
    if (now.playing)
    {
        box(button.left, button.bottom, button.left + 0.35 * width, button.top, bright);
        box(button.right - 0.35 * width, button.bottom, button.right, button.top, bright);
    }
    else
        triangle({button.left, button.bottom}, {button.right, 0.5 * (button.bottom + button.top)},
                 {button.left, button.top}, bright);
    osg::ref_ptr<osg::Geometry> shapes = new osg::Geometry;
    shapes->setVertexArray(corners);
    shapes->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    shapes->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(corners->size())));
    shapes->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    group->addChild(shapes);
    const auto write = [&](const std::string& words, double x, osgText::Text::AlignmentType alignment)
    {
        osg::ref_ptr<osgText::Text> text = new osgText::Text;
        if (_font) text->setFont(_font);
        text->setCharacterSize(static_cast<float>(layout.text));
        const auto resolution = static_cast<unsigned int>(std::clamp(layout.text * 1.5, 16.0, 96.0));
        text->setFontResolution(resolution, resolution);
        text->setAlignment(alignment);
        text->setColor(bright);
        text->setPosition(osg::Vec3(
            osg::Vec3d(std::round(x), std::round(layout.reachOfTrack.top + 0.35 * layout.text), 0.0)));
        text->setText(osgText::String(words, osgText::String::ENCODING_UTF8));
        group->addChild(text);
    };
    write(now.time, track.left, osgText::Text::LEFT_BASE_LINE);
    write(now.speed, track.right, osgText::Text::RIGHT_BASE_LINE);
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(group);
    _drawn = std::make_unique<Content>(now);
}

} // namespace osgGeoFX
