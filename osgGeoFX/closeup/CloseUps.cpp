// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/CloseUps.h>

#include <osgGeoFX/closeup/detail/CloseUpCamera.h>
#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/scene/detail/GpuLimits.h>

#include <osg/Notify>

#include <algorithm>
#include <mutex>
#include <set>

namespace osgGeoFX
{

/// What drawing needs and no one else sees.
class CloseUps::Drawing
{
public:
    PerCamera<CloseUpCamera> cameras;

    void saw(const Statistics& statistics, const std::string& sentence)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _statistics = statistics;
        if (!sentence.empty() && _said.insert(sentence).second)
            OSG_WARN << "osgGeoFX: " << sentence << std::endl;
    }

    Statistics statistics() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _statistics;
    }

    void releaseGLObjects(osg::State* state) const
    {
        cameras.releaseGLObjects(state);
        textures.releaseGLObjects(state);
    }

    void resizeGLObjectBuffers(unsigned int size)
    {
        cameras.resizeGLObjectBuffers(size);
        textures.resizeGLObjectBuffers(size);
    }

    CloseUpTextures textures;

private:
    mutable std::mutex _mutex;
    Statistics _statistics;
    std::set<std::string> _said;
};

CloseUps::CloseUps() : _drawing(std::make_unique<Drawing>()) {}

CloseUps::CloseUps(const CloseUps& other, const osg::CopyOp& copy)
    : PassEffect(other, copy), _closeUps(other._closeUps), _surfaceData(other._surfaceData),
      _drawing(std::make_unique<Drawing>())
{
    for (const Property& property : CloseUps::properties())
        property.put(*this, property.get(other));
    if (!(copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)) return;
    for (osg::ref_ptr<CloseUp>& closeUp : _closeUps)
        closeUp = osg::clone(closeUp.get(), copy);
    if (_surfaceData) _surfaceData = osg::clone(_surfaceData.get(), copy);
}

CloseUps::~CloseUps() = default;

bool CloseUps::addCloseUp(CloseUp* closeUp)
{
    if (!closeUp || std::find(_closeUps.begin(), _closeUps.end(), closeUp) != _closeUps.end())
    {
        OSG_WARN << "osgGeoFX: CloseUps::addCloseUp got "
                 << (closeUp ? "a close-up that it has already" : "no close-up") << "; nothing changes."
                 << std::endl;
        return false;
    }
    _closeUps.emplace_back(closeUp);
    touch();
    return true;
}

bool CloseUps::removeCloseUp(CloseUp* closeUp)
{
    const auto found = std::find(_closeUps.begin(), _closeUps.end(), closeUp);
    if (found == _closeUps.end()) return false;
    _closeUps.erase(found);
    touch();
    return true;
}

void CloseUps::removeCloseUps()
{
    _closeUps.clear();
    touch();
}

bool CloseUps::setSurfaceData(SurfaceData* data)
{
    _surfaceData = data;
    touch();
    return true;
}

CloseUps::Statistics CloseUps::statistics() const
{
    return _drawing->statistics();
}

const Properties& CloseUps::properties() const
{
    using Self = CloseUps;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            enabledProperty(),
            Property::choice("pipeline", "how close-ups are drawn",
                             {{"automatic", "as it suits"},
                              {"singlePass", "what lies in a region once, copied by a geometry shader"},
                              {"multiPass", "each close-up by itself, as detailed as it is large"}})
                .of<&Self::_pipeline>(),
            Property::integer(
                "tessellation",
                "the largest number of parts of a triangle's edge where vertices are added; 1 adds none", 1,
                64)
                .of<&Self::_tessellation>(),
            Property::number("opacity", "the opacity of all close-ups together", 0.0, 1.0)
                .of<&Self::_opacity>()
                .turnedBy(0.05),
            Property::integer("supersampling", "the number of samples along each side of a pixel", 1, 4)
                .of<&Self::_supersampling>(),
            Property::flag("depthTest", "whether what stands in front hides close-ups and anchors")
                .of<&Self::_depthTest>(),
            Property::integer("maxLayers", "the largest number of layers of a texture array", 2, 2048)
                .of<&Self::_maxLayers>(),
            TextureUnits::property("maskUnit", "the texture unit of the regions' masks")
                .of<&Self::_maskUnit>(),
            TextureUnits::property("tableUnit", "the texture unit of the tables").of<&Self::_tableUnit>(),
            TextureUnits::property("surfaceUnit", "the texture unit of the surface data")
                .of<&Self::_surfaceUnit>(),
            TextureUnits::blockProperty("blockBinding", "the binding point of the uniform block")
                .of<&Self::_blockBinding>(),
        });
    return all;
}

std::string CloseUps::inconsistency() const
{
    return TextureUnits::inconsistency(textureUnits());
}

std::vector<TextureUnitWish> CloseUps::textureUnits() const
{
    return {{"maskUnit", _maskUnit, 11, false},
            {"tableUnit", _tableUnit, 12, false},
            {"surfaceUnit", _surfaceUnit, 13, false}};
}

void CloseUps::cull(const ScenePass& pass)
{
    if (_opacity <= 0.0 || !pass.outer.getViewport()) return;
    std::vector<osg::ref_ptr<CloseUp>> drawn;
    std::copy_if(_closeUps.begin(), _closeUps.end(), std::back_inserter(drawn),
                 [](const osg::ref_ptr<CloseUp>& each)
                 { return each->getEnabled() && !each->getRegion()->isEmpty(); });
    if (drawn.empty()) return;
    // A layer is a part of the picture, but the GPU's viewport is as large as all of it.
    const double side =
        std::max({pass.outer.getViewport()->width(), pass.outer.getViewport()->height(), 1.0});
    const int limit = GpuLimits::of(pass.outer).textureSide;
    const int samples = std::clamp(static_cast<int>(limit / side), 1, _supersampling);
    std::string fewer;
    if (samples < _supersampling)
        fewer = "CloseUps draws " + std::to_string(samples) +
                " samples along a pixel's side in the place of " + std::to_string(_supersampling) +
                ", for the picture would have more than the " + std::to_string(limit) +
                " texels of this GPU; make the picture smaller or lower supersampling.";
    const CloseUpTask task = {drawn,
                              _surfaceData,
                              _drawing->textures.update(drawn, _surfaceData),
                              getPipeline(),
                              _tessellation,
                              _opacity,
                              samples,
                              _depthTest,
                              _maxLayers,
                              {pass.units[0], pass.units[1], pass.units[2]},
                              static_cast<unsigned int>(pass.blocks[0])};
    CloseUpCamera& camera = _drawing->cameras.of(pass.outer, pass.scene);
    const std::string sentence = camera.cull(pass, task);
    _drawing->saw(camera.statistics(), sentence);
    if (!fewer.empty()) _drawing->saw(camera.statistics(), fewer);
}

void CloseUps::resizeGLObjectBuffers(unsigned int size)
{
    _drawing->resizeGLObjectBuffers(size);
}

void CloseUps::releaseGLObjects(osg::State* state) const
{
    _drawing->releaseGLObjects(state);
}

} // namespace osgGeoFX
