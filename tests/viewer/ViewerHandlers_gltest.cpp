// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The viewer's event handlers, with events put into the queue of an off-screen viewer.
#include <osgGeoFX/viewer/Scene.h>
#include <osgGeoFX/viewer/SunKeys.h>
#include <osgGeoFX/viewer/ViewerHandlers.h>
#include <tools/GlFixture.h>
#include <tools/PagedScene.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

using geofx::test::PagedScene;
using osgGeoFX::Scene;

namespace
{

class ViewerHandlers : public geofx::test::GlFixture
{
protected:
    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        std::string error;
        _scene = Scene::load(PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric).string(), error);
        ASSERT_TRUE(_scene) << error;
        viewer().setSceneData(_scene->node);
        viewer().getCamera()->setProjectionMatrixAsPerspective(30.0, 1.0, 1.0, 1e5);
        const osg::Matrixd down =
            osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, 8000.0), osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0));
        viewer().getCamera()->setViewMatrix(
            osg::Matrixd::inverse(PagedScene::placement(PagedScene::Kind::Geocentric)) * down);
    }

    void frames(int count)
    {
        for (int i = 0; i < count; ++i)
        {
            viewer().frame();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }

    geofx::test::TempDir _folder;
    std::optional<Scene> _scene;
};

} // namespace

TEST_F(ViewerHandlers, CursorReadoutTellsThePlaceBelowThePointer)
{
    osg::ref_ptr<osgGeoFX::CursorReadout> readout = new osgGeoFX::CursorReadout(*_scene);
    viewer().addEventHandler(readout);
    viewer().getEventQueue()->setMouseInputRange(0.0f, 0.0f, 256.0f, 256.0f);
    viewer().getEventQueue()->mouseMotion(128.0f, 128.0f);
    frames(6);
    EXPECT_EQ(readout->text(), "") << "it is shown before anyone asked";
    // osgText updates its vertices in a buffer that it has told OpenGL is static, and Mesa says so.
    const std::vector<std::string> messages = watch().messagesOf(
        [&]
        {
            viewer().getEventQueue()->keyPress('c');
            viewer().getEventQueue()->keyRelease('c');
            viewer().getEventQueue()->mouseMotion(128.5f, 128.0f);
            frames(6);
        });
    for (const std::string& message : messages)
    {
        EXPECT_NE(message.find("GL_STATIC_DRAW"), std::string::npos) << message;
    }
    double longitude = 0.0;
    double latitude = 0.0;
    double height = 0.0;
    ASSERT_EQ(std::sscanf(readout->text().c_str(), "%lf W %lf N %lf m", &longitude, &latitude, &height), 3)
        << readout->text();
    EXPECT_NEAR(longitude, 157.8, 2e-4) << "half a pixel is 8 m";
    EXPECT_NEAR(latitude, 21.4, 2e-4);
    EXPECT_NEAR(height, 100.0, 0.2);

    watch().messagesOf(
        [&]
        {
            viewer().getEventQueue()->mouseMotion(1.0f, 1.0f);
            frames(6);
        });
    EXPECT_EQ(readout->text(), "") << "beside the terrain";
    viewer().getEventQueue()->keyPress('c');
    frames(2);
    EXPECT_EQ(readout->text(), "");
}

TEST_F(ViewerHandlers, LodScaleFollowsTheWindowAndKeepsTheKeys)
{
    viewer().addEventHandler(new osgGeoFX::LodScaleFollower(*_scene));
    osg::Camera& camera = *viewer().getCamera();
    frames(2);
    EXPECT_FLOAT_EQ(camera.getLODScale(), 1.0f) << "256 lines are less than the database was made for";
    camera.setProjectionMatrixAsPerspective(1.0, 1.0, 1.0, 1e5);
    frames(2);
    const double perRadian = 256.0 / (2.0 * std::tan(osg::DegreesToRadians(0.5)));
    const float expected = static_cast<float>(2077.0 / perRadian);
    EXPECT_FLOAT_EQ(camera.getLODScale(), expected);
    camera.setLODScale(camera.getLODScale() * 2.0f);
    frames(2);
    EXPECT_FLOAT_EQ(camera.getLODScale(), 2.0f * expected);
    camera.setProjectionMatrixAsPerspective(30.0, 1.0, 1.0, 1e5);
    frames(2);
    EXPECT_FLOAT_EQ(camera.getLODScale(), 2.0f);
}

TEST(ViewerProgram, SaysWhatIsWrong)
{
    const std::pair<std::vector<std::string>, std::string> cases[] = {
        {{"terrain.osgb"}, "no X display"},
        {{}, "Name a file"},
        {{"--nonsense", "terrain.osgb"}, "--nonsense"},
        {{"--fov", "200", "terrain.osgb"}, "--fov"},
        {{"--effect", "closeUps", "terrain.osgb"}, "closeUps draws nothing, because it has no close-up"},
        {{"--effect", "projectiveMappings", "terrain.osgb"}, "draws nothing, because it has no mapping"},
        {{"-p", "missing.path", "terrain.osgb"}, "missing.path"},
    };
    for (const auto& [arguments, word] : cases)
    {
        std::vector<std::string> line = {geofx::test::builtProgram("osggeofx_viewer")};
        line.insert(line.end(), arguments.begin(), arguments.end());
        geofx::test::ProgramOptions options;
        options.environment = {"DISPLAY="};
        const auto result = geofx::test::runProgram(line, options);
        EXPECT_EQ(result.exitCode, 2) << result.standardError;
        EXPECT_NE(result.standardError.find(word), std::string::npos) << result.standardError;
    }
}

TEST(ViewerProgram, HasAHelpPage)
{
    const auto result = geofx::test::runProgram({geofx::test::builtProgram("osggeofx_viewer"), "--help"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_NE(result.standardOutput.find("--fov"), std::string::npos);
    EXPECT_NE(result.standardOutput.find("--SingleThreaded"), std::string::npos);
}

TEST_F(ViewerHandlers, KeysMoveTheSun)
{
    const osg::ref_ptr<osgGeoFX::SunLight> sun = new osgGeoFX::SunLight;
    sun->setTime(*osgGeoFX::readClockTime("2026-06-21T07:30:00-10:00"));
    EXPECT_FALSE(osgGeoFX::SunKeys(*_scene->node).hasSun());
    _scene->node->asGroup()->addChild(sun);
    const osg::ref_ptr<osgGeoFX::SunKeys> keys = new osgGeoFX::SunKeys(*_scene->node);
    ASSERT_TRUE(keys->hasSun());
    viewer().addEventHandler(keys);
    viewer().frame();
    const osg::Vec4 before = sun->getLight()->getPosition();
    EXPECT_EQ(keys->text(), "");
    viewer().getEventQueue()->keyPress('j');
    viewer().frame();
    EXPECT_EQ(keys->text().substr(0, 25), "2026-06-21T08:00:00-10:00");
    EXPECT_NE(sun->getLight()->getPosition(), before);
    for (int i = 0; i < 2; ++i)
        viewer().getEventQueue()->keyPress('J');
    viewer().frame();
    EXPECT_EQ(keys->text().substr(0, 25), "2026-06-21T07:00:00-10:00");
    viewer().getEventQueue()->keyPress('j');
    viewer().frame();
    EXPECT_EQ(sun->getLight()->getPosition(), before);
    // The text goes by itself.
    for (int i = 0; i < 300 && !keys->text().empty(); ++i)
        frames(1);
    EXPECT_EQ(keys->text(), "");
}
