// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/SunShadows.h>

#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/light/detail/ShadowMaps.h>

#include <osg/LOD>
#include <osg/LightSource>
#include <osg/Transform>

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

namespace osgGeoFX
{

namespace
{

void set(osg::StateSet& state, const std::string& name, const osg::Vec4d& value)
{
    state.getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(value));
}

/// What OpenGL knows of a light: the light, and the matrix that leads from its frame to the eye space of the view.
using LightAt = std::optional<std::pair<const osg::Light*, osg::Matrixd>>;

bool isSun(const osg::StateAttribute* attribute)
{
    const auto* light = dynamic_cast<const osg::Light*>(attribute);
    return light && light->getLightNum() == 0;
}

/// The last light 0 below a node, but not in what a pager has read.
const osg::Light* sunBelow(osg::Node& node, unsigned int mask, osg::Matrixd& matrix)
{
    if (!(node.getNodeMask() & mask) || node.asCamera() || dynamic_cast<osg::LOD*>(&node)) return nullptr;
    const auto* source = dynamic_cast<osg::LightSource*>(&node);
    osg::Group* group = node.asGroup();
    const osg::Matrixd above = matrix;
    if (osg::Transform* transform = node.asTransform()) transform->computeLocalToWorldMatrix(matrix, nullptr);
    for (unsigned int i = group ? group->getNumChildren() : 0; i-- > 0;)
    {
        osg::Matrixd inner = matrix;
        if (const osg::Light* found = sunBelow(*group->getChild(i), mask, inner))
        {
            matrix = inner;
            return found;
        }
    }
    if (source && isSun(source->getLight())) return source->getLight();
    matrix = above;
    return nullptr;
}

/// The light 0 of a source that is traversed after the scene, and so wins over those that the stage knows.
LightAt sunAfter(const ScenePass& pass)
{
    const osg::NodePath& path = pass.outer.getNodePath();
    osg::Matrixd toWorld;
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
    {
        if (osg::Transform* transform = path[i]->asTransform())
            transform->computeLocalToWorldMatrix(toWorld, nullptr);
        osg::Group* group = path[i]->asGroup();
        const unsigned int here = group ? group->getChildIndex(path[i + 1]) : 0;
        for (unsigned int j = group ? group->getNumChildren() : 0; j-- > here + 1;)
        {
            osg::Matrixd matrix = toWorld;
            const osg::Light* found = sunBelow(*group->getChild(j), pass.outer.getTraversalMask(), matrix);
            // From the world by the way of the scene's own frame, since the view is given in that.
            if (found)
                return std::pair(found, matrix * osg::computeWorldToLocal(path, true) * pass.view.modelView);
        }
    }
    return std::nullopt;
}

/// The last one that the stage knows, as OSG applies them.
LightAt sunOfStage(const ScenePass& pass)
{
    LightAt found;
    osgUtil::PositionalStateContainer& lights =
        *pass.outer.getCurrentRenderBin()->getStage()->getPositionalStateContainer();
    for (const auto& [attribute, matrix] : lights.getAttrMatrixList())
    {
        if (!isSun(attribute)) continue;
        found = std::pair(static_cast<const osg::Light*>(attribute.get()),
                          matrix ? osg::Matrixd(*matrix) : osg::Matrixd());
        if (!pass.view.image.ofView) found->second.postMult(pass.view.image.toView);
    }
    return found;
}

/// Towards the sun, in the eye space of the view; empty where light 0 is none.
std::optional<osg::Vec3d> towardsSun(const ScenePass& pass)
{
    LightAt sun = sunAfter(pass);
    if (!sun) sun = sunOfStage(pass);
    if (!sun) return std::nullopt;
    const osg::Vec4 position = sun->first->getPosition();
    const osg::Vec4& color = sun->first->getDiffuse();
    if (position.w() != 0.0f || std::max({color.r(), color.g(), color.b()}) <= 0.0f) return std::nullopt;
    osg::Vec3d towards = osg::Matrixd::transform3x3(
        osg::Vec3d(osg::Vec3(position.x(), position.y(), position.z())), sun->second);
    return towards.normalize() > 0.0 ? std::optional(towards) : std::nullopt;
}

/// Which way is up: above a plane in the first three, on a globe from its center, in the fourth how many of both.
void setHorizon(osg::StateSet& state, const std::string& prefix, const ViewGeometry& view)
{
    const bool globe = view.ground.ellipsoid.valid();
    const osg::Vec3d center = view.modelView.getTrans();
    set(state, prefix + "upward", globe ? osg::Vec4d(center, 1.0) : osg::Vec4d(view.up, 0.0));
}

} // namespace

/// Draws the maps before the camera's picture.
class SunShadows::Pass : public PassEffect
{
public:
    explicit Pass(const SunShadows& shadows) : _shadows(shadows) {}
    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "SunShadows::Pass"; }
    const Properties& properties() const override
    {
        static const Properties none;
        return none;
    }

    void cull(const ScenePass& pass) override;
    Statistics statistics() const { return {_drawn, _kept}; }
    void resizeGLObjectBuffers(unsigned int size) override { _cameras.resizeGLObjectBuffers(size); }
    void releaseGLObjects(osg::State* state) const override { _cameras.releaseGLObjects(state); }

