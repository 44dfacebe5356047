// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/EffectScene.h>

#include <osgGeoFX/effect/ContextWatch.h>
#include <osgGeoFX/effect/NodeFinder.h>
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/effect/TileNormals.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/scene/CompensatingCullVisitor.h>
#include <osgGeoFX/scene/EffectProgram.h>
#include <osgGeoFX/scene/FollowingPrograms.h>

#include <osg/CoordinateSystemNode>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

namespace osgGeoFX
{

namespace
{

/// How far below the scene a coordinate system may be, and a terrain.
constexpr std::size_t deepestSystem = 9, deepestTerrain = 32;

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

void setDefine(osg::StateSet& state, const std::string& name, bool on)
{
    state.setDefine(name, on ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
}

/// What a deformation does for a camera; no frame where it does nothing.
struct Placed
{
    osg::ref_ptr<const DeformationFrame> frame;
    DeformationFrame::Uniforms uniforms;
};

/// The deformations of a camera, by their effects.
using Frames = std::vector<Placed>;

bool finite(const DeformationFrame::Uniforms& uniforms)
{
    return std::all_of(uniforms.begin(), uniforms.end(),
                       [](const auto& uniform)
                       {
                           const osg::Vec4d& value = uniform.second;
                           return std::isfinite(static_cast<float>(value.x())) &&
                                  std::isfinite(static_cast<float>(value.y())) &&
                                  std::isfinite(static_cast<float>(value.z())) &&
                                  std::isfinite(static_cast<float>(value.w()));
                       });
}

/// The state of one traversal of one camera.
struct CameraState
{
    osg::ref_ptr<osg::StateSet> set;
    /// Of the effects that it was made for.
    std::shared_ptr<const TextureUnits> units;
    /// Those of each effect, in the order of its list: to look for them by name takes longer than to set them.
    std::vector<std::vector<osg::ref_ptr<osg::Uniform>>> uniforms;
};

/// The uniform in a place of an effect's list.
osg::Uniform& uniformAt(CameraState& state, std::size_t effect, std::size_t place, const std::string& name)
{
    std::vector<osg::ref_ptr<osg::Uniform>>& known = state.uniforms[effect];
    if (known.size() <= place) known.resize(place + 1);
    osg::ref_ptr<osg::Uniform>& uniform = known[place];
    // Another effect may have taken the former one's place; what comes before the name is the place's.
    const bool same =
        uniform && uniform->getName().size() > name.size() &&
        uniform->getName().compare(uniform->getName().size() - name.size(), name.size(), name) == 0;
    if (!same)
        uniform =
            state.set->getOrCreateUniform(EffectProgram::prefix(effect) + name, osg::Uniform::FLOAT_VEC4);
    return *uniform;
}

/// Of the deformations, the defines of all effects.
void fill(CameraState& state, const Frames& frames)
{
    setDefine(*state.set, "GEOFX_DEFORMATION", true);
    state.uniforms.resize(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i)
    {
        setDefine(*state.set, EffectProgram::define(i), frames[i].frame.valid());
        for (std::size_t place = 0; place < frames[i].uniforms.size(); ++place)
        {
            const auto& [name, value] = frames[i].uniforms[place];
            uniformAt(state, i, place, name).set(osg::Vec4f(value));
        }
    }
}

CameraState createState(const EffectProgram::Effects& effects, int mapUnit,
                        const std::shared_ptr<const TextureUnits>& units)
{
    CameraState created;
    created.units = units;
    created.set = new osg::StateSet;
    osg::StateSet* const state = created.set.get();
    for (int unit = 0; unit < FixedFunctionLook::units; ++unit)
    {
        state->addUniform(new osg::Uniform(("geofx_texture" + std::to_string(unit)).c_str(), unit));
    }
    state->addUniform(new osg::Uniform("geofx_normals", static_cast<int>(TileNormals::unit)));
    state->addUniform(new osg::Uniform("geofx_map", std::max(mapUnit, 0)));
    state->setAttribute(new ContextWatch(effects));
    return created;
}

} // namespace

/// What drawing needs and no one else sees.
struct EffectScene::Drawing
{
    /// For one cull visitor of OSG: so for one camera, and one of the frames that are on their way.
    struct Camera
    {
        osg::ref_ptr<CompensatingCullVisitor> visitor = new CompensatingCullVisitor;
        std::vector<CameraState> states; ///< one for each traversal of a frame
        std::size_t used = 0;
    };

