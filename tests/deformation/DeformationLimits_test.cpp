// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Where deformations begin and end: limits, smooth camera paths, lines of the picture, folds, numbers that are none.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::BirdsEyeView;
using osgGeoFX::BlendedView;
using osgGeoFX::Deformation;
using osgGeoFX::PedestrianView;
using osgGeoFX::PerspectiveBend;
using osgGeoFX::VerticalExaggeration;

namespace
{

constexpr double pi = 3.14159265358979323846;

/// By how much an effect moves a point.
Vec3d displacement(const Deformation& effect, const osgGeoFX::ViewGeometry& view, const Vec3d& point)
{
    const auto snapshot = effect.snapshot(view);
    return snapshot ? snapshot->deform(point) - point : Vec3d();
}

/// By how much the ray of a line of the picture falls, in the bend's profile.
double depression(const CameraPose& pose, const BendNumbers& bend, double line)
{
    Vec3d origin;
    Vec3d direction;
    pose.view().ray(0.0, 2.0 * line - 1.0, origin, direction);
    return std::atan2(-(direction * bend.normal), direction * bend.forward);
}

/// The pose at a share of the way between two; the lens and the ground stay.
CameraPose between(const CameraPose& from, const CameraPose& to, double share)
{
    const auto mix = [share](double a, double b)
    {
        return a + share * (b - a);
    };
    CameraPose pose = from;
    pose.x = mix(from.x, to.x);
    pose.y = mix(from.y, to.y);
    pose.height = mix(from.height, to.height);
    pose.heading = mix(from.heading, to.heading);
    pose.pitch = mix(from.pitch, to.pitch);
    pose.roll = mix(from.roll, to.roll);
    pose.fieldOfView = mix(from.fieldOfView, to.fieldOfView);
    pose.pictureSize = mix(from.pictureSize, to.pictureSize);
    return pose;
}

/// Another pose on the same ground, up to 10 km away.
CameraPose neighbour(const CameraPose& pose, Random& random)
{
    CameraPose other = randomPose(random);
    const double reach = pose.globe ? 1e4 / 6.4e6 : 1e4;
    other.x = pose.x + random.uniform(-reach, reach);
    other.y = pose.y + random.uniform(-reach, reach);
    return other;
}

/// How a deformation moves a point of the world along a path of cameras.
struct Path
{
    CameraPose from;
    CameraPose to;
    osg::ref_ptr<Deformation> effect;
    Vec3d point;

    Vec3d moved(double share) const
    {
        const CameraPose pose = between(from, to, share);
        const osg::Matrixd modelView = pose.modelView();
        const Vec3d moved = displacement(*effect, pose.view(), point * modelView);
        return osg::Matrixd::transform3x3(moved, osg::Matrixd::inverse(modelView));
    }
    /// What is too little to be seen: a bend below 1e-5 radians is none.
    double tolerance(double share) const
    {
        const CameraPose pose = between(from, to, share);
        double reach = (point * pose.modelView()).length() + std::abs(pose.height) + 1.0;
        const auto snapshot = effect->snapshot(pose.view());
        BendNumbers numbers;
        if (snapshot && bendNumbers(*snapshot, numbers)) reach += std::min(std::abs(numbers.start), 1e7);
        return 2e-5 * reach;
    }
    /// The place of a jump between two places, found by halving where the change is larger; −1 where there is none.
    double jump(double low, double high) const
    {
        Vec3d atLow = moved(low);
        Vec3d atHigh = moved(high);
        while (high - low > 1e-13)
        {
            if ((atHigh - atLow).length() < tolerance(low) + tolerance(high)) return -1.0;
            const double middle = (low + high) / 2.0;
            const Vec3d atMiddle = moved(middle);
            const bool first = (atMiddle - atLow).length() > (atHigh - atMiddle).length();
            (first ? high : low) = middle;
            (first ? atHigh : atLow) = atMiddle;
        }
        return (atHigh - atLow).length() < tolerance(low) + tolerance(high) ? -1.0 : low;
    }
};

/// Drives each kind of effect along random straight paths.
void expectNoJumps(const std::string& kind, int paths)
{
    int failures = 0;
    double steepest = 0.0;
    for (int sample = 0; sample < paths && failures < 3; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        Path path;
        path.from = randomPose(random);
        path.to = neighbour(path.from, random);
        path.effect = randomDeformation(kind, random);
        bringNear(*path.effect, path.from, random);
        for (int place = 0; place < 2; ++place)
        {
            path.point = randomGroundPoint(random, path.from.view(), 1e5) *
                         osg::Matrixd::inverse(path.from.modelView());
            constexpr int steps = 25;
            for (int step = 0; step < steps; ++step)
            {
                const double low = static_cast<double>(step) / steps;
                const double high = (step + 1.0) / steps;
                const double at = path.jump(low, high);
                steepest = std::max(steepest, (path.moved(high) - path.moved(low)).length() * steps);
                if (at < 0.0) continue;
                ++failures;
                ADD_FAILURE() << "sample " << sample << ": jump from " << path.moved(at).length() << " m to "
                              << path.moved(at + 1e-12).length() << " m, by "
                              << (path.moved(at + 1e-12) - path.moved(at)).length() << " m, at " << at
                              << " of\n"
                              << path.from << "\nto " << path.to << "\nthere "
                              << between(path.from, path.to, at) << "\n"
                              << describe(*path.effect);
                break;
            }
        }
    }
    ::testing::Test::RecordProperty("steepest_metres_per_path", std::to_string(steepest));
}

} // namespace

