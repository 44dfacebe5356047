// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Scenes, effects, callbacks, views, windows and contexts are made, replaced and deleted while frames are on their way and tiles
// come and go, in all of OSG's threading models. Run it with AddressSanitizer and ThreadSanitizer, too.
#include <tools/CloseUpSamples.h>
#include <tools/GlRequired.h>
#include <tools/ImageComparison.h>
#include <tools/NotifyWatch.h>
#include <tools/PagedScene.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>

#include <osg/DisplaySettings>
#include <osg/LightSource>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgGeoFX/scene/EffectCullCallback.h>
#include <osgViewer/CompositeViewer>
#include <osgViewer/Renderer>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <typeinfo>
#include <utility>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;
using Threading = osgViewer::ViewerBase::ThreadingModel;

namespace
{

constexpr int WIDTH = 80, HEIGHT = 60;
/// More than there are at a time.
constexpr unsigned int contexts = 64;

/// For objects that are made from now on. OSG's objects make room for a context when they are first drawn or released there,
/// without a lock, and a new context tells OSG to make room for no more than there are now.
void makeRoom()
{
    osg::DisplaySettings::instance()->setMaxNumberOfGraphicsContexts(contexts);
}

constexpr Threading models[] = {osgViewer::ViewerBase::SingleThreaded,
                                osgViewer::ViewerBase::CullDrawThreadPerContext,
                                osgViewer::ViewerBase::DrawThreadPerContext,
                                osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext};

/// Keeps a frame on its way for a while, so that what happens between frames happens before it is drawn, with all its stages.
class LateRenderer : public osgViewer::Renderer
{
public:
    LateRenderer(osg::Camera* camera, int milliseconds) : osgViewer::Renderer(camera), _time(milliseconds) {}
    void draw() override
    {
        std::this_thread::sleep_for(_time);
        osgViewer::Renderer::draw();
    }

private:
    const std::chrono::milliseconds _time;
};

/// Views in windows of their own, which come and go.
class Windows
{
public:
    explicit Windows(Threading model, int late) : _viewer(new osgViewer::CompositeViewer), _late(late)
    {
        _viewer->setThreadingModel(model);
        _viewer->setKeyEventSetsDone(0);
    }
    ~Windows()
    {
        _viewer->stopThreading();
        _viewer = nullptr;
        for (Window& window : _windows)
            window.context->close();
    }
    Windows(const Windows&) = delete;
    Windows& operator=(const Windows&) = delete;