    Drawing()
    {
        untouched->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    }

    /// The same ones as long as the list of effects and what they get stay as they are.
    std::shared_ptr<const TextureUnits> unitsOf(const EffectProgram::Effects& effects)
    {
        std::shared_ptr<const TextureUnits> changed;
        {
            const std::lock_guard<std::mutex> lock(mutex);
            std::vector<unsigned int> now(effects.size());
            std::transform(effects.begin(), effects.end(), now.begin(),
                           [](const osg::ref_ptr<Effect>& each) { return each->revision(); });
            const bool sameList = units && effects == unitEffects;
            if (sameList && now == unitRevisions) return units;
            unitRevisions = now;
            unitEffects = effects;
            changed = std::make_shared<const TextureUnits>(TextureUnits::of(effects));
            if (!sameList || changed->ofEffects != units->ofEffects || changed->complete != units->complete)
                units = changed;
            else
                changed = units;
        }
        for (const std::string& sentence : changed->sentences)
            sayOnce(sentence);
        return changed;
    }

    osg::ref_ptr<osg::Program> programFor(const EffectProgram::Effects& effects)
    {
        const std::lock_guard<std::mutex> lock(mutex);
        const bool changed = effectsChanged(effects);
        if (programMade && !changed) return program;
        const std::string key = EffectProgram::key(effects);
        if (!programMade || key != programKey)
        {
            programKey = key;
            programMade = true;
            retire(program);
            program = EffectProgram::create(effects);
            // An application's programs keep the last functions that were well; tried again when something changes.
            if (program)
                following.follow(*program);
            else
                programKey.clear();
        }
        return program;
    }

    /// Of an effect that draws the scene again.
    osg::ref_ptr<osg::Program> passProgram(const EffectProgram::Effects& effects, const PassShaders& shaders,
                                           const std::string& prefix)
    {
        const std::lock_guard<std::mutex> lock(mutex);
        std::string key = prefix + shaders.vertexMain + ';' + shaders.fragmentMain + ';';
        for (const auto* files : {&shaders.vertex, &shaders.tessellationControl,
                                  &shaders.tessellationEvaluation, &shaders.geometry, &shaders.fragment})
        {
            for (const std::string& file : *files)
                key += file + ';';
            key += '|';
        }
        for (const auto& [name, binding] : shaders.blocks)
            key += name + std::to_string(binding) + ';';
        PassProgram& found = passPrograms[key];
        const std::string effectsKey = EffectProgram::key(effects);
        if (!found.made || found.effects != effectsKey)
        {
            retire(found.program);
            found = {true, effectsKey, EffectProgram::create(effects, shaders, prefix)};
        }
        return found.program;
    }

    /// One that is in use no more; state sets of frames and of cameras that have gone may hold it for a while.
    void retire(const osg::ref_ptr<osg::Program>& former)
    {
        const auto gone = [](const osg::observer_ptr<osg::Program>& each)
        {
            return !each.valid();
        };
        retired.erase(std::remove_if(retired.begin(), retired.end(), gone), retired.end());
        if (former) retired.emplace_back(former);
    }

    /// All programs that may have GL objects.
    std::vector<osg::ref_ptr<osg::Program>> programs()
    {
        const std::lock_guard<std::mutex> lock(mutex);
        std::vector<osg::ref_ptr<osg::Program>> all = following.programs();
        if (program) all.push_back(program);
        for (const auto& [key, pass] : passPrograms)
        {
            if (pass.program) all.push_back(pass.program);
        }
        for (const osg::observer_ptr<osg::Program>& each : retired)
        {
            osg::ref_ptr<osg::Program> former;
            if (each.lock(former)) all.push_back(former);
        }
        return all;
    }

    /// Whether an effect has changed, or the list of them, since the last call.
    bool effectsChanged(const EffectProgram::Effects& effects)
    {
        bool changed = effects != lastEffects;
        lastEffects = effects;
        revisions.resize(effects.size());
        for (std::size_t i = 0; i < effects.size(); ++i)
        {
            const unsigned int revision = effects[i]->revision();
            changed = changed || revision != revisions[i];
            revisions[i] = revision;
        }
        return changed;
    }

