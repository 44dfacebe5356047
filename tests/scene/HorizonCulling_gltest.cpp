// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Tiles of a whole Earth that know their horizon, in plain OSG and below effects: the picture is that without culling, bit for
// bit, also where an effect lifts what lies beyond the horizon.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <tools/CullHarness.h>
#include <tools/DrawnDepths.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/RandomSamples.h>

#include <osg/ClusterCullingCallback>
#include <osg/CoordinateSystemNode>
#include <osg/Math>
#include <osg/ShapeDrawable>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 160, HEIGHT = 120;
constexpr double EQUATOR = 6378137.0;

class HorizonCulling : public GlFixture
{
protected:
    HorizonCulling() : GlFixture(WIDTH, HEIGHT) {}
};

/// An eye's height over a sphere that touches the Earth at its poles: never less than that over the ellipsoid.
double heightOver(const osg::Vec3d& eye)
{
    return eye.length() - (EQUATOR - 22000.0);
}

osg::Matrixd randomView(Random& random)
{
    osg::Vec3d up(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    up.normalize();
    const osg::Vec3d east = osg::Vec3d(0.0, 0.0, 1.0) ^ up;
    const osg::Vec3d eye = up * (EQUATOR + random.logarithmic(1000.0, 3e7));
    // Mostly near the horizon.
    const double dip = std::acos(std::min(1.0, EQUATOR / eye.length()));
    const double pitch = -dip * random.uniform(0.3, 1.2);
    const osg::Vec3d ahead = osg::Quat(random.uniform(-osg::PI, osg::PI), up) * east;
    return osg::Matrixd::lookAt(eye, eye + (ahead * std::cos(pitch) + up * std::sin(pitch)) * 1000.0, up);
}

/// Near and far, metres.
struct DepthsOf
{
    explicit DepthsOf(const Culled& culled)
    {
        double angle = 0.0, aspect = 0.0;
        EXPECT_TRUE(culled.projection.getPerspective(angle, aspect, nearest, farthest));
    }
    double nearest = 0.0, farthest = 0.0;
};

/// What the depth buffer has to tell apart is far away. The near plane must not cut ground that a bend has brought near: through the
/// hole one would see the inside of the Earth's far side, which the horizon hides.
osg::Matrixd perspective(Random& random, const osg::Matrixd& view)
{
    const double height = heightOver(osg::Matrixd::inverse(view).getTrans());
    return osg::Matrixd::perspective(random.uniform(20.0, 90.0), static_cast<double>(WIDTH) / HEIGHT,
                                     0.05 * height, 1e8);
}

} // namespace

