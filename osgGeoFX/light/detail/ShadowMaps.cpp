// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/ShadowMaps.h>

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/PassFilter.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/PassStage.h>

#include <osg/ClipControl>
#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/PolygonMode>
#include <osg/Scissor>

#include <algorithm>
#include <atomic>
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

} // namespace

/// Clears the part of the target that its state's scissors leave, and counts how often.
class ShadowMaps::Clearing : public osg::Drawable
{
public:
    Clearing()
    {
        setUseDisplayList(false);
        setCullingActive(false);
    }
    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    const char* className() const override { return "ShadowMaps::Clearing"; }
    const char* libraryName() const override { return "osgGeoFX"; }

    void drawImplementation(osg::RenderInfo&) const override
    {
        glClearDepth(1.0);
        glClear(GL_DEPTH_BUFFER_BIT);
        ++_count;
    }
    unsigned int count() const { return _count; }

protected:
    ~Clearing() override = default;

private:
    mutable std::atomic<unsigned int> _count{0};
};

ShadowMaps::ShadowMaps() : _clearing(new Clearing) {}

ShadowMaps::~ShadowMaps() = default;

osg::ref_ptr<osg::Texture2D> ShadowMaps::makeTexture(int width, int height)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(width, height);
    texture->setInternalFormat(GL_DEPTH_COMPONENT24);
    texture->setSourceFormat(GL_DEPTH_COMPONENT);
    texture->setSourceType(GL_UNSIGNED_INT);
    texture->setShadowComparison(true);
    texture->setShadowCompareFunc(osg::Texture::LEQUAL);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

void ShadowMaps::resize(int count, int texels)
{
    if (_texture && count == _count && texels == _texels) return;
    _count = count;
    _texels = texels;
    _states.clear();
    _clears.clear();
    _casters.clear();
    constexpr auto on =
        osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    for (int i = 0; i < count; ++i)
    {
        const osg::ref_ptr<osg::StateSet> clear = new osg::StateSet;
        clear->setAttributeAndModes(
            new osg::Scissor(i % columns * texels, i / columns * texels, texels, texels), on);
        clear->setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, true), on);
        // Before all that is drawn.
        clear->setRenderBinDetails(-1, "RenderBin", osg::StateSet::OVERRIDE_PROTECTED_RENDERBIN_DETAILS);
        _clears.push_back(clear);
    }
    const int width = columns * texels, height = rows(count) * texels;
    _texture = makeTexture(width, height);
    _target = new osg::FrameBufferObject;
    _target->setAttachment(osg::Camera::DEPTH_BUFFER, osg::FrameBufferAttachment(_texture));
    _viewport = new osg::Viewport(0, 0, width, height);
}

void ShadowMaps::makeProgram(const std::string& prefix)
{
    if (_program && _prefix == prefix) return;
    _prefix = prefix;
    _states.clear();
    _casters.clear();
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

/// Whether the texture has all that was to be drawn into it.
bool ShadowMaps::holds(const ScenePass& pass) const
{
    const osg::State* const state = pass.outer.getState();
    return _clearing->count() == _expected && state && state->getContextID() == _context;
}

/// Which maps must be drawn. What stands in them is remembered.
std::vector<bool> ShadowMaps::changes(const ScenePass& pass, std::vector<ShadowCasters>& casters)
{
    const bool known = _casters.size() == casters.size() && holds(pass);
    std::vector<bool> changed(casters.size(), true);
    for (std::size_t i = 0; i < casters.size(); ++i)
        changed[i] = !known || !casters[i].same(_casters[i]);
    if (!known) _casters.resize(casters.size());
    // A map that stays was drawn with what is remembered; small differences must not add up.
    for (std::size_t i = 0; i < casters.size(); ++i)
        if (changed[i]) _casters[i] = std::move(casters[i]);
    return changed;
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

int ShadowMaps::draw(const ScenePass& pass, const ShadowCascades& cascades, int texels)
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
    _stage->setClearMask(0);
    _stage->setViewport(_viewport);
    _stage->setFrameBufferObject(_target);
    Casters casters(cascades, _states, osg::Matrixd::inverse(pass.view.modelView));
    ScenePass::Drawing drawing;
    drawing.program = _program;
    drawing.stage = _stage;
    drawing.filter = &casters;
    drawing.asksForTiles = false;
    pass.draw(drawing);

    const std::vector<bool> changed = changes(pass, casters.found);
    std::vector<ScenePass::Piece> clearing;
    for (std::size_t i = 0; i < changed.size(); ++i)
        if (changed[i]) clearing.push_back({_clearing, osg::Matrixd(), _clears[i]});
    if (clearing.empty()) return 0;
    leaveOut(changed);
    ScenePass::Drawing clears;
    clears.stage = _stage;
    pass.draw(clearing, clears);
    pass.outer.getCurrentRenderBin()->getStage()->addPreRenderStage(_stage, shadowOrder);
    _expected = _clearing->count() + static_cast<unsigned int>(clearing.size());
    _context = pass.outer.getState() ? pass.outer.getState()->getContextID() : 0;
    return static_cast<int>(clearing.size());
}

void ShadowMaps::resizeGLObjectBuffers(unsigned int size)
{
    if (_texture) _texture->resizeGLObjectBuffers(size);
    if (_target) _target->resizeGLObjectBuffers(size);
    if (_program) _program->resizeGLObjectBuffers(size);
}

void ShadowMaps::releaseGLObjects(osg::State* state) const
{
    // What was drawn is lost.
    _expected = _clearing->count() - 1;
    if (_texture) _texture->releaseGLObjects(state);
    if (_target) _target->releaseGLObjects(state);
    if (_program) _program->releaseGLObjects(state);
}

} // namespace osgGeoFX