    /// The first coordinate system below the scene; null where there is none.
    const osg::CoordinateSystemNode* systemBelow(const EffectScene& scene)
    {
        const std::lock_guard<std::mutex> lock(mutex);
        return dynamic_cast<const osg::CoordinateSystemNode*>(systems.find(scene));
    }

    /// What a terrain says of itself: that whose root the coordinate system is, else the first one below the scene. Read again
    /// only where the root has other user values than the last time.
    std::optional<TerrainInfo> terrainOf(const EffectScene& scene, const osg::CoordinateSystemNode* system)
    {
        if (!system) return std::nullopt;
        const std::lock_guard<std::mutex> lock(mutex);
        const osg::Node* root = isTerrainRoot(*system) ? system : terrains.find(scene);
        const osg::UserDataContainer* values = root ? root->getUserDataContainer() : nullptr;
        if (!values) return std::nullopt;
        if (values == terrainValues) return terrain;
        std::string error;
        const std::optional<TerrainInfo> info = TerrainInfo::read(root, error);
        if (info)
        {
            terrainValues = values;
            terrain = info;
        }
        return info;
    }

    void sayOnce(const std::string& sentence)
    {
        if (sentence.empty()) return;
        const std::lock_guard<std::mutex> lock(mutex);
        // Numbers change from frame to frame; the rest tells what it is about.
        std::string kind;
        std::copy_if(sentence.begin(), sentence.end(), std::back_inserter(kind),
                     [](char letter) { return letter < '0' || letter > '9'; });
        if (said.insert(kind).second) OSG_WARN << "osgGeoFX: " << sentence << std::endl;
    }

    /// Once for each program, whatever it is called.
    void warnOf(const CompensatingCullVisitor::Stranger& stranger)
    {
        osg::ref_ptr<const osg::StateAttribute> own;
        if (!stranger.program.lock(own)) return;
        const std::lock_guard<std::mutex> lock(mutex);
        osg::observer_ptr<const osg::StateAttribute>& known = strangers[own.get()];
        if (known.valid()) return;
        known = own.get();
        OSG_WARN
            << "osgGeoFX: " << OwnPrograms::describe(*own, stranger.path)
            << " does not call geofx_vertex(), so what it draws stays where it is, without the scene's "
               "effects. Let its vertex shader call the function (EffectScene::addFunctions), or put what "
               "it draws below an osgGeoFX::RigidReference, or leave it out with "
               "setDefine(\"GEOFX_DEFORMATION\", OFF) in its state set."
            << std::endl;
    }

