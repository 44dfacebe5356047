// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The textures of normals of a built database.
#include <osgGeoFX/panorama/detail/NormalSampler.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseTexels.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osg/Program>
#include <osgDB/ReadFile>

#include <cmath>
#include <map>
#include <optional>
#include <set>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr unsigned int unit = 2;

BuildOptions options(const std::string& dem, const std::filesystem::path& output, int tileSize)
{
    BuildOptions result;
    result.dems = {dem};
    result.tileSize = tileSize;
    result.output = output.string();
    return result;
}

/// The same on a plane, of a DEM in that CRS.
BuildOptions planeOptions(const std::string& dem, const std::filesystem::path& output, int tileSize)
{
    BuildOptions result = options(dem, output, tileSize);
    result.epsg = 32604;
    return result;
}

/// What a texel says, in the tile's frame, with the length that it says.
osg::Vec3d decoded(const osg::Image& image, int column, int row)
{
    const unsigned char* bytes = image.data(static_cast<unsigned>(column), static_cast<unsigned>(row));
    osg::Vec3d normal((bytes[0] - 128.0) / 127.0, (bytes[1] - 128.0) / 127.0, 0.0);
    if (image.getPixelFormat() == GL_RGB)
        normal.z() = (bytes[2] - 128.0) / 127.0;
    else
        normal.z() = std::sqrt(std::max(1.0 - normal.length2(), 0.0));
    return normal;
}

/// The ground's normals in the world, of the finest posts alone: at right angles to the ways between a post's neighbours.
class Ground
{
public:
    explicit Ground(const std::string& folder) : finest(folder) {}

    /// Nothing on the border, and at holes.
    std::optional<osg::Vec3d> normal(int column, int row) const
    {
        if (column < 1 || row < 1 || column + 1 >= finest.columns || row + 1 >= finest.rows) return {};
        const auto at = [&](int c, int r) -> std::optional<osg::Vec3d>
        {
            const std::size_t i = finest.index(c, r);
            if (!finest.used[i]) return {};
            return finest.world[i];
        };
        const auto west = at(column - 1, row), east = at(column + 1, row), south = at(column, row - 1),
                   north = at(column, row + 1);
        if (!west || !east || !south || !north) return {};
        osg::Vec3d normal = (*east - *west) ^ (*north - *south);
        normal.normalize();
        return normal;
    }

    const FinestLevel finest;
};

double degreesBetween(const osg::Vec3d& a, const osg::Vec3d& b)
{
    return osg::RadiansToDegrees(std::atan2((a ^ b).length(), a * b));
}

/// Compares the texels of the levels that have them as dense as the finest posts.
void expectNormalsOfTheGround(const std::string& folder, double degrees, int borderRows = 0)
{
    const Ground ground(folder);
    const int last = DatabaseRoot(folder).finestLevel();
    std::map<int, int> compared;
    readDatabase(folder,
                 [&](const DatabaseTile& tile)
                 {
                     if (!tile.geometry || tile.level < last - 2) return;
                     const osg::Image* image = tile.image(unit);
                     ASSERT_NE(image, nullptr) << tile.transform->getName();
                     const int n = ground.finest.tileIntervals << (last - tile.level);
                     ASSERT_EQ(image->s(), n + 1) << tile.transform->getName();
                     ASSERT_EQ(image->t(), n + 1);
                     for (int row = 0; row <= n; ++row)
                         for (int column = 0; column <= n; ++column)
                         {
                             const int gridRow = tile.y * n + row;
                             if (gridRow < borderRows || gridRow >= ground.finest.rows - borderRows) continue;
                             const auto expected = ground.normal(tile.x * n + column, gridRow);
                             if (!expected) continue;
                             const osg::Vec3d actual = osg::Matrixd::transform3x3(
                                 decoded(*image, column, row), tile.transform->getMatrix());
                             ASSERT_LT(degreesBetween(actual, *expected), degrees)
                                 << tile.transform->getName() << ", texel " << column << " " << row;
                             ++compared[tile.level];
                         }
                 });
    for (int level = std::max(last - 2, 0); level <= last; ++level)
        EXPECT_GT(compared[level], 1000) << level;
}

} // namespace

// Half a step of a byte is 0.23° for each of x and y, and more for what follows from them; slopes of 1 in 2 and more are among
// these. The ways between neighbours are chords, and slopes were measured along the ellipsoid: less than 0.01° here.
TEST(DatabaseNormals, AreThoseOfTheGround)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 150, 130, 10.0, 50.0, 0.02);
    const auto o = options(dem, folder / "db", 16);
    buildDatabase(o);
    expectNormalsOfTheGround(o.output, 0.6);
}

