// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// A camera above the ground as it is seen, and the wheel and the middle button on deformed ground, in a viewer that never draws.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <osgGeoFX/scene/ShaderHost.h>
#include <osgGeoFX/viewer/AboveGround.h>
#include <osgGeoFX/viewer/GroundGrip.h>
#include <tools/HeightMesh.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>
#include <tools/WindowEvents.h>

#include <osg/Geode>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgGA/AnimationPathManipulator>
#include <osgGA/DriveManipulator>
#include <osgGA/FirstPersonManipulator>
#include <osgGA/FlightManipulator>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgGA/OrbitManipulator>
#include <osgGA/SphericalManipulator>
#include <osgGA/TerrainManipulator>
#include <osgGA/TrackballManipulator>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

double hillAt(double x, double y)
{
    return 300.0 + 200.0 * std::sin(x / 900.0) * std::cos(y / 700.0);
}

osg::Matrixd lookingNorth(const osg::Vec3d& eye, double pitch)
{
    const double rise = osg::DegreesToRadians(pitch);
    return osg::Matrixd::lookAt(eye, eye + osg::Vec3d(0.0, std::cos(rise), std::sin(rise)),
                                osg::Vec3d(0.0, -std::sin(rise), std::cos(rise)));
}

/// OSG's set of osgviewer.
std::vector<osg::ref_ptr<osgGA::CameraManipulator>> allManipulators()
{
    return {new osgGA::TrackballManipulator, new osgGA::FlightManipulator, new osgGA::DriveManipulator,
            new osgGA::TerrainManipulator,   new osgGA::OrbitManipulator,  new osgGA::FirstPersonManipulator,
            new osgGA::SphericalManipulator};
}

/// An engine whose programs draw with the effects' functions, though their texts do not show it.
class Engine : public ShaderHost
{
public:
    bool draws(const osg::StateAttribute&) const override { return true; }
};

class AboveGroundTest : public WindowEvents
{
protected:
    AboveGroundTest()
    {
        scene->addChild(HeightMesh{hillAt}.mesh(200));
        viewer.getCamera()->setProjectionMatrixAsPerspective(40.0, 1280.0 / 720.0, 1.0, 1e6);
    }
    /// The frame's part that moves the camera.
    osg::Vec3d eyeAfter(osgGA::CameraManipulator& manipulator)
    {
        manipulator.updateCamera(*viewer.getCamera());
        return osg::Matrixd::inverse(viewer.getCamera()->getViewMatrix()).getTrans();
    }
    /// The drawn ground below the eye or above it, metres over the eye; found among many places that the effects move.
    double groundOverEye()
    {
        const DeformedView picture(*scene, *viewer.getCamera());
        const osg::Vec3d eye = osg::Matrixd::inverse(viewer.getCamera()->getViewMatrix()).getTrans();
        double highest = -1e9;
        for (double x = -60.0; x <= 60.0; x += 4.0)
        {
            for (double y = -1500.0; y <= 1500.0; y += 2.0)
            {
                const double column = eye.x() + x, row = eye.y() + y;
                const osg::Vec3d drawn = picture.deform({column, row, hillAt(column, row)});
                const osg::Vec3d away = drawn - eye;
                if (std::abs(away.x()) < 4.0 && std::abs(away.y()) < 4.0)
                    highest = std::max(highest, away.z());
            }
        }
        return highest;
    }
    osgGA::GUIEventHandler& handler() override { return *grip; }
    bool scroll(const osg::Vec2d& place, Event::ScrollingMotion motion)
    {
        return send(Event::SCROLL,
                    [&](Event& event)
                    {
                        event.setX(static_cast<float>(place.x() + 10.0));
                        event.setY(static_cast<float>(place.y() + 20.0));
                        event.setScrollingMotion(motion);
                    });
    }
    void addBirdsEye()
    {
        const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setContextTilt(0.3);
        scene->addEffect(bend);
    }

    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<GroundGrip> grip = new GroundGrip(*scene);
};

} // namespace

