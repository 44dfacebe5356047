// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/Compass.h>

#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/detail/OverlayShapes.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

const osg::Vec4 north(0.96f, 0.36f, 0.30f, 1.0f);
const std::array<osg::Vec4, 3> partColors = {overlay::bright, overlay::warm, overlay::cold};

std::string degrees(double radians)
{
    return std::to_string(std::lround(osg::RadiansToDegrees(radians))) + "°";
}

osg::Vec2d atAngle(double clockwise, double radius)
{
    return osg::Vec2d(std::sin(clockwise), std::cos(clockwise)) * radius;
}

osg::Vec2d toPixel(const osg::Vec2d& place)
{
    return {std::round(place.x() * 2.0) / 2.0, std::round(place.y() * 2.0) / 2.0};
}

/// Where everything is, pixels from the viewport's lower left corner.
struct Layout
{
    Layout(double viewportWidth, double viewportHeight)
    {
        text = overlayTextSize(viewportHeight);
        const double width = 26.0 * text, height = 8.6 * text;
        // Above the place of the bar of time.
        low.set(std::round(viewportWidth - width - text), std::round(5.4 * text));
        high = low + osg::Vec2d(width, height);
        dial = low + osg::Vec2d(4.3 * text, 4.9 * text);
        radius = 3.1 * text;
        sideLow = low + osg::Vec2d(9.0 * text, 2.3 * text);
        sideHigh = high - osg::Vec2d(0.8 * text, 0.8 * text);
    }
    double text, radius;
    osg::Vec2d low, high; ///< the panel
    osg::Vec2d dial;      ///< the dial's center
    osg::Vec2d sideLow, sideHigh;
};

} // namespace

struct Compass::Content
{
    double width = 0.0, height = 0.0; ///< of the viewport
    double heading = 0.0;             ///< to half a degree
    std::string headingText, pitchText;
    std::array<std::string, 3> seen;
    std::vector<std::pair<ViewOrientation::Part, OverlayPoints>> ground; ///< pixels
    osg::Vec2d eye;
    OverlayPoints wedge;

    bool operator==(const Content& other) const
    {
        return width == other.width && height == other.height && heading == other.heading &&
               headingText == other.headingText && pitchText == other.pitchText && seen == other.seen &&
               ground == other.ground && eye == other.eye && wedge == other.wedge;
    }

    /// Fits the ground from the side into its part of the panel.
    void setGround(const ViewOrientation& view, const Layout& layout);
};

void Compass::Content::setGround(const ViewOrientation& view, const Layout& layout)
{
    // What the picture shows, and a little around it; far ground would make all else small.
    osg::Vec2d low, high;
    const double most = view.bend ? view.bend->place.start + 1.7 * view.bend->place.size : 6.0 * view.height;
    const auto isNear = [&](const ViewOrientation::Point& point)
    {
        return point.distance <= most;
    };
    for (const ViewOrientation::Point& point : view.profile)
    {
        if (!isNear(point)) continue;
        for (int axis = 0; axis < 2; ++axis)
        {
            low[axis] = std::min(low[axis], point.place[axis]);
            high[axis] = std::max(high[axis], point.place[axis]);
        }
    }
    const osg::Vec2d room = layout.sideHigh - layout.sideLow, size = high - low;
    const double scale = std::min(room.x() / std::max(size.x(), 1e-9), room.y() / std::max(size.y(), 1e-9));
    const osg::Vec2d corner = layout.sideLow + (room - size * scale) * 0.5;
    const auto pixel = [&](const osg::Vec2d& place)
    {
        return toPixel(corner + (place - low) * scale);
    };
    eye = pixel({});
    for (const ViewOrientation::Point& point : view.profile)
    {
        if (!isNear(point)) continue;
        const osg::Vec2d place = pixel(point.place);
        if (ground.empty() || ground.back().first != point.part)
        {
            // Without a gap.
            OverlayPoints begin;
            if (!ground.empty()) begin.push_back(ground.back().second.back());
            ground.emplace_back(point.part, begin);
        }
        if (ground.back().second.empty() || ground.back().second.back() != place)
            ground.back().second.push_back(place);
        if (!point.inPicture) continue;
        if (wedge.empty()) wedge.push_back(eye);
        wedge.push_back(place);
    }
}

Compass::Compass(EffectScene& scene, const Georeference* reference, osgText::Font* font)
    : CornerOverlay('o', "Toggle the compass, and how steeply the ground is seen"), _scene(&scene),
      _reference(reference), _font(font)
{
}

Compass::~Compass() = default;

std::string Compass::text() const
{
    if (!shown() || !_drawn || _drawn->headingText.empty()) return {};
    std::string result = _drawn->headingText + " " + _drawn->pitchText;
    for (const std::string& angle : _drawn->seen)
        if (!angle.empty()) result += " " + angle;
    return result;
}

