// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The blocks of ground from which a proxy frustum is made, and proxies of scenes of any size.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/ShaderHost.h>
#include <osgGeoFX/scene/detail/GlobeHorizon.h>
#include <osgGeoFX/scene/detail/GroundShell.h>
#include <osgGeoFX/scene/detail/ProxyFrustum.h>
#include <osgGeoFX/scene/detail/Visibility.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <string>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

Ground earth(double lowest, double highest)
{
    Ground ground;
    ground.ellipsoid = new osg::EllipsoidModel;
    ground.minHeight = lowest;
    ground.maxHeight = highest;
    ground.heightsKnown = true;
    return ground;
}

/// By how much a point lies outside of a box with orthogonal axes, metres.
double outside(const EyeBox& box, const osg::Vec3d& point)
{
    double most = 0.0;
    for (const osg::Vec3d& half : box.half)
        most = std::max(most, std::abs((point - box.center) * half) / half.length() - half.length());
    return most;
}

/// Lets what a projection shows be in sight. `planes` must live as long as `sight`.
void look(const osg::Matrixd& projection, osg::Polytope& planes, Visibility& sight)
{
    planes.setToUnitFrustum(true, true);
    planes.transformProvidingInverse(projection);
    Visibility::Camera camera;
    camera.projection = projection;
    camera.planes = &planes;
    sight.set(camera);
}

} // namespace

TEST(GroundShell, BoxesHoldTheGroundOfTheirBlocks)
{
    const Ground ground = earth(-11000.0, 9000.0);
    const GroundShell shell(osg::BoundingSphere(osg::Vec3(), 6.4e6f), ground);
    Random random(21);
    for (int i = 0; i < sampleCount(); ++i)
    {
        // A block that halving leads to.
        const std::vector<GroundShell::Block> all = shell.blocks();
        GroundShell::Block block =
            all[static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1))];
        for (int halvings = random.integer(0, 40); halvings > 0; --halvings)
        {
            const auto [first, second] = shell.halvesOf(block);
            block = random.integer(0, 1) ? first : second;
        }
        const std::optional<EyeBox> box = shell.boxOf(block);
        ASSERT_TRUE(box);
        for (int j = 0; j < 5; ++j)
        {
            osg::Vec3d at;
            for (int axis = 0; axis < 3; ++axis)
            {
                const double share = random.integer(0, 2) ? random.uniform(0.0, 1.0) : random.integer(0, 1);
                at[axis] = block.low[axis] + (block.high - block.low)[axis] * share;
            }
            osg::Vec3d place;
            ground.ellipsoid->convertLatLongHeightToXYZ(at.y(), at.x(), at.z(), place.x(), place.y(),
                                                        place.z());
            EXPECT_LE(outside(*box, place), 1e-6)
                << "longitude " << block.low.x() << " to " << block.high.x() << ", latitude " << block.low.y()
                << " to " << block.high.y() << ", height " << block.low.z() << " to " << block.high.z();
        }
    }
}

TEST(GroundShell, BlocksHoldAllGround)
{
    const Ground ground = earth(-500.0, 9000.0);
    const GroundShell shell(osg::BoundingSphere(osg::Vec3(), 6.4e6f), ground);
    Random random(22);
    for (int i = 0; i < 1000; ++i)
    {
        const osg::Vec3d at(random.uniform(-osg::PI, osg::PI), random.uniform(-osg::PI_2, osg::PI_2),
                            random.uniform(-500.0, 9000.0));
        const std::vector<GroundShell::Block> all = shell.blocks();
        EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                                [&](const GroundShell::Block& each)
                                {
                                    bool within = true;
                                    for (int axis = 0; axis < 3; ++axis)
                                        within = within && at[axis] >= each.low[axis] - 1e-9 &&
                                                 at[axis] <= each.high[axis] + 1e-9;
                                    return within;
                                }));
    }
}

// A model on a table is terrain, too.
TEST(ProxyFrustumTest, SmallTerrainsHaveOne)
{
    Ground ground;
    for (const double radius : {1e-3, 1.0, 1e3, 1e6})
    {
        // The eye is among the hills.
        const osg::BoundingSphere bound(osg::Vec3(), static_cast<float>(radius));
        const ProxyFrustum::Terrain terrain = {bound,          osg::Matrixd(),
                                               osg::Matrixd(), osg::Vec3d(0.0, 1.0, 0.0),
                                               ground,         {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL},
                                               HUGE_VAL};
        const ProxyFrustum proxy(
            terrain, [](const EyeBox&) { return false; },
            [](const EyeBox& box)
            {
                const Ball ball = box.ball();
                return std::pair(-ball.center.z() - ball.radius, -ball.center.z() + ball.radius);
            },
            [](const EyeBox&) { return false; });
        EXPECT_GE(proxy.depths().second, 0.9 * radius) << "of a terrain of " << radius << " m";
        const osg::Vec3d ahead = osg::Vec3d(0.0, 0.0, -0.9 * radius) * proxy.projection();
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LE(std::abs(ahead[axis]), 1.0) << "of a terrain of " << radius << " m";
    }
}

