// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a SceneRenderer leaves as it was.
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <tools/GlFixture.h>

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
