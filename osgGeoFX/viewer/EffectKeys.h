// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osgGA/GUIEventHandler>

namespace osgGeoFX
{

/** Keys for the effects of a scene. F5 switches all effects on or off. F6 enables the next effect alone. ( and )
    change the main property of each enabled effect, such as the horizon line, the bend angle or the exaggeration; each
    effect marks it with Property::turnedBy(). F7 shows or hides the deformed bounds. F8 switches the compensation off
    or on. One handler serves one scene.
    @ingroup viewer */
class OSGGEOFX_EXPORT EffectKeys : public osgGA::GUIEventHandler
{
public:
    explicit EffectKeys(EffectScene& scene) : _scene(&scene) {}

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

private:
    void toggleAll();
    void next();
    void turn(double presses);

    osg::ref_ptr<EffectScene> _scene;
};

} // namespace osgGeoFX
