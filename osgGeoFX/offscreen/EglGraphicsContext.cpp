// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/offscreen/EglGraphicsContext.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <osg/GLExtensions>
#include <osg/Notify>
#include <osg/State>

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <sstream>
#include <vector>

namespace osgGeoFX
{

namespace
{

std::string eglErrorText()
{
    std::ostringstream text;
    text << "EGL error 0x" << std::hex << eglGetError();
    return text.str();
}

bool hasExtension(const char* list, const char* name)
{
    return list && osg::isExtensionInExtensionString(name, list);
}

template<class Function>
Function eglFunction(const char* name)
{
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

struct Candidate
{
    std::string name;
    EGLenum platform;
    void* native;
};

void appendDevices(std::vector<Candidate>& candidates, bool software, int onlyDevice)
{
    const auto queryDevices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto queryString = eglFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    if (!queryDevices || !queryString)
    {
        return;
    }
    std::array<EGLDeviceEXT, 64> devices = {};
    EGLint count = 0;
    if (!queryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count))
    {
        return;
    }
    for (int i = 0; i < count; ++i)
    {
        EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
        const bool isSoftware = hasExtension(queryString(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
        if (onlyDevice >= 0 ? (i == onlyDevice && !software) : isSoftware == software)
        {
            candidates.push_back({"device " + std::to_string(i), EGL_PLATFORM_DEVICE_EXT, device});
        }
    }
}

std::vector<Candidate> findCandidates(const EglGraphicsContext::Options& options)
{
    using Platform = EglGraphicsContext::Platform;
    std::vector<Candidate> candidates;
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool devices =
        options.platform != Platform::Surfaceless && hasExtension(extensions, "EGL_EXT_platform_device");
    if (devices)
    {
        appendDevices(candidates, false, options.device);
    }
    if (options.platform != Platform::Device && hasExtension(extensions, "EGL_MESA_platform_surfaceless"))
    {
        candidates.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY});
    }
    if (devices)
    {
        appendDevices(candidates, true, options.device);
    }
    return candidates;
}

} // namespace

struct EglGraphicsContext::Egl
{
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLConfig config = nullptr;
    EGLContext context = EGL_NO_CONTEXT;
    EGLSurface surface = EGL_NO_SURFACE;

    ~Egl() { destroy(); }

    void destroy()
    {
        // The display is never terminated: it is one for the whole process, and others may be using it.
        if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
        if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
        surface = EGL_NO_SURFACE;
        context = EGL_NO_CONTEXT;
    }

    bool open(const Candidate& candidate, std::string& error)
    {
        const auto getDisplay = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
        display = getDisplay ? getDisplay(candidate.platform, candidate.native, nullptr) : EGL_NO_DISPLAY;
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
        {
            error = "no display, " + eglErrorText();
            return false;
        }
        return true;
    }

    EGLint attribute(EGLConfig which, EGLint name) const
    {
        EGLint value = 0;
        eglGetConfigAttrib(display, which, name, &value);
        return value;
    }

