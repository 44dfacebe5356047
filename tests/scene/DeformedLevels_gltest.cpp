// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Near and far planes, levels of detail and small-feature culling go by where things are drawn, and not by where the file
// says that they are.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>

#include <osg/CullingSet>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/Transform>
#include <osg/TriangleIndexFunctor>
#include <osg/UserDataContainer>
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;

const osg::Vec3Array& verticesOf(const osg::Drawable& drawable)
{
    return dynamic_cast<const osg::Vec3Array&>(*drawable.asGeometry()->getVertexArray());
}

/// What the near and far planes of a frame must contain.
struct Depths
{
    double nearest = HUGE_VAL; ///< of what is in the picture, before the eye
    double farthest = 0.0;
    double farthestDrawn = 0.0; ///< in the picture or not
};

/// The vertices that are drawn: the blocks of a tile may share an array.
struct UsedVertices
{
    std::set<unsigned int> indices;
    void operator()(unsigned int a, unsigned int b, unsigned int c) { indices.insert({a, b, c}); }
};

Depths depthsOf(const Culled& culled, const DeformationChain& chain)
{
    Depths depths;
    for (const Culled::Leaf& leaf : culled.leaves)
    {
        osg::TriangleIndexFunctor<UsedVertices> used;
        leaf.drawable->accept(used);
        for (const unsigned int index : used.indices)
        {
            const osg::Vec3d vertex(verticesOf(*leaf.drawable).at(index));
            const osg::Vec3d eye = chain.deform(vertex * leaf.modelView);
            const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * culled.projection;
            depths.farthestDrawn = std::max(depths.farthestDrawn, -eye.z());
            if (eye.z() >= 0.0 || std::abs(clip.x()) > clip.w() || std::abs(clip.y()) > clip.w()) continue;
            depths.nearest = std::min(depths.nearest, -eye.z());
            depths.farthest = std::max(depths.farthest, -eye.z());
        }
    }
    return depths;
}

/// The planes of a projection, as distances before the eye.
void planesOf(const osg::Matrixd& projection, double& near, double& far)
{
    osg::Matrixd back;
    back.invert(projection);
    near = -(osg::Vec3d(0.0, 0.0, -1.0) * back).z();
    far = -(osg::Vec3d(0.0, 0.0, 1.0) * back).z();
}

class DeformedLevels : public GlFixture
{
protected:
    DeformedLevels() : GlFixture(WIDTH, HEIGHT) {}
};

/// A small square on the ground.
osg::ref_ptr<osg::Geometry> makeSquare(const osg::Vec3d& middle, double half)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
        vertices->push_back(middle + osg::Vec3d(x * half, y * half, 0.0));
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

/// Things on flat ground below a camera, with a bend of either kind without a wish for more or less detail.
struct Plain
{
    explicit Plain(Random& random)
    {
        scene->setTerrainFrame(EffectScene::PROJECTED);
        osg::ref_ptr<PerspectiveBend> bend;
        if (random.integer(0, 1))
        {
            const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
            pedestrian->setFocusDistance(random.uniform(100.0, 1000.0));
            pedestrian->setZoneWidth(random.uniform(200.0, 1000.0));
            pedestrian->setBendAngle(random.uniform(0.6, 1.4));
            bend = pedestrian;
        }
        else
        {
            const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
            bird->setFocusLine(0.2);
            bird->setHorizonLine(random.uniform(0.5, 0.8));
            bird->setContextTilt(random.uniform(0.0, 0.9));
            bend = bird;
        }
        bend->setTransitionDetail(1.0);
        scene->addEffect(bend);
        view = osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, random.uniform(200.0, 1500.0)),
                                    osg::Vec3d(0.0, random.uniform(1000.0, 3000.0), 0.0),
                                    osg::Vec3d(0.0, 0.0, 1.0));
        projection = osg::Matrixd::perspective(60.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e5);
        chain = scene->deformation(view, projection);
    }

    osg::Vec3d place(Random& random) const
    {
        return {random.uniform(-2000.0, 2000.0), random.uniform(100.0, 6000.0), random.uniform(0.0, 50.0)};
    }
    /// A place in the focus or in the context: there the deformation is rigid and nothing is stretched.
    osg::Vec3d rigidPlace(Random& random) const
    {
        for (;;)
        {
            const osg::Vec3d place = this->place(random);
            const double before = chain->style((place - osg::Vec3d(0.0, 50.0, 0.0)) * view);
            const double behind = chain->style((place + osg::Vec3d(0.0, 50.0, 0.0)) * view);
            if (before == behind && (before == 0.0 || before == 1.0)) return place;
        }
    }
    /// Pixels that a ball at a point of eye space has from its middle to its border.
    double pixels(const osg::Vec3d& eye, double radius) const
    {
        const osg::ref_ptr<osg::Viewport> port = new osg::Viewport(0, 0, WIDTH, HEIGHT);
        const osg::Vec4d size = osg::CullingSet::computePixelSizeVector(*port, projection, osg::Matrix());
        return std::abs(radius / (osg::Vec4d(eye, 1.0) * size));
    }

    osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::Matrixd view;
    osg::Matrixd projection;
    osg::ref_ptr<const DeformationChain> chain;
};

} // namespace

