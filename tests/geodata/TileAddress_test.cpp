// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Tiles that no file describes for GDAL: each tile's color is read at its place on the Earth.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/FileSources.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/TileAddress.h>
#include <osgGeoFX/paging/FilesByOthers.h>
#include <tools/KmlFiles.h>
#include <tools/TempDir.h>
#include <tools/TestServer.h>

#include <cpl_conv.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

using Color = std::array<int, 4>;

Color colorOf(int x, int y)
{
    return {50 + 25 * x, 50 + 25 * y, 120, 255};
}

/// Tiles of the levels 0 to 2; x and y, from the north, of those of level 2 make their colors. One of them is missing.
void writeTiles(const fs::path& folder, int columns, int rows, bool southern)
{
    for (int z = 0; z <= 2; ++z)
        for (int x = 0; x < columns << z; ++x)
            for (int y = 0; y < rows << z; ++y)
            {
                if (z == 2 && x == 1 && y == 2) continue;
                const fs::path column = folder / std::to_string(z) / std::to_string(x);
                fs::create_directories(column);
                const int row = southern ? (rows << z) - 1 - y : y;
                const Color color = z == 2 ? colorOf(x, y) : Color{0, 0, 60 * z, 255};
                writePicture((column / (std::to_string(row) + ".png")).string(), 256, 256,
                             [&](int, int) { return color; });
            }
}

class TileAddressTest : public ::testing::Test
{
protected:
    TileAddressTest() { CPLSetConfigOption("GDAL_DEFAULT_WMS_CACHE_PATH", (_folder / "cache").c_str()); }
    ~TileAddressTest() override { CPLSetConfigOption("GDAL_DEFAULT_WMS_CACHE_PATH", nullptr); }

    /// Reads the whole raster in 256 pixels for each tile of level 2.
    void expectTiles(const std::string& name, int columns, int rows, std::array<double, 4> box)
    {
        SCOPED_TRACE(name);
        initialiseGdal();
        const GdalErrorScope errors;
        ASSERT_TRUE(TileAddress::is(name));
        const DatasetPtr raster(
            GDALDataset::Open(TileAddress::forGdal(name).c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
        ASSERT_TRUE(raster) << errors.message();
        ASSERT_EQ(raster->GetRasterCount(), 4);
        std::array<double, 6> transform{};
        ASSERT_EQ(raster->GetGeoTransform(transform.data()), CE_None);
        EXPECT_NEAR(transform[0], box[0], 1e-4);
        EXPECT_NEAR(transform[3], box[3], 1e-4);
        EXPECT_NEAR(transform[0] + transform[1] * raster->GetRasterXSize(), box[2], 1e-4);
        EXPECT_NEAR(transform[3] + transform[5] * raster->GetRasterYSize(), box[1], 1e-4);
        const int width = 256 * columns * 4, height = 256 * rows * 4;
        std::vector<unsigned char> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                          4);
        ASSERT_EQ(raster->RasterIO(GF_Read, 0, 0, raster->GetRasterXSize(), raster->GetRasterYSize(),
                                   pixels.data(), width, height, GDT_Byte, 4, nullptr, 4,
                                   static_cast<GSpacing>(4) * width, 1, nullptr),
                  CE_None)
            << errors.message();
        for (int x = 0; x < columns * 4; ++x)
            for (int y = 0; y < rows * 4; ++y)
            {
                const std::size_t at =
                    4 * (static_cast<std::size_t>(256 * y + 128) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(256 * x + 128));
                const Color found{pixels[at], pixels[at + 1], pixels[at + 2], pixels[at + 3]};
                const bool missing = x == 1 && y == 2;
                if (missing)
                    EXPECT_EQ(found[3], 0);
                else
                    EXPECT_EQ(found, colorOf(x, y)) << x << " " << y;
            }
    }

    void writeResource(const fs::path& folder, const std::string& profile, const std::string& srs,
                       const std::string& box, double step, const std::string& href = "") const
    {
        std::string sets;
        for (int z = 0; z <= 2; ++z)
            sets += CPLSPrintf("<TileSet href=\"%s%d\" units-per-pixel=\"%.14f\" order=\"%d\"/>",
                               href.c_str(), z, step / (1 << z), z);
        _folder.write(
            (folder.filename() / "tilemapresource.xml").string(),
            "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<TileMap version=\"1.0.0\" "
            "tilemapservice=\"http://tms.osgeo.org/1.0.0\"><Title>a</Title><Abstract></Abstract><SRS>" +
                srs + "</SRS><BoundingBox " + box +
                "/><Origin x=\"1\" y=\"2\"/><TileFormat width=\"256\" height=\"256\" mime-type=\"image/png\" "
                "extension=\"png\"/><TileSets profile=\"" +
                profile + "\">" + sets + "</TileSets></TileMap>");
    }

    static constexpr double half = 20037508.342789244;
    static constexpr std::array<double, 4> web{-half, -half, half, half};
    const TempDir _folder;
};

} // namespace

