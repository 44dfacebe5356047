// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How a SceneRenderer waits for tiles, and what it leaves as it was.
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <tools/GlFixture.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>

#include <osg/Geode>
#include <osg/ShapeDrawable>

#include <sched.h>

namespace
{

int coresOfThisThread()
{
    cpu_set_t cores;
    CPU_ZERO(&cores);
    return sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 0;
}

/// Counts how often its drawable is culled and drawn.
struct Counts
{
    struct Culled : public osg::DrawableCullCallback
    {
        using osg::DrawableCullCallback::cull;
        bool cull(osg::NodeVisitor*, osg::Drawable*, osg::State*) const override
        {
            ++count;
            return false;
        }
        mutable int count = 0;
    };
    struct Drawn : public osg::Drawable::DrawCallback
    {
        void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
        {
            ++count;
            drawable->drawImplementation(info);
        }
        mutable int count = 0;
    };
    osg::ref_ptr<Culled> culled = new Culled;
    osg::ref_ptr<Drawn> drawn = new Drawn;
};

} // namespace

class SceneRendererTest : public geofx::test::GlFixture
{
};

// A program draws on all cores that it may use, and what it starts afterwards may use them, too.
TEST_F(SceneRendererTest, LeavesTheThreadOnAllCores)
{
    const int before = coresOfThisThread();
    if (before < 2) GTEST_SKIP() << "There is one core.";
    std::string error;
    const osg::ref_ptr<osg::Group> box = new osg::Group;
    box->addChild(new osg::ShapeDrawable(new osg::Box({}, 1.0f)));
    const auto scene = osgGeoFX::Scene::adopt(box, error);
    ASSERT_TRUE(scene) << error;
    osgGeoFX::SceneRenderer::Options options;
    options.width = options.height = 32;
    const auto renderer = osgGeoFX::SceneRenderer::create(*scene, options, error);
    ASSERT_TRUE(renderer) << error;
    osgGeoFX::FrameStatistics statistics;
    EXPECT_TRUE(renderer->render(osg::Matrixd::translate(0.0, 0.0, -5.0), 0.0, statistics, error)) << error;
    EXPECT_EQ(coresOfThisThread(), before);
}

// Frames that wait for tiles only cull: what they would draw nobody sees.
TEST_F(SceneRendererTest, DrawsOnlyWhatIsThere)
{
    const geofx::test::TempDir folder;
    geofx::test::PagedScene::write(folder.path(), geofx::test::PagedScene::Kind::Flat);
    std::string error;
    const auto scene = osgGeoFX::Scene::load((folder / "terrain.osgb").string(), error);
    ASSERT_TRUE(scene) << error;
    const Counts counts;
    const osg::ref_ptr<osg::Drawable> box =
        new osg::ShapeDrawable(new osg::Box({0.0f, 0.0f, 500.0f}, 100.0f));
    box->setUseDisplayList(false);
    box->setCullCallback(counts.culled);
    box->setDrawCallback(counts.drawn);
    scene->effects->addChild(box);
    osgGeoFX::SceneRenderer::Options options;
    options.width = options.height = 64;
    const auto renderer = osgGeoFX::SceneRenderer::create(*scene, options, error);
    ASSERT_TRUE(renderer) << error;
    const auto draw = [&](double height)
    {
        counts.culled->count = counts.drawn->count = 0;
        osgGeoFX::FrameStatistics statistics;
        const osg::ref_ptr<osg::Image> image = renderer->render(
            osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, height), osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0)), 0.0,
            statistics, error);
        EXPECT_TRUE(image) << error;
        return statistics.tilesLoaded;
    };
    EXPECT_GT(draw(20000.0), 0u);
    EXPECT_GE(counts.culled->count, 3) << "a frame for each level, and the picture";
    EXPECT_EQ(counts.drawn->count, 1);
    // All tiles are there already.
    EXPECT_EQ(draw(20000.0), 0u);
    EXPECT_EQ(counts.culled->count, 1);
    EXPECT_EQ(counts.drawn->count, 1);
    // What is not known before: the first frame is drawn in vain, but none of the others.
    EXPECT_GT(draw(6000.0), 0u);
    EXPECT_GE(counts.culled->count, 3);
    EXPECT_EQ(counts.drawn->count, 2);
}