TEST_F(DeformedLevels, NearAndFarContainWhatIsDrawn)
{
    const int count = fullTest() ? 300 : 6;
    const double ratio = 0.0005;
    int checked = 0;
    int wrongWithout = 0;
    double widest = 0.0;
    for (const char* name : {"oahu", "oahu_projected"})
    {
        const std::optional<Scene> oahu = loadOahu(name);
        if (!oahu) return;
        EffectScene& scene = *oahu->effects;
        CullHarness harness(context(), oahu->node, WIDTH, HEIGHT);
        harness.camera().setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        harness.camera().setNearFarRatio(ratio);
        for (int i = 0; i < count; ++i)
        {
            SCOPED_TRACE(std::string(name) + ", camera " + std::to_string(i));
            Random random(static_cast<std::uint64_t>(i) + 3000);
            addRandomEffects(scene, random);
            const osg::Matrixd view = randomOahuView(random, *oahu->reference);
            osg::Matrixd projection = randomProjection(random);
            for (const bool compensation : {true, false})
            {
                scene.setCompensation(compensation);
                // The harness draws with what the camera has been given; planes are computed anew each time.
                harness.setCamera(view, projection);
                for (int step = 0; compensation && step < 3; ++step)
                    CullHarness::load(harness.frame(true, false).requests, random, 1.0);
                const Culled culled = harness.frame(true, false);
                if (culled.leaves.empty()) continue;
                const osg::ref_ptr<const DeformationChain> chain = scene.deformation(view, projection);
                const Depths depths = depthsOf(culled, *chain);
                if (!(depths.farthest > 0.0)) continue;
                double near = 0.0;
                double far = 0.0;
                planesOf(culled.projection, near, far);
                const bool perspective = projection(3, 3) == 0.0;
                // OSG keeps the near plane from coming nearer than a share of the far plane.
                const bool clamped = perspective && near <= 1.001 * ratio * far;
                const bool fine = depths.farthest <= far * (1.0 + 1e-6) &&
                                  (clamped || depths.nearest >= near * (1.0 - 1e-6));
                if (!compensation)
                {
                    wrongWithout += fine ? 0 : 1;
                    continue;
                }
                ++checked;
                EXPECT_TRUE(fine) << "near " << near << ", far " << far << "; drawn from " << depths.nearest
                                  << " to " << depths.farthest;
                // A hull is wider than what is in it, most of all around one coarse tile across the whole zone.
                EXPECT_LE(far, 5.0 * depths.farthestDrawn + 100.0);
                widest = std::max(widest, far / depths.farthestDrawn);
            }
        }
    }
    std::cout << checked << " frames; far at most " << widest
              << " times the farthest vertex; without compensation " << wrongWithout << " are wrong\n";
    EXPECT_GT(checked, count);
    EXPECT_GT(wrongWithout, 0);
}

