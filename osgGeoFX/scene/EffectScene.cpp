// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/EffectScene.h>

#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/detail/AdaptedPrograms.h>
#include <osgGeoFX/scene/detail/CameraPasses.h>
#include <osgGeoFX/scene/detail/CameraRoles.h>
#include <osgGeoFX/scene/detail/CameraState.h>
#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>
#include <osgGeoFX/scene/detail/GroundFinder.h>
#include <osgGeoFX/scene/detail/ProgramCache.h>

#include <osg/Notify>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

namespace osgGeoFX
{

namespace
{

/// Of all nodes below one, whatever is known of those above them: a node with a bound of its own says nothing of its children.
void computeBounds(const osg::Group& group)
{
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
    {
        const osg::Node& child = *group.getChild(i);
        child.getBound();
        if (const osg::Group* inner = child.asGroup()) computeBounds(*inner);
    }
}

} // namespace

/// What drawing needs and no one else sees.
struct EffectScene::Drawing
{
    /// For one cull visitor of OSG: so for one camera, and one of the frames that are on their way.
    struct Camera
    {
        osg::ref_ptr<CompensatingCullVisitor> visitor = new CompensatingCullVisitor;
        CameraPasses passes;
        std::vector<std::unique_ptr<CameraState>> states; ///< one for each traversal of a frame
        std::size_t used = 0;
    };

    Drawing()
    {
        untouched->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    }

    /// The same ones as long as the list of effects and what they get stay as they are.
    std::shared_ptr<const TextureUnits> unitsOf(const EffectProgram::Effects& effects, int lowest)
    {
        std::shared_ptr<const TextureUnits> changed;
        {
            const std::lock_guard<std::mutex> lock(mutex);
            std::vector<unsigned int> now(effects.size());
            std::transform(effects.begin(), effects.end(), now.begin(),
                           [](const osg::ref_ptr<Effect>& each) { return each->revision(); });
            const bool sameList = units && effects == unitEffects && lowest == lowestUnit;
            if (sameList && now == unitRevisions) return units;
            unitRevisions = now;
            unitEffects = effects;
            lowestUnit = lowest;
            changed = std::make_shared<const TextureUnits>(TextureUnits::of(effects, lowest));
            if (!sameList || changed->ofEffects != units->ofEffects || changed->complete != units->complete)
                units = changed;
            else
                changed = units;
        }
        for (const std::string& sentence : changed->sentences)
            sayOnce(sentence);
        return changed;
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
        const auto* program = dynamic_cast<const osg::Program*>(own.get());
        const auto adaptation = program ? AdaptedPrograms::instance().of(*program) : nullptr;
        const std::string why = adaptation ? " cannot be adapted, since " + adaptation->refusal()
                                           : " does not call geofx_vertex()";
        OSG_WARN
            << "osgGeoFX: " << OwnPrograms::describe(*own, stranger.path) << why
            << ", so what it draws stays where it is, without the scene's effects. "
            << (program && !adaptation ? "Let the kit adapt it (EffectScene::adapt), or let" : "Let")
            << " its vertex shader call geofx_vertex() (EffectScene::addFunctions), or put what it draws "
               "below an "
               "osgGeoFX::RigidReference, or leave it out with setDefine(\"GEOFX_DEFORMATION\", OFF) in its "
               "state set."
            << std::endl;
    }

