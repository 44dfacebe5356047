// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What deformations tell of themselves, against what they do: each bound is measured by moving points, and is needed by
// more than half somewhere, so that one that is half as large does not pass.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::Ball;
using osgGeoFX::DeformationChain;
using osgGeoFX::EyeBox;
using osgGeoFX::Hull;
using osgGeoFX::PedestrianView;
using osgGeoFX::VerticalExaggeration;

namespace
{

/// A bend upwards before a camera on a plane, and the numbers that it has.
struct Fold
{
    osg::ref_ptr<const osgGeoFX::DeformationSnapshot> snapshot;
    BendNumbers bend;
    double curvature = 0.0;

    Fold(Random& random, const osgGeoFX::ViewGeometry& view, double least = 0.3)
    {
        const osg::ref_ptr<PedestrianView> effect = new PedestrianView;
        const auto curve = static_cast<osgGeoFX::PerspectiveBend::Curve>(random.integer(0, 2));
        EXPECT_TRUE(effect->setCurve(curve));
        EXPECT_TRUE(effect->setTallest(0.0));
        EXPECT_TRUE(effect->setBendAngle(random.uniform(least, 1.5707)));
        EXPECT_TRUE(effect->setFocusDistance(random.uniform(100.0, 5000.0)));
        EXPECT_TRUE(effect->setZoneWidth(random.logarithmic(200.0, 2e4)));
        EXPECT_TRUE(effect->setTransitionDetail(1.0));
        snapshot = effect->snapshot(view);
        EXPECT_TRUE(snapshot && bendNumbers(*snapshot, bend));
        if (snapshot) curvature = bendCurvature(bend, curve);
    }
};

osgGeoFX::ViewGeometry randomView(Random& random)
{
    CameraPose pose = randomCommonPose(random);
    pose.globe = false;
    pose.lens = CameraPose::PERSPECTIVE;
    return pose.view();
}

osg::ref_ptr<VerticalExaggeration> exaggeration(double factor, double base = 0.0)
{
    osg::ref_ptr<VerticalExaggeration> effect = new VerticalExaggeration;
    EXPECT_TRUE(effect->setFactor(factor));
    EXPECT_TRUE(effect->setBaseHeight(base));
    return effect;
}

double support(const std::vector<Vec3d>& points, const Vec3d& direction)
{
    double most = -HUGE_VAL;
    for (const Vec3d& point : points)
        most = std::max(most, point * direction);
    return most;
}

/// How far the image of an edge is from the straight line between the images of its ends, at most; and in which direction.
struct Bulge
{
    double length = 0.0;
    Vec3d direction;
    Vec3d point;
};

Bulge bulgeOf(const DeformationChain& chain, const Vec3d& from, const Vec3d& to)
{
    const Vec3d start = chain.deform(from);
    Vec3d along = chain.deform(to) - start;
    along.normalize();
    Bulge most;
    constexpr int steps = 16;
    for (int step = 1; step < steps; ++step)
    {
        const Vec3d point = chain.deform(from + (to - from) * (static_cast<double>(step) / steps));
        Vec3d off = point - start;
        off -= along * (off * along);
        const double length = off.normalize();
        if (length > most.length) most = {length, off, point};
    }
    return most;
}

/// For each random sample; says which one failed.
template<class Check>
void forSamples(int count, const Check& check)
{
    for (int sample = 0; sample < count; ++sample)
    {
        SCOPED_TRACE("sample " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        check(random);
        if (::testing::Test::HasFailure()) return;
    }
}

} // namespace

TEST(DeformationMeasures, HullsHoldSteepStripsAndNeedTheirMargins)
{
    // Of a strip that climbs along the bend the ends alone say little: in between, the turning frame carries it off.
    double tightest = 0.0;
    Hull hull;
    forSamples(sampleCount(),
               [&](Random& random)
               {
                   const Fold fold(random, randomView(random));
                   ASSERT_TRUE(fold.snapshot);
                   const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
                   chain->add(fold.snapshot);
                   const double reach = fold.bend.size * random.uniform(0.02, 0.4);
                   const double start = random.uniform(0.0, fold.bend.size - reach);
                   const double room = 0.8 / fold.curvature;
                   const double across = random.uniform(-1000.0, 1000.0);
                   const Vec3d from = fold.bend.point(start, random.uniform(-room, room), across);
                   const Vec3d to = fold.bend.point(start + reach, random.uniform(-room, room), across);
                   EyeBox box;
                   box.center = (from + to) * 0.5;
                   box.half[0] = (to - from) * 0.5;
                   box.half[1] = (fold.bend.forward ^ fold.bend.normal) * 0.01;
                   box.half[2] = box.half[0] ^ box.half[1];
                   box.half[2].normalize();
                   box.half[2] *= 0.01;
                   chain->bound(box, hull, 1.0);
                   const Bulge bulge = bulgeOf(*chain, from, to);
                   const double beyond =
                       bulge.point * bulge.direction - support(hull.points, bulge.direction);
                   EXPECT_LE(beyond, hull.margin + 1e-9 * bulge.point.length());
                   tightest = std::max(tightest, beyond / hull.margin);
               });
    RecordProperty("needed_share_of_margin", std::to_string(tightest));
    EXPECT_GT(tightest, 0.6);
}

TEST(DeformationMeasures, DistancesGrowAsLipschitzSaysFarFromThePlane)
{
    double tightest = 0.0;
    forSamples(sampleCount(),
               [&](Random& random)
               {
                   const Fold fold(random, randomView(random));
                   ASSERT_TRUE(fold.snapshot);
                   // Below a bend upwards nothing folds, and everything is stretched.
                   const double below = random.uniform(0.0, 4.0) * fold.bend.size;
                   const double s = random.uniform(0.01, 0.99) * fold.bend.size;
                   const double step = 1e-4 * fold.bend.size;
                   const Vec3d from = fold.bend.point(s - step, -below, 0.0);
                   const Vec3d to = fold.bend.point(s + step, -below, 0.0);
                   const double grown = (fold.snapshot->deform(to) - fold.snapshot->deform(from)).length();
                   const double most = fold.snapshot->lipschitz({(from + to) * 0.5, step});
                   EXPECT_LE(grown, most * 2.0 * step * (1.0 + 1e-6));
                   tightest = std::max(tightest, grown / (most * 2.0 * step));
               });
    RecordProperty("needed_share", std::to_string(tightest));
    EXPECT_GT(tightest, 0.95);
}

TEST(DeformationMeasures, TheHeightsOfTheGroundAreThoseOfExaggeratedPoints)
{
    forSamples(
        200,
        [](Random& random)
        {
            CameraPose pose = randomCommonPose(random);
            pose.globe = random.integer(0, 1) == 1;
            const osgGeoFX::ViewGeometry view = pose.view();
            const auto effect = exaggeration(random.logarithmic(0.2, 5.0), random.uniform(-900.0, 900.0));
            const auto snapshot = effect->snapshot(view);
            ASSERT_TRUE(snapshot);
            osgGeoFX::Ground ground;
            ground.minHeight = random.uniform(-400.0, 500.0);
            ground.maxHeight = ground.minHeight + random.uniform(0.0, 8000.0);
            // Straight below the eye, heights are told without any map.
            const auto raised = [&](double height)
            {
                return view.eyeHeight + snapshot->deform(view.up * (height - view.eyeHeight)) * view.up;
            };
            const double lowest = raised(ground.minHeight);
            const double highest = raised(ground.maxHeight);
            effect->changeGround(ground);
            // On the globe the normal below the eye is known to a few millimetres.
            EXPECT_NEAR(ground.minHeight, lowest, 0.1);
            EXPECT_NEAR(ground.maxHeight, highest, 0.1);
        });
}

/// A block of a tile: meshes for four distances, by the lengths of their longest edges, metres.
osg::ref_ptr<osg::LOD> blockOf(const std::vector<double>& edges)
{
    const osg::ref_ptr<osg::LOD> block = new osg::LOD;
    const osg::ref_ptr<osg::Vec2Array> meshes = new osg::Vec2Array;
    for (const double edge : edges)
    {
        const auto child = static_cast<float>(meshes->size());
        block->addChild(new osg::Geometry, 100.0f * child, 100.0f * (child + 1.0f));
        meshes->push_back(osg::Vec2(static_cast<float>(edge), 0.0f));
    }
    block->setUserData(meshes);
    return block;
}

TEST(DeformationMeasures, BlocksTakeTheCoarsestMeshWhoseEdgesAreShortEnough)
{
    int limited = 0;
    forSamples(
        200,
        [&](Random& random)
        {
            const osgGeoFX::ViewGeometry view = randomView(random);
            const Fold fold(random, view);
            ASSERT_TRUE(fold.snapshot);
            constexpr double tolerance = 1e-3;
            const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
            chain->add(fold.snapshot);
            chain->setTiles(0.125, tolerance);
            const Ball ball{fold.bend.point(0.5 * fold.bend.size, 0.0, 0.0), 0.05 * fold.bend.size};
            const double longest = fold.snapshot->longestEdge(ball, tolerance);
            if (!(longest > 1e-3 && longest < 1e6)) return;
            ++limited;
            const auto limit = [&](double a, double b, double c, double d)
            {
                return chain->lodLimit(*blockOf({a * longest, b * longest, c * longest, d * longest}), ball);
            };
            const double third = limit(0.5, 0.9, 0.99, 1.01);
            EXPECT_GT(third, 200.0);
            EXPECT_LT(third, 300.0);
            const double first = limit(0.9, 1.1, 2.0, 3.0);
            EXPECT_GT(first, 0.0);
            EXPECT_LT(first, 100.0);
            EXPECT_LT(limit(2.0, 3.0, 4.0, 5.0), 100.0) << "the finest is the best that there is";
            EXPECT_EQ(limit(0.0, 0.1, 0.2, 0.99), HUGE_VAL) << "all of them are short enough";
        });
    EXPECT_GT(limited, 50);
    const osg::ref_ptr<DeformationChain> nothing = new DeformationChain;
    nothing->setTiles(0.125, 1e-3);
    EXPECT_EQ(nothing->lodLimit(*blockOf({1e3, 1e4}), {osg::Vec3d(0.0, 0.0, -10.0), 1.0}), HUGE_VAL);
}

// An engine's tile with doubled heights is no larger, and no finer one is drawn for it.
TEST(DeformationMeasures, HeightsChangeTheLevelsOfTheKitsTilesAlone)
{
    forSamples(200,
               [](Random& random)
               {
                   const CameraPose pose = randomCommonPose(random);
                   const osg::ref_ptr<VerticalExaggeration> effect = new VerticalExaggeration;
                   const double factor = random.uniform(2.0, 5.0);
                   effect->setFactor(factor);
                   const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
                   const auto snapshot = effect->snapshot(pose.view());
                   chain->add(snapshot);
                   const Ball point{randomPointFor(*snapshot, pose.view(), random), 0.0};
                   chain->setTiles(0.0, 0.0, true);
                   const double own = chain->lodDistance(point, osg::Vec3d());
                   chain->setTiles(0.0, 0.0, false);
                   const double others = chain->lodDistance(point, osg::Vec3d());
                   EXPECT_NEAR(others, factor * own, 1e-9 * others);
                   const double stretch = snapshot->groundStretch(point);
                   EXPECT_NEAR(others, snapshot->deform(point.center).length() / stretch, 1e-9 * others);
                   if (!pose.globe)
                   {
                       EXPECT_EQ(stretch, 1.0);
                   }
               });
}

TEST(DeformationMeasures, TilesOfOthersBecomeFinerAsThoseOfTheKit)
{
    // The finer level of the kit's tiles comes last, that of others as their makers like it.
    const auto levels = [](bool finerFirst, const char* name)
    {
        const osg::ref_ptr<osg::LOD> node = new osg::LOD;
        const osg::ref_ptr<osg::MatrixTransform> mesh = new osg::MatrixTransform;
        mesh->setName(name);
        if (finerFirst) node->addChild(new osg::Group, 0.0f, 700.0f);
        node->addChild(mesh, 700.0f, 1e9f);
        if (!finerFirst) node->addChild(new osg::Group, 0.0f, 700.0f);
        return node;
    };
    const osg::ref_ptr<osg::LOD> own = levels(false, "tile 0/0/0");
    int limited = 0;
    forSamples(200,
               [&](Random& random)
               {
                   const osgGeoFX::ViewGeometry view = randomView(random);
                   const Fold fold(random, view);
                   ASSERT_TRUE(fold.snapshot);
                   const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
                   chain->add(fold.snapshot);
                   const Ball ball{fold.bend.point(0.5 * fold.bend.size, 0.0, 0.0), 0.3 * fold.bend.size};
                   chain->setTiles(0.5, 1e-3);
                   const double limit = chain->lodLimit(*own, ball);
                   for (const bool finerFirst : {false, true})
                   {
                       const osg::ref_ptr<osg::LOD> foreign = levels(finerFirst, "");
                       EXPECT_EQ(chain->lodLimit(*foreign, ball), HUGE_VAL) << "a house in the kit's terrain";
                       chain->setTiles(0.5, 1e-3, false);
                       EXPECT_EQ(chain->lodLimit(*foreign, ball), limit);
                       foreign->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
                       EXPECT_EQ(chain->lodLimit(*foreign, ball), HUGE_VAL);
                       foreign->setRangeMode(osg::LOD::DISTANCE_FROM_EYE_POINT);
                       foreign->addChild(new osg::Group, 0.0f, 10.0f);
                       EXPECT_EQ(chain->lodLimit(*foreign, ball), HUGE_VAL) << "of three, no one knows which";
                       chain->setTiles(0.5, 1e-3);
                   }
                   if (limit < 700.0) ++limited;
               });
    EXPECT_GT(limited, 50);
}

TEST(DeformationMeasures, EdgesThatAreShortEnoughMissTheirImagesByTheTolerance)
{
    // A tile as the kit's databases have them: a coarse mesh beside finer levels.
    const osg::ref_ptr<osg::LOD> tile = new osg::LOD;
    const osg::ref_ptr<osg::MatrixTransform> mesh = new osg::MatrixTransform;
    mesh->setName("tile 0/0/0");
    tile->addChild(mesh, 1000.0f, 1e9f);
    tile->addChild(new osg::Group, 0.0f, 1000.0f);
    constexpr double tolerance = 1e-3;
    double worst = 0.0;
    int limited = 0;
    forSamples(sampleCount() / 10,
               [&](Random& random)
               {
                   const osgGeoFX::ViewGeometry view = randomView(random);
                   const Fold fold(random, view);
                   const auto stretch = exaggeration(random.logarithmic(2.0, 8.0))->snapshot(view);
                   ASSERT_TRUE(fold.snapshot && stretch);
                   const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
                   chain->add(stretch);
                   chain->add(fold.snapshot);
                   const double room = 0.2 / fold.curvature;
                   const double middle = random.uniform(0.1, 0.9) * fold.bend.size;
                   const Vec3d raised =
                       fold.bend.point(middle, random.uniform(-room, room), random.uniform(-2e3, 2e3));
                   Ball ball;
                   ball.center = stretch->undeform(raised);
                   ball.radius = random.uniform(0.01, 0.1) * fold.bend.size;
                   // The longest edge that passes, by halving.
                   double passes = 0.0;
                   double fails = 1.0;
                   for (int step = 0; step < 40; ++step)
                   {
                       const double edge = 0.5 * (passes + fails);
                       chain->setTiles(edge, tolerance);
                       (std::isinf(chain->lodLimit(*tile, ball)) ? passes : fails) = edge;
                   }
                   // Where the ball reaches the eye, nothing is short enough; where it is far, its own size is.
                   if (passes < 1e-6 || passes > 0.999) return;
                   ++limited;
                   const double length = passes * ball.radius;
                   for (int i = 0; i < 20; ++i)
                   {
                       const Vec3d half = randomDirection(random) * (0.5 * length);
                       const Bulge bulge = bulgeOf(*chain, ball.center - half, ball.center + half);
                       const double share = bulge.length / (tolerance * bulge.point.length());
                       worst = std::max(worst, share);
                       // Curves are sharper below the plane than on it, by up to 0.4 here.
                       EXPECT_LE(share, 1.4);
                   }
               });
    RecordProperty("largest_share_of_tolerance", std::to_string(worst));
    EXPECT_GT(limited, sampleCount() / 100);
    EXPECT_GT(worst, 0.1) << "meshes are much finer than they need be";
}

TEST(DeformationMeasures, TheLevelOfDetailFollowsHowLargeThingsAreDrawn)
{
    // What is stretched by F and then has a gap of g to the eye looks like what is not, at a gap of g / F.
    forSamples(sampleCount(),
               [](Random& random)
               {
                   const osgGeoFX::ViewGeometry view = randomView(random);
                   const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
                   for (int i = random.integer(1, 2); i > 0; --i)
                       chain->add(exaggeration(random.logarithmic(0.2, 5.0))->snapshot(view));
                   const Ball ball = {randomGroundPoint(random, view), random.logarithmic(1.0, 1000.0)};
                   const Vec3d place = chain->deform(ball.center);
                   double stretch = 1.0;
                   Ball held = ball;
                   for (const auto& snapshot : chain->snapshots())
                   {
                       const Vec3d next = snapshot->deform(held.center);
                       const Vec3d lifted = snapshot->deform(held.center + view.up * held.radius);
                       const double growth = std::max(1.0, (lifted - next).length() / held.radius);
                       stretch *= growth;
                       held = {next, held.radius * growth};
                   }
                   const double gap = place.length() - ball.radius * stretch;
                   if (gap <= 0.0) return;
                   const double expected = ball.radius + gap / stretch;
                   EXPECT_NEAR(chain->lodDistance(ball, Vec3d()), expected,
                               1e-6 * (place.length() + expected));
               });
}

TEST(DeformationMeasures, NothingOfTheGlobesGroundFoldsBelowABend)
{
    // What lies far off falls away below the reference plane, on the inner side of a bend downwards.
    int deep = 0;
    double sharpest = 0.0;
    forSamples(sampleCount(),
               [&](Random& random)
               {
                   CameraPose pose = randomCommonPose(random);
                   pose.globe = true;
                   pose.lens = CameraPose::PERSPECTIVE;
                   pose.roll = 0.0;
                   pose.height = random.logarithmic(3e3, 2e5);
                   const osg::ref_ptr<osgGeoFX::BirdsEyeView> effect = new osgGeoFX::BirdsEyeView;
                   const auto curve = static_cast<osgGeoFX::PerspectiveBend::Curve>(random.integer(0, 2));
                   EXPECT_TRUE(effect->setCurve(curve));
                   const double horizon = random.uniform(0.3, 0.95);
                   EXPECT_TRUE(effect->setFocusLine(0.0));
                   EXPECT_TRUE(effect->setHorizonLine(horizon));
                   EXPECT_TRUE(effect->setFocusLine(horizon * random.uniform(0.8, 0.99)));
                   EXPECT_TRUE(effect->setContextTilt(random.uniform(0.5, 0.9)));
                   const osgGeoFX::ViewGeometry view = pose.view();
                   const auto snapshot = effect->snapshot(view);
                   BendNumbers bend;
                   if (!snapshot || !bendNumbers(*snapshot, bend)) return;
                   constexpr double radius = 6378137.0;
                   const double along = bend.start + bend.size * random.uniform(0.0, 1.0);
                   if (along > 0.4 * radius) return;
                   const double fall = radius - std::sqrt(radius * radius - along * along);
                   const double lowest = view.ground.minHeight - view.eyeHeight;
                   const Vec3d point = bend.forward * along + bend.normal * (lowest - fall);
                   const double depth = -bend.heightOf(point);
                   if (depth <= 0.0) return;
                   const double bent = depth * std::abs(bendCurvature(bend, curve));
                   sharpest = std::max(sharpest, bent);
                   EXPECT_LT(bent, 1.0) << depth << " m below the plane, zone " << bend.size << " m from "
                                        << bend.start << " m on";
                   deep += bent > 0.5 && fall > 0.5 * depth ? 1 : 0;
               });
    RecordProperty("sharpest", std::to_string(sharpest));
    EXPECT_GT(deep, 0) << "no ground comes near to folding because the globe is round";
}
