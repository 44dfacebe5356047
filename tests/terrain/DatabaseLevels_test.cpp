// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The levels of detail of a built database: ranges, boxes, skirts, normals.
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseReader.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

// OSG keeps the centers of its bounding spheres in float: 0.25 m off along each axis, at geocentric
// coordinates.
constexpr double CENTER_ROUNDING = 0.44;

constexpr double NO_DISTANCE = std::numeric_limits<double>::max();

BuildOptions options(const std::vector<std::string>& dems, const std::filesystem::path& output, int epsg = 0)
{
    BuildOptions result;
    result.dems = dems;
    result.epsg = epsg;
    result.tileSize = 16;
    result.textureSize = 32;
    result.output = output.string();
    return result;
}

/// Radius of the ball around the center of a PagedLOD that holds its tile.
double radiusOf(const DatabaseTile& tile, const osg::Vec3d& center)
{
    double radius = 0.0;
    for (const auto& vertex : tile.vertices)
        radius = std::max(radius, (osg::Vec3d(vertex) - center).length());
    return radius;
}

/// How far a tile's mesh is from the posts of the finest level below it, metres.
struct Deviation
{
    double vertical = 0.0; ///< where it covers a post
    double lateral = 0.0;  ///< from a post that it does not cover to the nearest that it does
};

