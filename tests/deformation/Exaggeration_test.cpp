// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Vertical exaggeration against GeographicLib's ellipsoid, and what floats lose of it.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomViews.h>

#include <GeographicLib/Geocentric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace glslf = osgGeoFX::glslf;
using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::DeformationSnapshot;
using osgGeoFX::VerticalExaggeration;

namespace
{

struct Place
{
    double latitude = 0.0; ///< degrees
    double longitude = 0.0;
    double height = 0.0;
};

Place placeOf(const Vec3d& point)
{
    Place place;
    GeographicLib::Geocentric::WGS84().Reverse(point.x(), point.y(), point.z(), place.latitude,
                                               place.longitude, place.height);
    return place;
}

Vec3d pointOf(const Place& place)
{
    Vec3d point;
    GeographicLib::Geocentric::WGS84().Forward(place.latitude, place.longitude, place.height, point.x(),
                                               point.y(), point.z());
    return point;
}

/// What the exaggeration makes of a place on the globe, against what it should.
struct Errors
{
    double lift = 0.0;     ///< how far it should go, metres
    double height = 0.0;   ///< metres
    double sideways = 0.0; ///< metres
};

Errors errorsAt(const VerticalExaggeration& effect, const CameraPose& pose, const Place& place)
{
    const osg::Matrixd modelView = pose.modelView();
    const auto snapshot = effect.snapshot(pose.view());
    const Vec3d moved = snapshot->deform(pointOf(place) * modelView) * osg::Matrixd::inverse(modelView);
    Place expected = place;
    expected.height = effect.getBaseHeight() + effect.getFactor() * (place.height - effect.getBaseHeight());
    Place found = placeOf(moved);
    Errors errors;
    errors.lift = std::abs(expected.height - place.height);
    errors.height = std::abs(found.height - expected.height);
    // Beside the vertical, all that is left of the way to the right place.
    found.height = expected.height;
    errors.sideways = (pointOf(found) - pointOf(expected)).length();
    return errors;
}

/// A place up to `reach` metres from the camera.
Place randomPlace(const CameraPose& pose, double reach, Random& random)
{
    const double distance = random.logarithmic(1.0, reach);
    const double turn = random.uniform(-3.14159, 3.14159);
    const osg::Matrixd toWorld = osg::Matrixd::inverse(pose.modelView());
    const osgGeoFX::ViewGeometry view = pose.view();
    Vec3d across = view.up ^ Vec3d(0.3, 0.5, 0.81);
    across.normalize();
    const Vec3d along = across * std::cos(turn) + (view.up ^ across) * std::sin(turn);
    Place place = placeOf((along * distance - view.up * pose.height) * toWorld);
    place.height = random.uniform(-400.0, 9000.0);
    return place;
}

CameraPose globePose(Random& random)
{
    CameraPose pose = randomPose(random);
    while (!pose.globe)
        pose = randomPose(random);
    return pose;
}

osg::ref_ptr<VerticalExaggeration> exaggeration(double factor, double base)
{
    osg::ref_ptr<VerticalExaggeration> effect = new VerticalExaggeration;
    EXPECT_TRUE(effect->setFactor(factor));
    EXPECT_TRUE(effect->setBaseHeight(base));
    return effect;
}

} // namespace

TEST(Exaggeration, IsNothingForAFactorOfOne)
{
    Random random(0);
    EXPECT_FALSE(exaggeration(1.0, 100.0)->snapshot(globePose(random).view()));
}

TEST(Exaggeration, IsExactOnAProjectedTerrain)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        SCOPED_TRACE(sample);
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomPose(random);
        pose.globe = false;
        const double factor = random.logarithmic(0.01, 100.0);
        const double base = random.uniform(-1000.0, 1000.0);
        const auto effect = exaggeration(factor, base);
        const auto snapshot = effect->snapshot(pose.view());
        const osg::Matrixd modelView = pose.modelView();
        const Vec3d point(pose.x + random.uniform(-3e5, 3e5), pose.y + random.uniform(-3e5, 3e5),
                          random.uniform(-400.0, 9000.0));
        const Vec3d moved = snapshot->deform(point * modelView) * osg::Matrixd::inverse(modelView);
        const Vec3d expected(point.x(), point.y(), base + factor * (point.z() - base));
        EXPECT_LT((moved - expected).length(), 1e-7 * std::max(1.0, factor));
        if (HasFailure()) return;
    }
}