    void open(osg::Node* scene)
    {
        Window window;
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = WIDTH;
        traits->height = HEIGHT;
        traits->alpha = 8;
        window.context = new EglGraphicsContext(traits);
        makeRoom();
        window.view = newView(*window.context, scene);
        window.capture = ImageCapture::attach(window.view->getCamera());
        show(*window.view);
        _windows.push_back(window);
    }
    /// With its context.
    void close(std::size_t i)
    {
        while (removeGuest(i))
        {
        }
        const Window window = _windows[i];
        _windows.erase(_windows.begin() + static_cast<std::ptrdiff_t>(i));
        _viewer->removeView(window.view);
        window.context->close();
    }
    /// One more view in the corner of a window, which has two at most.
    void addGuest(std::size_t i, osg::Node* scene)
    {
        if (_windows[i].guests.size() == 2) return;
        // OSG's threads go through the cameras of a context without a lock.
        _viewer->stopThreading();
        const osg::ref_ptr<osgViewer::View> view = newView(*_windows[i].context, scene);
        view->getCamera()->setViewport(0, 0, WIDTH / 4, HEIGHT / 4);
        show(*view);
        _windows[i].guests.push_back(view);
    }
    /// The context stays. False where there is none.
    bool removeGuest(std::size_t i)
    {
        if (_windows[i].guests.empty()) return false;
        _viewer->stopThreading();
        _viewer->removeView(_windows[i].guests.back());
        _windows[i].guests.pop_back();
        _viewer->startThreading();
        return true;
    }
    std::size_t size() const { return _windows.size(); }
    osgViewer::View& view(std::size_t i) { return *_windows[i].view; }
    void setModel(Threading model) { _viewer->setThreadingModel(model); }
    /// Nearer eyes have more tiles.
    static void look(osgViewer::View* view, double distance, double turn = 0.0)
    {
        const osg::Vec3d eye(distance * std::sin(turn), -distance * std::cos(turn), 0.4 * distance);
        view->getCamera()->setViewMatrixAsLookAt(eye, osg::Vec3d(), osg::Z_AXIS);
    }
    void frame() { _viewer->frame(++_frames / 1000.0); }
    /// Until no frame is on its way, so that the next one is the first to see what follows.
    void settle()
    {
        _viewer->stopThreading();
        _viewer->startThreading();
    }
    /// The picture of the next frame.
    void request(std::size_t i) { _windows[i].capture->request(); }
    osg::ref_ptr<osg::Image> take(std::size_t i) { return _windows[i].capture->take(); }
    /// Of the next frame.
    osg::ref_ptr<osg::Image> picture(std::size_t i)
    {
        frame();
        frame();
        _windows[i].capture->request();
        frame();
        frame();
        return _windows[i].capture->take();
    }

private:
    struct Window
    {
        osg::ref_ptr<EglGraphicsContext> context;
        osg::ref_ptr<osgViewer::View> view;
        osg::ref_ptr<ImageCapture> capture;
        std::vector<osg::ref_ptr<osgViewer::View>> guests;
    };
    osg::ref_ptr<osgViewer::View> newView(EglGraphicsContext& context, osg::Node* scene) const
    {
        osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        osg::Camera& camera = *view->getCamera();
        camera.setGraphicsContext(&context);
        camera.setViewport(0, 0, WIDTH, HEIGHT);
        camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e5);
        camera.setRenderer(new LateRenderer(&camera, _late));
        view->setSceneData(scene);
        look(view, 9000.0);
        return view;
    }
    void show(osgViewer::View& view)
    {
        // A thread that begins before its context is there finds no functions of OpenGL in it.
        _viewer->stopThreading();
        _viewer->addView(&view);
        _viewer->realize();
        makeRoom();
    }
    osg::ref_ptr<osgViewer::CompositeViewer> _viewer;
    const int _late;
    std::vector<Window> _windows;
    int _frames = 0;
};

/// While it lives, counts the tiles in memory.
class LiveTiles
{
public:
    LiveTiles() { osgDB::Registry::instance()->setReadFileCallback(new Reader(_count, _read)); }
    ~LiveTiles() { osgDB::Registry::instance()->setReadFileCallback(nullptr); }
    LiveTiles(const LiveTiles&) = delete;
    LiveTiles& operator=(const LiveTiles&) = delete;

    long count() const { return *_count; }
    /// Those that were read.
    long read() const { return *_read; }

private:
    using Counter = std::shared_ptr<std::atomic<long>>;
    /// Lives as long as its node.
    struct Token : osg::Object
    {
        explicit Token(Counter all = nullptr) : counter(std::move(all)) {}
        Token(const Token& other, const osg::CopyOp& copy) : osg::Object(other, copy) {}
        ~Token() override
        {
            if (counter) --*counter;
        }
        META_Object(geofx_test, Token);
        Counter counter;
    };
    struct Reader : osgDB::ReadFileCallback
    {
        Reader(Counter living, Counter all) : count(std::move(living)), read(std::move(all)) {}
        osgDB::ReaderWriter::ReadResult readNode(const std::string& file,
                                                 const osgDB::Options* options) override
        {
            osgDB::ReaderWriter::ReadResult result = ReadFileCallback::readNode(file, options);
            if (!result.validNode()) return result;
            ++*count;
            ++*read;
            result.getNode()->getOrCreateUserDataContainer()->addUserObject(new Token(count));
            return result;
        }
        const Counter count, read;
    };
    const Counter _count = std::make_shared<std::atomic<long>>(0),
                  _read = std::make_shared<std::atomic<long>>(0);
};

/// Many small things in two colors.
osg::ref_ptr<osg::Group> plain()
{
    osg::ref_ptr<osg::Group> all = new osg::Group;
    for (int i = 0; i < 64; ++i)
    {
        osg::ref_ptr<osg::ShapeDrawable> box =
            new osg::ShapeDrawable(new osg::Box(osg::Vec3(500.0f * static_cast<float>(i % 8) - 1750.0f,
                                                          500.0f * static_cast<float>(i / 8) - 1750.0f, 0.0f),
                                                300.0f));
        box->setColor(i % 3 ? osg::Vec4(0.2f, 0.7f, 0.3f, 1.0f) : osg::Vec4(0.8f, 0.2f, 0.1f, 1.0f));
        box->setUseDisplayList(false);
        box->setUseVertexBufferObjects(true);
        all->addChild(box);
    }
    return all;
}

