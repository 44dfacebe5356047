// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Panorama maps that show much of the Earth, beyond 90 degrees of arc from the eye, where the ground falls away behind the planet:
// what culling trusts holds there, too. And where a terrain's edge lies in the picture, by geodesics of a library.
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/PanoramaEdge.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <osgGeoFX/panorama/detail/PanoramaTextures.h>
#include <tools/RandomViews.h>
#include <tools/StrokeTiles.h>

#include <GeographicLib/Geodesic.hpp>
#include <gtest/gtest.h>
#include <osg/ValueObject>

#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;
using osg::Vec3d;

namespace
{

constexpr double EARTH = 6.371e6;

/// A map of up to all of the Earth, seen from any height.
struct Case
{
    CameraPose pose;
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    osg::ref_ptr<const PanoramaSnapshot> frame;

    explicit Case(Random& random)
    {
        do
        {
            pose = randomCommonPose(random);
            pose.globe = true;
            pose.x = random.uniform(-osg::PI, osg::PI);
            pose.y = random.uniform(-1.5, 1.5);
            pose.height = random.logarithmic(1e3, 2e7);
            pose.roll = 0.0;
            map->setCurveDistance(0.0);
            map->setHorizonDistance(random.uniform(0.5, 40.0));
            map->setCurveDistance(random.uniform(0.0, 0.9) * map->getHorizonDistance());
            map->setViewRadius(random.logarithmic(2e5, 2e6));
            map->setExaggeration(random.logarithmic(0.2, 20.0));
            map->setHorizonExaggeration(random.integer(0, 1) ? -1.0 : random.logarithmic(0.2, 20.0));
            map->setCurvePoints(random.integer(0, 1) ? randomCurve(random) : std::vector<osg::Vec2d>());
            frame = dynamic_cast<const PanoramaSnapshot*>(map->snapshot(pose.view()).get());
        } while (!frame);
    }

    /// On the ground or some kilometres above it, most often about 90 degrees from the eye.
    Vec3d ground(Random& random) const
    {
        const ViewGeometry view = pose.view();
        const double arc = random.integer(0, 2) ? random.uniform(1.2, 2.0) : random.uniform(0.0, 3.1);
        const double way = random.uniform(-osg::PI, osg::PI);
        const Vec3d right = toOsg(frame->view().right), forward = toOsg(frame->view().forward);
        const Vec3d center = view.up * (-view.eyeHeight - EARTH);
        const Vec3d direction =
            view.up * std::cos(arc) + (right * std::cos(way) + forward * std::sin(way)) * std::sin(arc);
        return center + direction * (EARTH + random.uniform(-15000.0, 9000.0));
    }
};

template<class Check>
void forRandom(const Check& check)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const Case found(random);
        SCOPED_TRACE(::testing::Message() << sample << ": " << describe(*found.map) << "; " << found.pose);
        check(found, random);
        if (::testing::Test::HasFailure()) return;
    }
}

} // namespace

namespace
{

void expectBallsHold(const Case& found, Random& random)
{
    const Ball ball = {found.ground(random), random.logarithmic(1e2, 3e6)};
    const double grows = found.frame->lipschitz(ball);
    for (int i = 0; i < 30; ++i)
    {
        const Vec3d a = ball.center + randomDirection(random) * (ball.radius * random.uniform(0.5, 1.0));
        const Vec3d b =
            random.integer(0, 1) ? ball.center : a + randomDirection(random) * (1e-3 * ball.radius);
        if ((b - ball.center).length() > ball.radius) continue;
        const double apart = (found.frame->deform(a) - found.frame->deform(b)).length();
        EXPECT_LE(apart, grows * (a - b).length() * (1.0 + 1e-6) + 1e-2)
            << "radius " << ball.radius << ", apart " << (a - b).length() << ", grows by "
            << apart / (a - b).length() << " instead of " << grows;
    }
}

} // namespace

TEST(PanoramaGlobe, BallsHoldWhatLiesBeyondAQuarterOfTheEarth)
{
    forRandom(expectBallsHold);
}