private:
    /// The maps of one camera. Its cull visitor may come several times before anything is drawn.
    class Looks
    {
    public:
        ShadowMaps& next(unsigned int frame)
        {
            if (frame != _frame) _used = 0;
            _frame = frame;
            if (_used == _all.size()) _all.push_back(std::make_unique<ShadowMaps>());
            return *_all[_used++];
        }
        void resizeGLObjectBuffers(unsigned int size)
        {
            for (const std::unique_ptr<ShadowMaps>& each : _all)
                each->resizeGLObjectBuffers(size);
        }
        void releaseGLObjects(osg::State* state) const
        {
            for (const std::unique_ptr<ShadowMaps>& each : _all)
                each->releaseGLObjects(state);
        }

    private:
        std::vector<std::unique_ptr<ShadowMaps>> _all;
        std::size_t _used = 0;
        unsigned int _frame = 0;
    };

    const SunShadows& _shadows;
    std::atomic<std::uint64_t> _drawn{0}, _kept{0}; ///< maps
    PerCamera<Looks> _cameras;
    PerCamera<ShadowGrid, osg::Camera>
        _grids; ///< one for all cull visitors of a camera, or they would drift apart
};

void SunShadows::Pass::cull(const ScenePass& pass)
{
    const std::optional<osg::Vec3d> towards = towardsSun(pass);
    if (!towards) return;
    set(pass.state, pass.prefix + "towards", {*towards, 1.0});
    setHorizon(pass.state, pass.prefix, pass.view);
    // On a globe the place below the eye tells nothing of the rest, but what is far away has no shadows anyway.
    if (*towards * pass.view.up <= 0.0) return;
    ShadowGrid& grid = _grids.of(*pass.outer.getCurrentCamera(), pass.scene);
    const int texels = _shadows._mapSize;
    const ShadowCascades cascades(pass.view, grid, *towards, _shadows._nearest, _shadows._cascades, texels);
    ShadowMaps& maps = _cameras.of(pass.outer, pass.scene).next(pass.frame);
    const auto count = static_cast<int>(cascades.all().size());
    const int drawn = maps.draw(pass, cascades, texels);
    _drawn += static_cast<std::uint64_t>(drawn);
    _kept += static_cast<std::uint64_t>(count - drawn);
    pass.state.setTextureAttribute(static_cast<unsigned int>(pass.units.front()), maps.texture());
    osg::Uniform& matrices =
        *pass.state.getOrCreateUniform(pass.prefix + "maps", osg::Uniform::FLOAT_MAT4, ShadowCascades::most);
    osg::Uniform& sizes =
        *pass.state.getOrCreateUniform(pass.prefix + "texels", osg::Uniform::FLOAT, ShadowCascades::most);
    for (int i = 0; i < count; ++i)
    {
        const ShadowCascade& cascade = cascades.all()[static_cast<std::size_t>(i)];
        matrices.setElement(static_cast<unsigned int>(i), osg::Matrixf(cascade.toMap));
        sizes.setElement(static_cast<unsigned int>(i), static_cast<float>(cascade.texel));
    }
    set(pass.state, pass.prefix + "cascades",
        {double(count), double(texels), cascades.firstShare(), _shadows._strength});
}

SunShadows::SunShadows() : _noMaps(ShadowMaps::makeTexture(1, 1)), _pass(new Pass(*this)) {}

SunShadows::SunShadows(const SunShadows& other, const osg::CopyOp& copy)
    : SurfaceEffect(other, copy), TextureUser(other), _strength(other._strength), _cascades(other._cascades),
      _mapSize(other._mapSize), _nearest(other._nearest), _mapUnit(other._mapUnit),
      _noMaps(ShadowMaps::makeTexture(1, 1)), _pass(new Pass(*this))
{
}

SunShadows::~SunShadows() = default;

PassEffect* SunShadows::asPassEffect()
{
    return _pass;
}

const Properties& SunShadows::properties() const
{
    using Self = SunShadows;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            enabledProperty(),
            Property::number("strength", "how much of the sun's light shadows take away", 0.0, 1.0)
                .of<&Self::_strength>()
                .turnedBy(0.1),
            Property::integer("cascades",
                              "how many maps there are, each four times as wide as the one before", 1,
                              ShadowCascades::most)
                .of<&Self::_cascades>(),
            Property::integer("mapSize", "the texels along the side of one map", 64, 4096)
                .of<&Self::_mapSize>(),
            Property::number(
                "nearest",
                "half the width of the first map; 0 goes by the eye's height above the lowest ground", 0.0,
                100000.0, "m")
                .of<&Self::_nearest>(),
            TextureUnits::property("mapUnit", "the texture unit of the maps").of<&Self::_mapUnit>(),
        });
    return all;
}

std::vector<TextureUnitWish> SunShadows::textureUnits() const
{
    return {{"mapUnit", _mapUnit, 19}};
}

SunShadows::Statistics SunShadows::statistics() const
{
    return _pass->statistics();
}

bool SunShadows::fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view)
{
    state.getOrCreateUniform(prefix + "depths", osg::Uniform::SAMPLER_2D_SHADOW)->set(view.units.front());
    // A shader that compares depths must find depths, even where it does not look at them.
    state.setTextureAttribute(static_cast<unsigned int>(view.units.front()), _noMaps);
    // Where no light is found while the scene is culled, none is taken away.
    set(state, prefix + "cascades", {0.0, 1.0, 1.0, _strength});
    set(state, prefix + "towards", {0.0, 0.0, 0.0, 0.0});
    set(state, prefix + "upward", {0.0, 0.0, 0.0, 0.0});
    return true;
}

void SunShadows::resizeGLObjectBuffers(unsigned int size)
{
    _noMaps->resizeGLObjectBuffers(size);
    _pass->resizeGLObjectBuffers(size);
}

void SunShadows::releaseGLObjects(osg::State* state) const
{
    _noMaps->releaseGLObjects(state);
    _pass->releaseGLObjects(state);
}

} // namespace osgGeoFX
