// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaManipulator.h>

#include <osg/View>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

constexpr double wheelFactor = 0.8;
const double keyTurn = 10.0 * osg::PI / 180.0;
/// Of half a picture's width or height under the pointer.
const double dragTurn = osg::PI_2;
constexpr double dragZoom = 2.0;
/// Seconds in which a glide comes nearer by a factor of e.
constexpr double glideTime = 0.12;

osg::Vec2d pointerOf(const Event& event)
{
    return {static_cast<double>(event.getXnormalized()), static_cast<double>(event.getYnormalized())};
}

} // namespace

PanoramaManipulator::PanoramaManipulator(EffectScene& scene, PanoramaMap& map)
    : _scene(&scene), _map(&map), _homeRadius(map.getViewRadius()), _pose(scene, map)
{
    PanoramaManipulator::home(0.0);
}

PanoramaManipulator::~PanoramaManipulator() = default;

void PanoramaManipulator::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("Panorama: left button", "Drag the ground");
    usage.addKeyboardMouseBinding("Panorama: wheel, right button", "Zoom about the pointer");
    usage.addKeyboardMouseBinding("Panorama: middle button, Left and Right",
                                  "Turn about the middle of the picture");
    usage.addKeyboardMouseBinding("Panorama: Up and Down", "Zoom about the middle of the picture");
    usage.addKeyboardMouseBinding("Panorama: Space", "Return to the home view");
}

void PanoramaManipulator::rest()
{
    _glide.reset();
    _hold.reset();
    _pose.follow();
}

void PanoramaManipulator::setByMatrix(const osg::Matrixd& matrix)
{
    rest();
    _pose.setMatrix(matrix);
}

void PanoramaManipulator::setByInverseMatrix(const osg::Matrixd& matrix)
{
    setByMatrix(osg::Matrixd::inverse(matrix));
}

osg::Matrixd PanoramaManipulator::getInverseMatrix() const
{
    return osg::Matrixd::inverse(_pose.matrix());
}

bool PanoramaManipulator::setCenter(const osg::Vec3d& world)
{
    rest();
    return _pose.setCenter(world);
}

osg::Vec3d PanoramaManipulator::getCenter() const
{
    return _pose.holdOnBase(_pose.middle()).world;
}

void PanoramaManipulator::setWidth(double metres)
{
    rest();
    const PanoramaHold hold = _pose.holdOnBase(_pose.middle());
    _pose.setRadius(metres / 2.0);
    _pose.keep(hold);
}

void PanoramaManipulator::setHeading(double radians)
{
    rest();
    const PanoramaHold hold = _pose.holdOnBase(_pose.middle());
    _pose.setHeading(radians);
    if (!_pose.isCylindrical()) _pose.keep(hold);
}

void PanoramaManipulator::home(double)
{
    _map->setViewRadius(_homeRadius);
    if (!_autoComputeHomePosition)
    {
        setByInverseMatrix(osg::Matrixd::lookAt(_homeEye, _homeCenter, _homeUp));
        return;
    }
    const osg::BoundingSphere bound = _scene->getTerrain()->getBound();
    if (!bound.valid()) return;
    _pose.setHeading(0.0);
    setCenter(bound.center());
    if (_homeRadius == 0.0) setWidth(2.0 * static_cast<double>(bound.radius()));
    setCenter(bound.center());
}

void PanoramaManipulator::home(const Event& event, osgGA::GUIActionAdapter& action)
{
    follow(action);
    home(event.getTime());
    action.requestRedraw();
}

void PanoramaManipulator::init(const Event&, osgGA::GUIActionAdapter& action)
{
    rest();
    follow(action);
    action.requestRedraw();
}

/// Takes over what the view has changed.
void PanoramaManipulator::follow(osgGA::GUIActionAdapter& action)
{
    if (const osg::View* view = action.asView())
        _pose.setProjection(view->getCamera()->getProjectionMatrix());
    _pose.follow();
}

PanoramaHold PanoramaManipulator::holdSeen(const osg::Vec2d& picture, osgGA::GUIActionAdapter& action) const
{
    const osg::View* view = action.asView();
    return view ? _pose.holdSeen(picture, *view->getCamera()) : _pose.holdOnBase(picture);
}

bool PanoramaManipulator::push(const Event& event, osgGA::GUIActionAdapter& action)
{
    _glide.reset();
    _button = event.getButton();
    _pointer = pointerOf(event);
    _hold =
        _button == Event::MIDDLE_MOUSE_BUTTON ? _pose.holdOnBase(_pose.middle()) : holdSeen(_pointer, action);
    _offset = _hold->picture - _pointer;
    return true;
}

