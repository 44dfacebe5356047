// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/ProbePanel.h>

#include <osgGeoFX/mapping/LayerWords.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/detail/SeriesGraph.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <tuple>
#include <utility>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;
using Text = osgText::Text;

const osg::Vec4 field(0.13f, 0.15f, 0.19f, 0.9f);
const osg::Vec4 button(0.20f, 0.42f, 0.70f, 0.9f);
const osg::Vec4 grid(0.30f, 0.33f, 0.38f, 0.9f);
const osg::Vec4 clockColor(0.45f, 0.68f, 0.95f, 1.0f);

constexpr std::size_t mostLines = 12;
/// A ray through all tiles costs milliseconds, so it waits until the pointer rests.
constexpr std::chrono::milliseconds rest(60);

std::string numberText(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.5g", value);
    return text;
}

/// A name for a file that no file system refuses.
std::string fileNameOf(const std::string& name)
{
    std::string file;
    for (const char letter : name)
    {
        const bool plain = std::isalnum(static_cast<unsigned char>(letter)) || letter == '-' || letter == '_';
        if (plain || (static_cast<unsigned char>(letter) & 0x80u))
            file += letter;
        else if (!file.empty() && file.back() != '_')
            file += '_';
    }
    while (!file.empty() && file.back() == '_')
        file.pop_back();
    return file.empty() ? "series" : file;
}

void drawPlot(OverlayShapes& shapes, const SeriesGraph& graph, const std::vector<std::string>& lines,
              double time)
{
    const double thin = std::max(std::round(graph.text / 12.0), 1.0);
    const PixelBox& area = graph.graph;
    shapes.box(graph.panel, overlay::background);
    shapes.box(area, field);
    for (const SeriesGraph::Tick& tick : graph.values)
    {
        const double y = std::round(graph.placeOf(graph.begin, tick.at).y());
        shapes.box(PixelBox{area.left, y, area.width, 1.0}, grid);
        shapes.text(tick.text, {area.left - 0.5 * graph.text, y - 0.36 * graph.text}, graph.text,
                    overlay::dim, Text::RIGHT_BASE_LINE);
    }
    for (const SeriesGraph::Tick& tick : graph.times)
    {
        const double x = std::round(graph.placeOf(tick.at, graph.low).x());
        shapes.box(PixelBox{x, area.bottom, 1.0, area.height}, grid);
        shapes.text(tick.text, {x, area.bottom - 1.3 * graph.text}, graph.text, overlay::dim);
    }
    for (const SeriesGraph::Curve& curve : graph.curves)
    {
        for (const std::vector<osg::Vec2d>& line : curve.lines)
        {
            shapes.line(line, 2.0 * thin, curve.color);
            // A single value between gaps has no line.
            for (const osg::Vec2d& place : line)
                shapes.disc(place, line.size() == 1 ? 2.0 * thin : thin, curve.color);
        }
    }
    if (time >= graph.begin && time <= graph.end)
    {
        const double x = std::round(graph.placeOf(time, graph.low).x());
        shapes.box(PixelBox{x - thin, area.bottom, 2.0 * thin, area.height}, clockColor);
        if (const std::optional<double> value = graph.valueAt(time))
            shapes.disc(graph.placeOf(time, *value), 0.35 * graph.text, clockColor);
    }
    const double left = graph.panel.left + graph.margin;
    double base = graph.close.bottom + 0.4 * graph.text;
    for (const std::string& each : lines)
    {
        shapes.text(each, {left, base}, graph.text,
                    base > area.top() + graph.line ? overlay::bright : overlay::dim, Text::LEFT_BASE_LINE);
        base -= graph.line;
    }
    for (const auto& [box, words] : {std::pair(graph.save, "Save"), std::pair(graph.close, "×")})
    {
        shapes.box(box, button);
        shapes.text(words, {box.middle().x(), box.bottom + 0.36 * graph.text}, graph.text, overlay::bright);
    }
}

void drawValues(OverlayShapes& shapes, const std::vector<std::string>& lines, const osg::Vec2d& pointer,
                const osg::Vec2d& size, double text)
{
    const double line = std::round(1.5 * text), margin = std::round(0.6 * text);
    PixelBox box;
    for (const std::string& each : lines)
        box.width = std::max(box.width, shapes.widthOf(each, text));
    box.width = std::ceil(box.width) + 2.0 * margin;
    box.height = line * static_cast<double>(lines.size()) + margin;
    // Beside the pointer, where there is room.
    const double away = 1.2 * text;
    box.left = pointer.x() + away;
    if (box.right() > size.x()) box.left = pointer.x() - away - box.width;
    box.left = std::round(std::clamp(box.left, 0.0, std::max(0.0, size.x() - box.width)));
    box.bottom = pointer.y() - away - box.height;
    if (box.bottom < 0.0) box.bottom = pointer.y() + away;
    box.bottom = std::round(std::clamp(box.bottom, 0.0, std::max(0.0, size.y() - box.height)));
    shapes.box(box, overlay::background);
    double base = box.top() - 0.5 * margin - line + 0.4 * text;
    for (const std::string& each : lines)
    {
        shapes.text(each, {box.left + margin, base}, text, overlay::bright, Text::LEFT_BASE_LINE);
        base -= line;
    }
}

} // namespace

