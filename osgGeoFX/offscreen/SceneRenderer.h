// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Camera>
#include <osg/GraphicsContext>
#include <osg/Image>
#include <osg/Matrixd>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace osgGeoFX
{

/// Times and counts of one finished image. Drawing includes reading the image back, so all of it has been drawn.
/// @ingroup offscreen
struct FrameStatistics
{
    double cullMilliseconds = 0.0;
    double drawMilliseconds = 0.0;
    double totalMilliseconds = 0.0;
    std::uint64_t triangles = 0;      ///< handed to OpenGL, after culling
    std::uint64_t leastTriangles = 0; ///< that the terrain needs (LeastTriangles); 0 unless requested
    std::uint64_t drawables = 0;
    std::uint64_t tilesDrawn = 0;  ///< drawn terrain tiles
    std::uint64_t tilesLoaded = 0; ///< since the previous image
    std::uint64_t bytesRead = 0;
};

/** Renders images of a scene off-screen, one after the other, and waits for the tiles of each image.

    The same calls give the same bytes, whatever the pager's threads do: an image is taken from a frame that requested
    no more tiles, opaque objects are drawn in the order of the scene graph, and time stands still within an image. An
    image takes one frame if it has no tiles to wait for, or if waitForTiles is false; frames that wait for tiles are
    culled and not drawn, and so is the first frame of a renderer. The LOD scale follows the
    terrain's pixel-error bound. One thread at a time uses one renderer. Several renderers may exist at once, each with
    its own scene.
    @ingroup offscreen */
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
        /// The size of a larger picture, of which each image is a tile (setTile()); 0: each image is a picture.
        int pictureWidth = 0;
        int pictureHeight = 0;
        double fieldOfView = 30.0; ///< vertical, degrees
        unsigned int samples = 0;  ///< multisampling; 0 is off
        bool cull = true;          ///< false: neither frustum nor small-feature culling
        bool waitForTiles = true;
        double timeout = 600.0; ///< seconds for each image
        /// Called with true when the wait for an image begins, and with false when the image is there.
        std::function<void(bool)> waits;
        /// Called for each image that lacks a part of a raster, with the reason (faultOfData()).
        std::function<void(const std::string&)> lacks;
        bool countTriangles = false; ///< fill triangles, drawables and tilesDrawn; costs a little
        bool leastTriangles = false; ///< fill leastTriangles; reads the whole database first
        ImageCapture::Format format = ImageCapture::Format::Rgb; ///< Rgb16 draws with 16 bits, too
        Platform platform = Platform::Egl;
    };

    /// Returns null, with a sentence in `error`, if no context can be made or the least count cannot be had.
    static std::unique_ptr<SceneRenderer> create(const Scene& scene, const Options& options,
                                                 std::string& error);
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    /// The next images are the tile with this lower left corner in the picture, pixels. Tiles show the same deformed world at the same
    /// level of detail, so side by side they are the picture. What lies beyond the picture is drawn, too.
    void setTile(int x, int y);

    /// Renders an image from a view matrix (world to eye space) at a time, seconds. Returns null, with a sentence in
    /// `error`, if the tiles did not arrive in time or the frame could not be read back.
    osg::ref_ptr<osg::Image> render(const osg::Matrixd& view, double time, FrameStatistics& statistics,
                                    std::string& error);

    /// The camera of the last image's whole picture, even if it was a tile or several cameras drew parts of it; for a DeformedView that
    /// tells what pixels show.
    const osg::Camera& camera() const;
    const std::string& rendererName() const;
    const std::string& glVersion() const;
    unsigned int samples() const; ///< in use

private:
    struct Parts;
    explicit SceneRenderer(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> _parts;
};

} // namespace osgGeoFX