TEST(Exaggeration, MovesPlacesOnTheGlobeAlongTheirVerticals)
{
    // The function's own errors: its height's, below a millimetre on the highest mountain, and that its vertical at
    // 9 km leans by 5e-6 from the one on the ellipsoid.
    double height = 0.0;
    double sideways = 0.0;
    double twice = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = globePose(random);
        const double factor = random.logarithmic(0.1, 10.0);
        const auto effect =
            exaggeration(factor, random.integer(0, 1) ? 0.0 : random.uniform(-1000.0, 1000.0));
        const Place place = randomPlace(pose, 3e5, random);
        SCOPED_TRACE(::testing::Message() << sample << ": factor " << factor << ", " << place.latitude << ", "
                                          << place.longitude << ", " << place.height << "; " << pose);
        const Errors errors = errorsAt(*effect, pose, place);
        const double change = std::abs(factor - 1.0);
        height = std::max(height, errors.height / change);
        sideways = std::max(sideways, errors.sideways / (errors.lift + 1.0));
        EXPECT_LT(errors.height, 1e-3 * change + 1e-10 * errors.lift * errors.lift);
        EXPECT_LT(errors.sideways, 6e-6 * errors.lift + 1e-3);
        const Errors plain = errorsAt(*exaggeration(2.0, 0.0), pose, place);
        twice = std::max(twice, plain.height);
        EXPECT_LT(plain.height, 1e-3);
        EXPECT_LT(plain.sideways, 0.05);
        if (HasFailure()) return;
    }
    RecordProperty("worst_height_metres_for_factor_2", std::to_string(twice));
    RecordProperty("worst_height_metres_for_change_of_1", std::to_string(height));
    RecordProperty("worst_sideways_share_of_lift", std::to_string(sideways * 1e6) + "e-6");
}

TEST(Exaggeration, HoldsForTheWholeGlobe)
{
    double worst = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = globePose(random);
        pose.height = random.logarithmic(1e5, 4e7);
        const Place place = {random.uniform(-90.0, 90.0), random.uniform(-180.0, 180.0),
                             random.uniform(-400.0, 9000.0)};
        const auto effect = exaggeration(random.logarithmic(0.1, 100.0), 0.0);
        SCOPED_TRACE(::testing::Message() << sample << ": factor " << effect->getFactor() << ", "
                                          << place.latitude << ", " << place.longitude << "; " << pose);
        const Errors errors = errorsAt(*effect, pose, place);
        const double distance = (pointOf(place) * pose.modelView()).length();
        const double error = (errors.height + errors.sideways) / distance;
        worst = std::max(worst, error);
        EXPECT_LT(error, 1e-5);
        if (HasFailure()) return;
    }
    RecordProperty("worst_share_of_distance", std::to_string(worst * 1e6) + "e-6");
}

