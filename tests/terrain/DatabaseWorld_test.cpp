// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Databases where the map has an edge and the globe has none, and units other than the metre.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseReader.h>
#include <tools/FolderContents.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <GeographicLib/Geocentric.hpp>

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <map>
#include <utility>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

BuildOptions options(const std::vector<std::string>& dems, const std::filesystem::path& output)
{
    BuildOptions result;
    result.dems = dems;
    result.tileSize = 16;
    result.textureSize = 16;
    result.output = output.string();
    return result;
}

struct Geodetic
{
    double latitude, longitude, height;
};

Geodetic geodetic(const osg::Vec3d& world)
{
    Geodetic g{};
    GeographicLib::Geocentric::WGS84().Reverse(world.x(), world.y(), world.z(), g.latitude, g.longitude,
                                               g.height);
    return g;
}

/// Longitude from 0 to 360.
double eastwards(double longitude)
{
    return longitude < 0.0 ? longitude + 360.0 : longitude;
}

TEST(DatabaseWorld, AcrossTheAntimeridian)
{
    const TempDir folder;
    // 1 m for each 0.01° east of 178°, so that 2 m are lost or won within a pixel of the border between two
    // files.
    const auto write = [&](const std::string& name, double west, int columns)
    {
        return TestRaster(columns, 40)
            .placed(west, 1.0, 0.02, 0.02)
            .crs("EPSG:4326")
            .fill([&](int column, int, int)
                  { return 100.0 * (eastwards(west + (column + 0.5) * 0.02) - 178.0); })
            .write(folder / name);
    };
    const auto east = write("east.tif", 179.0, 50), west = write("west.tif", -180.0, 50);
    const auto one = write("one.tif", 179.0, 100);
    for (const auto& dems : {std::vector{east, west}, std::vector{west, east}, std::vector{one}})
    {
        SCOPED_TRACE(dems.front());
        buildDatabase(options(dems, folder / "db"));
        const DatabaseRoot root(folder / "db");
        EXPECT_NEAR(root.east() - root.west(), 1.98, 1e-9) << "from " << root.west() << " to " << root.east();
        const FinestLevel level(folder / "db");
        EXPECT_EQ(level.columns, 100);
        for (std::size_t i = 0; i < level.world.size(); ++i)
        {
            ASSERT_TRUE(level.used[i]) << i;
            const Geodetic g = geodetic(level.world[i]);
            const double longitude = eastwards(g.longitude);
            ASSERT_NEAR(g.height, 100.0 * (longitude - 178.0),
                        std::abs(longitude - 180.0) < 0.0101 ? 1.1 : 0.05)
                << longitude;
        }
    }
}

// What floats lose in the frame of a tile as large as a continent, metres.
constexpr double ROUNDING = 1.0;

TEST(DatabaseWorld, WholeGlobeIsClosed)
{
    const TempDir folder;
    const auto height = [](int column, int row)
    {
        return 1000.0 + 500.0 * std::sin(column * 2.5 * osg::PI / 180.0) + 5.0 * row;
    };
    const auto write = [&](const std::string& name, int first, int columns)
    {
        return TestRaster(columns, 72)
            .placed(-180.0 + 2.5 * first, 90.0, 2.5, 2.5)
            .crs("EPSG:4326")
            .fill([&](int column, int row, int) { return height(first + column, row); })
            .write(folder / name);
    };
    // Worlds come in one file or in several, none of which goes around.
    const std::vector<std::string> one{write("dem.tif", 0, 144)},
        several{write("west.tif", 0, 40), write("east.tif", 90, 54), write("middle.tif", 40, 50)};
    for (const auto& dems : {one, several})
    {
        SCOPED_TRACE(dems.front());
        buildDatabase(options(dems, folder / "db"));
        const FinestLevel level(folder / "db");
        EXPECT_EQ(level.columns, 145);
        for (int row = 0; row < level.rows; ++row)
        {
            const auto first = level.index(0, row), last = level.index(level.columns - 1, row);
            ASSERT_LT((level.world[first] - level.world[last]).length(), 1.0) << "row " << row;
            for (int column = 0; column < level.columns; ++column)
            {
                ASSERT_TRUE(level.used[level.index(column, row)]) << column << " " << row;
                // Posts lie amid the pixels.
                const Geodetic g = geodetic(level.world[level.index(column, row)]);
                ASSERT_NEAR(g.height, height(column % 144, 71 - row), ROUNDING) << column << " " << row;
            }
        }
        // The levels above are coarse polyhedra; they must still be there.
        EXPECT_EQ(readTiles(folder / "db").size(),
                  static_cast<std::size_t>(DatabaseRoot(folder / "db").value<double>("geofx.tiles")));
    }
}