bool PanoramaManipulator::drag(const Event& event)
{
    if (!_hold) return false;
    const osg::Vec2d pointer = pointerOf(event);
    const osg::Vec2d way = pointer - _pointer;
    _pointer = pointer;
    switch (_button)
    {
    case Event::LEFT_MOUSE_BUTTON:
        _hold->picture = pointer + _offset;
        _pose.keep(*_hold);
        return true;
    case Event::MIDDLE_MOUSE_BUTTON:
        _pose.setHeading(_pose.heading() - way.x() * dragTurn);
        if (!_pose.isCylindrical()) _pose.keep(*_hold);
        return true;
    default:
        _pose.setRadius(_pose.radius() * std::exp(-dragZoom * way.y()));
        _pose.keep(*_hold);
        return true;
    }
}

PanoramaManipulator::Glide& PanoramaManipulator::glideFrom(const Event& event, const PanoramaHold& hold)
{
    if (!_glide) _glide = Glide{hold, _pose.radius(), _pose.heading(), event.getTime()};
    _glide->hold = hold;
    return *_glide;
}

bool PanoramaManipulator::scroll(const Event& event, osgGA::GUIActionAdapter& action)
{
    const Event::ScrollingMotion motion = event.getScrollingMotion();
    if (motion != Event::SCROLL_UP && motion != Event::SCROLL_DOWN) return false;
    const double factor = motion == Event::SCROLL_UP ? wheelFactor : 1.0 / wheelFactor;
    glideFrom(event, holdSeen(pointerOf(event), action)).radius *= factor;
    return true;
}

bool PanoramaManipulator::key(const Event& event, osgGA::GUIActionAdapter& action)
{
    const auto glide = [&]() -> Glide&
    {
        return glideFrom(event, _pose.holdOnBase(_pose.middle()));
    };
    switch (event.getKey())
    {
    case Event::KEY_Space:
        home(event, action);
        return true;
    case Event::KEY_Left:
        glide().heading -= keyTurn;
        return true;
    case Event::KEY_Right:
        glide().heading += keyTurn;
        return true;
    case Event::KEY_Up:
        glide().radius *= wheelFactor;
        return true;
    case Event::KEY_Down:
        glide().radius /= wheelFactor;
        return true;
    default:
        return false;
    }
}

/// A glide's next step.
void PanoramaManipulator::step(double time)
{
    const double share = 1.0 - std::exp(-std::max(time - _glide->time, 0.0) / glideTime);
    _glide->time = time;
    const double former = _pose.radius();
    const double way = std::log(_glide->radius / former);
    const double turn = _glide->heading - _pose.heading();
    const bool near = std::abs(way) < 1e-4 && std::abs(turn) < 1e-5;
    _pose.setRadius(former * std::exp(near ? way : share * way));
    const double turned = near ? turn : share * turn;
    _pose.setHeading(_pose.heading() + turned);
    // A cylindrical map turns about the eye, and what is held stays where it is in the picture only while it zooms.
    if (_pose.isCylindrical() && turn != 0.0)
        _glide->hold = _pose.holdOnBase(_pose.middle());
    else
        _pose.keep(_glide->hold);
    // It ends at the limits, too.
    const bool stuck = share > 0.0 && std::abs(turn) < 1e-5 &&
                       std::abs(std::log(_pose.radius() / former)) < 1e-3 * share * std::abs(way);
    if (near || stuck) _glide.reset();
}

bool PanoramaManipulator::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    follow(action);
    if (event.getEventType() == Event::FRAME)
    {
        if (_glide) step(event.getTime());
        if (_glide) action.requestRedraw();
        return false;
    }
    if (event.getHandled()) return false;
    const int others = Event::MODKEY_CTRL | Event::MODKEY_ALT | Event::MODKEY_SHIFT;
    bool handled = false;
    switch (event.getEventType())
    {
    case Event::PUSH:
        handled = (event.getModKeyMask() & others) == 0 && push(event, action);
        break;
    case Event::DRAG:
        handled = drag(event);
        break;
    case Event::RELEASE:
        handled = _hold.has_value();
        _hold.reset();
        break;
    case Event::SCROLL:
        handled = scroll(event, action);
        break;
    case Event::KEYDOWN:
        handled = key(event, action);
        break;
    default:
        break;
    }
    if (handled) action.requestRedraw();
    return handled;
}

} // namespace osgGeoFX
