// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/offscreen/detail/DeepFrame.h>

#include <osg/GLExtensions>
#include <osg/State>

#include <algorithm>

namespace osgGeoFX
{

DeepFrame::DeepFrame(int width, int height, unsigned int samples)
    : osg::Operation("DeepFrame", false), _width(width), _height(height), _samples(samples)
{
}

void DeepFrame::operator()(osg::Object* context)
{
    auto* const graphics = dynamic_cast<osg::GraphicsContext*>(context);
    if (!graphics) return;
    const osg::GLExtensions& gl = *graphics->getState()->get<osg::GLExtensions>();
    if (!gl.isFrameBufferObjectSupported) return;
    GLint most = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    const GLsizei samples = _samples > 1 ? std::min(static_cast<GLint>(_samples), most) : 0;
    GLuint frame = 0;
    GLuint buffers[2] = {};
    gl.glGenFramebuffers(1, &frame);
    gl.glGenRenderbuffers(2, buffers);
    gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, frame);
    const auto attach = [&](GLuint buffer, GLenum format, GLenum place)
    {
        gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, buffer);
        gl.glRenderbufferStorageMultisample(GL_RENDERBUFFER_EXT, samples, format, _width, _height);
        gl.glFramebufferRenderbuffer(GL_FRAMEBUFFER_EXT, place, GL_RENDERBUFFER_EXT, buffer);
    };
    attach(buffers[0], colorFormat, GL_COLOR_ATTACHMENT0_EXT);
    attach(buffers[1], GL_DEPTH24_STENCIL8_EXT, GL_DEPTH_STENCIL_ATTACHMENT);
    gl.glBindRenderbuffer(GL_RENDERBUFFER_EXT, 0);
    if (gl.glCheckFramebufferStatus(GL_FRAMEBUFFER_EXT) != GL_FRAMEBUFFER_COMPLETE_EXT)
    {
        gl.glBindFramebuffer(GL_FRAMEBUFFER_EXT, 0);
        gl.glDeleteFramebuffers(1, &frame);
        gl.glDeleteRenderbuffers(2, buffers);
        return;
    }
    // It lives as long as the context. What draws into another one comes back to it.
    graphics->setDefaultFboId(frame);
    _there = true;
}

} // namespace osgGeoFX
