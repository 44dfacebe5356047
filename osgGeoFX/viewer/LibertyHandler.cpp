// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/LibertyHandler.h>

#include <osgGeoFX/viewer/Liberties.h>
#include <osgGeoFX/viewer/Overlay.h>

#include <osg/LineWidth>
#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

constexpr int points = 64;
/// A new region: half its width over the distance of the eye, and how much its summit grows.
constexpr double firstRadius = 0.1, firstEnlarge = 1.3;
/// A step of each key.
constexpr double enlargeStep = 1.1, widenStep = 0.1;
const double turnStep = osg::DegreesToRadians(5.0);
/// A drag begins up to so far beyond the outline, of its radius.
constexpr double nearOutline = 1.1;
/// Tiles arrive, and the ground gets finer: the outline is laid on it again after so many frames.
constexpr int freshFrames = 30;
/// Higher than all ground, metres.
constexpr double aboveAll = 20000.0;

std::vector<double> valuesOf(const RegionalLiberty& liberty)
{
    return {liberty.getCenter().x(), liberty.getCenter().y(), liberty.getLongitude(), liberty.getLatitude(),
            liberty.getAcross(),     liberty.getAlong(),      liberty.getHeading()};
}

} // namespace

/// The ground of a scene as one camera has it at an event.
class LibertyHandler::Ground
{
public:
    Ground(EffectScene& scene, const osg::Camera& camera)
        : view(scene, camera), _scene(scene), _projection(camera.getProjectionMatrix()),
          _lodScale(static_cast<double>(camera.getLODScale())),
          _toWorld(osg::Matrixd::inverse(view.modelView()))
    {
    }

    /// Where the deformations before an effect of the scene move a place, and back.
    osg::Vec3d before(const Effect& effect, const osg::Vec3d& world) const
    {
        osg::Vec3d eye = world * view.modelView();
        for (const auto& each : snapshots(effect))
            eye = each->deform(eye);
        return eye * _toWorld;
    }
    osg::Vec3d undone(const Effect& effect, const osg::Vec3d& world) const
    {
        osg::Vec3d eye = world * view.modelView();
        const auto all = snapshots(effect);
        for (auto each = all.rbegin(); each != all.rend(); ++each)
            eye = (*each)->undeform(eye);
        return eye * _toWorld;
    }
    /// A place that the deformations before a liberty have moved, in half widths of the liberty.
    osg::Vec2d local(const RegionalLiberty& liberty, const osg::Vec3d& moved) const
    {
        const osg::Vec3d place = moved * osg::Matrixd::inverse(frame(liberty));
        const double c = std::cos(liberty.getHeading()), s = std::sin(liberty.getHeading());
        return {(place.x() * c - place.y() * s) / liberty.getAcross(),
                (place.x() * s + place.y() * c) / liberty.getAlong()};
    }
    /// The undeformed ground at a place of the outline; empty where there is none.
    std::optional<osg::Vec3d> onOutline(const RegionalLiberty& liberty, double angle) const
    {
        const double x = liberty.getAcross() * std::cos(angle), y = liberty.getAlong() * std::sin(angle);
        const double c = std::cos(liberty.getHeading()), s = std::sin(liberty.getHeading());
        const double drop = ellipsoid() ? (x * x + y * y) / (2.0 * ellipsoid()->getRadiusEquator()) : 0.0;
        const osg::Vec3d place =
            undone(liberty, osg::Vec3d(x * c + y * s, y * c - x * s, -drop) * frame(liberty));
        const osg::Vec3d up = upAt(place);
        const osg::Matrixd& toEye = view.modelView();
        const osg::ref_ptr<DeformedLineIntersector> ray = new DeformedLineIntersector(
            (place + up * aboveAll) * toEye, osg::Matrixd::transform3x3(-up, toEye));
        const osg::ref_ptr<const DeformationChain> none = new DeformationChain;
        const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
            new DeformedIntersectionVisitor(ray, *none, toEye, _lodScale);
        _scene.getTerrain()->traverse(*visitor);
        if (ray->intersections().empty()) return std::nullopt;
        return ray->intersections().front().world;
    }
    double heightOf(const osg::Vec3d& world) const
    {
        if (!ellipsoid()) return world.z();
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        ellipsoid()->convertXYZToLatLongHeight(world.x(), world.y(), world.z(), latitude, longitude, height);
        return height;
    }
    void center(RegionalLiberty& liberty, const osg::Vec3d& world) const
    {
        if (!ellipsoid())
        {
            liberty.setCenter({world.x(), world.y()});
            return;
        }
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        ellipsoid()->convertXYZToLatLongHeight(world.x(), world.y(), world.z(), latitude, longitude, height);
        liberty.setGeodeticCenter(longitude, latitude);
    }

