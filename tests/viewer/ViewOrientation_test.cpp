// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// How a camera stands over the map, the compass that shows it, and the small map, in a viewer that never draws.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/Compass.h>
#include <osgGeoFX/viewer/MiniMap.h>
#include <tools/HeightMesh.h>
#include <tools/PagedScene.h>
#include <tools/WindowEvents.h>

#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>
#include <osgText/Text>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr double fieldOfView = 40.0;
const double aspect = 1280.0 / 720.0;

double degrees(double radians)
{
    return osg::RadiansToDegrees(radians);
}

/// From a local frame (x east, y north, z up) to eye space; degrees.
osg::Matrixd looking(const osg::Vec3d& eye, double heading, double pitch)
{
    const double turn = osg::DegreesToRadians(heading), rise = osg::DegreesToRadians(pitch);
    const osg::Vec3d ahead(std::sin(turn) * std::cos(rise), std::cos(turn) * std::cos(rise), std::sin(rise));
    const osg::Vec3d up(-std::sin(turn) * std::sin(rise), -std::cos(turn) * std::sin(rise), std::cos(rise));
    return osg::Matrixd::lookAt(eye, eye + ahead, up);
}

/// The depression below the horizon, degrees, of the ray through a row of the picture's middle column, −1…1.
double depressionOf(double row, double pitch)
{
    return -pitch - degrees(std::atan(row * std::tan(osg::DegreesToRadians(fieldOfView / 2.0))));
}

class ViewOrientationTest : public WindowEvents
{
protected:
    ViewOrientationTest()
    {
        scene->addChild(HeightMesh{
            [](double, double)
            {
                return 0.0;
            }}.mesh(20));
        look({0.0, 0.0, 1000.0}, 40.0, -60.0);
        viewer.getCamera()->setProjectionMatrixAsPerspective(fieldOfView, aspect, 1.0, 1e6);
    }
    void look(const osg::Vec3d& eye, double heading, double pitch)
    {
        viewer.getCamera()->setViewMatrix(looking(eye, heading, pitch));
    }
    ViewOrientation orientation()
    {
        const auto result = ViewOrientation::of(*scene, *viewer.getCamera());
        EXPECT_TRUE(result);
        return result.value_or(ViewOrientation());
    }
    double rowOf(const osg::Vec3d& world)
    {
        osg::Vec2d pixel;
        EXPECT_TRUE(DeformedView(*scene, *viewer.getCamera()).project(world, pixel));
        return 2.0 * pixel.y() / HEIGHT - 1.0;
    }
    osgGA::GUIEventHandler& handler() override { return *_handler; }

    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<osgGA::GUIEventHandler> _handler;
};

} // namespace

TEST_F(ViewOrientationTest, TellsHeadingAndPitchOnAPlane)
{
    const ViewOrientation down = orientation();
    EXPECT_NEAR(degrees(down.heading), 40.0, 1e-9);
    EXPECT_NEAR(degrees(down.pitch), -60.0, 1e-9);
    EXPECT_NEAR(down.height, 1000.0, 1e-9);
    EXPECT_LT((down.north - osg::Vec3d(0.0, 1.0, 0.0)).length(), 1e-12);
    EXPECT_LT((down.east - osg::Vec3d(1.0, 0.0, 0.0)).length(), 1e-12);
    EXPECT_FALSE(down.bend);
    // Ground all over the picture: its middle row is the middle.
    ASSERT_TRUE(down.seen[ViewOrientation::FOCUS]);
    EXPECT_NEAR(degrees(*down.seen[ViewOrientation::FOCUS]), 60.0, 1.0);
    EXPECT_FALSE(down.seen[ViewOrientation::ZONE]);
    EXPECT_FALSE(down.seen[ViewOrientation::CONTEXT]);
    // Straight down, and beyond: the picture's upward direction is still that of the camera.
    look({0.0, 0.0, 1000.0}, 310.0, -90.0);
    EXPECT_NEAR(degrees(orientation().heading), 310.0, 1e-6);
    EXPECT_NEAR(degrees(orientation().pitch), -90.0, 1e-5);
    // On its side there is no heading.
    viewer.getCamera()->setViewMatrix(looking({0.0, 0.0, 1000.0}, 0.0, 0.0) *
                                      osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(0.0, 0.0, 1.0)));
    EXPECT_FALSE(ViewOrientation::of(*scene, *viewer.getCamera()));
}

