// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/DepthReader.h>

#include <osg/Depth>
#include <osg/FrameStamp>
#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/RenderInfo>
#include <osg/State>
#include <osg/observer_ptr>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr GLenum clipDepthMode = 0x935D, zeroToOneMode = 0x935F;

/// A frame that is being read into a buffer.
struct Reading
{
    GLuint buffer = 0;
    GLsizeiptr bytes = 0;
    std::shared_ptr<DepthPicture> picture; ///< null: nothing is under way
};

struct ContextObjects
{
    std::map<const osg::Camera*, Reading> readings;
    GLuint frameBuffer = 0; ///< into which multisampled depths are resolved
    GLuint renderBuffer = 0;
    GLenum format = 0;
    int width = 0;
    int height = 0;
    bool unresolvable = false;
};

/// Formats of depth buffers, one of which a multisampled target must have to be resolved.
constexpr GLenum formats[] = {GL_DEPTH24_STENCIL8_EXT, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F,
                              GL_DEPTH32F_STENCIL8,    GL_DEPTH_COMPONENT32, GL_DEPTH_COMPONENT16};

void clearErrors()
{
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i)
    {
    }
}

/// Binds, in its lifetime, what depths can be read from.
class Readable
{
public:
    Readable(const osg::GLExtensions& extensions, ContextObjects& objects, const osg::Viewport& port)
        : _extensions(extensions), _x(static_cast<int>(port.x())), _y(static_cast<int>(port.y()))
    {
        GLint samples = 0;
        glGetIntegerv(GL_SAMPLES, &samples);
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &_draw);
        glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &_read);
        if (samples < 2)
        {
            if (_read != _draw) extensions.glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(_draw));
            return;
        }
        const int width = static_cast<int>(port.width()), height = static_cast<int>(port.height());
        if (!objects.frameBuffer) extensions.glGenFramebuffers(1, &objects.frameBuffer);
        if (!objects.renderBuffer) extensions.glGenRenderbuffers(1, &objects.renderBuffer);
        extensions.glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(_draw));
        extensions.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, objects.frameBuffer);
        clearErrors();
        bool done = false;
        // Most often the format is that of the last frame.
        std::vector<GLenum> tried;
        if (objects.format) tried.push_back(objects.format);
        tried.insert(tried.end(), std::begin(formats), std::end(formats));
        for (const GLenum format : tried)
        {
            if (width != objects.width || height != objects.height || format != objects.format)
            {
                objects.format = format;
                objects.width = width;
                objects.height = height;
                extensions.glBindRenderbuffer(GL_RENDERBUFFER, objects.renderBuffer);
                extensions.glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
                extensions.glBindRenderbuffer(GL_RENDERBUFFER, 0);
                const bool stencil = format == GL_DEPTH24_STENCIL8_EXT || format == GL_DEPTH32F_STENCIL8;
                extensions.glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
                                                     GL_RENDERBUFFER, objects.renderBuffer);
                extensions.glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_STENCIL_ATTACHMENT,
                                                     GL_RENDERBUFFER, stencil ? objects.renderBuffer : 0);
            }
            extensions.glBlitFramebuffer(_x, _y, _x + width, _y + height, 0, 0, width, height,
                                         GL_DEPTH_BUFFER_BIT, GL_NEAREST);
            done = glGetError() == GL_NO_ERROR;
            if (done) break;
        }
        extensions.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(_draw));
        clearErrors();
        if (!done)
        {
            if (!std::exchange(objects.unresolvable, true))
                OSG_WARN << "osgGeoFX: DepthReader cannot resolve the depths of a multisampled target, so "
                            "nothing counts as "
                            "hidden; draw without multisampling."
                         << std::endl;
            return;
        }
        extensions.glBindFramebuffer(GL_READ_FRAMEBUFFER, objects.frameBuffer);
        _x = _y = 0;
    }
    ~Readable() { _extensions.glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(_read)); }
    Readable(const Readable&) = delete;
    Readable& operator=(const Readable&) = delete;

    int x() const { return _x; }
    int y() const { return _y; }