/// Where a ray towards the Earth's center goes in through a triangle; NaN where it does not, or from behind.
double heightAlong(const osg::Vec3d& direction, const osg::Vec3d& a, const osg::Vec3d& b, const osg::Vec3d& c)
{
    const osg::Vec3d normal = (b - a) ^ (c - a);
    if (normal * direction <= 0.0) return std::nan("");
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        if ((from ^ to) * direction < 0.0) return std::nan("");
    return geodetic(direction * ((a * normal) / (direction * normal))).height;
}

TEST(DatabaseWorld, CapsCloseThePoles)
{
    const TempDir folder;
    // The last tiles reach beyond the ends in the east and in the north.
    const auto height = [](int column, int row)
    {
        return (row < 45 ? 2000.0 : 500.0) + 300.0 * std::sin(column * 4.0 * osg::PI / 180.0);
    };
    const auto dem = TestRaster(180, 90)
                         .placed(-180.0, 90.0, 2.0, 2.0)
                         .crs("EPSG:4326")
                         .fill([&](int column, int row, int) { return height(column, row); })
                         .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "db"));
    struct Corners
    {
        osg::Vec3d a, b, c;
    };
    // Of the finest meshes, by level.
    std::map<int, std::vector<Corners>> caps;
    const auto tiles = readTiles(folder / "db");
    for (const auto& tile : tiles)
    {
        const auto corners = [&](const DatabaseTile::Triangle& triangle)
        {
            return Corners{tile.world(triangle[0]), tile.world(triangle[1]), tile.world(triangle[2])};
        };
        for (const auto& each : tile.cap)
            caps[tile.level].push_back(corners(each));
        for (const auto& mesh : tile.meshes)
        {
            for (const auto& each : mesh.cap)
                for (const unsigned int vertex : each)
                {
                    const Geodetic g = geodetic(tile.world(vertex));
                    if (std::abs(g.latitude) < 89.9) continue;
                    ASSERT_NEAR(g.height, g.latitude > 0.0 ? 2000.0 : 500.0, 30.0);
                }
            if (mesh.cap.empty()) continue;
            EXPECT_FALSE(mesh.capWalls.empty()) << tile.transform->getName();
        }
    }
    EXPECT_GE(caps.size(), 3u);
    int rays = 0;
    for (const auto& [level, triangles] : caps)
        for (const bool north : {true, false})
            for (int i = 0; i < 400; ++i)
            {
                // The first row of posts is a degree from the pole. A coarse level has a polygon there.
                const double longitude = osg::DegreesToRadians(0.9 * i + 0.05);
                const double share = level == 0 ? 0.5 : 0.9;
                const double colatitude = osg::DegreesToRadians(share * (i % 40 + 0.5) / 40.0);
                const osg::Vec3d direction(std::sin(colatitude) * std::cos(longitude),
                                           std::sin(colatitude) * std::sin(longitude),
                                           (north ? 1.0 : -1.0) * std::cos(colatitude));
                int hits = 0;
                for (const Corners& each : triangles)
                {
                    const double found = heightAlong(direction, each.a, each.b, each.c);
                    if (std::isnan(found)) continue;
                    ++hits;
                    ASSERT_NEAR(found, north ? 2000.0 : 500.0, 1300.0);
                }
                ASSERT_EQ(hits, 1) << "level " << level << ", " << i << (north ? " north" : " south");
                ++rays;
            }
    EXPECT_GE(rays, 2400);
}

TEST(DatabaseWorld, CapsFollowAnUpdate)
{
    const TempDir folder;
    const auto write = [&](const std::string& name, double west, double more)
    {
        return TestRaster(120, 180)
            .placed(west, 90.0, 1.0, 1.0)
            .crs("EPSG:4326")
            .fill([&](int column, int row, int)
                  { return 4.0 * relief(column, row) + (row == 0 && column < 12 ? more : 0.0); })
            .write(folder / name);
    };
    auto o = options(
        {write("west.tif", -180.0, 0.0), write("middle.tif", -60.0, 0.0), write("east.tif", 60.0, 0.0)},
        folder / "db");
    o.tileSize = 8;
    o.update = true;
    o.keep = true;
    buildDatabase(o);
    write("middle.tif", -60.0, 10.0);
    const BuildSummary update = buildDatabase(o);
    EXPECT_GT(update.unitsKept, 0u) << update.allBecause;
    EXPECT_GT(update.tilesKept, 0u);
    o.output = (folder / "anew").string();
    buildDatabase(o);
    // Tiles far from the change, made of another file alone, have a part of the cap, too.
    const auto updated = contents(folder / "db" / "tiles"), anew = contents(folder / "anew" / "tiles");
    ASSERT_GT(anew.size(), 20u);
    ASSERT_EQ(updated.size(), anew.size());
    for (const auto& [name, bytes] : anew)
        EXPECT_TRUE(updated.at(name) == bytes) << name;
}

