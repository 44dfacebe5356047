// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How many triangles a paged terrain draws, over how few would show it within the same pixel error: from random places, on
// terrains of different kinds. The least number is that of a network made for each view alone (LeastTriangles).
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/paging/Scene.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/GlFixture.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 1089, HEIGHT = 690;
constexpr double FIELD_OF_VIEW = 40.0;

/// Mountains whose relief is alike at all sizes: by halving, with ever smaller chance.
std::vector<double> mountains(int side, double width, std::uint64_t seed)
{
    Random random(seed);
    std::vector<double> heights(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    const auto at = [&](int column, int row) -> double&
    {
        return heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
                       static_cast<std::size_t>(column)];
    };
    double swing = 0.12 * width;
    for (int step = side - 1; step > 1; step /= 2, swing *= 0.47)
    {
        const int half = step / 2;
        const auto mean = [&](int column, int row, int dc, int dr)
        {
            double sum = 0.0;
            int count = 0;
            for (int turn = 0; turn < 4; ++turn)
            {
                const int c = column + dc, r = row + dr;
                if (c >= 0 && r >= 0 && c < side && r < side) sum += at(c, r), ++count;
                const int former = dc;
                dc = -dr;
                dr = former;
            }
            return sum / count + random.uniform(-0.5, 0.5) * swing;
        };
        for (int row = half; row < side; row += step)
            for (int column = half; column < side; column += step)
                at(column, row) = mean(column, row, half, half);
        for (int row = 0; row < side; row += half)
            for (int column = (row / half) % 2 ? 0 : half; column < side; column += step)
                at(column, row) = mean(column, row, half, 0);
    }
    return heights;
}

struct Shares
{
    std::vector<double> sorted;
    double median() const { return sorted[sorted.size() / 2]; }
    double worst() const { return sorted.back(); }
};

/// Of views with enough triangles to be worth a thought.
Shares sharesOf(const std::string& database, int views,
                const std::function<double(double x, double y)>& height)
{
    Shares result;
    std::string error;
    const std::optional<Scene> scene = Scene::load(database + "/terrain.osgb", error);
    if (!scene || !scene->terrain)
    {
        ADD_FAILURE() << error;
        return result;
    }
    SceneRenderer::Options options;
    options.width = WIDTH;
    options.height = HEIGHT;
    options.fieldOfView = FIELD_OF_VIEW;
    options.countTriangles = options.leastTriangles = true;
    const std::unique_ptr<SceneRenderer> renderer = SceneRenderer::create(*scene, options, error);
    if (!renderer)
    {
        ADD_FAILURE() << error;
        return result;
    }
    const TerrainInfo& info = *scene->terrain;
    Random random(11);
    constexpr std::uint64_t few = 2000;
    for (int tries = 0; static_cast<int>(result.sorted.size()) < views && tries < 5 * views; ++tries)
    {
        const double x = random.uniform(info.west, info.east), y = random.uniform(info.south, info.north);
        const osg::Vec3d eye(x, y, std::max(0.0, height(x, y)) + random.logarithmic(100.0, 30000.0));
        const double heading = random.uniform(0.0, 2.0 * osg::PI);
        const double pitch = osg::DegreesToRadians(random.uniform(-60.0, 5.0));
        const osg::Vec3d forward(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                                 std::sin(pitch));
        FrameStatistics statistics;
        const osg::ref_ptr<osg::Image> picture = renderer->render(
            osg::Matrixd::lookAt(eye, eye + forward, osg::Vec3d(0.0, 0.0, 1.0)), 0.0, statistics, error);
        EXPECT_TRUE(picture) << error;
        if (statistics.leastTriangles < few) continue;
        result.sorted.push_back(static_cast<double>(statistics.triangles) /
                                static_cast<double>(statistics.leastTriangles));
    }
    std::sort(result.sorted.begin(), result.sorted.end());
    return result;
}

class DrawnTriangles : public GlFixture
{
protected:
    static int views() { return fullTest() ? 100 : 8; }

    void check(const BuildOptions& options, double most,
               const std::function<double(double x, double y)>& height)
    {
        const Shares shares = sharesOf(options.output, views(), height);
        ASSERT_GE(shares.sorted.size(), static_cast<std::size_t>(views() / 2));
        RecordProperty("median", std::to_string(shares.median()));
        RecordProperty("worst", std::to_string(shares.worst()));
        std::cout << "drawn over least: median " << shares.median() << ", worst " << shares.worst() << " of "
                  << shares.sorted.size() << " views\n";
        EXPECT_LE(shares.median(), most);
    }

    static BuildOptions options(const std::string& dem, const std::string& output)
    {
        BuildOptions result;
        result.dems = {dem};
        result.epsg = 32604;
        result.output = output;
        result.pixelsPerRadian = 0.5 * HEIGHT / std::tan(osg::DegreesToRadians(0.5 * FIELD_OF_VIEW));
        return result;
    }

    TempDir folder;
};

TEST_F(DrawnTriangles, OfMountainsAreNotManyMoreThanTheLeast)
{
    const int side = fullTest() ? 4097 : 1025;
    constexpr double post = 30.0;
    const std::vector<double> heights = mountains(side, post * side, 5);
    const auto at = [&](int column, int row)
    {
        return heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
                       static_cast<std::size_t>(column)];
    };
    const BuildOptions built = options(TestRaster(side, side)
                                           .placed(500000.0, 2400000.0, post, post)
                                           .crs("EPSG:32604")
                                           .fill([&](int column, int row, int) { return at(column, row); })
                                           .write(folder / "dem.tif"),
                                       folder / "db");
    buildDatabase(built);
    // Twice is what is asked, and the full test demands it; these rough mountains are not there yet. What the short one demands
    // keeps them from getting worse.
    check(built, fullTest() ? 2.0 : 3.0,
          [&](double x, double y)
          {
              const auto place = [&](double metres)
              {
                  return std::clamp(static_cast<int>(metres / post), 0, side - 1);
              };
              return at(place(x - 500000.0), place(2400000.0 - y));
          });
}

TEST_F(DrawnTriangles, OfAnIslandAreHardlyMoreThanTwiceTheLeast)
{
    const BuildOptions built = options(GEOFX_SOURCE_DIR "/data/oahu/elevation.tif", folder / "db");
    buildDatabase(built);
    // Never below its highest mountain.
    check(built, 2.0, [](double, double) { return 1200.0; });
}

} // namespace