/// All that the picture shows.
struct ProbePanel::Content
{
    std::vector<std::string> lines, plot;
    osg::Vec2d pointer;
    const LayerSeries* series = nullptr;
    unsigned int revision = 0;
    double time = 0.0;

    bool operator==(const Content& other) const
    {
        return std::tie(lines, plot, series, revision, time) ==
                   std::tie(other.lines, other.plot, other.series, other.revision, other.time) &&
               (lines.empty() || pointer == other.pointer);
    }
};

ProbePanel::ProbePanel(EffectScene& scene, osgText::Font* font) : _scene(&scene), _font(font) {}

ProbePanel::~ProbePanel() = default;

void ProbePanel::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("v and V", "Values of layers below the pointer; a plot of one in time");
}

std::vector<std::string> ProbePanel::lines() const
{
    std::vector<std::string> lines;
    if (!_shown || !_probe) return lines;
    for (const LayerReading& reading : _probe->readings)
    {
        if (lines.size() == mostLines)
        {
            lines.push_back("and " + std::to_string(_probe->readings.size() - mostLines) + " more");
            break;
        }
        lines.push_back(reading.text());
    }
    if (lines.empty()) lines.emplace_back("no layer here");
    return lines;
}

std::vector<std::string> ProbePanel::plotLines() const
{
    if (!_series) return {};
    std::vector<std::string> lines = {_title};
    const std::vector<LayerSeries::Point> points = _series->points();
    const auto known =
        std::count_if(points.begin(), points.end(), [](const auto& point) { return point.known; });
    LayerSequence& sequence = const_cast<LayerSeries&>(*_series).sequence();
    const LayerClock& clock = *sequence.getClock();
    if (!_note.empty())
        lines.push_back(_note);
    else if (known < static_cast<std::ptrdiff_t>(points.size()))
        lines.push_back(std::to_string(known) + " of " + std::to_string(points.size()) + " steps are read");
    else
    {
        const bool classes = sequence.steps().kind() == DataLayer::CLASS;
        const SeriesGraph graph(1280.0, 720.0, points, clock, classes);
        const std::optional<double> value = graph.valueAt(clock.getTime());
        const std::string name = value && classes ? LayerWords::nameOf(*sequence.getLayer(), *value) : "";
        std::string words = clock.text(clock.getTime());
        if (value)
            words += ": " + (name.empty() ? numberText(*value) : name) + (_unit.empty() ? "" : " " + _unit);
        lines.push_back(words);
        if (!_series->fault().empty()) lines.back() += " (some steps cannot be read)";
    }
    return lines;
}

osg::Vec2d ProbePanel::pointer(const osg::Viewport& port) const
{
    return {_x - port.x(), _y - port.y()};
}

void ProbePanel::plot(osgViewer::View& view)
{
    const osg::Vec2d at = pointer(*view.getCamera()->getViewport());
    const auto probe = LayerProbe::under(*_scene, *view.getCamera(), at.x(), at.y());
    const LayerReading* found = nullptr;
    for (std::size_t i = 0; probe && !found && i < probe->readings.size(); ++i)
        if (probe->readings[i].sequence) found = &probe->readings[i];
    if (!found) return closePlot();
    // A series that is not shown any more is kept: its end would wait for the step that it is reading.
    if (_series && &_series->sequence() != found->sequence) closePlot();
    osg::ref_ptr<LayerSeries>& series = _all[found->sequence.get()];
    if (!series) series = new LayerSeries(*found->sequence);
    _series = series;
    _series->setPlace(found->raster);
    _name = found->name;
    _unit = found->unit;
    _title = _name + (_unit.empty() ? "" : " (" + _unit + ")");
    _note.clear();
}

void ProbePanel::closePlot()
{
    if (_series) _series->setPlace(std::nullopt);
    _series = nullptr;
    _note.clear();
}

void ProbePanel::save()
{
    const std::filesystem::path folder(_folder);
    const std::string name = fileNameOf(_name);
    std::filesystem::path file = folder / (name + ".csv");
    std::error_code fault;
    for (int number = 2; std::filesystem::exists(file, fault); ++number)
        file = folder / (name + "-" + std::to_string(number) + ".csv");
    std::string error;
    const bool done = _series->writeCsv(file.string(), _name, _unit, error);
    _note = done ? "written: " + file.string() : error;
    if (!done) OSG_WARN << "osgGeoFX: " << error << std::endl;
}

