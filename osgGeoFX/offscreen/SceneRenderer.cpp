// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/offscreen/SceneRenderer.h>

#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/LeastTriangles.h>
#include <osgGeoFX/offscreen/detail/DeepFrame.h>
#include <osgGeoFX/offscreen/detail/DrawnLeaves.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/PictureParts.h>
#include <osgGeoFX/viewer/SceneData.h>

#include <osg/Group>
#include <osg/Stats>
#include <osgUtil/SceneView>
#include <osgViewer/Renderer>
#include <osgViewer/Viewer>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace osgGeoFX
{

namespace
{

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A viewer whose clock shows what it is told: nothing expires, and nothing moves, while a picture's tiles come.
class StillViewer : public osgViewer::Viewer
{
public:
    void advance(double time) override
    {
        osgViewer::Viewer::advance(time);
        getFrameStamp()->setReferenceTime(time);
    }
};

/// Counts what is about to be drawn; afterwards OSG has cleared its lists.
class CountCallback : public osg::Camera::DrawCallback
{
public:
    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo& renderInfo) const override
    {
        auto* renderer = dynamic_cast<osgViewer::Renderer*>(renderInfo.getCurrentCamera()->getRenderer());
        // The single-threaded model uses the first of the renderer's two scene views only.
        if (renderer) leaves = DrawnLeaves::count(*renderer->getSceneView(0)->getRenderStage());
    }

    mutable DrawnLeaves leaves;
};

/// Draws nothing of a stage itself. What is drawn before it, into textures, remains.
class DrawNothing : public osgUtil::RenderBin::DrawCallback
{
public:
    void drawImplementation(osgUtil::RenderBin*, osg::RenderInfo&, osgUtil::RenderLeaf*&) override {}
};

/// Leaves the frame in the back buffer of an X11 pbuffer, which has no screen; Mesa reports an X error for each swap.
struct NoSwap : public osg::GraphicsContext::SwapCallback
{
    void swapBuffersImplementation(osg::GraphicsContext*) override {}
};

/// Whether it draws into a frame buffer of its own, since contexts have none of 16 bits.
bool isDeep(const SceneRenderer::Options& options)
{
    return options.format == ImageCapture::Format::Rgb16;
}

osg::ref_ptr<osg::GraphicsContext> createContext(const SceneRenderer::Options& options, std::string& error)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = options.width;
    traits->height = options.height;
    traits->alpha = 8;
    traits->stencil = 8;
    const unsigned int samples = isDeep(options) ? 0 : options.samples;
    traits->samples = samples;
    traits->sampleBuffers = samples > 1 ? 1 : 0;
    if (options.platform == SceneRenderer::Platform::Egl)
    {
        osg::ref_ptr<EglGraphicsContext> context = new EglGraphicsContext(traits);
        error = context->error();
        if (!context->valid()) return nullptr;
        return context;
    }
    const char* display = std::getenv("DISPLAY");
    if (!display || !*display)
    {
        error = "There is no X display (DISPLAY is not set); start an X server or use EGL.";
        return nullptr;
    }
    traits->pbuffer = true;
    traits->doubleBuffer = true;
    traits->readDISPLAY();
    osg::ref_ptr<osg::GraphicsContext> context = osg::GraphicsContext::createGraphicsContext(traits);
    if (!context || !context->valid())
    {
        error = std::string("No OpenGL context could be made on the X display ") + display +
                "; check that it runs and has GLX.";
        return nullptr;
    }
    context->setSwapCallback(new NoSwap);
    return context;
}

} // namespace

