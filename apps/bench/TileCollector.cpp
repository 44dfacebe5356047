// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TileCollector.h"

#include <osgGeoFX/effect/Tessellation.h>

#include <osg/CoordinateSystemNode>
#include <osgUtil/SceneView>
#include <osgViewer/Renderer>

#include <cmath>

namespace geofx::bench
{

namespace
{

/// The state that a node's own parents set below \p scene, first that of the uppermost.
std::vector<osg::StateSet*> stateAbove(const osg::Node& node, const osg::Node& scene)
{
    std::vector<osg::StateSet*> result;
    for (const osg::Node* each = node.getNumParents() ? node.getParent(0) : nullptr; each && each != &scene;
         each = each->getNumParents() ? each->getParent(0) : nullptr)
        if (each->getStateSet())
            result.insert(result.begin(), const_cast<osg::StateSet*>(each->getStateSet()));
    return result;
}

const osg::CoordinateSystemNode* systemBelow(const osg::Node& node)
{
    if (const auto* system = dynamic_cast<const osg::CoordinateSystemNode*>(&node)) return system;
    const osg::Group* group = node.asGroup();
    for (unsigned int i = 0; group && i < group->getNumChildren(); ++i)
        if (const osg::CoordinateSystemNode* found = systemBelow(*group->getChild(i))) return found;
    return nullptr;
}

} // namespace

osg::ref_ptr<osg::Group> TileCollector::collect(OffscreenView& view, const osg::Node& scene,
                                                const Filter& filter)
{
    const osg::ref_ptr<TileCollector> collector = new TileCollector(scene, filter);
    view.camera().addInitialDrawCallback(collector);
    view.frame();
    view.camera().removeInitialDrawCallback(collector);
    if (collector->tiles->getNumChildren() == 0)
        throw BenchError("Nothing of what is to be measured is in the view.");
    return collector->tiles;
}

void TileCollector::operator()(osg::RenderInfo& info) const
{
    auto* renderer = dynamic_cast<osgViewer::Renderer*>(info.getCurrentCamera()->getRenderer());
    if (!renderer) return;
    osg::Matrixd toWorld;
    toWorld.invert(info.getCurrentCamera()->getViewMatrix());
    add(*renderer->getSceneView(0)->getRenderStage(), toWorld);
}

void TileCollector::add(const osgUtil::RenderBin& bin, const osg::Matrixd& toWorld) const
{
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
    {
        for (const auto& leaf : graph->_leaves)
        {
            if (!leaf->_modelview) continue;
            osg::Drawable& drawable = osgGeoFX::PatchGeometry::originalOf(*leaf->_drawable);
            if (_filter && !_filter(drawable)) continue;
            osg::ref_ptr<osg::MatrixTransform> tile = new osg::MatrixTransform(*leaf->_modelview * toWorld);
            tile->addChild(&drawable);
            below(stateAbove(drawable, _scene)).addChild(tile);
        }
    }
    for (const auto& inner : bin.getRenderBinList())
        add(*inner.second, toWorld);
}

osg::Group& TileCollector::below(const std::vector<osg::StateSet*>& states) const
{
    osg::Group* group = tiles;
    for (osg::StateSet* state : states)
    {
        osg::Group*& inner = _groups[{group, state}];
        if (!inner)
        {
            inner = new osg::Group;
            inner->setStateSet(state);
            group->addChild(inner);
        }
        group = inner;
    }
    return *group;
}

osg::ref_ptr<osgGeoFX::EffectScene> deformedTiles(const osgGeoFX::Scene& scene, osgGeoFX::Effect& effect,
                                                  osg::Group& tiles)
{
    const osg::CoordinateSystemNode* system = systemBelow(*scene.node);
    if (!system) throw BenchError("The terrain has no coordinate system; take one of osggeofx_build.");
    const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode(*system);
    root->removeChildren(0, root->getNumChildren());
    root->addChild(&tiles);
    const osg::ref_ptr<osgGeoFX::EffectScene> bent = new osgGeoFX::EffectScene;
    bent->addEffect(&effect);
    bent->addChild(root);
    return bent;
}

osg::Matrixd viewOfAll(const osgGeoFX::Scene& scene, const osg::Group& tiles, double fieldOfView)
{
    const osg::BoundingSphere& bound = tiles.getBound();
    const osg::Vec3d middle(bound.center());
    osg::Vec3d upwards(0.0, 0.0, 1.0);
    if (scene.reference->isGeocentric())
    {
        upwards = middle;
        upwards.normalize();
    }
    const double distance = static_cast<double>(bound.radius()) / std::sin(fieldOfView / 2.0);
    return osg::Matrixd::lookAt(middle + upwards * distance, middle, osg::Vec3d(1.0, 2.0, 3.0));
}

} // namespace geofx::bench
