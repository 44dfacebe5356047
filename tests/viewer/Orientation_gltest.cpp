// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The compass and the small map over pictures of Oʻahu. With GEOFX_KEEP_PICTURES=FOLDER they are kept, to be looked at.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/viewer/BendHandles.h>
#include <osgGeoFX/viewer/Compass.h>
#include <osgGeoFX/viewer/MiniMap.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>

#include <OpenThreads/Thread>
#include <osg/PagedLOD>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cstdlib>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Children of paged nodes that are in memory.
class LoadedChildren : public osg::NodeVisitor
{
public:
    LoadedChildren() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::PagedLOD& node) override
    {
        count += node.getNumChildren();
        traverse(node);
    }
    unsigned int count = 0;
};

class OrientationPictures : public GlFixture
{
protected:
    OrientationPictures() : GlFixture(1280, 720) {}

    void frame()
    {
        // osgText updates its vertices in a buffer that it has told OpenGL is static, and Mesa says so.
        for (const std::string& message : watch().messagesOf([&] { viewer().frame(); }))
            EXPECT_NE(message.find("GL_STATIC_DRAW"), std::string::npos) << message;
    }
    void settle()
    {
        for (int i = 0; i < 2000; ++i)
        {
            frame();
            osgDB::DatabasePager& pager = *viewer().getDatabasePager();
            if (i > 3 && pager.getFileRequestListSize() == 0 && pager.getDataToMergeListSize() == 0 &&
                !pager.getRequestsInProgress())
                return;
            OpenThreads::Thread::microSleep(5000);
        }
        ADD_FAILURE() << "tiles go on coming";
    }
    osg::ref_ptr<osg::Image> picture()
    {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        withContext([&](osg::State&) { image->readPixels(0, 0, 1280, 720, GL_RGB, GL_UNSIGNED_BYTE); });
        return image;
    }
    void keep(const std::string& name)
    {
        if (const char* folder = std::getenv("GEOFX_KEEP_PICTURES"))
            osgDB::writeImageFile(*picture(), std::string(folder) + "/" + name + ".png");
    }
    void press(int key)
    {
        viewer().getEventQueue()->keyPress(key);
        viewer().getEventQueue()->keyRelease(key);
    }
    static unsigned int loaded(osg::Node& scene)
    {
        LoadedChildren visitor;
        scene.accept(visitor);
        return visitor.count;
    }
};

} // namespace

TEST_F(OrientationPictures, AsksForNoTileThatTheWindowHasNot)
{
    TempDir folder;
    const osg::ref_ptr<osg::Node> node =
        osgDB::readRefNodeFile(PagedScene::write(folder.path(), PagedScene::Kind::Flat).string());
    std::string error;
    const auto scene = Scene::adopt(node, error);
    ASSERT_TRUE(scene) << error;
    viewer().setSceneData(scene->node);
    scene->setUpView(viewer());
    // Red tiles come as near as 100 km; the small map is drawn from 28 km.
    viewer().getCamera()->setProjectionMatrixAsPerspective(2.0, 1280.0 / 720.0, 1.0, 1e6);
    viewer().getCamera()->setViewMatrixAsLookAt({0.0, -100.0, 150e3}, {}, {0.0, 1.0, 0.0});
    settle();
    const unsigned int before = loaded(*scene->node);
    const osg::ref_ptr<MiniMap> map = new MiniMap(*scene->effects, scene->reference, scene->terrain);
    map->setWidth(10e3);
    map->setShown(true);
    viewer().addEventHandler(map);
    settle();
    EXPECT_EQ(loaded(*scene->node), before);
    // It shows the four kilometres of red ground in its ten.
    const osg::ref_ptr<osg::Image> image = picture();
    const auto red = [&](const osg::Vec3d& world)
    {
        const auto pixel = map->pixelOf(world);
        if (!pixel) return false;
        const osg::Vec4 color =
            image->getColor(osg::Vec2(osg::Vec2d((pixel->x() + 0.5) / 1280.0, (pixel->y() + 0.5) / 720.0)));
        return color.r() > color.b() + 0.3f;
    };
    EXPECT_TRUE(red({-1800.0, -1800.0, 0.0}));
    EXPECT_TRUE(red({1800.0, -1900.0, 0.0}));
    EXPECT_FALSE(red({-2300.0, -1800.0, 0.0}));
    EXPECT_FALSE(red({1800.0, -2400.0, 0.0}));
    map->setShown(false);
    frame();
}