TEST(DeformationPaths, BirdsEyeViewDoesNotJump)
{
    expectNoJumps("birdsEyeView", sampleCount() / 10);
}

TEST(DeformationPaths, PedestrianViewDoesNotJump)
{
    expectNoJumps("pedestrianView", sampleCount() / 10);
}

TEST(DeformationPaths, BlendedViewDoesNotJump)
{
    expectNoJumps("blendedView", sampleCount() / 10);
}

TEST(DeformationPaths, VerticalExaggerationDoesNotDependOnTheCamera)
{
    double worst = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        Path path;
        path.from = randomPose(random);
        path.to = neighbour(path.from, random);
        path.effect = randomDeformation("verticalExaggeration", random);
        path.point =
            randomGroundPoint(random, path.from.view()) * osg::Matrixd::inverse(path.from.modelView());
        const double factor = path.effect->getProperty("factor");
        SCOPED_TRACE(::testing::Message()
                     << sample << ": factor " << factor << ", " << path.from << "; " << path.to);
        // What is left is how well OSG knows the eye's height.
        const double change = (path.moved(0.0) - path.moved(1.0)).length() / std::max(factor, 1.0);
        worst = std::max(worst, change);
        EXPECT_LT(change, 2e-3);
        if (HasFailure()) return;
    }
    RecordProperty("worst_metres_for_factor_1", std::to_string(worst * 1e6) + "e-6");
}

TEST(DeformationLimits, TheBirdsEyeViewFadesTowardsTheNaturalHorizon)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomCommonPose(random);
        const osg::ref_ptr<Deformation> effect = randomDeformation("birdsEyeView", random);
        // The line's ray falls below the horizon by less and less.
        const double line = 2.0 * effect->getProperty("horizonLine") - 1.0;
        pose.lens = CameraPose::PERSPECTIVE;
        const double rise = std::atan(line * std::tan(pose.fieldOfView / 2.0));
        const Vec3d point =
            randomGroundPoint(random, pose.view(), 1e5) * osg::Matrixd::inverse(pose.modelView());
        std::ostringstream text;
        text << sample << ": " << describe(*effect) << "; " << pose;
        SCOPED_TRACE(text.str());
        for (const double fall : {1e-1, 1e-2, 1e-3, 1e-4, 2e-5, 0.5e-5, 0.0, -1e-3})
        {
            pose.pitch = -rise - fall;
            const Vec3d here = point * pose.modelView();
            const double moved = displacement(*effect, pose.view(), here).length();
            // Nothing is farther from the bend's axis than this.
            const double reach = 2.0 * (here.length() + std::abs(pose.height));
            EXPECT_LE(moved, std::max(fall, 0.0) * reach) << fall;
        }
        if (HasFailure()) return;
    }
}

