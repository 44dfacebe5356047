// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A panorama map from files, while it changes, comes and goes, beside other maps, and in all threading models.
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/PanoramaHills.h>
#include <tools/PictureTiles.h>
#include <tools/RandomSamples.h>
#include <tools/SampledCases.h>
#include <tools/TempDir.h>
#include <tools/ThreadedViews.h>

#include <osg/ClipNode>
#include <osg/Geometry>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class PanoramaStates : public GlFixture
{
protected:
    PanoramaStates() : GlFixture(240, 150) {}

    static void SetUpTestSuite()
    {
        // Before the folders of an installed osgGeoFX.
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(GEOFX_BUILD_DIR "/lib");
    }

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        viewer().setLightingMode(osg::View::NO_LIGHT);
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setProjectionMatrixAsPerspective(30.0, 240.0 / 150.0, 100.0, 1e6);
        // Still water: each frame has another time.
        _map->setRipples(0.0);
        _scene->addEffect(_map);
        _scene->addChild(_terrain);
        look(24000.0, 0.3);
    }

    /// Over the hills' middle.
    void look(double width, double heading)
    {
        const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*_scene, *_map);
        hand->setCameraProjection(viewer().getCamera()->getProjectionMatrix());
        hand->setWidth(width);
        hand->setHeading(heading);
        EXPECT_TRUE(hand->setCenter(_hills.middle()));
        hand->updateCamera(*viewer().getCamera());
    }

    /// The second frame: what pictures in the water show is settled by then. In the order of the graph: that of addresses differs
    /// from one copy of a scene to the other.
    osg::ref_ptr<osg::Image> draw(osg::Node* scene)
    {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
        root->addChild(scene);
        render(root);
        return render(root);
    }
    osg::ref_ptr<osg::Image> draw() { return draw(_scene); }

    /// The share of pixels in which two pictures differ clearly.
    static double differing(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (int y = 0; y < a.t(); ++y)
        {
            for (int x = 0; x < a.s(); ++x)
            {
                int most = 0;
                for (int i = 0; i < 3; ++i)
                    most = std::max(most, std::abs(a.data(x, y)[i] - b.data(x, y)[i]));
                if (most > 12) ++count;
            }
        }
        return static_cast<double>(count) / (a.s() * a.t());
    }

    static void alter(PanoramaMap& map, Random& random)
    {
        map.setSeason(random.uniform(0.0, 1.0));
        map.setExaggeration(random.uniform(0.5, 4.0));
        map.setHorizonLine(random.uniform(0.5, 0.95));
        map.setAtmosphere(random.uniform(0.0, 1.0));
        map.setClouds(random.integer(0, 3));
        map.setPaint(random.integer(0, 3) != 0);
        map.setWater(random.integer(0, 1) != 0);
        map.setSky(random.integer(0, 1) != 0);
        map.setStrokes(random.integer(0, 1) != 0);
        map.setReflection(random.integer(0, 1) * 0.6);
        map.setProjection(random.integer(0, 3) != 0);
        map.setPalette(random.integer(0, 1) ? makePalette(0.0) : nullptr);
    }

    PanoramaHills _hills{0.8};
    osg::ref_ptr<osg::Node> _terrain = _hills.terrain();
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
};

} // namespace

// A plane between the eye and all that it sees: sky and strokes have no place of their own there to be cut at.
TEST_F(PanoramaStates, PlanesAboveItCutWhatIsBeyondThem)
{
    const osg::Matrixd eye = osg::Matrixd::inverse(viewer().getCamera()->getViewMatrix());
    const osg::Vec3d ahead = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, -1.0), eye);
    const auto clipped = [&](double distance, bool away)
    {
        const osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
        const double side = away ? -1.0 : 1.0;
        clip->addClipPlane(new osg::ClipPlane(
            0, osg::Vec4d(ahead * side, -side * (ahead * (eye.getTrans() + ahead * distance)))));
        clip->setStateSetModes(*clip->getOrCreateStateSet(), osg::StateAttribute::ON);
        clip->addChild(_scene);
        return draw(clip);
    };
    ASSERT_TRUE(_map->getStrokes() && _map->getSky());
    const osg::ref_ptr<osg::Image> expected = draw();
    EXPECT_LT(differing(*clipped(50.0, false), *expected), 0.002);
    // What is beyond a plane is gone, strokes and all.
    _map->setSky(false);
    EXPECT_EQ(differing(*clipped(50.0, true), *draw(new osg::Group)), 0.0);
}

