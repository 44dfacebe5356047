// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/SceneDrawing.h>

#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/Tessellation.h>
#include <osgGeoFX/effect/detail/AssemblyProgram.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/TilePrefetch.h>
#include <osgGeoFX/scene/detail/AdaptedPrograms.h>
#include <osgGeoFX/scene/detail/CameraRoles.h>
#include <osgGeoFX/scene/detail/DividedTriangles.h>
#include <osgGeoFX/scene/detail/GlobeHorizon.h>
#include <osgGeoFX/scene/detail/GpuLimits.h>
#include <osgGeoFX/scene/detail/NearestFirst.h>
#include <osgGeoFX/scene/detail/TargetFormat.h>

#include <osg/Notify>

#include <algorithm>
#include <iterator>
#include <optional>

namespace osgGeoFX
{

namespace
{

bool drawsPasses(const SceneDrawing::Effects& effects)
{
    return std::any_of(effects.begin(), effects.end(),
                       [](const auto& each) { return each->isActive() && each->asPassEffect(); });
}

/// Whether there are enabled effects that move geometry, be it for this camera or for others.
bool deforms(const SceneDrawing::Effects& effects)
{
    return std::any_of(effects.begin(), effects.end(),
                       [](const auto& each) { return each->isActive() && each->asDeformation(); });
}

int mapUnitOf(const SceneDrawing::Effects& effects)
{
    for (const auto& effect : effects)
    {
        const Deformation* deformation = effect->asDeformation();
        if (deformation && effect->isActive() && deformation->mapUnit() >= 0) return deformation->mapUnit();
    }
    return -1;
}

/// Whether the one whose map is shown has nothing else to show, such as a map of what tiles say of the ground.
bool needsMap(const SceneDrawing::Effects& effects)
{
    for (const auto& effect : effects)
    {
        const Deformation* deformation = effect->asDeformation();
        if (deformation && effect->isActive() && deformation->mapUnit() >= 0)
            return effect->getProperty("coverMap") == 0.0;
    }
    return false;
}

bool lookAtNormals(const SceneDrawing::Effects& effects)
{
    return std::any_of(effects.begin(), effects.end(),
                       [](const auto& each)
                       {
                           const SurfaceEffect* surface = each->asSurfaceEffect();
                           return each->isActive() && surface && surface->looksAtNormals();
                       });
}

/// Tells those that divide triangles what the camera's context can do.
void tellContext(const SceneDrawing::Effects& effects, osgUtil::CullVisitor& outer)
{
    for (const auto& each : effects)
    {
        const auto* tessellator = dynamic_cast<const Tessellator*>(each.get());
        if (tessellator && tessellator->wantsTessellation())
            tessellator->meetContext(GpuLimits::of(outer).version);
    }
}

/// In their own frame, whatever the node does.
osg::BoundingSphere boundOfChildren(const osg::Group& node)
{
    osg::BoundingSphere all;
    for (unsigned int i = 0; i < node.getNumChildren(); ++i)
        all.expandBy(node.getChild(i)->getBound());
    return all;
}

/// Empty where the camera shows the scene without effects.
std::optional<CameraRole> roleOf(const EffectScene& scene, osgUtil::CullVisitor& outer,
                                 const CameraEffects* own)
{
    CameraRole role = defaultRole(outer);
    if (scene.getNestedCameras() && role.getKind() == CameraRole::UNDEFORMED) role = CameraRole::view();
    const osg::Camera& camera = *outer.getCurrentCamera();
    if (own && own->getRole()) role = *own->getRole();
    if (const CameraRoleCallback* callback = scene.getRoleCallback())
        role = callback->role(camera, outer, role);
    if (role.getKind() == CameraRole::UNDEFORMED) return std::nullopt;
    return role;
}

} // namespace

/// One traversal of one camera.
class SceneDrawing::Traversal
{
public:
    /// `listed`: the effects of the scene; `effects`: what the camera draws in their places; `needing`: those that the programs
    /// are made for.
    Traversal(SceneDrawing& drawing, EffectScene& scene, const Effects& listed, const Effects& effects,
              ProgramCache& programs, const Effects& needing, osgUtil::CullVisitor& outer,
              const ViewGeometry& view, const CameraDepth& depth, const osg::Group& top,
              const Traverse& traverse)
        : _drawing(drawing), _scene(scene), _effects(effects), _programs(programs), _needing(needing),
          _work(effects), _outer(outer), _view(view), _depth(depth), _top(top), _bound(boundOfChildren(top)),
          _traverse(traverse), _units(drawing.unitsOf(listed, scene))
    {
    }

