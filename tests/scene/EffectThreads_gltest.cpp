// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Effects in all of OSG's threading models, in several views at once, and while they are changed between frames: with the
// real pager, and always the picture that one thread draws. Run with ThreadSanitizer, too: ./tests/run --preset tsan.
#include <tools/GlRequired.h>
#include <tools/ImageComparison.h>
#include <tools/NotifyWatch.h>
#include <tools/OahuScene.h>

#include <osg/DisplaySettings>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgViewer/CompositeViewer>

#include <chrono>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;
using Threading = osgViewer::ViewerBase::ThreadingModel;

namespace
{

constexpr int WIDTH = 120, HEIGHT = 90;

constexpr Threading models[] = {osgViewer::ViewerBase::SingleThreaded,
                                osgViewer::ViewerBase::CullDrawThreadPerContext,
                                osgViewer::ViewerBase::DrawThreadPerContext,
                                osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext};

/// For what takes long: those in which threads meet most.
std::vector<Threading> someModels()
{
    if (fullTest()) return {std::begin(models), std::end(models)};
    return {osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext,
            osgViewer::ViewerBase::DrawThreadPerContext};
}

osg::Matrixd viewOver(const Georeference& reference, double longitude, double heading, double pitch)
{
    ViewPoint point;
    point.longitude = osg::DegreesToRadians(longitude);
    point.latitude = osg::DegreesToRadians(21.42);
    point.height = 4000.0;
    point.heading = heading;
    point.pitch = pitch;
    osg::Matrixd view;
    EXPECT_TRUE(point.viewMatrix(reference, view));
    return view;
}

osg::ref_ptr<BirdsEyeView> birdsEye()
{
    osg::ref_ptr<BirdsEyeView> effect = new BirdsEyeView;
    effect->setFocusLine(0.3);
    effect->setHorizonLine(0.8);
    effect->setContextTilt(0.5);
    return effect;
}

osg::ref_ptr<PedestrianView> pedestrian()
{
    osg::ref_ptr<PedestrianView> effect = new PedestrianView;
    effect->setFocusDistance(4000.0);
    effect->setZoneWidth(5000.0);
    return effect;
}

/// One window's worth: an off-screen context and what reads it. Each view has its own.
struct Window
{
    osg::ref_ptr<EglGraphicsContext> context;
    osg::ref_ptr<ImageCapture> capture;

    /// False without OpenGL.
    bool open(osgViewer::View& view)
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = WIDTH;
        traits->height = HEIGHT;
        traits->alpha = 8;
        context = new EglGraphicsContext(traits);
        if (!context->valid()) return false;
        osg::Camera& camera = *view.getCamera();
        camera.setGraphicsContext(context);
        camera.setViewport(0, 0, WIDTH, HEIGHT);
        camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e6);
        capture = ImageCapture::attach(&camera);
        return true;
    }
};

/// What is opaque in the order of the graph: the order of addresses in memory differs from run to run.
osg::ref_ptr<osg::Group> ordered(osg::Node* scene)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    root->addChild(scene);
    return root;
}

/// More than there are at a time.
constexpr unsigned int contexts = 32;

/// For objects that are made from now on, such as tiles: an osg::Texture2D makes room for a context when it is first drawn there, without
/// a lock, and resizeGLObjectBuffers() does not reach what it counts.
void makeRoom()
{
    osg::DisplaySettings::instance()->setMaxNumberOfGraphicsContexts(contexts);
}

/// A composite viewer (of one view or more) that draws frames until every view has all its tiles.
class Views
{
public:
    explicit Views(Threading model) : _viewer(new osgViewer::CompositeViewer)
    {
        _viewer->setThreadingModel(model);
        _viewer->setKeyEventSetsDone(0);
    }
    ~Views()
    {
        _viewer->stopThreading();
        _viewer = nullptr;
        for (Window& window : _windows)
            window.context->close();
    }
    Views(const Views&) = delete;
    Views& operator=(const Views&) = delete;

    bool add(const Scene& scene, osg::Node* node, const osg::Matrixd& matrix)
    {
        osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        Window window;
        if (!window.open(*view)) return false;
        scene.setUpView(*view);
        view->getCamera()->setViewMatrix(matrix);
        // Some dozen tiles are enough to have the pager and the culling meet.
        view->getCamera()->setLODScale(fullTest() ? 1.0f : 8.0f);
        view->setSceneData(node);
        // OSG makes a pager for each root, and keeps one request for each child of a paged node: two pagers that ask for the
        // same child both work on it. So views over one terrain share one.
        if (_viewer->getNumViews() > 0) view->setDatabasePager(_viewer->getView(0)->getDatabasePager());
        _viewer->addView(view);
        _windows.push_back(window);
        return true;
    }

