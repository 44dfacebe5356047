// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/offscreen/ImageCapture.h>

#include <osgGeoFX/offscreen/detail/DeepFrame.h>

#include <osg/GLExtensions>
#include <osg/RenderInfo>
#include <osg/State>

#include <chrono>

namespace osgGeoFX
{

namespace
{

/// Reads where the frame was drawn; drivers differ in what a pbuffer's read buffer is at first.
class ReadBuffer
{
public:
    ReadBuffer()
    {
        GLint drawBuffer = GL_BACK;
        glGetIntegerv(GL_DRAW_BUFFER, &drawBuffer);
        glGetIntegerv(GL_READ_BUFFER, &_previous);
        if (drawBuffer != GL_NONE) glReadBuffer(static_cast<GLenum>(drawBuffer));
    }
    ~ReadBuffer() { glReadBuffer(static_cast<GLenum>(_previous)); }
    ReadBuffer(const ReadBuffer&) = delete;
    ReadBuffer& operator=(const ReadBuffer&) = delete;

private:
    GLint _previous = GL_BACK;
};

/// A multisampled frame, resolved into a frame buffer object that is bound for reading in the object's lifetime.
/// (glReadPixels alone gives one of the samples in Mesa's llvmpipe.)
class ResolvedFrame
{
public:
    ResolvedFrame(const osg::GLExtensions& extensions, GLenum format, int x, int y, int width, int height)
        : _extensions(extensions), _x(x), _y(y)
    {
        GLint samples = 0;
        glGetIntegerv(GL_SAMPLES, &samples);
        if (samples < 2)
        {
            return;
        }
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &_drawBinding);
        glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &_readBinding);
        _extensions.glGenFramebuffers(1, &_frameBuffer);
        _extensions.glGenRenderbuffers(1, &_renderBuffer);
        _extensions.glBindRenderbuffer(GL_RENDERBUFFER, _renderBuffer);
        _extensions.glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
        _extensions.glBindRenderbuffer(GL_RENDERBUFFER, 0);
        _extensions.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, _frameBuffer);
        _extensions.glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                              _renderBuffer);
        _extensions.glBlitFramebuffer(x, y, x + width, y + height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                                      GL_NEAREST);
        _extensions.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(_drawBinding));
        _extensions.glBindFramebuffer(GL_READ_FRAMEBUFFER, _frameBuffer);
        _x = 0;
        _y = 0;
    }
    ~ResolvedFrame()
    {
        if (_frameBuffer == 0)
        {
            return;
        }
        _extensions.glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(_readBinding));
        _extensions.glDeleteFramebuffers(1, &_frameBuffer);
        _extensions.glDeleteRenderbuffers(1, &_renderBuffer);
    }
    ResolvedFrame(const ResolvedFrame&) = delete;
    ResolvedFrame& operator=(const ResolvedFrame&) = delete;

    int x() const { return _x; }
    int y() const { return _y; }

private:
    const osg::GLExtensions& _extensions;
    int _x;
    int _y;
    GLint _drawBinding = 0;
    GLint _readBinding = 0;
    GLuint _frameBuffer = 0;
    GLuint _renderBuffer = 0;
};

} // namespace

ImageCapture::ImageCapture(Format format) : _format(format) {}

osg::ref_ptr<ImageCapture> ImageCapture::attach(osg::Camera* camera, Format format)
{
    osg::ref_ptr<ImageCapture> capture = new ImageCapture(format);
    camera->addFinalDrawCallback(capture.get());
    return capture;
}

void ImageCapture::detach(osg::Camera* camera)
{
    const osg::ref_ptr<ImageCapture> keep(this);
    camera->removeFinalDrawCallback(this);
}

void ImageCapture::request()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _image = nullptr;
    _requested = true;
}

osg::ref_ptr<osg::Image> ImageCapture::take(double seconds)
{
    std::unique_lock<std::mutex> lock(_mutex);
    _captured.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return _image.valid(); });
    const osg::ref_ptr<osg::Image> image = _image;
    _image = nullptr;
    return image;
}

void ImageCapture::operator()(osg::RenderInfo& renderInfo) const
{
    const osg::Camera* camera = renderInfo.getCurrentCamera();
    const osg::Viewport* viewport = camera ? camera->getViewport() : nullptr;
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!_requested || !viewport)
    {
        return;
    }
    const osg::GLExtensions& extensions = *renderInfo.getState()->get<osg::GLExtensions>();
    // A pixel pack buffer that someone left bound would swallow the pixels.
    if (extensions.isPBOSupported) extensions.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, 0);
    const ReadBuffer readBuffer;
    const int x = static_cast<int>(viewport->x());
    const int y = static_cast<int>(viewport->y());
    const int width = static_cast<int>(viewport->width());
    const int height = static_cast<int>(viewport->height());
    _image = new osg::Image;
    if (_format == Format::DepthFloat)
    {
        _image->readPixels(x, y, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, 1);
    }
    else
    {
        const bool deep = _format == Format::Rgb16;
        const ResolvedFrame frame(extensions, deep ? DeepFrame::colorFormat : GL_RGBA8, x, y, width, height);
        _image->readPixels(frame.x(), frame.y(), width, height, _format == Format::Rgba ? GL_RGBA : GL_RGB,
                           deep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, 1);
    }
    _requested = false;
    _captured.notify_all();
}

} // namespace osgGeoFX