TEST(PanoramaGlobe, HullsHoldWhatLiesBeyondAQuarterOfTheEarth)
{
    Hull hull;
    forRandom(
        [&](const Case& found, Random& random)
        {
            EyeBox box;
            box.center = found.ground(random);
            Vec3d up = box.center - found.pose.view().up * (-found.pose.view().eyeHeight - EARTH);
            up.normalize();
            Vec3d east = up ^ randomDirection(random);
            east.normalize();
            const double size = random.logarithmic(1e3, 2e6);
            box.half[0] = east * size;
            box.half[1] = (up ^ east) * (size * random.uniform(0.3, 1.0));
            // As a tile's box: over the bulge of the ground, too.
            box.half[2] = up * (random.uniform(100.0, 9000.0) + size * size / (2.0 * EARTH));
            found.frame->boundBox(box, hull, 1.0);
            for (int i = 0; i < 40; ++i)
            {
                Vec3d point = box.center;
                for (const Vec3d& half : box.half)
                    point += half * (random.integer(0, 1) ? random.uniform(-1.0, 1.0) : random.sign());
                const Vec3d deformed = found.frame->deform(point);
                for (int k = 0; k < 6; ++k)
                {
                    const Vec3d direction = randomDirection(random);
                    double most = -HUGE_VAL;
                    for (const Vec3d& corner : hull.points)
                        most = std::max(most, corner * direction);
                    EXPECT_LE(deformed * direction, most + hull.margin * (1.0 + 1e-6) + 1e-2)
                        << "size " << size << ", margin " << hull.margin;
                }
            }
        });
}

TEST(PanoramaGlobe, NothingIsHiddenThatThePictureShows)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            const Ball ball = {found.ground(random), random.logarithmic(1e2, 3e6)};
            if (!found.frame->hides(ball, {0.0, 0.0})) return;
            for (int i = 0; i < 20; ++i)
            {
                const Vec3d point =
                    ball.center + randomDirection(random) * (ball.radius * random.uniform(0.0, 1.0));
                const glm::dvec3 place = glsl::geofx_panoramaPlace(found.frame->view(), toGlm(point));
                const glm::dvec3 picture = glsl::geofx_panoramaPicture(found.frame->view(), place);
                // Beyond 60 degrees of arc, ground is no part of the picture, wherever the projection puts it.
                const glsl::geofx_Exaggeration& globe = found.frame->view().globe;
                const glm::dvec3 away = toGlm(point) + (globe.height + 1.0 / globe.curvature) * globe.up;
                constexpr double promised = 0.5; // its cosine
                if (glm::dot(away, globe.up) < promised * glm::length(away)) continue;
                // All that lies beyond the end is one point on the horizon.
                if (place.y > 2.0 * found.frame->view().end - found.frame->view().horizon) continue;
                EXPECT_FALSE(std::abs(picture.x) < 1.0 && std::abs(picture.y) < 1.0)
                    << "radius " << ball.radius;
            }
        });
}

namespace
{

/// The root of a database that tells of its extent, degrees or metres, above a coarsest tile of plain land.
osg::ref_ptr<osg::CoordinateSystemNode> rootOf(bool globe, double west, double south, double east,
                                               double north)
{
    StrokeTiles tiles;
    if (globe) tiles.ellipsoid = new osg::EllipsoidModel;
    tiles.skirt = 0.0;
    tiles.cover = [](double, double)
    {
        return glsl::geofx_Cover{0.0, 0.0, 0.0, -1000.0};
    };
    const double unit = globe ? osg::DegreesToRadians(1.0) : 1.0;
    const osg::ref_ptr<osg::MatrixTransform> tile =
        tiles.tile(west * unit, south * unit, east * unit, north * unit);
    tile->setName("tile 0/0/0");
    tile->setUserValue("geofx.boxMin", Vec3d());
    tile->setUserValue("geofx.boxMax", Vec3d(1.0, 1.0, 1.0));
    const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
    if (globe) root->setEllipsoidModel(tiles.ellipsoid);
    root->setName("osgGeoFX terrain");
    root->setUserValue("geofx.format", osgGeoFX::TerrainInfo::newestFormat);
    root->setUserValue("geofx.kind", std::string(globe ? "geocentric" : "projected"));
    root->setUserValue("geofx.west", west);
    root->setUserValue("geofx.south", south);
    root->setUserValue("geofx.east", east);
    root->setUserValue("geofx.north", north);
    for (const char* name : {"geofx.minHeight", "geofx.maxHeight"})
        root->setUserValue(name, 100.0);
    for (const char* name : {"geofx.pixelsPerRadian", "geofx.pixelError"})
        root->setUserValue(name, 1.0);
    root->setUserValue("geofx.levels", 1);
    root->setUserValue("geofx.vertical", std::string("none"));
    root->addChild(tile);
    return root;
}

} // namespace