struct SceneRenderer::Parts
{
    Options options;
    osg::ref_ptr<StillViewer> viewer;
    osg::ref_ptr<ImageCapture> capture;
    std::vector<osg::ref_ptr<osg::Camera>> cameras; ///< that draw, side by side
    std::vector<osg::ref_ptr<CountCallback>> counters;
    std::unique_ptr<PagerMonitor> monitor;
    std::unique_ptr<LeastTriangles> least;
    osg::ref_ptr<EffectScene> effects;
    osg::ref_ptr<osg::Camera> whole = new osg::Camera; ///< of the picture; it draws nothing
    osg::Vec2d corner;                                 ///< of the tile in the picture, pixels
    double pixelError = 0.0;
    bool hasDrawn = false; ///< some view, whose tiles are in memory
    std::string rendererName;
    std::string glVersion;
    unsigned int samples = 0;

    bool tiled() const { return options.pictureWidth > 0 && options.pictureHeight > 0; }
    void setUpCamera(const Scene& scene, osg::GraphicsContext& context);
    void look(const osg::Matrixd& view);
    void setUpScene(const Scene& scene);
    bool describe(osg::GraphicsContext& context);
    void setDraws(bool draws);
    osg::ref_ptr<osg::Image> frame(double time, FrameStatistics& statistics);
    std::uint64_t leastTriangles() const;
};

void SceneRenderer::Parts::setUpCamera(const Scene& scene, osg::GraphicsContext& context)
{
    osg::Camera& camera = *viewer->getCamera();
    const double width = tiled() ? options.pictureWidth : options.width;
    const double height = tiled() ? options.pictureHeight : options.height;
    camera.setGraphicsContext(&context);
    camera.setViewport(0, 0, options.width, options.height);
    camera.setProjectionMatrixAsPerspective(options.fieldOfView, width / height, 1.0, 1e6);
    camera.setLODScale(scene.lodScale(height, osg::DegreesToRadians(options.fieldOfView)));
    whole->setViewport(new osg::Viewport(0, 0, width, height));
    whole->setProjectionMatrix(camera.getProjectionMatrix());
    whole->setLODScale(camera.getLODScale());
    scene.setUpView(*viewer);
    if (!options.cull)
    {
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
    }
    cameras = drawInParts(*viewer, scene.effects->leastParts());
    osg::ref_ptr<osg::Camera> last = &camera;
    if (cameras.empty())
        cameras.push_back(last);
    else
    {
        // It draws nothing, after all others, and so has all of the picture before it.
        last = makeOverlay(options.width, options.height);
        last->setViewport(0, 0, options.width, options.height);
        attachOverlay(*viewer, *last);
    }
    for (const osg::ref_ptr<osg::Camera>& each : cameras)
    {
        each->setStats(new osg::Stats("Camera"));
        each->getStats()->collectStats("rendering", true);
        // Effects that draw into textures of their own follow the picture's format.
        if (isDeep(options)) each->attach(osg::Camera::COLOR_BUFFER, DeepFrame::colorFormat);
        if (!options.countTriangles) continue;
        counters.push_back(new CountCallback);
        each->addInitialDrawCallback(counters.back().get());
    }
    capture = ImageCapture::attach(last, options.format);
}

void SceneRenderer::Parts::look(const osg::Matrixd& view)
{
    osg::Camera& camera = *viewer->getCamera();
    camera.setViewMatrix(view);
    whole->setViewMatrix(view);
    if (!tiled()) return;
    // The part of the picture, −1…1, becomes all of the tile.
    const osg::Vec2d scale(static_cast<double>(options.pictureWidth) / options.width,
                           static_cast<double>(options.pictureHeight) / options.height);
    const osg::Vec2d middle((2.0 * corner.x() + options.width) / options.pictureWidth - 1.0,
                            (2.0 * corner.y() + options.height) / options.pictureHeight - 1.0);
    camera.setProjectionMatrix(whole->getProjectionMatrix() *
                               osg::Matrixd::translate(-middle.x(), -middle.y(), 0.0) *
                               osg::Matrixd::scale(scale.x(), scale.y(), 1.0));
    const CameraRole role = CameraRole::like(view, whole->getProjectionMatrix());
    for (const osg::ref_ptr<osg::Camera>& each : cameras)
        CameraEffects::of(*each).setRole(role);
}