TEST_F(HorizonCulling, PicturesOfAWholeEarthAreThoseWithoutIt)
{
    const std::optional<Scene> oahu = loadOahu("oahu_globe");
    if (!oahu) return;
    const std::function<void(EffectScene&, Random&)> kinds[] = {
        // Moves nothing.
        [](EffectScene& scene, Random&) { scene.addEffect(new ProjectiveMappings); },
        [](EffectScene& scene, Random& random)
        {
            osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
            exaggeration->setFactor(random.uniform(1.0, 10.0));
            scene.addEffect(exaggeration);
        },
        [](EffectScene& scene, Random&) { scene.addEffect(new BirdsEyeView); },
        [](EffectScene& scene, Random&) { scene.addEffect(new PedestrianView); },
        [](EffectScene& scene, Random& random)
        {
            osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
            exaggeration->setFactor(random.logarithmic(0.02, 10.0));
            exaggeration->setBaseHeight(random.uniform(-5000.0, 5000.0));
            scene.addEffect(exaggeration);
            scene.addEffect(new BirdsEyeView);
        }};
    constexpr std::size_t count = std::size(kinds);
    CullHarness harness(context(), oahu->effects, WIDTH, HEIGHT);
    harness.camera().setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    const osg::CullSettings::CullingMode usual = harness.camera().getCullingMode();
    std::size_t without[count] = {}, with[count] = {};
    for (std::size_t i = 0; i < (fullTest() ? 400 : 30); ++i)
    {
        SCOPED_TRACE(i);
        Random random(i);
        EffectScene& scene = *oahu->effects;
        while (scene.getNumEffects() > 0)
            scene.removeEffect(scene.getEffect(0));
        kinds[i % count](scene, random);
        const osg::Matrixd view = randomView(random);
        // An orthographic picture of the whole Earth, too: there the eye is nowhere.
        const bool flat = i % 8 == 5;
        const osg::Matrixd projection =
            flat ? osg::Matrixd::ortho(-8e6, 8e6, -6e6, 6e6, -1e8, 1e8) : perspective(random, view);
        harness.setCamera(view, projection);
        // In parallel rays the finest tiles are drawn from anywhere, and from afar their blocks are smaller than two pixels.
        const osg::CullSettings::CullingMode mode =
            flat ? usual & ~osg::CullSettings::SMALL_FEATURE_CULLING : usual;
        harness.camera().setCullingMode(mode);
        for (int step = 0; step < 3; ++step)
            CullHarness::load(harness.frame(true, false).requests, random, 0.7);
        const Culled culled = harness.frame(true);
        const Culled everything = harness.frame(false);
        EXPECT_TRUE(imagesMatch(*culled.image, *everything.image, {}));
        harness.camera().setCullingMode(mode & ~osg::CullSettings::CLUSTER_CULLING);
        const Culled both = harness.frame(true, false);
        harness.camera().setCullingMode(mode);
        if (flat)
        {
            EXPECT_EQ(culled.leaves.size(), both.leaves.size());
            continue;
        }
        with[i % count] += culled.leaves.size();
        without[i % count] += both.leaves.size();
    }
    for (std::size_t kind = 0; kind < count; ++kind)
    {
        // The far map of a pedestrian's view is seen from so high above that little of it is below a horizon.
        EXPECT_LT(with[kind], (kind == 3 ? 1.0 : 0.9) * static_cast<double>(without[kind]))
            << "kind " << kind << " knows no horizon";
        std::cout << "kind " << kind << ": " << with[kind] << " drawables in the place of " << without[kind]
                  << "\n";
    }
}

// Tiles on the far side of the Earth lie where no projection has a place for them.
TEST_F(HorizonCulling, NearAndFarAreNumbersUnderAnyEffect)
{
    const std::optional<Scene> oahu = loadOahu("oahu_globe");
    if (!oahu) return;
    EffectScene& scene = *oahu->effects;
    CullHarness harness(context(), oahu->effects, WIDTH, HEIGHT);
    struct Eye
    {
        double longitude, latitude, height, pitch;
    };
    const Eye eyes[] = {{-121.9, 46.55, 8000.0, -30.0}, {20.0, 10.0, 8000.0, -30.0},
                        {20.0, 10.0, 8000.0, -5.0},     {179.9, -89.5, 60.0, -10.0},
                        {0.0, 0.0, 8e5, -60.0},         {-158.0, 21.4, 2e7, -90.0}};
    const osg::ref_ptr<osg::EllipsoidModel> earth = new osg::EllipsoidModel;
    for (const osg::ref_ptr<Effect>& effect : std::vector<osg::ref_ptr<Effect>>{
             new PanoramaMap, new BirdsEyeView, new PedestrianView, new VerticalExaggeration})
    {
        if (auto* exaggeration = dynamic_cast<VerticalExaggeration*>(effect.get()))
            exaggeration->setFactor(2.0);
        while (scene.getNumEffects() > 0)
            scene.removeEffect(scene.getEffect(0));
        scene.addEffect(effect);
        for (const auto mode : {osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES,
                                osg::CullSettings::COMPUTE_NEAR_USING_PRIMITIVES,
                                osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES})
        {
            harness.camera().setComputeNearFarMode(mode);
            for (const Eye& eye : eyes)
            {
                SCOPED_TRACE(std::string(effect->className()) + " " + std::to_string(mode) + " " +
                             std::to_string(eye.height) + " " + std::to_string(eye.pitch));
                osg::Matrixd place;
                earth->computeLocalToWorldTransformFromLatLongHeight(osg::DegreesToRadians(eye.latitude),
                                                                     osg::DegreesToRadians(eye.longitude),
                                                                     eye.height, place);
                const osg::Matrixd view = osg::Matrixd::inverse(
                    osg::Matrixd::rotate(osg::DegreesToRadians(90.0 + eye.pitch), osg::X_AXIS) * place);
                harness.setCamera(
                    view, osg::Matrixd::perspective(40.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e8));
                Random random(7);
                for (int step = 0; step < 2; ++step)
                    CullHarness::load(harness.frame(true, false).requests, random, 1.0);
                const Culled culled = harness.frame(true, false);
                EXPECT_GT(culled.leaves.size(), 0u);
                const DepthsOf depths(culled);
                EXPECT_TRUE(std::isfinite(depths.nearest) && std::isfinite(depths.farthest));
                EXPECT_GT(depths.nearest, 0.0);
                EXPECT_GT(depths.farthest, depths.nearest);
                EXPECT_LT(depths.farthest, 1e9);
            }
        }
    }
}

