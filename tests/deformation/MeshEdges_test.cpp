// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How long edges may be that are made before a camera is known: random cameras of the range look at random edges of that length, and
// how far their images are from straight lines is measured.
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/MeshRefiner.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::CameraRange;
using osgGeoFX::Deformation;
using osgGeoFX::DeformationChain;
using osgGeoFX::EffectScene;
using osgGeoFX::MeshRefiner;

namespace
{

/// The place in the world so far (metres) and in that direction from the camera's foot, at a height.
Vec3d placeOf(const CameraPose& pose, double distance, double azimuth, double height)
{
    const double east = distance * std::sin(azimuth), north = distance * std::cos(azimuth);
    if (!pose.globe) return {pose.x + east, pose.y + north, height};
    Vec3d place;
    const double radius = 6.378e6;
    osg::EllipsoidModel().convertLatLongHeightToXYZ(pose.y + north / radius,
                                                    pose.x + east / radius / std::cos(pose.y), height,
                                                    place.x(), place.y(), place.z());
    return place;
}

struct Error
{
    bool seen = false;
    double share = 0.0; ///< of the distance from the eye
};

/// How far the image of an edge of eye space is from the straight line between the images of its ends, across the surface. Along it
/// the ground's colors move, and neither outline nor depth. `beside`: along the ground, across the edge.
Error errorOf(const DeformationChain& chain, const osg::Matrixd& projection, const Vec3d& from,
              const Vec3d& to, const Vec3d& beside)
{
    const Vec3d start = chain.deform(from);
    Vec3d along = chain.deform(to) - start;
    along.normalize();
    Error error;
    for (int step = 1; step < 8; ++step)
    {
        const Vec3d image = chain.deform(from + (to - from) * (step / 8.0));
        const Vec3d picture = image * projection;
        if (!(std::abs(picture.x()) <= 1.0 && std::abs(picture.y()) <= 1.0 && image.z() < 0.0)) continue;
        Vec3d off = image - start;
        const Vec3d middle = from + (to - from) * (step / 8.0);
        Vec3d normal = along ^ (chain.deform(middle + beside) - chain.deform(middle - beside));
        normal.normalize();
        off = normal * (off * normal);
        error.seen = true;
        error.share = std::max(error.share, off.length() / image.length());
    }
    return error;
}

/// A map's view radius, metres.
double radiusOf(const osgGeoFX::PanoramaMap& map, const CameraPose& pose)
{
    const double base =
        std::max(map.getBaseHeight(), map.getBaseFromTerrain() ? pose.lowestGround : -HUGE_VAL);
    return map.getViewRadius() > 0.0 ? map.getViewRadius()
                                     : std::max(pose.height - base, 1.0) / pose.projection()(0, 0);
}

/// How far a scene's panorama map shows ground as it lies, metres from the eye's foot: behind that it gathers all ground in one point of
/// the horizon.
double farthestShown(const EffectScene& scene, const CameraPose& pose)
{
    const auto* map = dynamic_cast<const osgGeoFX::PanoramaMap*>(scene.getEffect(0));
    if (!map) return HUGE_VAL;
    const double angle = map->getHorizontalAngle();
    return radiusOf(*map, pose) * (1.25 * map->getHorizonDistance() + (angle > 0.0 ? 2.0 / angle : 0.0));
}

/// Ground nearer to the eye's foot than this is not drawn by a scene's panorama map, metres.
double nearestShown(const EffectScene& scene, const CameraPose& pose)
{
    const auto* map = dynamic_cast<const osgGeoFX::PanoramaMap*>(scene.getEffect(0));
    if (!map || map->getHorizontalAngle() == 0.0 || !map->getProjection()) return 0.0;
    return 0.3 * 2.0 * radiusOf(*map, pose) / map->getHorizontalAngle();
}

/// Whether an end is farther from the reference plane than where bends are thought to be used.
bool folds(const DeformationChain& chain, Vec3d from, Vec3d to)
{
    for (const auto& snapshot : chain.snapshots())
    {
        BendNumbers bend;
        if (bendNumbers(*snapshot, bend))
        {
            // Of a circle's arc; parabolas are up to twice as sharp.
            const double curvature = 2.0 * std::abs(std::tan(bend.angle / 2.0)) / bend.size;
            for (const Vec3d& end : {from, to})
                if (std::abs(bend.heightOf(end)) * curvature > 0.3) return true;
        }
        from = snapshot->deform(from);
        to = snapshot->deform(to);
    }
    return false;
}

/// A camera that a range holds, at most so much higher than it must be.
CameraPose poseFor(Random& random)
{
    CameraPose pose = randomCommonPose(random);
    pose.lens = CameraPose::PERSPECTIVE;
    pose.roll = std::clamp(pose.roll, -1.0, 1.0);
    pose.lowestGround = random.uniform(-200.0, 0.0);
    pose.highestGround = random.integer(0, 1) == 1 ? 0.0 : random.logarithmic(1.0, 3000.0);
    pose.height = pose.highestGround + random.logarithmic(100.0, 5e4);
    if (std::abs(pose.y) > 1.3) pose.y = 0.5;
    return pose;
}

struct Tally
{
    int seen = 0;
    double worst = 0.0; ///< of the tolerance
};

/// Looks at random edges of a scene. Those nearer than the range says are passed over.
void measure(const EffectScene& scene, const CameraPose& pose, Random& random, Tally& tally)
{
    constexpr double tolerance = 1e-3;
    CameraRange range;
    range.ground = pose.ground();
    range.projection = pose.projection();
    range.distance = pose.height - pose.highestGround;
    const double longest = MeshRefiner::longestEdge(scene, range, tolerance);
    ASSERT_GT(longest, 0.0);
    const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
    osgGeoFX::ViewGeometry view = pose.view();
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        const Deformation* deformation = scene.getEffect(i)->asDeformation();
        const auto snapshot = deformation->snapshot(view);
        if (snapshot) chain->add(snapshot);
        if (snapshot) deformation->changeGround(view.ground);
    }
    if (chain->empty()) return;
    const double length = std::min(longest, 1e5);
    const double farthest = farthestShown(scene, pose), nearest = nearestShown(scene, pose);
    for (int i = 0; i < 60; ++i)
    {
        const double low = pose.lowestGround, high = pose.highestGround;
        const double away = pose.height * random.logarithmic(0.05, 30.0), heading = random.uniform(-1.0, 1.0);
        if (away + length > farthest || away - length < nearest) continue;
        const double turn = random.uniform(-3.2, 3.2);
        const double x = away * std::sin(pose.heading + heading) + length * std::sin(turn);
        const double y = away * std::cos(pose.heading + heading) + length * std::cos(turn);
        const double height = random.uniform(low, high), climb = 0.2 * length * random.uniform(-1.0, 1.0);
        const Vec3d from = placeOf(pose, away, pose.heading + heading, height);
        Vec3d edge =
            placeOf(pose, std::hypot(x, y), std::atan2(x, y), std::clamp(height + climb, low, high)) - from;
        edge *= length / edge.length();
        const Vec3d start = from * pose.modelView(), end = (from + edge) * pose.modelView();
        if (chain->deform((start + end) * 0.5).length() < range.distance || folds(*chain, start, end))
            continue;
        Vec3d beside = (end - start) ^ pose.view().up;
        beside.normalize();
        const Error error = errorOf(*chain, pose.projection(), start, end, beside);
        if (!error.seen) continue;
        ++tally.seen;
        tally.worst = std::max(tally.worst, error.share / tolerance);
        EXPECT_LE(error.share, tolerance) << pose << "\n" << length << " m, " << away << " m away";
        if (::testing::Test::HasFailure()) return;
    }
}

} // namespace