/// Of some triangles of a tile; where they are not `whole`, posts that they do not cover do not count.
Deviation deviation(const DatabaseTile& tile, const std::vector<DatabaseTile::Triangle>& surface, bool whole,
                    const DatabaseRoot& root, const FinestLevel& finest)
{
    const int span = finest.tileIntervals << (root.finestLevel() - tile.level);
    const int column0 = tile.x * span, row0 = tile.y * span;
    const int columns = std::min(span + 1, finest.columns - column0),
              rows = std::min(span + 1, finest.rows - row0);
    std::vector<double> distance(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                                 NO_DISTANCE);
    const osg::Matrixd inverse = osg::Matrixd::inverse(tile.transform->getMatrix());
    for (const auto& triangle : surface)
    {
        osg::Vec3d local[3], lattice[3];
        for (std::size_t k = 0; k < 3; ++k)
        {
            local[k] = tile.local(triangle[k]);
            const osg::Vec3d place = root.fromWorld(tile.world(triangle[k]));
            lattice[k].set((place.x() - finest.x0) / finest.dx - column0,
                           (place.y() - finest.y0) / finest.dy - row0, 0.0);
        }
        const auto cross = [](const osg::Vec3d& a, const osg::Vec3d& b, double x, double y)
        {
            return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
        };
        const auto [x0, x1] = std::minmax({lattice[0].x(), lattice[1].x(), lattice[2].x()});
        const auto [y0, y1] = std::minmax({lattice[0].y(), lattice[1].y(), lattice[2].y()});
        const osg::Vec3d normal = (local[1] - local[0]) ^ (local[2] - local[0]);
        for (int j = std::max(0, static_cast<int>(y0)); j <= std::min(rows - 1, static_cast<int>(y1) + 1);
             ++j)
            for (int i = std::max(0, static_cast<int>(x0));
                 i <= std::min(columns - 1, static_cast<int>(x1) + 1); ++i)
            {
                // A little outside counts: vertices are rounded.
                const double slack = -0.01;
                if (cross(lattice[0], lattice[1], i, j) < slack ||
                    cross(lattice[1], lattice[2], i, j) < slack ||
                    cross(lattice[2], lattice[0], i, j) < slack)
                    continue;
                const std::size_t index = finest.index(column0 + i, row0 + j);
                if (!finest.used[index]) continue;
                osg::Vec3d above = root.fromWorld(finest.world[index]);
                above.z() += 1000.0;
                const osg::Vec3d post = finest.world[index] * inverse;
                const osg::Vec3d up = (root.toWorld(above) * inverse - post) / 1000.0;
                double& least = distance[static_cast<std::size_t>(j * columns + i)];
                least = std::min(least, std::abs(((local[0] - post) * normal) / (up * normal)));
            }
    }
    Deviation result;
    const auto covered = [&](int i, int j)
    {
        return i >= 0 && j >= 0 && i < columns && j < rows &&
               distance[static_cast<std::size_t>(j * columns + i)] < NO_DISTANCE;
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
        {
            if (!finest.used[finest.index(column0 + i, row0 + j)]) continue;
            // On the tile's border it may be the neighbour's.
            if (!covered(i, j) && (i == 0 || j == 0 || i == span || j == span)) continue;
            if (covered(i, j))
            {
                result.vertical =
                    std::max(result.vertical, distance[static_cast<std::size_t>(j * columns + i)]);
                continue;
            }
            if (!whole) continue;
            int reach = 1;
            const auto found = [&]
            {
                for (int dj = -reach; dj <= reach; ++dj)
                    for (int di = -reach; di <= reach; ++di)
                        if (covered(i + di, j + dj)) return true;
                return reach > span;
            };
            while (!found())
                ++reach;
            result.lateral = std::max(result.lateral, reach * finest.dx);
        }
    return result;
}

/// Seen from beyond its range a tile must be right to pixelError pixels. Returns for each level the largest
/// share of what that admits which its tiles use.
std::map<int, double> largestShareOfBound(const std::string& database)
{
    const DatabaseRoot root(database);
    const double perRadian = root.value<double>("geofx.pixelsPerRadian");
    const double pixelError = root.value<double>("geofx.pixelError");
    const FinestLevel finest(database);
    std::map<int, double> shares;
    readDatabase(database,
                 [&](const DatabaseTile& tile)
                 {
                     if (!tile.lod || !tile.geometry) return;
                     const osg::Vec3d center =
                         tile.lod->getCenter() * osg::Matrixd::inverse(tile.transform->getMatrix());
                     const double range = static_cast<double>(tile.lod->getMaxRange(1));
                     EXPECT_EQ(tile.lod->getMinRange(0), tile.lod->getMaxRange(1));
                     const double admitted =
                         (range - radiusOf(tile, center) + CENTER_ROUNDING) * pixelError / perRadian + 1e-3;
                     const Deviation found = deviation(tile, tile.surface, true, root, finest);
                     // Borders of holes may run a finest cell otherwise, as the diagonals do.
                     const double lateral = found.lateral <= 1.001 * finest.dx ? 0.0 : found.lateral;
                     shares[tile.level] =
                         std::max(shares[tile.level], std::max(found.vertical, lateral) / admitted);
                 });
    return shares;
}

TEST(DatabaseLevels, RangesKeepThePixelError)
{
    const TempDir folder;
    const auto geographic = writeRelief(folder / "a.tif", 260, 200, 10.0, 47.5, 1.0 / 1200.0);
    const auto utm = writeRelief(folder / "b.tif", 260, 200, 600000.0, 2400000.0, 30.0, "EPSG:32604");
    for (const int epsg : {0, 32604})
    {
        auto o = options({epsg ? utm : geographic}, folder / std::to_string(epsg), epsg);
        o.texelError = 1e9; // so that textures ask for nothing
        o.pixelError = 2.0;
        buildDatabase(o);
        const auto shares = largestShareOfBound(o.output);
        ASSERT_GE(shares.size(), 4u);
        for (const auto& [level, share] : shares)
            EXPECT_LE(share, 1.0) << "level " << level << ", EPSG " << epsg;
        // And not by loading everything much too early.
        EXPECT_GE(shares.rbegin()->second, 0.9) << "EPSG " << epsg;
    }
}

/// A mesh stands at its distance on: no place of it may be nearer then than that less the ball around it. Vertices whose own
/// errors are within the pixel error may lie off by as much as 1.4 of it, as errors of edges add up.
TEST(DatabaseLevels, MeshesKeepThePixelErrorFromTheirDistanceOn)
{
    const TempDir folder;
    const auto utm = writeRelief(folder / "dem.tif", 260, 200, 600000.0, 2400000.0, 30.0, "EPSG:32604");
    auto o = options({utm}, folder / "db", 32604);
    o.tileSize = 64; // with blocks of two sizes
    o.pixelError = 2.0;
    buildDatabase(o);
    const DatabaseRoot root(o.output);
    const double perRadian = root.value<double>("geofx.pixelsPerRadian");
    const FinestLevel finest(o.output);
    int compared = 0;
    double largest = 0.0;
    readDatabase(
        o.output,
        [&](const DatabaseTile& tile)
        {
            for (const auto& mesh : tile.meshes)
            {
                // The finest ones are the tile's range's.
                if (mesh.from < 0.01) continue;
                double radius = 0.0;
                for (const auto& triangle : mesh.ground)
                    for (const unsigned int vertex : triangle)
                        radius = std::max(
                            radius, (tile.local(vertex) - osg::Vec3d(mesh.block->getCenter())).length());
                const double admitted = 1.4 * (mesh.from - radius) * 2.0 / perRadian + 1e-3;
                const double share = deviation(tile, mesh.ground, false, root, finest).vertical / admitted;
                EXPECT_LE(share, 1.0) << tile.transform->getName() << " from " << mesh.from << " m";
                largest = std::max(largest, share);
                ++compared;
            }
        });
    EXPECT_GT(compared, 200);
    EXPECT_GT(largest, 0.7) << "meshes are much finer than they need to be";
}

/// Each mesh of a block takes over where the one before it ends, and has clearly fewer triangles.
TEST(DatabaseLevels, MeshesFartherAwayHaveFewerTriangles)
{
    const TempDir folder;
    const auto utm = writeRelief(folder / "dem.tif", 260, 200, 600000.0, 2400000.0, 30.0, "EPSG:32604");
    auto o = options({utm}, folder / "db", 32604);
    o.tileSize = 64;
    buildDatabase(o);
    int blocks = 0;
    readDatabase(o.output,
                 [&](const DatabaseTile& tile)
                 {
                     const DatabaseTile::Mesh* former = nullptr;
                     for (const auto& mesh : tile.meshes)
                     {
                         const bool same = former && former->block == mesh.block;
                         if (same && former->to > 0.01)
                         {
                             ++blocks;
                             EXPECT_EQ(former->to, mesh.from)
                                 << "between them the block is not drawn, or twice";
                             EXPECT_LT(mesh.ground.size(), 0.86 * static_cast<double>(former->ground.size()));
                         }
                         EXPECT_TRUE(same || mesh.from < 0.01 || !mesh.smallest);
                         former = &mesh;
                     }
                     EXPECT_TRUE(!former || former->to > 1e30);
                 });
    EXPECT_GT(blocks, 100);
}

TEST(DatabaseLevels, RangesKeepThePixelErrorAroundHoles)
{
    const TempDir folder;
    TestRaster raster(200, 150);
    raster.placed(600000.0, 2400000.0, 30.0, 30.0).crs("EPSG:32604");
    raster.dataset().GetRasterBand(1)->SetNoDataValue(-9999.0);
    raster.fill(
        [](int column, int row, int) {
            return std::hypot(column - 100.0, row - 75.0) < 40.0 || column > 170 ? -9999.0
                                                                                 : relief(column, row);
        });
    auto o = options({raster.write(folder / "dem.tif")}, folder / "db", 32604);
    o.texelError = 1e9;
    o.voids = Voids::KEEP;
    buildDatabase(o);
    const auto shares = largestShareOfBound(o.output);
    ASSERT_GE(shares.size(), 3u);
    for (const auto& [level, share] : shares)
        EXPECT_LE(share, 1.0) << "level " << level;
}

TEST(DatabaseLevels, RangesKeepThePixelErrorWhereTheEarthIsRound)
{
    const TempDir folder;
    auto o = options({writeRelief(folder / "dem.tif", 240, 120, -30.0, 50.0, 0.25)}, folder / "db");
    o.texelError = 1e9;
    buildDatabase(o);
    const auto shares = largestShareOfBound(o.output);
    ASSERT_GE(shares.size(), 3u);
    for (const auto& [level, share] : shares)
        EXPECT_LE(share, 1.0) << "level " << level;
}

/// A sea has no relief, so what a tile is off by is the Earth's curve alone: between two posts, and twice as much across a cell's
/// diagonal. The upper tier has no finer posts to measure it by, and must know.
TEST(DatabaseLevels, RangesOfASeaAllowForTheEarthsCurve)
{
    const TempDir folder;
    const auto sea = TestRaster(240, 120)
                         .placed(-30.0, 15.0, 0.25, 0.25)
                         .crs("EPSG:4326")
                         .fill([](int, int, int) { return 0.0; })
                         .write(folder / "sea.tif");
    auto o = options({sea}, folder / "db");
    o.texelError = 1e9;
    o.pixelError = 1e-3; // so that the meshes' own tolerance hides nothing
    buildDatabase(o);
    const auto shares = largestShareOfBound(o.output);
    ASSERT_GE(shares.size(), 3u);
    ASSERT_TRUE(shares.count(0));
    for (const auto& [level, share] : shares)
        EXPECT_LE(share, 1.0) << "level " << level;
    EXPECT_GE(shares.at(0), 0.5) << "it is not the curve that decides";
}

TEST(DatabaseLevels, BoxesAreExact)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 130, 100, 10.0, 47.5, 1.0 / 3600.0);
    buildDatabase(options({dem}, folder / "db"));
    int tiles = 0;
    readDatabase(folder / "db",
                 [&](const DatabaseTile& tile)
                 {
                     ++tiles;
                     osg::BoundingBoxd box;
                     for (const auto& v : tile.vertices)
                         box.expandBy(osg::Vec3d(v));
                     osg::Vec3d low, high;
                     ASSERT_TRUE(tile.transform->getUserValue("geofx.boxMin", low));
                     ASSERT_TRUE(tile.transform->getUserValue("geofx.boxMax", high));
                     EXPECT_EQ(low, box._min) << tile.transform->getName();
                     EXPECT_EQ(high, box._max) << tile.transform->getName();
                     if (!tile.lod) return;
                     const osg::Vec3d center =
                         tile.lod->getCenter() * osg::Matrixd::inverse(tile.transform->getMatrix());
                     EXPECT_LE((center - box.center()).length(), CENTER_ROUNDING)
                         << tile.transform->getName();
                 });
    EXPECT_GE(tiles, 1 + 4 + 16 + 64);
    EXPECT_EQ(static_cast<double>(tiles), DatabaseRoot(folder / "db").value<double>("geofx.tiles"));
}