    bool run();

private:
    using Task = CompensatingCullVisitor::Task;

    Task taskOf(const osg::ref_ptr<const DeformationChain>& chain, int mapUnit) const;
    std::vector<CameraPass::Drawer> drawers() const;
    /// Culls with the visitor of the kit.
    void drawScene(Camera& own, Task task, const CameraPass::Traversal& passes, bool draws,
                   bool surfaces) const;
    /// Whether something that was drawn has the map that an effect shows.
    void lookForMap(const CompensatingCullVisitor& visitor, const Task& task) const;
    /// Where engines cull by what the deformed picture shows, osgEarth clips by it, too.
    void setHorizonPlane(CameraState& state, const Task& task) const;

    SceneDrawing& _drawing;
    EffectScene& _scene;
    const Effects& _effects;
    ProgramCache& _programs;
    const Effects& _needing;
    const EffectsAtWork _work;
    osgUtil::CullVisitor& _outer;
    const ViewGeometry& _view;
    const CameraDepth& _depth;
    const osg::Group& _top;
    const osg::BoundingSphere _bound; ///< of the terrain's children, in their frame
    const Traverse& _traverse;
    const std::shared_ptr<const TextureUnits> _units;
};

SceneDrawing::SceneDrawing()
{
    _untouched->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    _inPass->setDefine("GEOFX_IN_PASS");
}

void SceneDrawing::dirty()
{
    programs.dirty();
    const std::lock_guard<std::mutex> lock(_mutex);
    _otherPrograms.clear();
}

SceneDrawing::Effects SceneDrawing::effectsFor(const Effects& effects, const CameraEffects& camera)
{
    misuse.look(camera);
    Effects result = effects;
    for (osg::ref_ptr<Effect>& effect : result)
    {
        const osg::ref_ptr<Effect> other = camera.effectFor(*effect);
        // One that is off is not drawn, whatever it needs.
        if (other->isActive() && !CameraEffects::mayReplace(*effect, *other))
        {
            misuse.say(Misuse::OTHER_UNITS,
                       "the " + std::string(other->className()) +
                           " that a camera's CameraEffects draw in the place of another one has come to need "
                           "other texture units than that one, which is drawn itself. Give both the same.");
            continue;
        }
        effect = other;
    }
    return result;
}

std::shared_ptr<ProgramCache> SceneDrawing::otherPrograms(const EffectScene& scene, const Effects& effects,
                                                          const Effects& shown, Effects& needing)
{
    needing = effects;
    for (std::size_t i = 0; i < effects.size(); ++i)
        if (shown[i]->isActive()) needing[i] = shown[i];
    if (needing == effects) return nullptr;
    const std::string key = EffectProgram::key(needing);
    if (key == EffectProgram::key(effects)) return nullptr;
    if (scene.getShaderHost())
    {
        misuse.say(
            Misuse::NO_OTHER_SHADERS,
            "a camera's CameraEffects draw effects that need other shaders than the scene's, but an "
            "engine has one text for all cameras (EffectScene::setShaderHost), so they have the styles "
            "of the scene's effects. Give both the same curve and the same kinds of styles.");
        return nullptr;
    }
    const std::lock_guard<std::mutex> lock(_mutex);
    constexpr std::size_t most = 8;
    // Programs that frames on their way are drawn with are held by these.
    for (auto each = _otherPrograms.begin(); each != _otherPrograms.end() && _otherPrograms.size() >= most;)
        each =
            each->second.use_count() > 1 || each->first == key ? std::next(each) : _otherPrograms.erase(each);
    std::shared_ptr<ProgramCache>& found = _otherPrograms[key];
    if (!found) found = std::make_shared<ProgramCache>();
    return found;
}

std::vector<osg::ref_ptr<osg::Program>> SceneDrawing::allPrograms()
{
    std::vector<osg::ref_ptr<osg::Program>> all = programs.all();
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& [key, other] : _otherPrograms)
        for (const osg::ref_ptr<osg::Program>& program : other->all())
            all.push_back(program);
    return all;
}

