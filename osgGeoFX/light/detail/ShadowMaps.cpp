// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/ShadowMaps.h>

#include <osgGeoFX/effect/PassFilter.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/PassStage.h>

#include <osg/ClipControl>
#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/PolygonMode>

#include <utility>

namespace osgGeoFX
{

namespace
{

/// Shadows are drawn before all other stages of effects, which may show ground.
constexpr int shadowOrder = -16;
constexpr GLenum depthClamp = 0x864F; // GL_DEPTH_CLAMP

std::string withPrefix(std::string text, const std::string& prefix)
{
    const std::string word = "SLOT_";
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + prefix.size()))
        text.replace(at, word.size(), prefix);
    return text;
}

/// What throws shadows into the maps.
class Casters final : public PassFilter
{
public:
    Casters(const ShadowCascades& cascades, const std::vector<osg::ref_ptr<osg::StateSet>>& states)
        : _cascades(cascades), _all(states)
    {
    }
    bool outside(const Ball& ball) const override
    {
        for (std::size_t i = 0; i < _cascades.all().size(); ++i)
            if (!_cascades.outside(i, ball)) return false;
        return true;
    }
    const std::vector<osg::StateSet*>& states(const osg::Drawable&, const EyeBox& box, const osg::Matrixd&,
                                              bool ownProgram) override
    {
        _wanted.clear();
        // A program of an application puts its vertices where it likes.
        if (ownProgram) return _wanted;
        const Ball ball = box.ball();
        for (std::size_t i = 0; i < _cascades.all().size(); ++i)
        {
            // What is smaller than half a texel falls between them.
            if (4.0 * ball.radius > _cascades.all()[i].texel && !_cascades.outside(i, ball))
                _wanted.push_back(_all[i].get());
        }
        return _wanted;
    }

private:
    const ShadowCascades& _cascades;
    const std::vector<osg::ref_ptr<osg::StateSet>>& _all;
    std::vector<osg::StateSet*> _wanted;
};

} // namespace

void ShadowMaps::resize(int count, int texels)
{
    if (_texture && count == _count && texels == _texels) return;
    _count = count;
    _texels = texels;
    _states.clear();
    const int width = columns * texels, height = rows(count) * texels;
    _texture = new osg::Texture2D;
    _texture->setTextureSize(width, height);
    _texture->setInternalFormat(GL_DEPTH_COMPONENT24);
    _texture->setSourceFormat(GL_DEPTH_COMPONENT);
    _texture->setSourceType(GL_UNSIGNED_INT);
    _texture->setShadowComparison(true);
    _texture->setShadowCompareFunc(osg::Texture::LEQUAL);
    _texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    _texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    _texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    _texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    _texture->setResizeNonPowerOfTwoHint(false);
    _target = new osg::FrameBufferObject;
    _target->setAttachment(osg::Camera::DEPTH_BUFFER, osg::FrameBufferAttachment(_texture));
    _viewport = new osg::Viewport(0, 0, width, height);
}

void ShadowMaps::makeProgram(const std::string& prefix)
{
    if (_program && _prefix == prefix) return;
    _prefix = prefix;
    _states.clear();
    const ShaderLibrary library;
    _program = new ProfileProgram;
    _program->setName("osgGeoFX shadow maps");
    const auto add = [&](osg::Shader::Type stage, const std::string& file)
    {
        _program->addShader(
            ProfileProgram::createShader(stage, withPrefix(library.source(file), prefix), file));
    };
    add(osg::Shader::VERTEX, "stages/shadows.map.vert");
    add(osg::Shader::FRAGMENT, "stages/shadows.map.frag");
}

osg::ref_ptr<osg::StateSet> ShadowMaps::makeState(int cascade, int texels, bool reversed) const
{
    constexpr auto forced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    constexpr auto on = osg::StateAttribute::ON | forced, off = osg::StateAttribute::OFF | forced;
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttribute(
        new osg::Viewport(cascade % columns * texels, cascade / columns * texels, texels, texels), forced);
    state->setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, true), on);
    state->setAttribute(new osg::PolygonMode, forced);
    // OSG changes nothing of it elsewhere, and not every OpenGL has it.
    if (reversed) state->setAttribute(new osg::ClipControl, forced);
    // What stands nearer to the sun than the box is drawn at its end.
    state->setMode(depthClamp, on);
    for (const GLenum mode : {GL_BLEND, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_ALPHA_TEST,
                              GL_SAMPLE_ALPHA_TO_COVERAGE, GL_POLYGON_OFFSET_FILL})
        state->setMode(mode, off);
    // Blended things and others stand in bins of their own; depths need no order.
    state->setRenderBinDetails(0, "RenderBin", osg::StateSet::OVERRIDE_PROTECTED_RENDERBIN_DETAILS);
    return state;
}

void ShadowMaps::draw(const ScenePass& pass, const ShadowCascades& cascades, int texels)
{
    const auto count = static_cast<int>(cascades.all().size());
    resize(count, texels);
    makeProgram(pass.prefix);
    if (_reversed != pass.depth.reversed()) _states.clear();
    _reversed = pass.depth.reversed();
    for (int i = static_cast<int>(_states.size()); i < count; ++i)
        _states.push_back(makeState(i, texels, _reversed));
    // From places in the map to clip coordinates.
    const osg::Matrixd toClip =
        osg::Matrixd::scale(2.0, 2.0, 2.0) * osg::Matrixd::translate(-1.0, -1.0, -1.0);
    for (std::size_t i = 0; i < _states.size(); ++i)
        _states[i]
            ->getOrCreateUniform(_prefix + "light", osg::Uniform::FLOAT_MAT4)
            ->set(osg::Matrixf(cascades.all()[i].toMap * toClip));

    if (!_stage) _stage = createStage();
    startStage(*_stage, pass.outer, pass.depth, osg::Vec4());
    _stage->setClearMask(GL_DEPTH_BUFFER_BIT);
    _stage->setClearDepth(1.0);
    _stage->setViewport(_viewport);
    _stage->setFrameBufferObject(_target);
    pass.outer.getCurrentRenderBin()->getStage()->addPreRenderStage(_stage, shadowOrder);
    Casters casters(cascades, _states);
    ScenePass::Drawing drawing;
    drawing.program = _program;
    drawing.stage = _stage;
    drawing.filter = &casters;
    drawing.asksForTiles = false;
    pass.draw(drawing);
}

void ShadowMaps::resizeGLObjectBuffers(unsigned int size)
{
    if (_texture) _texture->resizeGLObjectBuffers(size);
    if (_target) _target->resizeGLObjectBuffers(size);
    if (_program) _program->resizeGLObjectBuffers(size);
}

void ShadowMaps::releaseGLObjects(osg::State* state) const
{
    if (_texture) _texture->releaseGLObjects(state);
    if (_target) _target->releaseGLObjects(state);
    if (_program) _program->releaseGLObjects(state);
}

} // namespace osgGeoFX
