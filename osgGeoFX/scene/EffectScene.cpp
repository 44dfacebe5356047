// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/EffectScene.h>

#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/scene/TilePrefetch.h>
#include <osgGeoFX/scene/detail/AdaptedPrograms.h>
#include <osgGeoFX/scene/detail/SceneDrawing.h>

#include <osg/Notify>

#include <algorithm>

namespace osgGeoFX
{

EffectScene::EffectScene() : _drawing(std::make_unique<SceneDrawing>())
{
    // What its bound becomes is known below it only.
    setCullingActive(false);
}

EffectScene::EffectScene(const EffectScene& other, const osg::CopyOp& copy)
    : osg::Group(other, copy), _effects(other._effects), _compensation(other._compensation),
      _debugBounds(other._debugBounds), _nestedCameras(other._nestedCameras),
      _adaptsPrograms(other._adaptsPrograms), _firstTextureUnit(other._firstTextureUnit),
      _textureUnits(other._textureUnits), _firstBlockBinding(other._firstBlockBinding),
      _depthConvention(other._depthConvention), _shaderHost(other._shaderHost),
      _roleCallback(other._roleCallback), _groundDescription(other._groundDescription),
      _engineCulling(other._engineCulling), _engineTerrain(other._engineTerrain),
      _layoutBins(other._layoutBins), _drawing(std::make_unique<SceneDrawing>())
{
    if (copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)
    {
        for (osg::ref_ptr<Effect>& effect : _effects)
            effect = osg::clone(effect.get(), copy);
    }
    for (const osg::ref_ptr<Effect>& effect : _effects)
        Misuse::enter(*effect);
}

EffectScene::~EffectScene()
{
    for (const osg::ref_ptr<Effect>& effect : _effects)
        Misuse::leave(*effect);
}

bool EffectScene::addEffect(Effect* effect)
{
    return insertEffect(getNumEffects(), effect);
}

bool EffectScene::insertEffect(unsigned int index, Effect* effect)
{
    if (!effect || std::find(_effects.begin(), _effects.end(), effect) != _effects.end())
    {
        OSG_WARN << "osgGeoFX: EffectScene got "
                 << (effect ? "an effect that the scene has already" : "no effect") << "; nothing changes."
                 << std::endl;
        return false;
    }
    _effects.insert(_effects.begin() + std::min(index, getNumEffects()), effect);
    Misuse::enter(*effect);
    _drawing->dirty();
    return true;
}

bool EffectScene::removeEffect(Effect* effect)
{
    const auto found = std::find(_effects.begin(), _effects.end(), effect);
    if (found == _effects.end()) return false;
    Misuse::leave(*effect);
    const osg::ref_ptr<Effect> removed = *found;
    _effects.erase(found);
    _drawing->forgetEffects();
    if (PassEffect* pass = removed->asPassEffect()) pass->forget(*this);
    return true;
}

void EffectScene::addFunctions(osg::Program& program)
{
    try
    {
        EffectProgram::addIdleFunctions(program);
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

bool EffectScene::setTextureUnits(const std::vector<int>& units)
{
    std::vector<int> sorted = units;
    std::sort(sorted.begin(), sorted.end());
    const bool twice = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
    if (twice ||
        (!sorted.empty() && (sorted.front() < TextureUnits::first || sorted.back() > TextureUnits::last)))
    {
        OSG_WARN << "osgGeoFX: the texture units that a scene may choose must be from " << TextureUnits::first
                 << " to " << TextureUnits::last << ", each named once; the former ones stay." << std::endl;
        return false;
    }
    _textureUnits = std::move(sorted);
    return true;
}

void EffectScene::setShaderHost(ShaderHost* host)
{
    _shaderHost = host;
    _drawing->dirty();
}

bool EffectScene::setFirstBlockBinding(int binding)
{
    if (binding < 0 || binding > TextureUnits::lastBlock)
    {
        OSG_WARN << "osgGeoFX: " << binding
                 << " cannot be the first uniform block binding of a scene; name one from 0 to "
                 << TextureUnits::lastBlock << "." << std::endl;
        return false;
    }
    _firstBlockBinding = binding;
    return true;
}

bool EffectScene::setDepthConvention(const DepthConvention& convention)
{
    const std::string fault = convention.fault();
    if (!fault.empty())
    {
        OSG_WARN << "osgGeoFX: EffectScene::setDepthConvention: " << fault << " The former convention stays."
                 << std::endl;
        return false;
    }
    _depthConvention = convention;
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
    return _drawing->ground.find(*this, *getTerrain(), above);
}

osg::ref_ptr<const DeformationChain> EffectScene::deformation(const osg::Matrixd& modelView,
                                                              const osg::Matrixd& projection,
                                                              const osg::NodePath& above) const
{
    const Ground known = ground(above);
    return CameraSnapshots(_effects, EffectsAtWork(_effects), ViewGeometry(modelView, projection, known))
        .chain(known);
}

osg::ref_ptr<const DeformationChain> EffectScene::deformationOfColumn(const osg::Matrixd& modelView,
                                                                      const osg::Matrixd& projection,
                                                                      double low, double high,
                                                                      const osg::NodePath& above) const
{
    const Ground known = ground(above);
    ViewGeometry view(modelView, projection, known);
    view.setImage(modelView, projection * osg::Matrixd::translate(-0.5 * (low + high), 0.0, 0.0) *
                                 osg::Matrixd::scale(2.0 / (high - low), 1.0, 1.0));
    return CameraSnapshots(_effects, EffectsAtWork(_effects), view).chain(known);
}

osg::Matrixd EffectScene::turnOfHorizon(osgUtil::CullVisitor& visitor)
{
    return _drawing->turnOfHorizon(*this, _effects, visitor);
}

unsigned int EffectScene::leastParts() const
{
    unsigned int parts = 1;
    for (const osg::ref_ptr<Effect>& effect : _effects)
    {
        const Deformation* deformation = effect->isActive() ? effect->asDeformation() : nullptr;
        if (deformation) parts = std::max(parts, deformation->leastParts());
    }
    return parts;
}

osg::ref_ptr<osg::Group> EffectScene::getTerrain()
{
    const std::lock_guard<std::mutex> lock(_terrainMutex);
    osg::ref_ptr<osg::Group> other;
    return _terrain.lock(other) ? other : this;
}

osg::ref_ptr<const osg::Group> EffectScene::getTerrain() const
{
    return const_cast<EffectScene*>(this)->getTerrain();
}

void EffectScene::setTerrain(osg::Group& terrain)
{
    const std::lock_guard<std::mutex> lock(_terrainMutex);
    if (_terrain.get() != &terrain) _terrain = &terrain;
}

bool EffectScene::cull(osgUtil::CullVisitor& outer, osg::Group& terrain,
                       const std::function<void(osg::NodeVisitor&)>& traverse)
{
    return _drawing->cull(*this, _effects, outer, terrain, traverse);
}

osg::BoundingSphere EffectScene::computeBound() const
{
    // Those below paged nodes, too. OSG would leave them to whoever asks first, and that may be two threads that cull at once.
    SceneDrawing::computeBoundsBelow(*this);
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

void EffectScene::setPrefetch(TilePrefetch* prefetch)
{
    const unsigned int updates = getNumChildrenRequiringUpdateTraversal();
    if (prefetch && !_prefetch) setNumChildrenRequiringUpdateTraversal(updates + 1);
    if (!prefetch && _prefetch) setNumChildrenRequiringUpdateTraversal(updates - 1);
    _prefetch = prefetch;
}

void EffectScene::traverse(osg::NodeVisitor& visitor)
{
    osgUtil::CullVisitor* culling = visitor.asCullVisitor();
    // An EffectCullCallback may have drawn another terrain before.
    if (culling) setTerrain(*this);
    if (culling && cull(*culling, *this, [this](osg::NodeVisitor& inner) { osg::Group::traverse(inner); }))
        return;
    osg::Group::traverse(visitor);
    if (_prefetch && visitor.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR && visitor.getFrameStamp())
        _prefetch->update(*visitor.getFrameStamp());
}

void EffectScene::resizeGLObjectBuffers(unsigned int size)
{
    _drawing->resizeGLObjectBuffers(size);
    for (const osg::ref_ptr<Effect>& effect : _effects)
        effect->resizeGLObjectBuffers(size);
    osg::Group::resizeGLObjectBuffers(size);
}

void EffectScene::releaseGLObjects(osg::State* state) const
{
    _drawing->releaseGLObjects(state);
    for (const osg::ref_ptr<Effect>& effect : _effects)
    {
        effect->releaseGLObjects(state);
    }
    osg::Group::releaseGLObjects(state);
}

} // namespace osgGeoFX