/// The same ones as long as the list of effects and what they get stay as they are.
std::shared_ptr<const TextureUnits> SceneDrawing::unitsOf(const Effects& effects, const EffectScene& scene)
{
    const int lowest = scene.getFirstTextureUnit(), lowestBlock = scene.getFirstBlockBinding();
    const TextureUnits::Units& choice = scene.getTextureUnits();
    std::shared_ptr<const TextureUnits> changed;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        std::vector<unsigned int> now(effects.size());
        std::transform(effects.begin(), effects.end(), now.begin(),
                       [](const osg::ref_ptr<Effect>& each) { return each->revision(); });
        const bool sameList = _units && effects == _unitEffects && lowest == _lowestUnit &&
                              lowestBlock == _lowestBlock && choice == _choice;
        if (sameList && now == _unitRevisions) return _units;
        _unitRevisions = now;
        _unitEffects = effects;
        _lowestUnit = lowest;
        _lowestBlock = lowestBlock;
        _choice = choice;
        changed = std::make_shared<const TextureUnits>(choice.empty()
                                                           ? TextureUnits::of(effects, lowest, lowestBlock)
                                                           : TextureUnits::of(effects, choice, lowestBlock));
        if (!sameList || changed->ofEffects != _units->ofEffects || changed->ofBlocks != _units->ofBlocks ||
            changed->complete != _units->complete)
            _units = changed;
        else
            changed = _units;
    }
    for (const std::string& sentence : changed->sentences)
        sayOnce(sentence);
    return changed;
}

void SceneDrawing::sayOnce(const std::string& sentence)
{
    if (sentence.empty()) return;
    const std::lock_guard<std::mutex> lock(_mutex);
    // Numbers change from frame to frame; the rest tells what it is about.
    std::string kind;
    std::copy_if(sentence.begin(), sentence.end(), std::back_inserter(kind),
                 [](char letter) { return letter < '0' || letter > '9'; });
    if (_said.insert(kind).second) OSG_WARN << "osgGeoFX: " << sentence << std::endl;
}

/// Once for all programs with equal texts, whatever they are called.
void SceneDrawing::warnOf(const CompensatingCullVisitor::Stranger& stranger)
{
    osg::ref_ptr<const osg::StateAttribute> own;
    if (!stranger.program.lock(own)) return;
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::observer_ptr<const osg::StateAttribute>& known = _strangers[own.get()];
    if (known.valid()) return;
    known = own.get();
    if (_strangers.size() > _strangersPurgeSize)
    {
        for (auto each = _strangers.begin(); each != _strangers.end();)
            each = each->second.valid() ? std::next(each) : _strangers.erase(each);
        _strangersPurgeSize = 2 * _strangers.size() + 64;
    }
    const auto* program = dynamic_cast<const osg::Program*>(own.get());
    const bool assembly = AssemblyProgram::is(*own);
    if ((program || assembly) && !_strangerNumbers.insert(OwnPrograms::numberOf(*own)).second) return;
    const auto adaptation = program ? AdaptedPrograms::instance().of(*program) : nullptr;
    const std::string why =
        adaptation ? " cannot be adapted, since " + adaptation->refusal() : " does not call geofx_vertex()";
    OSG_WARN << "osgGeoFX: " << OwnPrograms::describe(*own, stranger.path)
             << (assembly ? " is in assembly language" : why)
             << ", so what it draws stays where it is, without the scene's effects. "
             << (program && !adaptation ? "Let the kit adapt it (EffectScene::adapt), or let"
                 : assembly             ? "Write it in GLSL, and let"
                                        : "Let")
             << " its vertex shader call geofx_vertex() (EffectScene::addFunctions), or put what it draws "
                "below an "
                "osgGeoFX::RigidReference, or leave it out with setDefine(\"GEOFX_DEFORMATION\", OFF) in its "
                "state set."
             << std::endl;
}

void SceneDrawing::forgetEffects()
{
    programs.forgetEffects();
    // Let go of when the lock is.
    Effects former;
    const std::lock_guard<std::mutex> lock(_mutex);
    _otherPrograms.clear();
    _units = nullptr;
    former.swap(_unitEffects);
    // What is on its way to the screen keeps its state sets.
    _cameras.each([](Camera& camera) { camera.forgetStates(); });
}

void SceneDrawing::resizeGLObjectBuffers(unsigned int size)
{
    for (const osg::ref_ptr<osg::Program>& program : allPrograms())
        program->resizeGLObjectBuffers(size);
    _cameras.resizeGLObjectBuffers(size);
}

void SceneDrawing::releaseGLObjects(osg::State* state)
{
    for (const osg::ref_ptr<osg::Program>& program : allPrograms())
        program->releaseGLObjects(state);
    _cameras.releaseGLObjects(state);
}