TEST_F(ViewOrientationTest, TellsHeadingOnAGlobe)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
    globe->setEllipsoidModel(new osg::EllipsoidModel);
    const osg::ref_ptr<osg::MatrixTransform> local =
        new osg::MatrixTransform(PagedScene::placement(PagedScene::Kind::Geocentric));
    local->addChild(HeightMesh{
        [](double, double)
        {
            return 0.0;
        }}.mesh(20));
    globe->addChild(local);
    scene->removeChildren(0, scene->getNumChildren());
    scene->addChild(globe);
    viewer.getCamera()->setViewMatrix(
        osg::Matrixd::inverse(PagedScene::placement(PagedScene::Kind::Geocentric)) *
        looking({0.0, 0.0, 3000.0}, 215.0, -20.0));
    const ViewOrientation view = orientation();
    EXPECT_NEAR(degrees(view.heading), 215.0, 1e-3);
    EXPECT_NEAR(degrees(view.pitch), -20.0, 1e-3);
    EXPECT_NEAR(view.height, 3100.0, 1.0) << "above the ellipsoid";
}

TEST_F(ViewOrientationTest, PartsOfABirdsEyeViewAreSeenAsItBendsThem)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setFocusLine(0.4);
    bend->setHorizonLine(0.85);
    bend->setContextTilt(0.3);
    bend->setTallest(0.0);
    scene->addEffect(bend);
    const ViewOrientation view = orientation();
    ASSERT_TRUE(view.bend);
    EXPECT_EQ(view.bend->bend, bend);
    // The zone begins where the ray of the focus line meets the ground: independent of the kit.
    const double focus = osg::DegreesToRadians(depressionOf(-0.2, -60.0));
    EXPECT_NEAR(view.bend->place.start, 1000.0 / std::tan(focus), 1e-6);
    EXPECT_NEAR(rowOf(view.bend->at(view.bend->place.start)), -0.2, 1e-6);
    EXPECT_NEAR(degrees(*view.seen[ViewOrientation::FOCUS]), depressionOf(-0.6, -60.0), 1.0);
    // The context lies along the ray of the horizon line.
    const double end = rowOf(view.bend->at(view.bend->place.start + view.bend->place.size));
    const double middle = 0.5 * (end + 0.7);
    EXPECT_NEAR(degrees(*view.seen[ViewOrientation::CONTEXT]),
                depressionOf(middle, -60.0) - depressionOf(0.7, -60.0), 1.5);
    EXPECT_LT(*view.seen[ViewOrientation::CONTEXT], *view.seen[ViewOrientation::ZONE]);
    EXPECT_LT(*view.seen[ViewOrientation::ZONE], *view.seen[ViewOrientation::FOCUS]);
    // Another projection before it is in force, and it is none.
    bend->setEnabled(false);
    EXPECT_FALSE(orientation().bend);
}

TEST_F(ViewOrientationTest, TheContextOfAPedestriansViewIsSteep)
{
    const osg::ref_ptr<PedestrianView> bend = new PedestrianView;
    bend->setBendAngle(osg::DegreesToRadians(50.0));
    bend->setFocusDistance(800.0);
    bend->setZoneWidth(600.0);
    bend->setTallest(0.0);
    scene->addEffect(bend);
    look({0.0, 0.0, 200.0}, 90.0, -5.0);
    const ViewOrientation view = orientation();
    ASSERT_TRUE(view.bend && view.seen[ViewOrientation::CONTEXT]);
    EXPECT_LT((view.bend->at(800.0, 10.0) - osg::Vec3d(800.0, -10.0, 0.0)).length(), 1e-9);
    // It rises by 50°, and goes beyond the picture's upper edge.
    const double middle = 0.5 * (rowOf(view.bend->at(1400.0)) + 1.0);
    EXPECT_NEAR(degrees(*view.seen[ViewOrientation::CONTEXT]), 50.0 + depressionOf(middle, -5.0), 1.5);
}

