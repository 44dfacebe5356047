// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Cylindrical panorama maps on the screen: a strip all around is the same in few and in many parts, turns as a ring does, has no
// triangle across its seam, and culling leaves out nothing of it.
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/PictureParts.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/PanoramaHills.h>
#include <tools/PictureTiles.h>
#include <tools/RandomSamples.h>
#include <tools/SampledCases.h>

#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 480, HEIGHT = 120;

class PanoramaCylinder : public GlFixture, public ::testing::WithParamInterface<bool>
{
protected:
    PanoramaCylinder() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        viewer().setLightingMode(osg::View::NO_LIGHT);
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setProjectionMatrixAsPerspective(30.0, static_cast<double>(WIDTH) / HEIGHT, 100.0, 1e6);
        _map->setRipples(0.0); // each frame has another time
        _map->setHorizontalAngle(2.0 * osg::PI);
        _map->setHorizonBend(0.0);
        _map->setViewRadius(12000.0);
        _map->setHorizonDistance(2.4);
        _map->setExaggeration(1.2);
        _scene->addEffect(_map);
        _scene->addChild(_terrain);
        look(0.3);
    }

    /// From above the hills' middle.
    void look(double heading)
    {
        osg::Matrixd frame = osg::Matrixd::translate(_hills.middle());
        if (GetParam())
            osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(0.8, 0.4, 0.0, frame);
        viewer().getCamera()->setViewMatrix(osg::Matrixd::inverse(
            osg::Matrixd::rotate(osg::DegreesToRadians(60.0), osg::X_AXIS) *
            osg::Matrixd::rotate(-heading, osg::Z_AXIS) * osg::Matrixd::translate(0.0, 0.0, 9000.0) * frame));
    }

    osg::ref_ptr<osg::Image> draw()
    {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
        root->addChild(_scene);
        render(root);
        return render(root);
    }
    osg::ref_ptr<osg::Image> draw(int tiles)
    {
        return drawTiles(*viewer().getCamera(), tiles, [&] { return draw(); });
    }

    /// The share of pixels in which two pictures differ clearly. The second one is moved to the left, around the seam.
    static double differing(const osg::Image& a, const osg::Image& b, int moved = 0)
    {
        int count = 0;
        for (int y = 0; y < a.t(); ++y)
        {
            for (int x = 0; x < a.s(); ++x)
            {
                int most = 0;
                for (int i = 0; i < 3; ++i)
                    most = std::max(most, std::abs(a.data(x, y)[i] - b.data((x + moved) % b.s(), y)[i]));
                if (most > 12) ++count;
            }
        }
        return static_cast<double>(count) / (a.s() * a.t());
    }
    static void keep(const osg::Image& image, const std::string& name)
    {
        osgDB::writeImageFile(image, (testOutputFolder() / (name + ".png")).string());
    }

    PanoramaHills _hills{GetParam() ? std::optional<double>(0.8) : std::nullopt};
    osg::ref_ptr<osg::Node> _terrain = _hills.terrain();
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
};

} // namespace

TEST_P(PanoramaCylinder, FewPartsShowWhatManyDo)
{
    const osg::ref_ptr<osg::Image> few = draw(2);
    const osg::ref_ptr<osg::Image> many = draw(4); // of even heights, as derivatives need it
    keep(*few, "few");
    keep(*many, "many");
    EXPECT_LT(differing(*few, *many), 0.004);
}

TEST_P(PanoramaCylinder, TurnsAsARingDoes)
{
    // The light of a map is that of the picture, so it comes from straight above; reflections end at the picture's sides.
    _map->setLightElevation(osg::PI_2);
    _map->setWater(false);
    const osg::ref_ptr<osg::Image> before = draw(2);
    look(0.3 + osg::PI_2);
    const osg::ref_ptr<osg::Image> turned = draw(2);
    keep(*before, "before");
    keep(*turned, "turned");
    EXPECT_LT(differing(*turned, *before, WIDTH / 4), 0.02);
    EXPECT_GT(differing(*turned, *before), 0.2);
}

