// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Handles of bends, with events made by hand, in a viewer that never draws.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/BendHandles.h>
#include <tools/HeightMesh.h>
#include <tools/WindowEvents.h>

#include <osgText/Text>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

double hillAt(double x, double y)
{
    return 60.0 + 50.0 * std::sin(x / 900.0) * std::cos(y / 700.0);
}

class BendHandlesTest : public WindowEvents
{
protected:
    BendHandlesTest()
    {
        scene->addChild(HeightMesh{hillAt}.mesh(200));
        osg::Camera& camera = *viewer.getCamera();
        camera.setProjectionMatrixAsPerspective(40.0, 1280.0 / 720.0, 1.0, 1e6);
    }
    void look(double height, double pitch)
    {
        const double rise = osg::DegreesToRadians(pitch);
        const osg::Vec3d eye(0.0, -5000.0, height);
        viewer.getCamera()->setViewMatrixAsLookAt(eye, eye + osg::Vec3d(0.0, std::cos(rise), std::sin(rise)),
                                                  osg::Vec3d(0.0, 0.0, 1.0));
    }
    const BendHandles::Handle& handleOf(const std::string& property)
    {
        for (const BendHandles::Handle& each : handles->handles())
            if (each.property == property) return each;
        ADD_FAILURE() << property;
        static const BendHandles::Handle none;
        return none;
    }
    /// Drags a handle by some pixels, in steps; where the pointer is in the end.
    osg::Vec2d drag(const std::string& property, double pixels)
    {
        osg::Vec2d place = handleOf(property).knob;
        EXPECT_TRUE(mouse(Event::PUSH, place));
        for (int i = 0; i < 4; ++i)
        {
            place.y() += pixels / 4.0;
            EXPECT_TRUE(mouse(Event::DRAG, place));
        }
        EXPECT_TRUE(mouse(Event::RELEASE, place));
        frame();
        return place;
    }
    double rowOf(double y, double x = 0.0)
    {
        osg::Vec2d pixel;
        EXPECT_TRUE(DeformedView(*scene, *viewer.getCamera()).project({x, y, hillAt(x, y)}, pixel));
        return pixel.y();
    }
    osgGA::GUIEventHandler& handler() override { return *handles; }

    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<BendHandles> handles = new BendHandles(*scene);
};

} // namespace

TEST_F(BendHandlesTest, OfAPedestriansViewMoveItsLinesAndItsAngle)
{
    const osg::ref_ptr<PedestrianView> bend = new PedestrianView;
    bend->setFocusDistance(1500.0);
    bend->setZoneWidth(1800.0);
    bend->setBendAngle(osg::DegreesToRadians(35.0));
    bend->setTallest(0.0);
    scene->addEffect(bend);
    look(600.0, -12.0);
    frame();
    EXPECT_TRUE(handles->handles().empty()) << "nothing is shown before anyone asked";
    EXPECT_TRUE(press('d'));
    frame();
    ASSERT_EQ(handles->handles().size(), 3u);
    EXPECT_TRUE(bend->getZoneLines());
    // The first stands on the ground where the zone begins.
    EXPECT_NEAR(handleOf("focusDistance").knob.y(), rowOf(-3500.0), 0.5);
    EXPECT_NEAR(handleOf("focusDistance").knob.x(), 640.0, 0.5);

    const unsigned int revision = bend->revision();
    osg::Vec2d pointer = drag("focusDistance", 30.0);
    EXPECT_GT(bend->getFocusDistance(), 1600.0) << "up is farther";
    EXPECT_NEAR(rowOf(-5000.0 + bend->getFocusDistance()), pointer.y(), 2.0);
    EXPECT_LE(bend->revision(), revision + 4) << "those who listen are told of each step once";

    const osg::Vec3d corner = handleOf("zoneWidth").world;
    EXPECT_NEAR(corner.y(), -5000.0 + bend->getFocusDistance() + 1800.0, 1e-6);
    pointer = drag("zoneWidth", 25.0);
    EXPECT_GT(bend->getZoneWidth(), 1850.0);
    const osg::Vec3d moved = handleOf("zoneWidth").world;
    EXPECT_NEAR(moved.y(), -5000.0 + bend->getFocusDistance() + bend->getZoneWidth(), 1e-6);
    EXPECT_NEAR(moved.z(), hillAt(moved.x(), moved.y()), 1.0);
    EXPECT_NEAR(handleOf("zoneWidth").knob.y(), pointer.y(), 3.0);

    EXPECT_EQ(handleOf("bendAngle").knob, handleOf("bendAngle").place) << "in the picture";
    pointer = drag("bendAngle", 60.0);
    EXPECT_GT(bend->getBendAngle(), osg::DegreesToRadians(36.0)) << "up is steeper";
    EXPECT_NEAR(handleOf("bendAngle").knob.y(), pointer.y(), 3.0);
    const double angle = bend->getBendAngle();
    pointer = drag("bendAngle", -60.0);
    EXPECT_NEAR(handleOf("bendAngle").knob.y(), pointer.y(), 3.0);
    EXPECT_LT(bend->getBendAngle(), angle);

    EXPECT_TRUE(press('d'));
    EXPECT_FALSE(bend->getZoneLines()) << "as they were";
    EXPECT_EQ(overlay().getNodeMask(), 0u);
    EXPECT_FALSE(mouse(Event::PUSH, pointer));
}