TEST(DatabaseLevels, BoundsHoldEverythingBelow)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 130, 100, 10.0, 47.5, 1.0 / 120.0);
    buildDatabase(options({dem}, folder / "db"));
    const auto tiles = readTiles(folder / "db");
    for (const auto& parent : tiles)
        for (const auto& tile : tiles)
        {
            const int down = tile.level - parent.level;
            if (!parent.lod || down < 0 || tile.x >> down != parent.x || tile.y >> down != parent.y) continue;
            const auto& ball = parent.lod->getBound();
            for (const auto& v : tile.vertices)
                ASSERT_LE((osg::Vec3d(v) * tile.transform->getMatrix() - ball.center()).length(),
                          static_cast<double>(ball.radius()) + CENTER_ROUNDING)
                    << tile.transform->getName() << " in " << parent.transform->getName();
        }
}

/// Whatever stands beside a tile, of whatever level: where its own edge is higher, its skirt reaches lower
/// than the other's edge.
TEST(DatabaseLevels, SkirtsReachEveryNeighbourThatCanStandBeside)
{
    const TempDir folder;
    // Noise, so that neighbouring posts have little to do with each other.
    const auto dem = TestRaster(150, 110)
                         .placed(600000.0, 2400000.0, 30.0, 30.0)
                         .crs("EPSG:32604")
                         .fill([](int column, int row, int) { return (column * 7919 + row * 104729) % 101; })
                         .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "db", 32604));
    const FinestLevel finest(folder / "db");

    struct Edge
    {
        std::string tile;
        bool border; ///< of that tile, not between two of its blocks
        int level;
        double start, end, top[2], bottom[2];

        double at(const double (&height)[2], double place) const
        {
            return height[0] + (height[1] - height[0]) * (place - start) / (end - start);
        }
    };
    // By direction and finest row or column.
    std::map<std::pair<bool, long>, std::vector<Edge>> lines;
    readDatabase(folder / "db",
                 [&](const DatabaseTile& tile)
                 {
                     for (const auto& mesh : tile.meshes)
                         for (const auto& wall : mesh.walls)
                         {
                             osg::Vec3d a = tile.world(wall.top[0]), b = tile.world(wall.top[1]);
                             osg::Vec3d lowA = tile.world(wall.bottom[0]), lowB = tile.world(wall.bottom[1]);
                             const bool alongX = std::abs(b.x() - a.x()) > std::abs(b.y() - a.y());
                             if (alongX ? b.x() < a.x() : b.y() < a.y())
                             {
                                 std::swap(a, b);
                                 std::swap(lowA, lowB);
                             }
                             const long line = std::lround(alongX ? (a.y() - finest.y0) / finest.dy
                                                                  : (a.x() - finest.x0) / finest.dx);
                             lines[{alongX, line}].push_back({tile.transform->getName(),
                                                              wall.border,
                                                              tile.level,
                                                              alongX ? a.x() : a.y(),
                                                              alongX ? b.x() : b.y(),
                                                              {a.z(), b.z()},
                                                              {lowA.z(), lowB.z()}});
                         }
                 });
    int compared = 0;
    for (const auto& [line, edges] : lines)
        for (const auto& edge : edges)
            for (const auto& other : edges)
            {
                // What lies within a tile never stands beside another one.
                if (edge.border != other.border || (!edge.border && edge.tile != other.tile)) continue;
                const double start = std::max(edge.start, other.start), end = std::min(edge.end, other.end);
                if (end - start < 1.0) continue;
                for (const double place : {start, end})
                {
                    ++compared;
                    ASSERT_LE(edge.at(edge.bottom, place), other.at(other.top, place))
                        << "a tile of level " << edge.level << " beside one of level " << other.level;
                }
            }
    EXPECT_GT(compared, 5000);
}