void SceneDrawing::Camera::startFrame(osgUtil::CullVisitor& outer)
{
    used = 0;
    passes.startFrame(outer);
}

CameraState& SceneDrawing::Camera::nextState(const Effects& effects, int mapUnit,
                                             const std::shared_ptr<const TextureUnits>& units)
{
    if (used == states.size()) states.emplace_back();
    std::unique_ptr<CameraState>& state = states[used];
    // Made anew for other effects, which would find the uniforms and textures of the former ones under their names.
    if (!state || state->units() != units) state = std::make_unique<CameraState>(effects, mapUnit, units);
    return *state;
}

CompensatingCullVisitor::Task
SceneDrawing::Traversal::taskOf(const osg::ref_ptr<const DeformationChain>& chain, int mapUnit) const
{
    Task task;
    task.traverse = _traverse;
    task.chain = chain;
    task.mapUnit = mapUnit;
    task.view = &_view;
    task.depth = _depth;
    task.colorFormat = targetFormat(_outer);
    if (!_view.image.ofView) task.image = &_view.image;
    task.untouched = _drawing._untouched;
    task.normals = lookAtNormals(_effects);
    task.adapts = _scene.getAdaptsPrograms();
    task.tileError = _view.ground.tileError;
    task.engines = _scene.getEngineCulling() != EffectScene::AS_IT_IS && _scene.getCompensation();
    task.open = task.engines && !chain->empty();
    task.proxy = task.engines && _scene.getEngineCulling() == EffectScene::PROXY;
    if (!_scene.getLayoutBins().empty()) task.layoutBins = &_scene.getLayoutBins();
    task.engineTerrain = _scene.getEngineTerrain();
    task.bound = _bound;
    task.ground = &_drawing.ground;
    task.terrain = &_top;
    // Where no effect moves anything, OSG's own tests are right, and faster. Where one does so for other cameras, ours go
    // on for this one: they let fewer tiles through, and what is drawn is not to jump as the bend comes to its end.
    task.compensate = _scene.getCompensation() && (_scene.getDebugBounds() || deforms(_effects));
    return task;
}

/// Those that draw passes for this camera, in the scene's order.
std::vector<CameraPass::Drawer> SceneDrawing::Traversal::drawers() const
{
    std::vector<CameraPass::Drawer> result;
    for (std::size_t i = 0; i < _effects.size(); ++i)
    {
        PassEffect* effect = _effects[i]->asPassEffect();
        if (!effect || !_work[i] || !_units->complete[i]) continue;
        result.push_back({effect, EffectProgram::prefix(i), _units->ofEffects[i], _units->ofBlocks[i]});
    }
    return result;
}

void SceneDrawing::Traversal::drawScene(Camera& own, Task task, const CameraPass::Traversal& passes,
                                        bool draws, bool surfaces) const
{
    FollowingPrograms& following = _programs.following();
    osg::ref_ptr<osg::StateSet> hostAddition;
    osg::ref_ptr<osg::Program> tessellating;
    if (draws)
    {
        task.program = _programs.programOf(_needing);
        if (task.program && DividedTriangles::wanted(*task.chain))
        {
            tessellating = _programs.tessellatingProgramOf(_needing);
            task.tessellating = tessellating;
        }
        task.following = &following;
        if (ShaderHost* host = _scene.getShaderHost())
        {
            hostAddition = _programs.tell(*host, _needing);
            task.shaderHost = host;
            task.hostAddition = hostAddition;
        }
        task.state = passes.task.state;
        for (const CameraPass::Drawer& drawer : passes.drawers)
        {
            DrawableCompanion* companion = drawer.effect->companion(CameraPass(passes, drawer));
            if (companion) task.companions.push_back(companion);
        }
    }
    task.debugBounds = _scene.getDebugBounds();
    own.visitor->run(_outer, task);
    _drawing.sayOnce(own.visitor->complaint());
    for (const auto& stranger : own.visitor->strangers())
        _drawing.warnOf(stranger);
    for (const std::string& sentence : following.takeComplaints(surfaces))
        _drawing.sayOnce(sentence);
    if (draws && task.mapUnit >= 0) lookForMap(*own.visitor, task);
}

void SceneDrawing::Traversal::lookForMap(const CompensatingCullVisitor& visitor, const Task& task) const
{
    Misuse& misuse = _drawing.misuse;
    if (misuse.said(Misuse::MAP_MISSING) || task.chain->empty() || !needsMap(_effects)) return;
    if (visitor.metMap())
        misuse.dismiss(Misuse::MAP_MISSING);
    else if (misuse.lasts(Misuse::MAP_MISSING, visitor.metNoMap()))
        misuse.say(Misuse::MAP_MISSING, "nothing that is drawn has a texture on unit " +
                                            std::to_string(task.mapUnit) +
                                            ", which `mapUnit` names for a map. Put the map there, or name "
                                            "the unit that has it.");
}

