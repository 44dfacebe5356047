// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Flights with OSG's pager over a web server that takes its time, in OSG's threading models: what is asked for ahead comes
// once, and nothing is said.
#include <tools/GlRequired.h>
#include <tools/NotifyWatch.h>
#include <tools/OahuScene.h>
#include <tools/TestServer.h>

#include <osg/DisplaySettings>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/paging/MemoryBudget.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/scene/TilePrefetch.h>
#include <osgViewer/CompositeViewer>

#include <chrono>
#include <map>

using namespace osgGeoFX;
using namespace geofx::test;
using Threading = osgViewer::ViewerBase::ThreadingModel;
using Clock = std::chrono::steady_clock;

namespace
{

constexpr int WIDTH = 120, HEIGHT = 90;
constexpr unsigned int contexts = 32;

struct Model
{
    const char* name;
    Threading threading;
};

std::ostream& operator<<(std::ostream& out, const Model& model)
{
    return out << model.name;
}

class ServedFlights : public ::testing::Test, public ::testing::WithParamInterface<Model>
{
protected:
    void SetUp() override
    {
        osg::DisplaySettings::instance()->setMaxNumberOfGraphicsContexts(contexts);
        server.setDelay(std::chrono::milliseconds(30));
        std::string error;
        scene = Scene::load(server.url("terrain.osgb"), error);
        ASSERT_TRUE(scene) << error;
        ASSERT_TRUE(scene->reference) << scene->referenceError;
    }

    /// False without OpenGL.
    bool addView()
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = WIDTH;
        traits->height = HEIGHT;
        const osg::ref_ptr<EglGraphicsContext> context = new EglGraphicsContext(traits);
        if (!context->valid())
        {
            if (glIsRequired()) ADD_FAILURE() << context->error();
            return false;
        }
        windows.push_back(context);
        const osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        osg::Camera& camera = *view->getCamera();
        camera.setGraphicsContext(context);
        camera.setViewport(0, 0, WIDTH, HEIGHT);
        camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e6);
        camera.setLODScale(4.0f);
        scene->setUpView(*view);
        view->setSceneData(scene->node);
        if (viewer->getNumViews() > 0) view->setDatabasePager(viewer->getView(0)->getDatabasePager());
        viewer->addView(view);
        return true;
    }
    void look(unsigned int view, double time)
    {
        ViewPoint point;
        point.longitude = osg::DegreesToRadians(-158.2 + 0.06 * time);
        point.latitude = osg::DegreesToRadians(21.42 + 0.04 * view);
        point.height = 1500.0;
        point.heading = osg::DegreesToRadians(90.0);
        point.pitch = osg::DegreesToRadians(-15.0);
        osg::Matrixd matrix;
        EXPECT_TRUE(point.viewMatrix(*scene->reference, matrix));
        viewer->getView(view)->getCamera()->setViewMatrix(matrix);
    }

    NotifyWatch watch;
    TestServer server{GEOFX_BUILD_DIR "/test-data/oahu"};
    std::optional<Scene> scene;
    osg::ref_ptr<osgViewer::CompositeViewer> viewer = new osgViewer::CompositeViewer;
    std::vector<osg::ref_ptr<EglGraphicsContext>> windows;
};

} // namespace

TEST_P(ServedFlights, AskForEachTileOnce)
{
    viewer->setThreadingModel(GetParam().threading);
    viewer->setKeyEventSetsDone(0);
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setHorizonLine(0.85);
    scene->effects->addEffect(bend);
    const osg::ref_ptr<TilePrefetch> prefetch = new TilePrefetch;
    prefetch->setLead(2.0);
    scene->effects->setPrefetch(prefetch);
    if (!addView() || !addView()) return;
    osgDB::DatabasePager& pager = *viewer->getView(0)->getDatabasePager();
    RemoteFiles::setUpThreads(pager, 1);
    // With it, nothing that was seen is expired and read again.
    const osg::ref_ptr<MemoryBudget> budget = new MemoryBudget(pager);
    budget->setLimits(4096.0, 4096.0);
    budget->watch(*scene->node, *scene->guard);
    scene->node->resizeGLObjectBuffers(contexts);
    look(0, 0.0);
    look(1, 0.0);
    viewer->realize();
    osg::DisplaySettings::instance()->setMaxNumberOfGraphicsContexts(contexts);
    PagerMonitor monitor(&pager, nullptr, 3);
    for (viewer->frame(0.0); !monitor.frameFinished(); viewer->frame(0.0))
        monitor.waitForReads(10.0);
    unsigned int cameras = 0;
    const auto start = Clock::now();
    for (double time = 0.0; time < 4.0;)
    {
        time = std::chrono::duration<double>(Clock::now() - start).count();
        look(0, time);
        look(1, time);
        viewer->frame(time);
        cameras = std::max(cameras, prefetch->counts().cameras);
    }
    const TilePrefetch::Counts counts = prefetch->counts();
    viewer->stopThreading();
    pager.cancel();
    std::map<std::string, int> requests;
    for (const std::string& each : server.requests())
        ++requests[each];
    int twice = 0;
    for (const auto& [name, count] : requests)
        twice += count > 1 ? 1 : 0;
    std::cout << counts.asked << " asked ahead, " << requests.size() << " files, " << twice << " twice\n";
    EXPECT_EQ(cameras, 2u);
    EXPECT_GT(counts.asked, 3u);
    EXPECT_EQ(twice, 0);
    EXPECT_LE(server.mostAtOnce(), 8);
    viewer = nullptr;
    for (const auto& each : windows)
        each->close();
}

INSTANTIATE_TEST_SUITE_P(
    Threads, ServedFlights,
    ::testing::Values(Model{"Single", osgViewer::ViewerBase::SingleThreaded},
                      Model{"DrawThreads", osgViewer::ViewerBase::DrawThreadPerContext},
                      Model{"CullThreads", osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext}),
    [](const ::testing::TestParamInfo<Model>& model) { return std::string(model.param.name); });
