// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What culling trusts: nothing that deformations make of a ball or a box lies outside of its bound.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::Ball;
using osgGeoFX::DeformationChain;
using osgGeoFX::DeformationSnapshot;
using osgGeoFX::EyeBox;
using osgGeoFX::Hull;

namespace
{

/// Up to three deformations before one camera.
struct Case
{
    CameraPose pose;
    osgGeoFX::ViewGeometry view;
    osg::ref_ptr<DeformationChain> chain;
    std::string text;
};

Case randomCase(Random& random, int most)
{
    for (;;)
    {
        const CameraPose pose = randomPose(random);
        Case found{pose, pose.view(), new DeformationChain, {}};
        std::ostringstream text;
        for (int i = random.integer(1, most); i > 0; --i)
        {
            const auto effect = randomDeformation(random);
            bringNear(*effect, pose, random);
            const auto snapshot = effect->snapshot(found.view);
            if (!snapshot) continue;
            found.chain->add(snapshot);
            text << describe(*effect) << "; ";
            BendNumbers bend;
            if (bendNumbers(*snapshot, bend))
                text << "start " << bend.start << ", size " << bend.size << ", angle " << bend.angle << "; ";
        }
        if (found.chain->empty()) continue;
        text << pose;
        found.text = text.str();
        return found;
    }
}

Vec3d randomPointIn(const Ball& ball, Random& random)
{
    // Most often on its surface, where bounds fail first.
    const double share = random.integer(0, 2) ? 1.0 : std::cbrt(random.uniform(0.0, 1.0));
    return ball.center + randomDirection(random) * (ball.radius * share);
}

/// Of any size, most often across or near the first frame's zone.
Ball randomBall(const Case& found, Random& random)
{
    return {randomPointFor(*found.chain->snapshots()[0], found.view, random), random.logarithmic(0.1, 1e5)};
}

/// A tile most often: wide, flat and level; else any box in any orientation.
EyeBox randomBox(const Case& found, Random& random)
{
    EyeBox box;
    box.center = randomPointFor(*found.chain->snapshots()[0], found.view, random);
    const double size = random.logarithmic(1.0, 3e4);
    const bool tile = random.integer(0, 3) != 0;
    Vec3d up = tile ? found.view.up : randomDirection(random);
    if (tile && found.view.ground.ellipsoid)
    {
        // A tile lies level where it is, not where the eye is.
        up = up + (box.center + up * found.view.eyeHeight) / 6.37e6;
        up.normalize();
    }
    Vec3d east = up ^ randomDirection(random);
    east.normalize();
    box.half[0] = east * size;
    box.half[1] = (up ^ east) * (size * random.uniform(0.3, 1.0));
    box.half[2] =
        up * (tile ? std::min(random.uniform(0.0, 0.3) * size, 2000.0) : size * random.uniform(0.0, 1.0));
    return box;
}

Vec3d randomPointIn(const EyeBox& box, Random& random)
{
    Vec3d point = box.center;
    for (const Vec3d& half : box.half)
    {
        // Corners, edges and faces more often than the inside.
        const double any = random.uniform(-1.0, 1.0);
        point += half * (random.integer(0, 1) ? any : random.sign());
    }
    return point;
}

/// How far a set of points reaches in a direction.
double support(const std::vector<Vec3d>& points, const Vec3d& direction)
{
    double most = -HUGE_VAL;
    for (const Vec3d& point : points)
        most = std::max(most, point * direction);
    return most;
}

double scaleOf(const Case& found, const Vec3d& point)
{
    return point.length() + found.chain->deform(point).length() + std::abs(found.view.eyeHeight) + 1e6;
}

template<class Check>
void forRandomCases(int samples, int most, const Check& check)
{
    for (int sample = 0; sample < samples; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const Case found = randomCase(random, most);
        SCOPED_TRACE(std::to_string(sample) + ": " + found.text);
        check(found, random);
        if (::testing::Test::HasFailure()) return;
    }
}

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

void expectBallsHold(int most)
{
    forRandomCases(sampleCount(), most,
                   [](const Case& found, Random& random)
                   {
                       const Ball ball = randomBall(found, random);
                       const Ball bound = found.chain->bound(ball);
                       for (int i = 0; i < 10; ++i)
                       {
                           const Vec3d point = randomPointIn(ball, random);
                           EXPECT_LE((found.chain->deform(point) - bound.center).length(),
                                     bound.radius * (1.0 + 1e-9) + 1e-12 * scaleOf(found, point))
                               << "radius " << ball.radius;
                       }
                   });
}

void expectBoxesHold(int most)
{
    Hull hull;
    forRandomCases(sampleCount(), most,
                   [&](const Case& found, Random& random)
                   {
                       const EyeBox box = randomBox(found, random);
                       found.chain->bound(box, hull);
                       std::vector<Vec3d> deformed;
                       for (int i = 0; i < 30; ++i)
                           deformed.push_back(found.chain->deform(randomPointIn(box, random)));
                       // Where derivatives bound nothing, a hull is no wider than a ball.
                       const Ball ball = box.ball();
                       if (found.chain->snapshots().size() == 1)
                       {
                           EXPECT_LE(hull.margin,
                                     std::max(ball.radius, found.chain->bound(ball).radius) * (1.0 + 1e-9));
                       }
                       const double allowed = hull.margin * (1.0 + 1e-9) + 1e-12 * scaleOf(found, box.center);
                       for (int i = 0; i < 20; ++i)
                       {
                           // Any direction, and the box's own, in which it is thin.
                           Vec3d direction = randomDirection(random);
                           if (i < 6) direction = box.half[i / 2] * (i % 2 ? 1.0 : -1.0);
                           if (direction.normalize() == 0.0) continue;
                           EXPECT_LE(support(deformed, direction), support(hull.points, direction) + allowed)
                               << "size " << box.half[0].length() << ", margin " << hull.margin;
                       }
                   });
}

} // namespace

