// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Mappings in all of OSG's threading models and in several views, while they change: always the picture that one thread
// draws. Run with ThreadSanitizer, too: ./tests/run --preset tsan.
#include <tools/MappingStage.h>
#include <tools/RandomSamples.h>
#include <tools/ThreadedViews.h>

#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr int WIDTH = 120, HEIGHT = 90;

/// From an eye to the middle.
osg::ref_ptr<osg::Camera> cameraAt(const osg::Vec3d& eye)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setViewport(0, 0, WIDTH, HEIGHT);
    camera->setClearColor({0, 0, 0, 1});
    camera->setProjectionMatrixAsPerspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 5000.0);
    camera->setViewMatrixAsLookAt(eye, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    return camera;
}

} // namespace

class MappingThreads : public MappingStage
{
protected:
    using Pictures = std::vector<osg::ref_ptr<osg::Image>>;

    static osg::ref_ptr<ProjectiveMapping> makeOne(Random& random)
    {
        const osg::Vec2d center(random.uniform(-150.0, 150.0), random.uniform(-150.0, 150.0));
        const double size = random.uniform(5.0, 60.0);
        const osg::Vec3d color = colorOf(random.integer(0, 1000));
        const int side = 1 << random.integer(2, 6);
        const osg::ref_ptr<ProjectiveMapping> mapping =
            random.integer(0, 2) ? makePicture(center, size, makeImage(side, color))
                                 : makeSolid(center, size, color);
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
            if (what == 2) one->setCenter({random.uniform(-150.0, 150.0), random.uniform(-150.0, 150.0)});
            if (what == 3) one->setEnabled(!one->getEnabled());
            if (what == 4) one->getTransfer()->setHue(random.uniform(-3.0, 3.0));
            if (what == 5 && one->getLayer())
                one->getLayer()->setImage(makeImage(1 << random.integer(2, 6), colorOf(i)));
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
    static Pictures play(ThreadedViews::Threading model, int frames)
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->setPageSide(64);
        mappings->setMaxPages(512);
        const osg::ref_ptr<EffectScene> scene = sceneOf(mappings);
        const osg::ref_ptr<EffectScene> other = sceneOf(mappings);
        ThreadedViews views(model);
        views.add(scene, *cameraAt({0.0, -150.0, 250.0}));
        views.add(scene, *cameraAt({100.0, 50.0, 200.0}));
        views.add(other, *cameraAt({0.0, 10.0, 300.0}));
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
    const Pictures expected = play(ThreadedViews::models[0], frames);
    ASSERT_FALSE(expected.empty());
    for (const auto& picture : expected)
        ASSERT_TRUE(picture);
    EXPECT_GT(differing(*expected[0], *expected[3]), WIDTH * HEIGHT / 4);
    EXPECT_GT(differing(*expected[0], *expected[1]), WIDTH * HEIGHT / 4);
    for (const auto model : ThreadedViews::models)
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

TEST_F(MappingThreads, EachViewHasItsPages)
{
    const osg::Vec3d eyes[] = {{0.0, -150.0, 250.0}, {100.0, 50.0, 200.0}};
    Pictures expected;
    for (const auto model : ThreadedViews::models)
    {
        SCOPED_TRACE("threading model " + std::to_string(model));
        Random random(6);
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->setCaching(ProjectiveMappings::AUTOMATIC);
        for (int i = 0; i < 60; ++i)
            mappings->addMapping(makeOne(random));
        const osg::ref_ptr<EffectScene> scene = sceneOf(mappings);
        ThreadedViews views(model);
        for (const osg::Vec3d& eye : eyes)
            views.add(scene, *cameraAt(eye));
        views.realize();
        // One moves, and comes to rest.
        for (int i = 0; i < 40; ++i)
        {
            mappings->getMapping(7)->setCenter({5.0 * i - 100.0, 3.0 * i - 80.0});
            views.frame();
        }
        for (int i = 0; i < 100 && !mappings->cacheStatistics().settled; ++i)
            views.frame();
        const Pictures both = views.pictures();
        EXPECT_EQ(mappings->cacheStatistics().reason, "");
        EXPECT_GT(mappings->cacheStatistics().pagedFrames, 0u);
        for (std::size_t i = 0; i < 2; ++i)
        {
            ASSERT_TRUE(both[i]);
            if (expected.size() < 2)
                expected.push_back(both[i]);
            else
                EXPECT_EQ(differing(*both[i], *expected[i]), 0) << i;
        }
    }
    EXPECT_GT(differing(*expected[0], *expected[1]), WIDTH * HEIGHT / 4);
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
        ThreadedViews views(osgViewer::ViewerBase::SingleThreaded);
        views.add(scene, *cameraAt(eye));
        views.realize();
        alone.push_back(views.pictures().front());
        ASSERT_TRUE(alone.back());
    }
    for (const auto model : ThreadedViews::models)
    {
        ThreadedViews views(model);
        for (const osg::Vec3d& eye : eyes)
            views.add(scene, *cameraAt(eye));
        views.realize();
        const Pictures both = views.pictures();
        for (std::size_t i = 0; i < 2; ++i)
        {
            ASSERT_TRUE(both[i]);
            EXPECT_TRUE(same(*both[i], *alone[i])) << "view " << i << " in model " << model;
        }
    }
}
