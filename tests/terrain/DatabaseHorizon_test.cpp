// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Tiles of a whole Earth know their horizon (osg::ClusterCullingCallback). What they leave out is behind the ground, and all
// that is far beyond the horizon is left out.
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseReader.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osg/ClusterCullingCallback>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr double EQUATOR = 6378137.0;

struct World
{
    double south = -90.0, north = 90.0, east = 180.0;
    bool hole = false;
};

/// From the deepest trench to the highest mountain.
std::string dem(const std::filesystem::path& file, const World& world)
{
    constexpr double pixel = 3.0, missing = -32768.0;
    TestRaster raster(static_cast<int>((world.east + 180.0) / pixel),
                      static_cast<int>((world.north - world.south) / pixel));
    raster.placed(-180.0, world.north, pixel, pixel).crs("EPSG:4326");
    raster.dataset().GetRasterBand(1)->SetNoDataValue(missing);
    return raster
        .fill(
            [&](int column, int row, int)
            {
                if (world.hole && column > 40 && column < 60 && row > 10 && row < 40) return missing;
                return -1000.0 + 9800.0 * std::sin(0.3 * column) * std::cos(0.4 * row);
            })
        .write(file);
}

BuildOptions options(const std::string& dem, const std::filesystem::path& output)
{
    BuildOptions result;
    result.dems = {dem};
    result.tileSize = 16;
    result.textureSize = 16;
    result.output = output.string();
    return result;
}

class Eye : public osg::NodeVisitor
{
public:
    osg::Vec3 getViewPoint() const override { return place; }
    osg::Vec3 place;
};

const osg::ClusterCullingCallback* horizonOf(const DatabaseTile& tile)
{
    const osg::Node* node = tile.lod ? static_cast<const osg::Node*>(tile.lod) : tile.transform;
    return dynamic_cast<const osg::ClusterCullingCallback*>(node->getCullCallback());
}

/// As OSG asks: in the frame of what is below the node.
bool isLeftOut(const DatabaseTile& tile, const osg::Vec3d& eye)
{
    const osg::ClusterCullingCallback* horizon = horizonOf(tile);
    if (!horizon) return false;
    osg::ref_ptr<Eye> visitor = new Eye;
    visitor->place = tile.lod ? eye : eye * osg::Matrixd::inverse(tile.transform->getMatrix());
    return horizon->cull(visitor, nullptr, nullptr);
}

bool isRefined(const DatabaseTile& tile, const osg::Vec3d& eye)
{
    return tile.lod &&
           (eye - osg::Vec3d(tile.lod->getCenter())).length() < static_cast<double>(tile.lod->getMaxRange(1));
}

bool isWithin(const DatabaseTile& tile, const DatabaseTile& other)
{
    const int levels = tile.level - other.level;
    return levels >= 0 && tile.x >> levels == other.x && tile.y >> levels == other.y;
}

/// How near a line comes to the Earth's center.
double nearest(const osg::Vec3d& eye, const osg::Vec3d& place)
{
    const osg::Vec3d along = place - eye;
    const double share = -(eye * along) / along.length2();
    return share <= 0.0 ? eye.length() : share >= 1.0 ? place.length() : (eye + along * share).length();
}

/// How near a triangle comes to it.
double distance(const osg::Vec3d (&corners)[3])
{
    osg::Vec3d normal = (corners[1] - corners[0]) ^ (corners[2] - corners[0]);
    normal.normalize();
    double result = std::numeric_limits<double>::max();
    bool above = true;
    for (int i = 0; i < 3; ++i)
    {
        const osg::Vec3d &from = corners[i], &to = corners[(i + 1) % 3];
        result = std::min(result, nearest(from, to));
        above = above && ((to - from) ^ (normal * (normal * from) - from)) * normal >= 0.0;
    }
    return above ? std::min(result, std::abs(normal * corners[0])) : result;
}