void SceneRenderer::Parts::setUpScene(const Scene& scene)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    // Sorting by state would draw in the order of addresses in memory, which differ from run to run.
    root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    root->addChild(scene.node.get());
    viewer->setSceneData(root);
    RemoteFiles::setUpThreads(*viewer->getDatabasePager(), std::max(2u, std::thread::hardware_concurrency()));
    monitor = std::make_unique<PagerMonitor>(viewer->getDatabasePager(), scene.guard.get(), 1);
}

bool SceneRenderer::Parts::describe(osg::GraphicsContext& context)
{
    if (!context.makeCurrent())
    {
        return false;
    }
    rendererName = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    glVersion = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    GLint count = 0;
    glGetIntegerv(GL_SAMPLES, &count);
    samples = static_cast<unsigned int>(count);
    context.releaseContext();
    return true;
}

/// Whether the next frames draw their pictures. While tiles are on their way only the culling counts, which requests them.
void SceneRenderer::Parts::setDraws(bool draws)
{
    const osg::ref_ptr<DrawNothing> nothing = draws ? nullptr : new DrawNothing;
    for (const osg::ref_ptr<osg::Camera>& each : cameras)
    {
        auto* renderer = dynamic_cast<osgViewer::Renderer*>(each->getRenderer());
        // The single-threaded model uses the first of the renderer's two scene views only.
        if (renderer) renderer->getSceneView(0)->getRenderStage()->setDrawCallback(nothing);
    }
}

osg::ref_ptr<osg::Image> SceneRenderer::Parts::frame(double time, FrameStatistics& statistics)
{
    const auto start = Clock::now();
    capture->request();
    viewer->frame(time);
    osg::ref_ptr<osg::Image> image = capture->take();
    statistics.totalMilliseconds = 1000.0 * secondsSince(start);

    const unsigned int number = viewer->getFrameStamp()->getFrameNumber();
    statistics.cullMilliseconds = statistics.drawMilliseconds = 0.0;
    for (const osg::ref_ptr<osg::Camera>& each : cameras)
    {
        double cull = 0.0;
        double draw = 0.0;
        each->getStats()->getAttribute(number, "Cull traversal time taken", cull);
        each->getStats()->getAttribute(number, "Draw traversal time taken", draw);
        statistics.cullMilliseconds += 1000.0 * cull;
        statistics.drawMilliseconds += 1000.0 * draw;
    }
    statistics.triangles = statistics.drawables = statistics.tilesDrawn = 0;
    for (const osg::ref_ptr<CountCallback>& each : counters)
    {
        statistics.triangles += each->leaves.triangles;
        statistics.drawables += each->leaves.drawables;
        statistics.tilesDrawn += each->leaves.tiles;
    }
    return image;
}

std::uint64_t SceneRenderer::Parts::leastTriangles() const
{
    if (!least) return 0;
    const osg::Matrixd& view = whole->getViewMatrix();
    const osg::Matrixd& projection = whole->getProjectionMatrix();
    return least->count(
        view, projection,
        pixelsPerRadian(whole->getViewport()->height(), osg::DegreesToRadians(options.fieldOfView)),
        pixelError, *effects->deformation(view, projection));
}

SceneRenderer::SceneRenderer(std::unique_ptr<Parts> parts) : _parts(std::move(parts)) {}

SceneRenderer::~SceneRenderer() = default;

