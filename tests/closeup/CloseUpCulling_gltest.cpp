// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What CloseUps culls is not seen: the picture with culling equals the one without, bit for bit, on paged terrain whose tiles
// arrive between the pictures. Where OSG's culling is off, CloseUps draws all that is there for all regions; without
// compensation its layers are as large as the picture, too. Levels of detail follow deformed distances where there is
// compensation, so bends are compared with all tiles as detailed as they are loaded.
#include <tools/CloseUpSamples.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/PagedScene.h>
#include <tools/SampledCases.h>
#include <tools/TempDir.h>

#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <cstring>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 160, HEIGHT = 120;

bool sameBits(const osg::Image& a, const osg::Image& b)
{
    return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

constexpr int PARTS = 5;

/// On a terrain, and for a part of the set-ups.
class CloseUpCulling : public GlFixture, public ::testing::WithParamInterface<std::tuple<std::string, int>>
{
protected:
    CloseUpCulling() : GlFixture(WIDTH, HEIGHT) {}

    static std::string terrain() { return std::get<0>(GetParam()); }
    static bool onOahu() { return terrain().find("oahu") == 0; }
    static bool onGlobe() { return terrain() == "oahu" || terrain() == "globe"; }

    /// The terrain again, with no tile loaded beyond the root.
    void reload()
    {
        if (onOahu())
        {
            const std::optional<Scene> loaded = loadOahu(terrain());
            ASSERT_TRUE(loaded);
            _scene = loaded->effects;
            _reference = loaded->reference;
        }
        else
        {
            const auto kind = onGlobe() ? PagedScene::Kind::Geocentric : PagedScene::Kind::Flat;
            const std::filesystem::path file = PagedScene::write(_folder.path(), kind);
            _scene = new EffectScene;
            _scene->addChild(osgDB::readRefNodeFile(file.string()));
        }
        _bend->setEnabled(false);
        _scene->addEffect(_bend);
        _scene->addEffect(_closeUps);
    }

    /// A camera and where it looks.
    struct Pose
    {
        osg::Matrixd view;
        CloseUpPlan plan;
    };

    Pose randomPose(Random& random)
    {
        Pose pose;
        const double pitch = random.uniform(0.25, 1.4);
        const double heading = random.uniform(-3.0, 3.0);
        const double height =
            onOahu() ? random.logarithmic(1000.0, 25000.0) : random.logarithmic(1500.0, 60000.0);
        const double distance = height / std::tan(pitch);
        pose.plan.globe = onGlobe();
        pose.plan.size = 0.15 * height;
        pose.plan.reach = 0.3 * height;
        pose.plan.rise = 0.12 * height;
        const osg::Vec3d ahead(std::sin(heading) * distance, std::cos(heading) * distance, -height);
        if (onOahu())
        {
            const double longitude = osg::DegreesToRadians(random.uniform(-158.25, -157.7));
            const double latitude = osg::DegreesToRadians(random.uniform(21.3, 21.7));
            osg::Matrixd frame;
            EXPECT_TRUE(_reference->localToWorld(longitude, latitude, 0.0, frame));
            pose.view = lookFrom(-ahead, frame, random);
            pose.plan.center.set(longitude, latitude);
            if (!onGlobe()) pose.plan.center.set(frame.getTrans().x(), frame.getTrans().y());
        }
        else
        {
            const auto kind = onGlobe() ? PagedScene::Kind::Geocentric : PagedScene::Kind::Flat;
            pose.view = lookFrom(-ahead, PagedScene::placement(kind), random);
            if (onGlobe()) pose.plan.center.set(osg::DegreesToRadians(-157.8), osg::DegreesToRadians(21.4));
            pose.plan.size = std::min(pose.plan.size, 1500.0);
            pose.plan.reach = 1500.0;
        }
        return pose;
    }

    /// To the origin of a local frame.
    static osg::Matrixd lookFrom(const osg::Vec3d& eye, const osg::Matrixd& frame, Random& random)
    {
        const osg::Matrixd local = osg::Matrixd::lookAt(eye, osg::Vec3d(), osg::Vec3d(0.0, 0.0, 1.0));
        const double roll = random.integer(0, 4) ? 0.0 : random.uniform(-1.0, 1.0);
        return osg::Matrixd::inverse(frame) * local * osg::Matrixd::rotate(roll, osg::Vec3d(0.0, 0.0, 1.0));
    }

    TempDir _folder;
    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<Georeference> _reference;
    osg::ref_ptr<BirdsEyeView> _bend = new BirdsEyeView;
    osg::ref_ptr<CloseUps> _closeUps = new CloseUps;
};

} // namespace