TEST(DeformationLimits, TheBirdsEyeViewFadesTowardsTheReferencePlane)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomCommonPose(random);
        if (pose.lens == CameraPose::ORTHOGRAPHIC) pose.lens = CameraPose::OFF_AXIS;
        // Before low ground the plane sinks.
        pose.lowestGround = std::max(pose.lowestGround, 0.0);
        const osg::ref_ptr<Deformation> effect = randomDeformation("birdsEyeView", random);
        std::string error;
        effect->setProperty("planeReference", PerspectiveBend::GROUND, error);
        const double plane = effect->getProperty("planeHeight");
        const Vec3d point =
            randomGroundPoint(random, pose.view(), 1e5) * osg::Matrixd::inverse(pose.modelView());
        SCOPED_TRACE(::testing::Message() << sample << ": " << describe(*effect));
        for (const double above : {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 0.0, -1.0})
        {
            pose.height = plane + above;
            const Vec3d here = point * pose.modelView();
            const double moved = displacement(*effect, pose.view(), here).length();
            // The curvature is bounded, and the zone's width goes with the height: so does the angle.
            if (above < 0.0)
            {
                EXPECT_EQ(moved, 0.0);
            }
            else if (above <= 1e-4)
            {
                EXPECT_LT(moved, 0.05 * (here.length() + 100.0)) << pose;
            }
        }
        if (HasFailure()) return;
    }
}

// The shore of the Dead Sea is 400 m below the ellipsoid, and many coasts are 100 m below it.
TEST(DeformationLimits, TheBirdsEyeViewBendsOnOverGroundBelowZero)
{
    for (const bool globe : {false, true})
        for (const double lowest : {-100.0, -430.0})
            for (const double plane : {-50.0, 0.0, 5.0})
            {
                SCOPED_TRACE(::testing::Message() << globe << ", " << lowest << ", " << plane);
                const osg::ref_ptr<BirdsEyeView> effect = new BirdsEyeView;
                effect->setPlaneHeight(plane);
                CameraPose pose;
                pose.globe = globe;
                pose.x = 0.6;
                pose.y = 0.5;
                pose.pitch = -0.7;
                pose.lowestGround = lowest;
                pose.highestGround = lowest + 40.0;
                CameraPose aboveZero = pose;
                aboveZero.lowestGround = aboveZero.highestGround = 0.0;
                double former = 0.0, formerHeight = 0.0;
                for (double above = 1000.0; above >= 40.0; above -= 0.5)
                {
                    pose.height = aboveZero.height = lowest + above;
                    const auto placement = effect->placement(pose.view());
                    ASSERT_TRUE(placement) << above << " m above the ground";
                    EXPECT_LT(placement->angle, -0.3) << above;
                    // T is above the lowest ground, and where it is as high as elsewhere, nothing is other than elsewhere.
                    EXPECT_GT(placement->planeHeight, 0.24 * above - std::max(plane, 0.0)) << above;
                    EXPECT_LT(placement->planeHeight, above) << above;
                    if (pose.height > 0.5 * above)
                    {
                        EXPECT_NEAR(placement->planeHeight, pose.height - plane, 1e-6) << above;
                    }
                    // It goes smoothly.
                    if (above < 1000.0)
                    {
                        EXPECT_LT(std::abs(placement->planeHeight - formerHeight), 1.001 * 0.5) << above;
                        EXPECT_LT(std::abs(placement->angle - former), 0.02) << above;
                    }
                    former = placement->angle;
                    formerHeight = placement->planeHeight;
                }
            }
}

TEST(DeformationLimits, PedestrianViewAndExaggerationFadeWithTheirParameters)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        SCOPED_TRACE(sample);
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = randomPose(random);
        const osgGeoFX::ViewGeometry view = pose.view();
        const Vec3d point = randomGroundPoint(random, view);
        const osg::ref_ptr<Deformation> bend = randomDeformation("pedestrianView", random);
        const osg::ref_ptr<Deformation> lift = randomDeformation("verticalExaggeration", random);
        std::string error;
        for (const double share : {1e-2, 1e-4, 1e-6, 0.0})
        {
            ASSERT_TRUE(bend->setProperty("bendAngle", share, error));
            const double reach = 2.0 * (point.length() + std::abs(bend->getProperty("focusDistance")) + 1e4);
            EXPECT_LE(displacement(*bend, view, point).length(), share * reach);
            ASSERT_TRUE(lift->setProperty("factor", 1.0 + share, error));
            EXPECT_LE(displacement(*lift, view, point).length(), share * 4e4);
        }
        if (HasFailure()) return;
    }
}

