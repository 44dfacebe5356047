// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/CurvePanel.h>

#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/detail/CurveGraph.h>

#include <osg/Geometry>
#include <osgText/Text>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;
using Handle = CurveGraph::Handle;

const osg::Vec4 background(0.06f, 0.07f, 0.09f, 0.85f);
const osg::Vec4 field(0.13f, 0.15f, 0.19f, 0.9f);
const osg::Vec4 button(0.20f, 0.42f, 0.70f, 0.9f);
const osg::Vec4 bright(0.95f, 0.95f, 0.95f, 1.0f);
const osg::Vec4 dim(0.58f, 0.60f, 0.63f, 1.0f);
const osg::Vec4 curveColor(1.0f, 0.83f, 0.45f, 1.0f);
const osg::Vec4 horizonColor(0.45f, 0.68f, 0.95f, 0.9f);
const osg::Vec4 selectedColor(1.0f, 0.55f, 0.25f, 1.0f);

std::string percent(double share)
{
    return std::to_string(std::lround(100.0 * share)) + " %";
}

std::string factor(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "× %.2f", value);
    return text;
}

/// Sets what a hand has changed.
void apply(PanoramaMap& map, const CurveState& before, const CurveState& after)
{
    if (before.points != after.points) map.setCurvePoints(after.points);
    if (before.exaggeration != after.exaggeration) map.setExaggeration(after.exaggeration);
    if (before.horizonExaggeration != after.horizonExaggeration)
        map.setHorizonExaggeration(after.horizonExaggeration);
}

} // namespace

/// What is selected: the last thing that was pressed.
struct CurvePanel::Selection
{
    std::optional<Handle> handle;
};

/// All that the picture shows.
struct CurvePanel::Content
{
    std::string sentence; ///< in place of the rest, where there is no map
    CurveState state;
    std::optional<Handle> selected;

    bool operator==(const Content& other) const
    {
        return sentence == other.sentence && state == other.state && selected == other.selected;
    }
    std::string count() const
    {
        return std::to_string(state.points.size()) + " of " + std::to_string(PanoramaMap::mostCurvePoints) +
               " points";
    }
    std::string held() const
    {
        if (selected && selected->kind == Handle::POINT && selected->point < state.points.size())
        {
            const osg::Vec2d& point = state.points[selected->point];
            return "point " + std::to_string(selected->point + 1) + ": " + percent(point.x()) +
                   " of the way, " + percent(point.y()) + " of the horizon's height";
        }
        return state.points.empty() ? "no points: straight, then a parabola" : "click a point to select it";
    }
    std::string farFactor() const
    {
        return state.horizonExaggeration < 0.0 ? "as at the base" : factor(state.horizonExaggeration);
    }
};

/// Collects triangles and texts, and gives them out as one group.
class CurvePanel::Painter
{
public:
    Painter(const CurveGraph& graph, osgText::Font* font) : _graph(graph), _font(font)
    {
        _shapes->setVertexArray(_corners);
        _shapes->setColorArray(_colors, osg::Array::BIND_PER_VERTEX);
        _shapes->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
        _group->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
        _group->addChild(_shapes);
    }

    void box(const CurveGraph::Box& box, const osg::Vec4& color)
    {
        const osg::Vec2d low(std::round(box.left), std::round(box.bottom));
        const osg::Vec2d high(std::round(box.left + box.width), std::round(box.bottom + box.height));
        quad(low, {high.x(), low.y()}, high, {low.x(), high.y()}, color);
    }

    void line(const osg::Vec2d& from, const osg::Vec2d& to, double width, const osg::Vec4& color)
    {
        osg::Vec2d aside(from.y() - to.y(), to.x() - from.x());
        if (!(aside.normalize() > 0.0)) return;
        aside *= 0.5 * width;
        quad(from - aside, to - aside, to + aside, from + aside, color);
    }

    void disc(const osg::Vec2d& middle, double radius, const osg::Vec4& color)
    {
        constexpr int sides = 20;
        const auto rim = [&](int side)
        {
            const double angle = 2.0 * osg::PI * side / sides;
            return middle + osg::Vec2d(std::cos(angle), std::sin(angle)) * radius;
        };
        for (int side = 0; side < sides; ++side)
        {
            add(middle, color);
            add(rim(side), color);
            add(rim(side + 1), color);
        }
    }

    /// `bottom` is that of a line of text.
    void text(const std::string& words, double x, double bottom, osgText::Text::AlignmentType alignment,
              const osg::Vec4& color)
    {
        osg::ref_ptr<osgText::Text> text = new osgText::Text;
        if (_font) text->setFont(_font);
        text->setCharacterSize(static_cast<float>(_graph.text));
        const auto resolution = static_cast<unsigned int>(std::clamp(_graph.text * 1.5, 16.0, 96.0));
        text->setFontResolution(resolution, resolution);
        text->setAlignment(alignment);
        text->setColor(color);
        const double y = bottom + 0.5 * (_graph.line - 0.72 * _graph.text);
        text->setPosition(osg::Vec3(osg::Vec3d(std::round(x), std::round(y), 0.0)));
        text->setText(osgText::String(words, osgText::String::ENCODING_UTF8));
        _group->addChild(text);
    }