namespace
{

struct Tiles
{
    int inZone = 0;
    int inContext = 0;
    int inFocus = 0;
    int groups = 0; ///< whose choice was compared with the rule
};

/// What a camera over a database read anew draws when all has come.
Tiles settledTiles(osg::GraphicsContext& context, const char* name, double transitionDetail,
                   double contextDetail)
{
    Tiles tiles;
    const std::optional<Scene> oahu = loadOahu(name);
    if (!oahu) return tiles;
    const osg::ref_ptr<PedestrianView> effect = new PedestrianView;
    effect->setFocusDistance(9000.0);
    effect->setZoneWidth(20000.0);
    effect->setTransitionDetail(transitionDetail);
    effect->setContextDetail(contextDetail);
    oahu->effects->addEffect(effect);
    ViewPoint point;
    point.longitude = osg::DegreesToRadians(-158.3);
    point.latitude = osg::DegreesToRadians(21.42);
    point.height = 9000.0;
    point.heading = osg::DegreesToRadians(80.0);
    point.pitch = osg::DegreesToRadians(-15.0);
    osg::Matrixd view;
    EXPECT_TRUE(point.viewMatrix(*oahu->reference, view));
    const osg::Matrixd projection =
        osg::Matrixd::perspective(60.0, static_cast<double>(WIDTH) / HEIGHT, 5.0, 3e5);
    CullHarness harness(context, oahu->node, WIDTH, HEIGHT);
    harness.setCamera(view, projection);
    Random random(0);
    while (CullHarness::load(harness.frame(true, false).requests, random, 1.0) > 0)
    {
    }
    const Culled culled = harness.frame(true, false);
    const osg::ref_ptr<const DeformationChain> chain = oahu->effects->deformation(view, projection);
    for (const Culled::Leaf& leaf : culled.leaves)
    {
        const osg::BoundingBox& box = leaf.drawable->getBoundingBox();
        const double style = chain->style(osg::Vec3d(box.center()) * leaf.modelView);
        ++(style == 0.0 ? tiles.inFocus : style == 1.0 ? tiles.inContext : tiles.inZone);
        osg::NodePath path = leaf.drawable->getParentalNodePaths().front();
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
        {
            auto* group = dynamic_cast<osg::PagedLOD*>(path[i]);
            if (!group) continue;
            const osg::Matrixd toEye = osg::computeLocalToWorld(osg::NodePath(
                                           path.begin(), path.begin() + static_cast<std::ptrdiff_t>(i))) *
                                       view;
            const Ball ball = {osg::Vec3d(group->getCenter()) * toEye,
                               static_cast<double>(group->getBound().radius())};
            // Where triangles are too large for the bend they become smaller, whatever the distance.
            const double ratio =
                std::min(chain->lodDistance(ball, osg::Vec3d()), chain->lodLimit(*group, ball)) /
                static_cast<double>(group->getMaxRange(1));
            const bool finer = path[i + 1] != group->getChild(0);
            // The visitor's radius is wider by a millionth.
            EXPECT_TRUE(finer ? ratio < 1.0001 : ratio > 0.9999) << group->getFileName(1) << ": " << ratio;
            ++tiles.groups;
        }
    }
    return tiles;
}

} // namespace

TEST_F(DeformedLevels, TilesFollowTheDeformedDistanceAndTheWishedDetail)
{
    for (const char* name : {"oahu", "oahu_projected"})
    {
        if (!fullTest() && name != std::string("oahu")) continue;
        SCOPED_TRACE(name);
        const Tiles even = settledTiles(context(), name, 1.0, 1.0);
        const Tiles fineZone = settledTiles(context(), name, 4.0, 1.0);
        const Tiles coarseContext = settledTiles(context(), name, 1.0, 0.25);
        std::cout << name << ": zone " << even.inZone << ", with detail 4 " << fineZone.inZone << "; context "
                  << even.inContext << ", with detail 1/4 " << coarseContext.inContext << "\n";
        EXPECT_GT(even.groups, 20);
        EXPECT_GT(fineZone.inZone, even.inZone * 3 / 2);
        EXPECT_LT(coarseContext.inContext, even.inContext);
        EXPECT_GT(even.inContext, 4);
        EXPECT_GT(even.inZone, 4);
    }
}