TEST(DeformationLines, TheContextsHorizonIsAtTheHorizonLine)
{
    int seen = 0;
    double worst = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomCommonPose(random);
        pose.globe = false;
        const bool level = random.integer(0, 1) == 1;
        if (!level) pose.roll = random.uniform(-0.8, 0.8);
        const osg::ref_ptr<Deformation> effect = randomDeformation("birdsEyeView", random);
        std::string error;
        effect->setProperty("tallest", 0.0, error);
        if (pose.lens == CameraPose::ORTHOGRAPHIC) effect->setProperty("contextTilt", 0.0, error);
        std::ostringstream text;
        text << sample << ": " << describe(*effect) << "; " << pose;
        SCOPED_TRACE(text.str());
        const auto snapshot = effect->snapshot(pose.view());
        BendNumbers bend;
        if (!snapshot || !bendNumbers(*snapshot, bend)) continue;
        const auto& view = static_cast<const BirdsEyeView&>(*effect);
        const double curvature = bendCurvature(bend, view.getCurve());
        // Nothing stands on the ground: the bend is whole unless the zone is as narrow as a metre.
        if (std::abs(curvature) > 0.85) continue;
        // Nor where the camera sees the ground as a bend of 90° cannot serve.
        if (depression(pose, bend, view.getHorizonLine()) > pi / 2.0) continue;
        if (depression(pose, bend, view.getFocusLine()) > osg::DegreesToRadians(165.0)) continue;
        // An orthographic camera needs some pitch.
        if (pose.lens == CameraPose::ORTHOGRAPHIC && pose.pitch > -0.06) continue;
        ++seen;
        // A far point of the context's reference plane, moved along the bend's axis to the picture's middle column.
        const auto heightInPicture = [&](double s, double column)
        {
            const osg::Matrixd projection = pose.projection();
            const Vec3d axis = bend.forward ^ bend.normal;
            const osg::Vec4d along = osg::Vec4d(axis, 0.0) * projection;
            const osg::Vec4d place = osg::Vec4d(snapshot->deform(bend.point(s, 0.0, 0.0)), 1.0) * projection;
            const osg::Vec4d moved =
                place - along * ((place.x() - column * place.w()) / (along.x() - column * along.w()));
            return moved.y() / moved.w() / 2.0 + 0.5;
        };
        const double far = (bend.size + std::abs(bend.start) + pose.height) * 1e5;
        const double y = heightInPicture(bend.size + far, 0.0);
        worst = std::max(worst, std::abs(y - view.getHorizonLine()));
        EXPECT_NEAR(y, view.getHorizonLine(), 1e-3);
        // With a level camera, in every column; and where the context is seen from its edge, all of its plane.
        if (level)
        {
            EXPECT_NEAR(heightInPicture(bend.size + far, random.uniform(-1.0, 1.0)), y, 1e-3);
        }
        if (view.getContextTilt() == 0.0)
        {
            EXPECT_NEAR(heightInPicture(bend.size * random.uniform(1.001, 3.0), 0.0), y, 1e-6);
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(seen, sampleCount() / 4);
    RecordProperty("worst_share_of_picture", std::to_string(worst * 1e6) + "e-6");
}

TEST(DeformationLines, TheZoneBeginsAtTheFocusLine)
{
    int seen = 0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = randomPose(random);
        const osg::ref_ptr<Deformation> effect = randomDeformation("birdsEyeView", random);
        SCOPED_TRACE(::testing::Message() << sample << ": " << describe(*effect));
        const osgGeoFX::ViewGeometry view = pose.view();
        const auto snapshot = effect->snapshot(view);
        BendNumbers bend;
        if (!snapshot || !bendNumbers(*snapshot, bend)) continue;
        // Where the ray of the line meets the plane.
        Vec3d origin;
        Vec3d direction;
        view.ray(0.0, 2.0 * effect->getProperty("focusLine") - 1.0, origin, direction);
        const Vec3d point = origin - direction * (bend.heightOf(origin) / (direction * bend.normal));
        EXPECT_NEAR(bend.alongOf(point), 0.0, 1e-9 * (point.length() + origin.length()));
        if (bend.size < 1e-3 * point.length()) continue;
        ++seen;
        EXPECT_EQ(snapshot->style(point - bend.forward * (bend.size * 1e-4)), 0.0);
        EXPECT_GT(snapshot->style(point + bend.forward * (bend.size * 1e-4)), 0.0);
        if (HasFailure()) return;
    }
    EXPECT_GT(seen, sampleCount() / 10);
}

