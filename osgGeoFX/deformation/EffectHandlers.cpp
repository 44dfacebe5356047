// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/EffectHandlers.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgGeoFX
{

namespace
{

/// What the keys ( and ) turn, and by how much; properties are linear but for the exaggeration's.
struct Turn
{
    const char* property;
    double step;
    bool multiplies;
};

constexpr Turn turns[] = {{"horizonLine", 0.02, false},
                          {"bendAngle", 0.05, false},
                          {"factor", 1.15, true},
                          {"highHeight", 1.15, true}};

} // namespace

void EffectKeys::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F5", "Switch the effects on or off");
    usage.addKeyboardMouseBinding("F6", "Show the next effect alone");
    usage.addKeyboardMouseBinding("( and )", "Turn the effect: horizon line, bend angle, exaggeration");
    usage.addKeyboardMouseBinding("F7", "Toggle the deformed bounds that culling decides on");
    usage.addKeyboardMouseBinding("F8", "Toggle the compensation of the deformation on the CPU");
}

void EffectKeys::toggleAll()
{
    bool any = false;
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
        any = any || _scene->getEffect(i)->getEnabled();
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
        _scene->getEffect(i)->setEnabled(!any);
}

void EffectKeys::next()
{
    const unsigned int count = _scene->getNumEffects();
    unsigned int current = count;
    for (unsigned int i = 0; i < count; ++i)
    {
        if (_scene->getEffect(i)->getEnabled()) current = i;
    }
    const unsigned int chosen = count > 0 ? (current + 1) % count : 0;
    for (unsigned int i = 0; i < count; ++i)
        _scene->getEffect(i)->setEnabled(i == chosen);
    if (count > 0) OSG_INFO << "osgGeoFX: " << _scene->getEffect(chosen)->className() << std::endl;
}

void EffectKeys::turn(double steps)
{
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
    {
        Effect& effect = *_scene->getEffect(i);
        if (!effect.getEnabled()) continue;
        for (const Turn& each : turns)
        {
            const Property* property = effect.property(each.property);
            if (!property) continue;
            const double value = effect.getProperty(each.property);
            const double turned =
                each.multiplies ? value * std::pow(each.step, steps) : value + steps * each.step;
            std::string error;
            // At its end it stays where it is.
            effect.setProperty(each.property, std::clamp(turned, property->minimum, property->maximum),
                               error);
        }
    }
}

bool EffectKeys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN) return false;
    switch (event.getKey())
    {
    case osgGA::GUIEventAdapter::KEY_F5:
        toggleAll();
        break;
    case osgGA::GUIEventAdapter::KEY_F6:
        next();
        break;
    case osgGA::GUIEventAdapter::KEY_F7:
        _scene->setDebugBounds(!_scene->getDebugBounds());
        break;
    case osgGA::GUIEventAdapter::KEY_F8:
        _scene->setCompensation(!_scene->getCompensation());
        break;
    case '(':
        turn(-1.0);
        break;
    case ')':
        turn(1.0);
        break;
    default:
        return false;
    }
    action.requestRedraw();
    return true;
}

void ClickAndFly::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("Ctrl + left button", "Fly to the ground that the picture shows there");
}

bool ClickAndFly::aim(osgViewer::View& view, const osgGA::GUIEventAdapter& event)
{
    const osg::Camera& camera = *view.getCamera();
    const osg::Viewport* port = camera.getViewport();
    if (!port) return false;
    const DeformedView picture(*_scene, camera);
    const auto hit = picture.pick(static_cast<double>(event.getX()) - port->x(),
                                  static_cast<double>(event.getY()) - port->y());
    if (!hit) return false;
    osg::Matrixd toWorld;
    toWorld.invert(camera.getViewMatrix());
    _from = toWorld.getTrans();
    // From the frame of the scene's children to the viewer's world.
    osg::Matrixd childrenToWorld = picture.modelView() * toWorld;
    const osg::Vec3d ground = hit->world * childrenToWorld;
    _attitude = camera.getViewMatrix();
    _attitude.setTrans(osg::Vec3d());
    const Ground terrain = _scene->ground();
    const ViewGeometry geometry(camera.getViewMatrix(), camera.getProjectionMatrix(), terrain);
    const osg::Vec3d up = osg::Matrixd::transform3x3(geometry.up, toWorld);
    // The height above the ground that is flown to shrinks with the way that is left.
    _to = _from + (ground - _from) * _share;
    const double below = (ground - _to) * up;
    if (below > -2.0) _to += up * (below + 2.0);
    return true;
}

void ClickAndFly::fly(osgViewer::View& view, double time)
{
    const double share = std::clamp((time - _start) / _seconds, 0.0, 1.0);
    const double smooth = share * share * (3.0 - 2.0 * share);
    const osg::Vec3d eye = _from + (_to - _from) * smooth;
    const osg::Matrixd matrix = osg::Matrixd::translate(-eye) * _attitude;
    if (view.getCameraManipulator())
    {
        view.getCameraManipulator()->setByInverseMatrix(matrix);
    }
    else
    {
        view.getCamera()->setViewMatrix(matrix);
    }
    if (share >= 1.0) _start = -1.0;
}

bool ClickAndFly::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!view) return false;
    using Event = osgGA::GUIEventAdapter;
    if (event.getEventType() == Event::FRAME && flying())
    {
        fly(*view, event.getTime());
        action.requestRedraw();
        return false;
    }
    const bool wanted = event.getEventType() == Event::PUSH &&
                        event.getButton() == Event::LEFT_MOUSE_BUTTON &&
                        (event.getModKeyMask() & Event::MODKEY_CTRL);
    if (!wanted || !aim(*view, event)) return false;
    _start = event.getTime();
    action.requestRedraw();
    return true;
}

} // namespace osgGeoFX