TEST(DeformationBounds, BallsHoldWhatOneDeformationMakesOfThem)
{
    expectBallsHold(1);
}

TEST(DeformationBounds, BallsHoldWhatAChainMakesOfThem)
{
    expectBallsHold(3);
}

TEST(DeformationBounds, VerticalMovementsAreNoLonger)
{
    int stays = 0, moves = 0;
    forRandomCases(sampleCount(), 2,
                   [&](const Case& found, Random& random)
                   {
                       const Ball ball = randomBall(found, random);
                       const osg::Matrixd toWorld = osg::Matrixd::inverse(found.view.modelView);
                       std::vector<Vec3d> points;
                       double lowest = HUGE_VAL, highest = -HUGE_VAL;
                       for (int i = 0; i < 10; ++i)
                       {
                           points.push_back(randomPointIn(ball, random));
                           const Vec3d world = points.back() * toWorld;
                           double latitude = 0.0, longitude = 0.0, height = world.z();
                           if (found.view.ground.ellipsoid)
                               found.view.ground.ellipsoid->convertXYZToLatLongHeight(
                                   world.x(), world.y(), world.z(), latitude, longitude, height);
                           lowest = std::min(lowest, height);
                           highest = std::max(highest, height);
                       }
                       if (!found.chain->movesVertically(ball)) return;
                       const double movement = found.chain->verticalMovement(lowest, highest);
                       ++(movement > 0.0 ? moves : stays);
                       for (const Vec3d& point : points)
                           EXPECT_LE((found.chain->deform(point) - point).length(),
                                     movement * (1.0 + 1e-6) + 1e-12 * scaleOf(found, point))
                               << "radius " << ball.radius << ", from " << lowest << " to " << highest;
                   });
    EXPECT_GT(stays, sampleCount() / 50);
    EXPECT_GT(moves, sampleCount() / 50);
}

TEST(DeformationBounds, HullsHoldWhatOneDeformationMakesOfABox)
{
    expectBoxesHold(1);
}

TEST(DeformationBounds, HullsHoldWhatAChainMakesOfABox)
{
    expectBoxesHold(3);
}

TEST(DeformationBounds, ReachIsWhatItSays)
{
    int counts[3] = {};
    forRandomCases(
        sampleCount(), 1,
        [&](const Case& found, Random& random)
        {
            const DeformationSnapshot& snapshot = *found.chain->snapshots()[0];
            const Ball ball = randomBall(found, random);
            const DeformationSnapshot::Reach reach = snapshot.reach(ball);
            ++counts[static_cast<int>(reach)];
            const Vec3d a = randomPointIn(ball, random);
            const Vec3d b = randomPointIn(ball, random);
            const Vec3d middle = (a + b) * 0.5;
            if (reach == DeformationSnapshot::Reach::Identity)
            {
                EXPECT_EQ(snapshot.deform(a), a);
                EXPECT_TRUE(found.chain->leavesAlone(ball));
                EXPECT_EQ(snapshot.lipschitz(ball), 1.0);
            }
            else if (reach == DeformationSnapshot::Reach::Affine)
            {
                const double error =
                    (snapshot.deform(middle) - (snapshot.deform(a) + snapshot.deform(b)) * 0.5).length();
                EXPECT_LT(error, 1e-9 * scaleOf(found, a));
            }
            else
            {
                EXPECT_FALSE(found.chain->leavesAlone(ball));
            }
        });
    for (const int count : counts)
        EXPECT_GT(count, sampleCount() / 50);
}