TEST(PanoramaGlobe, ATerrainsEdgeLiesWhereItsLongitudesAndLatitudesAre)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    PanoramaTextures textures;
    double worst = 0.0;
    for (int sample = 0; sample < 12; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomCommonPose(random);
        pose.globe = true;
        pose.x = random.uniform(-osg::PI, osg::PI);
        pose.y = random.uniform(-1.2, 1.2);
        pose.height = random.uniform(2000.0, 90000.0);
        pose.pitch = -0.6;
        pose.roll = 0.0;
        const double size = random.logarithmic(0.01, 3.0); // degrees
        const double west = osg::RadiansToDegrees(pose.x) + random.uniform(-1.0, 0.0) * size;
        const double south = osg::RadiansToDegrees(pose.y) + random.uniform(-1.0, 0.0) * size;
        const osg::ref_ptr<osg::CoordinateSystemNode> root =
            rootOf(true, west, south, west + size, south + size);
        Ground ground = pose.ground();
        ground.terrain = root.get();
        const ViewGeometry view(pose.modelView(), pose.projection(), ground);
        const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(*map, view);
        ASSERT_TRUE(panorama);
        const PanoramaEdge edge(*map, textures, view, pose.modelView(), *panorama);
        ASSERT_EQ(edge.kind.w(), 1.0) << "the land's edge is not drawn";
        for (int i = 0; i < 20; ++i)
        {
            const double way = random.logarithmic(10.0, 4e5), azimuth = random.uniform(-180.0, 180.0);
            double latitude = 0.0, longitude = 0.0;
            GeographicLib::Geodesic::WGS84().Direct(osg::RadiansToDegrees(pose.y),
                                                    osg::RadiansToDegrees(pose.x), azimuth, way, latitude,
                                                    longitude);
            const double turned = osg::DegreesToRadians(azimuth) - pose.heading;
            const glm::dvec2 at =
                glsl::geofx_edgePlace(edge.frame(), {way * std::sin(turned), way * std::cos(turned)});
            const double inner = EdgeMap::inner();
            const double east = std::remainder(longitude - west - 0.5 * size, 360.0) / size;
            const double north = (latitude - south) / size - 0.5;
            const double perDegree = osg::DegreesToRadians(1.0) * EARTH;
            const double off = std::hypot(((at.x - 0.5) / inner - east) * size * perDegree * std::cos(pose.y),
                                          ((at.y - 0.5) / inner - north) * size * perDegree);
            worst = std::max(worst, off / way);
            EXPECT_LT(off, 1e-3 * way + 0.01) << sample << ": " << way << " m";
        }
    }
    std::cout << "off by " << 1000.0 * worst << " m a kilometre at most\n";
}

TEST(PanoramaGlobe, OnAPlaneATerrainsEdgeLiesWhereItsMetresAre)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    PanoramaTextures textures;
    for (int sample = 0; sample < 6; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        CameraPose pose = randomCommonPose(random);
        pose.globe = false;
        pose.x = 600000.0 + random.uniform(-2e4, 2e4);
        pose.y = 2400000.0 + random.uniform(-2e4, 2e4);
        pose.pitch = -0.6;
        pose.roll = 0.0;
        const osg::ref_ptr<osg::CoordinateSystemNode> root =
            rootOf(false, 590000.0, 2380000.0, 630000.0, 2410000.0);
        Ground ground = pose.ground();
        ground.terrain = root.get();
        const ViewGeometry view(pose.modelView(), pose.projection(), ground);
        const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(*map, view);
        ASSERT_TRUE(panorama);
        const PanoramaEdge edge(*map, textures, view, pose.modelView(), *panorama);
        const double x = random.uniform(-3e4, 3e4), s = random.uniform(-3e4, 3e4);
        const double east = pose.x + x * std::cos(pose.heading) + s * std::sin(pose.heading);
        const double north = pose.y - x * std::sin(pose.heading) + s * std::cos(pose.heading);
        const glm::dvec2 at = glsl::geofx_edgePlace(edge.frame(), {x, s});
        EXPECT_NEAR((at.x - 0.5) / EdgeMap::inner() + 0.5, (east - 590000.0) / 40000.0, 1e-6);
        EXPECT_NEAR((at.y - 0.5) / EdgeMap::inner() + 0.5, (north - 2380000.0) / 30000.0, 1e-6);
    }
}

// A ball of half the Earth's radius has places deep below others: their feet lie farther apart than they do.
TEST(PanoramaGlobe, BallsHoldWhatLiesDeepInThem)
{
    forRandom(
        [](const Case& found, Random& random)
        {
            // Heights count for little, so that widths tell.
            found.map->setExaggeration(0.2);
            found.map->setHorizonExaggeration(-1.0);
            const ViewGeometry view = found.pose.view();
            const osg::ref_ptr<const DeformationSnapshot> frame = found.map->snapshot(view);
            ASSERT_TRUE(frame);
            const Vec3d right = toOsg(found.frame->view().right),
                        forward = toOsg(found.frame->view().forward);
            const Ball ball = {view.up * -view.eyeHeight + forward * random.uniform(0.0, 5e5),
                               random.uniform(2e6, 3.2e6)};
            const double grows = frame->lipschitz(ball);
            const Vec3d deep = ball.center - view.up * (0.95 * ball.radius);
            const Vec3d aside = deep + right * (0.01 * ball.radius);
            EXPECT_LE((frame->deform(deep) - frame->deform(aside)).length(),
                      grows * (deep - aside).length() * (1.0 + 1e-6));
        });
}