TEST_F(OrientationPictures, OfOahuBentLeaveTheRestOfThePictureAlone)
{
    const auto scene = loadOahu("oahu");
    ASSERT_TRUE(scene);
    viewer().setSceneData(scene->node);
    scene->setUpView(viewer());
    // As a sun in the south-west.
    osg::Matrixd frameOfPlace;
    ASSERT_TRUE(scene->reference->localToWorld(osg::DegreesToRadians(-157.84), osg::DegreesToRadians(21.3),
                                               0.0, frameOfPlace));
    viewer().setLightingMode(osg::View::SKY_LIGHT);
    viewer().getLight()->setPosition(
        osg::Vec4(osg::Vec4d(osg::Matrixd::transform3x3(osg::Vec3d(-0.5, -0.4, 0.75), frameOfPlace), 0.0)));
    const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
    bird->setFocusLine(0.35);
    bird->setHorizonLine(0.84);
    bird->setContextTilt(0.15);
    scene->effects->addEffect(bird);
    const osg::ref_ptr<PedestrianView> walker = new PedestrianView;
    walker->setFocusDistance(2300.0);
    walker->setZoneWidth(2500.0);
    walker->setBendAngle(0.73);
    walker->setEnabled(false);
    scene->effects->addEffect(walker);
    viewer().getCamera()->setProjectionMatrixAsPerspective(40.0, 1280.0 / 720.0, 1.0, 1e6);
    std::string error;
    const auto look = [&](const char* place)
    {
        const auto point = ViewPoint::parse(place, error);
        osg::Matrixd view;
        ASSERT_TRUE(point && point->viewMatrix(*scene->reference, view)) << error;
        viewer().getCamera()->setViewMatrix(view);
    };
    look("-157.862,21.266,4000,25,-42");
    settle();
    const osg::ref_ptr<osg::Image> plain = picture();
    const unsigned int before = loaded(*scene->node);
    const osg::ref_ptr<Compass> compass = new Compass(*scene->effects, scene->reference);
    const osg::ref_ptr<MiniMap> map = new MiniMap(*scene->effects, scene->reference, scene->terrain);
    viewer().addEventHandler(compass);
    viewer().addEventHandler(map);
    press('o');
    press('i');
    settle();
    settle();
    keep("orientation-birdseye");
    EXPECT_LE(loaded(*scene->node), before + 4u) << "of hundreds";
    EXPECT_EQ(compass->text().substr(0, 8), "25° -42") << compass->text();
    const osg::ref_ptr<osg::Image> with = picture();
    unsigned int changed = 0, elsewhere = 0;
    for (int y = 0; y < 720; ++y)
    {
        for (int x = 0; x < 1280; ++x)
        {
            const bool differs = std::memcmp(plain->data(x, y), with->data(x, y), 3) != 0;
            const bool inCorner = y < 300 && (x < 230 || x > 890);
            changed += differs && inCorner;
            elsewhere += differs && !inCorner;
        }
    }
    EXPECT_GT(changed, 50000u);
    EXPECT_EQ(elsewhere, 0u);
    viewer().addEventHandler(new BendHandles(*scene->effects));
    press('d');
    settle();
    keep("handles-birdseye");
    EXPECT_TRUE(bird->getZoneLines());
    bird->setEnabled(false);
    walker->setEnabled(true);
    look("-157.817,21.332,650,214,-3");
    settle();
    settle();
    keep("orientation-pedestrian");
    EXPECT_TRUE(walker->getZoneLines() && !bird->getZoneLines());
    EXPECT_EQ(compass->text().substr(0, 10), "214° -3°") << compass->text();
}