void Compass::show(osgViewer::View& view)
{
    if (!_overlay && !_font) _font = osgText::readRefFontFile("fonts/arial.ttf");
    const bool fresh = showOverlay(view, _overlay, 6);
    const osg::Viewport& port = *_overlay->getViewport();
    const Layout layout(port.width(), port.height());
    Content content;
    content.width = port.width();
    content.height = port.height();
    if (const auto now = ViewOrientation::of(*_scene, *view.getCamera(), _reference.get()))
    {
        content.heading = std::round(osg::RadiansToDegrees(now->heading) * 2.0) / 2.0;
        content.headingText = std::to_string(std::lround(osg::RadiansToDegrees(now->heading)) % 360) + "°";
        content.pitchText = degrees(now->pitch);
        for (std::size_t part = 0; part < 3; ++part)
            if (now->seen[part]) content.seen[part] = degrees(*now->seen[part]);
        if (!now->profile.empty()) content.setGround(*now, layout);
    }
    if (!fresh && _drawn && *_drawn == content) return;
    draw(content);
    _drawn = std::make_unique<Content>(content);
}

void Compass::draw(const Content& content)
{
    const Layout layout(content.width, content.height);
    const double text = layout.text;
    OverlayShapes shapes(_font);
    shapes.box(layout.low, layout.high, overlay::background);
    if (!content.headingText.empty())
    {
        // The dial, which turns under a mark that stands still.
        const osg::Vec2d& dial = layout.dial;
        const double radius = layout.radius;
        const double heading = osg::DegreesToRadians(content.heading);
        shapes.disc(dial, radius, {0.16f, 0.18f, 0.22f, 0.9f});
        shapes.ring(dial, radius, 1.5, overlay::dim);
        for (int i = 0; i < 24; ++i)
        {
            const double angle = osg::PI * i / 12.0 - heading;
            const double length = i % 6 == 0 ? 0.0 : i % 2 == 0 ? 0.16 : 0.09;
            if (length > 0.0)
                shapes.line(
                    {dial + atAngle(angle, radius * (0.97 - length)), dial + atAngle(angle, radius * 0.97)},
                    1.5, overlay::dim);
        }
        const osg::Vec2d tip = dial + atAngle(-heading, 0.56 * radius);
        const osg::Vec2d tail = dial + atAngle(osg::PI - heading, 0.56 * radius);
        const osg::Vec2d side = atAngle(osg::PI_2 - heading, 0.15 * radius);
        shapes.polygon({dial - side, tip, dial + side}, north);
        shapes.polygon({dial - side, dial + side, tail}, overlay::bright);
        const char* const names[] = {"N", "E", "S", "W"};
        for (int i = 0; i < 4; ++i)
        {
            const osg::Vec2d at = dial + atAngle(osg::PI_2 * i - heading, 0.80 * radius);
            shapes.text(names[i], at - osg::Vec2d(0.0, 0.36 * text), text, i == 0 ? north : overlay::bright);
        }
        const osg::Vec2d top = dial + osg::Vec2d(0.0, radius);
        shapes.polygon({top - osg::Vec2d(0.0, 0.1 * text), top + osg::Vec2d(0.34 * text, 0.45 * text),
                        top + osg::Vec2d(-0.34 * text, 0.45 * text)},
                       overlay::warm);
        shapes.text(content.headingText, {dial.x(), layout.low.y() + 0.55 * text}, text, overlay::bright);
    }
    // The ground from the side.
    shapes.polygon(content.wedge, {0.95f, 0.95f, 0.95f, 0.14f});
    for (const std::size_t i : {std::size_t(1), content.wedge.size() - 1})
        if (i < content.wedge.size())
            shapes.line({content.wedge[0], content.wedge[i]}, 1.0, {0.95f, 0.95f, 0.95f, 0.55f});
    for (const auto& [part, points] : content.ground)
        shapes.line(points, 0.24 * text, partColors[part]);
    if (!content.ground.empty()) shapes.disc(content.eye, 0.28 * text, overlay::bright);
    // How steeply each is seen, in its color.
    double at = layout.sideLow.x();
    const double baseLine = layout.low.y() + 0.55 * text;
    if (!content.pitchText.empty())
    {
        shapes.text("pitch " + content.pitchText + "   seen at", {at, baseLine}, text, overlay::dim,
                    osgText::Text::LEFT_BASE_LINE);
        at += 10.2 * text;
    }
    for (std::size_t part = 0; part < 3; ++part)
    {
        if (!content.seen[part].empty())
            shapes.text(content.seen[part], {at, baseLine}, text, partColors[part],
                        osgText::Text::LEFT_BASE_LINE);
        at += 2.4 * text;
    }
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(shapes.group());
}

} // namespace osgGeoFX