class LifeAndDeath : public ::testing::TestWithParam<Threading>
{
protected:
    void SetUp() override
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = traits->height = 8;
        const osg::ref_ptr<EglGraphicsContext> context = new EglGraphicsContext(traits);
        makeRoom();
        if (context->valid()) return;
        if (geofx::test::glIsRequired()) FAIL() << context->error();
        GTEST_SKIP() << context->error();
    }

    static osg::ref_ptr<EffectScene> sceneOf(const osg::ref_ptr<Effect>& effect)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
        sun->getLight()->setPosition(osg::Vec4(0.3f, 0.2f, 1.0f, 0.0f));
        scene->addChild(sun);
        scene->addChild(plain());
        scene->addEffect(effect);
        return scene;
    }
    static osg::ref_ptr<BirdsEyeView> bird()
    {
        osg::ref_ptr<BirdsEyeView> effect = new BirdsEyeView;
        effect->setFocusLine(0.3);
        effect->setHorizonLine(0.8);
        return effect;
    }
    static osg::ref_ptr<CloseUps> closeUps(Random& random, CloseUps::Pipeline pipeline)
    {
        CloseUpPlan plan;
        plan.reach = 1200.0;
        osg::ref_ptr<CloseUps> effect = new CloseUps;
        effect->setPipeline(pipeline);
        for (int i = 0; i < 5; ++i)
            effect->addCloseUp(randomCloseUp(random, plan));
        return effect;
    }
    static osg::ref_ptr<SunShadows> shadows()
    {
        osg::ref_ptr<SunShadows> effect = new SunShadows;
        effect->setMapSize(64);
        effect->setCascades(2);
        return effect;
    }

    /// The picture of a scene in one thread.
    static osg::ref_ptr<osg::Image> alone(osg::Node* scene)
    {
        Windows windows(osgViewer::ViewerBase::SingleThreaded, 0);
        windows.open(scene);
        return windows.picture(0);
    }
    static constexpr int replacements = 10;
    static constexpr int late = 10; ///< milliseconds

    NotifyWatch _watch;
};

INSTANTIATE_TEST_SUITE_P(AllModels, LifeAndDeath, ::testing::ValuesIn(models),
                         [](const auto& each) { return "Model" + std::to_string(each.index); });

} // namespace

TEST_P(LifeAndDeath, ASceneIsReplacedInItsView)
{
    const osg::ref_ptr<osg::Image> expected = alone(sceneOf(bird()));
    Windows windows(GetParam(), late);
    windows.open(sceneOf(bird()));
    windows.frame();
    for (int i = 0; i < replacements; ++i)
    {
        windows.frame();
        windows.view(0).setSceneData(sceneOf(bird()));
    }
    EXPECT_TRUE(imagesMatch(*windows.picture(0), *expected, {}, "replaced-scene"));
}

TEST_P(LifeAndDeath, ASceneIsReplacedInAGroup)
{
    const osg::ref_ptr<osg::Image> expected = alone(sceneOf(bird()));
    Windows windows(GetParam(), late);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(sceneOf(bird()));
    windows.open(root);
    windows.frame();
    for (int i = 0; i < replacements; ++i)
    {
        windows.frame();
        root->setChild(0, sceneOf(bird()));
    }
    EXPECT_TRUE(imagesMatch(*windows.picture(0), *expected, {}, "replaced-child"));
}

TEST_P(LifeAndDeath, ACullCallbackIsReplaced)
{
    const osg::ref_ptr<EffectScene> same = new EffectScene;
    same->addChild(plain());
    same->addEffect(bird());
    const osg::ref_ptr<osg::Image> expected = alone(same);
    Windows windows(GetParam(), late);
    const osg::ref_ptr<osg::Group> terrain = plain();
    terrain->setCullingActive(false);
    const auto callback = []
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(bird());
        return osg::ref_ptr<EffectCullCallback>(new EffectCullCallback(scene));
    };
    terrain->setCullCallback(callback());
    windows.open(terrain);
    windows.frame();
    for (int i = 0; i < replacements; ++i)
    {
        windows.frame();
        terrain->setCullCallback(callback());
    }
    EXPECT_TRUE(imagesMatch(*windows.picture(0), *expected, {}, "replaced-callback"));
}