// Whichever way OSG finds them. A near plane that lies too far away cuts a hole into the foreground.
TEST_F(HorizonCulling, NearAndFarAreThoseOfWhatIsDrawn)
{
    const std::optional<Scene> oahu = loadOahu("oahu_globe");
    if (!oahu) return;
    EffectScene& scene = *oahu->effects;
    CullHarness harness(context(), oahu->effects, WIDTH, HEIGHT);
    const auto exaggeration = [](double factor)
    {
        osg::ref_ptr<VerticalExaggeration> made = new VerticalExaggeration;
        made->setFactor(factor);
        return made;
    };
    const osg::ref_ptr<Effect> effects[] = {exaggeration(1.0005), exaggeration(2.0), new BirdsEyeView,
                                            new PedestrianView, new PanoramaMap};
    const osg::ref_ptr<osg::EllipsoidModel> earth = new osg::EllipsoidModel;
    int looked = 0;
    for (std::size_t i = 0; i < (fullTest() ? 300 : 20); ++i)
    {
        Random random(i);
        const osg::ref_ptr<Effect>& effect = effects[i % std::size(effects)];
        while (scene.getNumEffects() > 0)
            scene.removeEffect(scene.getEffect(0));
        scene.addEffect(effect);
        const double height = 5000.0 + random.logarithmic(60.0, 2e7);
        const double pitch = random.uniform(-90.0, -5.0);
        // Most of them near the island, where there are fine tiles.
        const bool isNear = i % 2 == 0;
        const double latitude = isNear ? 21.4 + random.uniform(-1.0, 1.0) : random.uniform(-89.9, 89.9);
        const double longitude = isNear ? -158.0 + random.uniform(-1.0, 1.0) : random.uniform(-180.0, 180.0);
        osg::Matrixd place;
        earth->computeLocalToWorldTransformFromLatLongHeight(osg::DegreesToRadians(latitude),
                                                             osg::DegreesToRadians(longitude), height, place);
        const osg::Matrixd view =
            osg::Matrixd::inverse(osg::Matrixd::rotate(osg::DegreesToRadians(90.0 + pitch), osg::X_AXIS) *
                                  osg::Matrixd::rotate(random.uniform(-3.0, 3.0), osg::Z_AXIS) * place);
        const osg::Matrixd projection =
            osg::Matrixd::perspective(40.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e8);
        harness.setCamera(view, projection);
        for (int step = 0; step < 3; ++step)
            CullHarness::load(harness.frame(true, false).requests, random, 1.0);
        const bool isPanorama = dynamic_cast<const PanoramaMap*>(effect.get()) != nullptr;
        DepthSpan exact;
        for (const auto mode : {osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES,
                                osg::CullSettings::COMPUTE_NEAR_USING_PRIMITIVES,
                                osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES})
        {
            SCOPED_TRACE(std::to_string(i) + " " + effect->className() + ", mode " + std::to_string(mode) +
                         ", " + std::to_string(height) + " m, pitch " + std::to_string(pitch));
            harness.camera().setComputeNearFarMode(mode);
            harness.setCamera(view, projection);
            const Culled culled = harness.frame(true, false);
            const DepthsOf actual(culled);
            DepthSpan drawn;
            const osg::ref_ptr<const DeformationChain> chain = scene.deformation(view, projection);
            for (const Culled::Leaf& leaf : culled.leaves)
                include(drawn, *leaf.drawable, leaf.modelView, projection, *chain);
            if (drawn.farthest < drawn.nearest) continue;
            ++looked;
            // A panorama map ends before the far side of the Earth, whose triangles are anywhere. Its fragments are not drawn.
            if (isPanorama)
            {
                if (mode == osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES)
                    exact = {actual.nearest, actual.farthest};
                drawn = exact;
            }
            // OSG puts the planes 2 % nearer and farther, and the near plane nowhere nearer than a share of the far one.
            constexpr double room = 1.2 * 1.02;
            EXPECT_GE(actual.farthest, 0.999 * drawn.farthest);
            EXPECT_LE(actual.farthest, room * drawn.farthest);
            const double bound = harness.camera().getNearFarRatio() * actual.farthest;
            EXPECT_GE(actual.nearest, std::max(drawn.nearest / room, 0.96 * bound));
            EXPECT_LE(actual.nearest, std::max(drawn.nearest, bound));
        }
        harness.camera().setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    }
    EXPECT_GT(looked, 40);
}

