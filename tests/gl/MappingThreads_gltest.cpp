// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Mappings in all of OSG's threading models and in several views, while they change: always the picture that one thread
// draws. Run with ThreadSanitizer, too: ./tests/run --preset tsan.
#include <tools/MappingStage.h>
#include <tools/RandomSamples.h>

#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgViewer/CompositeViewer>

#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;
using Threading = osgViewer::ViewerBase::ThreadingModel;

namespace
{

constexpr int WIDTH = 120, HEIGHT = 90;

constexpr Threading models[] = {osgViewer::ViewerBase::SingleThreaded,
                                osgViewer::ViewerBase::CullDrawThreadPerContext,
                                osgViewer::ViewerBase::DrawThreadPerContext,
                                osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext};

/// Views of scenes, each with a context of its own.
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
        for (const auto& context : _contexts)
            context->close();
    }
    Views(const Views&) = delete;
    Views& operator=(const Views&) = delete;

    void add(osg::Node* scene, const osg::Vec3d& eye)
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = WIDTH;
        traits->height = HEIGHT;
        traits->alpha = 8;
        _contexts.push_back(new EglGraphicsContext(traits));
        osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        view->setLightingMode(osg::View::NO_LIGHT);
        osg::Camera& camera = *view->getCamera();
        camera.setGraphicsContext(_contexts.back());
        camera.setViewport(0, 0, WIDTH, HEIGHT);
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setClearColor({0, 0, 0, 1});
        camera.setProjectionMatrixAsPerspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 5000.0);
        camera.setViewMatrixAsLookAt(eye, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
        _captures.push_back(ImageCapture::attach(&camera));
        view->setSceneData(scene);
        _viewer->addView(view);
    }
    void realize() { _viewer->realize(); }
    void frame() { _viewer->frame(++_time / 1000.0); }
    /// The pictures of the next frame; the frames on their way may be of an older state.
    std::vector<osg::ref_ptr<osg::Image>> pictures()
    {
        frame();
        frame();
        for (const auto& capture : _captures)
            capture->request();
        frame();
        frame();
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (const auto& capture : _captures)
            images.push_back(capture->take());
        return images;
    }

private:
    osg::ref_ptr<osgViewer::CompositeViewer> _viewer;
    std::vector<osg::ref_ptr<EglGraphicsContext>> _contexts;
    std::vector<osg::ref_ptr<ImageCapture>> _captures;
    int _time = 0;
};

} // namespace

class MappingThreads : public MappingStage
{
protected:
    using Pictures = std::vector<osg::ref_ptr<osg::Image>>;

    static osg::ref_ptr<ProjectiveMapping> makeOne(Random& random)
    {
        const osg::Vec2d centre(random.uniform(-150.0, 150.0), random.uniform(-150.0, 150.0));
        const double size = random.uniform(5.0, 60.0);
        const osg::Vec3d colour = colourOf(random.integer(0, 1000));
        const int side = 1 << random.integer(2, 6);
        const osg::ref_ptr<ProjectiveMapping> mapping =
            random.integer(0, 2) ? makePicture(centre, size, makeImage(side, colour))
                                 : makeSolid(centre, size, colour);
        mapping->setOpacity(random.uniform(0.4, 1.0));
        mapping->setOrder(random.integer(-1, 1));
        return mapping;
    }
    /// What happens between two frames.
    static void change(ProjectiveMappings& mappings, Random& random)
    {
        const int many = random.integer(0, 19) == 0 ? 300 : 5;
        for (int i = 0; i < many; ++i)
        {
            const int count = static_cast<int>(mappings.getNumMappings());
            const int what = count < 20 ? 0 : random.integer(0, 5);
            const osg::ref_ptr<ProjectiveMapping> one =
                count ? mappings.getMapping(static_cast<unsigned int>(random.integer(0, count - 1)))
                      : nullptr;
            if (what == 0) mappings.addMapping(makeOne(random));
            if (what == 1) mappings.removeMapping(one);
            if (what == 2) one->setCentre({random.uniform(-150.0, 150.0), random.uniform(-150.0, 150.0)});
            if (what == 3) one->setEnabled(!one->getEnabled());
            if (what == 4) one->getTransfer()->setHue(random.uniform(-3.0, 3.0));
            if (what == 5 && one->getLayer())
                one->getLayer()->setImage(makeImage(1 << random.integer(2, 6), colourOf(i)));
        }
        mappings.setWholeList(random.integer(0, 3) == 0);
    }
    static osg::ref_ptr<EffectScene> sceneOf(ProjectiveMappings* mappings)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(mappings);
        scene->addChild(makeGround());
        return scene;
    }

    /// Pictures on the way and at the end: two views of one scene, and one of another scene with the same mappings.
    static Pictures play(Threading model, int frames)
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->setPageSide(64);
        mappings->setMaxPages(512);
        const osg::ref_ptr<EffectScene> scene = sceneOf(mappings);
        const osg::ref_ptr<EffectScene> other = sceneOf(mappings);
        Views views(model);
        views.add(scene, {0.0, -150.0, 250.0});
        views.add(scene, {100.0, 50.0, 200.0});
        views.add(other, {0.0, 10.0, 300.0});
        views.realize();
        Pictures all;
        Random random(11);
        for (int i = 0; i < frames; ++i)
        {
            change(*mappings, random);
            views.frame();
            if (i % 20 != 19) continue;
            for (const auto& image : views.pictures())
                all.push_back(image);
        }
        return all;
    }
};

TEST_F(MappingThreads, AllModelsDrawTheSame)
{
    const int frames = fullTest() ? 600 : 80;
    const Pictures expected = play(models[0], frames);
    ASSERT_FALSE(expected.empty());
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_TRUE(expected[i]);
    EXPECT_GT(differing(*expected[0], *expected[3]), WIDTH * HEIGHT / 4);
    EXPECT_GT(differing(*expected[0], *expected[1]), WIDTH * HEIGHT / 4);
    for (const Threading model : models)
    {
        SCOPED_TRACE("threading model " + std::to_string(model));
        const Pictures found = play(model, frames);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            ASSERT_TRUE(found[i]);
            // Where layers lie in their pages follows addresses in memory, and so does the last bit of filters.
            EXPECT_EQ(differing(*found[i], *expected[i]), 0) << "picture " << i;
        }
    }
}

TEST_F(MappingThreads, EachViewDrawsWhatOneAloneDraws)
{
    Random random(5);
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    for (int i = 0; i < 100; ++i)
        mappings->addMapping(makeOne(random));
    const osg::Vec3d eyes[] = {{0.0, -150.0, 250.0}, {100.0, 50.0, 200.0}};
    const osg::ref_ptr<EffectScene> scene = sceneOf(mappings);
    Pictures alone;
    for (const osg::Vec3d& eye : eyes)
    {
        Views views(models[0]);
        views.add(scene, eye);
        views.realize();
        alone.push_back(views.pictures().front());
        ASSERT_TRUE(alone.back());
    }
    for (const Threading model : models)
    {
        Views views(model);
        for (const osg::Vec3d& eye : eyes)
            views.add(scene, eye);
        views.realize();
        const Pictures both = views.pictures();
        for (std::size_t i = 0; i < 2; ++i)
        {
            ASSERT_TRUE(both[i]);
            EXPECT_TRUE(same(*both[i], *alone[i])) << "view " << i << " in model " << model;
        }
    }
}