// Those of effects, with their stages, cameras and textures.
TEST_P(LifeAndDeath, AnEffectIsReplaced)
{
    Random random(1);
    const osg::ref_ptr<EffectScene> scene = sceneOf(bird());
    const osg::ref_ptr<osg::Image> expected = alone(scene);
    Windows windows(GetParam(), late);
    windows.open(scene);
    windows.frame();
    for (int i = 0; i < replacements; ++i)
    {
        osg::ref_ptr<Effect> effect;
        if (i % 3 == 2)
            effect = shadows();
        else
            effect = closeUps(random, i % 3 ? CloseUps::MULTI_PASS : CloseUps::SINGLE_PASS);
        scene->addEffect(effect);
        // Also before OpenGL has anything of it.
        for (int frames = i / 3 % 2; frames >= 0; --frames)
            windows.frame();
        scene->removeEffect(effect);
        effect = nullptr;
        if (i % 2) windows.frame();
    }
    EXPECT_TRUE(imagesMatch(*windows.picture(0), *expected, {}, "replaced-effect"));
}

// A frame on its way is drawn whole, with buffers of which OpenGL has nothing yet, though its scene is gone.
TEST_P(LifeAndDeath, TheLastFrameOfASceneIsWhole)
{
    const auto makeScene = [](int kind)
    {
        Random random(3);
        return sceneOf(kind == 0   ? osg::ref_ptr<Effect>(closeUps(random, CloseUps::SINGLE_PASS))
                       : kind == 1 ? osg::ref_ptr<Effect>(closeUps(random, CloseUps::MULTI_PASS))
                       : kind == 2 ? osg::ref_ptr<Effect>(shadows())
                                   : osg::ref_ptr<Effect>(bird()));
    };
    // The same in one thread, with a scene that lives.
    const auto expected = [&](int kind)
    {
        Windows windows(osgViewer::ViewerBase::SingleThreaded, 0);
        windows.open(plain());
        windows.frame();
        windows.view(0).setSceneData(makeScene(kind));
        windows.request(0);
        windows.frame();
        return windows.take(0);
    };
    const osg::ref_ptr<osg::Image> without = alone(plain());
    Windows windows(GetParam(), 3 * late);
    windows.open(plain());
    for (int kind = 0; kind < 4; ++kind)
    {
        SCOPED_TRACE(kind);
        windows.frame();
        windows.frame();
        windows.settle();
        windows.view(0).setSceneData(makeScene(kind));
        windows.request(0);
        windows.frame();
        windows.view(0).setSceneData(plain());
        windows.frame();
        windows.frame();
        const osg::ref_ptr<osg::Image> last = windows.take(0);
        ASSERT_TRUE(last);
        EXPECT_TRUE(imagesMatch(*last, *expected(kind), {}, "last-frame-" + std::to_string(kind)));
        EXPECT_NE(std::memcmp(last->data(), without->data(), last->getTotalSizeInBytes()), 0);
    }
}

TEST_P(LifeAndDeath, AViewGoesWithItsWindow)
{
    const osg::ref_ptr<EffectScene> scene = sceneOf(bird());
    const osg::ref_ptr<osg::Image> expected = alone(scene);
    Windows windows(GetParam(), late);
    windows.open(scene);
    for (int i = 0; i < 4; ++i)
    {
        windows.open(i % 2 ? scene : sceneOf(bird()));
        windows.frame();
        windows.frame();
        windows.close(1);
    }
    EXPECT_TRUE(imagesMatch(*windows.picture(0), *expected, {}, "after-views"));
}

namespace
{

/// What an application may do between two frames, at random.
class Life
{
public:
    Life(Windows& windows, std::uint64_t sample, std::string database)
        : _windows(windows), _random(sample), _database(std::move(database))
    {
        open();
    }