    const DeformedView view;

private:
    const osg::EllipsoidModel* ellipsoid() const { return view.ground().ellipsoid.get(); }
    osg::Matrixd frame(const RegionalLiberty& liberty) const
    {
        const LocalOrigin origin = {liberty.getCenter().x(), liberty.getCenter().y(), liberty.getLongitude(),
                                    liberty.getLatitude()};
        return origin.toWorld(ellipsoid(), 0.0);
    }
    osg::Vec3d upAt(const osg::Vec3d& world) const
    {
        return ellipsoid() ? ellipsoid()->computeLocalUpVector(world.x(), world.y(), world.z())
                           : osg::Vec3d(0.0, 0.0, 1.0);
    }
    std::vector<osg::ref_ptr<const DeformationSnapshot>> snapshots(const Effect& effect) const
    {
        std::vector<osg::ref_ptr<const DeformationSnapshot>> result;
        osgGeoFX::Ground ground = view.ground();
        for (unsigned int i = 0; i < _scene.getNumEffects() && _scene.getEffect(i) != &effect; ++i)
        {
            const auto* deformation = dynamic_cast<const Deformation*>(_scene.getEffect(i));
            if (!deformation || !deformation->isActive()) continue;
            const auto snapshot = deformation->snapshot({view.modelView(), _projection, ground});
            if (!snapshot) continue;
            result.push_back(snapshot);
            deformation->changeGround(ground);
        }
        return result;
    }

    EffectScene& _scene;
    osg::Matrixd _projection;
    double _lodScale;
    osg::Matrixd _toWorld;
};

LibertyHandler::~LibertyHandler() = default;

void LibertyHandler::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("k", "Take a liberty with the ground, or edit it (drag: its size)");
    usage.addKeyboardMouseBinding("[ and ], { and }, ; and '", "Enlarge, turn, widen the liberty");
    usage.addKeyboardMouseBinding("Delete", "Remove the liberty below the pointer");
}

void LibertyHandler::edit(RegionalLiberty* liberty)
{
    if (_edited == liberty) return;
    _edited = liberty;
    _drags = false;
    _ringOf.clear();
    if (!liberty) hide();
}

std::vector<osg::Vec2d> LibertyHandler::outline() const
{
    std::vector<osg::Vec2d> result;
    for (const Point& point : _outline)
        if (point) result.push_back(*point);
    return result;
}

/// The uppermost liberty that has a place of the undeformed ground.
RegionalLiberty* LibertyHandler::at(const Ground& ground, const osg::Vec3d& world) const
{
    // The one that is edited can be taken even if it does nothing yet.
    const auto has = [&](const RegionalLiberty& liberty)
    {
        return ground.local(liberty, ground.before(liberty, world)).length2() < 1.0;
    };
    if (_edited && has(*_edited)) return _edited;
    for (unsigned int i = _scene->getNumEffects(); i-- > 0;)
    {
        auto* const liberty = dynamic_cast<RegionalLiberty*>(_scene->getEffect(i));
        if (liberty && liberty->isActive() && has(*liberty)) return liberty;
    }
    return nullptr;
}

void LibertyHandler::begin(const Ground& ground, const osg::Vec3d& world, double away)
{
    const osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
    addLiberty(*_scene, *liberty);
    // The deformations before it show the place elsewhere.
    ground.center(*liberty, ground.before(*liberty, world));
    const double radius = std::clamp(firstRadius * away, 10.0, 3e5);
    liberty->setRadii(radius, radius);
    liberty->setEnlarge(firstEnlarge);
    edit(liberty);
    lower(ground);
}

