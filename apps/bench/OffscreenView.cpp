// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "OffscreenView.h"

#include "BenchError.h"
#include "Figure.h"
#include "Interruption.h"

#include <osgGeoFX/offscreen/EglGraphicsContext.h>

#include <osg/Stats>

#include <chrono>
#include <vector>

namespace geofx::bench
{

namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct FinishCallback : public osg::Camera::DrawCallback
{
    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo&) const override { glFinish(); }
};

class StillViewer : public osgViewer::Viewer
{
public:
    void advance(double time) override
    {
        osgViewer::Viewer::advance(time);
        getFrameStamp()->setReferenceTime(time);
    }
};

} // namespace

OffscreenView::OffscreenView(Size size, double fieldOfView, osg::Node* scene) : _viewer(new StillViewer)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = size.width;
    traits->height = size.height;
    const osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
    if (!context->valid()) throw BenchError("Nothing can be drawn: " + context->error());

    camera().setGraphicsContext(context);
    camera().setViewport(0, 0, size.width, size.height);
    camera().setProjectionMatrixAsPerspective(osg::RadiansToDegrees(fieldOfView),
                                              static_cast<double>(size.width) / size.height, 1.0, 1e6);
    // OSG's default keeps near and far within 1 : 2000, which cuts off the foreground of a wide landscape.
    camera().setNearFarRatio(0.0002);
    camera().setStats(new osg::Stats("Camera"));
    camera().addFinalDrawCallback(new FinishCallback);
    _capture = osgGeoFX::ImageCapture::attach(&camera());
    _viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    _viewer->setUseConfigureAffinity(false); // the pager's threads would share this one's core
    _viewer->setLightingMode(osg::View::HEADLIGHT);
    _viewer->setSceneData(scene);
    _viewer->realize();
    _monitor = std::make_unique<osgGeoFX::PagerMonitor>(_viewer->getDatabasePager(), nullptr, 1);
}

OffscreenView::~OffscreenView() = default;

double OffscreenView::frame(double time)
{
    Interruption::throwIfInterrupted();
    const auto start = Clock::now();
    _viewer->frame(time);
    return secondsSince(start);
}

void OffscreenView::settle(double time)
{
    const auto start = Clock::now();
    _monitor->restart();
    for (frame(time); !_monitor->frameFinished(); frame(time))
    {
        if (secondsSince(start) > 600.0)
            throw BenchError(
                "The terrain's tiles did not come within ten minutes; is its disk within reach?");
        _monitor->waitForReads(1.0);
    }
}

std::pair<double, double> OffscreenView::takeTurns(int rounds, Part part, const std::function<void()>& first,
                                                   const std::function<void()>& second)
{
    // Culls are short, and five of them tell more than one.
    const int frames = part == Part::CULL ? 5 : 1;
    std::vector<double> times[2];
    osg::Stats& stats = *camera().getStats();
    stats.collectStats("rendering", true);
    for (int turn = 0; turn < 2 * rounds; ++turn)
    {
        (turn % 2 ? second : first)();
        frame();
        for (int i = 0; i < frames; ++i)
        {
            double seconds = frame();
            if (part == Part::CULL)
                stats.getAttribute(stats.getLatestFrameNumber(), "Cull traversal time taken", seconds);
            times[turn % 2].push_back(1000.0 * seconds);
        }
    }
    stats.collectStats("rendering", false);
    return {median(times[0]), median(times[1])};
}

OffscreenView::Drawn OffscreenView::count(double time)
{
    osg::Stats& stats = *camera().getStats();
    stats.collectStats("scene", true);
    frame(time);
    stats.collectStats("scene", false);
    double triangles = 0.0, drawables = 0.0;
    const unsigned int number = _viewer->getFrameStamp()->getFrameNumber();
    stats.getAttribute(number, "Visible number of GL_TRIANGLES", triangles);
    stats.getAttribute(number, "Visible number of drawables", drawables);
    return {static_cast<std::uint64_t>(triangles), static_cast<std::uint64_t>(drawables)};
}

GlObjectCount OffscreenView::objects()
{
    osg::GraphicsContext& context = *camera().getGraphicsContext();
    if (!context.makeCurrent()) throw BenchError("OpenGL's objects could not be counted.");
    const GlObjectCount count = GlObjectCount::of(*context.getState());
    context.releaseContext();
    return count;
}

osg::ref_ptr<osg::Image> OffscreenView::capture()
{
    _capture->request();
    frame();
    const osg::ref_ptr<osg::Image> image = _capture->take();
    if (!image) throw BenchError("The picture could not be read back from OpenGL.");
    return image;
}

} // namespace geofx::bench