TEST_F(DeformedLevels, PlainLodsGoByTheDeformedDistanceAndSize)
{
    const int count = fullTest() ? 2000 : 200;
    int others[2][2] = {{0, 0}, {0, 0}};
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i) + 5000);
        const Plain plain(random);
        CullHarness harness(context(), plain.scene, WIDTH, HEIGHT);
        const bool bySize = random.integer(0, 1) != 0;
        const osg::Vec3d place = plain.rigidPlace(random);
        const double radius = 4.0;
        const osg::Vec3d eye = place * plain.view;
        const osg::Vec3d deformed = plain.chain->deform(eye);
        // Behind the eye sizes are of no use.
        if (deformed.z() > -50.0 || eye.z() > -50.0) continue;
        const double undeformedValue = bySize ? plain.pixels(eye, radius) : eye.length();
        const double value = bySize ? plain.pixels(deformed, radius) : deformed.length();
        const double limit = undeformedValue * random.logarithmic(0.6, 1.6);
        if (std::abs(value / limit - 1.0) < 0.02) continue;
        osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        lod->setRangeMode(bySize ? osg::LOD::PIXEL_SIZE_ON_SCREEN : osg::LOD::DISTANCE_FROM_EYE_POINT);
        lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        lod->setCenter(place);
        lod->setRadius(static_cast<float>(radius));
        const osg::ref_ptr<osg::Geometry> low = makeSquare(place, 1.0);
        const osg::ref_ptr<osg::Geometry> high = makeSquare(place, 1.0);
        lod->addChild(low, 0.0f, static_cast<float>(limit));
        lod->addChild(high, static_cast<float>(limit), 1e9f);
        plain.scene->addChild(lod);
        harness.setCamera(plain.view, plain.projection);
        const Culled culled = harness.frame(false, false);
        ASSERT_EQ(culled.leaves.size(), 1u);
        EXPECT_EQ(culled.leaves[0].drawable == low, value < limit)
            << (bySize ? "size " : "distance ") << value << ", undeformed " << undeformedValue << ", limit "
            << limit;
        if ((value < limit) != (undeformedValue < limit)) ++others[bySize ? 1 : 0][value < limit ? 1 : 0];

        // Without compensation it is the undeformed one.
        plain.scene->setCompensation(false);
        const Culled without = harness.frame(false, false);
        ASSERT_EQ(without.leaves.size(), 1u);
        EXPECT_EQ(without.leaves[0].drawable == low, undeformedValue < limit);
    }
    std::cout << "by distance " << others[0][0] << " farther, " << others[0][1] << " nearer; by size "
              << others[1][1] << " smaller, " << others[1][0] << " larger than undeformed\n";
    for (const auto& kind : others)
    {
        EXPECT_GT(kind[0] + kind[1], count / 100);
        EXPECT_GT(std::max(kind[0], kind[1]), 0);
    }
}

TEST_F(DeformedLevels, SmallThingsGoByTheirDeformedSize)
{
    const int count = fullTest() ? 2000 : 200;
    int dropped = 0;
    int others = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i) + 7000);
        const Plain plain(random);
        CullHarness harness(context(), plain.scene, WIDTH, HEIGHT);
        const osg::Vec3d place = plain.rigidPlace(random);
        const osg::Vec3d eye = place * plain.view;
        const osg::Vec3d deformed = plain.chain->deform(eye);
        if (deformed.z() > -50.0 || eye.z() > -50.0) continue;
        const double threshold = random.uniform(1.0, 20.0);
        const double undeformedPixels = threshold * random.logarithmic(0.6, 1.6);
        const double radius = undeformedPixels / plain.pixels(eye, 1.0);
        if (radius > 40.0) continue;
        const double pixels = plain.pixels(deformed, radius);
        if (std::abs(pixels / threshold - 1.0) < 0.02) continue;
        const osg::ref_ptr<osg::Geometry> thing = makeSquare(place, radius / std::sqrt(2.0));
        // As OSG does it, nodes are left out, and not single drawables. A transform of one drawable goes another way.
        const osg::ref_ptr<osg::Group> node = i % 2 ? new osg::MatrixTransform : new osg::Group;
        node->addChild(thing);
        plain.scene->addChild(node);
        harness.camera().setCullingMode(osg::CullSettings::SMALL_FEATURE_CULLING);
        harness.camera().setSmallFeatureCullingPixelSize(static_cast<float>(threshold));
        harness.setCamera(plain.view, plain.projection);
        const bool drawn = !harness.frame(true, false).leaves.empty();
        EXPECT_EQ(drawn, pixels > threshold) << pixels << " pixels of " << threshold;
        dropped += drawn ? 0 : 1;
        others += (pixels > threshold) != (undeformedPixels > threshold) ? 1 : 0;
    }
    std::cout << dropped << " dropped, " << others << " unlike undeformed\n";
    EXPECT_GT(dropped, count / 10);
    EXPECT_GT(others, count / 40);
}

TEST_F(DeformedLevels, WithoutCompensationCullingIsThatOfAPlainGroup)
{
    const std::optional<Scene> oahu = loadOahu("oahu");
    if (!oahu) return;
    CullHarness harness(context(), oahu->node, WIDTH, HEIGHT);
    int others = 0;
    for (int i = 0; i < (fullTest() ? 200 : 12); ++i)
    {
        SCOPED_TRACE("camera " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i) + 9000);
        EffectScene& scene = *oahu->effects;
        addRandomEffects(scene, random);
        harness.setCamera(randomOahuView(random, *oahu->reference), randomProjection(random));
        CullHarness::load(harness.frame(true, false).requests, random, 0.5);
        const std::set<const osg::Drawable*> with = harness.frame(true, false).drawables();
        scene.setCompensation(false);
        const std::set<const osg::Drawable*> without = harness.frame(true, false).drawables();
        scene.setCompensation(true);
        for (unsigned int effect = 0; effect < scene.getNumEffects(); ++effect)
            scene.getEffect(effect)->setEnabled(false);
        EXPECT_EQ(without, harness.frame(true, false).drawables());
        others += with != without ? 1 : 0;
    }
    EXPECT_GT(others, 3);
}

