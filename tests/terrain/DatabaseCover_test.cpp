// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What tiles carry of the ground in their cover textures: trees, towns, bare ground, and the distance to the shore.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/DatabaseTexels.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osg/Texture2D>

#include <gtest/gtest.h>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr unsigned int COVER_UNIT = 7;
constexpr double WEST = 600000.0, NORTH = 2400000.0, CELL = 30.0; // UTM zone 4
constexpr int COLUMNS = 100, ROWS = 80;

struct Texel
{
    double column, row; ///< in the source's pixels, from the outer corner of the north-western one
    int trees, town, bare, shore;
};

class DatabaseCover : public ::testing::Test
{
protected:
    using Height = std::function<double(int column, int row)>;

    TestRaster raster(GDALDataType type = GDT_Byte) const
    {
        TestRaster result(COLUMNS, ROWS, 1, type);
        result.placed(WEST, NORTH, CELL, CELL).crs("EPSG:32604");
        return result;
    }

    std::string write(const std::string& name, const Height& value, GDALDataType type = GDT_Byte) const
    {
        return raster(type)
            .fill([&](int column, int row, int) { return value(column, row); })
            .write(_folder / name);
    }

    BuildOptions options(const Height& height) const
    {
        BuildOptions result;
        result.dems = {write("dem.tif", height, GDT_Float32)};
        result.epsg = 32604;
        result.tileSize = 8; // several units, so that their borders are seen
        result.output = (_folder / "db").string();
        return result;
    }

    /// Of sea west of column 40, wood, and a town from column 70 on; from row 60 on the table says nothing.
    void addLandCover(BuildOptions& o) const
    {
        o.landCover = write("classes.tif",
                            [](int column, int row) {
                                return column < 40 ? 1.0 : row >= 60 ? 9.0 : column < 70 ? 2.0 : 3.0;
                            });
        o.landCoverTable =
            _folder.write("table.csv", "value,class,name,red,green,blue,trees,town,bare,water\n"
                                       "1,a,A,10,20,200,0,0,0,1\n"
                                       "2,b,B,30,120,40,0.8,0.1,0.5,0\n"
                                       "3,c,C,90,90,90,0,1,0,0\n");
    }

    template<typename Visit>
    static void forTexels(const std::string& folder, const Visit& visit, int above = 0)
    {
        forEachTexel(
            folder, DatabaseRoot(folder).finestLevel() - above, COVER_UNIT,
            [&](double x, double y, const osg::Image& image, int column, int row)
            {
                const unsigned char* texel =
                    image.data(static_cast<unsigned>(column), static_cast<unsigned>(row));
                visit(Texel{(x - WEST) / CELL, (NORTH - y) / CELL, texel[0], texel[1], texel[2], texel[3]});
            });
    }

    static double codeOf(double metres) { return 255.0 * glsl::geofx_shoreCode(metres); }

    const TempDir _folder;
};

double hills(int column, int row)
{
    return 20.0 + 0.2 * relief(column, row);
}

TEST_F(DatabaseCover, ClassesAtTheirPlaces)
{
    auto o = options(hills);
    addLandCover(o);
    buildDatabase(o);
    ASSERT_EQ(DatabaseRoot(o.output).finestLevel(), 4);
    for (const int above : {0, 1, 3, 4}) // the coarsest two are of the upper tier
        forTexels(
            o.output,
            [&](const Texel& texel)
            {
                // A class is drawn with a B-spline, two pixels wide; above it is smoothed.
                const double margin = above < 3 ? 2.6 : 6.0;
                const double toBorder =
                    std::min(std::abs(texel.column - 40.0), std::abs(texel.column - 70.0));
                ASSERT_NEAR(texel.shore, codeOf(CELL * (40.0 - texel.column)), above < 3 ? 1.01 : 3.0)
                    << texel.column;
                if (toBorder < margin || std::abs(texel.row - 60.0) < margin) return;
                const bool sea = texel.column < 40.0, known = sea || texel.row < 60.0,
                           wood = texel.column < 70.0;
                if (!known) return;
                ASSERT_NEAR(texel.trees, sea || !wood ? 0 : 204, 1) << texel.column << " " << texel.row;
                ASSERT_NEAR(texel.town, sea ? 0 : wood ? 26 : 255, 1) << texel.column << " " << texel.row;
                ASSERT_NEAR(texel.bare, sea || !wood ? 0 : 128, 1) << texel.column << " " << texel.row;
            },
            above);
    expectNoSeams(o.output, COVER_UNIT);
}