TEST(Exaggeration, LosesLittleInFloats)
{
    double worst = 0.0;
    double worstHeight = 0.0;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = randomPose(random);
        const auto effect = exaggeration(random.logarithmic(0.1, 10.0), random.uniform(-1000.0, 1000.0));
        const osgGeoFX::ViewGeometry view = pose.view();
        const auto snapshot = effect->snapshot(view);
        std::map<std::string, osg::Vec4f> uniforms;
        for (const auto& [name, value] : snapshot->uniforms())
            uniforms[name] = osg::Vec4f(value);
        const osg::Vec4f up = uniforms["up"];
        const osg::Vec4f axis = uniforms["axis"];
        const osg::Vec4f scale = uniforms["scale"];
        const glslf::geofx_Exaggeration given = {{up.x(), up.y(), up.z()},
                                                 {axis.x(), axis.y(), axis.z()},
                                                 up.w(),
                                                 scale.x(),
                                                 axis.w(),
                                                 scale.y(),
                                                 scale.z(),
                                                 scale.w()};
        const Vec3d ground = randomGroundPoint(random, view);
        const glm::vec3 point(ground.x(), ground.y(), ground.z());
        const glm::vec3 found = glslf::geofx_exaggerate(given, point);
        const Vec3d rounded(static_cast<double>(point.x), static_cast<double>(point.y),
                            static_cast<double>(point.z));
        const Vec3d expected = snapshot->deform(rounded);
        const Vec3d error =
            Vec3d(static_cast<double>(found.x), static_cast<double>(found.y), static_cast<double>(found.z)) -
            expected;
        SCOPED_TRACE(::testing::Message()
                     << sample << ": factor " << effect->getFactor() << ", base " << effect->getBaseHeight()
                     << ", distance " << rounded.length() << "; " << pose);
        const double distance = std::max(rounded.length(), expected.length());
        worst = std::max(worst, error.length() / distance);
        worstHeight = std::max(worstHeight, std::abs(error * view.up));
        EXPECT_LT(error.length(), 1e-5 * distance);
        if (HasFailure()) return;
    }
    RecordProperty("worst_share_of_distance", std::to_string(worst * 1e6) + "e-6");
    RecordProperty("worst_metres_of_height", std::to_string(worstHeight));
}

TEST(Exaggeration, HullsHoldBoxesOfEverySizeOnAGlobe)
{
    osgGeoFX::Hull hull;
    std::vector<double> excess;
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomCommonPose(random);
        pose.globe = true;
        const osg::ref_ptr<VerticalExaggeration> effect = new VerticalExaggeration;
        effect->setFactor(random.logarithmic(0.05, 50.0));
        effect->setBaseHeight(random.uniform(-5000.0, 5000.0));
        const osgGeoFX::ViewGeometry view = pose.view();
        const auto snapshot = effect->snapshot(view);
        ASSERT_TRUE(snapshot);
        // A tile within 60° of arc, which may stand as the ground does there or lean.
        osgGeoFX::EyeBox box;
        const Vec3d middle = view.up * (-view.eyeHeight - 6.37e6);
        Vec3d up = view.up + randomDirection(random) * random.uniform(0.0, 0.8);
        up.normalize();
        // The parts of a large tile's box lie deep in the Earth, too.
        const bool lies = random.uniform(0.0, 1.0) < 0.7;
        box.center = middle + up * (lies ? 6.37e6 + random.logarithmic(1.0, 2e6) - 5000.0
                                         : random.uniform(0.2, 1.0) * 6.37e6);
        const bool leans = random.uniform(0.0, 1.0) < 0.3;
        const Vec3d axis = leans ? randomDirection(random) : up;
        Vec3d east = axis ^ randomDirection(random);
        east.normalize();
        const double size = random.logarithmic(10.0, 2.5e6);
        box.half[0] = east * size;
        box.half[1] = (axis ^ east) * (size * random.uniform(0.2, 1.0));
        box.half[2] = axis * (size * (leans ? random.uniform(0.0, 1.0) : 0.02));
        snapshot->boundBox(box, hull, 0.02);
        SCOPED_TRACE(::testing::Message() << sample << ": factor " << effect->getFactor() << ", size " << size
                                          << ", margin " << hull.margin << "; " << pose);
        std::vector<Vec3d> deformed;
        for (int i = 0; i < 60; ++i)
        {
            Vec3d point = box.center;
            for (const Vec3d& half : box.half)
                point += half * (i < 20 ? std::round(random.uniform(-1.5, 1.5)) : random.uniform(-1.0, 1.0));
            deformed.push_back(snapshot->deform(point));
        }
        const double rounding = 1e-9 * (box.center.length() + view.eyeHeight + 6.4e6);
        for (int i = 0; i < 20; ++i)
        {
            const Vec3d direction = i < 2 ? up * (i ? 1.0 : -1.0) : randomDirection(random);
            double most = -HUGE_VAL, least = HUGE_VAL, needed = -HUGE_VAL, from = HUGE_VAL;
            for (const Vec3d& point : hull.points)
            {
                most = std::max(most, point * direction);
                least = std::min(least, point * direction);
            }
            for (const Vec3d& point : deformed)
            {
                needed = std::max(needed, point * direction);
                from = std::min(from, point * direction);
            }
            EXPECT_LE(needed, most + hull.margin + rounding);
            if (!leans && lies && size < 1e5)
                excess.push_back((most - least + 2.0 * hull.margin) / (needed - from));
        }
        // Culling makes many.
        if (size < 1e5 && lies)
        {
            EXPECT_LE(hull.points.size(), 16u);
        }
        if (HasFailure()) return;
    }
    std::sort(excess.begin(), excess.end());
    RecordProperty("median_excess", std::to_string(excess[excess.size() / 2]));
    RecordProperty("excess_of_95_percent", std::to_string(excess[excess.size() * 95 / 100]));
    EXPECT_LT(excess[excess.size() / 2], 1.02);
    EXPECT_LT(excess[excess.size() * 95 / 100], 1.2);
}

