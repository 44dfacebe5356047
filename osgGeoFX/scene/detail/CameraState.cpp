// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/CameraState.h>

#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/detail/TileNormals.h>
#include <osgGeoFX/scene/detail/ContextWatch.h>
#include <osgGeoFX/scene/detail/FixedFunctionLook.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

void setDefine(osg::StateSet& state, const std::string& name, bool on)
{
    state.setDefine(name, on ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
}

bool finite(const DeformationSnapshot::Uniforms& uniforms)
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

} // namespace

EffectsAtWork::EffectsAtWork(const EffectProgram::Effects& effects) : _work(effects.size())
{
    const Effect* projection = nullptr;
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        _work[i] = effects[i]->isActive();
        const Deformation* deformation = effects[i]->asDeformation();
        if (!_work[i] || !deformation || !deformation->isProjection()) continue;
        if (projection)
        {
            _work[i] = false;
            _sentence =
                std::string(projection->className()) + " and " + effects[i]->className() +
                " both make a picture of their own of the whole view, so a camera shows one of them "
                "at a time: the first one in the scene's list. Switch the other one off, for one camera with "
                "CameraEffects; a BlendedView goes from one bend to the other.";
        }
        else
            projection = effects[i];
    }
}

CameraSnapshots::CameraSnapshots(const EffectProgram::Effects& effects, const EffectsAtWork& work,
                                 const ViewGeometry& first)
    : _all(effects.size())
{
    ViewGeometry view = first;
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        const Deformation* deformation = effects[i]->asDeformation();
        if (!deformation || !work[i]) continue;
        const osg::ref_ptr<const DeformationSnapshot> snapshot = deformation->snapshot(view);
        if (!snapshot) continue;
        DeformationSnapshot::Uniforms uniforms = snapshot->uniforms();
        if (!finite(uniforms)) continue;
        _all[i] = {snapshot, std::move(uniforms)};
        deformation->changeGround(view.ground);
    }
}

osg::ref_ptr<DeformationChain> CameraSnapshots::chain(const Ground& ground) const
{
    osg::ref_ptr<DeformationChain> result = new DeformationChain;
    result->setTiles(ground.tileEdge, ground.tileError, ground.terrain.get() != nullptr);
    result->setCoarseTiles(ground.coarseTiles);
    for (const Placed& placed : _all)
    {
        if (placed.snapshot) result->add(placed.snapshot);
    }
    return result;
}

CameraState::CameraState(const EffectProgram::Effects& effects, int mapUnit,
                         const std::shared_ptr<const TextureUnits>& units)
    : _units(units)
{
    for (int unit = 0; unit < FixedFunctionLook::units; ++unit)
        _set->addUniform(new osg::Uniform(("geofx_texture" + std::to_string(unit)).c_str(), unit));
    _set->addUniform(new osg::Uniform("geofx_normals", static_cast<int>(TileNormals::unit)));
    _set->addUniform(new osg::Uniform("geofx_map", std::max(mapUnit, 0)));
    _set->addUniform(new osg::Uniform("geofx_cover", TextureUnits::ofCover));
    _set->setAttribute(new ContextWatch(effects));
}

/// The uniform at one place of an effect's list.
osg::Uniform& CameraState::uniformAt(std::size_t effect, std::size_t place, const std::string& name)
{
    std::vector<osg::ref_ptr<osg::Uniform>>& known = _uniforms[effect];
    if (known.size() <= place) known.resize(place + 1);
    osg::ref_ptr<osg::Uniform>& uniform = known[place];
    // Another effect may have taken the former one's index. The prefix depends on the index alone, so only the rest
    // of the name is compared.
    const bool same =
        uniform && uniform->getName().size() > name.size() &&
        uniform->getName().compare(uniform->getName().size() - name.size(), name.size(), name) == 0;
    if (!same)
        uniform = _set->getOrCreateUniform(EffectProgram::prefix(effect) + name, osg::Uniform::FLOAT_VEC4);
    return *uniform;
}

/// Where the camera stands that draws the view.
void CameraState::fillImage(const ViewGeometry& view)
{
    setDefine(*_set, "GEOFX_IMAGE", !view.image.ofView);
    if (view.image.ofView) return;
    const auto put = [&](const char* name, const osg::Matrixd& matrix)
    {
        _set->getOrCreateUniform(name, osg::Uniform::FLOAT_MAT4)->set(osg::Matrixf(matrix));
    };
    put("geofx_toView", view.image.toView);
    put("geofx_toEye", view.image.toEye);
    put("geofx_viewProjection", view.projection);
}

void CameraState::setBright(bool on)
{
    setDefine(*_set, "GEOFX_HDR", on);
}

void CameraState::setHorizonPlane(const osg::Vec4d* plane)
{
    constexpr const char* name = "oe_ClipPlane_plane";
    if (!plane)
    {
        _set->removeUniform(name);
        return;
    }
    osg::Uniform* uniform = _set->getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4);
    uniform->set(osg::Vec4f(*plane));
    _set->addUniform(uniform, osg::StateAttribute::OVERRIDE);
}

void CameraState::fill(const CameraSnapshots& snapshots, const ViewGeometry& view, const CameraDepth& depth,
                       int mapUnit)
{
    fillImage(view);
    depth.put(*_set);
    _set->getOrCreateUniform("geofx_map", osg::Uniform::INT)->set(std::max(mapUnit, 0));
    setDefine(*_set, "GEOFX_DEFORMATION", true);
    const std::vector<CameraSnapshots::Placed>& all = snapshots.all();
    _uniforms.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        setDefine(*_set, EffectProgram::define(i), all[i].snapshot.valid());
        for (std::size_t place = 0; place < all[i].uniforms.size(); ++place)
        {
            const auto& [name, value] = all[i].uniforms[place];
            uniformAt(i, place, name).set(osg::Vec4f(value));
        }
    }
}

bool CameraState::fillSurfaces(const EffectProgram::Effects& effects, const EffectsAtWork& work,
                               const ViewGeometry& geometry, osgUtil::CullVisitor& outer)
{
    bool any = false;
    bool repainted = false;
    bool fading = false;
    bool shadowed = false;
    const osg::Viewport* viewport = outer.getViewport();
    const osg::FrameStamp* stamp = outer.getFrameStamp();
    for (std::size_t i = 0; i < effects.size(); ++i)
    {
        SurfaceEffect* surface = effects[i]->asSurfaceEffect();
        if (!surface) continue;
        const SurfaceView view = {geometry,
                                  geometry.modelView,
                                  viewport ? viewport->x() : 0.0,
                                  viewport ? viewport->y() : 0.0,
                                  viewport ? viewport->width() : 0.0,
                                  viewport ? viewport->height() : 0.0,
                                  stamp ? stamp->getSimulationTime() : 0.0,
                                  _units->ofEffects[i]};
        const bool draws =
            work[i] && _units->complete[i] && surface->fill(*_set, EffectProgram::prefix(i), view);
        setDefine(*_set, EffectProgram::surfaceDefine(i), draws);
        any = any || draws;
        repainted = repainted || (draws && surface->repaints());
        fading = fading || (draws && surface->repaints() && surface->fades());
        shadowed = shadowed || (draws && surface->shadesLight());
    }
    setDefine(*_set, "GEOFX_PAINTED", repainted);
    setDefine(*_set, "GEOFX_FADING", fading);
    setDefine(*_set, "GEOFX_SHADOWED", shadowed);
    return any;
}

} // namespace osgGeoFX