TEST_F(PanoramaStates, DrawsTheSameFromFiles)
{
    const TempDir folder;
    _map->setSeason(0.75);
    _map->setExaggeration(3.0);
    _map->setPalette(makePalette(0.9));
    const osg::ref_ptr<osg::Image> expected = draw();
    ASSERT_TRUE(osgDB::writeNodeFile(*_terrain, (folder / "terrain.osgb").string()));
    ASSERT_TRUE(osgDB::writeImageFile(*_map->getPalette(), (folder / "palette.png").string()));
    ASSERT_TRUE(osgDB::writeNodeFile(*_scene, (folder / "scene.osgb").string()));
    folder.write("scene.geofx",
                 "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain>"
                 "<effects><panoramaMap season='0.75' exaggeration='3' ripples='0' palette='palette.png'/>"
                 "</effects></geofx>");
    for (const char* name : {"scene.osgb", "scene.geofx"})
    {
        const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile((folder / name).string());
        ASSERT_TRUE(read) << name;
        EXPECT_TRUE(imagesMatch(*draw(read), *expected, {}, name));
    }
    // Text files have no images of their own and round the ground; the map itself they keep.
    const osg::ref_ptr<osgDB::Options> whole = new osgDB::Options("WriteImageHint=IncludeData");
    ASSERT_TRUE(osgDB::writeObjectFile(*_map, (folder / "map.osgt").string(), whole));
    const osg::ref_ptr<PanoramaMap> map = osgDB::readRefFile<PanoramaMap>((folder / "map.osgt").string());
    ASSERT_TRUE(map);
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    other->addEffect(map);
    other->addChild(_terrain);
    EXPECT_TRUE(imagesMatch(*draw(other), *expected, {}, "map.osgt"));
    const osg::ref_ptr<osg::Node> clone = new EffectScene(*_scene, osg::CopyOp::DEEP_COPY_ALL);
    // A deep copy has its strokes made anew, and a few soft edges of them round otherwise, by 2/255.
    EXPECT_TRUE(imagesMatch(*draw(clone), *expected, {2.5 / 255.0, 0.0}, "clone"));
    _map->setSeason(0.0);
    EXPECT_GT(differing(*draw(), *expected), 0.05) << "and another season is another picture";
}

TEST_F(PanoramaStates, ComesAndGoesWithoutATrace)
{
    const osg::ref_ptr<EffectScene> bare = new EffectScene;
    bare->addChild(_terrain);
    const osg::ref_ptr<osg::Image> plain = draw(bare);
    const osg::ref_ptr<osg::Image> painted = draw();
    EXPECT_GT(differing(*painted, *plain), 0.3);
    for (int i = 0; i < 2; ++i)
    {
        _map->setEnabled(false);
        EXPECT_TRUE(imagesMatch(*draw(), *plain, {}, "off"));
        _map->setEnabled(true);
        EXPECT_TRUE(imagesMatch(*draw(), *painted, {}, "on"));
        _scene->removeEffect(_map);
        EXPECT_TRUE(imagesMatch(*draw(), *plain, {}, "removed"));
        _scene->addEffect(_map);
        EXPECT_TRUE(imagesMatch(*draw(), *painted, {}, "back"));
        EXPECT_TRUE(imagesMatch(*draw(bare), *plain, {}, "beside"));
        withContext([&](osg::State& state) { _scene->releaseGLObjects(&state); });
        EXPECT_TRUE(imagesMatch(*draw(), *painted, {}, "released"));
    }
}

TEST_F(PanoramaStates, MayChangeFromFrameToFrame)
{
    for (int i = 0; i < (fullTest() ? 200 : 6); ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        alter(*_map, random);
        look(random.logarithmic(3000.0, 80000.0), random.uniform(-3.0, 3.0));
        render(_scene);
    }
    // What has been through all of that draws as what is new.
    const osg::ref_ptr<osg::Image> old = draw();
    const osg::ref_ptr<EffectScene> fresh = new EffectScene;
    fresh->addEffect(new PanoramaMap(*_map));
    fresh->addChild(_terrain);
    EXPECT_TRUE(imagesMatch(*old, *draw(fresh)));
}

