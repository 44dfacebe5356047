// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/ShadowTexture.h>

#include <osg/State>

#include <algorithm>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// OSG has two frames on their way, and two eyes at most.
constexpr std::size_t mostFrames = 8;

} // namespace

/// Clears the part of the target that its state's scissors leave, and counts how often.
class ShadowTexture::Clearing : public osg::Drawable
{
public:
    Clearing()
    {
        setUseDisplayList(false);
        setCullingActive(false);
    }
    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    const char* className() const override { return "ShadowTexture::Clearing"; }
    const char* libraryName() const override { return "osgGeoFX"; }

    void drawImplementation(osg::RenderInfo&) const override
    {
        glClearDepth(1.0);
        glClear(GL_DEPTH_BUFFER_BIT);
        ++_count;
    }
    std::uint64_t count() const { return _count; }

protected:
    ~Clearing() override = default;

private:
    mutable std::atomic<std::uint64_t> _count{0};
};

ShadowTexture::ShadowTexture() = default;

ShadowTexture::~ShadowTexture() = default;

osg::ref_ptr<osg::Texture2D> ShadowTexture::makeTexture(int width, int height)
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

osg::Drawable* ShadowTexture::clearing() const
{
    return _clearing;
}

void ShadowTexture::resize(int count, int texels, int columns)
{
    if (_texture && count == _count && texels == _texels && columns == _columns) return;
    _count = count;
    _texels = texels;
    _columns = columns;
    const int width = columns * texels, height = (count + columns - 1) / columns * texels;
    _texture = makeTexture(width, height);
    _target = new osg::FrameBufferObject;
    _target->setAttachment(osg::Camera::DEPTH_BUFFER, osg::FrameBufferAttachment(_texture));
    _viewport = new osg::Viewport(0, 0, width, height);
    // Frames on their way draw into the former one, and count there.
    _clearing = new Clearing;
    _lost = true;
}

/// Whether the texture has all that was to be drawn into it, or will have it when this frame is drawn.
bool ShadowTexture::holds(const ScenePass& pass)
{
    // Where the visitor of a frame begins another one, the frame has been drawn, and so have those before it.
    const auto drawn = std::find_if(_frames.rbegin(), _frames.rend(),
                                    [&](const Frame& each)
                                    { return each.visitor == &pass.outer && each.frame != pass.frame; });
    if (drawn != _frames.rend())
    {
        _certain = drawn->maps;
        _frames.erase(_frames.begin(), drawn.base());
    }
    const osg::State* const state = pass.outer.getState();
    const std::uint64_t count = _clearing->count();
    return !_lost && count >= _certain && count <= _expected && state && state->getContextID() == _context;
}

std::vector<bool> ShadowTexture::changes(const ScenePass& pass, std::vector<ShadowCasters>& casters)
{
    const bool known = holds(pass) && _casters.size() == casters.size();
    std::vector<bool> changed(casters.size(), true);
    for (std::size_t i = 0; i < casters.size(); ++i)
        changed[i] = !known || !casters[i].same(_casters[i]);
    if (!known)
    {
        _casters.resize(casters.size());
        _frames.clear();
        _certain = _expected = _clearing->count();
        _context = pass.outer.getState() ? pass.outer.getState()->getContextID() : 0;
        _lost = false;
    }
    // A map that stays was drawn with what is remembered; small differences must not add up.
    for (std::size_t i = 0; i < casters.size(); ++i)
        if (changed[i]) _casters[i] = std::move(casters[i]);
    const auto maps = std::count(changed.begin(), changed.end(), true);
    if (maps == 0) return changed;
    _expected += static_cast<std::uint64_t>(maps);
    _frames.push_back({&pass.outer, pass.frame, _expected});
    if (_frames.size() > mostFrames) _frames.pop_front();
    return changed;
}

void ShadowTexture::resizeGLObjectBuffers(unsigned int size)
{
    if (_texture) _texture->resizeGLObjectBuffers(size);
    if (_target) _target->resizeGLObjectBuffers(size);
}

void ShadowTexture::releaseGLObjects(osg::State* state) const
{
    // What was drawn is lost.
    _lost = true;
    if (_texture) _texture->releaseGLObjects(state);
    if (_target) _target->releaseGLObjects(state);
}

} // namespace osgGeoFX