    // eglChooseConfig puts 10 bit colors before 8 bit ones; we want what was asked for.
    bool chooseConfig(const Traits& traits, unsigned int samples)
    {
        const EGLint wanted[] = {EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT,
                                 EGL_RENDERABLE_TYPE,
                                 EGL_OPENGL_BIT,
                                 EGL_RED_SIZE,
                                 static_cast<EGLint>(traits.red),
                                 EGL_GREEN_SIZE,
                                 static_cast<EGLint>(traits.green),
                                 EGL_BLUE_SIZE,
                                 static_cast<EGLint>(traits.blue),
                                 EGL_ALPHA_SIZE,
                                 static_cast<EGLint>(traits.alpha),
                                 EGL_DEPTH_SIZE,
                                 static_cast<EGLint>(traits.depth),
                                 EGL_STENCIL_SIZE,
                                 static_cast<EGLint>(traits.stencil),
                                 EGL_SAMPLES,
                                 static_cast<EGLint>(samples),
                                 EGL_NONE};
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted, nullptr, 0, &count) || count == 0)
        {
            return false;
        }
        std::vector<EGLConfig> configs(static_cast<std::size_t>(count));
        eglChooseConfig(display, wanted, configs.data(), count, &count);
        config = *std::min_element(configs.begin(), configs.end(),
                                   [&](EGLConfig a, EGLConfig b) { return excess(a) < excess(b); });
        return true;
    }

    // Everything beyond the request costs memory; samples cost most.
    int excess(EGLConfig which) const
    {
        return 1000 * attribute(which, EGL_SAMPLES) + 10 * attribute(which, EGL_BUFFER_SIZE) +
               attribute(which, EGL_DEPTH_SIZE) + attribute(which, EGL_STENCIL_SIZE);
    }

    bool createContext(const Traits& traits, EGLContext shared, bool debug, std::string& error)
    {
        std::vector<EGLint> attributes;
        unsigned int major = 1;
        unsigned int minor = 0;
        if (traits.getContextVersion(major, minor) && major > 1)
        {
            const bool core = (traits.glContextProfileMask & EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT) != 0;
            attributes = {EGL_CONTEXT_MAJOR_VERSION,
                          static_cast<EGLint>(major),
                          EGL_CONTEXT_MINOR_VERSION,
                          static_cast<EGLint>(minor),
                          EGL_CONTEXT_OPENGL_PROFILE_MASK,
                          core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT
                               : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT};
        }
        // OSG's glContextFlags are those of GLX: 1 debug, 2 forward compatible.
        if (debug || (traits.glContextFlags & 1u))
        {
            attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
        }
        if (traits.glContextFlags & 2u)
        {
            attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE, EGL_TRUE});
        }
        attributes.push_back(EGL_NONE);
        context = eglCreateContext(display, config, shared, attributes.data());
        if (context == EGL_NO_CONTEXT)
        {
            error = "no OpenGL context, " + eglErrorText();
            return false;
        }
        return true;
    }

    bool createSurface(const Traits& traits, std::string& error)
    {
        const EGLint attributes[] = {EGL_WIDTH, traits.width, EGL_HEIGHT, traits.height, EGL_NONE};
        surface = eglCreatePbufferSurface(display, config, attributes);
        if (surface == EGL_NO_SURFACE)
        {
            error = "no pbuffer of " + std::to_string(traits.width) + "x" + std::to_string(traits.height) +
                    " pixels, " + eglErrorText();
            return false;
        }
        return true;
    }

    bool create(Traits& traits, EGLContext shared, bool debug, std::string& error)
    {
        if (!eglBindAPI(EGL_OPENGL_API))
        {
            error = "no desktop OpenGL";
            return false;
        }
        unsigned int samples = traits.sampleBuffers || traits.samples > 1 ? std::max(traits.samples, 2u) : 0;
        while (!chooseConfig(traits, samples))
        {
            if (samples == 0)
            {
                error = "no pbuffer configuration with the wanted color and depth bits";
                return false;
            }
            samples = samples > 2 ? samples / 2 : 0;
        }
        if (!createContext(traits, shared, debug, error) || !createSurface(traits, error))
        {
            destroy();
            return false;
        }
        traits.samples = static_cast<unsigned int>(attribute(config, EGL_SAMPLES));
        traits.sampleBuffers = traits.samples > 0 ? 1 : 0;
        return true;
    }
};

EglGraphicsContext::EglGraphicsContext(Traits* traits) : EglGraphicsContext(traits, Options()) {}

EglGraphicsContext::EglGraphicsContext(Traits* traits, const Options& options)
    : _egl(std::make_unique<Egl>()), _debugCallback(options.debugCallback)
{
    _traits = traits;
    initialize(options);
    if (!valid())
    {
        return;
    }
    setState(new osg::State);
    getState()->setGraphicsContext(this);
    osg::ref_ptr<osg::GraphicsContext> shared;
    if (_traits->sharedContext.lock(shared))
    {
        getState()->setContextID(shared->getState()->getContextID());
        incrementContextIDUsageCount(getState()->getContextID());
    }
    else
    {
        getState()->setContextID(createNewContextID());
    }
}

EglGraphicsContext::~EglGraphicsContext()
{
    close(true);
}

void EglGraphicsContext::initialize(const Options& options)
{
    if (!_traits || _traits->width <= 0 || _traits->height <= 0)
    {
        _error = "An off-screen context needs traits with a width and a height above zero.";
        return;
    }
    // Two threads must not initialise one display at a time with every driver.
    static std::mutex mutex;
    const std::lock_guard<std::mutex> lock(mutex);

    std::string reasons;
    osg::ref_ptr<osg::GraphicsContext> shared;
    if (_traits->sharedContext.lock(shared))
    {
        const auto* other = dynamic_cast<const EglGraphicsContext*>(shared.get());
        if (!other || !other->valid())
        {
            _error = "An off-screen context can share objects with a valid EglGraphicsContext only.";
            return;
        }
        _egl->display = other->_egl->display;
        _platformName = other->_platformName;
        if (!_egl->create(*_traits, other->_egl->context, static_cast<bool>(_debugCallback), reasons))
        {
            _error = "No shared OpenGL context could be made through EGL (" + reasons + ").";
        }
        return;
    }
    for (const Candidate& candidate : findCandidates(options))
    {
        std::string reason;
        if (_egl->open(candidate, reason) &&
            _egl->create(*_traits, EGL_NO_CONTEXT, static_cast<bool>(_debugCallback), reason))
        {
            _platformName = candidate.name;
            return;
        }
        reasons += (reasons.empty() ? "" : "; ") + candidate.name + ": " + reason;
    }
    _error = "No OpenGL context could be made through EGL (" +
             (reasons.empty() ? std::string("the wanted platform or device does not exist here") : reasons) +
             "); install a driver, on Debian for example libegl-mesa0 and libgl1-mesa-dri.";
}