/// A wall of a skirt on a meridian, in that meridian's half plane: distance from the axis, and along it.
struct MeridianWall
{
    osg::Vec2d top[2], up[2];
    double depth[2] = {};

    /// How high the wall's edge passes over a place, measured along a direction; NaN where it does not.
    double heightOver(const osg::Vec2d& place, const osg::Vec2d& direction,
                      double* depthThere = nullptr) const
    {
        const osg::Vec2d along = top[1] - top[0], from = place - top[0];
        const double determinant = along.x() * -direction.y() + direction.x() * along.y();
        const double s = (from.x() * -direction.y() + direction.x() * from.y()) / determinant;
        if (s < -1e-9 || s > 1.0 + 1e-9) return std::nan("");
        if (depthThere) *depthThere = depth[0] + s * (depth[1] - depth[0]);
        return (top[0] + along * s - place) * direction;
    }
};

/// Where the globe's eastern end meets its western one, tiles of all levels stand beside each other too.
TEST(DatabaseWorld, SkirtsCloseTheGlobe)
{
    const TempDir folder;
    // 100 columns, so that the last tiles reach beyond the end.
    const auto dem =
        TestRaster(100, 50)
            .placed(-180.0, 90.0, 3.6, 3.6)
            .crs("EPSG:4326")
            .fill([](int column, int row, int) { return 4.0 * relief(10.0 * (column % 100), 10.0 * row); })
            .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "db"));
    const double seam = DatabaseRoot(folder / "db").west();
    std::vector<MeridianWall> east, west;
    readDatabase(folder / "db",
                 [&](const DatabaseTile& tile)
                 {
                     if (tile.level == 0) return; // it never has a neighbour
                     for (const auto& piece : tile.skirt)
                     {
                         MeridianWall wall;
                         bool onSeam = true;
                         for (std::size_t k = 0; k < 2; ++k)
                         {
                             const osg::Vec3d top = tile.world(piece.top[k]),
                                              bottom = tile.world(piece.bottom[k]);
                             const Geodetic g = geodetic(top);
                             onSeam = onSeam && std::abs(std::remainder(g.longitude - seam, 360.0)) < 1e-4;
                             const double latitude = osg::DegreesToRadians(g.latitude);
                             wall.top[k].set(std::hypot(top.x(), top.y()), top.z());
                             wall.up[k].set(std::cos(latitude), std::sin(latitude));
                             wall.depth[k] = g.height - geodetic(bottom).height;
                         }
                         // The walls of a tile's western side come last and run southwards.
                         if (onSeam) (wall.top[1].y() < wall.top[0].y() ? west : east).push_back(wall);
                     }
                 });
    ASSERT_GT(east.size(), 50u);
    ASSERT_GT(west.size(), 50u);
    int compared = 0;
    for (const auto& [walls, others] : {std::pair(&east, &west), std::pair(&west, &east)})
        for (const auto& wall : *walls)
            for (const auto& other : *others)
                for (std::size_t k = 0; k < 2; ++k)
                {
                    const double below = other.heightOver(wall.top[k], wall.up[k]);
                    double depth = 0.0;
                    const double above = wall.heightOver(other.top[k], other.up[k], &depth);
                    compared += !std::isnan(below) + !std::isnan(above);
                    ASSERT_FALSE(-below > wall.depth[k] + ROUNDING)
                        << "a gap of " << -below - wall.depth[k] << " m";
                    ASSERT_FALSE(above > depth + ROUNDING) << "a gap of " << above - depth << " m";
                }
    EXPECT_GT(compared, 500);
}

