// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The textures of a built database: colors and classes at known places, and no seams between tiles.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseTexels.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osg/Texture>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Color = std::array<int, 3>;

Color colorAt(const osg::Image& image, int column, int row)
{
    const unsigned char* texel = image.data(static_cast<unsigned>(column), static_cast<unsigned>(row));
    return {texel[0], texel[1], texel[2]};
}

/// Classes have one byte for each texel.
int classAt(const osg::Image& image, int column, int row)
{
    return *image.data(static_cast<unsigned>(column), static_cast<unsigned>(row));
}

int distance(const Color& a, const Color& b)
{
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

BuildOptions options(const std::string& dem, const std::filesystem::path& output)
{
    BuildOptions result;
    result.dems = {dem};
    result.tileSize = 16;
    result.output = output.string();
    return result;
}

TEST(DatabaseSurface, ImageryAtItsPlaces)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 100, 80, 10.0, 50.0, 0.001);
    // Twice as fine as the elevation, over its western half; colors tell where they are.
    const auto image = TestRaster(100, 160, 3, GDT_Byte)
                           .placed(10.0, 50.0, 0.0005, 0.0005)
                           .crs("EPSG:4326")
                           .fill([](int column, int row, int band)
                                 { return band == 0   ? 2.0 * column
                                          : band == 1 ? 1.5 * row
                                                      : 5.0; })
                           .write(folder / "image.tif");
    auto o = options(dem, folder / "db");
    o.imagery = {image};
    buildDatabase(o);
    const int finest = DatabaseRoot(o.output).finestLevel();
    for (const int level : {finest, finest - 1})
        forEachTexel(o.output, level, 0,
                     [&](double x, double y, const osg::Image& picture, int column, int row)
                     {
                         const double px = (x - 10.0) / 0.0005 - 0.5, py = (50.0 - y) / 0.0005 - 0.5;
                         if (px < 2.0 || px > 96.0 || py < 2.0 || py > 156.0) return;
                         const Color found = colorAt(picture, column, row);
                         ASSERT_NEAR(found[0], 2.0 * px, 2.1) << x << " " << y;
                         ASSERT_NEAR(found[1], 1.5 * py, 2.1) << x << " " << y;
                         ASSERT_EQ(found[2], 5);
                     });
    // East of the image the relief's own colors show.
    forEachTexel(o.output, finest, 0,
                 [&](double x, double, const osg::Image& picture, int column, int row)
                 { ASSERT_TRUE(x < 10.0505 || colorAt(picture, column, row)[2] != 5) << x; });
    expectNoSeams(o.output, 0);
}

// A satellite's picture of 16 bits, blue first: in each tile with the same stretch, and with another one if it is wanted.
TEST(DatabaseSurface, ImageryOfSatellitesIsAsBrightInAllTiles)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 60, 60, 10.0, 50.0, 0.001);
    TestRaster image(60, 60, 4, GDT_UInt16);
    image.placed(10.0, 50.0, 0.001, 0.001)
        .crs("EPSG:4326")
        .fill([](int column, int, int band)
              { return band == 3 ? 5000.0 : (column < 30 ? 300.0 : 1100.0) + 100.0 * band; });
    for (const auto& [band, color] :
         {std::pair{1, GCI_BlueBand}, {2, GCI_GreenBand}, {3, GCI_RedBand}, {4, GCI_Undefined}})
        image.dataset().GetRasterBand(band)->SetColorInterpretation(color);
    auto o = options(dem, folder / "db");
    o.imagery = {image.write(folder / "image.tif")};
    const auto expectColors = [&](double black, double white)
    {
        const auto shown = [&](double number)
        {
            return 255.0 * (number - black) / (white - black);
        };
        forEachTexel(o.output, DatabaseRoot(o.output).finestLevel(), 0,
                     [&](double x, double, const osg::Image& picture, int column, int row)
                     {
                         if (std::abs(x - 10.03) < 0.0015) return;
                         const double number = x < 10.03 ? 300.0 : 1100.0;
                         const Color found = colorAt(picture, column, row);
                         ASSERT_NEAR(found[0], shown(number + 200.0), 1.0) << x;
                         ASSERT_NEAR(found[1], shown(number + 100.0), 1.0) << x;
                         ASSERT_NEAR(found[2], shown(number), 1.0) << x;
                     });
    };
    buildDatabase(o);
    expectColors(300.0, 1300.0);
    o.stretch = {0.0, 2000.0};
    o.update = true;
    EXPECT_EQ(buildDatabase(o).tilesKept, 0u) << "all are built again";
    expectColors(0.0, 2000.0);
}