/// The base is the lowest ground of the outline, so that the region stands out from what lies around it.
void LibertyHandler::lower(const Ground& ground)
{
    double lowest = HUGE_VAL;
    for (int i = 0; i < points; i += 4)
        if (const auto place = ground.onOutline(*_edited, 2.0 * osg::PI * i / points))
            lowest = std::min(lowest, ground.heightOf(ground.before(*_edited, *place)));
    if (std::isfinite(lowest)) _edited->setBaseHeight(std::clamp(std::round(lowest), -12000.0, 12000.0));
}

bool LibertyHandler::change(int key)
{
    if (!_edited) return false;
    const auto within = [](double value, double low, double high)
    {
        return std::clamp(value, low, high);
    };
    switch (key)
    {
    case '[':
        _edited->setEnlarge(within(_edited->getEnlarge() / enlargeStep, 0.1, 5.0));
        return true;
    case ']':
        _edited->setEnlarge(within(_edited->getEnlarge() * enlargeStep, 0.1, 5.0));
        return true;
    case '{':
        _edited->setTurn(within(_edited->getTurn() - turnStep, -osg::PI_2, osg::PI_2));
        return true;
    case '}':
        _edited->setTurn(within(_edited->getTurn() + turnStep, -osg::PI_2, osg::PI_2));
        return true;
    case ';':
        _edited->setWiden(within(_edited->getWiden() - widenStep, 0.25, 2.0));
        return true;
    case '\'':
        _edited->setWiden(within(_edited->getWiden() + widenStep, 0.25, 2.0));
        return true;
    default:
        return false;
    }
}

bool LibertyHandler::press(int key, osgViewer::View& view)
{
    if (change(key)) return true;
    if (key != 'k' && key != Event::KEY_Delete) return false;
    if (!view.getCamera()->getViewport()) return true;
    const Ground ground(*_scene, *view.getCamera());
    const auto hit = ground.view.pick(_pointer.x(), _pointer.y());
    if (!hit) return true; // The sky.
    const osg::ref_ptr<RegionalLiberty> below = at(ground, hit->world);
    if (key == 'k')
    {
        if (!below)
            begin(ground, hit->world, hit->deformed.length());
        else
            edit(below == _edited ? nullptr : below.get());
    }
    else if (below)
    {
        if (below == _edited) edit(nullptr);
        _scene->removeEffect(below);
    }
    return true;
}

bool LibertyHandler::push(const osgGA::GUIEventAdapter& event, osgViewer::View& view)
{
    const int others = Event::MODKEY_CTRL | Event::MODKEY_ALT | Event::MODKEY_SHIFT | Event::MODKEY_META;
    if (!_edited || event.getButton() != Event::LEFT_MOUSE_BUTTON || (event.getModKeyMask() & others) != 0)
        return false;
    const Ground ground(*_scene, *view.getCamera());
    const auto hit = ground.view.pick(_pointer.x(), _pointer.y());
    if (!hit) return false;
    _drags = ground.local(*_edited, ground.before(*_edited, hit->world)).length() < nearOutline;
    _dragged = false;
    return _drags;
}

void LibertyHandler::drag(osgViewer::View& view)
{
    const Ground ground(*_scene, *view.getCamera());
    const auto hit = ground.view.pick(_pointer.x(), _pointer.y());
    if (!hit) return;
    const double factor = ground.local(*_edited, ground.before(*_edited, hit->world)).length();
    const double across = std::clamp(factor * _edited->getAcross(), 10.0, 3e5);
    const double along = std::clamp(factor * _edited->getAlong(), 10.0, 3e5);
    _edited->setRadii(across, along);
    lower(ground);
}

void LibertyHandler::hide()
{
    _outline.clear();
    if (_overlay) _overlay->setNodeMask(0);
}

