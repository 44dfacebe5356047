// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osgGA/GUIEventHandler>

namespace osgGeoFX
{

/** Keys for the effects of a scene: F5 switches them on and off together, F6 to the next one alone, and ( and ) turn the
    main property of the effect that is in force: the horizon's line, the bend's angle, the exaggeration. Which one that
    is an effect's own table says, see Property::turnedBy(). F7 shows the deformed bounds, F8 switches the compensation
    off and on. Serves one scene. */
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
