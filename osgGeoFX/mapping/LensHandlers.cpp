// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/LensMapping.h>

#include <osgGeoFX/mapping/PointerPlace.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Transform>
#include <osgViewer/View>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

LensFollowsPointer::LensFollowsPointer(EffectScene& scene, ProjectiveMappings& mappings, LensMapping& lens,
                                       double smallest, double largest)
    : _scene(&scene), _mappings(&mappings), _lens(&lens), _smallest(smallest), _largest(largest)
{
}

LensFollowsPointer::~LensFollowsPointer() = default;

void LensFollowsPointer::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("Ctrl + wheel", "Make the lens larger or smaller");
}

bool LensFollowsPointer::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    using Event = osgGA::GUIEventAdapter;
    const Event::EventType type = event.getEventType();
    if (type == Event::SCROLL && (event.getModKeyMask() & Event::MODKEY_CTRL))
    {
        const Event::ScrollingMotion motion = event.getScrollingMotion();
        if (motion != Event::SCROLL_UP && motion != Event::SCROLL_DOWN) return false;
        const double factor = motion == Event::SCROLL_UP ? 1.15 : 1.0 / 1.15;
        const double wanted = std::clamp(_lens->getHalfWidth() * factor, _smallest, _largest);
        const double scale = wanted / _lens->getHalfWidth();
        _lens->setSize(wanted, _lens->getHalfHeight() * scale, _lens->getHeading());
        action.requestRedraw();
        return true;
    }
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!view || (type != Event::MOVE && type != Event::DRAG)) return false;
    const std::optional<osg::Vec3d> place = placeUnderPointer(*_scene, *_mappings, *view->getCamera(), event);
    if (!place) return false;
    _lens->setCenter({place->x(), place->y()});
    action.requestRedraw();
    return false;
}

LensFollowsNode::LensFollowsNode(EffectScene& scene, ProjectiveMappings& mappings, LensMapping& lens)
    : _scene(&scene), _mappings(&mappings), _lens(&lens)
{
}

LensFollowsNode::~LensFollowsNode() = default;

void LensFollowsNode::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    osg::ref_ptr<EffectScene> scene;
    _scene.lock(scene);
    // The mappings' frame is that of the terrain's children.
    osg::NodePath path = visitor->getNodePath();
    const osg::ref_ptr<osg::Group> terrain = scene ? scene->getTerrain() : nullptr;
    const auto above = std::find(path.begin(), path.end(), terrain.get());
    if (above != path.end()) path.erase(path.begin(), above + 1);
    const osg::Vec3d world = node->getBound().center() *
                             (node->asTransform() ? osg::computeLocalToWorld({path.begin(), path.end() - 1})
                                                  : osg::computeLocalToWorld(path));
    if (scene)
    {
        const osg::Vec3d place = _mappings->placeOf(world, scene->ground().ellipsoid);
        _lens->setCenter({place.x(), place.y()});
    }
    traverse(node, visitor);
}

} // namespace osgGeoFX