TEST_F(DatabaseCover, TheTextureIsBoundAndNotDrawn)
{
    auto o = options(hills);
    buildDatabase(o);
    int textures = 0;
    readDatabase(o.output,
                 [&](const DatabaseTile& tile)
                 {
                     const osg::StateSet& state = *tile.geometry->getStateSet();
                     const auto* texture = dynamic_cast<const osg::Texture2D*>(
                         state.getTextureAttribute(COVER_UNIT, osg::StateAttribute::TEXTURE));
                     ASSERT_NE(texture, nullptr) << tile.transform->getName();
                     EXPECT_EQ(texture->getName(), "geofx cover");
                     EXPECT_EQ(texture->getInternalFormat(), GL_RGBA8);
                     EXPECT_EQ(texture->getFilter(osg::Texture::MIN_FILTER),
                               osg::Texture::LINEAR_MIPMAP_LINEAR);
                     EXPECT_EQ(texture->getFilter(osg::Texture::MAG_FILTER), osg::Texture::LINEAR);
                     EXPECT_EQ(texture->getWrap(osg::Texture::WRAP_S), osg::Texture::CLAMP_TO_EDGE);
                     EXPECT_FALSE(texture->getResizeNonPowerOfTwoHint());
                     EXPECT_EQ(state.getTextureMode(COVER_UNIT, GL_TEXTURE_2D),
                               static_cast<GLuint>(osg::StateAttribute::INHERIT));
                     EXPECT_EQ(tile.image(COVER_UNIT)->s(), tile.image(0)->s());
                     ++textures;
                 });
    EXPECT_GT(textures, 10);
}

TEST_F(DatabaseCover, PlacesWithoutAClassGoByTheirHeights)
{
    // Below row 60 a plain as high as the tree line's middle, but for a bay at height 0.
    auto o = options([](int column, int row) { return row < 60 ? 500.0 : column >= 80 ? 0.0 : 900.0; });
    addLandCover(o);
    o.treeLine = 1000.0;
    o.allHeights = true; // the bay's cliffs are too high to be true
    buildDatabase(o);
    int land = 0, bay = 0;
    forTexels(o.output,
              [&](const Texel& texel)
              {
                  if (texel.row < 64.0 || texel.column < 44.0 || std::abs(texel.column - 80.0) < 3.0) return;
                  if (texel.column > 80.0)
                  {
                      ++bay;
                      ASSERT_GT(texel.shore, 128);
                      ASSERT_EQ(texel.trees, 0);
                      return;
                  }
                  ++land;
                  const auto likely = glsl::geofx_likelyCover(900.0, 0.0, 1000.0);
                  ASSERT_LT(texel.shore, 128);
                  ASSERT_NEAR(texel.trees, 255.0 * likely.trees, 1.0);
                  ASSERT_NEAR(texel.bare, 255.0 * likely.bare, 1.0);
                  ASSERT_EQ(texel.town, 0);
              });
    EXPECT_GT(land, 100);
    EXPECT_GT(bay, 100);
}

TEST_F(DatabaseCover, WoodsStandOnSlopes)
{
    for (const double slope : {0.0, 0.1, 0.4, 0.9})
    {
        auto o =
            options([&](int column, int row) { return 100.0 + CELL * slope * (0.6 * column + 0.8 * row); });
        o.treeLine = 20000.0;
        buildDatabase(o);
        const auto likely = glsl::geofx_likelyCover(100.0, slope, 20000.0);
        forTexels(o.output,
                  [&](const Texel& texel)
                  {
                      if (std::min(texel.column, COLUMNS - texel.column) < 2.0 ||
                          std::min(texel.row, ROWS - texel.row) < 2.0)
                          return;
                      ASSERT_NEAR(texel.trees, 255.0 * likely.trees, 1.0) << slope;
                      ASSERT_EQ(texel.bare, 0);
                      ASSERT_LT(texel.shore, 4) << "no shore is near";
                  });
    }
}

TEST_F(DatabaseCover, SeaAndLakesOfHeightsAlone)
{
    const auto fromLake = [](double column, double row)
    {
        return std::hypot(column - 65.0, row - 40.0);
    };
    auto o = options(
        [&](int column, int row)
        {
            const double lake = fromLake(column + 0.5, row + 0.5);
            return column < 20 ? 0.0 : lake < 15.0 ? 180.0 : 181.0 + 2.0 * (lake - 15.0);
        });
    o.treeLine = 100.0;
    const auto check = [&](bool lakeIsWater)
    {
        int lake = 0;
        forTexels(o.output,
                  [&](const Texel& texel)
                  {
                      const double toLake = fromLake(texel.column, texel.row) - 15.0;
                      if (std::abs(texel.column - 20.0) < 1.5 || std::abs(toLake) < 1.5) return;
                      lake += toLake < 0.0;
                      const bool water = texel.column < 20.0 || (toLake < 0.0 && lakeIsWater);
                      ASSERT_EQ(texel.shore > 128, water) << texel.column << " " << texel.row;
                      ASSERT_EQ(texel.bare, water ? 0 : 128) << "the land lies above the tree line";
                      ASSERT_EQ(texel.trees, 0);
                  });
        EXPECT_GT(lake, 100);
        expectNoSeams(o.output, COVER_UNIT);
    };
    buildDatabase(o);
    check(true);
    o.lakeArea = 1e6; // the lake has 0.6 km²
    buildDatabase(o);
    check(false);
}

