// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/BendHandles.h>

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/scene/DeformedView.h>
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

constexpr int key = 'd';
/// Metres above a place, from where its ground is looked for.
constexpr double reach = 1e5;
constexpr int steps = 16;

/// The part of a bend that a camera shows now.
PropertyHolder& partInForce(const BendOnGround& ground)
{
    auto* const both = dynamic_cast<BlendedView*>(ground.bend.get());
    if (!both) return *ground.bend;
    // Birds see the ground bend down.
    if (ground.place.angle < 0.0) return *both->getBirdsEyeView();
    return *both->getPedestrianView();
}

/// The height of the ground above the reference plane, as it is drawn without effects; 0 beside it.
double groundHeight(EffectScene& scene, const DeformedView& picture, double lodScale,
                    const BendOnGround& ground, double ahead, double across)
{
    const osg::Vec3d place = ground.at(ahead, across) * picture.modelView();
    const osg::Vec3d up = osg::Matrixd::transform3x3(ground.up, picture.modelView());
    const osg::ref_ptr<DeformationChain> none = new DeformationChain;
    const osg::ref_ptr<DeformedLineIntersector> ray = new DeformedLineIntersector(place + up * reach, -up);
    const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
        new DeformedIntersectionVisitor(ray, *none, picture.modelView(), lodScale);
    scene.getTerrain()->traverse(*visitor);
    if (ray->intersections().empty()) return 0.0;
    return reach - ray->intersections().front().distance;
}

/// As many digits as a hand can mean.
double rounded(double value, double range)
{
    const double step = std::pow(10.0, std::floor(std::log10(std::max(std::abs(range), 1e-9))) - 3.0);
    return std::round(value / step) * step;
}

} // namespace

BendHandles::BendHandles(EffectScene& scene, osgText::Font* font) : _scene(&scene), _font(font) {}

BendHandles::~BendHandles() = default;

void BendHandles::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding(std::string(1, static_cast<char>(key)),
                                  "Toggle handles to drag the bend with");
}

void BendHandles::setShown(bool shown)
{
    _shown = shown;
    if (_shown) return;
    useLines(nullptr);
    _handles.clear();
    _held.reset();
    if (_overlay) _overlay->setNodeMask(0u);
}

/// The lines of one bend are on, those of the one before as they were.
void BendHandles::useLines(PerspectiveBend* bend)
{
    if (_lined == bend || (bend && bend->getZoneLines())) return;
    if (_lined) _lined->setZoneLines(false);
    _lined = bend;
    if (_lined) _lined->setZoneLines(true);
}

void BendHandles::find(const osgViewer::View& view)
{
    _handles.clear();
    const osg::Camera& camera = *view.getCamera();
    const osg::Viewport& port = *camera.getViewport();
    const std::optional<BendOnGround> ground = BendOnGround::of(*_scene, camera);
    useLines(ground ? ground->bend.get() : nullptr);
    if (!ground) return;
    PropertyHolder& holder = partInForce(*ground);
    const DeformedView picture(*_scene, camera);
    const auto lodScale = static_cast<double>(camera.getLODScale());
    const double margin = 1.5 * overlayTextSize(port.height());
    const auto add = [&](const std::string& property, const osg::Vec2d& place, const osg::Vec3d& world)
    {
        const osg::Vec2d knob(std::clamp(place.x(), margin, port.width() - margin),
                              std::clamp(place.y(), margin, port.height() - margin));
        _handles.push_back({&holder, property, place, knob, world});
    };
    /// On the ground `ahead` of the eye, in a column of the picture.
    const auto addOnGround = [&](const std::string& property, double ahead, double column)
    {
        osg::Vec2d middle, beside;
        double across = 0.0;
        // Across the picture a bend changes nothing, so the columns of such a line grow evenly.
        if (picture.project(ground->at(ahead), middle) && picture.project(ground->at(ahead, 1.0), beside) &&
            std::abs(beside.x() - middle.x()) > 1e-9)
            across = (column * port.width() - middle.x()) / (beside.x() - middle.x());
        const osg::Vec3d world =
            ground->at(ahead, across, groundHeight(*_scene, picture, lodScale, *ground, ahead, across));
        osg::Vec2d pixel;
        if (picture.project(world, pixel)) add(property, pixel, world);
    };
    const BendPlacement& place = ground->place;
    const double end = place.start + place.size;
    if (const auto* const bird = dynamic_cast<const BirdsEyeView*>(&holder))
    {
        add("focusLine", {0.5 * port.width(), bird->getFocusLine() * port.height()}, ground->at(place.start));
        addOnGround("contextTilt", end, 0.2);
        add("horizonLine", {0.5 * port.width(), bird->getHorizonLine() * port.height()}, {});
    }
    else if (dynamic_cast<const PedestrianView*>(&holder))
    {
        addOnGround("focusDistance", place.start, 0.5);
        addOnGround("zoneWidth", end, 0.3);
        // As far behind the zone as the picture shows; the hand keeps the place that it holds.
        const auto inPicture = [&](double share)
        {
            osg::Vec2d pixel;
            return picture.project(ground->at(end + share * place.size), pixel) &&
                   pixel.y() < 0.8 * port.height();
        };
        if (!_held)
            for (_share = 1.0; _share > 0.05 && !inPicture(_share);)
                _share *= 0.8;
        addOnGround("bendAngle", end + _share * place.size, 0.7);
    }
}