    osg::Camera& camera(unsigned int i) { return *_viewer->getView(i)->getCamera(); }
    void realize()
    {
        // OSG gives a scene room for the contexts that there are when a view takes it. Threads that draw the first frame of a shared
        // scene would make room for theirs at the same time, without a lock.
        for (unsigned int i = 0; i < _viewer->getNumViews(); ++i)
            _viewer->getView(i)->getSceneData()->resizeGLObjectBuffers(contexts);
        _viewer->realize();
        // It counts the contexts of this viewer only.
        makeRoom();
        for (unsigned int i = 0; i < _windows.size(); ++i)
        {
            _monitors.push_back(
                std::make_unique<PagerMonitor>(_viewer->getView(i)->getDatabasePager(), nullptr, 2));
        }
    }
    void frame() { _viewer->frame(++_time / 1000.0); }

    /// The settled pictures of all views.
    std::vector<osg::ref_ptr<osg::Image>> settle()
    {
        using Clock = std::chrono::steady_clock;
        const auto end = Clock::now() + std::chrono::seconds(300);
        for (const auto& monitor : _monitors)
            monitor->restart();
        bool done = false;
        while (!done && Clock::now() < end)
        {
            frame();
            done = true;
            for (const auto& monitor : _monitors)
                done = monitor->frameFinished() && done;
            for (const auto& monitor : _monitors)
                monitor->waitForReads(done ? 0.0 : 10.0);
        }
        EXPECT_TRUE(done) << "tiles did not come";
        for (const Window& window : _windows)
            window.capture->request();
        // The pictures of frames on their way are of the same scene.
        frame();
        frame();
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (const Window& window : _windows)
            images.push_back(window.capture->take());
        return images;
    }

private:
    osg::ref_ptr<osgViewer::CompositeViewer> _viewer;
    std::vector<Window> _windows;
    std::vector<std::unique_ptr<PagerMonitor>> _monitors;
    int _time = 0;
};

class EffectThreads : public ::testing::Test
{
protected:
    void SetUp() override
    {
        makeRoom();
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = traits->height = 8;
        const osg::ref_ptr<EglGraphicsContext> context = new EglGraphicsContext(traits);
        if (context->valid()) return;
        if (geofx::test::glIsRequired()) FAIL() << context->error();
        GTEST_SKIP() << context->error();
    }

private:
    NotifyWatch _watch;
};

/// Each database in a test of its own, so that none takes long.
class EveryModel : public EffectThreads, public ::testing::WithParamInterface<const char*>
{
};

void expectSame(const osg::ref_ptr<osg::Image>& image, const osg::ref_ptr<osg::Image>& expected,
                const std::string& name)
{
    ASSERT_TRUE(image && expected) << name;
    EXPECT_TRUE(imagesMatch(*image, *expected, {}, name));
}

/// How many pixels are not as in another picture.
int differences(const osg::Image& a, const osg::Image& b)
{
    int count = 0;
    for (int y = 0; y < HEIGHT; ++y)
    {
        for (int x = 0; x < WIDTH; ++x)
        {
            const unsigned char* p = a.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            const unsigned char* q = b.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            count += std::equal(p, p + 3, q) ? 0 : 1;
        }
    }
    return count;
}

/// The settled picture of one view alone, in one thread, of a database read anew.
osg::ref_ptr<osg::Image> alone(const std::string& name, Effect* effect, double longitude, double heading)
{
    const std::optional<Scene> oahu = loadOahu(name);
    if (!oahu) return nullptr;
    if (effect) oahu->effects->addEffect(effect);
    Views views(osgViewer::ViewerBase::SingleThreaded);
    views.add(*oahu, ordered(oahu->node), viewOver(*oahu->reference, longitude, heading, -0.4));
    views.realize();
    return views.settle().front();
}

} // namespace

