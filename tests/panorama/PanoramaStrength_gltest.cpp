// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A flight from the camera's own picture into a panorama map, by the map's strength.
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/PanoramaHills.h>
#include <tools/RandomSamples.h>
#include <tools/RandomViews.h>
#include <tools/SampledCases.h>

#include <osg/Material>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int steps = 100;

class PanoramaStrength : public GlFixture, public ::testing::WithParamInterface<bool>
{
protected:
    PanoramaStrength() : GlFixture(320, 200) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        osg::Camera& camera = *viewer().getCamera();
        camera.setProjectionMatrixAsPerspective(30.0, 320.0 / 200.0, 100.0, 1e6);
        camera.setClearColor(osg::Vec4(0.55f, 0.65f, 0.8f, 1.0f));
        _map->setRipples(0.0); // each frame has another time
        // The ground has no colors, so the viewers' material, which follows colors, would follow what was drawn before.
        _terrain->getOrCreateStateSet()->setAttribute(new osg::Material);
        _scene->addEffect(_map);
        _scene->addChild(_terrain);
        const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*_scene, *_map);
        hand->setCameraProjection(camera.getProjectionMatrix());
        hand->setWidth(24000.0);
        hand->setHeading(0.3);
        EXPECT_TRUE(hand->setCenter(_hills.middle()));
        hand->updateCamera(camera);
    }

    /// The second frame, in which pictures in the water are settled.
    osg::ref_ptr<osg::Image> draw(osg::Node* scene)
    {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
        root->addChild(scene);
        render(root);
        return render(root);
    }
    osg::ref_ptr<osg::Image> draw(double strength)
    {
        EXPECT_TRUE(_map->setStrength(strength));
        return draw(_scene);
    }

    /// The mean difference of the channels, 0 to 255.
    static double difference(const osg::Image& a, const osg::Image& b)
    {
        double sum = 0.0;
        for (int y = 0; y < a.t(); ++y)
            for (int x = 0; x < a.s(); ++x)
                for (int i = 0; i < 3; ++i)
                    sum += std::abs(a.data(x, y)[i] - b.data(x, y)[i]);
        return sum / (3.0 * a.s() * a.t());
    }

    PanoramaHills _hills{GetParam() ? std::optional<double>(0.8) : std::nullopt};
    osg::ref_ptr<osg::Node> _terrain = _hills.terrain();
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
};

} // namespace

TEST_P(PanoramaStrength, IsThePlainPictureAtNoneAndTheMapAtAll)
{
    const osg::ref_ptr<osg::Image> plain = draw(_terrain.get());
    const osg::ref_ptr<osg::Image> map = draw(1.0);
    EXPECT_TRUE(imagesMatch(*draw(0.0), *plain));
    EXPECT_GT(difference(*plain, *map), 10.0);
    // All but all of it is all but the map.
    EXPECT_LT(difference(*draw(0.9999), *map), 1.0);
    EXPECT_LT(difference(*draw(0.0001), *plain), 1.0);
}

TEST_P(PanoramaStrength, ComesStepByStep)
{
    std::vector<double> changes;
    osg::ref_ptr<osg::Image> former;
    // From the plain picture on, or all the way.
    const int last = fullTest() ? steps : 12;
    for (int step = 0; step <= last; ++step)
    {
        const osg::ref_ptr<osg::Image> picture = draw(static_cast<double>(step) / steps);
        if (former) changes.push_back(difference(*former, *picture));
        former = picture;
        if (step % 10 == 0)
            osgDB::writeImageFile(*picture,
                                  (testOutputFolder() / ("step-" + std::to_string(step) + ".png")).string());
    }
    std::vector<double> sorted = changes;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    for (std::size_t step = 0; step < changes.size(); ++step)
        EXPECT_LE(changes[step], 2.0 * median) << "step " << step + 1;
    RecordProperty("largest_over_median", std::to_string(sorted.back() / median));
}

TEST_P(PanoramaStrength, CullsNothingThatShows)
{
    osg::Camera& camera = *viewer().getCamera();
    for (int step = 0; step <= steps; step += fullTest() ? 1 : 20)
    {
        SCOPED_TRACE(step);
        const double strength = static_cast<double>(step) / steps;
        const osg::ref_ptr<osg::Image> culled = draw(strength);
        const osg::CullSettings::CullingMode culling = camera.getCullingMode();
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> whole = draw(strength);
        camera.setCullingMode(culling);
        EXPECT_TRUE(imagesMatch(*culled, *whole));
    }
}

/// Of maps whose ground bends through points, and whose heights have another scale at the horizon.
TEST_P(PanoramaStrength, CullsNothingThatShowsOfAnyCurve)
{
    osg::Camera& camera = *viewer().getCamera();
    const osg::ref_ptr<osg::Image> usual = draw(1.0);
    int different = 0;
    const int samples = fullTest() ? 200 : 6;
    for (int sample = 0; sample < samples; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        ASSERT_TRUE(
            _map->setCurvePoints(random.integer(0, 3) ? randomCurve(random) : std::vector<osg::Vec2d>()));
        ASSERT_TRUE(
            _map->setHorizonExaggeration(random.integer(0, 2) ? random.logarithmic(0.1, 10.0) : -1.0));
        SCOPED_TRACE(::testing::Message() << sample << ": " << describe(*_map));
        const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*_scene, *_map);
        hand->setCameraProjection(camera.getProjectionMatrix());
        hand->setWidth(random.logarithmic(4000.0, 40000.0));
        hand->setHeading(random.uniform(-3.0, 3.0));
        ASSERT_TRUE(hand->setCenter(_hills.middle()));
        hand->updateCamera(camera);
        const double strength = random.integer(0, 3) ? 1.0 : random.uniform(0.1, 1.0);
        const osg::ref_ptr<osg::Image> culled = draw(strength);
        const osg::CullSettings::CullingMode culling = camera.getCullingMode();
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> whole = draw(strength);
        camera.setCullingMode(culling);
        EXPECT_TRUE(imagesMatch(*culled, *whole));
        different += difference(*culled, *usual) > 1.0 ? 1 : 0;
    }
    EXPECT_GT(different, std::min(samples - 2, 10));
}

TEST_P(PanoramaStrength, WithoutPointsAndWithOneExaggerationThePictureIsAsEver)
{
    const osg::ref_ptr<osg::Image> before = draw(1.0);
    ASSERT_TRUE(_map->setCurvePoints({{0.3, 0.2}, {0.6, 0.8}}));
    EXPECT_GT(difference(*draw(1.0), *before), 2.0);
    ASSERT_TRUE(_map->setCurvePoints({}));
    EXPECT_TRUE(imagesMatch(*draw(1.0), *before));
    ASSERT_TRUE(_map->setHorizonExaggeration(6.0));
    EXPECT_GT(difference(*draw(1.0), *before), 2.0);
    ASSERT_TRUE(_map->setHorizonExaggeration(_map->getExaggeration()));
    EXPECT_TRUE(imagesMatch(*draw(1.0), *before));
}

INSTANTIATE_TEST_SUITE_P(Ground, PanoramaStrength,
                         ::testing::ValuesIn(sampledCases<bool>({false, true}, 2, 1)),
                         [](const auto& one) { return std::string(one.param ? "globe" : "projected"); });
