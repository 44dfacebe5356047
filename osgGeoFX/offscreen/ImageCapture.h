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

    It hangs on the camera's chain of final draw callbacks, before the buffers are swapped, and never replaces
    another one's callback. The camera must draw to the context's own frame buffer (a camera that draws to a
    frame buffer object attaches an image instead). The image is the camera's viewport, its first row the
    lowest, as OpenGL and OSG have it; multisampled frames are resolved. Depth is window depth, 0…1.

    Threads: all methods may be called from any thread; the reading itself happens in the one that draws. One
    capture serves one camera. */
class OSGGEOFX_EXPORT ImageCapture : public osg::Camera::DrawCallback
{
public:
    enum class Format
    {
        Rgb,       ///< 8 bits per channel
        Rgba,      ///< 8 bits per channel
        DepthFloat ///< one float
    };

    /// Makes a capture and appends it to the camera's final draw callbacks.
    static osg::ref_ptr<ImageCapture> attach(osg::Camera* camera, Format format = Format::Rgb);

    explicit ImageCapture(Format format = Format::Rgb);

    /// Takes it off the camera's chain again; not while a frame is drawn.
    void detach(osg::Camera* camera);

    /// Asks for the next frame that is drawn; without that a frame costs nothing.
    void request();

    /// The requested image, once it has been drawn; null after `seconds` without one. Each request gives one image.
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
