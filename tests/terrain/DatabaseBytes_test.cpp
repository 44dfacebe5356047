// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What keeps databases small: which vertices there are, how they are numbered, and to what they are rounded.
#include <tools/DatabaseReader.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

/// Every post counts: of white noise none can be left out.
double noise(int column, int row)
{
    const double value = std::sin(column * 12.9898 + row * 78.233) * 43758.5453;
    return 200.0 * (value - std::floor(value));
}

BuildOptions options(const std::string& dem, const std::filesystem::path& output)
{
    BuildOptions result;
    result.dems = {dem};
    result.epsg = 32604;
    result.tileSize = 64;
    result.output = output.string();
    return result;
}

std::string raster(const std::filesystem::path& file, int samples, double (*height)(int, int))
{
    return TestRaster(samples, samples)
        .placed(600000.0, 2400000.0, 30.0, 30.0)
        .crs("EPSG:32604")
        .fill([&](int column, int row, int) { return height(column, row); })
        .write(file);
}

double sea(int, int)
{
    return 0.0;
}

/// Half of it is a sea.
double coast(int column, int row)
{
    return column < 64 ? 0.0 : noise(column, row);
}

std::vector<unsigned int> groundOf(const DatabaseTile::Mesh& mesh)
{
    const osg::PrimitiveSet& set = *mesh.geometry->getPrimitiveSet(0);
    std::vector<unsigned int> result;
    for (unsigned int i = 0; i < 3 * mesh.ground.size(); ++i)
        result.push_back(set.index(i));
    return result;
}

/// The smallest blocks of the finest tiles.
template<typename Visit>
void visitSmallest(const std::string& database, const Visit& visit)
{
    const int finest = DatabaseRoot(database).finestLevel();
    readDatabase(database,
                 [&](const DatabaseTile& tile)
                 {
                     if (tile.level != finest) return;
                     std::map<const osg::LOD*, std::vector<DatabaseTile::Mesh>> blocks;
                     for (const auto& mesh : tile.meshes)
                         if (mesh.smallest) blocks[mesh.block].push_back(mesh);
                     for (const auto& [block, meshes] : blocks)
                         visit(tile, meshes);
                 });
}

} // namespace

/// A compressor sees the same bytes again, block after block.
TEST(DatabaseBytes, BlocksWithAllPostsAreNumberedAlike)
{
    const TempDir folder;
    buildDatabase(options(raster(folder / "dem.tif", 129, noise), folder / "db"));
    std::set<std::vector<unsigned int>> lists;
    std::set<const osg::Array*> arrays;
    int blocks = 0;
    visitSmallest((folder / "db").string(),
                  [&](const DatabaseTile& tile, const std::vector<DatabaseTile::Mesh>& meshes)
                  {
                      ++blocks;
                      const auto& first = meshes.front();
                      ASSERT_EQ(first.from, 0.0);
                      ASSERT_EQ(first.ground.size(), 512u) << tile.transform->getName();
                      lists.insert(groundOf(first));
                      for (const auto& mesh : meshes)
                          EXPECT_EQ(mesh.geometry->getVertexArray(), first.geometry->getVertexArray());
                      // The block's 17² posts, and few lower ends of walls.
                      const unsigned int vertices = first.geometry->getVertexArray()->getNumElements();
                      EXPECT_GE(vertices, 289u);
                      EXPECT_LE(vertices, 289u + 64u);
                      // Row by row.
                      const auto& places =
                          dynamic_cast<const osg::Vec2Array&>(*first.geometry->getTexCoordArray(0));
                      for (unsigned int i = 0; i < 289; ++i)
                      {
                          EXPECT_TRUE(i % 17 == 0 || places[i].x() > places[i - 1].x()) << i;
                          EXPECT_TRUE(i < 17 || places[i].y() > places[i - 17].y()) << i;
                      }
                  });
    EXPECT_EQ(blocks, 64);
    // One for each way in which diagonals alternate.
    EXPECT_LE(lists.size(), 2u);
}

