// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The extension <geofx> of osgEarth: a scene's effects in an .earth file, for everything that the map draws.
#include "HeightWatch.h"
#include "HostUnits.h"
#include "TileCulling.h"
#include "VirtualProgramHost.h"

#include "../geofx/SceneFile.h"
#include "../geofx/SceneNode.h"
#include "../geofx/SceneReach.h"

#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/EngineTiles.h>
#include <osgGeoFX/viewer/EarthSky.h>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgEarth/Extension>
#include <osgEarth/Horizon>
#include <osgEarth/MapNode>
#include <osgEarth/NodeUtils>
#include <osgEarth/ScreenSpaceLayout>
#include <osgEarth/TerrainEngineNode>
#include <osgEarth/URI>
#include <osgEarth/Utils>
#include <osgEarth/VirtualProgram>

#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Raises the eye of the horizon by which osgEarth culls the annotations and features of the map's layers. The scene itself leaves out
/// labels that the deformed globe hides.
class HorizonRaiser : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osg::ref_ptr<osgEarth::Horizon> horizon;
        const std::optional<osg::Vec3d> viewPoint = raisedViewPoint(*visitor);
        if (!viewPoint || !osgEarth::ObjectStorage::get(visitor, horizon))
        {
            traverse(node, visitor);
            return;
        }
        const osg::Vec3d eye = horizon->getEye();
        horizon->setEye(*viewPoint, nullptr);
        traverse(node, visitor);
        // Draping goes by the eye.
        horizon->setEye(eye, visitor->asCullVisitor()->getProjectionMatrix());
    }
};

/** The defines of the terrain's programs in a frame.

    Panorama maps lay on their painting what osgEarth drapes (VirtualProgramHost.cpp), where the program has osgEarth's function for it.

    osgEarth hides the seams between its levels by moving vertices, by the distance of the undeformed ground. Where effects choose
    levels by other distances, this would open the seams, so it is off there. Skirts hide them. */
class TerrainDefines : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osgUtil::CullVisitor* const cull = visitor->asCullVisitor();
        const bool draped = cull && drapes(*cull);
        const bool unmorphed = cull && !isMovedVertically(*node, *visitor);
        if (draped) cull->pushStateSet(_draped);
        if (unmorphed) cull->pushStateSet(_unmorphed);
        traverse(node, visitor);
        if (unmorphed) cull->popStateSet();
        if (draped) cull->popStateSet();
    }