TEST_P(EveryModel, DrawsTheSame)
{
    const std::string name = GetParam();
    std::vector<osg::ref_ptr<osg::Image>> first;
    for (const Threading model : models)
    {
        SCOPED_TRACE("threading model " + std::to_string(model));
        const std::optional<Scene> oahu = loadOahu(name);
        if (!oahu) return;
        osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
        high->setFactor(2.0);
        const osg::ref_ptr<BirdsEyeView> bird = birdsEye();
        const osg::ref_ptr<PedestrianView> walk = pedestrian();
        for (Effect* effect : {static_cast<Effect*>(high), static_cast<Effect*>(bird)})
            oahu->effects->addEffect(effect);
        Views views(model);
        const osg::Matrixd begin = viewOver(*oahu->reference, -158.1, 1.2, -0.4);
        ASSERT_TRUE(views.add(*oahu, ordered(oahu->node), begin));
        views.realize();
        std::vector<osg::ref_ptr<osg::Image>> images = views.settle();

        // Under way: tiles come and go, effects are switched, changed, added and removed between frames.
        for (int i = 0; i < (fullTest() ? 30 : 12); ++i)
        {
            views.camera(0).setViewMatrix(
                viewOver(*oahu->reference, -158.1 + 0.01 * i, 1.2 + 0.05 * i, -0.4 - 0.01 * i));
            // A scene shows one bend at a time.
            bird->setEnabled(i % 7 != 3 && (i % 10 < 4 || i % 10 >= 8));
            bird->setHorizonLine(0.7 + 0.01 * (i % 20));
            bird->setCurve(static_cast<PerspectiveBend::Curve>(i % 3));
            high->setFactor(1.0 + 0.1 * i);
            if (i % 10 == 4) oahu->effects->addEffect(walk);
            if (i % 10 == 8) oahu->effects->removeEffect(walk);
            oahu->effects->setDebugBounds(i % 5 == 1);
            oahu->effects->setCompensation(i % 11 != 5);
            views.frame();
        }
        oahu->effects->setDebugBounds(false);
        oahu->effects->setCompensation(true);
        for (const auto& image : views.settle())
            images.push_back(image);
        if (first.empty())
        {
            first = images;
            EXPECT_GT(differences(*images[0], *images[1]), WIDTH * HEIGHT / 4);
            continue;
        }
        expectSame(images[0], first[0], name + std::to_string(model) + "-settled");
        expectSame(images[1], first[1], name + std::to_string(model) + "-after-the-way");
    }
}

INSTANTIATE_TEST_SUITE_P(Oahu, EveryModel,
                         ::testing::ValuesIn(fullTest() ? std::vector<const char*>{"oahu", "oahu_projected"}
                                                        : std::vector<const char*>{"oahu"}),
                         [](const auto& each) { return std::string(each.param); });

TEST_F(EffectThreads, ViewsShareATerrainEachWithItsEffects)
{
    const osg::ref_ptr<osg::Image> expected[] = {alone("oahu", birdsEye(), -158.1, 1.2),
                                                 alone("oahu", pedestrian(), -158.1, 1.2),
                                                 alone("oahu", nullptr, -157.9, 5.5)};
    if (!expected[2]) return;
    EXPECT_GT(differences(*expected[0], *expected[1]), WIDTH * HEIGHT / 4);
    for (const Threading model : someModels())
    {
        SCOPED_TRACE("threading model " + std::to_string(model));
        const std::optional<Scene> oahu = loadOahu("oahu");
        ASSERT_TRUE(oahu);
        oahu->effects->addEffect(birdsEye());
        osg::ref_ptr<EffectScene> second = new EffectScene;
        second->addEffect(pedestrian());
        for (unsigned int i = 0; i < oahu->effects->getNumChildren(); ++i)
            second->addChild(oahu->effects->getChild(i));
        osg::ref_ptr<osg::Group> plain = new osg::Group;
        plain->addChild(second->getChild(0));
        Views views(model);
        const osg::Matrixd here = viewOver(*oahu->reference, -158.1, 1.2, -0.4);
        const osg::Matrixd there = viewOver(*oahu->reference, -157.9, 5.5, -0.4);
        ASSERT_TRUE(views.add(*oahu, ordered(oahu->effects), here));
        ASSERT_TRUE(views.add(*oahu, ordered(second), here));
        ASSERT_TRUE(views.add(*oahu, ordered(plain), there));
        views.realize();
        const std::vector<osg::ref_ptr<osg::Image>> images = views.settle();
        for (std::size_t i = 0; i < images.size(); ++i)
            expectSame(images[i], expected[i], std::to_string(model) + "-view-" + std::to_string(i));
    }
}

TEST_F(EffectThreads, OneSceneInTwoViews)
{
    const osg::ref_ptr<osg::Image> expected[] = {alone("oahu", birdsEye(), -158.1, 1.2),
                                                 alone("oahu", birdsEye(), -157.9, 5.5)};
    if (!expected[1]) return;
    EXPECT_GT(differences(*expected[0], *expected[1]), WIDTH * HEIGHT / 4);
    for (const Threading model : someModels())
    {
        SCOPED_TRACE("threading model " + std::to_string(model));
        const std::optional<Scene> oahu = loadOahu("oahu");
        ASSERT_TRUE(oahu);
        oahu->effects->addEffect(birdsEye());
        const osg::ref_ptr<osg::Group> root = ordered(oahu->node);
        Views views(model);
        ASSERT_TRUE(views.add(*oahu, root, viewOver(*oahu->reference, -158.1, 1.2, -0.4)));
        ASSERT_TRUE(views.add(*oahu, root, viewOver(*oahu->reference, -157.9, 5.5, -0.4)));
        views.realize();
        const std::vector<osg::ref_ptr<osg::Image>> images = views.settle();
        for (std::size_t i = 0; i < images.size(); ++i)
            expectSame(images[i], expected[i], std::to_string(model) + "-view-" + std::to_string(i));
    }
}
