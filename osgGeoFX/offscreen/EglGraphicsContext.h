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

/** An off-screen OpenGL context over EGL that osgViewer uses like any other; it needs no X server.

    It draws into a pbuffer of the traits' size, which stays fixed, with the traits' colour, depth and stencil
    bits. `traits->samples` asks for multisampling; where the driver has no such configuration the next
    smaller count is taken, and the traits then tell the count in use. Without a version in the traits (OSG's
    default "1.0") the context is the newest desktop compatibility profile of the driver. A `sharedContext` must
    itself be an EglGraphicsContext; the new one then lives on the same display.

    `Platform::Auto` tries each hardware device that EGL enumerates (NVIDIA, Mesa), then Mesa's surfaceless
    platform, then software devices. `valid()` is false, and `error()` says why, where no context could be made.

    Threads: like any osg::GraphicsContext, current in one thread at a time; any of OSG's threading models. */
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
        /// Index among EGL's devices, as eglQueryDevicesEXT gives them; −1 takes the first that works.
        int device = -1;
        /// Makes a debug context that reports each message, synchronously, in the thread that draws.
        DebugCallback debugCallback;
    };

    explicit EglGraphicsContext(Traits* traits);
    EglGraphicsContext(Traits* traits, const Options& options);

    /// Why the context is not valid, as one sentence; empty if it is.
    const std::string& error() const { return _error; }

    /// Where the context lives, for people: "device 0" or "surfaceless".
    const std::string& platformName() const { return _platformName; }

    bool valid() const override;
    bool isRealizedImplementation() const override { return _realized; }
    bool realizeImplementation() override;
    void closeImplementation() override;
    bool makeCurrentImplementation() override;
    bool makeContextCurrentImplementation(osg::GraphicsContext* readContext) override;
    bool releaseContextImplementation() override;
    void swapBuffersImplementation() override;
    /// EGL binds no pbuffer to a desktop OpenGL texture; says so.
    void bindPBufferToTextureImplementation(GLenum buffer) override;
    /// The size is fixed; a change is refused with a warning.
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