TEST(DatabaseBytes, ASeaHasFewVerticesAndStillBends)
{
    const TempDir folder;
    buildDatabase(options(raster(folder / "dem.tif", 129, sea), folder / "db"));
    int blocks = 0;
    visitSmallest(
        (folder / "db").string(),
        [&](const DatabaseTile& tile, const std::vector<DatabaseTile::Mesh>& meshes)
        {
            ++blocks;
            const auto [nearest, seen] = std::minmax_element(
                meshes.begin(), meshes.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
            // No camera comes as near as to see the first; deformations find short edges there.
            EXPECT_LT(nearest->to, 0.01);
            EXPECT_EQ(nearest->ground.size(), 128u);
            for (const auto& triangle : nearest->ground)
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_LE((tile.local(triangle[k]) - tile.local(triangle[(k + 1) % 3])).length(),
                              2.0 * 30.0 * std::sqrt(2.0) + 0.1);
            EXPECT_EQ(seen->ground.size(), 2u);
            EXPECT_LE(nearest->geometry->getVertexArray()->getNumElements(), 81u + 32u);
        });
    EXPECT_EQ(blocks, 64);
}

/// And what is there is right: where nothing is left out, where much is, and in between.
TEST(DatabaseBytes, PostsThatAreLeftOutLieOnTheTriangles)
{
    const TempDir folder;
    buildDatabase(options(raster(folder / "dem.tif", 129, coast), folder / "db"));
    const FinestLevel level((folder / "db").string());
    ASSERT_EQ(level.columns, 129);
    int plain = 0;
    for (int row = 0; row < level.rows; ++row)
        for (int column = 0; column < level.columns; ++column)
        {
            const std::size_t i = level.index(column, row);
            ASSERT_TRUE(level.used[i]) << column << " " << row;
            const double expected = coast(column, level.rows - 1 - row);
            ASSERT_NEAR(level.world[i].z(), expected, 0.02) << column << " " << row;
            plain += expected == 0.0;
        }
    EXPECT_GT(plain, 8000);
}

TEST(DatabaseBytes, PlacesLieOnAGrid)
{
    const TempDir folder;
    buildDatabase(options(raster(folder / "dem.tif", 129, noise), folder / "db"));
    std::size_t vertices = 0;
    readDatabase((folder / "db").string(),
                 [&](const DatabaseTile& tile)
                 {
                     // The next power of two below a 1,024th of 30 m.
                     constexpr double steps = 64.0;
                     for (const osg::Vec3& vertex : tile.vertices)
                         for (int k = 0; k < 3; ++k)
                             ASSERT_EQ(std::round(static_cast<double>(vertex[k]) * steps),
                                       static_cast<double>(vertex[k]) * steps);
                     vertices += tile.vertices.size();
                 });
    EXPECT_GT(vertices, 17000u);
}

/// What strokes, outlines and counts are made of.
TEST(DatabaseBytes, TheGroundOfATileIsAllOfItsFinestMeshes)
{
    const TempDir folder;
    buildDatabase(options(raster(folder / "dem.tif", 129, coast), folder / "db"));
    readDatabase((folder / "db").string(),
                 [&](const DatabaseTile& tile)
                 {
                     const osg::ref_ptr<osg::Geometry> ground = TileInfo::ground(*tile.transform);
                     ASSERT_TRUE(ground.valid());
                     const auto& vertices = dynamic_cast<const osg::Vec3Array&>(*ground->getVertexArray());
                     ASSERT_EQ(ground->getNormalArray()->getNumElements(), vertices.size());
                     ASSERT_EQ(ground->getTexCoordArray(0)->getNumElements(), vertices.size());
                     EXPECT_EQ(ground->getStateSet(), tile.geometry->getStateSet());
                     const osg::PrimitiveSet& set = *ground->getPrimitiveSet(0);
                     double area = 0.0;
                     for (unsigned int i = 0; i < set.getNumIndices(); i += 3)
                     {
                         const osg::Vec3d a = vertices[set.index(i)], b = vertices[set.index(i + 1)],
                                          c = vertices[set.index(i + 2)];
                         area += 0.5 * ((b - a) ^ (c - a)).z();
                     }
                     const TileInfo info = *TileInfo::read(*tile.transform);
                     const double edge = std::ldexp(128.0 * 30.0, -tile.level);
                     EXPECT_NEAR(area, edge * edge, 1e-3 * edge * edge) << tile.transform->getName();
                     EXPECT_GE(info.cells, 64);
                     EXPECT_NE(TileInfo::firstMesh(*tile.transform), nullptr);
                 });
}

/// Behind OSG's header, as OSG would have written it: others than our own readers must take it.
TEST(DatabaseBytes, FilesAreCompressed)
{
    const TempDir folder;
    buildDatabase(options(raster(folder / "dem.tif", 129, noise), folder / "db"));
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "db"))
    {
        if (entry.path().extension() != ".osgb") continue;
        ++files;
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
        ASSERT_GT(bytes.size(), 100u);
        EXPECT_EQ(bytes.substr(24, 4), "zlib") << entry.path();
        EXPECT_EQ(bytes.substr(28, 2), "\x1f\x8b") << entry.path();
    }
    EXPECT_GE(files, 2);
}