TEST_F(HorizonCulling, PicturesOfPlainOsgAreThoseWithoutIt)
{
    const std::optional<Scene> oahu = loadOahu("oahu_globe");
    if (!oahu) return;
    // The terrain itself, as Debian's osgviewer draws it.
    osg::ref_ptr<osg::Group> plain = new osg::Group;
    for (unsigned int i = 0; i < oahu->effects->getNumChildren(); ++i)
        plain->addChild(oahu->effects->getChild(i));
    CullHarness harness(context(), plain, WIDTH, HEIGHT);
    harness.camera().setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    for (int i = 0; i < (fullTest() ? 200 : 16); ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(1000 + i));
        const osg::Matrixd view = randomView(random);
        harness.setCamera(view, perspective(random, view));
        for (int step = 0; step < 3; ++step)
            CullHarness::load(harness.frame(true, false).requests, random, 0.7);
        const Culled culled = harness.frame(true);
        const Culled everything = harness.frame(false);
        EXPECT_TRUE(imagesMatch(*culled.image, *everything.image, {}));
    }
}

/// Tiles and models of others may have such callbacks, too.
TEST_F(HorizonCulling, OfOthersDoesNotHoldWhereABendLifts)
{
    // A red block behind the horizon of an Earth without ground, so high that it stands above the horizon once it is exaggerated.
    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<osg::CoordinateSystemNode> earth = new osg::CoordinateSystemNode;
    earth->setEllipsoidModel(new osg::EllipsoidModel);
    scene->addChild(earth);
    const osg::Vec3d up(1.0, 0.0, 0.0), north(0.0, 0.0, 1.0);
    const double angle = 0.04; // 255 km
    const osg::Vec3d there = up * std::cos(angle) + north * std::sin(angle);
    osg::ref_ptr<osg::Group> tile = new osg::Group;
    osg::ref_ptr<osg::ShapeDrawable> block =
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(there * EQUATOR), 50000.0f));
    block->setColor(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f));
    tile->addChild(block);
    tile->setCullCallback(
        new osg::ClusterCullingCallback(osg::Vec3(there * EQUATOR), osg::Vec3(there), -0.005f));
    earth->addChild(tile);
    CullHarness harness(context(), scene, WIDTH, HEIGHT);
    const osg::Vec3d eye = up * (EQUATOR + 1000.0);
    harness.setCamera(osg::Matrixd::lookAt(eye, eye + north, up),
                      osg::Matrixd::perspective(60.0, static_cast<double>(WIDTH) / HEIGHT, 10.0, 1e7));
    EXPECT_TRUE(harness.frame(true).leaves.empty()) << "the test's block does not know its horizon";
    osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
    exaggeration->setFactor(10.0);
    scene->addEffect(exaggeration);
    EXPECT_EQ(harness.frame(true).leaves.size(), 1u);
}