    /// A name of what was done.
    std::string step()
    {
        struct Action
        {
            const char* name;
            int weight;
            void (Life::*run)();
        };
        static constexpr Action actions[] = {{"the camera moves", 8, &Life::move},
                                             {"another scene in the view", 3, &Life::replaceData},
                                             {"another scene in the group", 4, &Life::replaceChild},
                                             {"another callback", 4, &Life::replaceCallback},
                                             {"an effect comes", 5, &Life::addEffect},
                                             {"an effect goes", 5, &Life::removeEffect},
                                             {"an effect is switched", 3, &Life::switchEffect},
                                             {"a window opens", 2, &Life::open},
                                             {"a window closes", 2, &Life::close},
                                             {"a view comes into a window", 2, &Life::addGuest},
                                             {"a view leaves its window", 2, &Life::removeGuest},
                                             {"two views of one scene", 2, &Life::share},
                                             {"nothing to see", 1, &Life::empty},
                                             {"another threading model", 1, &Life::changeModel}};
        int all = 0;
        for (const Action& each : actions)
            all += each.weight;
        int choice = _random.integer(0, all - 1);
        const Action* action = actions;
        while (choice >= action->weight)
            choice -= (action++)->weight;
        (this->*action->run)();
        // Some of what was replaced lives a little longer.
        while (!_replaced.empty() && _random.integer(0, 1))
            _replaced.pop_back();
        for (int frames = _random.integer(0, 2); frames > 0; --frames)
            _windows.frame();
        return action->name;
    }

    /// Views of one new scene.
    void end(osg::Node* scene)
    {
        while (_windows.size() > 1)
            _windows.close(_windows.size() - 1);
        while (_windows.removeGuest(0))
        {
        }
        _windows.view(0).setSceneData(scene);
        Windows::look(&_windows.view(0), 9000.0);
        _replaced.clear();
    }

private:
    std::size_t any()
    {
        return static_cast<std::size_t>(_random.integer(0, static_cast<int>(_windows.size()) - 1));
    }
    osg::Group& rootOf(std::size_t i) { return *_windows.view(i).getSceneData()->asGroup(); }
    /// The scene that a view shows; null for none.
    EffectScene* sceneOf(std::size_t i)
    {
        osg::Group& root = rootOf(i);
        if (root.getNumChildren() == 0) return nullptr;
        if (auto* scene = dynamic_cast<EffectScene*>(root.getChild(0))) return scene;
        auto* callback = dynamic_cast<EffectCullCallback*>(root.getChild(0)->getCullCallback());
        return callback ? callback->getScene() : nullptr;
    }