void SceneDrawing::Traversal::setHorizonPlane(CameraState& state, const Task& task) const
{
    if (!task.open)
    {
        state.setHorizonPlane(nullptr);
        return;
    }
    const osg::Vec3d eye = task.image ? osg::Vec3d() * task.image->toView : osg::Vec3d();
    const std::optional<osg::Vec4d> plane = GlobeHorizon(*task.chain, _view, eye).plane();
    // Clips nothing.
    osg::Vec4d inWorld(0.0, 0.0, 0.0, 1.0);
    if (plane)
    {
        const osg::Matrixd& toEye = _outer.getCurrentCamera()->getViewMatrix();
        inWorld = (task.image ? toEye * task.image->toView : toEye) * *plane;
    }
    state.setHorizonPlane(&inWorld);
}

bool SceneDrawing::Traversal::run()
{
    _drawing.sayOnce(_work.sentence());
    const CameraSnapshots snapshots(_effects, _work, _view);
    const int mapUnit = mapUnitOf(_effects);
    Camera& own = _drawing._cameras.of(_outer);
    if (own.visitor->startsFrame(_outer)) own.startFrame(_outer);
    CameraState& state = own.nextState(_effects, mapUnit, _units);
    state.fill(snapshots, _view, _depth, mapUnit);
    state.setBright(holdsBrightColors(targetFormat(_outer)));
    const bool surfaces = state.fillSurfaces(_effects, _work, _view, _outer);

    const Task task = taskOf(snapshots.chain(_view.ground), mapUnit);
    setHorizonPlane(state, task);
    // What has no shader writes no logarithmic depth by itself.
    const bool draws = surfaces || _scene.getDebugBounds() || !task.chain->empty() || _depth.logarithmic();
    const bool culls = draws || task.compensate;
    if (!culls && !drawsPasses(_effects)) return false;

    ++own.used;
    Task passTask = task;
    passTask.state = &state.set();
    passTask.inPass = _drawing._inPass;
    passTask.following = &_programs.following();
    passTask.compensate = _scene.getCompensation();
    const CameraPass::Traversal passes = {
        _outer, _scene, _view, passTask, own.passes, _programs, _needing, _scene.getShaderHost(), drawers()};
    if (culls)
        drawScene(own, task, passes, draws, surfaces);
    else
        _traverse(_outer);
    for (const CameraPass::Drawer& drawer : passes.drawers)
        drawer.effect->cull(CameraPass(passes, drawer));
    return true;
}

void SceneDrawing::computeBoundsBelow(const osg::Group& top)
{
    for (unsigned int i = 0; i < top.getNumChildren(); ++i)
    {
        const osg::Node& child = *top.getChild(i);
        child.getBound();
        if (const osg::Group* inner = child.asGroup()) computeBoundsBelow(*inner);
    }
}

void SceneDrawing::completeBounds(const EffectScene& scene, const osg::Group& top,
                                  const osg::FrameStamp* stamp)
{
    // Two threads may be about to cull what a pager has brought, here or in another scene.
    static std::mutex mutex;
    const std::lock_guard<std::mutex> lock(mutex);
    // A scene's own bound is computed with all of those below it. Another node's does not tell whether they are known.
    if (&top != &scene && (!stamp || _boundsFrame != stamp->getFrameNumber()))
    {
        computeBoundsBelow(top);
        if (stamp) _boundsFrame = stamp->getFrameNumber();
    }
    top.getBound();
}