TEST_F(AboveGroundTest, NoManipulatorOfOsgGoesThroughExaggeratedGround)
{
    const osg::ref_ptr<VerticalExaggeration> effect = new VerticalExaggeration;
    effect->setFactor(3.0);
    scene->addEffect(effect);
    for (const auto& manipulator : allManipulators())
    {
        SCOPED_TRACE(manipulator->className());
        const osg::ref_ptr<AboveGround> above = new AboveGround(*scene, *manipulator);
        above->setNode(scene);
        above->setMargin(5.0);
        // Above the ground, and yet below what is drawn there.
        const osg::Vec3d eye(700.0, 200.0, hillAt(700.0, 200.0) + 100.0);
        above->setByInverseMatrix(lookingNorth(eye, -10.0));
        const osg::Vec3d wished = osg::Matrixd::inverse(manipulator->getInverseMatrix()).getTrans();
        const osg::Vec3d risen = eyeAfter(*above);
        EXPECT_NEAR(risen.z(), 3.0 * hillAt(risen.x(), risen.y()) + 5.0, 1.0);
        EXPECT_NEAR(risen.x(), wished.x(), 0.01);
        EXPECT_NEAR(risen.y(), wished.y(), 0.01);
        // It looks as it did.
        osg::Matrixd turned = viewer.getCamera()->getViewMatrix(), before = lookingNorth(eye, -10.0);
        if (std::string(manipulator->className()) != "Spherical Manipulator")
        {
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k)
                    EXPECT_NEAR(turned(i, k), before(i, k), 1e-6);
        }
        // And it rests there.
        EXPECT_LT((eyeAfter(*above) - risen).length(), 0.5);
        // Far above it nothing happens.
        above->setByInverseMatrix(lookingNorth(eye + osg::Vec3d(0.0, 0.0, 2000.0), -10.0));
        const osg::Vec3d high = osg::Matrixd::inverse(manipulator->getInverseMatrix()).getTrans();
        EXPECT_LT((eyeAfter(*above) - high).length(), 1e-6);
    }
}

TEST_F(AboveGroundTest, TheEyeStaysAboveAGroundThatFoldsUpBelowIt)
{
    const osg::ref_ptr<PedestrianView> bend = new PedestrianView;
    // The zone lies below the eye.
    bend->setFocusDistance(-900.0);
    bend->setZoneWidth(2500.0);
    bend->setBendAngle(osg::DegreesToRadians(40.0));
    scene->addEffect(bend);
    const osg::ref_ptr<AboveGround> above = new AboveGround(*scene, *new osgGA::FirstPersonManipulator);
    const double level = hillAt(100.0, 100.0);
    for (const double height : {-60.0, 3.0, 40.0, 100.0})
    {
        above->setByInverseMatrix(lookingNorth({100.0, 100.0, level + height}, -15.0));
        eyeAfter(*above);
        EXPECT_LT(groundOverEye(), 0.0) << height << " m above the ground that is not bent";
        EXPECT_NEAR(AboveGround::rise(*scene, viewer.getCamera()->getViewMatrix(), *viewer.getCamera(), 2.0),
                    0.0, 0.05);
    }
    above->setEnabled(false);
    above->setByInverseMatrix(lookingNorth({100.0, 100.0, level + 3.0}, -15.0));
    eyeAfter(*above);
    EXPECT_GT(groundOverEye(), 10.0) << "without it the eye is below the ground that is seen";
}

// As before finer tiles have come.
TEST_F(AboveGroundTest, TrianglesThatSpanABendAreFollowedAlongIt)
{
    scene->removeChildren(0, scene->getNumChildren());
    scene->addChild(HeightMesh{
        [](double, double)
        {
            return 50.0;
        }}.mesh(3));
    scene->addEffect(new PedestrianView);
    viewer.getCamera()->setViewMatrix(lookingNorth({700.0, 200.0, 400.0}, -25.0));
    EXPECT_EQ(AboveGround::rise(*scene, viewer.getCamera()->getViewMatrix(), *viewer.getCamera(), 2.0), 0.0);
    viewer.getCamera()->setViewMatrix(lookingNorth({700.0, 200.0, 20.0}, -25.0));
    EXPECT_NEAR(AboveGround::rise(*scene, viewer.getCamera()->getViewMatrix(), *viewer.getCamera(), 2.0),
                32.0, 0.1);
    viewer.getCamera()->setViewMatrix(lookingNorth({700.0, 200.0, 400.0}, -25.0));
    const DeformedView picture(*scene, *viewer.getCamera());
    for (const double y : {20.0, 150.0, 360.0, 600.0})
    {
        const auto drawn = picture.pick(0.5 * WIDTH, y), place = picture.pickCurved(0.5 * WIDTH, y);
        ASSERT_TRUE(place) << y;
        EXPECT_NEAR(place->world.z(), 50.0, 2.0) << y;
        osg::Vec2d shown;
        ASSERT_TRUE(picture.project(place->world, shown));
        EXPECT_LT((shown - osg::Vec2d(0.5 * WIDTH, y)).length(), 0.1);
        EXPECT_FALSE(drawn && std::abs(drawn->world.z() - 50.0) < 20.0)
            << "the triangles are too small for this test";
    }
}