TEST(MeshEdges, AreShortEnoughForEveryCameraOfTheRange)
{
    for (const std::string& kind : deformationKinds())
    {
        SCOPED_TRACE(kind);
        Tally tally;
        const int count = fullTest() ? 20000 : 8000;
        for (int sample = 0; sample < count; ++sample)
        {
            SCOPED_TRACE("sample " + std::to_string(sample));
            Random random(static_cast<std::uint64_t>(sample));
            const osg::ref_ptr<Deformation> effect = randomDeformation(kind, random);
            effect->setEnabled(true);
            const osg::ref_ptr<EffectScene> scene = new EffectScene;
            scene->addEffect(effect);
            const CameraPose pose = poseFor(random);
            bringNear(*effect, pose, random);
            measure(*scene, pose, random, tally);
            if (HasFailure())
            {
                ADD_FAILURE() << describe(*effect);
                return;
            }
        }
        EXPECT_GT(tally.seen, count / 2);
        EXPECT_GT(tally.worst, 0.1) << "edges would be much shorter than they need be";
        RecordProperty(kind, std::to_string(tally.worst));
    }
}

TEST(MeshEdges, AreShortEnoughForSeveralDeformationsTogether)
{
    Tally tally;
    const int count = fullTest() ? 10000 : 1000;
    for (int sample = 0; sample < count; ++sample)
    {
        SCOPED_TRACE("sample " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(randomDeformation("verticalExaggeration", random));
        scene->addEffect(
            randomDeformation(random.integer(0, 1) == 1 ? "birdsEyeView" : "pedestrianView", random));
        for (unsigned int i = 0; i < 2; ++i)
            scene->getEffect(i)->setEnabled(true);
        measure(*scene, poseFor(random), random, tally);
        if (HasFailure()) return;
    }
    EXPECT_GT(tally.seen, count / 2);
}
