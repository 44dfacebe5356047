// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/effect/detail/NodeFinder.h>
#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/CoordinateSystemNode>
#include <osg/Group>
#include <osg/UserDataContainer>

#include <mutex>
#include <optional>

namespace osgGeoFX
{

class EffectScene;

/// Finds out what is known of the ground below a scene, and remembers where it is said. Thread-safe.
class GroundFinder
{
public:
    GroundFinder();
    /// What a scene states, and what is said by its terrain and by the nodes above this.
    Ground find(const EffectScene& scene, const osg::Group& terrain, const osg::NodePath& above);
    /// A traversal has come to a coordinate system below `top`, at the end of a path. So one that a pager brings is known
    /// in the next frame, however large the scene is.
    void meet(const osg::Group& top, const osg::NodePath& path);

private:
    /// The first coordinate system at `top` or below it; null where there is none.
    const osg::CoordinateSystemNode* systemBelow(const osg::Group& top);
    std::optional<TerrainInfo> terrainOf(const osg::Group& top, const osg::CoordinateSystemNode* system);

    std::mutex _mutex;
    NodeFinder _systems, _terrains;
    osg::ref_ptr<const osg::UserDataContainer> _terrainValues;
    std::optional<TerrainInfo> _terrain;
    /// Of a globe that has no coordinate system. Always the same: effects tell by it whether the ground has changed.
    const osg::ref_ptr<const osg::EllipsoidModel> _globe = new osg::EllipsoidModel;
};

} // namespace osgGeoFX