    void curve(const Content& now)
    {
        const CurveState& state = now.state;
        text(now.count(), outer(), _graph.lineBottom(0), right, bright);
        text(now.held(), inner(), _graph.lineBottom(1), left, dim);
        box(_graph.graph, field);
        line(_graph.placeOf(0.0, state.horizonLine), _graph.placeOf(1.0, state.horizonLine), thin(),
             horizonColor);
        const double count = static_cast<double>(state.heights.size() - 1);
        const auto at = [&](std::size_t step)
        {
            return _graph.placeOf(static_cast<double>(step) / count, state.heights[step] * state.horizonLine);
        };
        for (std::size_t i = 1; i < state.heights.size(); ++i)
            line(at(i - 1), at(i), 2.0 * thin(), curveColor);
        for (std::size_t i = 0; i < state.points.size(); ++i)
        {
            const osg::Vec2d place =
                _graph.placeOf(state.points[i].x(), state.points[i].y() * state.horizonLine);
            const bool selected = now.selected && *now.selected == Handle{Handle::POINT, i};
            disc(place, 0.5 * _graph.text, background);
            disc(place, 0.38 * _graph.text, selected ? selectedColor : bright);
        }
        text("base", _graph.graph.left, _graph.lineBottom(2), left, dim);
        text("horizon", _graph.graph.left + _graph.graph.width, _graph.lineBottom(2), right, dim);
    }

    void scales(const Content& now)
    {
        const CurveState& state = now.state;
        const bool own = state.horizonExaggeration >= 0.0;
        scale(now, Handle::NEAR_SCALE, "Heights at the base", factor(state.exaggeration), state.exaggeration,
              true);
        scale(now, Handle::FAR_SCALE, "at the horizon", now.farFactor(),
              own ? state.horizonExaggeration : state.exaggeration, own);
    }

    void help()
    {
        const double bottom = _graph.panel.bottom + _graph.margin;
        text("Drag a point; click the curve for a new one", inner(), bottom + _graph.line, left, dim);
        text("Right click or Delete removes it", inner(), bottom, left, dim);
        box(_graph.reset, button);
        text("Reset", _graph.reset.left + 0.5 * _graph.reset.width, _graph.reset.bottom,
             osgText::Text::CENTER_BASE_LINE, bright);
    }

    double inner() const { return _graph.panel.left + _graph.margin; }
    static constexpr auto left = osgText::Text::LEFT_BASE_LINE;
    static constexpr auto right = osgText::Text::RIGHT_BASE_LINE;

    osg::ref_ptr<osg::Group> take()
    {
        _shapes->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(_corners->size())));
        return _group;
    }

private:
    double outer() const { return _graph.panel.left + _graph.panel.width - _graph.margin; }
    double thin() const { return std::max(std::round(_graph.text / 10.0), 1.0); }
    void scale(const Content& now, Handle::Kind kind, const char* name, const std::string& words,
               double value, bool own)
    {
        const CurveGraph::Box& track = kind == Handle::NEAR_SCALE ? _graph.nearScale : _graph.farScale;
        text(name, inner(), track.bottom, left, bright);
        text(words, outer(), track.bottom, right, own ? bright : dim);
        box({track.left, track.bottom + 0.5 * track.height - thin(), track.width, 2.0 * thin()}, dim);
        const bool selected = now.selected && now.selected->kind == kind;
        disc(_graph.placeOf(track, value), 0.38 * _graph.text, selected ? selectedColor : own ? bright : dim);
    }
    void add(const osg::Vec2d& corner, const osg::Vec4& color)
    {
        _corners->push_back(osg::Vec3(osg::Vec3d(corner.x(), corner.y(), 0.0)));
        _colors->push_back(color);
    }
    void quad(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c, const osg::Vec2d& d,
              const osg::Vec4& color)
    {
        for (const osg::Vec2d& corner : {a, b, c, a, c, d})
            add(corner, color);
    }

    const CurveGraph& _graph;
    osgText::Font* _font;
    osg::ref_ptr<osg::Group> _group = new osg::Group;
    osg::ref_ptr<osg::Geometry> _shapes = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> _corners = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> _colors = new osg::Vec4Array;
};

CurvePanel::CurvePanel(EffectScene& scene, osgText::Font* font)
    : _scene(&scene), _font(font), _selection(std::make_unique<Selection>())
{
}

CurvePanel::~CurvePanel() = default;

void CurvePanel::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F4", "Toggle the bending curve: drag its points, click it for new ones");
    usage.addKeyboardMouseBinding("Delete", "Remove the selected point of the curve");
}

PanoramaMap* CurvePanel::map() const
{
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
    {
        auto* const each = dynamic_cast<PanoramaMap*>(_scene->getEffect(i));
        if (each && each->getEnabled() && each->getProjection()) return each;
    }
    return nullptr;
}