/// Each tile has a skirt along each edge that it shares with another.
TEST(DatabaseLevels, SkirtsHaveNoGaps)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 128, 96, 600000.0, 2400000.0, 30.0, "EPSG:32604");
    buildDatabase(options({dem}, folder / "db", 32604));
    const FinestLevel finest(folder / "db");
    const int last = DatabaseRoot(folder / "db").finestLevel();
    readDatabase(folder / "db",
                 [&](const DatabaseTile& tile)
                 {
                     const int span = finest.tileIntervals << (last - tile.level);
                     const double width = std::min(span, finest.columns - 1 - tile.x * span) * finest.dx;
                     const double height = std::min(span, finest.rows - 1 - tile.y * span) * finest.dy;
                     double length = 0.0;
                     for (const auto& wall : tile.skirt)
                     {
                         if (!wall.border) continue;
                         osg::Vec3d along = wall.top[1] - wall.top[0];
                         along.z() = 0.0;
                         length += along.length();
                     }
                     const bool atEast = (tile.x + 1) * span >= finest.columns - 1;
                     const bool atNorth = (tile.y + 1) * span >= finest.rows - 1;
                     const double needed = width * ((tile.y > 0 ? 1 : 0) + (atNorth ? 0 : 1)) +
                                           height * ((tile.x > 0 ? 1 : 0) + (atEast ? 0 : 1));
                     EXPECT_GE(length, needed - 0.1) << tile.transform->getName();
                 });
}