private:
    static bool drapes(osgUtil::CullVisitor& cull)
    {
        using osgEarth::VirtualProgram;
        for (const osgUtil::StateGraph* graph = cull.getCurrentStateGraph(); graph; graph = graph->_parent)
        {
            const VirtualProgram* program = VirtualProgram::get(graph->getStateSet());
            if (program && program->getPolyShader("oe_overlay_fragment")) return true;
        }
        return false;
    }

    static osg::ref_ptr<osg::StateSet> defining(const std::vector<const char*>& names,
                                                osg::StateAttribute::GLModeValue value)
    {
        osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        for (const char* name : names)
            state->setDefine(name, value);
        return state;
    }

    const osg::ref_ptr<osg::StateSet> _draped = defining({"GEOFX_OSGEARTH_DRAPED"}, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::StateSet> _unmorphed =
        defining({"OE_TERRAIN_MORPH_GEOMETRY", "OE_TERRAIN_MORPH_IMAGERY"},
                 osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
};

// osgEarth's interfaces have no virtual destructors; nobody deletes by them.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"

/** Puts an EffectScene above a MapNode.

    The scene is what osgEarth has read of the element, so maps may come from anywhere and include files. All faults of it are
    warnings, with the file and the line where the map is a file or has an address; the map is drawn without effects then.

    Threads: as for osgEarth's extensions, which are added and removed between frames. */
class GeoFXExtension : public osgEarth::Extension, public osgEarth::ExtensionInterface<osgEarth::MapNode>
{
public:
    META_OE_Extension(osgGeoFX, GeoFXExtension, geofx);
    GeoFXExtension() = default;
    explicit GeoFXExtension(const osgEarth::ConfigOptions& options) : _config(options) {}

    void setDBOptions(const osgDB::Options* options) override { _options = options; }
    const osgEarth::ConfigOptions& getConfigOptions() const override { return _config; }

    bool connect(osgEarth::MapNode* map) override
    {
        SceneResult read = readScene();
        for (const std::string& error : read.errors)
            OSG_WARN << "osgGeoFX: " << error << std::endl;
        if (!map || !read.scene) return false;
        if (map->getNumParents() == 0)
        {
            OSG_WARN
                << "osgGeoFX: " << _config.getConfig().referrer()
                << ": the map has no parent, so the effects of <geofx> have no place above it; add the map "
                   "to a group, such as a viewer's scene, before the extension."
                << std::endl;
            return false;
        }
        if (osgEarth::findFirstParentOfType<EffectScene>(map))
        {
            OSG_WARN << "osgGeoFX: " << _config.getConfig().referrer()
                     << ": the map has effects already, so this <geofx> is left out; write all effects into "
                        "one <geofx>."
                     << std::endl;
            return false;
        }
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        _scene = scene;
        scene->setName("osgGeoFX scene");
        osgEarth::insertParent(scene.get(), map);
        std::string error;
        if (!addEffects(*read.scene, *scene, *map, error))
        {
            OSG_WARN << "osgGeoFX: " << error << std::endl;
            disconnect(map);
            return false;
        }
        if (!takeUnits(*map, error)) OSG_WARN << "osgGeoFX: " << error << std::endl;
        // A plane as large as the Earth might be taken for one.
        if (!map->isGeocentric() && scene->getTerrainFrame() == EffectScene::AUTOMATIC)
            scene->setTerrainFrame(EffectScene::PROJECTED);
        refineWhatIsSeen(*map, *scene);
        scene->setShaderHost(new VirtualProgramHost);
        scene->setEngineCulling(read.scene->engine->culling);
        scene->setLayoutBins({OSGEARTH_SCREEN_SPACE_LAYOUT_BIN});
        if (osgEarth::TerrainEngine* engine = map->getTerrainEngine())
        {
            scene->setEngineTerrain(engine->getNode());
            const EffectScene::GroundDescription& ground = scene->getGround();
            if (ground.minHeight && ground.maxHeight)
            {
                _heights =
                    new HeightWatch(_config.getConfig().referrer(), *ground.minHeight, *ground.maxHeight);
                engine->addCreateTileModelCallback(_heights);
            }
        }
        _culling = new TileCulling;
        _culling->add(*map);
        _raiser = new HorizonRaiser;
        map->getLayerNodeGroup()->addCullCallback(_raiser);
        if (osgEarth::TerrainEngine* engine = map->getTerrainEngine())
        {
            _defines = new TerrainDefines;
            engine->getNode()->addCullCallback(_defines);
        }
        if (read.scene->background) addSky(*read.scene->background, *map, *scene);
        return true;
    }

    bool disconnect(osgEarth::MapNode* map) override
    {
        if (map && _raiser) map->getLayerNodeGroup()->removeCullCallback(_raiser);
        _raiser = nullptr;
        if (map && _defines && map->getTerrainEngine())
            map->getTerrainEngine()->getNode()->removeCullCallback(_defines);
        _defines = nullptr;
        if (map && _culling) _culling->remove(*map);
        _culling = nullptr;
        if (map && _heights && map->getTerrainEngine())
            map->getTerrainEngine()->removeCreateTileModelCallback(_heights);
        _heights = nullptr;
        osg::ref_ptr<osg::Group> sky;
        if (_sky.lock(sky))
        {
            sky->removeChild(0, 1); // the sky itself
            osgEarth::removeGroup(sky.get());
        }
        _sky = nullptr;
        osg::ref_ptr<EffectScene> scene;
        if (!_scene.lock(scene)) return false;
        osgEarth::removeGroup(scene.get());
        _scene = nullptr;
        return true;
    }

protected:
    ~GeoFXExtension() override = default;

private:
    static SceneElement elementOf(const osgEarth::Config& config)
    {
        SceneElement element{config.key(), config.value(), {}};
        for (const osgEarth::Config& child : config.children())
            element.children.push_back(elementOf(child));
        return element;
    }

    /// Tiles of osgEarth are so fine, for their distance, that the curve of a bend is smooth by them as they are. A bend asks for
    /// finer ones where the file says so.
    static void keepLevelsInBends(SceneElement& scene)
    {
        const auto isNamed = [](const SceneElement& element, const char* name)
        {
            return osgDB::equalCaseInsensitive(element.name, name);
        };
        for (SceneElement& part : scene.children)
        {
            if (!isNamed(part, "effects")) continue;
            for (SceneElement& effect : part.children)
            {
                const bool bends = isNamed(effect, "birdsEyeView") || isNamed(effect, "pedestrianView") ||
                                   isNamed(effect, "blendedView");
                const bool states =
                    std::any_of(effect.children.begin(), effect.children.end(),
                                [&](const SceneElement& each) { return isNamed(each, "transitionDetail"); });
                if (bends && !states) effect.children.push_back({"transitionDetail", "1", {}});
            }
        }
    }

    SceneResult readScene() const
    {
        const osgEarth::Config& config = _config.getConfig();
        // A map from a string refers to nothing. Its files are sought from where the program runs.
        std::string file = config.referrer(), text;
        const std::string path = osgDB::findDataFile(file, _options.get());
        if (!path.empty())
        {
            file = path;
            text = readSceneText(path);
        }
        else if (!file.empty())
            text = osgEarth::URI(file).readString(_options.get()).getString();
        const bool isAddress = file.find("://") != std::string::npos;
        std::string folder = osgDB::getFilePath(isAddress ? file : osgDB::getRealPath(file));
        if (folder.empty()) folder = osgDB::getCurrentWorkingDirectory();
        SceneElement scene = elementOf(config);
        keepLevelsInBends(scene);
        SceneResult result = parseEngineScene(scene, text, file, folder);
        if (!result.scene) return result;
        result.errors = faultsOfFiles(*result.scene, folder, _options.get());
        result.scene->anywhere = isAllowedOutside(_options.get());
        if (!result.errors.empty()) result.scene.reset();
        return result;
    }

    /// Whether a tile is so far beyond the horizon of a panorama map that all of it is one point there. It has no end of detail
    /// otherwise: behind and beside the picture at once, where the map tells least, tile after tile would come.
    static bool isBeyondPanoramas(const EffectScene& scene, bool globe, const osg::Node& tile,
                                  osg::NodeVisitor& visitor)
    {
        osgUtil::CullVisitor* cull = visitor.asCullVisitor();
        const osg::Camera* camera = cull ? cull->getCurrentCamera() : nullptr;
        const PanoramaMap* map = nullptr;
        for (unsigned int i = 0; i < scene.getNumEffects() && !map; ++i)
        {
            const auto* each = dynamic_cast<const PanoramaMap*>(scene.getEffect(i));
            if (each && each->getEnabled() && each->getProjection()) map = each;
        }
        if (!camera || !map) return false;
        const osg::Vec3d eye = camera->getInverseViewMatrix().getTrans();
        const osg::Matrixd& projection = camera->getProjectionMatrix();
        const double height = globe ? eye.length() - osg::WGS_84_RADIUS_POLAR : eye.z();
        const double shown = (projection(3, 3) == 0.0 ? height : 1.0) / std::abs(projection(0, 0));
        const double radius = map->getViewRadius() > 0.0 ? map->getViewRadius() : shown;
        // Heights and widths fade within half of the distance to the horizon. High mountains before the base may rise into sight.
        constexpr double generous = 2.0, mountains = 2e5;
        const double reach = generous * (1.5 * map->getHorizonDistance() + 1.0) * radius + mountains;
        const osg::BoundingSphere& bound = tile.getBound();
        const osg::Vec3d center(bound.center());
        const double turn = std::acos(std::clamp(eye * center / (eye.length() * center.length()), -1.0, 1.0));
        const double away = globe ? turn * osg::WGS_84_RADIUS_EQUATOR
                                  : std::hypot(center.x() - eye.x(), center.y() - eye.y());
        return away - 1.6 * static_cast<double>(bound.radius()) > reach;
    }

    /// The engine's own levels go by distances and by a frustum that contains all that is shown.
    static void refineWhatIsSeen(osgEarth::MapNode& map, const EffectScene& scene)
    {
        osgEarth::TerrainEngine* engine = map.getTerrainEngine();
        if (!engine) return;
        const osg::observer_ptr<const EffectScene> effects = &scene;
        const bool globe = map.isGeocentric();
        engine->setComputeTileRangeCallback(
            [effects, globe](osg::Node* tile, osg::NodeVisitor& visitor)
            {
                osg::ref_ptr<const EffectScene> known;
                return effects.lock(known) && isBeyondPanoramas(*known, globe, *tile, visitor) ? 0.0f : -1.0f;
            });
        engine->setComputeTilePixelSizeCallback(
            [](osg::Node* tile, osg::NodeVisitor& visitor)
            {
                // osgEarth measures half of a tile's width; 0 would mean its own measure.
                constexpr double halfWidth = 0.7, none = 1e-6;
                const double size = tilePixelSize(*tile, visitor);
                return static_cast<float>(size < 0.0 ? size : std::max(halfWidth * size, none));
            });
        if (engine->getOptions().getHeightFieldSkirtRatio() <= 0.0f)
            OSG_WARN
                << "osgGeoFX: the map's terrain has no skirts, so seams between its levels of detail may "
                   "show under the effects of <geofx>; write <terrain skirt_ratio=\"0.05\"/> in the "
                   "<options> of the map."
                << std::endl;
    }

    /// A bend shows what lies below the horizon of osgEarth's own sky, which draws nothing there.
    void addSky(const SceneBackground& background, const osgEarth::MapNode& map, EffectScene& scene)
    {
        if (!map.isGeocentric())
        {
            OSG_WARN << "osgGeoFX: "
                     << background.place.message(
                            "the map is no round Earth to put a sky around, so the sky "
                            "is left out; expected: no sky, or a map that is geocentric.")
                     << std::endl;
            return;
        }
        const SceneColor& air = background.color;
        const osg::ref_ptr<osg::Node> sky =
            makeEarthSky(osg::EllipsoidModel(), osg::Vec3(osg::Vec3d(air[0], air[1], air[2])),
                         background.visibility.value_or(DEFAULT_VISIBILITY), &scene);
        const osg::ref_ptr<osg::Group> both = new osg::Group;
        osgEarth::insertParent(both.get(), &scene);
        both->insertChild(0, sky);
        _sky = both;
    }

    bool takeUnits(osgEarth::MapNode& map, std::string& error)
    {
        const osgEarth::TerrainEngine* engine = map.getTerrainEngine();
        osgEarth::TerrainResources* resources = engine ? engine->getResources() : nullptr;
        if (!resources) return true;
        return _units.reserve(*resources, *_scene, error);
    }

    osgEarth::ConfigOptions _config;
    osg::ref_ptr<const osgDB::Options> _options;
    osg::observer_ptr<EffectScene> _scene; ///< it holds the map, which holds the extension
    osg::ref_ptr<HorizonRaiser> _raiser;
    osg::ref_ptr<TerrainDefines> _defines;
    osg::ref_ptr<TileCulling> _culling;
    osg::ref_ptr<HeightWatch> _heights;
    osg::observer_ptr<osg::Group> _sky; ///< the kit's sky, and the scene; null for none
    HostUnits _units;
};
#pragma GCC diagnostic pop

REGISTER_OSGEARTH_EXTENSION(osgearth_geofx, GeoFXExtension)

} // namespace osgGeoFX
