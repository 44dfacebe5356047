// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/SunShadows.h>

#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/light/detail/ShadowMaps.h>
#include <osgGeoFX/light/detail/SunFinder.h>

#include <osg/Notify>

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <vector>

namespace osgGeoFX
{

namespace
{

void set(osg::StateSet& state, const std::string& name, const osg::Vec4d& value)
{
    state.getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(value));
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
    void forget(const osg::Group& scene) override
    {
        _draws.forget(scene);
        _cameras.forget(scene);
    }
    Statistics statistics() const { return {_drawn, _kept}; }
    void resizeGLObjectBuffers(unsigned int size) override
    {
        _draws.resizeGLObjectBuffers(size);
        _cameras.resizeGLObjectBuffers(size);
    }
    void releaseGLObjects(osg::State* state) const override
    {
        _draws.releaseGLObjects(state);
        _cameras.releaseGLObjects(state);
    }

private:
    /// What a cull visitor draws maps with. It may come several times before anything is drawn.
    class Draws
    {
    public:
        /// The number of the next one within the frame.
        std::size_t next(unsigned int frame)
        {
            if (frame != _frame) _used = 0;
            _frame = frame;
            if (_used == _all.size()) _all.push_back(std::make_unique<ShadowMaps>());
            return _used++;
        }
        ShadowMaps& operator[](std::size_t number) { return *_all[number]; }
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

    /// What all cull visitors of a camera share. With grids of their own they would drift apart.
    struct Camera
    {
        ShadowGrid grid;
        std::map<std::size_t, ShadowTexture> textures; ///< by the number within the frame

        void resizeGLObjectBuffers(unsigned int size)
        {
            for (auto& [number, texture] : textures)
                texture.resizeGLObjectBuffers(size);
        }
        void releaseGLObjects(osg::State* state) const
        {
            for (const auto& [number, texture] : textures)
                texture.releaseGLObjects(state);
        }
    };

    const SunShadows& _shadows;
    std::atomic<std::uint64_t> _drawn{0}, _kept{0};         ///< maps
    std::array<std::atomic<bool>, Sun::SHINING> _said = {}; ///< of each complaint
    PerCamera<Draws> _draws;
    PerCamera<Camera, osg::Camera> _cameras;
};

void SunShadows::Pass::cull(const ScenePass& pass)
{
    const Sun sun = Sun::find(pass);
    const std::string complaint = sun.complaint();
    if (!complaint.empty() && !_said[sun.kind].exchange(true))
        OSG_WARN << "osgGeoFX: " << complaint << std::endl;
    if (sun.kind != Sun::SHINING) return;
    const osg::Vec3d& towards = sun.towards;
    set(pass.state, pass.prefix + "towards", {towards, 1.0});
    setHorizon(pass.state, pass.prefix, pass.view);
    // On a globe the place below the eye tells nothing of the rest, but what is far away has no shadows anyway.
    if (towards * pass.view.up <= 0.0) return;
    Camera& camera = _cameras.of(*pass.outer.getCurrentCamera(), pass.scene);
    const int texels = _shadows._mapSize;
    const ShadowCascades cascades(pass.view, GroundBelow::find(pass), camera.grid, towards, _shadows._nearest,
                                  _shadows._cascades, texels);
    Draws& draws = _draws.of(pass.outer, pass.scene);
    const std::size_t number = draws.next(pass.frame);
    ShadowTexture& texture = camera.textures[number];
    const auto count = static_cast<int>(cascades.all().size());
    const int drawn = draws[number].draw(pass, cascades, texels, texture);
    _drawn += static_cast<std::uint64_t>(drawn);
    _kept += static_cast<std::uint64_t>(count - drawn);
    pass.state.setTextureAttribute(static_cast<unsigned int>(pass.units.front()), texture.texture());
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

SunShadows::SunShadows() : _noMaps(ShadowTexture::makeTexture(1, 1)), _pass(new Pass(*this)) {}

SunShadows::SunShadows(const SunShadows& other, const osg::CopyOp& copy)
    : SurfaceEffect(other, copy), TextureUser(other), _strength(other._strength), _cascades(other._cascades),
      _mapSize(other._mapSize), _nearest(other._nearest), _mapUnit(other._mapUnit),
      _noMaps(ShadowTexture::makeTexture(1, 1)), _pass(new Pass(*this))
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
                "half the width of the first map; 0 goes by the eye's height above the ground below it", 0.0,
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