// What another deformation has thrown deep below the ground: verticals meet there, and derivatives bound nothing.
TEST(Exaggeration, BoundsHoldDeepInTheEarth)
{
    osgGeoFX::Hull hull;
    for (int sample = 0; sample < 2000; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomCommonPose(random);
        pose.globe = true;
        const osg::ref_ptr<VerticalExaggeration> effect = new VerticalExaggeration;
        effect->setFactor(random.logarithmic(1.5, 80.0));
        const osgGeoFX::ViewGeometry view = pose.view();
        const auto snapshot = effect->snapshot(view);
        ASSERT_TRUE(snapshot);
        SCOPED_TRACE(::testing::Message() << sample << ": factor " << effect->getFactor() << "; " << pose);
        osgGeoFX::EyeBox box;
        const double depth = random.uniform(0.05, 1.3) * 6.4e6;
        box.center =
            view.up * (-view.eyeHeight - depth) + randomDirection(random) * random.logarithmic(1e3, 2e6);
        const double size = random.logarithmic(1e3, 2e6);
        const Vec3d east = randomDirection(random);
        Vec3d north = east ^ randomDirection(random);
        north.normalize();
        box.half[0] = east * size;
        box.half[1] = north * (size * random.uniform(0.1, 1.0));
        box.half[2] = (east ^ north) * (size * random.uniform(0.1, 1.0));
        const osgGeoFX::Ball ball = box.ball(), bound = snapshot->bound(ball);
        const double grows = snapshot->lipschitz(ball);
        snapshot->boundBox(box, hull, 0.02);
        for (int i = 0; i < 20; ++i)
        {
            Vec3d point = box.center;
            for (const Vec3d& half : box.half)
                point += half * random.uniform(-1.0, 1.0);
            const Vec3d deformed = snapshot->deform(point);
            EXPECT_LE((deformed - bound.center).length(), bound.radius * (1.0 + 1e-9));
            const Vec3d beside = point + randomDirection(random) * (1e-3 * size);
            EXPECT_LE((snapshot->deform(beside) - deformed).length(),
                      grows * 1e-3 * size * (1.0 + 1e-6) + 1e-6);
            const Vec3d direction = randomDirection(random);
            double most = -HUGE_VAL;
            for (const Vec3d& corner : hull.points)
                most = std::max(most, corner * direction);
            EXPECT_LE(deformed * direction, most + hull.margin * (1.0 + 1e-9) + 1e-3);
        }
        if (::testing::Test::HasFailure()) return;
    }
}