TEST(DatabaseNormals, AreThoseOfTheGroundOfAPlane)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 150, 130, 600000.0, 2400000.0, 60.0, "EPSG:32604");
    const auto o = planeOptions(dem, folder / "db", 16);
    buildDatabase(o);
    expectNormalsOfTheGround(o.output, 0.6);
}

TEST(DatabaseNormals, TwoChannelsWhereTheyTellTheThird)
{
    const TempDir folder;
    // A whole globe, whose largest tiles reach around it; and cliffs on a plane.
    const auto globe = writeRelief(folder / "globe.tif", 144, 72, -180.0, 90.0, 2.5);
    const auto o = options(globe, folder / "globe", 8);
    buildDatabase(o);
    std::map<int, std::set<GLenum>> formats;
    readDatabase(o.output,
                 [&](const DatabaseTile& tile)
                 {
                     const osg::Image* image = tile.image(unit);
                     if (!image) return;
                     formats[tile.level].insert(image->getPixelFormat());
                     double least = 1.0;
                     for (int row = 0; row < image->t(); ++row)
                         for (int column = 0; column < image->s(); ++column)
                         {
                             const osg::Vec3d normal = decoded(*image, column, row);
                             EXPECT_NEAR(normal.length(), 1.0, 0.01);
                             least = std::min(least, normal.z());
                         }
                     // So a shader may take the root of what is left.
                     EXPECT_EQ(image->getPixelFormat() == GL_RG, least > 0.2) << tile.transform->getName();
                 });
    const int last = DatabaseRoot(o.output).finestLevel();
    EXPECT_EQ(formats[0], std::set<GLenum>{GL_RGB});
    EXPECT_EQ(formats[last], std::set<GLenum>{GL_RG});
    // Around the poles the ways between neighbours shrink to nothing, and at 2.5° between posts the ellipsoid's curve shows.
    expectNormalsOfTheGround(o.output, 0.8, 4);

    const auto cliffs = TestRaster(40, 40)
                            .placed(600000.0, 2400000.0, 10.0, 10.0)
                            .crs("EPSG:32604")
                            .fill([](int column, int, int) { return column < 20 ? 0.0 : 300.0; })
                            .write(folder / "cliffs.tif");
    const auto steep = planeOptions(cliffs, folder / "steep", 16);
    buildDatabase(steep);
    readDatabase(steep.output,
                 [&](const DatabaseTile& tile)
                 {
                     const osg::Image* image = tile.image(unit);
                     ASSERT_NE(image, nullptr);
                     // Between posts 19 and 20: in the second tile of 16, the first of 32.
                     const bool cliff = tile.x == (tile.level == 2 ? 1 : 0);
                     EXPECT_EQ(image->getPixelFormat(), cliff ? GL_RGB : GL_RG) << tile.transform->getName();
                 });
    expectNormalsOfTheGround(steep.output, 0.8);
}

// Tiles of 8 cells make more levels than a unit of work has, so neighbours come from different units and from different tiers.
TEST(DatabaseNormals, NoSeams)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 150, 130, 600000.0, 2400000.0, 60.0, "EPSG:32604");
    const auto o = planeOptions(dem, folder / "db", 8);
    buildDatabase(o);
    ASSERT_GE(DatabaseRoot(o.output).finestLevel(), 5); // a unit has three levels below its root
    expectNoSeams(o.output, unit);
}

/// On levels with fewer texels than there are posts below, slopes are means of those around; also where a unit of work hands them to
/// the tier above, which it does for tiles of 8 cells.
TEST(DatabaseNormals, CoarserLevelsAreSmooth)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 129, 129, 600000.0, 2400000.0, 60.0, "EPSG:32604");
    for (const int tileSize : {16, 8})
    {
        SCOPED_TRACE(tileSize);
        const auto o = planeOptions(dem, folder / std::to_string(tileSize), tileSize);
        buildDatabase(o);
        const Ground ground(o.output);
        ASSERT_EQ(ground.finest.columns, 129);
        int compared = 0;
        readDatabase(o.output,
                     [&](const DatabaseTile& tile)
                     {
                         if (tile.level > 0) return;
                         const osg::Image* image = tile.image(unit);
                         ASSERT_EQ(image->s(), 4 * tileSize + 1);
                         const int step = 128 / (4 * tileSize), middle = 2 * tileSize;
                         for (int row = 2; row < 4 * tileSize - 1; ++row)
                             for (int column = 2; column < 4 * tileSize - 1; ++column)
                             {
                                 // A unit's border is smoothed along itself alone.
                                 if (row == middle || column == middle) continue;
                                 osg::Vec3d sum;
                                 for (int y = 1 - step; y < step; ++y)
                                     for (int x = 1 - step; x < step; ++x)
                                     {
                                         const osg::Vec3d each =
                                             *ground.normal(step * column + x, step * row + y);
                                         sum +=
                                             each / each.z() * ((step - std::abs(x)) * (step - std::abs(y)));
                                     }
                                 sum.normalize();
                                 EXPECT_LT(degreesBetween(decoded(*image, column, row), sum), 0.6)
                                     << column << " " << row;
                                 ++compared;
                             }
                     });
        EXPECT_EQ(compared, (4 * tileSize - 4) * (4 * tileSize - 4));
    }
}