bool BendHandles::push(const osg::Vec2d& pixel)
{
    double nearest = HUGE_VAL;
    for (std::size_t i = 0; i < _handles.size(); ++i)
    {
        const double away = (_handles[i].knob - pixel).length();
        if (!(away < nearest)) continue;
        nearest = away;
        _held = i;
        _offset = _handles[i].place - pixel;
    }
    return nearest < HUGE_VAL;
}

void BendHandles::drag(const osgViewer::View& view, const osg::Vec2d& pixel)
{
    const Handle handle = _handles[*_held];
    const osg::Camera& camera = *view.getCamera();
    const osg::Viewport& port = *camera.getViewport();
    const Property* const property = handle.holder->property(handle.property);
    const double wanted = pixel.y() + _offset.y();
    std::string error;
    if (handle.property == "focusLine" || handle.property == "horizonLine")
    {
        const double line = std::clamp(wanted / port.height(), property->minimum, property->maximum);
        // What does not fit the others is left as it is.
        handle.holder->setProperty(handle.property, rounded(line, 1.0), error);
        return;
    }
    // Where the place would be with another value. Nobody is told of these.
    const double former = property->get(*handle.holder);
    const bool ofAngle = handle.property == "bendAngle", ofWidth = handle.property == "zoneWidth";
    const auto rowOf = [&](double value, double& row)
    {
        property->put(*handle.holder, value);
        const std::optional<BendOnGround> ground = BendOnGround::of(*_scene, camera);
        osg::Vec2d place;
        bool found = false;
        if (ground)
        {
            // The place moves with the line that it stands on, at its height.
            const osg::Vec3d away = handle.world - ground->foot;
            const double end = ground->place.start + ground->place.size;
            const double ahead = handle.property == "focusDistance" ? ground->place.start
                                 : ofAngle                          ? end + _share * ground->place.size
                                                                    : end;
            found = DeformedView(*_scene, camera)
                        .project(ground->at(ahead, away * ground->right, away * ground->up), place);
        }
        property->put(*handle.holder, former);
        row = place.y();
        return found;
    };
    double row = 0.0, value = former, best = former;
    if (!rowOf(value, row)) return;
    double miss = std::abs(row - wanted);
    const double range = ofAngle || handle.property == "contextTilt" ? property->maximum - property->minimum
                                                                     : std::max({std::abs(former), 100.0});
    for (int i = 0; i < steps && std::abs(row - wanted) > 0.1; ++i)
    {
        // Of both sides, for a value may lie at an end of its range.
        const double step = 1e-4 * range;
        const double low = std::max(value - step, property->minimum),
                     high = std::min(value + step, property->maximum);
        double below = 0.0, above = 0.0;
        if (!rowOf(low, below) || !rowOf(high, above) || std::abs(above - below) < 1e-9) break;
        const double change = (wanted - row) * (high - low) / (above - below);
        double next = value + std::clamp(change, -0.3 * range, 0.3 * range);
        next = std::clamp(next, property->minimum, property->maximum);
        if (ofWidth) next = std::max(next, 1.0);
        if (next == value || !rowOf(next, row)) break;
        value = next;
        if (std::abs(row - wanted) >= miss) continue;
        miss = std::abs(row - wanted);
        best = value;
    }
    const double clamped = std::clamp(
        ofAngle ? osg::DegreesToRadians(rounded(osg::RadiansToDegrees(best), 90.0)) : rounded(best, range),
        property->minimum, property->maximum);
    handle.holder->setProperty(handle.property, clamped, error);
}

