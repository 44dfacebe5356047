// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/CloseUpHandler.h>

#include <osg/Notify>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

/// A hand that clicks moves the pointer so far, pixels.
constexpr double clickSlack = 3.0;

std::optional<osg::Vec2d> pixelOf(const Event& event, const osg::Camera& camera)
{
    const osg::Viewport* port = camera.getViewport();
    if (!port) return std::nullopt;
    return osg::Vec2d(static_cast<double>(event.getX()) - port->x(),
                      static_cast<double>(event.getY()) - port->y());
}

double timeOf(const osgViewer::View& view)
{
    const osg::FrameStamp* stamp = view.getFrameStamp();
    return stamp ? stamp->getSimulationTime() : 0.0;
}

std::string nameOf(int key)
{
    return key > ' ' && key < 127 ? std::string(1, static_cast<char>(key)) : "the mode key";
}

} // namespace

CloseUpHandler::CloseUpHandler(EffectScene& scene, CloseUps& closeUps) : _scene(&scene), _closeUps(&closeUps)
{
}

CloseUpHandler::~CloseUpHandler() = default;

void CloseUpHandler::getUsage(osg::ApplicationUsage& usage) const
{
    if (_modeKey)
    {
        usage.addKeyboardMouseBinding(nameOf(_modeKey),
                                      "Cycle what makes a close-up active: click, pointer, nothing");
    }
    usage.addKeyboardMouseBinding("Shift + left button", "Drag a close-up");
}

void CloseUpHandler::setMode(Mode mode)
{
    _mode = mode;
    if (mode == OFF) choose(nullptr);
}

bool CloseUpHandler::setInactiveLook(CloseUp::Activity look)
{
    if (look != CloseUp::REGION_ONLY && look != CloseUp::NO_ANCHOR && look != CloseUp::DESATURATED)
    {
        OSG_WARN << "osgGeoFX: CloseUpHandler::setInactiveLook takes REGION_ONLY, NO_ANCHOR or DESATURATED; "
                    "the former look stays."
                 << std::endl;
        return false;
    }
    _inactiveLook = look;
    if (chosen()) dress();
    return true;
}

CloseUp* CloseUpHandler::chosen() const
{
    return _chosen.get();
}

void CloseUpHandler::choose(CloseUp* closeUp)
{
    if (closeUp)
    {
        _chosen = closeUp;
        dress();
        return;
    }
    _chosen = nullptr;
    for (const auto& [former, activity] : _former)
    {
        osg::ref_ptr<CloseUp> kept;
        if (former.lock(kept)) kept->setActivity(activity);
    }
    _former.clear();
}

void CloseUpHandler::dress()
{
    for (unsigned int i = 0; i < _closeUps->getNumCloseUps(); ++i)
    {
        CloseUp* closeUp = _closeUps->getCloseUp(i);
        const bool known = std::any_of(_former.begin(), _former.end(),
                                       [&](const auto& each) { return each.first.get() == closeUp; });
        if (!known) _former.emplace_back(closeUp, closeUp->getActivity());
        closeUp->setActivity(closeUp == chosen() ? CloseUp::ACTIVE : _inactiveLook);
    }
}

std::optional<CloseUpHit> CloseUpHandler::pick(osgViewer::View& view, double x, double y) const
{
    return pickCloseUp(*_scene, *_closeUps, *view.getCamera(), x, y, timeOf(view));
}

bool CloseUpHandler::push(const Event& event, osgViewer::View& view)
{
    _press = NONE;
    const std::optional<osg::Vec2d> pixel = pixelOf(event, *view.getCamera());
    if (!pixel || event.getButton() != Event::LEFT_MOUSE_BUTTON) return false;
    const int others = Event::MODKEY_CTRL | Event::MODKEY_ALT | Event::MODKEY_META;
    if (event.getModKeyMask() & others) return false;
    _pressed = *pixel;
    if (!(event.getModKeyMask() & Event::MODKEY_SHIFT))
    {
        _press = MAYBE_CLICK;
        return false;
    }
    const std::optional<CloseUpHit> hit = pick(view, pixel->x(), pixel->y());
    if (!hit || hit->onRegion) return false;
    _press = DRAGS;
    _held = hit->closeUp;
    _heldAt = hit->drawn;
    _heldOffset = hit->closeUp->getOffset();
    return true;
}

void CloseUpHandler::drag(const Event& event, osgViewer::View& view)
{
    const std::optional<osg::Vec2d> pixel = pixelOf(event, *view.getCamera());
    if (!pixel) return;
    const std::optional<osg::Vec3d> shift =
        dragCloseUp(*_scene, *_held, *view.getCamera(), _heldAt, pixel->x(), pixel->y(), timeOf(view));
    // From where it was taken, so that nothing adds up.
    if (shift) _held->setOffset(_heldOffset + *shift);
}

bool CloseUpHandler::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!view) return false;
    const Event::EventType type = event.getEventType();
    if (event.getHandled() && type != Event::RELEASE && type != Event::FRAME) return false;
    switch (type)
    {
    case Event::KEYDOWN:
        if (!_modeKey || event.getKey() != _modeKey) return false;
        setMode(_mode == CLICK ? HOVER : _mode == HOVER ? OFF : CLICK);
        action.requestRedraw();
        // Handlers of other effects go on with it.
        return false;
    case Event::MOVE:
        _pointer = pixelOf(event, *view->getCamera());
        return false;
    case Event::FRAME:
    {
        // Once a frame, however often the pointer moved.
        if (!_pointer) return false;
        const std::optional<CloseUpHit> hit =
            _mode == HOVER ? pick(*view, _pointer->x(), _pointer->y()) : std::nullopt;
        _pointer.reset();
        // What was chosen stays so on the way from a region to its close-up.
        if (!hit || hit->closeUp == chosen()) return false;
        choose(hit->closeUp);
        action.requestRedraw();
        return false;
    }
    case Event::PUSH:
        return push(event, *view);
    case Event::DRAG:
        if (_press != DRAGS) return false;
        drag(event, *view);
        break;
    case Event::RELEASE:
    {
        const Press former = _press;
        _press = NONE;
        _held = nullptr;
        if (former == DRAGS) return true;
        const std::optional<osg::Vec2d> pixel = pixelOf(event, *view->getCamera());
        if (former == NONE || _mode == OFF || !pixel || (*pixel - _pressed).length() > clickSlack)
            return false;
        const std::optional<CloseUpHit> hit = pick(*view, pixel->x(), pixel->y());
        choose(hit ? hit->closeUp : nullptr);
        action.requestRedraw();
        // The camera's manipulator has to know, too.
        return false;
    }
    default:
        return false;
    }
    action.requestRedraw();
    return true;
}

} // namespace osgGeoFX
