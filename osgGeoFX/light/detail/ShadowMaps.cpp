// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/ShadowMaps.h>

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/PassFilter.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/GpuLimits.h>
#include <osgGeoFX/scene/detail/PassStage.h>

#include <osg/ClipControl>
#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/PolygonMode>
#include <osg/Scissor>
#include <osg/Viewport>

#include <algorithm>
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
    Casters(const ShadowCascades& cascades, const std::vector<osg::ref_ptr<osg::StateSet>>& states,
            const osg::Matrixd& toWorld)
        : found(cascades.all().size()), _cascades(cascades), _all(states)
    {
        for (std::size_t i = 0; i < found.size(); ++i)
            found[i].begin(cascades.all()[i], toWorld);
    }
    bool outside(const Ball& ball) const override
    {
        for (std::size_t i = 0; i < _cascades.all().size(); ++i)
            if (!_cascades.outside(i, ball)) return false;
        return true;
    }
    const std::vector<osg::StateSet*>& states(const osg::Drawable& drawable, const EyeBox& box,
                                              const osg::Matrixd&, bool ownProgram) override
    {
        _wanted.clear();
        // A program of an application puts its vertices where it likes.
        if (ownProgram || GroundShade::is(drawable)) return _wanted;
        const Ball ball = box.ball();
        for (std::size_t i = 0; i < _cascades.all().size(); ++i)
        {
            // What is smaller than half a texel falls between them.
            if (!(4.0 * ball.radius > _cascades.all()[i].texel) || _cascades.outside(i, ball)) continue;
            _wanted.push_back(_all[i].get());
            found[i].add(drawable, box);
        }
        return _wanted;
    }

    std::vector<ShadowCasters> found; ///< of each map

private:
    const ShadowCascades& _cascades;
    const std::vector<osg::ref_ptr<osg::StateSet>>& _all;
    std::vector<osg::StateSet*> _wanted;
};

/// For drawing into one of the maps.
osg::ref_ptr<osg::StateSet> makeState(osg::Viewport* viewport, bool reversed)
{
    constexpr auto forced = osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    constexpr auto on = osg::StateAttribute::ON | forced, off = osg::StateAttribute::OFF | forced;
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttribute(viewport, forced);
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

/// For clearing one.
osg::ref_ptr<osg::StateSet> makeClearing(osg::Scissor* scissors)
{
    constexpr auto on =
        osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttributeAndModes(scissors, on);
    state->setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, true), on);
    // Before all that is drawn.
    state->setRenderBinDetails(-1, "RenderBin", osg::StateSet::OVERRIDE_PROTECTED_RENDERBIN_DETAILS);
    return state;
}

} // namespace

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

void ShadowMaps::makeStates(int count, int texels, int columns, bool reversed)
{
    if (texels != _texels || columns != _columns || reversed != _reversed) _states.clear();
    _texels = texels;
    _columns = columns;
    _reversed = reversed;
    _clears.resize(_states.size());
    for (int i = static_cast<int>(_states.size()); i < count; ++i)
    {
        const int x = i % columns * texels, y = i / columns * texels;
        _states.push_back(makeState(new osg::Viewport(x, y, texels, texels), reversed));
        _clears.push_back(makeClearing(new osg::Scissor(x, y, texels, texels)));
    }
    _states.resize(static_cast<std::size_t>(count));
}

/// Takes what the maps that stay would be drawn with out of the stage.
void ShadowMaps::leaveOut(const std::vector<bool>& changed)
{
    auto& graphs = _stage->getStateGraphList();
    const auto stays = [&](const osgUtil::StateGraph* graph)
    {
        for (; graph; graph = graph->_parent)
            for (std::size_t i = 0; i < changed.size(); ++i)
                if (!changed[i] && graph->getStateSet() == _states[i]) return true;
        return false;
    };
    graphs.erase(std::remove_if(graphs.begin(), graphs.end(), stays), graphs.end());
}

int ShadowMaps::draw(const ScenePass& pass, const ShadowCascades& cascades, int texels,
                     ShadowTexture& texture)
{
    const auto count = static_cast<int>(cascades.all().size());
    const int columns = ShadowTexture::columnsFor(count, texels, GpuLimits::of(pass.outer).textureSide);
    texture.resize(count, texels, columns);
    makeProgram(pass.prefix);
    makeStates(count, texels, columns, pass.depth.reversed());
    // From places in the map to clip coordinates.
    const osg::Matrixd toClip =
        osg::Matrixd::scale(2.0, 2.0, 2.0) * osg::Matrixd::translate(-1.0, -1.0, -1.0);
    for (std::size_t i = 0; i < _states.size(); ++i)
        _states[i]
            ->getOrCreateUniform(_prefix + "light", osg::Uniform::FLOAT_MAT4)
            ->set(osg::Matrixf(cascades.all()[i].toMap * toClip));

    if (!_stage) _stage = createStage();
    startStage(*_stage, pass.outer, pass.depth, osg::Vec4());
    _stage->setClearMask(0);
    _stage->setViewport(texture.viewport());
    _stage->setFrameBufferObject(texture.target());
    Casters casters(cascades, _states, osg::Matrixd::inverse(pass.view.modelView));
    ScenePass::Drawing drawing;
    drawing.program = _program;
    drawing.stage = _stage;
    drawing.filter = &casters;
    drawing.asksForTiles = false;
    pass.draw(drawing);

    const std::vector<bool> changed = texture.changes(pass, casters.found);
    std::vector<ScenePass::Piece> clearing;
    for (std::size_t i = 0; i < changed.size(); ++i)
        if (changed[i]) clearing.push_back({texture.clearing(), osg::Matrixd(), _clears[i]});
    if (clearing.empty()) return 0;
    leaveOut(changed);
    ScenePass::Drawing clears;
    clears.stage = _stage;
    pass.draw(clearing, clears);
    pass.outer.getCurrentRenderBin()->getStage()->addPreRenderStage(_stage, shadowOrder);
    return static_cast<int>(clearing.size());
}

void ShadowMaps::resizeGLObjectBuffers(unsigned int size)
{
    if (_program) _program->resizeGLObjectBuffers(size);
}

void ShadowMaps::releaseGLObjects(osg::State* state) const
{
    if (_program) _program->releaseGLObjects(state);
}

} // namespace osgGeoFX