bool BendHandles::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    if (event.getEventType() == Event::KEYDOWN && event.getKey() == key)
    {
        setShown(!_shown);
        action.requestRedraw();
        return true;
    }
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    const osg::Viewport* const port = view ? view->getCamera()->getViewport() : nullptr;
    if (!_shown || !port) return false;
    const osg::Vec2d pixel(static_cast<double>(event.getX()) - port->x(),
                           static_cast<double>(event.getY()) - port->y());
    switch (event.getEventType())
    {
    case Event::PUSH:
    case Event::DOUBLECLICK:
    {
        _held.reset();
        const double reachOfKnob = 1.3 * overlayTextSize(port->height());
        const bool near =
            std::any_of(_handles.begin(), _handles.end(),
                        [&](const Handle& each) { return (each.knob - pixel).length() <= reachOfKnob; });
        constexpr int modifiers = Event::MODKEY_CTRL | Event::MODKEY_ALT | Event::MODKEY_SHIFT;
        if (event.getButton() != Event::LEFT_MOUSE_BUTTON || (event.getModKeyMask() & modifiers) || !near)
            return false;
        return push(pixel);
    }
    case Event::DRAG:
        if (!_held || *_held >= _handles.size()) return false;
        drag(*view, pixel);
        find(*view);
        if (_held && *_held >= _handles.size()) _held.reset();
        action.requestRedraw();
        return true;
    case Event::RELEASE:
    {
        const bool held = _held.has_value();
        _held.reset();
        return held;
    }
    case Event::FRAME:
        show(*view);
        return false;
    default:
        return false;
    }
}

void BendHandles::show(osgViewer::View& view)
{
    if (!_overlay && !_font) _font = osgText::readRefFontFile("fonts/arial.ttf");
    const bool fresh = showOverlay(view, _overlay, 7);
    find(view);
    if (_held && *_held >= _handles.size()) _held.reset();
    const osg::Viewport& port = *_overlay->getViewport();
    // In words, by which a change is seen.
    std::string now;
    std::vector<std::string> labels;
    for (const Handle& each : _handles)
    {
        const Property& property = *each.holder->property(each.property);
        const double value = property.get(*each.holder);
        char number[64];
        std::snprintf(number, sizeof number, "%.4g",
                      property.kind == Property::Kind::Angle ? osg::RadiansToDegrees(value) : value);
        labels.push_back(each.property + "  " + number +
                         (property.kind == Property::Kind::Angle ? "°"
                          : property.unit.empty()                ? ""
                                                                 : " " + property.unit));
        char place[64];
        std::snprintf(place, sizeof place, " %.1f %.1f", each.knob.x(), each.knob.y());
        now += labels.back() + place + (_held && &each == &_handles[*_held] ? " held\n" : "\n");
    }
    if (!fresh && now == _drawn) return;
    _drawn = now;
    OverlayShapes shapes(_font);
    const double text = overlayTextSize(port.height());
    for (std::size_t i = 0; i < _handles.size(); ++i)
    {
        const osg::Vec2d& knob = _handles[i].knob;
        const osg::Vec4 color = i == 0 ? overlay::warm : i == 1 ? overlay::cold : overlay::bright;
        const double size = _held == i ? 0.75 * text : 0.6 * text;
        if (_handles[i].property == "horizonLine")
            shapes.line({{knob.x() - 9.0 * text, knob.y()}, {knob.x() + 9.0 * text, knob.y()}}, 1.5, color);
        shapes.disc(knob, size + 0.22 * text, {0.06f, 0.07f, 0.09f, 0.85f});
        shapes.disc(knob, size, color);
        // Up and down.
        for (const double side : {-1.0, 1.0})
        {
            const osg::Vec2d tip = knob + osg::Vec2d(0.0, side * (size + 0.85 * text));
            const osg::Vec2d foot = knob + osg::Vec2d(0.0, side * (size + 0.4 * text));
            const osg::Vec2d half(0.42 * text, 0.0);
            shapes.polygon({foot - half, foot + half, tip}, color);
        }
        // A dark plate below the words, on the side where there is room.
        const double width = shapes.widthOf(labels[i], text) + 0.9 * text;
        const bool left = knob.x() + 1.4 * text + width > port.width();
        const double from = left ? knob.x() - 1.4 * text - width : knob.x() + 1.4 * text;
        shapes.box(PixelBox{from, knob.y() - 0.75 * text, width, 1.5 * text}, overlay::background);
        shapes.text(labels[i], {from + 0.5 * width, knob.y() - 0.36 * text}, text, color);
    }
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(shapes.group());
}

} // namespace osgGeoFX