TEST(DatabaseSurface, LaterImageWins)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 60, 60, 10.0, 50.0, 0.001);
    const auto plain = [&](const std::string& name, double west, double value)
    {
        return TestRaster(60, 60, 1, GDT_Byte)
            .placed(west, 50.0, 0.001, 0.001)
            .crs("EPSG:4326")
            .fill([&](int, int, int) { return value; })
            .write(folder / name);
    };
    auto o = options(dem, folder / "db");
    o.imagery = {plain("a.tif", 10.0, 50.0), plain("b.tif", 10.03, 200.0)};
    buildDatabase(o);
    forEachTexel(o.output, DatabaseRoot(o.output).finestLevel(), 0,
                 [&](double x, double, const osg::Image& picture, int column, int row)
                 {
                     const int found = colorAt(picture, column, row)[0];
                     ASSERT_TRUE(x > 10.0290 || found == 50) << x << " " << found;
                     ASSERT_TRUE(x < 10.0310 || found == 200) << x << " " << found;
                 });
}

TEST(DatabaseSurface, ReprojectedImageryHasNoSeams)
{
    const TempDir folder;
    // Enough tiles for several units on two tiers; an image in another CRS, and coarser than the texels.
    const auto dem = writeRelief(folder / "dem.tif", 300, 290, -158.0, 21.5, 1.0 / 3600.0);
    const auto image = TestRaster(300, 300, 3, GDT_Byte)
                           .placed(603000.0, 2379000.0, 33.0, 33.0)
                           .crs("EPSG:32604")
                           .fill([](int column, int row, int band)
                                 { return (column * 7919 + row * 104729 + band * 31) % 251; })
                           .write(folder / "image.tif");
    auto o = options(dem, folder / "db");
    o.imagery = {image};
    buildDatabase(o);
    ASSERT_GE(DatabaseRoot(o.output).finestLevel(), 4);
    expectNoSeams(o.output, 0);
    auto flat = options(dem, folder / "flat");
    flat.epsg = 32604;
    flat.imagery = {image};
    flat.textureSize = 16; // coarser than the image: averaged
    buildDatabase(flat);
    expectNoSeams(flat.output, 0);
}

TEST(DatabaseSurface, LandCover)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 100, 80, 10.0, 50.0, 0.001);
    TestRaster raster(100, 80, 1, GDT_Byte);
    const auto classOf = [](int column, int row)
    {
        return row >= 70 ? 9 : column < 50 ? 1 : 2;
    };
    raster.placed(10.0, 50.0, 0.001, 0.001)
        .crs("EPSG:4326")
        .fill([&](int column, int row, int) { return classOf(column, row); });
    auto o = options(dem, folder / "db");
    o.landCover = raster.write(folder / "landcover.tif");
    const std::string table = "value,class,name,red,green,blue\n1,sea,Sea,10,20,200\n2,wood,Wood,30,120,40\n";
    o.landCoverTable = folder.write("table.csv", table);
    buildDatabase(o);
    EXPECT_EQ(DatabaseRoot(o.output).value<std::string>("geofx.landCoverTable"), table);
    const int finest = DatabaseRoot(o.output).finestLevel();
    for (int level = finest; level >= finest - 1; --level)
        forEachTexel(
            o.output, level, 1,
            [&](double x, double y, const osg::Image& picture, int column, int row)
            {
                const double px = (x - 10.0) / 0.001, py = (50.0 - y) / 0.001;
                const double toBorder = std::min(std::abs(px - 50.0), std::abs(py - 70.0));
                if (toBorder < 0.05) return;
                ASSERT_EQ(classAt(picture, column, row), classOf(static_cast<int>(px), static_cast<int>(py)))
                    << px << " " << py << " level " << level;
            });
    forEachTexel(o.output, finest, 0,
                 [&](double x, double y, const osg::Image& picture, int column, int row)
                 {
                     const double px = (x - 10.0) / 0.001, py = (50.0 - y) / 0.001;
                     if (std::min(std::abs(px - 50.0), std::abs(py - 70.0)) < 1.1) return;
                     // A class that the table leaves out is grey.
                     const Color expected = py > 70.0   ? Color{128, 128, 128}
                                            : px < 50.0 ? Color{10, 20, 200}
                                                        : Color{30, 120, 40};
                     ASSERT_LE(distance(colorAt(picture, column, row), expected), 1) << px << " " << py;
                 });
    expectNoSeams(o.output, 0);
    expectNoSeams(o.output, 1);
    readDatabase(o.output,
                 [](const DatabaseTile& tile)
                 {
                     // Plain OSG must not draw the classes.
                     EXPECT_EQ(tile.geometry->getStateSet()->getTextureMode(1, GL_TEXTURE_2D),
                               static_cast<GLuint>(osg::StateAttribute::INHERIT));
                 });
}