TEST_P(CloseUpCulling, ChangesNoBit)
{
    const SampleRange setUps(fullTest() ? 75 : PARTS, std::get<1>(GetParam()), PARTS);
    const int count = setUps.count();
    std::unique_ptr<CullHarness> harness;
    int loaded = 0;
    int seen = 0;
    int spared = 0;
    for (int i = setUps.first; i < setUps.end; ++i)
    {
        SCOPED_TRACE("set-up " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        // What is loaded stays, and all of it is drawn where nothing is culled.
        if (i % 4 == 0 || i == setUps.first)
        {
            reload();
            if (HasFatalFailure()) return;
            if (!harness) harness = std::make_unique<CullHarness>(context(), _scene, WIDTH, HEIGHT);
            harness->setScene(_scene);
        }
        const Pose pose = randomPose(random);
        _closeUps->removeCloseUps();
        for (int number = random.integer(1, 5); number > 0; --number)
        {
            const osg::ref_ptr<CloseUp> closeUp = randomCloseUp(random, pose.plan);
            closeUp->setSurface("");
            _closeUps->addCloseUp(closeUp);
        }
        _closeUps->setPipeline(static_cast<CloseUps::Pipeline>(random.integer(0, 2)));
        _closeUps->setDepthTest(random.integer(0, 2) > 0);
        _closeUps->setSupersampling(random.integer(0, 3) ? 1 : 2);
        _closeUps->setTessellation(random.integer(0, 2) ? 1 : 16);
        const bool bends = random.integer(0, 2) == 0;
        _bend->setEnabled(bends);
        _bend->setHorizonLine(random.uniform(0.7, 0.95));
        _bend->setFocusLine(random.uniform(0.1, 0.5));
        harness->camera().setLODScale(bends ? 1e-6f : 1.0f);
        osg::Matrixd projection = randomProjection(random);
        // Those without perspective as large as what they look at.
        if (projection(3, 3) != 0.0)
        {
            const double half = 2.0 * pose.plan.size;
            projection = osg::Matrixd::ortho(-half, half, -half, half, 1.0, 2e5);
        }
        harness->setCamera(pose.view, projection);
        for (int step = random.integer(1, 5); step > 0; --step)
            loaded += CullHarness::load(harness->frame(true, false).requests, random, 0.7);

        const Culled culled = harness->frame(true);
        const CloseUps::Statistics statistics = _closeUps->statistics();
        seen += statistics.closeUps > 0 ? 1 : 0;
        const Culled whole = harness->frame(false);
        spared += _closeUps->statistics().drawables - statistics.drawables;
        ASSERT_TRUE(sameBits(*culled.image, *whole.image))
            << imagesMatch(*culled.image, *whole.image, {}).message();
        // And in layers as large as the picture, whose corners are rounded apart from those of smaller ones by 1/256 of a pixel:
        // nothing of a close-up lies beyond its layer. Without compensation levels follow other distances.
        harness->camera().setLODScale(1e-6f);
        const Culled finest = bends ? culled : harness->frame(true);
        _scene->setCompensation(false);
        const Culled wide = harness->frame(false);
        _scene->setCompensation(true);
        EXPECT_TRUE(imagesMatch(*finest.image, *wide.image, {3.1f / 255.0f, 0.005, 1.0f}));
    }
    EXPECT_GT(seen, count / 2);
    EXPECT_GT(loaded, count / 2);
    EXPECT_GT(spared, count);
    std::cout << seen << " of " << count << " set-ups show close-ups; " << loaded << " tiles loaded, "
              << spared << " drawables culled\n";
}

INSTANTIATE_TEST_SUITE_P(Terrain, CloseUpCulling,
                         ::testing::Combine(::testing::ValuesIn(sampledCases<std::string>(
                                                {"oahu", "oahu_projected", "flat", "globe"}, 2, 1)),
                                            ::testing::Range(0, PARTS)),
                         [](const auto& each)
                         { return std::get<0>(each.param) + "_" + std::to_string(std::get<1>(each.param)); });