    std::mutex mutex;
    PerCamera<Camera> cameras;
    std::shared_ptr<const TextureUnits> units;
    int lowestUnit = TextureUnits::first;
    EffectProgram::Effects unitEffects; ///< those that the units were given to, and
    std::vector<unsigned int> unitRevisions;
    GroundFinder ground;
    ProgramCache programs;
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
      _firstTextureUnit(other._firstTextureUnit), _roleCallback(other._roleCallback),
      _groundDescription(other._groundDescription), _engineCulling(other._engineCulling),
      _drawing(std::make_unique<Drawing>())
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
    _drawing->programs.dirty();
    return true;
}

bool EffectScene::removeEffect(Effect* effect)
{
    const auto found = std::find(_effects.begin(), _effects.end(), effect);
    if (found == _effects.end()) return false;
    _effects.erase(found);
    _drawing->programs.dirty();
    return true;
}

void EffectScene::addFunctions(osg::Program& program)
{
    try
    {
        EffectProgram::addFunctions(program, EffectProgram::Effects());
    }
    catch (const ShaderError& error)
    {
        OSG_WARN << "osgGeoFX: " << error.what() << std::endl;
    }
}

bool EffectScene::setFirstTextureUnit(int unit)
{
    if (unit < TextureUnits::first || unit > TextureUnits::last)
    {
        OSG_WARN << "osgGeoFX: " << unit << " cannot be the first texture unit of a scene; name one from "
                 << TextureUnits::first << " to " << TextureUnits::last << "." << std::endl;
        return false;
    }
    _firstTextureUnit = unit;
    return true;
}

void EffectScene::adapt(osg::Program& program)
{
    AdaptedPrograms::instance().add(program);
}

bool EffectScene::setGround(const GroundDescription& description)
{
    const std::string fault = description.fault();
    if (!fault.empty())
    {
        OSG_WARN << "osgGeoFX: EffectScene::setGround: " << fault << " The former description stays."
                 << std::endl;
        return false;
    }
    _groundDescription = description;
    return true;
}

Ground EffectScene::ground(const osg::NodePath& above) const
{
    return _drawing->ground.find(*this, above);
}

namespace
{

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
    return CameraSnapshots(_effects, ViewGeometry(modelView, projection, known)).chain(known);
}

std::optional<CameraRole> EffectScene::roleOf(osgUtil::CullVisitor& outer, const CameraEffects* own) const
{
    CameraRole role = defaultRole(outer);
    if (_nestedCameras && role.getKind() == CameraRole::UNDEFORMED) role = CameraRole::view();
    const osg::Camera& camera = *outer.getCurrentCamera();
    if (own && own->getRole()) role = *own->getRole();
    if (_roleCallback) role = _roleCallback->role(camera, outer, role);
    if (role.getKind() == CameraRole::UNDEFORMED) return std::nullopt;
    return role;
}

namespace
{

/// The effects that a camera draws in the places of a scene's.
EffectProgram::Effects effectsFor(const EffectProgram::Effects& effects, const CameraEffects& camera)
{
    EffectProgram::Effects result = effects;
    for (osg::ref_ptr<Effect>& effect : result)
        effect = camera.effectFor(*effect);
    return result;
}

} // namespace

bool EffectScene::cull(osgUtil::CullVisitor& outer)
{
    if (dynamic_cast<CompensatingCullVisitor*>(&outer)) return false;
    if (!outer.getRenderStage() || !outer.getCurrentCamera()) return false;
    const CameraEffects* const special = CameraEffects::find(*outer.getCurrentCamera());
    EffectProgram::Effects replaced;
    if (special) replaced = effectsFor(_effects, *special);
    const EffectProgram::Effects& effects = special ? replaced : _effects;
    const bool wanted =
        std::any_of(effects.begin(), effects.end(), [](const auto& each) { return each->getEnabled(); });
    const std::optional<CameraRole> role = wanted ? roleOf(outer, special) : std::nullopt;
    if (!role) return false;
    const osg::NodePath& path = outer.getNodePath();

    // Two threads may be about to cull what a pager has brought, here or in another scene.
    if (_compensation)
    {
        static std::mutex mutex;
        const std::lock_guard<std::mutex> lock(mutex);
        getBound();
    }
    const ViewGeometry view = viewOf(outer, *role, ground(path));
    const CameraSnapshots snapshots(effects, view);
    Drawing::Camera& own = _drawing->cameras.of(outer);
    if (own.visitor->startsFrame(outer))
    {
        own.used = 0;
        own.passes.startFrame(outer);
    }
    const std::shared_ptr<const TextureUnits> units = _drawing->unitsOf(_effects, _firstTextureUnit);
    const int mapUnit = mapUnitOf(effects);
    if (own.used == own.states.size()) own.states.emplace_back();
    std::unique_ptr<CameraState>& now = own.states[own.used];
    // Made anew for other effects, which would find the uniforms and textures of the former ones under their names.
    if (!now || now->units() != units) now = std::make_unique<CameraState>(effects, mapUnit, units);
    osg::StateSet& state = now->set();
    now->fill(snapshots, view, mapUnit);
    now->setHorizonClipping(_engineCulling != OPEN);
    const bool surfaces = now->fillSurfaces(effects, view, outer);

    CompensatingCullVisitor::Task task;
    task.chain = snapshots.chain(view.ground);
    task.mapUnit = mapUnit;
    task.view = &view;
    if (!view.image.ofView) task.image = &view.image;
    task.untouched = _drawing->untouched;
    task.tileError = view.ground.tileError;
    task.open = _engineCulling == OPEN && _compensation && !task.chain->empty();
    // Where no effect moves anything, OSG's own tests are right, and faster. Where one does so for other cameras, ours go
    // on for this one: they let fewer tiles through, and what is drawn is not to jump as the bend comes to its end.
    const bool draws = surfaces || _debugBounds || !task.chain->empty();
    const bool passes = drawsPasses(effects);
    task.compensate = _compensation && (_debugBounds || deforms(effects));
    if (!draws && !task.compensate && !passes) return false;

    ++own.used;
    CompensatingCullVisitor::Task passTask = task;
    passTask.state = &state;
    passTask.following = &_drawing->programs.following();
    passTask.compensate = _compensation;
    const CameraPass::Traversal traversal = {outer,   *this, view, passTask, own.passes, _drawing->programs,
                                             _effects};
    const auto forPasses = [&](const auto& action)
    {
        for (std::size_t i = 0; i < effects.size(); ++i)
        {
            PassEffect* effect = effects[i]->asPassEffect();
            if (!effect || !effects[i]->getEnabled() || !units->complete[i]) continue;
            const std::string prefix = EffectProgram::prefix(i);
            action(*effect, CameraPass(traversal, prefix, units->ofEffects[i]));
        }
    };
    if (draws || task.compensate)
    {
        if (draws)
        {
            task.program = _drawing->programs.programOf(_effects);
            task.following = passTask.following;
            task.state = &state;
            forPasses(
                [&](PassEffect& effect, const ScenePass& pass)
                {
                    DrawableCompanion* companion = effect.companion(pass);
                    if (companion) task.companions.push_back(companion);
                });
        }
        task.debugBounds = _debugBounds;
        own.visitor->run(outer, *this, task);
        _drawing->sayOnce(own.visitor->complaint());
        for (const auto& stranger : own.visitor->strangers())
            _drawing->warnOf(stranger);
        const std::vector<std::string> colors = _drawing->programs.following().takeComplaints(surfaces);
        for (const std::string& sentence : colors)
            _drawing->sayOnce(sentence);
    }
    else
    {
        osg::Group::traverse(outer);
    }
    forPasses([](PassEffect& effect, const ScenePass& pass) { effect.cull(pass); });
    return true;
}

osg::BoundingSphere EffectScene::computeBound() const
{
    // Those below paged nodes, too, which have bounds of their own: OSG would leave them to whoever asks first, and that may be two
    // threads that cull at once.
    computeBounds(*this);
    return osg::Group::computeBound();
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
    for (const osg::ref_ptr<osg::Program>& program : _drawing->programs.all())
        program->resizeGLObjectBuffers(size);
    for (const osg::ref_ptr<Effect>& effect : _effects)
        effect->resizeGLObjectBuffers(size);
    osg::Group::resizeGLObjectBuffers(size);
}

void EffectScene::releaseGLObjects(osg::State* state) const
{
    for (const osg::ref_ptr<osg::Program>& program : _drawing->programs.all())
        program->releaseGLObjects(state);
    for (const osg::ref_ptr<Effect>& effect : _effects)
    {
        effect->releaseGLObjects(state);
    }
    osg::Group::releaseGLObjects(state);
}

} // namespace osgGeoFX