TEST(DatabaseWorld, AroundThePole)
{
    const TempDir folder;
    const std::string crs = "EPSG:3995";
    const auto dem = TestRaster(120, 120)
                         .placed(-600000.0, 600000.0, 10000.0, 10000.0)
                         .crs(crs)
                         .fill([](int column, int row, int) { return 10.0 * column + row; })
                         .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "db"));
    const DatabaseRoot root(folder / "db");
    EXPECT_EQ(root.north(), 90.0);
    EXPECT_NEAR(root.east() - root.west(), 360.0, 1e-9);
    OGRSpatialReference polar, geographic;
    polar.SetFromUserInput(crs.c_str());
    geographic.importFromEPSG(4326);
    for (auto* srs : {&polar, &geographic})
        srs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> toPolar(
        OGRCreateCoordinateTransformation(&geographic, &polar));
    const FinestLevel level(folder / "db");
    int posts = 0;
    for (int row = 0; row < level.rows; ++row)
        for (int column = 0; column < level.columns; ++column)
        {
            // Where a post should be, not where it is: it may be a hole.
            double x = root.west() + (root.east() - root.west()) * column / (level.columns - 1.0);
            double y = root.south() + (root.north() - root.south()) * row / (level.rows - 1.0);
            ASSERT_TRUE(toPolar->Transform(1, &x, &y));
            if (std::max(std::abs(x), std::abs(y)) > 594000.0) continue;
            ++posts;
            const auto index = level.index(column, row);
            ASSERT_TRUE(level.used[index]) << "a hole at " << x << " " << y;
            const double expected = 10.0 * ((x + 600000.0) / 10000.0 - 0.5) + (600000.0 - y) / 10000.0 - 0.5;
            ASSERT_NEAR(geodetic(level.world[index]).height, expected, 0.05) << x << " " << y;
        }
    EXPECT_GT(posts, 10000);
}

TEST(DatabaseWorld, Egm96)
{
    const TempDir folder;
    // Places and undulations of the test data that NGA publishes with the model (file OUTINTPT.DAT).
    const double places[][3] = {{38.6281550, 269.7791550, -31.628},
                                {-14.6212170, 305.0211140, -2.969},
                                {46.8743190, 102.4487290, -43.575},
                                {-23.6174460, 133.8747120, 15.871}};
    for (const auto& [latitude, longitude, undulation] : places)
    {
        const double west = longitude > 180.0 ? longitude - 360.0 : longitude;
        const auto dem = TestRaster(20, 20)
                             .placed(west - 0.001, latitude + 0.001, 0.0001, 0.0001)
                             .crs("EPSG:4326")
                             .fill([](int, int, int) { return 100.0; })
                             .write(folder / "dem.tif");
        auto o = options({dem}, folder / "db");
        constexpr double rounding = 0.01; // a 1,024th of a cell of 11 m at most
        for (const auto& [datum, height, tolerance] :
             {std::tuple{VerticalDatum::None, 100.0, rounding},
              std::tuple{VerticalDatum::Ellipsoid, 100.0, rounding},
              // PROJ's grid has 15' and is interpolated bilinearly; NGA's program does it with splines.
              std::tuple{VerticalDatum::Egm96, 100.0 + undulation, 0.3}})
        {
            o.vertical = datum;
            buildDatabase(o);
            for (const auto& post : FinestLevel(o.output).world)
                ASSERT_NEAR(geodetic(post).height, height, tolerance) << latitude << " " << longitude;
        }
        o.epsg = 3857;
        buildDatabase(o);
        EXPECT_NEAR(DatabaseRoot(o.output).value<double>("geofx.maxHeight"), 100.0 + undulation, 0.3);
    }
}

TEST(DatabaseWorld, CrsInFeetIsDrawnInMetres)
{
    const TempDir folder;
    // New York Long Island, US survey feet; heights in metres.
    const auto dem = writeRelief(folder / "dem.tif", 60, 50, 980000.0, 200000.0, 100.0, "EPSG:2263");
    auto o = options({dem}, folder / "db");
    o.epsg = 2263;
    buildDatabase(o);
    const double metres = 1200.0 / 3937.0;
    const DatabaseRoot root(o.output);
    EXPECT_NEAR(root.west(), 980050.0 * metres, 1e-3);
    EXPECT_NEAR(root.north(), 199950.0 * metres, 1e-3);
    const FinestLevel level(o.output);
    EXPECT_NEAR(level.world.front().x(), 980050.0 * metres, 0.01);
    EXPECT_NEAR(level.world.back().y(), 199950.0 * metres, 0.01);
    const auto expected = warpedHeights({dem}, "EPSG:2263", 980050.0, 195050.0, 5900.0 / (level.columns - 1),
                                        4900.0 / (level.rows - 1), level.columns, level.rows);
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_NEAR(level.world[i].z(), static_cast<double>(expected[i]), 0.05);
}

TEST(DatabaseWorld, OneRowOfHeightsIsNoTerrain)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 60, 1, 10.0, 50.0, 0.01);
    EXPECT_THROW(buildDatabase(options({dem}, folder / "db")), BuildError);
}

} // namespace