// Into a texture and onto the screen, by one cull visitor: each look has a picture in the water and strokes of its own.
TEST_F(PanoramaStates, OneMapMayBeDrawnTwiceInAFrame)
{
    const osg::Camera& screen = *viewer().getCamera();
    look(60000.0, 1.9);
    const osg::Matrixd otherView = screen.getViewMatrix();
    look(24000.0, 0.3);
    const auto together = [&](const osg::ref_ptr<EffectScene>& first, const osg::ref_ptr<EffectScene>& second)
    {
        constexpr int width = 120, height = 75;
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setTextureSize(width, height);
        texture->setInternalFormat(GL_RGBA);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setRenderOrder(osg::Camera::PRE_RENDER);
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->setViewport(0, 0, width, height);
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setViewMatrix(otherView);
        camera->setProjectionMatrix(screen.getProjectionMatrix());
        camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
        camera->attach(osg::Camera::COLOR_BUFFER, texture);
        camera->addChild(second);
        osg::ref_ptr<osg::Camera> corner = new osg::Camera;
        corner->setRenderOrder(osg::Camera::POST_RENDER);
        corner->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        corner->setClearMask(GL_DEPTH_BUFFER_BIT);
        corner->setViewport(0, 0, width, height);
        corner->setProjectionMatrixAsOrtho2D(0, 1, 0, 1);
        osg::ref_ptr<osg::Geometry> quad = osg::createTexturedQuadGeometry({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        quad->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
        corner->addChild(quad);
        for (const auto& scene : {first, second})
            scene->setNestedCameras(true);
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(camera);
        root->addChild(first);
        root->addChild(corner);
        const osg::ref_ptr<osg::Image> image = draw(root);
        // And again: what one frame kept must not lead the next one astray.
        EXPECT_TRUE(imagesMatch(*draw(root), *image, {}, "a later frame"));
        return image;
    };
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    other->addEffect(osg::clone(_map.get(), osg::CopyOp::DEEP_COPY_ALL));
    other->addChild(_terrain);
    const osg::ref_ptr<osg::Image> apart = together(_scene, other);
    EXPECT_GT(differing(*apart, *draw()), 0.05);
    // A copy of a map has strokes made anew, some soft edges of which round otherwise.
    EXPECT_TRUE(imagesMatch(*together(_scene, _scene), *apart, {3 / 255.0f, 0.0, 3 / 255.0f}, "one map"));
}

TEST_F(PanoramaStates, OneTerrainMayHaveTwoMapsInAllThreadingModels)
{
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    const osg::ref_ptr<PanoramaMap> winter = new PanoramaMap;
    winter->setSeason(0.0);
    winter->setHorizonLine(0.6);
    winter->setRipples(0.0);
    other->addEffect(winter);
    other->addChild(_terrain);
    const osg::ref_ptr<EffectScene> plain = new EffectScene;
    plain->addChild(_terrain);
    std::vector<osg::ref_ptr<osg::Image>> expected;
    for (const auto model : ThreadedViews::models)
    {
        SCOPED_TRACE(model);
        ThreadedViews views(model);
        for (const auto& scene : {_scene, other, plain})
            views.add(scene, *viewer().getCamera());
        views.realize();
        const auto pictures = views.pictures();
        ASSERT_EQ(pictures.size(), 3u);
        if (expected.empty())
        {
            expected = pictures;
            EXPECT_GT(differing(*pictures[0], *pictures[1]), 0.2);
            EXPECT_GT(differing(*pictures[0], *pictures[2]), 0.2);
        }
        for (std::size_t i = 0; i < pictures.size(); ++i)
            EXPECT_TRUE(
                imagesMatch(*pictures[i], *expected[i], {}, std::to_string(model) + std::to_string(i)));
        // Changes between frames, while another thread may still draw the last one.
        for (int i = 0; i < 6; ++i)
        {
            winter->setSeason(i % 2 ? 0.0 : 0.5);
            _map->setEnabled(i % 3 != 0);
            views.frame();
        }
        winter->setSeason(0.0);
        _map->setEnabled(true);
        const auto again = views.pictures();
        for (std::size_t i = 0; i < again.size(); ++i)
            EXPECT_TRUE(imagesMatch(*again[i], *expected[i], {},
                                    "again" + std::to_string(model) + std::to_string(i)));
    }
}

TEST_F(PanoramaStates, TilesAreThePictureInParts)
{
    // Tiles of even sides: GPUs find slopes in squares of four pixels.
    viewer().getCamera()->setViewport(0, 0, 240, 144);
    struct Painting
    {
        const char* name;
        bool strokes, water, projection;
        double most;
    };
    for (const Painting& painting : sampledCases<Painting>({{"plain", false, false, true, 0.0005},
                                                            {"water", false, true, true, 0.0005},
                                                            {"strokes", true, true, true, 0.002},
                                                            {"perspective", true, true, false, 0.002}},
                                                           2, 1))
    {
        SCOPED_TRACE(painting.name);
        _map->setStrokes(painting.strokes);
        _map->setWater(painting.water);
        _map->setProjection(painting.projection);
        const osg::ref_ptr<osg::Image> whole = draw();
        const osg::ref_ptr<osg::Image> parts = drawTiles(*viewer().getCamera(), 4, [this] { return draw(); });
        EXPECT_TRUE(imagesMatch(*parts, *whole, {2.1f / 255.0f, painting.most, 1.0f}, painting.name));
    }
}
