// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/GraphicsContext>

#include <functional>
#include <memory>
#include <string>

namespace osgGeoFX
{

/** An off-screen OpenGL context over EGL that osgViewer uses like any other context. It needs no X server.

    It draws into a pbuffer of the traits' size, which is fixed, with the traits' color, depth and stencil bits.
    `traits->samples` requests multisampling; if the driver has no such configuration, the count is halved until one
    fits, and the traits are set to the count in use. If the traits name no version (OSG's default "1.0"), the context
    is the driver's newest desktop compatibility profile. A `sharedContext` must be a valid EglGraphicsContext; the new
    context then uses the same EGL display.

    `Platform::Auto` tries each hardware device that EGL lists (NVIDIA, Mesa), then Mesa's surfaceless platform, then
    the software devices. If no context can be made, `valid()` is false and `error()` says why.

    Threads: like any osg::GraphicsContext, it is current in one thread at a time. All threading models of OSG work.
    @ingroup offscreen */
class OSGGEOFX_EXPORT EglGraphicsContext : public osg::GraphicsContext
{
public:
    enum class Platform
    {
        Auto,
        Device,     ///< EGL_EXT_platform_device
        Surfaceless ///< EGL_MESA_platform_surfaceless
    };

    /// A message of GL_KHR_debug, with OpenGL's own constants.
    struct DebugMessage
    {
        GLenum source;
        GLenum type;
        GLuint id;
        GLenum severity;
        std::string text;
    };
    using DebugCallback = std::function<void(const DebugMessage&)>;

    struct Options
    {
        Platform platform = Platform::Auto;
        /// Index of the EGL device in the order of eglQueryDevicesEXT; −1 takes the first device that works.
        int device = -1;
        /// If set, the context is a debug context (OpenGL 4.3) that calls it for each message, at once, in the drawing
        /// thread.
        DebugCallback debugCallback;
    };

    explicit EglGraphicsContext(Traits* traits);
    EglGraphicsContext(Traits* traits, const Options& options);

    /// Why the context is not valid, as one sentence; empty if it is valid.
    const std::string& error() const { return _error; }

    /// The platform in use, as text for people: "device 0" or "surfaceless".
    const std::string& platformName() const { return _platformName; }

    bool valid() const override;
    bool isRealizedImplementation() const override { return _realized; }
    bool realizeImplementation() override;
    void closeImplementation() override;
    bool makeCurrentImplementation() override;
    bool makeContextCurrentImplementation(osg::GraphicsContext* readContext) override;
    bool releaseContextImplementation() override;
    void swapBuffersImplementation() override;
    /// Only warns: EGL cannot bind a pbuffer to a texture of desktop OpenGL.
    void bindPBufferToTextureImplementation(GLenum buffer) override;
    /// Refuses any change of size, with a warning.
    void resizedImplementation(int x, int y, int width, int height) override;

    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "EglGraphicsContext"; }

protected:
    ~EglGraphicsContext() override;

private:
    struct Egl;

    void initialize(const Options& options);
    void installDebugCallback();

    std::unique_ptr<Egl> _egl;
    DebugCallback _debugCallback;
    std::string _error;
    std::string _platformName;
    bool _realized = false;
};

} // namespace osgGeoFX
