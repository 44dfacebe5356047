// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Camera>
#include <osg/Image>

#include <condition_variable>
#include <mutex>

namespace osgGeoFX
{

/** Reads a camera's finished frame from its graphics context into an image.

    It is one of the camera's final draw callbacks, which run before the buffers are swapped, and it replaces no other
    callback. The camera must draw into the context's own framebuffer. (A camera that draws into a framebuffer object
    attaches an image instead.) The image covers the camera's viewport. Its first row is the lowest, as in OpenGL and
    OSG. Colors of multisampled frames are resolved. Depth is window depth, 0…1.

    Threads: any thread may call all methods. The reading happens in the drawing thread. One capture serves one
    camera.
    @ingroup offscreen */
class OSGGEOFX_EXPORT ImageCapture : public osg::Camera::DrawCallback
{
public:
    enum class Format
    {
        Rgb,       ///< 8 bits per channel
        Rgba,      ///< 8 bits per channel
        Rgb16,     ///< 16 bits per channel; for a frame buffer that has them
        DepthFloat ///< one float, 0…1
    };

    /// Makes a capture and appends it to the camera's final draw callbacks.
    static osg::ref_ptr<ImageCapture> attach(osg::Camera* camera, Format format = Format::Rgb);

    explicit ImageCapture(Format format = Format::Rgb);

    /// Removes this capture from the camera's callbacks. Do not call it while a frame is drawn.
    void detach(osg::Camera* camera);

    /// Requests the next frame that is drawn. Frames without a request cost nothing.
    void request();

    /// Waits for the requested image, at most `seconds`; null if none was drawn by then. Each request gives one image.
    osg::ref_ptr<osg::Image> take(double seconds = 60.0);

    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo& renderInfo) const override;

    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "ImageCapture"; }

protected:
    ~ImageCapture() override = default;

private:
    const Format _format;
    mutable std::mutex _mutex;
    mutable std::condition_variable _captured;
    mutable bool _requested = false;
    mutable osg::ref_ptr<osg::Image> _image;
};

} // namespace osgGeoFX