// So that a far plane by them leaves a near plane before the foreground.
TEST(ProxyFrustumTest, DepthsOfAGlobeAreThoseOfItsGround)
{
    const Ground ground = earth(-500.0, 4400.0);
    const osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
    exaggeration->setFactor(2.0);
    const osg::ref_ptr<Effect> effects[] = {exaggeration, new BirdsEyeView, new PedestrianView,
                                            new PanoramaMap};
    const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 1.8, 1.0, 1e8);
    Random random(23);
    for (const osg::ref_ptr<Effect>& effect : effects)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<osg::CoordinateSystemNode> world = new osg::CoordinateSystemNode;
        world->setEllipsoidModel(new osg::EllipsoidModel);
        scene->addChild(world);
        EffectScene::GroundDescription heights;
        heights.minHeight = ground.minHeight;
        heights.maxHeight = ground.maxHeight;
        ASSERT_TRUE(scene->setGround(heights));
        scene->addEffect(effect);
        for (const double height : {200.0, 800.0, 4500.0, 50e3})
        {
            SCOPED_TRACE(std::string(effect->className()) + " from " + std::to_string(height));
            constexpr double latitude = 0.8;
            osg::Matrixd place;
            ground.ellipsoid->computeLocalToWorldTransformFromLatLongHeight(latitude, 0.0, height, place);
            const osg::Matrixd view = osg::Matrixd::inverse(
                osg::Matrixd::rotate(osg::DegreesToRadians(75.0), osg::Vec3d(1.0, 0.0, 0.0)) * place);
            const osg::ref_ptr<const DeformationChain> chain = scene->deformation(view, projection);
            if (chain->empty()) continue;
            const ViewGeometry geometry(view, projection, ground);
            const GlobeHorizon horizon(*chain, geometry, {});
            osg::Polytope planes;
            Visibility sight;
            look(projection, planes, sight);
            const auto isOut = [&](const EyeBox& box)
            {
                return horizon.hides(box.ball()) || sight.outOfSight(*chain, box, sight.all());
            };
            const ProxyFrustum::Terrain terrain = {
                osg::BoundingSphere(osg::Vec3(), 6.4e6f), view,    osg::Matrixd(), geometry.up, ground,
                {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL}, HUGE_VAL};
            const ProxyFrustum proxy(
                terrain, isOut, [&](const EyeBox& box) { return sight.depthsOf(*chain, box); },
                [](const EyeBox&) { return false; });
            double farthest = 0.0, nearest = HUGE_VAL;
            for (int i = 0; i < 20000; ++i)
            {
                const double turn = random.logarithmic(1e-6, 0.3), bearing = random.uniform(-1.0, 1.0);
                osg::Vec3d at;
                ground.ellipsoid->convertLatLongHeightToXYZ(
                    latitude + turn * std::cos(bearing), turn * std::sin(bearing) / std::cos(latitude),
                    i % 2 ? ground.minHeight : ground.maxHeight, at.x(), at.y(), at.z());
                const osg::Vec3d seen = at * view;
                if (chain->hides({seen, 0.0}, {}) || horizon.hides({seen, 0.0})) continue;
                const osg::Vec3d clip = chain->deform(seen) * projection;
                const double depth = -chain->deform(seen).z();
                if (!(depth > 0.0) || !(std::max(std::abs(clip.x()), std::abs(clip.y())) < 1.0)) continue;
                farthest = std::max(farthest, depth);
                if (i % 2) nearest = std::min(nearest, depth);
            }
            EXPECT_GE(proxy.depths().second, farthest);
            // By OSG's ratio of near and far.
            EXPECT_LE(0.0005 * proxy.depths().second, nearest);
            const bool isTight = effect->className() != std::string("PanoramaMap") && height < 10e3;
            if (isTight)
            {
                EXPECT_LE(proxy.depths().second, 1.3 * farthest);
            }
        }
    }
}