/// At the posts of a finest tile the texels say what its vertices do, also where colors are denser than posts.
TEST(DatabaseNormals, LieWhereVerticesDo)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 60, 50, 10.0, 50.0, 0.004);
    const auto image = TestRaster(180, 150, 3, GDT_Byte)
                           .placed(10.0, 50.0, 0.004 / 3, 0.004 / 3)
                           .crs("EPSG:4326")
                           .fill([](int column, int row, int) { return (column + row) % 256; })
                           .write(folder / "image.tif");
    for (const bool imagery : {false, true})
    {
        auto o = options(dem, folder / (imagery ? "imagery" : "plain"), 16);
        if (imagery) o.imagery = {image};
        buildDatabase(o);
        const int last = DatabaseRoot(o.output).finestLevel();
        int compared = 0;
        readDatabase(o.output,
                     [&](const DatabaseTile& tile)
                     {
                         if (!tile.geometry || tile.level < last) return;
                         EXPECT_EQ(tile.image(0)->s() == tile.image(unit)->s(), !imagery);
                         const NormalSampler sampler(*tile.geometry);
                         ASSERT_TRUE(sampler.valid());
                         for (const auto& mesh : tile.meshes)
                         {
                             const auto& places =
                                 dynamic_cast<const osg::Vec2Array&>(*mesh.geometry->getTexCoordArray(0));
                             const auto& normals =
                                 dynamic_cast<const osg::Vec3bArray&>(*mesh.geometry->getNormalArray());
                             for (std::size_t i = 0; i < normals.size(); ++i)
                             {
                                 const auto texel = sampler.at(static_cast<double>(places[i].x()),
                                                               static_cast<double>(places[i].y()));
                                 ASSERT_TRUE(texel.has_value());
                                 const osg::Vec3d vertex(normals[i].x(), normals[i].y(), normals[i].z());
                                 // Both are rounded to bytes.
                                 ASSERT_LT(degreesBetween(*texel, vertex), 0.9)
                                     << imagery << " " << tile.transform->getName() << " " << i;
                                 ++compared;
                             }
                         }
                     });
        EXPECT_GT(compared, 2000);
    }
}

TEST(DatabaseNormals, TheyAreBoundAndTheStateStandsAboveTilesAlone)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 40, 40, 10.0, 50.0, 0.004);
    const auto o = options(dem, folder / "db", 16);
    buildDatabase(o);
    readDatabase(o.output,
                 [&](const DatabaseTile& tile)
                 {
                     const osg::StateSet& state = *tile.geometry->getStateSet();
                     const osg::StateAttribute* texture =
                         state.getTextureAttribute(unit, osg::StateAttribute::TEXTURE);
                     ASSERT_NE(texture, nullptr);
                     EXPECT_EQ(texture->getName(), "geofx normals");
                     EXPECT_EQ(state.getTextureMode(unit, GL_TEXTURE_2D), osg::StateAttribute::INHERIT);
                     EXPECT_EQ(state.getAttribute(osg::StateAttribute::PROGRAM), nullptr);
                 });
    const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(o.output + "/terrain.osgb");
    ASSERT_TRUE(root.valid());
    EXPECT_EQ(root->getStateSet()->getAttribute(osg::StateAttribute::PROGRAM), nullptr);
    EXPECT_EQ(root->getStateSet()->getMode(GL_CULL_FACE), osg::StateAttribute::INHERIT);
    const osg::StateSet* above = root->asGroup()->getChild(0)->getStateSet();
    ASSERT_NE(above, nullptr);
    EXPECT_EQ(above->getMode(GL_CULL_FACE), osg::StateAttribute::ON);
    const auto* program =
        dynamic_cast<const osg::Program*>(above->getAttribute(osg::StateAttribute::PROGRAM));
    ASSERT_NE(program, nullptr);
    EXPECT_EQ(program->getName(), "geofx tile");
    ASSERT_EQ(program->getNumShaders(), 1u);
    // OpenGL's own vertex stage clips and lights.
    EXPECT_EQ(program->getShader(0)->getType(), osg::Shader::FRAGMENT);
}