TEST_F(BendHandlesTest, OfABirdsEyeViewMoveItsLinesInThePicture)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setFocusLine(0.35);
    bend->setHorizonLine(0.85);
    bend->setContextTilt(0.3);
    bend->setTallest(0.0);
    bend->setZoneLines(true);
    scene->addEffect(bend);
    look(2500.0, -45.0);
    EXPECT_TRUE(press('d'));
    frame();
    EXPECT_NEAR(handleOf("focusLine").knob.y(), 0.35 * 720.0, 1e-6);
    EXPECT_NEAR(handleOf("horizonLine").knob.y(), 0.85 * 720.0, 1e-6);
    drag("focusLine", 36.0);
    EXPECT_NEAR(bend->getFocusLine(), 0.40, 1e-3);
    drag("horizonLine", -36.0);
    EXPECT_NEAR(bend->getHorizonLine(), 0.80, 1e-3);
    const osg::Vec2d pointer = drag("contextTilt", -15.0);
    EXPECT_GT(bend->getContextTilt(), 0.3);
    EXPECT_NEAR(handleOf("contextTilt").knob.y(), pointer.y(), 3.0);
    // Past each other they do not go.
    drag("focusLine", 400.0);
    EXPECT_LT(bend->getFocusLine(), bend->getHorizonLine());
    // The text of each says its value.
    std::string words;
    for (unsigned int i = 1; i < picture().getNumChildren(); ++i)
        if (auto* const text = dynamic_cast<osgText::Text*>(picture().getChild(i)))
            words += text->getText().createUTF8EncodedString() + "\n";
    EXPECT_NE(words.find("horizonLine  0.8\n"), std::string::npos) << words;
    EXPECT_TRUE(press('d'));
    EXPECT_TRUE(bend->getZoneLines()) << "they were on before";
}

TEST_F(BendHandlesTest, FollowExaggeratedGroundAndThePartInForce)
{
    const osg::ref_ptr<VerticalExaggeration> higher = new VerticalExaggeration;
    higher->setFactor(2.0);
    scene->addEffect(higher);
    const osg::ref_ptr<BlendedView> blended = new BlendedView;
    blended->getPedestrianView()->setFocusDistance(1500.0);
    blended->getPedestrianView()->setTallest(0.0);
    scene->addEffect(blended);
    look(250.0, -5.0);
    EXPECT_TRUE(press('d'));
    frame();
    ASSERT_EQ(handles->handles().size(), 3u);
    EXPECT_EQ(handleOf("focusDistance").holder, blended->getPedestrianView());
    EXPECT_NEAR(handleOf("focusDistance").knob.y(), rowOf(-3500.0), 0.5);
    drag("focusDistance", 6.0);
    EXPECT_GT(blended->getPedestrianView()->getFocusDistance(), 1510.0);
    EXPECT_TRUE(blended->getZoneLines());
    look(3000.0, -45.0);
    frame();
    EXPECT_EQ(handleOf("horizonLine").holder, blended->getBirdsEyeView());
    // A panorama map that is in force has no such lines.
    scene->insertEffect(0, new PanoramaMap);
    frame();
    EXPECT_TRUE(handles->handles().empty());
    EXPECT_FALSE(blended->getZoneLines());
    EXPECT_FALSE(mouse(Event::PUSH, {640.0, 300.0}));
}

TEST_F(BendHandlesTest, LeaveOtherEventsToOthers)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    scene->addEffect(bend);
    look(2500.0, -45.0);
    EXPECT_TRUE(press('d'));
    frame();
    const osg::Vec2d knob = handleOf("focusLine").knob;
    EXPECT_FALSE(mouse(Event::PUSH, knob + osg::Vec2d(0.0, 60.0)));
    EXPECT_FALSE(mouse(Event::DRAG, knob));
    EXPECT_FALSE(mouse(Event::RELEASE, knob));
    EXPECT_FALSE(mouse(Event::PUSH, knob, Event::RIGHT_MOUSE_BUTTON));
    EXPECT_FALSE(press('x'));
    // A click that does not move changes nothing.
    EXPECT_TRUE(click(knob + osg::Vec2d(3.0, 5.0)));
    EXPECT_EQ(bend->getFocusLine(), 0.4);
    // Held beside its middle, it does not jump there.
    EXPECT_TRUE(mouse(Event::PUSH, knob + osg::Vec2d(3.0, 8.0)));
    EXPECT_TRUE(mouse(Event::DRAG, knob + osg::Vec2d(4.0, 8.0)));
    EXPECT_TRUE(mouse(Event::RELEASE, knob + osg::Vec2d(4.0, 8.0)));
    EXPECT_NEAR(bend->getFocusLine(), 0.4, 1e-9);
}
