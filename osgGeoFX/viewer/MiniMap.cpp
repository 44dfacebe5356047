// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/MiniMap.h>

#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/detail/OverlayShapes.h>

#include <osg/LightSource>
#include <osgViewer/ViewerBase>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double fieldOfView = 20.0; ///< vertical, degrees: from afar, so that heights hardly move places
constexpr double usualLens = 30.0;   ///< vertical, degrees
constexpr double pixelErrors = 2.0;  ///< as many as in the window
constexpr double lead = 0.22;        ///< how far the middle lies ahead of the camera, of the map's width

osg::Vec4 faint(const osg::Vec4& color, float alpha)
{
    return {color.r(), color.g(), color.b(), alpha};
}

osg::Vec2d toPixel(const osg::Vec2d& place)
{
    return {std::round(place.x() * 2.0) / 2.0, std::round(place.y() * 2.0) / 2.0};
}

} // namespace

struct MiniMap::Content
{
    double viewWidth = 0.0, viewHeight = 0.0; ///< the whole viewport
    osg::Vec2d low, high;                     ///< the map, pixels
    double metres = 0.0;                      ///< for a pixel
    // Pixels:
    osg::Vec2d eye, ahead;               ///< the eye, and a unit vector ahead
    OverlayPoints focus, zone, context;  ///< what the picture takes in of each
    std::array<OverlayPoints, 2> border; ///< the bend's two lines

    bool operator==(const Content& other) const
    {
        return viewWidth == other.viewWidth && viewHeight == other.viewHeight && low == other.low &&
               high == other.high && eye == other.eye && ahead == other.ahead && focus == other.focus &&
               zone == other.zone && context == other.context && border == other.border;
    }
    void fill(const ViewOrientation& view, const osg::Camera& camera, const osg::Matrixd& modelView);
};

/// What of the picture's parts lies on the map.
void MiniMap::Content::fill(const ViewOrientation& view, const osg::Camera& camera,
                            const osg::Matrixd& modelView)
{
    const auto toMap = [&](const osg::Vec3d& direction)
    {
        return osg::Vec2d(direction * view.east, direction * view.north);
    };
    ahead = osg::Vec2d(std::sin(view.heading), std::cos(view.heading));
    eye = (low + high) * 0.5 - ahead * (lead * (high.x() - low.x()));
    // Between the picture's left and right borders, where it looks farthest.
    osg::Matrixd inverse, toWorld;
    inverse.invert(camera.getProjectionMatrix());
    toWorld.invert(modelView);
    OverlayPoints wedge = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    for (const double side : {-1.0, 1.0})
    {
        osg::Vec3d origin, ray;
        ViewGeometry::ray(camera.getProjectionMatrix(), inverse, side, 0.0, origin, ray);
        osg::Vec2d along = toMap(osg::Matrixd::transform3x3(ray, toWorld));
        const osg::Vec2d start = eye + toMap(osg::Matrixd::transform3x3(origin, toWorld)) / metres;
        if (along.normalize() <= 0.0) continue;
        const osg::Vec2d out(along.y() * side, -along.x() * side);
        wedge = clippedPolygon(wedge, out, out * start);
    }
    // What lies behind the eye is not in the picture.
    wedge = clippedPolygon(wedge, -ahead, -(ahead * eye));
    focus = wedge;
    if (!view.bend) return;
    const osg::Vec2d forward = toMap(view.bend->forward), right = toMap(view.bend->right);
    const double start = forward * eye + view.bend->place.start / metres;
    const double end = start + view.bend->place.size / metres;
    focus = clippedPolygon(wedge, forward, start);
    zone = clippedPolygon(clippedPolygon(wedge, -forward, -start), forward, end);
    context = clippedPolygon(wedge, -forward, -end);
    const osg::Vec2d reach = right * (high - low).length();
    border[0] = clippedSegment(eye + forward * (start - forward * eye) - reach,
                               eye + forward * (start - forward * eye) + reach, low, high);
    border[1] = clippedSegment(eye + forward * (end - forward * eye) - reach,
                               eye + forward * (end - forward * eye) + reach, low, high);
    for (OverlayPoints* const points : {&focus, &zone, &context, &border[0], &border[1]})
        for (osg::Vec2d& point : *points)
            point = toPixel(point);
}

MiniMap::MiniMap(EffectScene& scene, const Georeference* reference, const std::optional<TerrainInfo>& terrain)
    : CornerOverlay('i', "Toggle the small map with the parts of the bend"), _scene(&scene),
      _reference(reference), _terrain(terrain)
{
}

MiniMap::~MiniMap() = default;

void MiniMap::hide()
{
    CornerOverlay::hide();
    if (_map) _map->setNodeMask(0u);
}

std::optional<osg::Vec2d> MiniMap::pixelOf(const osg::Vec3d& world) const
{
    if (!shown() || !_drawn || !(_drawn->metres > 0.0)) return std::nullopt;
    const osg::Vec3d place = world * _toMap;
    const osg::Vec2d pixel = _drawn->eye + osg::Vec2d(place.x(), place.y()) / _drawn->metres;
    for (int axis = 0; axis < 2; ++axis)
        if (pixel[axis] < _drawn->low[axis] || pixel[axis] > _drawn->high[axis]) return std::nullopt;
    return pixel;
}