TEST(DeformationFold, CurvatureTimesHeightStaysBelowOne)
{
    double worst = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = randomPose(random);
        const osg::ref_ptr<Deformation> effect = randomDeformation(random);
        bringNear(*effect, pose, random);
        std::ostringstream text;
        text << sample << ": " << describe(*effect) << "; " << pose;
        SCOPED_TRACE(text.str());
        const auto* bending = dynamic_cast<const PerspectiveBend*>(effect.get());
        const auto snapshot = effect->snapshot(pose.view());
        BendNumbers bend;
        if (!bending || !snapshot || !bendNumbers(*snapshot, bend)) continue;
        const double curvature = bendCurvature(bend, bending->getCurve());
        // Who says how tall things are: in the blend, the view whose side it bends to.
        const Deformation* part = effect.get();
        if (const auto* blend = dynamic_cast<const BlendedView*>(bending))
        {
            if (bend.angle > 0.0)
                part = blend->getPedestrianView();
            else
                part = blend->getBirdsEyeView();
        }
        const double tallest = part->getProperty("tallest");
        const double level = pose.view().eyeHeight - bend.height;
        const double inner = bend.angle > 0.0 ? pose.highestGround - level : level - pose.lowestGround;
        const double extent = tallest >= 0.0 ? tallest : inner;
        if (extent <= 0.0) continue;
        worst = std::max(worst, std::abs(curvature) * extent);
        EXPECT_LE(std::abs(curvature) * extent, 0.9 + 1e-9)
            << "curvature " << curvature << ", extent " << extent;
        // And nothing up to there folds.
        const Vec3d point = bend.point(random.uniform(0.0, 1.0) * bend.size,
                                       bend.angle > 0.0 ? extent : -extent, random.uniform(-1e4, 1e4));
        EXPECT_EQ(snapshot->complaint({point, {Vec3d(), Vec3d(), Vec3d()}}), "");
        if (HasFailure()) return;
    }
    RecordProperty("largest_curvature_times_height", std::to_string(worst));
}

TEST(DeformationInput, WhatIsNotFiniteMakesNoFrameThatIsNotFinite)
{
    const double infinity = std::numeric_limits<double>::infinity();
    const double wrong[] = {std::nan(""), infinity, -infinity, 1e300, -1e300, 0.0};
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = randomPose(random);
        const osg::ref_ptr<Deformation> effect = randomDeformation(random);
        bringNear(*effect, pose, random);
        SCOPED_TRACE(::testing::Message() << sample << ": " << describe(*effect));
        osg::Matrixd modelView = pose.modelView();
        osg::Matrixd projection = pose.projection();
        osgGeoFX::Ground ground = pose.ground();
        for (int count = random.integer(1, 3); count > 0; --count)
        {
            const double value = wrong[random.integer(0, 5)];
            switch (random.integer(0, 3))
            {
            case 0:
                modelView(random.integer(0, 3), random.integer(0, 3)) = value;
                break;
            case 1:
                projection(random.integer(0, 3), random.integer(0, 3)) = value;
                break;
            case 2:
                (random.integer(0, 1) ? ground.minHeight : ground.maxHeight) = value;
                break;
            default: // the Earth's middle, or everything 0
                modelView = osg::Matrixd::scale(random.integer(0, 1), 1.0, 1.0);
                break;
            }
        }
        const auto snapshot = effect->snapshot(osgGeoFX::ViewGeometry(modelView, projection, ground));
        if (!snapshot) continue;
        for (const auto& [name, value] : snapshot->uniforms())
        {
            for (int i = 0; i < 4; ++i)
                EXPECT_TRUE(std::isfinite(static_cast<float>(value[i]))) << name << " " << value[i];
        }
        if (HasFailure()) return;
    }
}
