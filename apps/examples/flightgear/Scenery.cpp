// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Scenery.h"

#include <osgGeoFX/scene/EffectScene.h>

#include <osg/CoordinateSystemNode>
#include <osg/Fog>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Program>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgUtil/CullVisitor>

#include <simgear/bucket/newbucket.hxx>
#include <simgear/debug/logstream.hxx>
#include <simgear/misc/ResourceManager.hxx>
#include <simgear/misc/sg_path.hxx>
#include <simgear/props/props.hxx>
#include <simgear/scene/material/Effect.hxx>
#include <simgear/scene/material/EffectCullVisitor.hxx>
#include <simgear/scene/material/EffectGeode.hxx>
#include <simgear/scene/material/Pass.hxx>
#include <simgear/scene/material/Technique.hxx>
#include <simgear/scene/material/matlib.hxx>
#include <simgear/scene/model/modellib.hxx>
#include <simgear/scene/tgdb/userdata.hxx>
#include <simgear/scene/util/SGReaderWriterOptions.hxx>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flightgear
{

namespace
{

/// SimGear's cull visitor, which draws an EffectGeode with the states of its effect. Those have the programs, and no
/// visitor of state sets finds them; so they are adapted where they are chosen.
class AdaptingCullVisitor : public simgear::EffectCullVisitor
{
public:
    osgUtil::CullVisitor* clone() const override { return new AdaptingCullVisitor; }
    using simgear::EffectCullVisitor::apply;
    void apply(osg::Geode& node) override
    {
        const auto* geode = dynamic_cast<simgear::EffectGeode*>(&node);
        const simgear::Effect* effect = geode ? geode->getEffect() : nullptr;
        if (effect) adapt(*effect);
        simgear::EffectCullVisitor::apply(node);
    }

private:
    static void adapt(const simgear::Effect& effect)
    {
        for (const auto& technique : effect.techniques)
            for (const auto& pass : technique->passes)
            {
                osg::StateAttribute* program = pass->getAttribute(osg::StateAttribute::PROGRAM);
                if (program) osgGeoFX::EffectScene::adapt(static_cast<osg::Program&>(*program));
            }
    }
};

/// What FlightGear's own defaults say of pictures: shaders for land and water, but not those that draw its sky, too.
const std::vector<std::pair<std::string, std::string>> settings = {
    {"/sim/rendering/materials-file", "Materials/regions/materials.xml"},
    {"/sim/rendering/random-vegetation", "true"},
    {"/sim/rendering/random-objects", "true"},
    {"/sim/rendering/shaders/quality-level", "1"},
    {"/sim/rendering/shaders/quality-level-internal", "1"},
    {"/sim/rendering/shaders/generic", "1"},
    {"/sim/rendering/shaders/landmass", "1"},
    {"/sim/rendering/shaders/model", "1"},
    {"/sim/rendering/shaders/crop", "1"},
    {"/sim/rendering/shaders/transition", "1"},
    {"/sim/rendering/shaders/urban", "1"},
    {"/sim/rendering/shaders/water", "1"},
    {"/sim/rendering/point-sprites", "true"},
    {"/sim/startup/season", "summer"},
    {"/environment/snow-level-m", "8000"},
};

osg::ref_ptr<osg::LightSource> makeSun(const Place& place)
{
    osg::Matrixd local;
    osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(
        osg::DegreesToRadians(place.latitude), osg::DegreesToRadians(place.longitude), 0.0, local);
    const osg::Vec3d direction = osg::Matrixd::transform3x3(osg::Vec3d(-0.5, -0.45, 0.74), local);
    const osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setPosition(osg::Vec4(direction, 0.0));
    sun->getLight()->setAmbient({0.0f, 0.0f, 0.0f, 1.0f});
    sun->getLight()->setDiffuse({0.95f, 0.93f, 0.88f, 1.0f});
    sun->getLight()->setSpecular({0.6f, 0.6f, 0.6f, 1.0f});
    return sun;
}

/// What FlightGear sets for its whole scene: its shaders read the fog and the ambient light.
void setSurroundings(osg::StateSet& state)
{
    const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(osg::Fog::EXP2);
    fog->setColor({0.72f, 0.80f, 0.88f, 1.0f});
    fog->setDensity(1e-5f);
    state.setAttributeAndModes(fog);
    const osg::ref_ptr<osg::LightModel> light = new osg::LightModel;
    light->setAmbientIntensity({0.45f, 0.47f, 0.52f, 1.0f});
    state.setAttributeAndModes(light);
    state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
}

} // namespace

struct Scenery::Parts
{
    SGPropertyNode_ptr properties = new SGPropertyNode;
    SGMaterialLibPtr materials = new SGMaterialLib;
    osg::ref_ptr<simgear::SGReaderWriterOptions> options = new simgear::SGReaderWriterOptions;
};

Scenery::Scenery(const std::string& root, const std::vector<std::pair<std::string, std::string>>& properties)
    : _parts(std::make_unique<Parts>())
{
    SGPropertyNode& tree = *_parts->properties;
    const SGPath folder = SGPath::fromUtf8(root);
    if (!(folder / "Scenery").exists())
        throw std::runtime_error("\"" + root +
                                 "\" is not FlightGear's data folder: it has no Scenery; name another one.");
    sglog().setLogLevels(SG_ALL, SG_ALERT);
    simgear::ResourceManager::instance()->addBasePath(folder);
    for (const auto& [name, value] : settings)
        tree.setStringValue(name, value);
    for (const auto& [name, value] : properties)
        tree.setStringValue(name, value);
    sgUserDataInit(&tree);
    simgear::SGModelLib::init(root, &tree);
    const SGPath materials = folder / tree.getStringValue("/sim/rendering/materials-file");
    if (!_parts->materials->load(folder, materials, &tree))
        throw std::runtime_error("FlightGear's materials (" + materials.utf8Str() +
                                 ") cannot be read; install them.");

    simgear::SGReaderWriterOptions& options = *_parts->options;
    options.getDatabasePathList() = {(folder / "Scenery").utf8Str(), root};
    options.setMaterialLib(_parts->materials);
    options.setPropertyNode(&tree);
    options.setSceneryPathSuffixes({"Objects", "Terrain"});
    options.setPluginStringData("SimGear::FG_ROOT", root);
    osgDB::Registry::instance()->getDataFilePathList() = options.getDatabasePathList();
    osgUtil::CullVisitor::prototype() = new AdaptingCullVisitor;
}

Scenery::~Scenery()
{
    osgUtil::CullVisitor::prototype() = new osgUtil::CullVisitor;
    // Its objects have SimGear's, whose statics go before OSG's.
    osgDB::Registry::instance()->clearObjectCache();
}

osg::ref_ptr<osg::Group> Scenery::load(const Place& place, double radius) const
{
    const double degrees = radius / 111320.0;
    const double across = degrees / std::max(0.05, std::cos(osg::DegreesToRadians(place.latitude)));
    std::vector<SGBucket> buckets;
    sgGetBuckets(SGGeod::fromDeg(place.longitude - across, place.latitude - degrees),
                 SGGeod::fromDeg(place.longitude + across, place.latitude + degrees), buckets);
    const osg::ref_ptr<osg::CoordinateSystemNode> world = new osg::CoordinateSystemNode;
    world->setEllipsoidModel(new osg::EllipsoidModel);
    for (const SGBucket& bucket : buckets)
    {
        const osg::ref_ptr<osg::Node> tile =
            osgDB::readRefNodeFile(bucket.gen_index_str() + ".stg", _parts->options);
        if (tile) world->addChild(tile);
    }
    if (world->getNumChildren() == 0)
        throw std::runtime_error(
            "No tile can be read around this place; name another one, or a larger radius.");
    world->addChild(makeSun(place));
    setSurroundings(*world->getOrCreateStateSet());
    return world;
}

} // namespace flightgear
