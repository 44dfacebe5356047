// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/GraphicsContext>
#include <osg/Image>
#include <osg/Matrixd>

#include <cstdint>
#include <memory>
#include <string>

namespace osgGeoFX
{

/// What one finished picture took. Drawing includes reading the picture back, so all of it has been drawn.
struct FrameStatistics
{
    double cullMilliseconds = 0.0;
    double drawMilliseconds = 0.0;
    double totalMilliseconds = 0.0;
    std::uint64_t triangles = 0;      ///< handed to OpenGL, after culling
    std::uint64_t leastTriangles = 0; ///< that would do for the terrain (LeastTriangles); 0 unless asked for
    std::uint64_t drawables = 0;
    std::uint64_t tilesDrawn = 0;  ///< terrain tiles among them
    std::uint64_t tilesLoaded = 0; ///< since the picture before
    std::uint64_t bytesRead = 0;
};

/** Renders pictures of a scene off-screen, one after the other, and waits for its tiles.

    The same calls give the same bytes, whatever the pager's threads do: a picture is taken from a frame that
    asked for nothing more, opaque things are drawn in the order of the scene graph, and time stands still within a
    picture. Without tiles to wait for a picture is one frame. The LOD scale follows the terrain's pixel-error
    bound. One object is used by one thread at a time; several may live side by side, each with a scene of its own. */
class OSGGEOFX_EXPORT SceneRenderer
{
public:
    enum class Platform
    {
        Egl,
        X11 ///< an X11 pbuffer; needs DISPLAY
    };

    struct Options
    {
        int width = 1600;
        int height = 900;
        double fieldOfView = 30.0; ///< vertical, degrees
        unsigned int samples = 0;  ///< multisampling
        bool cull = true;          ///< false: neither frustum nor small-feature culling
        bool waitForTiles = true;
        double timeout = 600.0;      ///< seconds for each picture
        bool countTriangles = false; ///< fill the counts of FrameStatistics, which costs a little
        bool leastTriangles = false; ///< fill the least count, too, which reads the whole database first
        ImageCapture::Format format = ImageCapture::Format::Rgb;
        Platform platform = Platform::Egl;
    };

    /// Null, and a sentence in `error`, where there is no context, or where the least count is asked for and not to be had.
    static std::unique_ptr<SceneRenderer> create(const Scene& scene, const Options& options,
                                                 std::string& error);
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    /// A picture from a view matrix (world to eye) at a time, seconds. Null, and a sentence in `error`, where the
    /// tiles did not come in time.
    osg::ref_ptr<osg::Image> render(const osg::Matrixd& view, double time, FrameStatistics& statistics,
                                    std::string& error);

    const std::string& rendererName() const;
    const std::string& glVersion() const;
    unsigned int samples() const; ///< in use

private:
    struct Parts;
    explicit SceneRenderer(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> _parts;
};

} // namespace osgGeoFX