void MiniMap::show(osgViewer::View& view)
{
    const bool fresh = showOverlay(view, _overlay, 5);
    const auto orientation = ViewOrientation::of(*_scene, *view.getCamera(), _reference.get());
    if (!orientation) return hide();
    const osg::Viewport& port = *_overlay->getViewport();
    const double text = overlayTextSize(port.height());
    Content content;
    content.viewWidth = port.width();
    content.viewHeight = port.height();
    const double side = std::round(14.0 * text);
    // Above the place of the bar of time, and of the coordinates.
    content.low.set(std::round(text), std::round(5.4 * text));
    content.high = content.low + osg::Vec2d(side, side);
    const double bound = 2.2 * static_cast<double>(_scene->getBound().radius());
    double width = _width;
    if (width == 0.0)
    {
        const auto& bend = orientation->bend;
        width = bend ? 1.9 * (std::abs(bend->place.start) + bend->place.size)
                     : 12.0 * std::abs(orientation->height);
        width = std::clamp(width, 200.0, std::max(bound, 200.0));
    }
    content.metres = width / side;
    const DeformedView picture(*_scene, *view.getCamera());
    content.fill(*orientation, *view.getCamera(), picture.modelView());
    place(view, content, *orientation);
    if (fresh || !_drawn || !(*_drawn == content)) draw(content);
    _drawn = std::make_unique<Content>(content);
}

/// Puts the map's camera above the eye's foot.
void MiniMap::place(osgViewer::View& view, const Content& content, const ViewOrientation& orientation)
{
    const bool made = !_map;
    if (made)
    {
        _map = new osg::Camera;
        _map->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        _map->setRenderOrder(osg::Camera::POST_RENDER, 4);
        _map->setProjectionResizePolicy(osg::Camera::FIXED);
        _map->setAllowEventFocus(false);
        _map->setClearColor(view.getCamera()->getClearColor());
        _map->setViewport(new osg::Viewport);
        CameraEffects::of(*_map).setRole(CameraRole::undeformed());
        // As maps have it, whatever lights the scene.
        const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
        light->setReferenceFrame(osg::LightSource::ABSOLUTE_RF);
        light->getLight()->setPosition({-0.6f, 0.6f, 0.9f, 0.0f});
        light->getLight()->setDiffuse({0.85f, 0.85f, 0.85f, 1.0f});
        light->getLight()->setAmbient({0.25f, 0.25f, 0.25f, 1.0f});
        light->getLight()->setSpecular({0.0f, 0.0f, 0.0f, 1.0f});
        light->setStateSetModes(*_map->getOrCreateStateSet(), osg::StateAttribute::ON);
        _map->addChild(light);
        _map->addChild(_scene);
    }
    const osg::Viewport& whole = *_overlay->getViewport();
    const osg::Vec2d size = content.high - content.low;
    _map->getViewport()->setViewport(whole.x() + content.low.x(), whole.y() + content.low.y(), size.x(),
                                     size.y());
    const double tangent = std::tan(osg::DegreesToRadians(fieldOfView / 2.0));
    const double away = 0.5 * size.y() * content.metres / tangent;
    const osg::Vec2d ahead = content.ahead * (lead * size.x() * content.metres);
    const osg::Vec3d middle = orientation.foot + orientation.east * ahead.x() + orientation.north * ahead.y();
    _map->setViewMatrixAsLookAt(middle + orientation.up * away, middle, orientation.north);
    _map->setProjectionMatrixAsPerspective(fieldOfView, 1.0, 1.0, 2.0 * away);
    const osg::Vec3d &north = orientation.north, &east = orientation.east, &up = orientation.up;
    const osg::Matrixd axes(east.x(), east.y(), east.z(), 0.0, north.x(), north.y(), north.z(), 0.0, up.x(),
                            up.y(), up.z(), 0.0, orientation.foot.x(), orientation.foot.y(),
                            orientation.foot.z(), 1.0);
    _toMap.invert(axes);
    const double perRadian = pixelsPerRadian(size.y(), osg::DegreesToRadians(fieldOfView));
    const double native = _terrain ? _terrain->pixelsPerRadian
                                   : pixelsPerRadian(content.viewHeight, osg::DegreesToRadians(usualLens));
    _map->setLODScale(static_cast<float>(pixelErrors * std::max(1.0, native / perRadian)));
    if (made) attachOverlay(view, *_map);
    _map->setNodeMask(~0u);
}

void MiniMap::draw(const Content& content)
{
    OverlayShapes shapes(nullptr);
    const double unit = overlayTextSize(content.viewHeight);
    shapes.polygon(content.focus, faint(overlay::bright, 0.18f));
    shapes.polygon(content.zone, faint(overlay::warm, 0.38f));
    shapes.polygon(content.context, faint(overlay::cold, 0.30f));
    shapes.line(content.border[0], 2.0, overlay::warm);
    shapes.line(content.border[1], 2.0, overlay::cold);
    // The camera, as an arrow.
    const osg::Vec2d side(content.ahead.y(), -content.ahead.x());
    const auto arrow = [&](double size, const osg::Vec4& color)
    {
        const osg::Vec2d tip = content.eye + content.ahead * (0.95 * size);
        const osg::Vec2d back = content.eye - content.ahead * (0.35 * size);
        for (const double hand : {-1.0, 1.0})
            shapes.polygon(
                {tip, content.eye - content.ahead * (0.75 * size) + side * (hand * 0.7 * size), back}, color);
    };
    arrow(1.15 * unit, {0.05f, 0.05f, 0.06f, 0.9f});
    arrow(0.8 * unit, {0.96f, 0.36f, 0.30f, 1.0f});
    const osg::Vec2d low = content.low, high = content.high;
    const OverlayPoints frame = {low, {high.x(), low.y()}, high, {low.x(), high.y()}, low};
    shapes.line(frame, 5.0, {0.06f, 0.07f, 0.09f, 0.9f});
    shapes.line(frame, 1.5, overlay::dim);
    _overlay->removeChildren(0, _overlay->getNumChildren());
    _overlay->addChild(shapes.group());
}

} // namespace osgGeoFX