    std::mutex mutex;
    PerCamera<Camera> cameras;
    std::shared_ptr<const TextureUnits> units;
    EffectProgram::Effects unitEffects; ///< those that the units were given to, and
    std::vector<unsigned int> unitRevisions;
    NodeFinder systems = NodeFinder(&isSystem, deepestSystem);
    NodeFinder terrains = NodeFinder(&isTerrainRoot, deepestTerrain);
    osg::ref_ptr<const osg::UserDataContainer> terrainValues;
    std::optional<TerrainInfo> terrain;
    /// Of a globe that has no coordinate system. Always the same: effects tell by it whether the ground has changed.
    const osg::ref_ptr<const osg::EllipsoidModel> globe = new osg::EllipsoidModel;
    EffectProgram::Effects lastEffects; ///< those that the program was made for, and
    std::vector<unsigned int> revisions;
    std::string programKey;
    bool programMade = false;
    osg::ref_ptr<osg::Program> program;
    struct PassProgram
    {
        bool made = false;
        std::string effects; ///< the key of those that it was made for
        osg::ref_ptr<osg::Program> program;
    };
    std::map<std::string, PassProgram> passPrograms;
    std::vector<osg::observer_ptr<osg::Program>> retired;
    FollowingPrograms following;
    osg::ref_ptr<osg::StateSet> untouched = new osg::StateSet;
    std::set<std::string> said;
    std::map<const osg::StateAttribute*, osg::observer_ptr<const osg::StateAttribute>> strangers;
};

EffectScene::EffectScene() : _drawing(std::make_unique<Drawing>())
{
    // What its bound becomes is known below it only.
    setCullingActive(false);
}

EffectScene::EffectScene(const EffectScene& other, const osg::CopyOp& copy)
    : osg::Group(other, copy), _effects(other._effects), _compensation(other._compensation),
      _debugBounds(other._debugBounds), _nestedCameras(other._nestedCameras),
      _terrainFrame(other._terrainFrame), _drawing(std::make_unique<Drawing>())
{
    if (copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)
    {
        for (osg::ref_ptr<Effect>& effect : _effects)
            effect = osg::clone(effect.get(), copy);
    }
}

EffectScene::~EffectScene() = default;

bool EffectScene::addEffect(Effect* effect)
{
    if (!effect || std::find(_effects.begin(), _effects.end(), effect) != _effects.end())
    {
        OSG_WARN << "osgGeoFX: EffectScene::addEffect got "
                 << (effect ? "an effect that the scene has already" : "no effect") << "; nothing changes."
                 << std::endl;
        return false;
    }
    _effects.emplace_back(effect);
    _drawing->revisions.clear();
    return true;
}

bool EffectScene::removeEffect(Effect* effect)
{
    const auto found = std::find(_effects.begin(), _effects.end(), effect);
    if (found == _effects.end()) return false;
    _effects.erase(found);
    _drawing->revisions.clear();
    return true;
}

void EffectScene::addFunctions(osg::Program& program)
{
    try
    {
        EffectProgram::addFunctions(program, _effects);
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
    }
}

Ground EffectScene::ground(const osg::NodePath& above) const
{
    const osg::CoordinateSystemNode* system = nullptr;
    for (const osg::Node* node : above)
    {
        const auto* found = dynamic_cast<const osg::CoordinateSystemNode*>(node);
        if (found) system = found;
    }
    if (!system) system = _drawing->systemBelow(*this);
    Ground ground;
    if (system && _terrainFrame != PROJECTED) ground.ellipsoid = system->getEllipsoidModel();
    if (!ground.ellipsoid && _terrainFrame == GEOCENTRIC) ground.ellipsoid = _drawing->globe;
    if (const std::optional<TerrainInfo> info = _drawing->terrainOf(*this, system))
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
    return ground;
}

namespace
{

Frames framesFor(const EffectProgram::Effects& effects, const ViewGeometry& first)
{
    ViewGeometry view = first;
    Frames frames(effects.size());
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const Deformation* deformation = effects[i]->asDeformation();
        if (!deformation || !effects[i]->getEnabled()) continue;
        const osg::ref_ptr<const DeformationFrame> frame = deformation->frame(view);
        if (!frame) continue;
        DeformationFrame::Uniforms uniforms = frame->uniforms();
        if (!finite(uniforms)) continue;
        frames[i] = {frame, std::move(uniforms)};
        deformation->changeGround(view.ground);
    }
    return frames;
}

/// Of the effects that colour surfaces; whether there are any at work.
bool fillSurfaces(const EffectProgram::Effects& effects, const TextureUnits& units, osg::StateSet& state,
                  const ViewGeometry& geometry, osgUtil::CullVisitor& outer)
{
    bool any = false;
    bool repainted = false;
    const osg::Viewport* viewport = outer.getViewport();
    const osg::FrameStamp* stamp = outer.getFrameStamp();
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        SurfaceEffect* surface = effects[i]->asSurfaceEffect();
        if (!surface) continue;
        const SurfaceView view = {geometry,
                                  *outer.getModelViewMatrix(),
                                  viewport ? viewport->x() : 0.0,
                                  viewport ? viewport->y() : 0.0,
                                  viewport ? viewport->width() : 0.0,
                                  viewport ? viewport->height() : 0.0,
                                  stamp ? stamp->getSimulationTime() : 0.0,
                                  units.ofEffects[i]};
        const bool draws = effects[i]->getEnabled() && units.complete[i] &&
                           surface->fill(state, EffectProgram::prefix(i), view);
        setDefine(state, EffectProgram::surfaceDefine(i), draws);
        any = any || draws;
        repainted = repainted || (draws && surface->repaints());
    }
    setDefine(state, "GEOFX_PAINTED", repainted);
    return any;
}

osg::ref_ptr<DeformationChain> chainOf(const Frames& frames, const Ground& ground)
{
    osg::ref_ptr<DeformationChain> chain = new DeformationChain;
    chain->setTiles(ground.tileEdge, ground.tileError);
    for (const Placed& placed : frames)
    {
        if (placed.frame) chain->add(placed.frame);
    }
    return chain;
}

bool drawsPasses(const EffectProgram::Effects& effects)
{
    return std::any_of(effects.begin(), effects.end(),
                       [](const auto& each) { return each->getEnabled() && each->asPassEffect(); });
}

/// Whether there are enabled effects that move geometry, be it for this camera or for others.
bool deforms(const EffectProgram::Effects& effects)
{
    return std::any_of(effects.begin(), effects.end(),
                       [](const auto& each) { return each->getEnabled() && each->asDeformation(); });
}

int mapUnitOf(const EffectProgram::Effects& effects)
{
    for (const auto& effect : effects)
    {
        const Deformation* deformation = effect->asDeformation();
        if (deformation && effect->getEnabled() && deformation->mapUnit() >= 0) return deformation->mapUnit();
    }
    return -1;
}

} // namespace