void LibertyHandler::show(osgViewer::View& view)
{
    const Ground ground(*_scene, *view.getCamera());
    const std::vector<double> values = valuesOf(*_edited);
    if (values != _ringOf || ++_age >= freshFrames)
    {
        _ring.clear();
        for (int i = 0; i < points; ++i)
            _ring.push_back(ground.onOutline(*_edited, 2.0 * osg::PI * i / points));
        _ringOf = values;
        _age = 0;
    }
    _outline.assign(points, std::nullopt);
    for (std::size_t i = 0; i < _ring.size(); ++i)
    {
        osg::Vec2d pixel;
        if (_ring[i] && ground.view.project(*_ring[i], pixel)) _outline[i] = pixel;
    }
    const bool made = !_overlay;
    showOverlay(view, _overlay, 9);
    if (made)
    {
        for (const bool dark : {true, false})
        {
            const osg::ref_ptr<osg::Geometry> lines = new osg::Geometry;
            lines->setDataVariance(osg::Object::DYNAMIC);
            lines->setUseDisplayList(false);
            lines->setUseVertexBufferObjects(true);
            lines->setVertexArray(new osg::Vec3Array);
            const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL);
            color->push_back(dark ? osg::Vec4(0.1f, 0.1f, 0.1f, 1.0f) : osg::Vec4(1.0f, 0.9f, 0.4f, 1.0f));
            lines->setColorArray(color);
            lines->addPrimitiveSet(new osg::DrawArrays(GL_LINES));
            lines->getOrCreateStateSet()->setAttribute(new osg::LineWidth(dark ? 4.0f : 2.0f));
            lines->getOrCreateVertexBufferObject()->setUsage(GL_DYNAMIC_DRAW);
            lines->setCullingActive(false);
            _overlay->addChild(lines);
            _lines.push_back(lines);
        }
    }
    draw();
}

void LibertyHandler::draw()
{
    for (const osg::ref_ptr<osg::Geometry>& lines : _lines)
    {
        auto& vertices = static_cast<osg::Vec3Array&>(*lines->getVertexArray());
        vertices.clear();
        for (std::size_t i = 0; i < _outline.size(); ++i)
        {
            const Point& from = _outline[i];
            const Point& to = _outline[(i + 1) % _outline.size()];
            if (!from || !to) continue;
            vertices.push_back(osg::Vec3(osg::Vec3d(*from, 0.0)));
            vertices.push_back(osg::Vec3(osg::Vec3d(*to, 0.0)));
        }
        vertices.dirty();
        static_cast<osg::DrawArrays&>(*lines->getPrimitiveSet(0))
            .setCount(static_cast<GLsizei>(vertices.size()));
        lines->getPrimitiveSet(0)->dirty();
        lines->dirtyBound();
    }
}

bool LibertyHandler::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    if (!view) return false;
    if (const osg::Viewport* const port = view->getCamera()->getViewport())
    {
        const Event::EventType type = event.getEventType();
        if (type != Event::FRAME && type != Event::RESIZE)
            _pointer.set(static_cast<double>(event.getX()) - port->x(),
                         static_cast<double>(event.getY()) - port->y());
    }
    bool handled = false;
    switch (event.getEventType())
    {
    case Event::KEYDOWN:
        handled = press(event.getKey(), *view);
        break;
    case Event::PUSH:
        handled = push(event, *view);
        break;
    case Event::DRAG:
        // A pick costs milliseconds, so one a frame is enough.
        handled = _dragged = _drags;
        break;
    case Event::RELEASE:
        if (_drags && _dragged && _edited) drag(*view);
        handled = _drags;
        _drags = _dragged = false;
        break;
    case Event::FRAME:
    {
        bool there = false;
        for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
            there = there || _scene->getEffect(i) == _edited;
        if (!there) edit(nullptr);
        if (_edited && _drags && _dragged)
        {
            drag(*view);
            _dragged = false;
        }
        if (_edited && view->getCamera()->getViewport()) show(*view);
        return false;
    }
    default:
        break;
    }
    if (handled) action.requestRedraw();
    return handled;
}

} // namespace osgGeoFX