TEST(DeformationBounds, NoPairOfPointsDriftsApartByMoreThanLipschitzSays)
{
    forRandomCases(sampleCount(), 1,
                   [](const Case& found, Random& random)
                   {
                       const DeformationSnapshot& snapshot = *found.chain->snapshots()[0];
                       const Ball ball = randomBall(found, random);
                       const double factor = snapshot.lipschitz(ball);
                       const Vec3d a = randomPointIn(ball, random);
                       const Vec3d b = a + (randomPointIn(ball, random) - a) * random.logarithmic(1e-3, 1.0);
                       EXPECT_LE((snapshot.deform(b) - snapshot.deform(a)).length(),
                                 factor * (b - a).length() * (1.0 + 1e-9) + 1e-12 * scaleOf(found, a));
                   });
}

TEST(DeformationBounds, PartsOfAnEdgeMissTheCurveByNoMoreThanTheSagSays)
{
    int curved = 0, tight = 0, outside = 0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = randomPose(random);
        const char* const kinds[] = {"birdsEyeView", "pedestrianView", "blendedView"};
        const auto effect = randomDeformation(kinds[sample % 3], random);
        auto& bend = dynamic_cast<osgGeoFX::PerspectiveBend&>(*effect);
        bend.setTessellation(true);
        bend.meetContext(4.5f);
        const auto snapshot = bend.snapshot(pose.view());
        if (!snapshot) continue;
        SCOPED_TRACE(std::to_string(sample) + ": " + describe(bend));
        const auto& divider = dynamic_cast<const osgGeoFX::TessellatedSnapshot&>(*snapshot);
        const Case found{pose, pose.view(), new DeformationChain, {}};
        const Vec3d a = randomPointFor(*snapshot, found.view, random);
        const Vec3d b = random.integer(0, 1) ? randomPointFor(*snapshot, found.view, random)
                                             : a + randomDirection(random) * random.logarithmic(1.0, 1e5);
        const osg::Vec2d sag = divider.edgeSag(a, b);
        EXPECT_EQ(sag, divider.edgeSag(b, a)) << "neighbours have their edges in other directions";
        const double parts = random.integer(1, 64);
        const double allowed = sag.x() / (parts * parts) + sag.y() / parts;
        double worst = 0.0;
        const auto at = [&](double share)
        {
            return snapshot->deform(a + (b - a) * share);
        };
        for (int i = 0; i < 20; ++i)
        {
            const double part = std::floor(random.uniform(0.0, parts)), within = random.uniform(0.0, 1.0);
            const Vec3d chord = at(part / parts) * (1.0 - within) + at((part + 1.0) / parts) * within;
            worst = std::max(worst, (at((part + within) / parts) - chord).length());
        }
        const double rounding = 1e-9 * (a.length() + b.length() + std::abs(found.view.eyeHeight) + 1e6);
        EXPECT_LE(worst, allowed * (1.0 + 1e-6) + rounding) << parts << " parts";
        curved += worst > rounding ? 1 : 0;
        tight += worst > 0.2 * allowed && worst > rounding ? 1 : 0;
        // A drawable of which nothing is divided has no such edge.
        EyeBox box;
        box.center = (a + b) * 0.5;
        for (int axis = 0; axis < 3; ++axis)
            box.half[axis][axis] = 0.5 * std::abs((b - a)[axis]);
        if (!divider.divides(box))
        {
            ++outside;
            EXPECT_EQ(sag, osg::Vec2d());
        }
    }
    EXPECT_GT(curved, sampleCount() / 20);
    EXPECT_GT(tight, curved / 50) << "the bound is not far from the truth";
    EXPECT_GT(outside, sampleCount() / 50);
}

TEST(DeformationBounds, NothingIsDividedWithoutOpenGL4)
{
    const osg::ref_ptr<osgGeoFX::BirdsEyeView> view = new osgGeoFX::BirdsEyeView;
    osgGeoFX::BirdsEyeView& bend = *view;
    EXPECT_FALSE(bend.tessellates());
    bend.meetContext(4.5f);
    EXPECT_FALSE(bend.tessellates()) << "it is off by default";
    bend.setTessellation(true);
    EXPECT_TRUE(bend.tessellates());
    bend.meetContext(0.0f);
    EXPECT_TRUE(bend.tessellates());
    bend.meetContext(3.3f);
    bend.meetContext(4.5f);
    EXPECT_FALSE(bend.tessellates()) << "one of the contexts cannot";
    const osg::ref_ptr<osgGeoFX::BirdsEyeView> other = new osgGeoFX::BirdsEyeView;
    other->setTessellation(true);
    EXPECT_FALSE(other->tessellates()) << "before it has been drawn nobody knows";
}

