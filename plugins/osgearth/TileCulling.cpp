// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TileCulling.h"

#include <osgGeoFX/scene/EngineTiles.h>

#include <osg/CullStack>
#include <osg/Drawable>
#include <osg/NodeVisitor>
#include <osg/Plane>
#include <osg/Polytope>
#include <osg/Transform>
#include <osgEarth/TerrainEngineNode>
#include <osgEarth/TerrainTileNode>

namespace osgGeoFX
{

namespace
{

/// The cull visitor that has come to the engine. The engine traverses its tiles with a visitor of its own.
thread_local osg::NodeVisitor* engineVisitor = nullptr;

class VisitorKeeper : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osg::NodeVisitor* const former = engineVisitor;
        engineVisitor = visitor;
        traverse(node, visitor);
        engineVisitor = former;
    }
};

/// Finds the mesh of a tile without finer ones, and where it lies.
class MeshFinder : public osg::NodeVisitor
{
public:
    MeshFinder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Node& node) override
    {
        if (dynamic_cast<osgEarth::TerrainTileNode*>(&node) && ++_tiles > 1) return;
        if (!mesh) traverse(node);
    }
    void apply(osg::Transform& node) override
    {
        if (mesh || _tiles > 1) return;
        placed = &node;
        traverse(node);
    }
    void apply(osg::Drawable& drawable) override
    {
        if (!mesh && placed) mesh = &drawable;
    }

    osg::Drawable* mesh = nullptr;
    osg::Transform* placed = nullptr;

private:
    int _tiles = 0;
};

class TileCallback : public osg::NodeCallback
{
public:
    explicit TileCallback(osg::Node& tile)
    {
        MeshFinder finder;
        tile.accept(finder);
        if (!finder.mesh) return;
        _mesh = finder.mesh;
        _placed = finder.placed;
    }

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        if (engineVisitor && isOut(*node))
            touch(*node, *visitor);
        else
            traverse(node, visitor);
    }

private:
    /// Has a tile culled by osgEarth, which keeps it then. osgEarth unloads tiles that it does not meet, and a parent that is drawn by
    /// its four tiles would load them again.
    void touch(osg::Node& tile, osg::NodeVisitor& visitor)
    {
        auto* const culling = dynamic_cast<osg::CullStack*>(&visitor);
        if (!culling) return;
        osg::CullingSet& set = culling->getCurrentCullingSet();
        osg::Polytope former = set.getFrustum(), nothing;
        const osg::CullingSet::Mask formerMask = set.getCullingMask();
        nothing.add(osg::Plane(0.0, 0.0, 0.0, -1e30));
        set.setFrustum(nothing);
        set.setCullingMask(osg::CullingSet::VIEW_FRUSTUM_CULLING);
        traverse(&tile, &visitor);
        set.setFrustum(former);
        set.setCullingMask(formerMask);
    }

    bool isOut(const osg::Node& tile) const
    {
        if (isTileOutOfSight(tile, *engineVisitor)) return true;
        osg::ref_ptr<osg::Drawable> mesh;
        osg::ref_ptr<osg::Transform> placed;
        if (!_mesh.lock(mesh) || !_placed.lock(placed)) return false;
        osg::Matrix placement;
        placed->computeLocalToWorldMatrix(placement, nullptr);
        return isBoxOutOfSight(mesh->getBoundingBox(), placement, *engineVisitor);
    }

    osg::observer_ptr<osg::Drawable> _mesh; ///< none where the tile had finer ones already
    osg::observer_ptr<osg::Transform> _placed;
};

TileCallback* callbackOf(osg::Node& tile)
{
    for (osg::Callback* each = tile.getCullCallback(); each; each = each->getNestedCallback())
        if (auto* const ours = dynamic_cast<TileCallback*>(each)) return ours;
    return nullptr;
}

void addCallback(osg::Node& tile)
{
    if (!callbackOf(tile)) tile.addCullCallback(new TileCallback(tile));
}

/// Goes to each tile of an engine.
class EachTile : public osg::NodeVisitor
{
public:
    explicit EachTile(void (*act)(osg::Node&)) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _act(act) {}

    void apply(osg::Node& node) override
    {
        if (dynamic_cast<osgEarth::TerrainTileNode*>(&node)) _act(node);
        traverse(node);
    }

private:
    void (*_act)(osg::Node&);
};

void forEachTile(osg::Node& engine, void (*act)(osg::Node&))
{
    EachTile visitor(act);
    engine.accept(visitor);
}

} // namespace

void TileCulling::add(osgEarth::MapNode& map)
{
    osgEarth::TerrainEngine* engine = map.getTerrainEngine();
    if (!engine) return;
    _visitors = new VisitorKeeper;
    engine->getNode()->addCullCallback(_visitors);
    forEachTile(*engine->getNode(), addCallback);
    map.getTerrain()->addTerrainCallback(this);
}

void TileCulling::remove(osgEarth::MapNode& map)
{
    osgEarth::TerrainEngine* engine = map.getTerrainEngine();
    if (!engine || !_visitors) return;
    map.getTerrain()->removeTerrainCallback(this);
    engine->getNode()->removeCullCallback(_visitors);
    _visitors = nullptr;
    forEachTile(*engine->getNode(),
                [](osg::Node& tile)
                {
                    if (TileCallback* const callback = callbackOf(tile)) tile.removeCullCallback(callback);
                });
}

void TileCulling::onTileUpdate(const osgEarth::TileKey&, osg::Node* graph, osgEarth::TerrainCallbackContext&)
{
    if (graph && dynamic_cast<osgEarth::TerrainTileNode*>(graph)) addCallback(*graph);
}

} // namespace osgGeoFX