private:
    const osg::GLExtensions& _extensions;
    int _x;
    int _y;
    GLint _draw = 0;
    GLint _read = 0;
};

} // namespace

bool DepthPicture::shows(const osg::Vec3d& eye, int around, double tolerance) const
{
    const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * projection;
    if (!(clip.w() > 0.0) || width < 1 || height < 1) return false;
    const double x = 0.5 * (clip.x() / clip.w() + 1.0) * width,
                 y = 0.5 * (clip.y() / clip.w() + 1.0) * height;
    if (!(x >= 0.0 && y >= 0.0 && x < width && y < height)) return false;
    if (depths.empty()) return true;
    // A little nearer to the eye along its ray; without a perspective, along the axis.
    const bool perspective = projection(3, 3) == 0.0;
    const osg::Vec3d nearer =
        perspective ? eye * (1.0 - tolerance) : eye - osg::Vec3d(0.0, 0.0, eye.z()) * tolerance;
    const osg::Vec4d moved = osg::Vec4d(nearer, 1.0) * projection;
    const CameraDepth kind(convention, projection);
    double depth = 0.0;
    if (kind.logarithmic())
        depth = kind.logarithmicDepth(moved.w());
    else
        depth = zeroToOne ? moved.z() / moved.w() : 0.5 * (moved.z() / moved.w() + 1.0);
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    for (int j = std::max(row - around, 0); j <= std::min(row + around, height - 1); ++j)
    {
        for (int i = std::max(column - around, 0); i <= std::min(column + around, width - 1); ++i)
        {
            const auto drawn =
                static_cast<double>(depths[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                           static_cast<std::size_t>(i)]);
            if (kind.reversed() ? drawn <= depth : drawn >= depth) return true;
        }
    }
    return false;
}

struct DepthReader::Shared
{
    mutable std::mutex mutex;
    std::map<const osg::Camera*,
             std::pair<osg::observer_ptr<const osg::Camera>, std::shared_ptr<const DepthPicture>>>
        newest;
    std::map<unsigned int, ContextObjects> contexts; ///< by OSG's context id

    void publish(const osg::Camera& camera, std::shared_ptr<const DepthPicture> picture)
    {
        const std::lock_guard<std::mutex> lock(mutex);
        for (auto entry = newest.begin(); entry != newest.end();)
            entry = entry->second.first.valid() ? std::next(entry) : newest.erase(entry);
        newest[&camera] = {&camera, std::move(picture)};
    }
    ContextObjects& objectsOf(unsigned int context)
    {
        const std::lock_guard<std::mutex> lock(mutex);
        return contexts[context];
    }
};

DepthReader::DepthReader() : _shared(std::make_unique<Shared>())
{
    setCullingActive(false);
    setUseDisplayList(false);
    // When all else of the stage has been drawn, whatever bin the reader's parents are in.
    getOrCreateStateSet()->setRenderBinDetails(900000, "RenderBin",
                                               osg::StateSet::PROTECTED_RENDERBIN_DETAILS);
    getStateSet()->setNestRenderBins(false);
}

DepthReader::~DepthReader() = default;

void DepthReader::setInterval(unsigned int frames)
{
    _interval = std::clamp(frames, 1u, 1000u);
}

std::shared_ptr<const DepthPicture> DepthReader::picture(const osg::Camera& camera) const
{
    const std::lock_guard<std::mutex> lock(_shared->mutex);
    const auto found = _shared->newest.find(&camera);
    return found == _shared->newest.end() ? nullptr : found->second.second;
}

std::vector<std::shared_ptr<const DepthPicture>> DepthReader::pictures() const
{
    const std::lock_guard<std::mutex> lock(_shared->mutex);
    std::vector<std::shared_ptr<const DepthPicture>> all;
    for (const auto& [key, entry] : _shared->newest)
        if (entry.first.valid()) all.push_back(entry.second);
    return all;
}