TEST_F(ViewOrientationTest, TheCompassTurnsItsDial)
{
    const osg::ref_ptr<Compass> compass = new Compass(*scene);
    _handler = compass;
    frame();
    EXPECT_EQ(viewer.getNumSlaves(), 0u) << "nothing is shown before anyone asked";
    EXPECT_TRUE(press('o'));
    frame();
    EXPECT_EQ(compass->text(), "40° -60° 60°");
    const auto letter = [&](const std::string& word)
    {
        for (unsigned int i = 1; i < picture().getNumChildren(); ++i)
        {
            auto* const text = dynamic_cast<osgText::Text*>(picture().getChild(i));
            if (text && text->getText().createUTF8EncodedString() == word)
                return osg::Vec3d(text->getPosition());
        }
        ADD_FAILURE() << word;
        return osg::Vec3d();
    };
    // Looking east, north is to the left and east is up.
    look({0.0, 0.0, 1000.0}, 90.0, -60.0);
    frame();
    EXPECT_EQ(compass->text(), "90° -60° 60°");
    EXPECT_LT(letter("N").x() + 20.0, letter("S").x());
    EXPECT_NEAR(letter("N").y(), letter("S").y(), 1.5);
    EXPECT_GT(letter("E").y(), letter("W").y() + 20.0);
    EXPECT_NEAR(letter("E").x(), letter("W").x(), 1.5);
    // All of it lies in the window.
    osg::BoundingBox box;
    for (const osg::Vec3& corner :
         static_cast<const osg::Vec3Array&>(*picture().getChild(0)->asGeometry()->getVertexArray()))
        box.expandBy(corner);
    EXPECT_GE(box.xMin(), 640.0f);
    EXPECT_LE(box.xMax(), 1280.0f);
    EXPECT_GE(box.yMin(), 0.0f);
    EXPECT_LE(box.yMax(), 360.0f);
    // What has not changed is not drawn anew.
    const osg::ref_ptr<osg::Node> drawn = &picture();
    frame();
    EXPECT_EQ(drawn, &picture());
    EXPECT_TRUE(press('o'));
    EXPECT_EQ(overlay().getNodeMask(), 0u);
    EXPECT_EQ(compass->text(), "");
    EXPECT_FALSE(press('x'));
}