bool SceneDrawing::cull(EffectScene& scene, const Effects& effects, osgUtil::CullVisitor& outer,
                        osg::Group& top, const Traverse& traverse)
{
    if (dynamic_cast<CompensatingCullVisitor*>(&outer))
    {
        if (!misuse.said(Misuse::SCENE_IN_SCENE) && !effects.empty())
            misuse.say(Misuse::SCENE_IN_SCENE,
                       "a scene with effects stands below another one, and is drawn with the effects of the "
                       "outer one alone. Add its effects to that one.");
        return false;
    }
    if (!outer.getRenderStage() || !outer.getCurrentCamera()) return false;
    misuse.meet(top, outer.getFrameStamp());
    NearestFirst order(*outer.getCurrentRenderBin());
    const bool orthographic = (*outer.getProjectionMatrix())(3, 3) != 0.0;
    if (orthographic && (outer.getCullingMode() & osg::CullSettings::CLUSTER_CULLING))
    {
        // Tiles that know their horizon ask for the eye, and an orthographic picture is seen from nowhere. All settings
        // are kept, since a change of one tells OSG to take it from the camera no longer.
        const osg::CullSettings former(outer);
        outer.setCullingMode(outer.getCullingMode() & ~osg::CullSettings::CLUSTER_CULLING);
        if (!cullWithEffects(scene, effects, outer, top, traverse)) traverse(outer);
        outer.setCullSettings(former);
    }
    else if (!cullWithEffects(scene, effects, outer, top, traverse))
        traverse(outer);
    order.sort();
    return true;
}

bool SceneDrawing::cullWithEffects(EffectScene& scene, const Effects& effects, osgUtil::CullVisitor& outer,
                                   osg::Group& top, const Traverse& traverse)
{
    const CameraEffects* const special = CameraEffects::find(*outer.getCurrentCamera());
    const Effects shown = special ? effectsFor(effects, *special) : effects;
    const CameraDepth depth(special && special->getDepthConvention() ? *special->getDepthConvention()
                                                                     : scene.getDepthConvention(),
                            *outer.getProjectionMatrix());
    const bool wanted =
        depth.logarithmic() || scene.getDebugBounds() ||
        std::any_of(shown.begin(), shown.end(), [](const auto& each) { return each->isActive(); });
    const std::optional<CameraRole> role = wanted ? roleOf(scene, outer, special) : std::nullopt;
    TilePrefetch* const prefetch = scene.getPrefetch();
    if (!role)
    {
        const ViewGeometry plain(*outer.getModelViewMatrix(), *outer.getProjectionMatrix(), Ground());
        if (prefetch) prefetch->note(outer, top, plain, {}, false);
        return false;
    }
    if (scene.getCompensation()) completeBounds(scene, top, outer.getFrameStamp());
    tellContext(shown, outer);
    const ViewGeometry view = viewOf(outer, *role, ground.find(scene, top, outer.getNodePath()));
    if (prefetch) prefetch->note(outer, top, view, shown, scene.getCompensation() && deforms(shown));
    misuse.look(scene, outer, view, top);
    Effects needing;
    const std::shared_ptr<ProgramCache> other =
        special ? otherPrograms(scene, effects, shown, needing) : nullptr;
    return Traversal(*this, scene, effects, shown, other ? *other : programs, other ? needing : effects,
                     outer, view, depth, top, traverse)
        .run();
}

osg::Matrixd SceneDrawing::turnOfHorizon(EffectScene& scene, const Effects& effects,
                                         osgUtil::CullVisitor& outer)
{
    if (!outer.getRenderStage() || !outer.getCurrentCamera() || !deforms(effects)) return {};
    const CameraEffects* const special = CameraEffects::find(*outer.getCurrentCamera());
    const Effects shown = special ? effectsFor(effects, *special) : effects;
    const std::optional<CameraRole> role = roleOf(scene, outer, special);
    if (!role) return {};
    const Ground known = ground.find(scene, *scene.getTerrain(), outer.getNodePath());
    const ViewGeometry view = viewOf(outer, *role, known);
    // Bends point there, too.
    osg::Vec3d ahead = view.up ^ osg::X_AXIS;
    if (!(ahead.normalize() > 0.0)) return {};
    // Behind the transition zone, which lies within the picture.
    osg::Vec3d at = ahead * std::max(1e6, 1e3 * view.eyeHeight);
    osg::Matrixd turn;
    const CameraSnapshots snapshots(shown, EffectsAtWork(shown), view);
    for (const CameraSnapshots::Placed& placed : snapshots.all())
    {
        if (!placed.snapshot) continue;
        if (placed.snapshot->reach({at, 0.0}) == DeformationSnapshot::Reach::Affine)
            turn.postMult(placed.snapshot->turn(at));
        at = placed.snapshot->deform(at);
    }
    if (osg::Matrixd::transform3x3(ahead, turn) * view.up > -1e-9) return {};
    if (!view.image.ofView) turn = view.image.toView * turn * view.image.toEye;
    // The eye keeps its height: a bend may put it into the plane of the far ground, where the sea has no depth.
    turn.setTrans(osg::Vec3d());
    return turn;
}

} // namespace osgGeoFX