void DepthReader::drawImplementation(osg::RenderInfo& renderInfo) const
{
    const osg::Camera* const camera = renderInfo.getCurrentCamera();
    const osg::Viewport* const port = camera ? camera->getViewport() : nullptr;
    if (!port || port->width() < 1.0 || port->height() < 1.0) return;
    osg::State& state = *renderInfo.getState();
    const osg::GLExtensions& extensions = *state.get<osg::GLExtensions>();
    ContextObjects& objects = _shared->objectsOf(state.getContextID());
    Reading& reading = objects.readings[camera];
    const auto finish = [&]
    {
        if (!reading.picture) return;
        extensions.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, reading.buffer);
        if (const void* const data = extensions.glMapBuffer(GL_PIXEL_PACK_BUFFER_ARB, GL_READ_ONLY_ARB))
        {
            std::memcpy(reading.picture->depths.data(), data, reading.picture->depths.size() * sizeof(float));
            extensions.glUnmapBuffer(GL_PIXEL_PACK_BUFFER_ARB);
            _shared->publish(*camera, std::move(reading.picture));
        }
        reading.picture = nullptr;
        extensions.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, 0);
    };
    finish();
    const unsigned int frame = state.getFrameStamp() ? state.getFrameStamp()->getFrameNumber() : 0;
    if (frame % _interval != 0) return;

    auto picture = std::make_shared<DepthPicture>();
    picture->frame = frame;
    picture->width = static_cast<int>(port->width());
    picture->height = static_cast<int>(port->height());
    picture->view = state.getModelViewMatrix();
    picture->projection = state.getProjectionMatrix();
    picture->convention = _convention;
    if (extensions.glClipControl)
    {
        GLint mode = 0;
        glGetIntegerv(clipDepthMode, &mode);
        picture->zeroToOne = static_cast<GLenum>(mode) == zeroToOneMode;
    }
    picture->depths.resize(static_cast<std::size_t>(picture->width) *
                           static_cast<std::size_t>(picture->height));
    const auto bytes = static_cast<GLsizeiptr>(picture->depths.size() * sizeof(float));
    const Readable readable(extensions, objects, *port);
    if (objects.unresolvable)
    {
        picture->depths.clear();
        _shared->publish(*camera, std::move(picture));
        return;
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    const bool buffered = extensions.isPBOSupported && !_immediate;
    if (extensions.isPBOSupported && !buffered) extensions.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, 0);
    if (!buffered)
    {
        glReadPixels(readable.x(), readable.y(), picture->width, picture->height, GL_DEPTH_COMPONENT,
                     GL_FLOAT, picture->depths.data());
        _shared->publish(*camera, std::move(picture));
        return;
    }
    if (!reading.buffer) extensions.glGenBuffers(1, &reading.buffer);
    extensions.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, reading.buffer);
    if (reading.bytes != bytes)
    {
        extensions.glBufferData(GL_PIXEL_PACK_BUFFER_ARB, bytes, nullptr, GL_STREAM_READ_ARB);
        reading.bytes = bytes;
    }
    glReadPixels(readable.x(), readable.y(), picture->width, picture->height, GL_DEPTH_COMPONENT, GL_FLOAT,
                 nullptr);
    extensions.glBindBuffer(GL_PIXEL_PACK_BUFFER_ARB, 0);
    reading.picture = std::move(picture);
}

void DepthReader::releaseGLObjects(osg::State* state) const
{
    osg::Drawable::releaseGLObjects(state);
    const std::lock_guard<std::mutex> lock(_shared->mutex);
    const auto release = [](ContextObjects& objects, const osg::GLExtensions& extensions)
    {
        for (auto& [camera, reading] : objects.readings)
            if (reading.buffer) extensions.glDeleteBuffers(1, &reading.buffer);
        if (objects.frameBuffer) extensions.glDeleteFramebuffers(1, &objects.frameBuffer);
        if (objects.renderBuffer) extensions.glDeleteRenderbuffers(1, &objects.renderBuffer);
    };
    if (!state)
    {
        // Without a context nothing can be deleted; the objects go with theirs.
        _shared->contexts.clear();
        return;
    }
    const auto found = _shared->contexts.find(state->getContextID());
    if (found == _shared->contexts.end()) return;
    release(found->second, *state->get<osg::GLExtensions>());
    _shared->contexts.erase(found);
}

} // namespace osgGeoFX
