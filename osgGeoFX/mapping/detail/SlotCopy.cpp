// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/SlotCopy.h>

namespace osgGeoFX
{

namespace
{

constexpr GLenum readFramebuffer = 0x8CA8;
constexpr GLenum drawFramebuffer = 0x8CA9;
constexpr GLenum readBinding = 0x8CAA;
constexpr GLenum drawBinding = 0x8CA6;
constexpr GLenum colorAttachment = 0x8CE0;

} // namespace

SlotCopy::SlotCopy(const osg::GLExtensions& gl) : _gl(gl)
{
    glGetIntegerv(readBinding, &_read);
    glGetIntegerv(drawBinding, &_drawn);
    // Of the state that copies between frame buffers go by: these textures have no sRGB format.
    _scissor = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
    if (_scissor) glDisable(GL_SCISSOR_TEST);
    _gl.glGenFramebuffers(2, _buffers);
    _gl.glBindFramebuffer(readFramebuffer, _buffers[0]);
    _gl.glBindFramebuffer(drawFramebuffer, _buffers[1]);
}

SlotCopy::~SlotCopy()
{
    _gl.glBindFramebuffer(readFramebuffer, static_cast<GLuint>(_read));
    _gl.glBindFramebuffer(drawFramebuffer, static_cast<GLuint>(_drawn));
    _gl.glDeleteFramebuffers(2, _buffers);
    if (_scissor) glEnable(GL_SCISSOR_TEST);
}

void SlotCopy::blit(const Box& from, const Box& to, unsigned int filter) const
{
    if (to.x0 >= to.x1 || to.y0 >= to.y1) return;
    _gl.glBlitFramebuffer(from.x0, from.y0, from.x1, from.y1, to.x0, to.y0, to.x1, to.y1, GL_COLOR_BUFFER_BIT,
                          filter);
}

void SlotCopy::copy(unsigned int texture, int width, int height, unsigned int array,
                    const LayerAtlas::Slot& slot) const
{
    _gl.glFramebufferTexture2D(readFramebuffer, colorAttachment, GL_TEXTURE_2D, texture, 0);
    _gl.glFramebufferTextureLayer(drawFramebuffer, colorAttachment, array, 0, slot.page);
    const int x = slot.x, y = slot.y, side = slot.side, right = x + width, top = y + height;
    blit({0, 0, width, height}, {x, y, right, top}, GL_NEAREST);
    blit({width - 1, 0, width, height}, {right, y, x + side, top}, GL_NEAREST);
    blit({0, height - 1, width, height}, {x, top, right, y + side}, GL_NEAREST);
    blit({width - 1, height - 1, width, height}, {right, top, x + side, y + side}, GL_NEAREST);
    // Between four texels, a linear filter gives their mean.
    for (int level = 1; side >> level > 0; ++level)
    {
        _gl.glFramebufferTextureLayer(readFramebuffer, colorAttachment, array, level - 1, slot.page);
        _gl.glFramebufferTextureLayer(drawFramebuffer, colorAttachment, array, level, slot.page);
        const auto box = [&](int at)
        {
            return Box{x >> at, y >> at, (x >> at) + (side >> at), (y >> at) + (side >> at)};
        };
        blit(box(level - 1), box(level), GL_LINEAR);
    }
}

} // namespace osgGeoFX