TEST_F(ViewOrientationTest, TheSmallMapHasTheBendWhereItIs)
{
    const osg::ref_ptr<PedestrianView> bend = new PedestrianView;
    bend->setFocusDistance(800.0);
    bend->setZoneWidth(600.0);
    bend->setTallest(0.0);
    scene->addEffect(bend);
    look({500.0, -300.0, 200.0}, 30.0, -5.0);
    const osg::ref_ptr<MiniMap> map = new MiniMap(*scene);
    _handler = map;
    frame();
    EXPECT_FALSE(map->getCamera());
    EXPECT_TRUE(press('i'));
    frame();
    ASSERT_TRUE(map->getCamera());
    const osg::Camera& camera = *map->getCamera();
    // It is drawn without effects, for fewer pixels.
    const CameraEffects* const effects = CameraEffects::find(camera);
    ASSERT_TRUE(effects && effects->getRole());
    EXPECT_EQ(effects->getRole()->getKind(), CameraRole::UNDEFORMED);
    // Twice the error, 720 pixels of 30° over 196 of 20°.
    EXPECT_NEAR(camera.getLODScale(),
                2.0 * 720.0 / 196.0 * std::tan(osg::DegreesToRadians(10.0)) /
                    std::tan(osg::DegreesToRadians(15.0)),
                1e-3);
    // Its marks lie where its camera draws the ground.
    const auto where = [&](const osg::Vec3d& world)
    {
        const osg::Vec3d clip = world * camera.getViewMatrix() * camera.getProjectionMatrix();
        const osg::Viewport& port = *camera.getViewport();
        // The window's corner is not the viewport's.
        return osg::Vec2d(port.x() - 10.0 + (clip.x() + 1.0) / 2.0 * port.width(),
                          port.y() - 20.0 + (clip.y() + 1.0) / 2.0 * port.height());
    };
    const osg::Vec3d places[] = {{500.0, -300.0, 0.0}, {900.0, 100.0, 0.0}, {0.0, -500.0, 0.0}};
    for (const osg::Vec3d& place : places)
    {
        const auto pixel = map->pixelOf(place);
        ASSERT_TRUE(pixel);
        EXPECT_LT((*pixel - where(place)).length(), 1.0);
    }
    const osg::Vec2d middle(camera.getViewport()->x() - 10.0 + 98.0, camera.getViewport()->y() - 20.0 + 98.0);
    const osg::Vec2d behind = where(places[0]) - middle;
    EXPECT_NEAR(behind *
                    osg::Vec2d(std::sin(osg::DegreesToRadians(30.0)), std::cos(osg::DegreesToRadians(30.0))),
                -0.22 * 196.0, 1.0);
    EXPECT_GT(where({500.0, 300.0, 0.0}).y(), where(places[0]).y() + 10.0) << "north is up";
    EXPECT_GT(where({900.0, -300.0, 0.0}).x(), where(places[0]).x() + 10.0) << "east is right";
    EXPECT_FALSE(map->pixelOf({9000.0, 0.0, 0.0}));

    // The color of the topmost triangle at a place.
    const auto colorAt = [&](const osg::Vec3d& world)
    {
        const osg::Geometry& shapes = *picture().getChild(0)->asGeometry();
        const auto& corners = static_cast<const osg::Vec3Array&>(*shapes.getVertexArray());
        const auto& colors = static_cast<const osg::Vec4Array&>(*shapes.getColorArray());
        const osg::Vec2d pixel = where(world);
        osg::Vec4 result;
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        {
            int left = 0, right = 0;
            for (std::size_t k = 0; k < 3; ++k)
            {
                const osg::Vec3d a = corners[i + k], b = corners[i + (k + 1) % 3];
                const double side =
                    (b.x() - a.x()) * (pixel.y() - a.y()) - (b.y() - a.y()) * (pixel.x() - a.x());
                left += side > 0.0;
                right += side < 0.0;
            }
            if (left == 3 || right == 3) result = colors[i];
        }
        return result;
    };
    const double turn = osg::DegreesToRadians(30.0);
    const auto ahead = [&](double metres, double across)
    {
        return osg::Vec3d(500.0 + metres * std::sin(turn) + across * std::cos(turn),
                          -300.0 + metres * std::cos(turn) - across * std::sin(turn), 0.0);
    };
    const osg::Vec4 focus = colorAt(ahead(600.0, 0.0)), zone = colorAt(ahead(1100.0, 0.0)),
                    context = colorAt(ahead(1550.0, 0.0));
    EXPECT_NEAR(focus.r(), focus.b(), 0.01f) << "white";
    EXPECT_GT(zone.r(), zone.b() + 0.3f) << "amber";
    EXPECT_GT(context.b(), context.r() + 0.3f) << "blue";
    EXPECT_GT(focus.a() * zone.a() * context.a(), 0.0f);
    EXPECT_EQ(colorAt(ahead(-600.0, 0.0)).a(), 0.0f) << "behind the camera";
    // The field of view is 66° wide: so much at the side.
    const double half = std::tan(osg::DegreesToRadians(fieldOfView / 2.0)) * aspect;
    EXPECT_GT(colorAt(ahead(1100.0, 1100.0 * half * 0.9)).a(), 0.0f);
    EXPECT_EQ(colorAt(ahead(1100.0, 1100.0 * half * 1.1)).a(), 0.0f);

    EXPECT_TRUE(press('i'));
    EXPECT_EQ(camera.getNodeMask(), 0u);
    EXPECT_EQ(overlay().getNodeMask(), 0u);
    EXPECT_FALSE(map->pixelOf(places[0]));
}
