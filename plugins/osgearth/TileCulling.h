// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/NodeCallback>
#include <osg/observer_ptr>
#include <osgEarth/MapNode>
#include <osgEarth/Terrain>

namespace osgGeoFX
{

/** Leaves out tiles of osgEarth's terrain that the deformed picture does not show. osgEarth culls by a frustum that contains all of
    the picture, and so holds much more.

    Each tile gets a cull callback, in the update after its creation. Tiles that have finer ones are judged by their spheres, and
    those that are drawn by their boxes.

    Threads: add() and remove() between frames. */
class TileCulling : public osgEarth::TerrainCallback
{
public:
    void add(osgEarth::MapNode& map);
    void remove(osgEarth::MapNode& map);

    void onTileUpdate(const osgEarth::TileKey& key, osg::Node* graph,
                      osgEarth::TerrainCallbackContext& context) override;

protected:
    ~TileCulling() override = default;

private:
    osg::ref_ptr<osg::NodeCallback> _visitors; ///< of the engine's node
};

} // namespace osgGeoFX
