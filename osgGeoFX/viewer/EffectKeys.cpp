// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/EffectKeys.h>

#include <osg/Notify>

#include <string>

namespace osgGeoFX
{

void EffectKeys::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F5", "Switch the effects on or off");
    usage.addKeyboardMouseBinding("F6", "Show the next effect alone");
    usage.addKeyboardMouseBinding("( and )", "Turn horizon line, bend angle, exaggeration");
    usage.addKeyboardMouseBinding("F7", "Toggle the bounds that culling decides on");
    usage.addKeyboardMouseBinding("F8", "Toggle the CPU's part of the deformation");
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
    // The first, where none is in force.
    unsigned int chosen = 0;
    for (unsigned int i = 0; i < count; ++i)
    {
        if (_scene->getEffect(i)->getEnabled()) chosen = (i + 1) % count;
    }
    for (unsigned int i = 0; i < count; ++i)
        _scene->getEffect(i)->setEnabled(i == chosen);
    if (count > 0) OSG_INFO << "osgGeoFX: " << _scene->getEffect(chosen)->className() << std::endl;
}

void EffectKeys::turn(double presses)
{
    for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
    {
        Effect& effect = *_scene->getEffect(i);
        if (!effect.getEnabled()) continue;
        for (const Property& property : effect.properties())
        {
            if (property.keyStep == 0.0) continue;
            std::string error;
            // Where the turned value does not fit the effect's others, it stays where it is.
            effect.setProperty(property.name, property.turned(effect.getProperty(property.name), presses),
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

} // namespace osgGeoFX