/// OpenGL draws no backs of them.
TEST(DatabaseLevels, AllTrianglesFaceOutside)
{
    const TempDir folder;
    constexpr double ROUNDING = 1.0 / 64.0; // metres: heights are multiples of a 32nd here
    const auto projected = writeRelief(folder / "utm.tif", 100, 70, 600000.0, 2400000.0, 30.0, "EPSG:32604");
    const auto geographic = writeRelief(folder / "geographic.tif", 100, 70, 10.0, 50.0, 0.001);
    for (const auto& [dem, epsg] : {std::pair(projected, 32604), std::pair(geographic, 0)})
    {
        const std::string database = folder / ("db" + std::to_string(epsg));
        buildDatabase(options({dem}, database, epsg));
        std::size_t ground = 0, walls = 0;
        readDatabase(
            database,
            [&](const DatabaseTile& tile)
            {
                for (const auto& mesh : tile.meshes)
                {
                    const auto& places =
                        dynamic_cast<const osg::Vec3Array&>(*mesh.geometry->getVertexArray());
                    const osg::PrimitiveSet& corners = *mesh.geometry->getPrimitiveSet(0);
                    const osg::Vec3d middle = mesh.block->getCenter();
                    for (unsigned int i = 0; i < corners.getNumIndices(); i += 3)
                    {
                        const osg::Vec3d a = places[corners.index(i)], b = places[corners.index(i + 1)],
                                         c = places[corners.index(i + 2)];
                        const osg::Vec3d normal = (b - a) ^ (c - a);
                        if (i / 3 < mesh.ground.size())
                        {
                            ASSERT_GT(normal.z(), 0.0) << tile.transform->getName();
                            ++ground;
                            continue;
                        }
                        osg::Vec3d away = (a + b + c) / 3.0 - middle;
                        away.z() = 0.0;
                        // Some are as low as the rounding of places, seen from the side. A wall leans, so its
                        // normal's upper part does not tell.
                        const double edge = std::max({(b - a).length(), (c - b).length(), (a - c).length()});
                        if (std::hypot(normal.x(), normal.y()) < ROUNDING * edge) continue;
                        ASSERT_GT(normal * away, 0.0) << tile.transform->getName();
                        ++walls;
                    }
                }
            });
        EXPECT_GT(ground, 10000u);
        EXPECT_GT(walls, 3000u);
    }
}