TEST_P(PanoramaCylinder, CullsNothingThatShows)
{
    osg::Camera& camera = *viewer().getCamera();
    const osg::CullSettings::CullingMode culling = camera.getCullingMode();
    for (int sample = 0; sample < (fullTest() ? 50 : 4); ++sample)
    {
        SCOPED_TRACE(sample);
        Random random(static_cast<std::uint64_t>(sample));
        look(random.uniform(-osg::PI, osg::PI));
        _map->setHorizontalAngle(random.uniform(0.5, 2.0 * osg::PI));
        _map->setViewRadius(random.uniform(4000.0, 20000.0));
        _map->setExaggeration(random.uniform(0.5, 3.0));
        const osg::ref_ptr<osg::Image> culled = draw(2);
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> whole = draw(2);
        camera.setCullingMode(culling);
        EXPECT_TRUE(imagesMatch(*culled, *whole));
    }
}

TEST_P(PanoramaCylinder, AViewersPartsAreTheWholePicture)
{
    const osg::ref_ptr<osg::Image> expected = draw(2);
    const std::vector<osg::ref_ptr<osg::Camera>> parts = drawInParts(viewer(), _scene->leastParts());
    ASSERT_EQ(parts.size(), 2u);
    std::vector<osg::ref_ptr<ImageCapture>> captures;
    for (const osg::ref_ptr<osg::Camera>& part : parts)
        captures.push_back(ImageCapture::attach(part, ImageCapture::Format::Rgba));
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    root->addChild(_scene);
    viewer().setSceneData(root);
    viewer().frame();
    for (const osg::ref_ptr<ImageCapture>& capture : captures)
        capture->request();
    viewer().frame();
    const osg::ref_ptr<osg::Image> joined = new osg::Image;
    joined->allocateImage(WIDTH, HEIGHT, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < 2; ++i)
    {
        const osg::ref_ptr<osg::Image> image = captures[i]->take();
        ASSERT_TRUE(image);
        ASSERT_EQ(image->s(), WIDTH / 2);
        joined->copySubImage(static_cast<int>(i) * WIDTH / 2, 0, 0, image);
    }
    keep(*expected, "expected");
    keep(*joined, "joined");
    EXPECT_LT(differing(*expected, *joined), 0.004);
}

TEST_P(PanoramaCylinder, APixelIsThePlaceThatItShows)
{
    const DeformedView view(*_scene, *viewer().getCamera());
    int found = 0;
    for (int x = 2; x < WIDTH; x += 17)
    {
        for (int y = 2; y < HEIGHT / 2; y += 13)
        {
            SCOPED_TRACE(std::to_string(x) + ", " + std::to_string(y));
            const auto hit = view.pick(x + 0.5, y + 0.5);
            if (!hit) continue;
            ++found;
            osg::Vec2d pixel;
            ASSERT_TRUE(view.project(hit->world, pixel));
            EXPECT_NEAR(pixel.x(), x + 0.5, 0.6);
            EXPECT_NEAR(pixel.y(), y + 0.5, 0.6);
            // Clockwise from the middle by the share of a turn.
            const osg::Vec3d place = hit->world * viewer().getCamera()->getViewMatrix();
            // The camera looks down by 30 degrees.
            const osg::Vec3d up(0.0, std::cos(osg::PI / 6.0), std::sin(osg::PI / 6.0));
            const osg::Vec3d ahead = up ^ osg::Vec3d(1.0, 0.0, 0.0);
            const double azimuth = std::atan2(place.x(), place * ahead);
            const double expected = 2.0 * osg::PI * ((x + 0.5) / WIDTH - 0.5);
            EXPECT_NEAR(std::remainder(azimuth - expected, 2.0 * osg::PI), 0.0, 0.02);
        }
    }
    EXPECT_GT(found, 60);
}

TEST_P(PanoramaCylinder, WhatTheHandHoldsStaysUnderIt)
{
    const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*_scene, *_map);
    osg::Camera& camera = *viewer().getCamera();
    hand->setCameraProjection(camera.getProjectionMatrix());
    hand->setByInverseMatrix(camera.getViewMatrix());
    const osg::Vec3d place = hand->getCenter();
    hand->setWidth(18000.0);
    EXPECT_LT((hand->getCenter() - place).length(), 1.0);
    EXPECT_NEAR(hand->getWidth(), 18000.0, 1.0);
    hand->setHeading(1.1);
    EXPECT_NEAR(hand->getHeading(), 1.1, 1e-9);
    EXPECT_TRUE(hand->setCenter(_hills.middle()));
    EXPECT_LT((hand->getCenter() - _hills.middle()).length(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Ground, PanoramaCylinder, ::testing::ValuesIn(sampledCases<bool>({false, true}, 2)),
                         [](const auto& one) { return std::string(one.param ? "globe" : "projected"); });