std::unique_ptr<SceneRenderer> SceneRenderer::create(const Scene& scene, const Options& options,
                                                     std::string& error)
{
    const osg::ref_ptr<osg::GraphicsContext> context = createContext(options, error);
    if (!context)
    {
        return nullptr;
    }
    auto parts = std::make_unique<Parts>();
    parts->options = options;
    parts->effects = scene.effects;
    if (options.leastTriangles)
    {
        parts->least = LeastTriangles::read(*scene.node, error);
        if (!parts->least) return nullptr;
        parts->pixelError = scene.terrain->pixelError;
    }
    parts->viewer = new StillViewer;
    parts->viewer->setThreadingModel(osgViewer::Viewer::SingleThreaded);
    // OSG would tie this thread, and all that it starts, to the first core; all processes of a film would share that one.
    parts->viewer->setUseConfigureAffinity(false);
    parts->setUpCamera(scene, *context);
    parts->setUpScene(scene);
    osg::ref_ptr<DeepFrame> deep;
    if (isDeep(options)) deep = new DeepFrame(options.width, options.height, options.samples);
    if (deep) parts->viewer->setRealizeOperation(deep);
    parts->viewer->realize();
    if (deep && !deep->isThere())
    {
        error =
            "The graphics card draws no pictures of 16 bits and this size; take 8 bits, or fewer samples.";
        return nullptr;
    }
    if (!parts->viewer->isRealized() || !parts->describe(*context))
    {
        error = "The OpenGL context cannot be used; check the driver.";
        return nullptr;
    }
    return std::unique_ptr<SceneRenderer>(new SceneRenderer(std::move(parts)));
}

void SceneRenderer::setTile(int x, int y)
{
    _parts->corner.set(x, y);
}

osg::ref_ptr<osg::Image> SceneRenderer::render(const osg::Matrixd& view, double time,
                                               FrameStatistics& statistics, std::string& error)
{
    Parts& parts = *_parts;
    const auto start = Clock::now();
    if (parts.options.waits) parts.options.waits(true);
    parts.look(view);
    parts.monitor->restart();
    osg::ref_ptr<osg::Image> image;
    // A first view lacks nearly all of its tiles, a later one often none.
    bool draws = parts.hasDrawn || !parts.options.waitForTiles;
    for (bool done = false; !done;)
    {
        parts.setDraws(draws);
        image = parts.frame(time, statistics);
        if (!image)
        {
            error = "The frame could not be read back; check the OpenGL driver.";
            return nullptr;
        }
        bool here = parts.monitor->frameFinished() || !parts.options.waitForTiles;
        if (!here && draws)
        {
            // A thread of the pager that wakes up late, when all is read, looks as if it read.
            parts.monitor->waitForReads(parts.options.timeout - secondsSince(start));
            here = parts.monitor->frameFinished();
        }
        const bool waits = here && draws && parts.options.waitForTiles && !hasAllData(*parts.effects);
        done = here && draws && !waits;
        draws = here;
        const double left = parts.options.timeout - secondsSince(start);
        if (!done && left <= 0.0)
        {
            std::ostringstream text;
            text << "The tiles did not arrive within " << parts.options.timeout
                 << " s; allow more time, or do not wait for them.";
            error = text.str();
            return nullptr;
        }
        // What mappings read has threads of its own.
        if (waits)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        else if (!here)
            parts.monitor->waitForReads(left);
    }
    parts.hasDrawn = true;
    const PagerMonitor::Progress progress = parts.monitor->takeProgress();
    statistics.tilesLoaded = progress.tilesLoaded;
    statistics.bytesRead = progress.bytesRead;
    statistics.leastTriangles = parts.leastTriangles();
    if (parts.options.waits) parts.options.waits(false);
    const std::string fault = parts.options.lacks ? faultOfData(*parts.effects) : std::string();
    if (!fault.empty()) parts.options.lacks(fault);
    return image;
}

const osg::Camera& SceneRenderer::camera() const
{
    return *_parts->whole;
}

const std::string& SceneRenderer::rendererName() const
{
    return _parts->rendererName;
}

const std::string& SceneRenderer::glVersion() const
{
    return _parts->glVersion;
}

unsigned int SceneRenderer::samples() const
{
    return _parts->samples;
}

} // namespace osgGeoFX
