// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "GlObjectCount.h"

#include <osg/Image>
#include <osg/Matrixd>
#include <osg/Node>
#include <osgViewer/Viewer>

#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/paging/PagerMonitor.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace geofx::bench
{

/** A viewer without a window, for timing: single-threaded, a head light, each frame finished before it
   counts.

    Its clock stands still unless frame() is told the time, so that tiles of a scene that is switched off do not
   expire. */
class OffscreenView
{
public:
    struct Size
    {
        int width, height;
    };
    struct Drawn
    {
        std::uint64_t triangles = 0, drawables = 0;
    };

    /// Throws BenchError where there is no OpenGL. `fieldOfView` is the vertical one, radians.
    OffscreenView(Size size, double fieldOfView, osg::Node* scene);
    ~OffscreenView();
    OffscreenView(const OffscreenView&) = delete;
    OffscreenView& operator=(const OffscreenView&) = delete;

    osg::Camera& camera() { return *_viewer->getCamera(); }
    osg::View& view() { return *_viewer; }

    /// World to eye.
    void look(const osg::Matrixd& view) { camera().setViewMatrix(view); }

    /// Draws until the pager has nothing more to bring; throws BenchError if that takes ten minutes. `time`: as for frame().
    void settle(double time = 0.0);

    /// Draws the frame of a time, in seconds, and waits for the end of it; the seconds that it took.
    double frame(double time = 0.0);

    /// What is timed of a frame: all of it, or the cull traversal alone.
    enum class Part
    {
        ALL,
        CULL
    };
    /// Frames of two scenes that take turns, so that other programs disturb both alike: `first` and `second` show one of them each.
    /// Medians over `rounds`, milliseconds. The first frame after a change does not count.
    std::pair<double, double> takeTurns(int rounds, Part part, const std::function<void()>& first,
                                        const std::function<void()>& second);

    /// What a frame draws.
    Drawn count(double time = 0.0);

    /// What OpenGL holds for this view.
    GlObjectCount objects();

    osg::ref_ptr<osg::Image> capture();

private:
    osg::ref_ptr<osgViewer::Viewer> _viewer;
    osg::ref_ptr<osgGeoFX::ImageCapture> _capture;
    std::unique_ptr<osgGeoFX::PagerMonitor> _monitor;
};

} // namespace geofx::bench