bool EglGraphicsContext::valid() const
{
    return _egl->context != EGL_NO_CONTEXT;
}

bool EglGraphicsContext::realizeImplementation()
{
    if (_realized)
    {
        return true;
    }
    if (!valid())
    {
        OSG_WARN << "osgGeoFX: " << _error << std::endl;
        return false;
    }
    _realized = true;
    if (_debugCallback && makeCurrentImplementation())
    {
        installDebugCallback();
        releaseContextImplementation();
    }
    return true;
}

void EglGraphicsContext::installDebugCallback()
{
    using Callback = void(GL_APIENTRY*)(GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*, const void*);
    using DebugMessageCallback = void(GL_APIENTRY*)(Callback, const void*);
    const auto setCallback = eglFunction<DebugMessageCallback>("glDebugMessageCallback");
    // Drivers give a context of the version that was asked for, and the extension with it.
    if (!setCallback ||
        !osg::isGLExtensionOrVersionSupported(getState()->getContextID(), "GL_KHR_debug", 4.3f))
    {
        OSG_WARN << "osgGeoFX: the OpenGL driver has no debug messages (it needs OpenGL 4.3 or GL_KHR_debug)."
                 << std::endl;
        return;
    }
    constexpr GLenum debugOutput = 0x92E0;
    constexpr GLenum debugOutputSynchronous = 0x8242;
    glEnable(debugOutput);
    glEnable(debugOutputSynchronous);
    setCallback(
        [](GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar* text,
           const void* self)
        {
            const std::string message =
                length < 0 ? std::string(text) : std::string(text, static_cast<std::size_t>(length));
            static_cast<const EglGraphicsContext*>(self)->_debugCallback(
                {source, type, id, severity, message});
        },
        this);
}

void EglGraphicsContext::closeImplementation()
{
    _egl->destroy();
    _realized = false;
}

bool EglGraphicsContext::makeCurrentImplementation()
{
    return makeContextCurrentImplementation(this);
}

bool EglGraphicsContext::makeContextCurrentImplementation(osg::GraphicsContext* readContext)
{
    const auto* read = dynamic_cast<const EglGraphicsContext*>(readContext);
    if (!_realized || !read || read->_egl->surface == EGL_NO_SURFACE)
    {
        OSG_WARN << "osgGeoFX: an off-screen context that is not realised cannot be made current."
                 << std::endl;
        return false;
    }
    // Which API is bound is a property of the thread, and is OpenGL ES at first.
    eglBindAPI(EGL_OPENGL_API);
    if (eglMakeCurrent(_egl->display, _egl->surface, read->_egl->surface, _egl->context))
    {
        return true;
    }
    OSG_WARN << "osgGeoFX: the off-screen context cannot be made current (" << eglErrorText() << ")."
             << std::endl;
    return false;
}

bool EglGraphicsContext::releaseContextImplementation()
{
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(_egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT) == EGL_TRUE;
}

void EglGraphicsContext::swapBuffersImplementation()
{
    // A pbuffer has nothing to swap; this ends the frame for the driver.
    if (_realized) eglSwapBuffers(_egl->display, _egl->surface);
}

void EglGraphicsContext::bindPBufferToTextureImplementation(GLenum)
{
    OSG_WARN << "osgGeoFX: an off-screen EGL context cannot be bound as a texture; use a frame buffer object."
             << std::endl;
}

void EglGraphicsContext::resizedImplementation(int x, int y, int width, int height)
{
    if (width != _traits->width || height != _traits->height)
    {
        OSG_WARN << "osgGeoFX: an off-screen context keeps its size of " << _traits->width << "x"
                 << _traits->height << " pixels; make a new one of " << width << "x" << height << "."
                 << std::endl;
        return;
    }
    osg::GraphicsContext::resizedImplementation(x, y, width, height);
}

} // namespace osgGeoFX