osg::ref_ptr<const DeformationChain> EffectScene::deformation(const osg::Matrixd& modelView,
                                                              const osg::Matrixd& projection,
                                                              const osg::NodePath& above) const
{
    const Ground known = ground(above);
    return chainOf(framesFor(_effects, ViewGeometry(modelView, projection, known)), known);
}

namespace
{

/** Whether it is not the view's own camera that is being culled for.

    OSG never puts the view's camera, or a slave's, on the node path, and the stage that culling begins with is that
    camera's. Parents tell nothing: the cameras of osgShadow and of other techniques have none, and a slave of a view may
    have some. */
bool isNested(osgUtil::CullVisitor& outer)
{
    const osg::NodePath& path = outer.getNodePath();
    return outer.getCurrentCamera() != outer.getRenderStage()->getCamera() ||
           std::any_of(path.begin(), path.end(), [](osg::Node* node) { return node->asCamera() != nullptr; });
}

} // namespace

bool EffectScene::cull(osgUtil::CullVisitor& outer)
{
    const bool wanted =
        std::any_of(_effects.begin(), _effects.end(), [](const auto& each) { return each->getEnabled(); });
    if (!wanted || dynamic_cast<CompensatingCullVisitor*>(&outer)) return false;
    if (!outer.getRenderStage() || !outer.getCurrentCamera()) return false;
    const osg::NodePath& path = outer.getNodePath();
    if (!_nestedCameras && isNested(outer)) return false;

    const ViewGeometry view(*outer.getModelViewMatrix(), *outer.getProjectionMatrix(), ground(path));
    const Frames frames = framesFor(_effects, view);
    CompensatingCullVisitor::Task task;
    task.chain = chainOf(frames, view.ground);
    task.mapUnit = mapUnitOf(_effects);
    Drawing::Camera& own = _drawing->cameras.of(outer);
    if (own.visitor->startsFrame(outer)) own.used = 0;
    const std::shared_ptr<const TextureUnits> units = _drawing->unitsOf(_effects);
    if (own.used == own.states.size()) own.states.emplace_back();
    // Made anew for other effects, which would find the uniforms and textures of the former ones under their names.
    if (own.states[own.used].units != units)
        own.states[own.used] = createState(_effects, task.mapUnit, units);
    osg::StateSet& state = *own.states[own.used].set;
    state.getOrCreateUniform("geofx_map", osg::Uniform::INT)->set(std::max(task.mapUnit, 0));
    fill(own.states[own.used], frames);
    const bool surfaces = fillSurfaces(_effects, *units, state, view, outer);
    // Where no effect moves anything, OSG's own tests are right, and faster. Where one does so for other cameras, ours go
    // on for this one: they let fewer tiles through, and what is drawn is not to jump as the bend comes to its end.
    const bool draws = surfaces || _debugBounds || !task.chain->empty();
    const bool passes = drawsPasses(_effects);
    task.compensate = _compensation && (_debugBounds || deforms(_effects));
    if (!draws && !task.compensate && !passes) return false;

    ++own.used;
    if (draws || task.compensate)
    {
        task.untouched = _drawing->untouched;
        if (draws)
        {
            task.program = _drawing->programFor(_effects);
            task.following = &_drawing->following;
            task.state = &state;
            forPasses(outer, view, *task.chain, state, task.mapUnit, *units,
                      [&](PassEffect& effect, const ScenePass& pass)
                      {
                          DrawableCompanion* companion = effect.companion(pass);
                          if (companion) task.companions.push_back(companion);
                      });
        }
        task.debugBounds = _debugBounds;
        task.tileError = view.ground.tileError;
        own.visitor->run(outer, *this, task);
        _drawing->sayOnce(own.visitor->complaint());
        for (const auto& stranger : own.visitor->strangers())
            _drawing->warnOf(stranger);
    }
    else
    {
        osg::Group::traverse(outer);
    }
    if (passes)
    {
        forPasses(outer, view, *task.chain, state, task.mapUnit, *units,
                  [](PassEffect& effect, const ScenePass& pass) { effect.cull(pass); });
    }
    return true;
}

