// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Real summits compare in a panorama map: their heights above the sea's level in the picture stand in the ratio of their heights,
// from wherever they are seen. Found in the picture by picking. Oahu's, and those of Fuji and Ashitaka, the paper's own example: cones
// of their heights in their places, and the mountains themselves where GEOFX_FUJI is the path of a database of theirs (README, Panorama
// maps).
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 1600, HEIGHT = 900;
constexpr double FIELD_OF_VIEW = 30.0; // degrees
constexpr double EARTH = 6.37e6;       // metres
/// How far from the summit's place ground counts as the summit, metres.
constexpr double SUMMIT_RADIUS = 500.0;

struct Summit
{
    const char* name;
    double longitude, latitude; // degrees
    double height;              // metres, in the DEM
};

struct Pair
{
    Summit high, low;
    double viewHeight; // metres; tells how much is shown
    double exaggeration;
};

// The highest posts of their surroundings in data/oahu/elevation.tif, and in SRTM's 90 m.
const Pair OAHU = {
    {"Kaala", -158.142361, 21.507639, 1224.4}, {"Konahuanui", -157.788472, 21.357639, 929.4}, 90000.0, 6.0};
const Pair FUJI = {
    {"Fuji", 138.7275, 35.360833, 3742.0}, {"Ashitaka", 138.794167, 35.238333, 1489.0}, 60000.0, 2.0};

class PanoramaSummits : public GlFixture
{
protected:
    /// The height of a summit above its foot at height 0, pixels; nothing where another mountain hides it.
    static std::optional<double> shown(const Summit& summit, const DeformedView& picture,
                                       const Georeference& reference)
    {
        const double longitude = osg::DegreesToRadians(summit.longitude);
        const double latitude = osg::DegreesToRadians(summit.latitude);
        osg::Vec2d foot, top;
        EXPECT_TRUE(picture.project(longitude, latitude, 0.0, reference, foot));
        EXPECT_TRUE(picture.project(longitude, latitude, summit.height, reference, top));
        for (double y = top.y() + 8.0; y > top.y() - 12.0; y -= 0.125)
        {
            double east = 0.0, north = 0.0, height = 0.0;
            if (!picture.unproject(top.x(), y, reference, east, north, height)) continue;
            if (EARTH * std::hypot((east - longitude) * std::cos(latitude), north - latitude) < SUMMIT_RADIUS)
                return y - foot.y();
        }
        return std::nullopt;
    }

    static void compare(const Scene& scene, const Pair& pair)
    {
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setExaggeration(pair.exaggeration);
        map->setHorizonDistance(4.0);
        map->setPaint(false);
        map->setSky(false);
        scene.effects->addEffect(map);
        SceneRenderer::Options options;
        options.width = WIDTH;
        options.height = HEIGHT;
        options.fieldOfView = FIELD_OF_VIEW;
        std::string error;
        const std::unique_ptr<SceneRenderer> renderer = SceneRenderer::create(scene, options, error);
        ASSERT_TRUE(renderer) << error;
        const double middleX = osg::DegreesToRadians((pair.high.longitude + pair.low.longitude) / 2.0);
        const double middleY = osg::DegreesToRadians((pair.high.latitude + pair.low.latitude) / 2.0);
        const double field = osg::DegreesToRadians(FIELD_OF_VIEW);
        const osg::Matrixd projection =
            osg::Matrixd::perspective(FIELD_OF_VIEW, static_cast<double>(WIDTH) / HEIGHT, 100.0, 1e6);
        double worst = 0.0;
        int measured = 0;
        for (const double heading : {-7.0, 40.0, 100.0, 160.0, 200.0, -100.0})
        {
            SCOPED_TRACE(heading);
            ViewPoint point;
            point.heading = osg::DegreesToRadians(heading);
            const double back = 0.7 * pair.viewHeight / EARTH;
            point.longitude = middleX - back * std::sin(point.heading) / std::cos(middleY);
            point.latitude = middleY - back * std::cos(point.heading);
            point.height = pair.viewHeight;
            point.pitch = osg::DegreesToRadians(-40.0);
            osg::Matrixd view;
            ASSERT_TRUE(point.viewMatrix(*scene.reference, view));
            FrameStatistics statistics;
            ASSERT_TRUE(renderer->render(view, 0.0, statistics, error)) << error;
            const DeformedView picture(
                *scene.effects, view, projection, WIDTH, HEIGHT,
                static_cast<double>(lodScaleFor(*scene.terrain, pixelsPerRadian(HEIGHT, field))));
            const std::optional<double> high = shown(pair.high, picture, *scene.reference);
            const std::optional<double> low = shown(pair.low, picture, *scene.reference);
            if (!high || !low) continue;
            ++measured;
            const double off = *low / *high / (pair.low.height / pair.high.height) - 1.0;
            EXPECT_LT(std::abs(off), 0.02) << *high << " and " << *low << " pixels";
            worst = std::max(worst, std::abs(off));
        }
        std::cout << pair.high.name << " and " << pair.low.name << ": ratio off by " << 100.0 * worst
                  << " % at most, seen from " << measured << " sides\n";
        EXPECT_GE(measured, 4);
    }
};

} // namespace

TEST_F(PanoramaSummits, OfOahuCompare)
{
    const std::optional<Scene> oahu = loadOahu("oahu");
    if (oahu) compare(*oahu, OAHU);
}

TEST_F(PanoramaSummits, FujiAndAshitakaCompare)
{
    // Samples 3" apart, as SRTM has them, with one on each summit.
    constexpr double sample = 1.0 / 1200.0;
    constexpr double west = 138.5, north = 35.6;
    constexpr int columns = 600, rows = 600;
    const TempDir folder;
    const auto cone = [](const Summit& summit, double longitude, double latitude, double steepness)
    {
        const double east = osg::DegreesToRadians(longitude - summit.longitude) *
                            std::cos(osg::DegreesToRadians(summit.latitude));
        const double away = EARTH * std::hypot(east, osg::DegreesToRadians(latitude - summit.latitude));
        return summit.height - steepness * away;
    };
    TestRaster dem(columns, rows);
    dem.placed(west - 0.5 * sample, north + 0.5 * sample, sample, sample).crs("EPSG:4326");
    dem.fill(
        [&](int column, int row, int)
        {
            const double longitude = west + column * sample, latitude = north - row * sample;
            return std::max(
                {0.0, cone(FUJI.high, longitude, latitude, 0.35), cone(FUJI.low, longitude, latitude, 0.3)});
        });
    BuildOptions options;
    options.dems = {dem.write(folder / "cones.tif")};
    options.output = (folder / "cones").string();
    std::string error;
    const std::optional<Scene> cones = Scene::load(buildDatabase(options).file, error);
    ASSERT_TRUE(cones) << error;
    compare(*cones, FUJI);
    if (const char* real = std::getenv("GEOFX_FUJI"))
    {
        const std::optional<Scene> fuji = Scene::load(real, error);
        ASSERT_TRUE(fuji) << error;
        compare(*fuji, FUJI);
    }
}