TEST_F(DeformedLevels, DebugBoundsAreLines)
{
    Random random(1);
    const Plain plain(random);
    for (int i = 0; i < 40; ++i)
        plain.scene->addChild(makeSquare(plain.place(random), 100.0));
    CullHarness harness(context(), plain.scene, WIDTH, HEIGHT);
    harness.setCamera(plain.view, plain.projection);
    const Culled without = harness.frame(true);
    plain.scene->setDebugBounds(true);
    const Culled with = harness.frame(true);
    ASSERT_EQ(with.leaves.size(), without.leaves.size() + 1);
    int lines = 0;
    for (const Culled::Leaf& leaf : with.leaves)
        lines += leaf.drawable->asGeometry()->getPrimitiveSet(0)->getMode() == GL_LINES ? 1 : 0;
    EXPECT_EQ(lines, 1);
    EXPECT_NE(std::memcmp(with.image->data(), without.image->data(), with.image->getTotalSizeInBytes()), 0);
    plain.scene->setDebugBounds(false);
    EXPECT_EQ(harness.frame(true).leaves.size(), without.leaves.size());
    // Without an effect, too.
    while (plain.scene->getNumEffects() > 0)
        plain.scene->removeEffect(plain.scene->getEffect(0));
    const std::size_t bare = harness.frame(true).leaves.size();
    plain.scene->setDebugBounds(true);
    EXPECT_EQ(harness.frame(true).leaves.size(), bare + 1);
}

TEST_F(DeformedLevels, AForeignDatabaseIsCulledWithoutBeingKnown)
{
    // Nothing tells of boxes, heights or errors.
    struct Forget : public osg::NodeVisitor
    {
        Forget() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Node& node) override
        {
            node.setUserDataContainer(nullptr);
            node.setName("");
            traverse(node);
        }
    } forget;
    const TempDir folder;
    const std::string file = PagedScene::write(folder.path(), PagedScene::Kind::Flat).string();
    const int scenes = fullTest() ? 60 : 12;
    int loaded = 0;
    int bent = 0;
    int culledAway = 0;
    // Kept to the end: Mesa complains where a buffer object of a scene that is gone is used again.
    std::vector<osg::ref_ptr<EffectScene>> kept;
    for (int i = 0; i < scenes; ++i)
    {
        Random random(static_cast<std::uint64_t>(i) + 11000);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addChild(osgDB::readRefNodeFile(file));
        kept.push_back(scene);
        addRandomEffects(*scene, random);
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        harness.camera().setLODScale(static_cast<float>(random.uniform(1.0, 8.0)));
        for (int step = 0; step < 6; ++step)
        {
            SCOPED_TRACE("scene " + std::to_string(i) + ", camera " + std::to_string(step));
            scene->accept(forget);
            const osg::Vec3d eye(random.uniform(-3000.0, 3000.0), random.uniform(-3000.0, 3000.0),
                                 random.logarithmic(50.0, 8000.0));
            const osg::Vec3d target(random.uniform(-2500.0, 2500.0), random.uniform(-2500.0, 2500.0), 0.0);
            const osg::Matrixd view = osg::Matrixd::lookAt(eye, target, osg::Vec3d(0.0, 0.0, 1.0));
            const osg::Matrixd projection = randomProjection(random);
            harness.setCamera(view, projection);
            const Culled culled = harness.frame(true);
            const Culled everything = harness.frame(false);
            bent += scene->deformation(view, projection)->empty() ? 0 : 1;
            culledAway += static_cast<int>(everything.leaves.size() - culled.leaves.size());
            EXPECT_TRUE(imagesMatch(*culled.image, *everything.image));
            loaded += CullHarness::load(culled.requests, random, 0.5);
        }
    }
    std::cout << loaded << " tiles loaded, " << bent << " pictures bent, " << culledAway << " tiles culled\n";
    EXPECT_GT(loaded, scenes);
    EXPECT_GT(bent, 3 * scenes);
    EXPECT_GT(culledAway, scenes);
}