TEST_F(DatabaseCover, OnAGlobeDistancesAreMetres)
{
    BuildOptions o;
    o.dems = {TestRaster(120, 100)
                  .placed(10.0, 60.0, 0.001, 0.001)
                  .crs("EPSG:4326")
                  .fill([](int column, int, int) { return column < 60 ? 0.0 : 5.0; })
                  .write(_folder / "dem.tif")};
    o.tileSize = 8; // several units, so that their borders are seen
    o.output = (_folder / "db").string();
    buildDatabase(o);
    forEachTexel(o.output, DatabaseRoot(o.output).finestLevel(), COVER_UNIT,
                 [&](double x, double y, const osg::Image& image, int column, int row)
                 {
                     // On the ellipsoid a degree of longitude at 60° has 55,800 m.
                     const double metres = (10.06 - x) * 111412.84 * std::cos(y * M_PI / 180.0) * 1.00125;
                     const int shore =
                         image.data(static_cast<unsigned>(column), static_cast<unsigned>(row))[3];
                     ASSERT_NEAR(shore, codeOf(metres), 1.5) << x << " " << y;
                 });
    expectNoSeams(o.output, COVER_UNIT);
}

TEST_F(DatabaseCover, TreeCoverTakesThePlaceOfTheClasses)
{
    auto o = options(hills);
    addLandCover(o);
    // No data in the east, which the file does not declare.
    o.treeCover = write("trees.tif", [](int column, int) { return column < 55 ? 40.0 : 255.0; });
    buildDatabase(o);
    int west = 0, east = 0;
    forTexels(o.output,
              [&](const Texel& texel)
              {
                  if (texel.column < 43.0 || texel.column > 67.0 || texel.row > 56.0) return;
                  west += texel.column < 54.0;
                  east += texel.column > 56.0;
                  if (std::abs(texel.column - 55.0) < 1.0) return;
                  ASSERT_NEAR(texel.trees, texel.column < 54.0 ? 102 : 204, 1) << texel.column;
              });
    EXPECT_GT(west, 100);
    EXPECT_GT(east, 100);
    expectNoSeams(o.output, COVER_UNIT);
}

TEST_F(DatabaseCover, DepthsStandForDistances)
{
    const auto depth = [](double column)
    {
        return std::max(0.0, 0.6 * (40.0 - column));
    };
    auto o = options([&](int column, int) { return column < 40 ? -depth(column + 0.5) : 10.0; });
    addLandCover(o);
    buildDatabase(o);
    forTexels(o.output,
              [&](const Texel& texel)
              {
                  if (texel.column > 37.0 && texel.column < 40.0) return;
                  const double metres =
                      texel.column < 40.0 ? depth(texel.column) / 0.02 : CELL * (40.0 - texel.column);
                  ASSERT_NEAR(texel.shore, codeOf(metres), 1.01) << texel.column;
              });
    expectNoSeams(o.output, COVER_UNIT);

    // Noise about the sea's level is no depth.
    o.dems = {write(
        "dem.tif", [](int column, int row) { return column < 40 ? -((column + row) % 3) : 10.0; },
        GDT_Float32)};
    buildDatabase(o);
    forTexels(o.output, [&](const Texel& texel)
              { ASSERT_NEAR(texel.shore, codeOf(CELL * (40.0 - texel.column)), 1.01) << texel.column; });
}

TEST_F(DatabaseCover, TheTreeLineSinksTowardsThePoles)
{
    const auto treesAt = [&](double latitude)
    {
        BuildOptions o;
        o.dems = {TestRaster(40, 40)
                      .placed(10.0, latitude, 0.01, 0.01)
                      .crs("EPSG:4326")
                      .fill([](int, int, int) { return 1500.0; })
                      .write(_folder / "dem.tif")};
        o.output = (_folder / "db").string();
        buildDatabase(o);
        int trees = -1;
        forEachTexel(o.output, 0, COVER_UNIT,
                     [&](double, double, const osg::Image& image, int, int) { trees = image.data(9, 9)[0]; });
        return trees;
    };
    EXPECT_GT(treesAt(10.0), 30);
    EXPECT_GT(treesAt(-30.0), 30);
    EXPECT_EQ(treesAt(65.0), 0);
}

} // namespace