void EffectScene::forPasses(osgUtil::CullVisitor& outer, const ViewGeometry& view,
                            const DeformationChain& chain, osg::StateSet& state, int mapUnit,
                            const TextureUnits& units,
                            const std::function<void(PassEffect&, const ScenePass&)>& action)
{
    class Pass : public ScenePass
    {
    public:
        Pass(EffectScene& group, osgUtil::CullVisitor& visitor, const ViewGeometry& geometry,
             const DeformationChain& deformations, osg::StateSet& stateSet, const std::string& names,
             int unit, const std::vector<int>& textureUnits)
            : ScenePass(visitor, group, geometry, deformations, stateSet, *group._drawing->untouched,
                        group._drawing->following, names, geometry.ground.tileError, unit,
                        group._compensation, textureUnits),
              _group(group)
        {
        }
        osg::ref_ptr<osg::Program> program(const PassShaders& shaders) const override
        {
            return _group._drawing->passProgram(_group._effects, shaders, prefix);
        }
        osg::ref_ptr<osg::Program> sceneProgram() const override
        {
            return _group._drawing->programFor(_group._effects);
        }

    private:
        EffectScene& _group;
    };
    for (std::size_t i = 0; i < _effects.size(); ++i)
    {
        PassEffect* effect = _effects[i]->asPassEffect();
        if (!effect || !_effects[i]->getEnabled() || !units.complete[i]) continue;
        const std::string prefix = EffectProgram::prefix(i);
        action(*effect, Pass(*this, outer, view, chain, state, prefix, mapUnit, units.ofEffects[i]));
    }
}

void EffectScene::listenTo(TileGuard& guard)
{
    for (const osg::ref_ptr<Effect>& effect : _effects)
    {
        PassEffect* pass = effect->asPassEffect();
        const osg::ref_ptr<TileListener> listener = pass ? pass->tileListener(ground()) : nullptr;
        if (listener) guard.addListener(listener);
    }
}

void EffectScene::traverse(osg::NodeVisitor& visitor)
{
    osgUtil::CullVisitor* culling = visitor.asCullVisitor();
    if (culling && cull(*culling)) return;
    osg::Group::traverse(visitor);
}

void EffectScene::resizeGLObjectBuffers(unsigned int size)
{
    for (const osg::ref_ptr<osg::Program>& program : _drawing->programs())
        program->resizeGLObjectBuffers(size);
    for (const osg::ref_ptr<Effect>& effect : _effects)
        effect->resizeGLObjectBuffers(size);
    osg::Group::resizeGLObjectBuffers(size);
}

void EffectScene::releaseGLObjects(osg::State* state) const
{
    for (const osg::ref_ptr<osg::Program>& program : _drawing->programs())
        program->releaseGLObjects(state);
    for (const osg::ref_ptr<Effect>& effect : _effects)
    {
        effect->releaseGLObjects(state);
    }
    osg::Group::releaseGLObjects(state);
}

} // namespace osgGeoFX
