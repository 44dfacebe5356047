// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/GroundFinder.h>

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/ShaderHost.h>

#include <osg/Math>

#include <string>

namespace osgGeoFX
{

namespace
{

bool isSystem(const osg::Node& node)
{
    // Asked for many nodes, and casts take their time: transforms are none.
    return !node.asTransform() && dynamic_cast<const osg::CoordinateSystemNode*>(&node);
}

bool isTerrainRoot(const osg::Node& node)
{
    const osg::UserDataContainer* values = node.getUserDataContainer();
    return values && values->getUserObjectIndex("geofx.format") < values->getNumUserObjects() &&
           isSystem(node);
}

/// What an application states comes before what a database says.
void addStated(const EffectScene::GroundDescription& stated, Ground& ground)
{
    if (stated.minHeight)
    {
        ground.heightsKnown = true;
        ground.minHeight = *stated.minHeight;
        ground.maxHeight = *stated.maxHeight;
    }
    if (stated.tileCells == 0) return;
    ground.tileEdge = 2.0 / stated.tileCells;
    // Two pixels of a picture with 1,000 of them for a radian, as in the kit's databases.
    if (ground.tileError == 0.0) ground.tileError = 0.002;
}

} // namespace

GroundFinder::GroundFinder() : _systems(&isSystem), _terrains(&isTerrainRoot) {}

void GroundFinder::meet(const osg::Group& top, const osg::NodePath& path)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _systems.meet(top, path);
}

const osg::CoordinateSystemNode* GroundFinder::systemBelow(const osg::Group& top)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return dynamic_cast<const osg::CoordinateSystemNode*>(_systems.find(top));
}

/// What a terrain says of itself: that whose root the coordinate system is, else the first one below `top`. Read again
/// only where the root has other user values than the last time.
std::optional<TerrainInfo> GroundFinder::terrainOf(const osg::Group& top,
                                                   const osg::CoordinateSystemNode* system)
{
    if (!system) return std::nullopt;
    const std::lock_guard<std::mutex> lock(_mutex);
    const osg::Node* root = isTerrainRoot(*system) ? system : _terrains.find(top);
    const osg::UserDataContainer* values = root ? root->getUserDataContainer() : nullptr;
    if (!values) return std::nullopt;
    if (values == _terrainValues) return _terrain;
    std::string error;
    std::optional<TerrainInfo> info = TerrainInfo::read(root, error);
    if (info)
    {
        _terrainValues = values;
        _terrain = info;
    }
    return info;
}

Ground GroundFinder::find(const EffectScene& scene, const osg::Group& terrain, const osg::NodePath& above)
{
    const osg::CoordinateSystemNode* system = nullptr;
    for (const osg::Node* node : above)
    {
        const auto* found = dynamic_cast<const osg::CoordinateSystemNode*>(node);
        if (found) system = found;
    }
    if (!system) system = systemBelow(terrain);
    Ground ground;
    const EffectScene::TerrainFrame frame = scene.getTerrainFrame();
    if (system && frame != EffectScene::PROJECTED) ground.ellipsoid = system->getEllipsoidModel();
    if (!ground.ellipsoid && frame == EffectScene::GEOCENTRIC) ground.ellipsoid = _globe;
    if (const std::optional<TerrainInfo> info = terrainOf(terrain, system))
    {
        ground.heightsKnown = true;
        ground.terrain = info->root;
        ground.minHeight = info->minHeight;
        ground.maxHeight = info->maxHeight;
        if (info->geocentric) ground.latitude = osg::DegreesToRadians(0.5 * (info->south + info->north));
        // A range is the radius and error / pixelError · pixelsPerRadian; both meshes may be off by their error.
        if (info->pixelsPerRadian > 0.0) ground.tileError = 2.0 * info->pixelError / info->pixelsPerRadian;
        // The diagonal of a cell, and half of the tile's.
        if (info->tileCells > 0) ground.tileEdge = 2.0 / info->tileCells;
    }
    addStated(scene.getGround(), ground);
    const ShaderHost* const host = scene.getShaderHost();
    ground.coarseTiles = host && host->leavesTilesCoarse();
    return ground;
}

std::string EffectScene::GroundDescription::fault() const
{
    constexpr double lowest = -12000.0, highest = 100000.0;
    constexpr int mostCells = 4096;
    if (minHeight.has_value() != maxHeight.has_value())
        return "minHeight and maxHeight must be stated together, or neither of them.";
    if (minHeight && !(*minHeight >= lowest && *minHeight <= *maxHeight && *maxHeight <= highest))
        return "minHeight and maxHeight must be metres from -12000 to 100000, and minHeight must not be "
               "above "
               "maxHeight.";
    if (tileCells < 0 || tileCells > mostCells)
        return "tileCells must be a whole number from 1 to 4096, or 0 where it is unknown.";
    return {};
}

} // namespace osgGeoFX