/// Colors of heights are smooth; those of pictures have detail that is seen from its edge.
TEST(DatabaseSurface, AnisotropyFollowsTheColors)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 40, 40, 10.0, 50.0, 0.001);
    const auto image = TestRaster(40, 40, 3, GDT_Byte)
                           .placed(10.0, 50.0, 0.001, 0.001)
                           .crs("EPSG:4326")
                           .fill([](int column, int, int) { return column; })
                           .write(folder / "image.tif");
    const auto anisotropy = [&](bool imagery, double wanted)
    {
        auto o = options(dem, folder / "db");
        if (imagery) o.imagery = {image};
        o.anisotropy = wanted;
        buildDatabase(o);
        std::set<float> found;
        readDatabase(
            o.output,
            [&](const DatabaseTile& tile)
            {
                const auto& texture = dynamic_cast<const osg::Texture&>(
                    *tile.geometry->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
                found.insert(texture.getMaxAnisotropy());
            });
        return found;
    };
    EXPECT_EQ(anisotropy(false, 0.0), std::set<float>{1.0f});
    EXPECT_EQ(anisotropy(true, 0.0), std::set<float>{4.0f});
    EXPECT_EQ(anisotropy(false, 8.0), std::set<float>{8.0f});
    for (const double wrong : {0.5, -1.0, 17.0, std::nan("")})
        EXPECT_THROW(anisotropy(false, wrong), BuildError) << wrong;
}

TEST(DatabaseSurface, ReliefIsTintedByHeight)
{
    const TempDir folder;
    // Sea to 50 m deep in the west, land to 2000 m in the east.
    const auto dem =
        TestRaster(100, 60)
            .placed(10.0, 50.0, 0.001, 0.001)
            .crs("EPSG:4326")
            .fill([](int column, int, int) { return column < 50 ? column - 50.0 : 40.0 * (column - 49.0); })
            .write(folder / "dem.tif");
    auto o = options(dem, folder / "db");
    buildDatabase(o);
    std::map<int, Color> byColumn;
    forEachTexel(o.output, DatabaseRoot(o.output).finestLevel(), 0,
                 [&](double x, double, const osg::Image& picture, int column, int row)
                 {
                     const Color color = colorAt(picture, column, row);
                     const int pixel = static_cast<int>((x - 10.0) / 0.001);
                     const auto [place, fresh] = byColumn.emplace(pixel, color);
                     ASSERT_LE(distance(place->second, color), 60)
                         << "the color depends on more than the height";
                     ASSERT_TRUE(x > 10.0485 || color[2] > color[0]) << "the sea is not blue at " << x;
                     ASSERT_TRUE(x < 10.0515 || x > 10.06 || color[1] > color[2])
                         << "the lowland is not green at " << x;
                 });
    EXPECT_LE(distance(byColumn.rbegin()->second, {240, 240, 238}), 4) << "the summit is not white";
    expectNoSeams(o.output, 0);
}

TEST(DatabaseSurface, TexturesKeepTheirLimit)
{
    const TempDir folder;
    const auto dem = writeRelief(folder / "dem.tif", 100, 80, 10.0, 50.0, 0.001);
    const auto image = TestRaster(200, 160, 1, GDT_Byte)
                           .placed(10.0, 50.0, 0.0005, 0.0005)
                           .crs("EPSG:4326")
                           .write(folder / "image.tif");
    for (const bool withImage : {false, true})
        for (const int limit : {16, 48, 0})
        {
            auto o = options(dem, folder / "db");
            o.tileSize = 32;
            o.textureSize = limit;
            if (withImage) o.imagery = {image};
            buildDatabase(o);
            int widest = 0;
            readDatabase(o.output, [&](const DatabaseTile& tile)
                         { widest = std::max(widest, tile.image(0)->s() - 1); });
            EXPECT_LE(widest, limit ? limit : 4 * 32);
            EXPECT_GE(widest, 8);
        }
}