    osg::ref_ptr<Effect> newEffect(const EffectScene& scene)
    {
        bool bends = false;
        for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
            bends = bends || dynamic_cast<const PerspectiveBend*>(scene.getEffect(i));
        switch (_random.integer(bends ? 2 : 0, 5))
        {
        case 0:
        {
            const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
            bird->setHorizonLine(0.8);
            return bird;
        }
        case 1:
        {
            const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
            walk->setFocusDistance(4000.0);
            walk->setZoneWidth(5000.0);
            return walk;
        }
        case 2:
        {
            const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
            high->setFactor(_random.uniform(1.0, 3.0));
            return high;
        }
        case 3:
        {
            const osg::ref_ptr<SunShadows> shadows = new SunShadows;
            shadows->setMapSize(64);
            shadows->setCascades(2);
            return shadows;
        }
        default:
        {
            CloseUpPlan plan;
            plan.reach = 1200.0;
            const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
            closeUps->setPipeline(_random.integer(0, 1) ? CloseUps::MULTI_PASS : CloseUps::SINGLE_PASS);
            closeUps->addCloseUp(randomCloseUp(_random, plan));
            return closeUps;
        }
        }
    }
    void addEffectTo(EffectScene& scene)
    {
        const osg::ref_ptr<Effect> effect = newEffect(scene);
        // Of each kind, a scene has one.
        for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
            if (typeid(*scene.getEffect(i)) == typeid(*effect)) return;
        scene.addEffect(effect);
    }
    osg::ref_ptr<EffectScene> newEffects()
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        for (int count = _random.integer(1, 3); count > 0; --count)
            addEffectTo(*scene);
        return scene;
    }
    osg::ref_ptr<osg::Group> newTerrain()
    {
        osg::ref_ptr<osg::Group> all = new osg::Group;
        osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
        sun->getLight()->setPosition(osg::Vec4(0.3f, 0.2f, 1.0f, 0.0f));
        all->addChild(sun);
        if (_random.integer(0, 2)) all->addChild(osgDB::readRefNodeFile(_database));
        if (_random.integer(0, 1)) all->addChild(plain());
        return all;
    }
    osg::ref_ptr<osg::Group> newScene()
    {
        const osg::ref_ptr<EffectScene> effects = newEffects();
        osg::ref_ptr<osg::Group> terrain = newTerrain();
        if (_random.integer(0, 2))
        {
            effects->addChild(terrain);
            return effects;
        }
        terrain->setCullingActive(false);
        terrain->setCullCallback(new EffectCullCallback(effects));
        return terrain;
    }
    osg::ref_ptr<osg::Group> newRoot()
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(newScene());
        return root;
    }

    void move()
    {
        Windows::look(&_windows.view(any()), _random.logarithmic(500.0, 60000.0), _random.uniform(-3.0, 3.0));
    }
    void replaceData()
    {
        osgViewer::View& view = _windows.view(any());
        _replaced.emplace_back(view.getSceneData());
        view.setSceneData(newRoot());
    }
    void replaceChild()
    {
        osg::Group& root = rootOf(any());
        if (root.getNumChildren() > 0) _replaced.emplace_back(root.getChild(0));
        root.removeChildren(0, root.getNumChildren());
        root.addChild(newScene());
    }
    void replaceCallback()
    {
        osg::Group& root = rootOf(any());
        osg::Node* const terrain = root.getNumChildren() > 0 ? root.getChild(0) : nullptr;
        if (terrain && dynamic_cast<EffectCullCallback*>(terrain->getCullCallback()))
            terrain->setCullCallback(new EffectCullCallback(newEffects()));
    }
    void addEffect()
    {
        if (EffectScene* scene = sceneOf(any())) addEffectTo(*scene);
    }
    void removeEffect()
    {
        EffectScene* const scene = sceneOf(any());
        if (!scene || scene->getNumEffects() == 0) return;
        const osg::ref_ptr<Effect> effect = scene->getEffect(
            static_cast<unsigned int>(_random.integer(0, static_cast<int>(scene->getNumEffects()) - 1)));
        if (_random.integer(0, 1)) _replaced.emplace_back(effect);
        scene->removeEffect(effect);
    }
    void switchEffect()
    {
        EffectScene* const scene = sceneOf(any());
        if (!scene || scene->getNumEffects() == 0) return;
        Effect* const effect = scene->getEffect(
            static_cast<unsigned int>(_random.integer(0, static_cast<int>(scene->getNumEffects()) - 1)));
        effect->setEnabled(!effect->getEnabled());
    }
    void open()
    {
        if (_windows.size() >= 3) return;
        _windows.open(newRoot());
    }
    void close()
    {
        if (_windows.size() > 1) _windows.close(any());
    }
    void addGuest()
    {
        _windows.addGuest(any(),
                          _random.integer(0, 1) ? newRoot() : osg::ref_ptr<osg::Group>(&rootOf(any())));
    }
    void removeGuest() { _windows.removeGuest(any()); }
    void share()
    {
        // Below one root: OSG's pagers do not share a terrain.
        _windows.view(any()).setSceneData(_windows.view(any()).getSceneData());
    }
    void empty() { rootOf(any()).removeChildren(0, rootOf(any()).getNumChildren()); }
    void changeModel() { _windows.setModel(models[_random.integer(0, 3)]); }

    Windows& _windows;
    Random _random;
    const std::string _database;
    std::vector<osg::ref_ptr<osg::Referenced>> _replaced;
};

} // namespace

// As many steps for each model; the model itself changes now and then.
TEST_P(LifeAndDeath, RandomStepsEndWell)
{
    const osg::ref_ptr<osg::Image> expected = alone(sceneOf(bird()));
    const TempDir folder;
    const std::string database = PagedScene::write(folder.path(), PagedScene::Kind::Flat).string();
    const LiveTiles tiles;
    {
        Windows windows(GetParam(), 2);
        Life life(windows, static_cast<std::uint64_t>(GetParam()), database);
        std::string way;
        for (int i = 0; i < (fullTest() ? 2500 : 30); ++i)
        {
            SCOPED_TRACE("step " + std::to_string(i) + way);
            way = ", after: " + life.step();
        }
        life.end(sceneOf(bird()));
        EXPECT_TRUE(imagesMatch(*windows.picture(0), *expected, {}, "after-random-steps"));
    }
    EXPECT_GT(tiles.read(), 0);
    EXPECT_EQ(tiles.count(), 0) << "tiles whose scenes and views are gone";
}