TEST(DatabaseLevels, NormalsAreThoseOfTheGround)
{
    // A plane that rises 3 m in 10 m to the east and falls 1 m in 10 m to the north.
    const TempDir folder;
    const auto dem = TestRaster(70, 60)
                         .placed(600000.0, 2400000.0, 10.0, 10.0)
                         .crs("EPSG:32604")
                         .fill([](int column, int row, int) { return 3.0 * column + 1.0 * row; })
                         .write(folder / "dem.tif");
    buildDatabase(options({dem}, folder / "db", 32604));
    osg::Vec3d expected(-0.3, 0.1, 1.0);
    expected.normalize();
    readDatabase(folder / "db",
                 [&](const DatabaseTile& tile)
                 {
                     for (const auto& mesh : tile.meshes)
                     {
                         const auto& normals =
                             dynamic_cast<const osg::Vec3bArray&>(*mesh.geometry->getNormalArray());
                         EXPECT_TRUE(normals.getNormalize());
                         // To half of a byte's steps.
                         for (const auto& n : normals)
                             ASSERT_LT((osg::Vec3d(n.x(), n.y(), n.z()) / 127.0 - expected).length(),
                                       std::sqrt(3.0) * 0.5 / 127.0)
                                 << tile.transform->getName();
                     }
                 });
}

} // namespace