TEST(DatabaseSurface, HolesHaveNoPillars)
{
    const TempDir folder;
    TestRaster raster(100, 80);
    raster.placed(600000.0, 2400000.0, 30.0, 30.0).crs("EPSG:32604");
    raster.dataset().GetRasterBand(1)->SetNoDataValue(-9999.0);
    const auto hole = [](double column, double row)
    {
        return std::hypot(column - 50.0, row - 40.0);
    };
    raster.fill([&](int column, int row, int)
                { return hole(column, row) < 15.0 ? -9999.0 : 300.0 + relief(column, row) * 0.1; });
    auto o = options(raster.write(folder / "dem.tif"), folder / "db");
    o.epsg = 32604;
    o.voids = Voids::KEEP;
    buildDatabase(o);
    const int finest = DatabaseRoot(o.output).finestLevel();
    int triangles = 0;
    readDatabase(
        o.output,
        [&](const DatabaseTile& tile)
        {
            if (!tile.geometry) return;
            for (unsigned int vertex = 0; vertex < tile.vertices.size(); ++vertex)
                ASSERT_GT(tile.world(vertex).z(), 0.0)
                    << "a post or a skirt goes down to no-data in " << tile.transform->getName();
            if (tile.level != finest) return;
            for (const auto& triangle : tile.surface)
                for (const unsigned int vertex : triangle)
                {
                    ++triangles;
                    const osg::Vec3d p = tile.world(vertex);
                    ASSERT_GT(hole((p.x() - 600000.0) / 30.0 - 0.5, (2400000.0 - p.y()) / 30.0 - 0.5), 14.0)
                        << "a triangle reaches into the hole";
                }
        });
    EXPECT_GT(triangles, 30000);
    EXPECT_GT(DatabaseRoot(o.output).value<double>("geofx.minHeight"), 290.0);
}

/// Each channel of a coarser texel is the 1-2-1 mean of the finer ones around it, to the nearest byte: were it cut off instead, pictures
/// would darken by half a byte from level to level.
TEST(DatabaseSurface, CoarserTexelsAreRoundedMeans)
{
    const TempDir folder;
    auto o = options(writeRelief(folder / "dem.tif", 65, 65, 10.0, 50.0, 0.001), folder / "db");
    o.textureSize = 16; // as fine as the finest: every level halves
    o.imagery = {TestRaster(65, 65, 3, GDT_Byte)
                     .placed(10.0, 50.0, 0.001, 0.001)
                     .crs("EPSG:4326")
                     .fill([](int column, int row, int band)
                           { return (column * 7919 + row * 104729 * (band + 1) + column * row) % 251; })
                     .write(folder / "image.tif")};
    buildDatabase(o);
    std::map<std::array<int, 3>, DatabaseTile> tiles;
    for (const DatabaseTile& tile : readTiles(o.output))
        tiles[{tile.level, tile.x, tile.y}] = tile;
    int compared = 0;
    double sum = 0.0;
    for (const auto& [key, tile] : tiles)
    {
        const auto [level, x, y] = key;
        if (level == DatabaseRoot(o.output).finestLevel()) continue;
        const osg::Image& coarse = *tile.image(0);
        const int m = coarse.s() - 1;
        ASSERT_EQ(m, 16);
        const auto fine = [&, x = x, y = y, level = level](int column, int row, std::size_t channel)
        {
            const int east = std::min(column / m, 1), north = std::min(row / m, 1);
            const DatabaseTile& child = tiles.at({level + 1, 2 * x + east, 2 * y + north});
            return colorAt(*child.image(0), column - east * m, row - north * m)[channel];
        };
        for (int row = 1; row < m; ++row)
            for (int column = 1; column < m; ++column)
                for (std::size_t channel = 0; channel < 3; ++channel)
                {
                    double mean = 0.0;
                    for (int dy = -1; dy <= 1; ++dy)
                        for (int dx = -1; dx <= 1; ++dx)
                            mean += (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0 *
                                    fine(2 * column + dx, 2 * row + dy, channel);
                    const int found = colorAt(coarse, column, row)[channel];
                    ASSERT_NEAR(found, mean, 0.5) << tile.transform->getName();
                    sum += found - mean;
                    ++compared;
                }
    }
    EXPECT_EQ(compared, 5 * 15 * 15 * 3);
    EXPECT_NEAR(sum / compared, 0.0, 0.06) << "all levels together are lighter or darker";
}

} // namespace
