// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Ground.h"

#include <osgGeoFX/geodata/MaterialLegend.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <simgear/scene/material/EffectGeode.hxx>
#include <simgear/scene/material/mat.hxx>

#include <algorithm>
#include <iostream>
#include <stdexcept>

namespace flightgear
{

namespace
{

/// The name of the material of ground; empty for all else. SimGear knows a material by several names.
std::string nameOf(const osgGeoFX::MaterialCover& cover, const osg::Node& node)
{
    const auto* geode = dynamic_cast<const simgear::EffectGeode*>(&node);
    if (!geode) return {};
    // The sea between the tiles that have land has no material of its own.
    if (geode->getName() == "Ocean tile") return "Ocean";
    // Only the loader of terrain sets this name, and a material; that of other geodes is not initialized.
    const SGMaterial* material = geode->getName() == "EffectGeode" ? geode->getMaterial() : nullptr;
    if (!material || material->get_names().empty()) return {};
    const std::vector<std::string>& names = material->get_names();
    const auto known = std::find_if(names.begin(), names.end(),
                                    [&](const std::string& name) { return cover.getCover(name) != nullptr; });
    return known == names.end() ? names.front() : *known;
}

/// Finds the lowest and the highest vertex of ground.
class HeightFinder : public osg::NodeVisitor
{
public:
    explicit HeightFinder(const osgGeoFX::MaterialCover& cover)
        : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _cover(cover)
    {
        setNodeMaskOverride(~0u);
    }
    void apply(osg::Geode& node) override
    {
        if (nameOf(_cover, node).empty()) return;
        const osg::Matrixd toWorld = osg::computeLocalToWorld(getNodePath());
        for (unsigned int i = 0; i < node.getNumDrawables(); ++i)
        {
            const osg::Geometry* geometry = node.getDrawable(i)->asGeometry();
            const auto* places =
                dynamic_cast<const osg::Vec3Array*>(geometry ? geometry->getVertexArray() : nullptr);
            for (std::size_t each = 0; places && each < places->size(); ++each)
                meet(osg::Vec3d((*places)[each]) * toWorld);
        }
    }
    double lowest = 1e5, highest = -1e5;

private:
    void meet(const osg::Vec3d& place)
    {
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        _globe.convertXYZToLatLongHeight(place.x(), place.y(), place.z(), latitude, longitude, height);
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
    }

    const osgGeoFX::MaterialCover& _cover;
    const osg::EllipsoidModel _globe;
};

} // namespace

Ground::Ground(const osgGeoFX::Scene& scene, const std::vector<std::string>& covers)
    : _scene(scene), _cover(osgGeoFX::readMaterialCover("flightgear", coverUnit))
{
    for (const std::string& line : covers)
    {
        const std::size_t comma = std::min(line.find(','), line.size() - 1);
        const auto shares = osgGeoFX::parseNumbers(line.substr(comma + 1));
        if (!shares || shares->size() != 3 ||
            !_cover->setCover(line.substr(0, comma), {(*shares)[0], (*shares)[1], (*shares)[2], false}))
            throw std::runtime_error("--cover " + line +
                                     ": write it as NAME,TREES,TOWN,BARE, shares from 0 to 1.");
    }
    const osgGeoFX::MaterialCover& legend = *_cover;
    _cover->setNaming([&legend](const osg::Node& node) { return nameOf(legend, node); });
    osg::Node& world = *scene.effects->getChild(0);
    _cover->setKeepsObjects(true);
    _cover->apply(world);
    scene.guard->addListener(_cover);

    HeightFinder heights(*_cover);
    world.accept(heights);
    if (heights.lowest > heights.highest) return;
    _highest = heights.highest;
    osgGeoFX::EffectScene::GroundDescription description;
    description.minHeight = heights.lowest;
    description.maxHeight = heights.highest;
    scene.effects->setGround(description);
}

double Ground::longestEdge(const Frame& frame, double distance) const
{
    osgGeoFX::CameraRange cameras;
    cameras.ground = _scene.effects->ground();
    cameras.projection = frame.projection();
    cameras.distance = distance;
    return osgGeoFX::MeshRefiner::longestEdge(*_scene.effects, cameras, frame.pixel());
}

void Ground::refine(double longestEdge)
{
    _refiner = new osgGeoFX::MeshRefiner(longestEdge);
    _refiner->refine(*_scene.effects->getChild(0));
    _scene.guard->addListener(_refiner);
    // Strokes stand on the split triangles.
    _scene.effects->listenTo(*_scene.guard);
    std::cout << "Edges are at most " << _refiner->getLongestEdge() << " m long; "
              << _refiner->refinedGeometries() << " geometries now have " << _refiner->refinedTriangles()
              << " triangles." << std::endl;
}

} // namespace flightgear