TEST_F(AboveGroundTest, BendsThatFollowTheEyeAreLookedAtAgain)
{
    addBirdsEye();
    const osg::ref_ptr<AboveGround> above = new AboveGround(*scene, *new osgGA::TerrainManipulator);
    above->setNode(scene);
    above->setByInverseMatrix(lookingNorth({0.0, 0.0, 150.0}, -40.0));
    eyeAfter(*above);
    EXPECT_LT(groundOverEye(), 0.0);
}

TEST_F(AboveGroundTest, PathsAreLeftAloneAndThingsHoldNobodyUp)
{
    const osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->insert(0.0, osg::AnimationPath::ControlPoint(osg::Vec3d(0.0, 0.0, 10.0)));
    const osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> chosen = new osgGA::KeySwitchMatrixManipulator;
    chosen->addMatrixManipulator('1', "Path", new osgGA::AnimationPathManipulator(path));
    chosen->addMatrixManipulator('2', "Trackball", new osgGA::TrackballManipulator);
    const osg::ref_ptr<AboveGround> above = new AboveGround(*scene, *chosen);
    EXPECT_FALSE(AboveGround::isFree(above));
    EXPECT_STREQ(AboveGround::movingOne(above)->className(), "AnimationPath");
    viewer.getCamera()->setViewMatrix(osg::Matrixd::inverse(chosen->getMatrix()));
    EXPECT_LT((eyeAfter(*above) - chosen->getMatrix().getTrans()).length(), 1e-9);
    chosen->selectMatrixManipulator(1);
    EXPECT_TRUE(AboveGround::isFree(above));
    EXPECT_FALSE(AboveGround::isFree(nullptr));

    const osg::ref_ptr<RigidReference> house = new RigidReference;
    const osg::ref_ptr<osg::Geode> box = new osg::Geode;
    box->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(0.0f, 0.0f, 400.0f), 80.0f)));
    house->addChild(box);
    scene->addChild(house);
    const osg::Vec3d inside(0.0, 0.0, 400.0);
    above->setByInverseMatrix(lookingNorth(inside, -10.0));
    EXPECT_LT((eyeAfter(*above) - inside).length(), 1e-6);
}

TEST_F(AboveGroundTest, GroundOfAnEngineIsWhereItsHostDrawsIt)
{
    const osg::ref_ptr<VerticalExaggeration> effect = new VerticalExaggeration;
    effect->setFactor(3.0);
    scene->addEffect(effect);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, "void main() { gl_Position = ftransform(); }"));
    scene->getChild(0)->getOrCreateStateSet()->setAttribute(program);
    const osg::Vec3d eye(700.0, 200.0, 5000.0);
    const double height = hillAt(eye.x(), eye.y());
    viewer.getCamera()->setViewMatrix(lookingNorth(eye, -89.999));
    const auto seen = [&]
    {
        return eye.z() - DeformedView(*scene, *viewer.getCamera()).pick(0.5 * WIDTH, 0.5 * HEIGHT)->distance;
    };
    const auto rise = [&]
    {
        return AboveGround::rise(*scene, lookingNorth({700.0, 200.0, 0.0}, -10.0), *viewer.getCamera(), 2.0);
    };
    EXPECT_NEAR(seen(), height, 2.0) << "a program that draws by itself";
    EXPECT_NEAR(rise(), height + 2.0, 2.0);
    scene->setShaderHost(new Engine);
    EXPECT_NEAR(seen(), 3.0 * height, 2.0);
    EXPECT_NEAR(rise(), 3.0 * height + 2.0, 2.0);
}