bool ProbePanel::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    const osg::Viewport* const port = view ? view->getCamera()->getViewport() : nullptr;
    if (!port) return false;
    const auto type = event.getEventType();
    if (type == Event::MOVE || type == Event::DRAG || type == Event::PUSH)
    {
        _x = static_cast<double>(event.getX());
        _y = static_cast<double>(event.getY());
        _moved = true;
        _lastMove = std::chrono::steady_clock::now();
    }
    const osg::Vec2d place = pointer(*port);
    if (type == Event::KEYDOWN && (event.getKey() == 'v' || event.getKey() == 'V'))
    {
        if (event.getKey() == 'V')
            plot(*view);
        else
        {
            _shown = !_shown;
            _probe.reset();
            _moved = true;
            _lastMove = {};
        }
        action.requestRedraw();
        return true;
    }
    if (type == Event::FRAME)
    {
        follow(*view);
        show(*view);
        return false;
    }
    // What began on the panel is nothing for a camera manipulator, also where the panel is gone.
    if (type == Event::RELEASE) return std::exchange(_held, false);
    if (!_series) return false;
    const SeriesGraph graph(port->width(), port->height(), {}, *_series->sequence().getClock(), false);
    const auto setTime = [&]
    {
        LayerClock& clock = *_series->sequence().getClock();
        const SeriesGraph whole(port->width(), port->height(), _series->points(), clock, false);
        clock.setTime(whole.timeAt(place.x()));
        _note.clear();
    };
    switch (type)
    {
    case Event::PUSH:
    case Event::DOUBLECLICK:
        _held = graph.panel.has(place);
        if (!_held || event.getButton() != Event::LEFT_MOUSE_BUTTON) return _held;
        if (graph.close.has(place))
            closePlot();
        else if (graph.save.has(place))
            save();
        else if (graph.graph.has(place))
            setTime();
        action.requestRedraw();
        return true;
    case Event::DRAG:
        if (_held && (event.getButtonMask() & Event::LEFT_MOUSE_BUTTON)) setTime();
        return _held;
    case Event::SCROLL:
        return graph.panel.has(place);
    default:
        return false;
    }
}

/// Looks for what is below the pointer, when it rests; what was found has the values of the present time.
void ProbePanel::follow(osgViewer::View& view)
{
    if (!_shown) return;
    const osg::Camera& camera = *view.getCamera();
    if (camera.getViewMatrix() != _view)
    {
        _view = camera.getViewMatrix();
        _moved = true;
    }
    if (_moved && std::chrono::steady_clock::now() - _lastMove > rest)
    {
        _moved = false;
        const osg::Vec2d at = pointer(*camera.getViewport());
        _probe = LayerProbe::under(*_scene, camera, at.x(), at.y());
    }
    else if (_probe)
        _probe = LayerProbe::at(*_scene, _probe->world);
}

void ProbePanel::show(osgViewer::View& view)
{
    Content now;
    now.lines = lines();
    now.plot = plotLines();
    now.pointer = pointer(*view.getCamera()->getViewport());
    now.series = _series;
    if (_series)
    {
        now.revision = _series->revision();
        now.time = _series->sequence().getClock()->getTime();
    }
    if (now.lines.empty() && !_series)
    {
        if (_overlay) _overlay->setNodeMask(0u);
        _drawn.reset();
        return;
    }
    if (!_overlay && !_font) _font = osgText::readRefFontFile("fonts/arial.ttf");
    const bool fresh = showOverlay(view, _overlay, 11);
    if (!fresh && _drawn && *_drawn == now) return;
    const osg::Vec2d size(_overlay->getViewport()->width(), _overlay->getViewport()->height());
    const double text = overlayTextSize(size.y());
    _overlay->removeChildren(0, _overlay->getNumChildren());
    if (_series)
    {
        LayerSequence& sequence = _series->sequence();
        const SeriesGraph graph(size.x(), size.y(), _series->points(), *sequence.getClock(),
                                sequence.steps().kind() == DataLayer::CLASS);
        OverlayShapes shapes(_font);
        drawPlot(shapes, graph, now.plot, now.time);
        _overlay->addChild(shapes.group());
    }
    if (!now.lines.empty())
    {
        OverlayShapes shapes(_font);
        drawValues(shapes, now.lines, now.pointer, size, text);
        _overlay->addChild(shapes.group());
    }
    _drawn = std::make_unique<Content>(std::move(now));
}

} // namespace osgGeoFX