CurvePanel::Content CurvePanel::content() const
{
    Content result;
    if (const PanoramaMap* const shown = map())
    {
        result.state = CurveState::of(*shown);
        result.selected = _selection->handle;
    }
    else
        result.sentence = "No panorama map is shown; F11 makes one.";
    return result;
}

std::vector<std::string> CurvePanel::lines() const
{
    if (!_shown) return {};
    const Content now = content();
    if (!now.sentence.empty()) return {"Bending curve", now.sentence};
    return {"Bending curve\t" + now.count(), now.held(),
            "Heights at the base\t" + factor(now.state.exaggeration), "at the horizon\t" + now.farFactor()};
}

bool CurvePanel::removeHeld()
{
    PanoramaMap* const shown = map();
    if (!shown || !_selection->handle) return false;
    const CurveState before = CurveState::of(*shown);
    CurveState after = before;
    if (!CurveGraph::remove(*_selection->handle, after)) return false;
    apply(*shown, before, after);
    _selection->handle.reset();
    return true;
}

bool CurvePanel::push(const Event& event, const osg::Viewport& port)
{
    const CurveGraph graph(port.width(), port.height());
    const osg::Vec2d place(static_cast<double>(event.getX()) - port.x(),
                           static_cast<double>(event.getY()) - port.y());
    if (!graph.panel.has(place)) return false;
    PanoramaMap* const shown = map();
    if (!shown) return true;
    const CurveState before = CurveState::of(*shown);
    CurveState after = before;
    std::optional<Handle> handle = graph.handleAt(place, before);
    if (event.getButton() == Event::RIGHT_MOUSE_BUTTON)
    {
        _selection->handle = handle;
        removeHeld();
        return true;
    }
    if (event.getButton() != Event::LEFT_MOUSE_BUTTON) return true;
    if (handle && handle->kind == Handle::CURVE)
    {
        const std::optional<std::size_t> made = graph.insert(place, after);
        handle = made ? std::optional<Handle>(Handle{Handle::POINT, *made}) : std::nullopt;
    }
    if (handle && handle->kind == Handle::RESET)
    {
        after.points.clear();
        after.horizonExaggeration = -1.0;
        handle.reset();
    }
    // A press beside the middle of a point does not move it; one on a scale goes there.
    if (handle && handle->kind != Handle::POINT) graph.drag(*handle, place, after);
    _selection->handle = handle;
    apply(*shown, before, after);
    return true;
}

bool CurvePanel::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    const Event::EventType type = event.getEventType();
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    if (type == Event::KEYDOWN && event.getKey() == Event::KEY_F4)
    {
        _shown = !_shown;
        if (!_shown && _overlay) _overlay->setNodeMask(0u);
        _selection->handle.reset();
        action.requestRedraw();
        return true;
    }
    const osg::Viewport* const port = view ? view->getCamera()->getViewport() : nullptr;
    if (!_shown || !port) return false;
    bool handled = false;
    switch (type)
    {
    case Event::KEYDOWN:
        handled = event.getKey() == Event::KEY_Delete && removeHeld();
        break;
    case Event::PUSH:
    case Event::DOUBLECLICK:
        _held = handled = push(event, *port);
        break;
    case Event::DRAG:
        if (!_held) return false;
        handled = true;
        if (PanoramaMap* const shown = map(); shown && _selection->handle)
        {
            const CurveState before = CurveState::of(*shown);
            CurveState after = before;
            CurveGraph(port->width(), port->height())
                .drag(*_selection->handle,
                      {static_cast<double>(event.getX()) - port->x(),
                       static_cast<double>(event.getY()) - port->y()},
                      after);
            apply(*shown, before, after);
        }
        break;
    case Event::RELEASE:
        // What began here is nothing for a camera manipulator.
        handled = _held;
        _held = false;
        return handled;
    case Event::SCROLL:
        return CurveGraph(port->width(), port->height())
            .panel.has({static_cast<double>(event.getX()) - port->x(),
                        static_cast<double>(event.getY()) - port->y()});
    case Event::FRAME:
        show(*view);
        return false;
    default:
        return false;
    }
    if (handled) action.requestRedraw();
    return handled;
}

void CurvePanel::show(osgViewer::View& view)
{
    if (!_overlay && !_font) _font = osgText::readRefFontFile("fonts/arial.ttf");
    const bool fresh = showOverlay(view, _overlay, 9);
    const Content now = content();
    if (!fresh && _drawn && *_drawn == now) return;
    const osg::Viewport& port = *_overlay->getViewport();
    const CurveGraph graph(port.width(), port.height());
    Painter painter(graph, _font);
    painter.box(graph.panel, background);
    painter.text("Bending curve", painter.inner(), graph.lineBottom(0), Painter::left, bright);
    if (now.sentence.empty())
    {
        painter.curve(now);
        painter.scales(now);
        painter.help();
    }
    else
        painter.text(now.sentence, painter.inner(), graph.lineBottom(1), Painter::left, bright);
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(painter.take());
    _drawn = std::make_unique<Content>(now);
}

} // namespace osgGeoFX
