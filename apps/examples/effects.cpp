// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Effects that are not the kit's own, over any scene: effects FILE. A click outlines what it hits.
#include "Contours.h"
#include "Lean.h"
#include "Outline.h"

#include <osgDB/ReadFile>
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgViewer/Viewer>

namespace
{

class Select : public osgGA::GUIEventHandler
{
public:
    Select(osgGeoFX::EffectScene& scene, Outline& outline) : _scene(scene), _outline(outline) {}
    using osgGA::GUIEventHandler::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override
    {
        auto* view = dynamic_cast<osgViewer::View*>(&action);
        if (event.getEventType() != osgGA::GUIEventAdapter::PUSH || !view) return false;
        const osgGeoFX::DeformedView deformed(_scene, *view->getCamera());
        const auto hit = deformed.pick(static_cast<double>(event.getX()), static_cast<double>(event.getY()));
        _outline.select(hit ? hit->drawable : nullptr);
        return false;
    }

private:
    osgGeoFX::EffectScene& _scene;
    Outline& _outline;
};

} // namespace

int main(int argc, char** argv)
{
    const osg::ref_ptr<osg::Node> world = osgDB::readRefNodeFile(argc > 1 ? argv[1] : "");
    if (!world) return 1;
    const osg::ref_ptr<Outline> outline = new Outline;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new Contours);
    scene->addEffect(new Lean);
    scene->addEffect(outline);
    scene->addChild(world);

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene);
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    viewer.addEventHandler(new Select(*scene, *outline));
    return viewer.run();
}