// Engines fit to their frustum what they drape.
TEST(ProxyFrustumTest, OpensAsWideAsThePictureWhereNothingMoves)
{
    const Ground ground = earth(-500.0, 4400.0);
    const osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
    exaggeration->setFactor(1.0005);
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<osg::CoordinateSystemNode> world = new osg::CoordinateSystemNode;
    world->setEllipsoidModel(new osg::EllipsoidModel);
    scene->addChild(world);
    scene->addEffect(exaggeration);
    const double up = std::tan(osg::DegreesToRadians(20.0)), right = 1.8 * up;
    const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 1.8, 1.0, 1e8);
    for (const double height : {50e3, 900e3, 9e6})
        for (const double pitch : {-90.0, -70.0, height > 1e6 ? -60.0 : -20.0})
        {
            SCOPED_TRACE(std::to_string(height) + " m, " + std::to_string(pitch) + " degrees");
            osg::Matrixd place;
            ground.ellipsoid->computeLocalToWorldTransformFromLatLongHeight(0.8, 0.0, height, place);
            const osg::Matrixd view = osg::Matrixd::inverse(
                osg::Matrixd::rotate(osg::DegreesToRadians(90.0 + pitch), osg::Vec3d(1.0, 0.0, 0.0)) * place);
            const osg::ref_ptr<const DeformationChain> chain = scene->deformation(view, projection);
            const ViewGeometry geometry(view, projection, ground);
            osg::Polytope planes;
            Visibility sight;
            look(projection, planes, sight);
            const ProxyFrustum::Terrain terrain = {
                osg::BoundingSphere(osg::Vec3(), 6.4e6f),
                view,
                osg::Matrixd(),
                geometry.up,
                ground,
                {right, right, up, up},
                chain->verticalMovement(ground.minHeight, ground.maxHeight)};
            const ProxyFrustum proxy(
                terrain, [&](const EyeBox& box) { return sight.outOfSight(*chain, box, sight.all()); },
                [&](const EyeBox& box) { return sight.depthsOf(*chain, box); },
                [&](const EyeBox& box) { return chain->movesVertically(box.ball()); });
            const osg::Matrixd& opened = proxy.projection();
            // The ground moves by 2 m: from 50 km, by less than a tenth of a pixel.
            EXPECT_NEAR(opened(0, 0) / projection(0, 0), 1.0, height < 1e5 ? 1e-3 : 1e-9);
            EXPECT_NEAR(opened(1, 1) / projection(1, 1), 1.0, height < 1e5 ? 1e-3 : 1e-9);
            EXPECT_NEAR(opened(2, 0), 0.0, 1e-9);
            EXPECT_NEAR(opened(2, 1), 0.0, height < 1e5 ? 1e-3 : 1e-9);
        }
}

// All ground behind a map's end comes to one point of the picture. What comes there from far beside the picture has no height left.
TEST(ProxyFrustumTest, CoarseTilesFarBesideAPanoramaMapAreHidden)
{
    class Host : public ShaderHost
    {
    public:
        bool draws(const osg::StateAttribute&) const override { return false; }
        bool leavesTilesCoarse() const override { return true; }
    };
    const Ground ground = earth(-500.0, 4400.0);
    constexpr double latitude = 0.8, height = 4500.0;
    osg::Matrixd place;
    ground.ellipsoid->computeLocalToWorldTransformFromLatLongHeight(latitude, 0.0, height, place);
    const osg::Matrixd view = osg::Matrixd::inverse(
        osg::Matrixd::rotate(osg::DegreesToRadians(70.0), osg::Vec3d(1.0, 0.0, 0.0)) * place);
    const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 1.8, 1.0, 1e8);
    // How many of the tiles, 1 km wide, are hidden, in a row across the map's end that is so far beside the middle.
    const auto hiddenIn = [&](bool coarse, double beside)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        const osg::ref_ptr<osg::CoordinateSystemNode> world = new osg::CoordinateSystemNode;
        world->setEllipsoidModel(new osg::EllipsoidModel);
        scene->addChild(world);
        scene->addEffect(new PanoramaMap);
        if (coarse) scene->setShaderHost(new Host);
        const osg::ref_ptr<const DeformationChain> chain = scene->deformation(view, projection);
        int hidden = 0;
        for (int i = 0; i < 20; ++i)
        {
            const osg::Matrixd tile = osg::Matrixd::translate(beside, 1000.0 * i, -height) * place * view;
            EyeBox box;
            box.center = osg::Vec3d() * tile;
            for (int axis = 0; axis < 3; ++axis)
            {
                osg::Vec3d half;
                half[axis] = axis < 2 ? 500.0 : 100.0;
                box.half[axis] = osg::Matrixd::transform3x3(half, tile);
            }
            hidden += chain->hides(box, {}) ? 1 : 0;
        }
        return hidden;
    };
    EXPECT_EQ(hiddenIn(true, 150e3), 20);
    EXPECT_LT(hiddenIn(false, 150e3), 20);
    EXPECT_EQ(hiddenIn(true, 0.0), hiddenIn(false, 0.0));
    EXPECT_LT(hiddenIn(true, 0.0), 10);
}