TEST_F(TileAddressTest, FoldersOfTilesAreRead)
{
    const fs::path tiles = _folder / "north #1 at 50%";
    writeTiles(tiles, 1, 1, false);
    expectTiles((tiles / "{z}/{x}/{y}.png").string(), 1, 1, web);
    const fs::path southern = _folder / "south";
    writeTiles(southern, 1, 1, true);
    expectTiles((southern / "{z}/{x}/{-y}.png").string(), 1, 1, web);
}

TEST_F(TileAddressTest, TileMapResourcesAreRead)
{
    // gdal2tiles swaps or keeps the axes of the box, as its version is.
    const fs::path mercator = _folder / "mercator", degrees = _folder / "degrees", own = _folder / "own";
    writeTiles(mercator, 1, 1, true);
    writeResource(mercator, "mercator", "EPSG:900913", "minx=\"21\" miny=\"-158\" maxx=\"22\" maxy=\"-157\"",
                  156543.0339);
    expectTiles(mercator.string(), 1, 1, web);
    expectTiles((mercator / "tilemapresource.xml").string(), 1, 1, web);
    writeTiles(degrees, 2, 1, true);
    writeResource(degrees, "geodetic", "EPSG:4326", "minx=\"-158\" miny=\"21\" maxx=\"-157\" maxy=\"22\"",
                  0.703125);
    expectTiles(degrees.string(), 2, 1, {-180.0, -90.0, 180.0, 90.0});
    // A raster's own system: from the box's south-western corner.
    writeTiles(own, 2, 1, true);
    writeResource(own, "raster", "EPSG:32604",
                  "minx=\"600000\" miny=\"2300000\" maxx=\"651000\" maxy=\"2325000\"", 100.0);
    expectTiles(own.string(), 2, 1, {600000.0, 2300000.0, 651200.0, 2325600.0});
}

TEST_F(TileAddressTest, ServersAreAskedForTheLevelThatIsWanted)
{
    writeTiles(_folder / "tiles", 1, 1, false);
    // A server's missing tile is a fault.
    writePicture((_folder / "tiles" / "2" / "1" / "2.png").string(), 256, 256,
                 [](int, int) {
                     return Color{100, 150, 120, 0};
                 });
    TestServer server(_folder / "tiles");
    expectTiles(server.url("{z}/{x}/{y}.png"), 1, 1, web);
    EXPECT_EQ(server.requests().size(), 16u) << "the tiles of level 2, each once";
    writeTiles(_folder / "south", 1, 1, true);
    writeResource(_folder / "south", "mercator", "EPSG:3857",
                  "minx=\"21\" miny=\"-158\" maxx=\"22\" maxy=\"-157\"", 156543.0339);
    TestServer other(_folder / "south");
    expectTiles(other.url("tilemapresource.xml"), 1, 1, web);
}

TEST_F(TileAddressTest, OtherNamesStayAndFaultsAreSentences)
{
    for (const char* const name : {"a.tif", "/vsicurl/http://a/b.tif", "WMTS:http://a/{z}.xml",
                                   "<GDAL_WMS>{z}{x}{y}</GDAL_WMS>", "data{x}{y}.tif"})
    {
        EXPECT_FALSE(TileAddress::is(name)) << name;
        EXPECT_EQ(TileAddress::forGdal(name), name);
    }
    EXPECT_FALSE(TileAddress::is(_folder.path().string()));
    EXPECT_THROW(TileAddress::forGdal((_folder / "nowhere/{z}/{x}/{y}.png").string()), BuildError);
    for (const char* const text :
         {"", "no XML", "<TileMap/>", "<TileMap><TileSets/></TileMap>",
          "<TileMap><TileSets><TileSet order=\"1\" units-per-pixel=\"nan\"/></TileSets></TileMap>"})
    {
        _folder.write("tilemapresource.xml", text);
        try
        {
            TileAddress::forGdal((_folder / "tilemapresource.xml").string());
            ADD_FAILURE() << text;
        }
        catch (const BuildError& error)
        {
            EXPECT_NE(std::string(error.what()).find("tilemapresource.xml: "), std::string::npos)
                << error.what();
            EXPECT_NE(std::string(error.what()).find("{z}"), std::string::npos) << error.what();
        }
    }
}

TEST_F(TileAddressTest, FilesByOthersFetchNothing)
{
    writeTiles(_folder / "tiles", 1, 1, true);
    writeResource(_folder / "tiles", "mercator", "EPSG:3857",
                  "minx=\"21\" miny=\"-158\" maxx=\"22\" maxy=\"-157\"", 156543.0339);
    TestServer server(_folder / "tiles");
    for (const std::string& name :
         {server.url("{z}/{x}/{y}.png"), server.url("tilemapresource.xml"), (_folder / "tiles").string(),
          (_folder / "tiles" / "{z}/{x}/{-y}.png").string()})
    {
        SCOPED_TRACE(name);
        EXPECT_EQ(FileSources::of(name).service, "WMS");
        const FilesByOthers::Scope scope(_folder.path().string());
        initialiseGdal();
        const GdalErrorScope errors;
        try
        {
            EXPECT_FALSE(DatasetPtr(GDALDataset::Open(TileAddress::forGdal(name).c_str(), GDAL_OF_RASTER)));
        }
        catch (const BuildError&)
        {
        }
    }
    EXPECT_TRUE(server.requests().empty());
}