/// The radius of the largest sphere about the Earth's center that no triangle cuts which is drawn for an eye.
double innerRadius(const std::vector<DatabaseTile>& tiles, const osg::Vec3d& eye)
{
    double result = std::numeric_limits<double>::max();
    for (const auto& tile : tiles)
    {
        const bool drawn = !isRefined(tile, eye) && std::all_of(tiles.begin(), tiles.end(),
                                                                [&](const DatabaseTile& above) {
                                                                    return above.level >= tile.level ||
                                                                           !isWithin(tile, above) ||
                                                                           isRefined(above, eye);
                                                                });
        if (!drawn) continue;
        for (const auto& mesh : tile.meshes)
        {
            const double range = (tile.world(osg::Vec3d(mesh.block->getCenter())) - eye).length();
            if (range < mesh.from || range >= mesh.to) continue;
            for (const auto& triangle : mesh.ground)
            {
                const osg::Vec3d corners[] = {tile.world(triangle[0]), tile.world(triangle[1]),
                                              tile.world(triangle[2])};
                result = std::min(result, distance(corners));
            }
        }
    }
    return result;
}

} // namespace

TEST(DatabaseHorizon, LeavesOutWhatTheGroundHides)
{
    const TempDir folder;
    buildDatabase(options(dem(folder / "dem.tif", {}), folder / "db"));
    const std::vector<DatabaseTile> tiles = readTiles(folder / "db");
    int leftOut = 0, beyond = 0;
    for (int i = 0; i < (fullTest() ? 2000 : 60); ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        osg::Vec3d up(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        up.normalize();
        const double height = random.logarithmic(10.0, 5e7);
        const osg::Vec3d eye = up * (EQUATOR + 9000.0 + height);
        // Lines of sight that graze the ground from here end at the highest mountain there.
        const double horizon =
            std::acos(0.96 * EQUATOR / eye.length()) + std::acos(0.96 * EQUATOR / (EQUATOR + 9000.0));
        const double inner = innerRadius(tiles, eye);
        for (const auto& tile : tiles)
        {
            double closest = osg::PI;
            for (const osg::Vec3& vertex : tile.vertices)
            {
                const osg::Vec3d place = tile.world(osg::Vec3d(vertex));
                closest = std::min(closest, std::acos(std::clamp(place * up / place.length(), -1.0, 1.0)));
            }
            const bool out = isLeftOut(tile, eye);
            // Small tiles far beyond.
            if (tile.level >= 3 && closest > horizon + osg::DegreesToRadians(30.0))
            {
                ++beyond;
                ASSERT_TRUE(out) << tile.transform->getName() << " from a height of " << height << " m";
            }
            if (!out) continue;
            ++leftOut;
            for (const auto& other : tiles)
            {
                if (!isWithin(other, tile)) continue;
                for (const osg::Vec3& vertex : other.vertices)
                    ASSERT_LT(nearest(eye, other.world(osg::Vec3d(vertex))), inner)
                        << other.transform->getName() << " in " << tile.transform->getName() << " from "
                        << height << " m";
            }
        }
    }
    EXPECT_GT(leftOut, 1000);
    EXPECT_GT(beyond, 500);
}

TEST(DatabaseHorizon, OnlyWhereTheEarthIsWhole)
{
    const TempDir folder;
    const std::pair<const char*, World> worlds[] = {{"whole", {}},
                                                    {"south", {-90.0, 60.0}},
                                                    {"west", {-90.0, 90.0, 150.0}},
                                                    {"hole", {-90.0, 90.0, 180.0, true}}};
    for (const auto& [name, world] : worlds)
    {
        SCOPED_TRACE(name);
        BuildOptions wishes = options(dem(folder / "dem.tif", world), folder / "db");
        // GDAL would fill the hole.
        wishes.voids = Voids::KEEP;
        buildDatabase(wishes);
        int horizons = 0;
        for (const auto& tile : readTiles(folder / "db"))
            horizons += horizonOf(tile) ? 1 : 0;
        if (std::string("whole") == name)
        {
            EXPECT_GT(horizons, 20);
        }
        else
        {
            EXPECT_EQ(horizons, 0);
        }
    }
}

TEST(DatabaseHorizon, FollowsAnUpdate)
{
    const TempDir folder;
    BuildOptions wishes = options(dem(folder / "dem.tif", {}), folder / "db");
    wishes.voids = Voids::KEEP;
    wishes.keep = true;
    buildDatabase(wishes);
    // Far from most tiles, whose own ground stays as it is.
    dem(folder / "dem.tif", {-90.0, 90.0, 180.0, true});
    wishes.update = true;
    const BuildSummary summary = buildDatabase(wishes);
    ASSERT_EQ(summary.allBecause, "");
    for (const auto& tile : readTiles(folder / "db"))
        EXPECT_FALSE(horizonOf(tile)) << tile.transform->getName();
}