TEST_F(AboveGroundTest, TheWheelGoesToThePlaceBelowThePointer)
{
    addBirdsEye();
    for (const auto& manipulator : allManipulators())
    {
        if (std::string(manipulator->className()) == "Spherical Manipulator") continue;
        SCOPED_TRACE(manipulator->className());
        viewer.setCameraManipulator(new AboveGround(*scene, *manipulator), false);
        for (const osg::Vec2d& pixel :
             {osg::Vec2d(640.0, 150.0), osg::Vec2d(400.0, 380.0), osg::Vec2d(900.0, 520.0)})
        {
            manipulator->setByInverseMatrix(lookingNorth({0.0, -6000.0, 2500.0}, -42.0));
            viewer.getCamera()->setViewMatrix(manipulator->getInverseMatrix());
            const auto hit = DeformedView(*scene, *viewer.getCamera()).pick(pixel.x(), pixel.y());
            ASSERT_TRUE(hit);
            double away = (hit->world - osg::Vec3d(0.0, -6000.0, 2500.0)).length();
            for (int i = 0; i < 4; ++i)
            {
                ASSERT_TRUE(scroll(pixel, Event::SCROLL_UP));
                osg::Vec2d shown;
                const DeformedView after(*scene, *viewer.getCamera());
                ASSERT_TRUE(after.project(hit->world, shown));
                EXPECT_LT((shown - pixel).length(), 1.0);
                const double left = (hit->world * viewer.getCamera()->getViewMatrix()).length();
                EXPECT_LT(left, 0.97 * away);
                EXPECT_GT(left, 0.5 * away);
                away = left;
            }
            const double height = osg::Matrixd::inverse(viewer.getCamera()->getViewMatrix()).getTrans().z();
            ASSERT_TRUE(scroll(pixel, Event::SCROLL_DOWN));
            EXPECT_GT(osg::Matrixd::inverse(viewer.getCamera()->getViewMatrix()).getTrans().z(), height);
        }
    }
    EXPECT_FALSE(scroll({640.0, 719.0}, Event::SCROLL_UP)) << "the sky is nobody's";
    scene->removeEffect(scene->getEffect(0));
    EXPECT_FALSE(scroll({640.0, 150.0}, Event::SCROLL_UP))
        << "OSG's manipulators know ground that is not deformed";
}

TEST_F(AboveGroundTest, TheMiddleButtonDragsTheGroundAlsoOfAGlobe)
{
    TempDir folder;
    addBirdsEye();
    const osg::ref_ptr<osg::Node> globe =
        osgDB::readRefNodeFile(PagedScene::write(folder.path(), PagedScene::Kind::Geocentric).string());
    ASSERT_TRUE(globe);
    for (const bool round : {false, true})
    {
        osg::Matrixd toLocal;
        if (round)
        {
            scene->removeChildren(0, scene->getNumChildren());
            scene->addChild(globe);
            toLocal.invert(PagedScene::placement(PagedScene::Kind::Geocentric));
        }
        viewer.setCameraManipulator(new osgGA::TrackballManipulator, false);
        const double scale = round ? 0.15 : 1.0;
        viewer.getCameraManipulator()->setByInverseMatrix(
            toLocal * lookingNorth(osg::Vec3d(0.0, -6000.0, 2500.0) * scale, -42.0));
        viewer.getCamera()->setViewMatrix(viewer.getCameraManipulator()->getInverseMatrix());
        const osg::Vec2d from(500.0, 400.0), to(580.0, 370.0);
        const auto hit = DeformedView(*scene, *viewer.getCamera()).pick(from.x(), from.y());
        ASSERT_TRUE(hit);
        const auto height = [&]
        {
            return (osg::Matrixd::inverse(viewer.getCamera()->getViewMatrix()).getTrans() * toLocal).z();
        };
        const double before = height();
        ASSERT_TRUE(mouse(Event::PUSH, from, Event::MIDDLE_MOUSE_BUTTON));
        EXPECT_TRUE(mouse(Event::DRAG, (from + to) * 0.5, Event::MIDDLE_MOUSE_BUTTON));
        EXPECT_TRUE(mouse(Event::DRAG, to, Event::MIDDLE_MOUSE_BUTTON));
        osg::Vec2d shown;
        ASSERT_TRUE(DeformedView(*scene, *viewer.getCamera()).project(hit->world, shown));
        EXPECT_LT((shown - to).length(), 1.0);
        EXPECT_NEAR(height(), before, round ? 1.0 : 1e-6);
        // Into the sky: it stays where it is.
        const osg::Matrixd last = viewer.getCamera()->getViewMatrix();
        EXPECT_TRUE(mouse(Event::DRAG, {580.0, 719.0}, Event::MIDDLE_MOUSE_BUTTON));
        osg::Vec2d still;
        ASSERT_TRUE(DeformedView(*scene, *viewer.getCamera()).project(hit->world, still));
        EXPECT_LT((still - to).length(), 1.0);
        EXPECT_TRUE(mouse(Event::RELEASE, to, Event::MIDDLE_MOUSE_BUTTON));
        EXPECT_FALSE(mouse(Event::DRAG, from, Event::MIDDLE_MOUSE_BUTTON));
        EXPECT_FALSE(mouse(Event::PUSH, from, Event::LEFT_MOUSE_BUTTON)) << "other buttons are others'";
    }
}