TEST(DeformationBounds, TheLevelOfDetailFollowsTheDeformedDistance)
{
    forRandomCases(sampleCount(), 2,
                   [](const Case& found, Random& random)
                   {
                       const Ball ball = randomBall(found, random);
                       const Vec3d eye = randomDirection(random) * random.logarithmic(0.1, 1000.0);
                       const osg::ref_ptr<DeformationChain> none = new DeformationChain;
                       EXPECT_EQ(none->lodDistance(ball, eye), (ball.center - eye).length());
                       EXPECT_EQ(none->detail(ball), 1.0);
                       const double distance = found.chain->lodDistance(ball, eye);
                       EXPECT_TRUE(std::isfinite(distance));
                       EXPECT_GE(distance, 0.0);
                       if (found.chain->leavesAlone(ball))
                       {
                           EXPECT_EQ(distance, (ball.center - eye).length());
                       }
                       const bool told = std::any_of(
                           found.chain->snapshots().begin(), found.chain->snapshots().end(),
                           [&](const auto& snapshot) { return snapshot->viewDistance(ball).has_value(); });
                       if (told)
                       {
                           EXPECT_GT(distance, ball.radius);
                           return;
                       }
                       // Outside of the deformed ball, what lies between is divided by the detail.
                       const Ball bound = found.chain->bound(ball);
                       const double gap = (bound.center - eye).length() - bound.radius;
                       if (gap > 0.0 && (found.chain->detail(ball) != 1.0 || bound.radius != ball.radius))
                       {
                           EXPECT_NEAR(distance, ball.radius + gap / found.chain->detail(ball),
                                       1e-9 * (distance + bound.center.length()));
                       }
                   });
}

TEST(DeformationBounds, HullsAreTight)
{
    // Tiles as a terrain has them, and the bound's extent over that of what is in it, in random directions.
    std::vector<double> ratios;
    std::vector<double> curved;
    std::vector<double> ofLiberties; // whose bounds are those of their whole regions
    Hull hull;
    forRandomCases(sampleCount() / 2, 1,
                   [&](const Case& found, Random& random)
                   {
                       EyeBox box = randomBox(found, random);
                       const DeformationSnapshot::Reach reach =
                           found.chain->snapshots()[0]->reach(box.ball());
                       if (reach == DeformationSnapshot::Reach::Identity) return;
                       // A panorama map hides what its hulls would be wide for: tiles beside and behind its picture.
                       if (dynamic_cast<const osgGeoFX::PanoramaSnapshot*>(found.chain->snapshots()[0].get()))
                           return;
                       found.chain->bound(box, hull);
                       std::vector<Vec3d> deformed;
                       for (int i = 0; i < 500; ++i)
                           deformed.push_back(found.chain->deform(randomPointIn(box, random)));
                       for (int i = 0; i < 5; ++i)
                       {
                           const Vec3d direction = randomDirection(random);
                           const double given = support(hull.points, direction) +
                                                support(hull.points, -direction) + 2.0 * hull.margin;
                           const double needed = support(deformed, direction) + support(deformed, -direction);
                           const double ratio = given / needed;
                           if (found.text.find("regionalLiberty") != std::string::npos)
                           {
                               ofLiberties.push_back(ratio);
                               continue;
                           }
                           ratios.push_back(ratio);
                           if (reach == DeformationSnapshot::Reach::Curved) curved.push_back(ratio);
                       }
                   });
    ASSERT_GT(curved.size(), 100u);
    std::sort(curved.begin(), curved.end());
    RecordProperty("median", std::to_string(median(ratios)));
    RecordProperty("median_in_the_zone", std::to_string(median(curved)));
    RecordProperty("95_percent_in_the_zone", std::to_string(curved[curved.size() * 95 / 100]));
    EXPECT_LT(median(ratios), 1.01);
    EXPECT_LT(median(curved), 1.02);
    EXPECT_LT(curved[curved.size() * 95 / 100], 1.2);
    ASSERT_GT(ofLiberties.size(), 100u);
    std::sort(ofLiberties.begin(), ofLiberties.end());
    RecordProperty("median_of_liberties", std::to_string(median(ofLiberties)));
    EXPECT_LT(median(ofLiberties), 1.5);
}
