// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Rasters of files in the frames of mappings: where their texels lie, which frames they get, and what is refused. Where things must
// lie, PROJ says. GDAL writes the pictures and archives.
#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/geodata/OverlayReader.h>
#include <tools/GeofxPlugins.h>
#include <tools/KmlFiles.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>
#include <tools/TestServer.h>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <ogr_spatialref.h>
#include <osg/Math>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sys/resource.h>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// From degrees into a frame, metres.
osg::Vec2d placed(const OverlayReader& reader, std::size_t frame, const osg::Vec2d& degrees)
{
    OGRSpatialReference from, to;
    from.importFromEPSG(4326);
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const LocalOrigin& origin = reader.frames[frame];
    if (reader.globe)
        to.SetFromUserInput(CPLSPrintf("+proj=ortho +ellps=WGS84 +lat_0=%.17g +lon_0=%.17g",
                                       osg::RadiansToDegrees(origin.latitude),
                                       osg::RadiansToDegrees(origin.longitude)));
    else
        to.SetFromUserInput(reader.wkt.c_str());
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> transformation(
        OGRCreateCoordinateTransformation(&from, &to));
    double x = degrees.x();
    double y = degrees.y();
    EXPECT_TRUE(transformation->Transform(1, &x, &y));
    return osg::Vec2d(x, y) - (reader.globe ? osg::Vec2d() : origin.place());
}

/// The texel of an overlay at a place of its frame: RGBA, or all 0 outside.
std::array<int, 4> texelAt(const GroundOverlay& overlay, const osg::Vec2d& place)
{
    const osg::ref_ptr<ProjectiveMapping> mapping = overlay.makeMapping();
    const glm::dvec3 uvw = mapping->placeToRaster() * glm::dvec3(place.x(), place.y(), 1.0);
    const double u = uvw.x / uvw.z;
    const double v = uvw.y / uvw.z;
    if (!(u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0)) return {};
    const osg::Image& image = *overlay.layer->getImage();
    const unsigned char* const texel =
        image.data(static_cast<unsigned int>(u * image.s()), static_cast<unsigned int>(v * image.t()));
    return {texel[0], texel[1], texel[2], texel[3]};
}

/// A picture whose color tells its place: red from left to right, green from the bottom up.
std::array<int, 4> ramp(int x, int y)
{
    return {x, 255 - y, 77, 255};
}

class OverlayReaderTest : public GeofxPlugins
{
protected:
    void SetUp() override { GDALAllRegister(); }

    std::string archive(const std::string& features, const std::string& name = "over.kmz")
    {
        const std::string picture = (_folder / "ramp.png").string();
        if (!std::filesystem::exists(picture)) writePicture(picture, 256, 256, ramp);
        const std::string file = (_folder / name).string();
        writeArchive(file, {{"doc.kml", kml(features)}, {"files/ramp.png", bytesOf(picture)}});
        return file;
    }
    bool read(const std::string& file, const OverlayReader::Options& options = {})
    {
        std::string error;
        const bool done = _reader.read(file, options, error);
        EXPECT_TRUE(done) << error;
        return done;
    }
    std::string faultOf(const std::string& file)
    {
        std::string error;
        EXPECT_FALSE(_reader.read(file, {}, error));
        EXPECT_TRUE(_reader.overlays.empty() && _reader.frames.empty()) << "unchanged";
        EXPECT_TRUE(!error.empty() && error.back() == '.') << error;
        return error;
    }
    /// The overlay shows the ramp as it lies between its corners in degrees, to a texel.
    void expectRamp(const GroundOverlay& overlay, const std::function<osg::Vec2d(double, double)>& degrees)
    {
        for (double u = 0.05; u < 1.0; u += 0.1)
        {
            for (double v = 0.05; v < 1.0; v += 0.1)
            {
                const std::array<int, 4> color =
                    texelAt(overlay, placed(_reader, overlay.frame, degrees(u, v)));
                EXPECT_NEAR(color[0], u * 256.0 - 0.5, 2.0) << u << " " << v;
                EXPECT_NEAR(color[1], v * 256.0 - 0.5, 2.0) << u << " " << v;
                EXPECT_EQ(color[3], 255);
            }
        }
        EXPECT_EQ(texelAt(overlay, placed(_reader, overlay.frame, degrees(-0.02, 0.5)))[3], 0);
        EXPECT_EQ(texelAt(overlay, placed(_reader, overlay.frame, degrees(0.5, 1.02)))[3], 0);
    }

    TempDir _folder;
    OverlayReader _reader;
};

} // namespace

TEST_F(OverlayReaderTest, ASmallPictureStaysAsItIs)
{
    ASSERT_TRUE(read(archive(groundOverlay("files/ramp.png", latLonBox(7.0, 45.0, 7.01, 45.006)))));
    ASSERT_EQ(_reader.overlays.size(), 1u);
    const GroundOverlay& overlay = _reader.overlays[0];
    EXPECT_EQ(overlay.layer->getImage()->s(), 256);
    EXPECT_EQ(overlay.name, "files/ramp.png");
    expectRamp(overlay, [](double u, double v) { return osg::Vec2d(7.0 + 0.01 * u, 45.0 + 0.006 * v); });
}

TEST_F(OverlayReaderTest, ALargePictureIsBentWithTheGlobe)
{
    for (const double south : {-20.0, 40.0, 65.0})
    {
        SCOPED_TRACE(south);
        _reader = OverlayReader();
        ASSERT_TRUE(
            read(archive(groundOverlay("files/ramp.png", latLonBox(170.0, south, -160.0, south + 20.0)))));
        expectRamp(_reader.overlays.at(0),
                   [&](double u, double v) { return osg::Vec2d(170.0 + 30.0 * u, south + 20.0 * v); });
    }
}

TEST_F(OverlayReaderTest, AProjectedTerrainHasThemWhereItsProjectionHasThem)
{
    // osgEarth put them elsewhere on projected maps (its issue 140).
    for (const double size : {0.02, 4.0})
    {
        SCOPED_TRACE(size);
        _reader = OverlayReader();
        _reader.globe = false;
        _reader.wkt = wktOf(32604);
        ASSERT_TRUE(read(
            archive(groundOverlay("files/ramp.png", latLonBox(-159.0, 21.0, -159.0 + size, 21.0 + size)))));
        expectRamp(_reader.overlays.at(0),
                   [&](double u, double v) { return osg::Vec2d(-159.0 + size * u, 21.0 + size * v); });
    }
}

TEST_F(OverlayReaderTest, AlphaIsTheMappingsAndColorsMultiply)
{
    ASSERT_TRUE(read(archive(
        groundOverlay("files/ramp.png", latLonBox(7.0, 45.0, 7.01, 45.006), "<color>40ff8000</color>") +
        groundOverlay("", latLonBox(7.0, 45.0, 7.01, 45.006), "<color>ff0000ff</color>"))));
    const GroundOverlay& first = _reader.overlays.at(0);
    EXPECT_NEAR(first.opacity, 64.0 / 255.0, 1e-6);
    const std::array<int, 4> texel = texelAt(first, placed(_reader, 0, {7.005, 45.003}));
    EXPECT_EQ(texel[0], 0);
    EXPECT_NEAR(texel[1], 64, 1);
    EXPECT_EQ(texel[2], 77);
    EXPECT_EQ(texel[3], 255);
    EXPECT_EQ(texelAt(_reader.overlays.at(1), placed(_reader, 0, {7.005, 45.003})),
              (std::array<int, 4>{255, 0, 0, 255}));
}

TEST_F(OverlayReaderTest, NeighborsShareAFrameAndOthersDoNot)
{
    const auto small = [](double longitude, double latitude, double size)
    {
        return groundOverlay("files/ramp.png",
                             latLonBox(longitude, latitude, longitude + size, latitude + size));
    };
    // The third one is on the other side of the globe; the texels of the fourth, 4 cm, want a frame nearby.
    ASSERT_TRUE(read(archive(small(7.0, 45.0, 0.1) + small(9.0, 47.0, 0.1) + small(-170.0, -40.0, 0.1) +
                             small(12.0, 50.0, 1e-4))));
    ASSERT_EQ(_reader.overlays.size(), 4u);
    EXPECT_EQ(_reader.overlays[0].frame, 0u);
    EXPECT_EQ(_reader.overlays[1].frame, 0u);
    EXPECT_EQ(_reader.overlays[2].frame, 1u);
    EXPECT_EQ(_reader.overlays[3].frame, 2u);
    // A later file may share them.
    ASSERT_TRUE(read(archive(small(7.5, 45.5, 0.1), "later.kmz")));
    EXPECT_EQ(_reader.overlays[4].frame, 0u);
    EXPECT_EQ(_reader.frames.size(), 3u);
}

// No matter where a hundred of them lie, seven frames reach all.
TEST_F(OverlayReaderTest, SevenFramesReachAllOfTheGlobe)
{
    std::string features;
    for (int i = 0; i < 100; ++i)
    {
        const double latitude = osg::RadiansToDegrees(std::asin(-1.0 + (2.0 * i + 1.0) / 100.0));
        const double longitude = std::remainder(i * 137.50776, 360.0);
        features += groundOverlay("files/ramp.png",
                                  latLonBox(longitude, latitude, longitude + 0.02, latitude + 0.01));
    }
    ASSERT_TRUE(read(archive(features)));
    EXPECT_EQ(_reader.overlays.size(), 100u);
    EXPECT_LE(_reader.frames.size(), 7u);
    for (const GroundOverlay& each : _reader.overlays)
        for (const osg::Vec2d& corner : each.corners)
            EXPECT_LT(corner.length(), 6378137.0 * std::sin(osg::DegreesToRadians(81.0)));
}

TEST_F(OverlayReaderTest, RastersWithAGeoreferenceComeAsTheyAre)
{
    const std::string file = writeRelief(_folder / "relief.tif", 60, 40, 7.0, 46.0, 0.001);
    ASSERT_TRUE(read(file));
    const GroundOverlay& overlay = _reader.overlays.at(0);
    EXPECT_EQ(overlay.layer->getKind(), DataLayer::VALUE);
    EXPECT_LT(overlay.lowest, overlay.highest);
    const osg::Vec2d corner = placed(_reader, 0, {7.0, 45.96});
    EXPECT_NEAR(overlay.corners[0].x(), corner.x(), 20.0);
    EXPECT_NEAR(overlay.corners[0].y(), corner.y(), 20.0);
    EXPECT_EQ(overlay.name, "relief.tif");
}

TEST_F(OverlayReaderTest, TilesInAnMBTilesFileAreRead)
{
    TestRaster raster(300, 300, 3, GDT_Byte);
    raster.placed(1000000.0, 5700000.0, 76.4, 76.4).crs("EPSG:3857");
    raster.fill([](int column, int, int band) { return band == 0 ? column * 255 / 300 : 60; });
    const std::string file = (_folder / "tiles.mbtiles").string();
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("MBTiles");
    ASSERT_TRUE(driver);
    GDALClose(driver->CreateCopy(file.c_str(), &raster.dataset(), FALSE, nullptr, nullptr, nullptr));
    ASSERT_TRUE(read(file));
    OGRSpatialReference mercator, degrees;
    mercator.importFromEPSG(3857);
    degrees.importFromEPSG(4326);
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> toDegrees(
        OGRCreateCoordinateTransformation(&mercator, &degrees));
    for (const double share : {0.25, 0.5, 0.75})
    {
        double x = 1000000.0 + 300 * 76.4 * share;
        double y = 5700000.0 - 150 * 76.4;
        ASSERT_TRUE(toDegrees->Transform(1, &x, &y));
        EXPECT_NEAR(texelAt(_reader.overlays.at(0), placed(_reader, 0, {x, y}))[0], 255.0 * share, 6.0)
            << share;
    }
}

// A map of the world in tiles of the web, four by four at the level 2, from a server on this machine; each tile's color tells its number.
TEST_F(OverlayReaderTest, TilesOfAWebServerAreRead)
{
    for (int z = 0; z <= 2; ++z)
    {
        for (int x = 0; x < 1 << z; ++x)
        {
            const std::filesystem::path column = _folder / "tiles" / std::to_string(z) / std::to_string(x);
            std::filesystem::create_directories(column);
            for (int y = 0; y < 1 << z; ++y)
                writePicture((column / (std::to_string(y) + ".png")).string(), 256, 256,
                             [&](int, int) {
                                 return std::array<int, 4>{50 + 50 * x, 50 + 50 * y, 60 * z, 255};
                             });
        }
    }
    TestServer server(_folder / "tiles");
    // What a file of the user's says of a service; GDAL's names.
    _folder.write(
        "map.xml",
        "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://" + server.address() +
            "/${z}/${x}/${y}.png</ServerUrl></Service><DataWindow><UpperLeftX>-20037508.34</UpperLeftX>"
            "<UpperLeftY>20037508.34</UpperLeftY><LowerRightX>20037508.34</LowerRightX>"
            "<LowerRightY>-20037508.34</LowerRightY><TileLevel>2</TileLevel><TileCountX>1</TileCountX>"
            "<TileCountY>1</TileCountY><YOrigin>top</YOrigin></DataWindow><Projection>EPSG:3857</Projection>"
            "<BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY><BandsCount>3</BandsCount></GDAL_WMS>");
    ASSERT_TRUE(read((_folder / "map.xml").string()));
    EXPECT_GT(server.requests().size(), 0u);
    ASSERT_EQ(_reader.overlays.size(), 6u) << "it reaches around the globe";
    // The middles of tiles: longitudes in steps of 90 degrees, latitudes by Mercator.
    int found = 0;
    for (int y = 0; y < 4; ++y)
    {
        for (int x = 0; x < 4; ++x)
        {
            const double mercator = osg::PI * (1.0 - 2.0 * (y + 0.5) / 4.0);
            const osg::Vec2d degrees(-180.0 + 90.0 * (x + 0.5),
                                     osg::RadiansToDegrees(std::atan(std::sinh(mercator))));
            for (const GroundOverlay& overlay : _reader.overlays)
            {
                const LocalOrigin& origin = _reader.frames[overlay.frame];
                const double east = osg::DegreesToRadians(degrees.x()) - origin.longitude;
                const double north = osg::DegreesToRadians(degrees.y());
                const double facing = std::sin(north) * std::sin(origin.latitude) +
                                      std::cos(north) * std::cos(origin.latitude) * std::cos(east);
                if (facing < 0.6) continue;
                const std::array<int, 4> texel = texelAt(overlay, placed(_reader, overlay.frame, degrees));
                if (texel[3] == 0) continue;
                ++found;
                EXPECT_NEAR(texel[0], 50 + 50 * x, 2) << degrees.x() << ", " << degrees.y();
                EXPECT_NEAR(texel[1], 50 + 50 * y, 2) << degrees.x() << ", " << degrees.y();
                EXPECT_NEAR(texel[2], 120, 2) << "the finest level";
            }
        }
    }
    EXPECT_GE(found, 16) << "each tile's middle lies in a part";
    // A server that has nothing is told, and leaves no half map.
    server.setFault(TestServer::Fault::Broken);
    OverlayReader other;
    std::string error;
    std::filesystem::copy(_folder / "map.xml", _folder / "again.xml");
    EXPECT_FALSE(other.read((_folder / "again.xml").string(), {}, error));
    EXPECT_NE(error.find("again.xml"), std::string::npos) << error;
}

// A service as it tells of itself (WMTS 1.0.0, RESTful), three by three kilometres at the finest level around 7° east; GDAL's driver reads the document.
TEST_F(OverlayReaderTest, AWmtsServiceIsReadByItsCapabilities)
{
    CPLSetConfigOption("GDAL_DEFAULT_WMS_CACHE_PATH", (_folder / "cache").c_str());
    constexpr int finest = 14;
    constexpr double half = 20037508.342789244; // metres of Web Mercator
    const auto sideOf = [](int level)
    {
        return 2.0 * half / std::pow(2.0, level);
    };
    const osg::Vec2d middle(osg::DegreesToRadians(7.0) * 6378137.0,
                            6378137.0 * std::log(std::tan(osg::PI_4 + osg::DegreesToRadians(45.0) / 2.0)));
    const int column = static_cast<int>((middle.x() + half) / sideOf(finest));
    const int row = static_cast<int>((half - middle.y()) / sideOf(finest));
    std::string matrices;
    for (int level = 10; level <= finest; ++level)
    {
        matrices += "<TileMatrix><ows:Identifier>" + std::to_string(level) +
                    "</ows:Identifier><ScaleDenominator>" +
                    CPLSPrintf("%.10f", sideOf(level) / 256.0 / 0.00028) +
                    "</ScaleDenominator><TopLeftCorner>-20037508.342789 20037508.342789</TopLeftCorner>"
                    "<TileWidth>256</TileWidth><TileHeight>256</TileHeight><MatrixWidth>" +
                    std::to_string(1 << level) + "</MatrixWidth><MatrixHeight>" + std::to_string(1 << level) +
                    "</MatrixHeight></TileMatrix>";
        const int shift = finest - level;
        for (int x = (column - 1) >> shift; x <= (column + 1) >> shift; ++x)
        {
            for (int y = (row - 1) >> shift; y <= (row + 1) >> shift; ++y)
            {
                const std::filesystem::path folder =
                    _folder / "served" / std::to_string(level) / std::to_string(x);
                std::filesystem::create_directories(folder);
                writePicture((folder / (std::to_string(y) + ".png")).string(), 256, 256,
                             [&](int, int) {
                                 return std::array<int, 4>{50 + 50 * (x - column + 1),
                                                           50 + 50 * (y - row + 1), 10 * level, 255};
                             });
            }
        }
    }
    TestServer server(_folder / "served");
    const auto cornerOf = [&](int x, int y)
    {
        return osg::Vec2d(
            osg::RadiansToDegrees((sideOf(finest) * x - half) / 6378137.0),
            osg::RadiansToDegrees(std::atan(std::sinh((half - sideOf(finest) * y) / 6378137.0))));
    };
    const osg::Vec2d low = cornerOf(column - 1, row + 2), high = cornerOf(column + 2, row - 1);
    const auto document = [&](const std::string& more)
    {
        return R"(<?xml version="1.0"?><Capabilities xmlns="http://www.opengis.net/wmts/1.0" version="1.0.0"
 xmlns:ows="http://www.opengis.net/ows/1.1" xmlns:xlink="http://www.w3.org/1999/xlink"><Contents><Layer><ows:Title>Test</ows:Title>
 <ows:Identifier>test</ows:Identifier><ows:WGS84BoundingBox><ows:LowerCorner>)" +
               std::string(CPLSPrintf("%.9f %.9f</ows:LowerCorner><ows:UpperCorner>%.9f %.9f", low.x(),
                                      low.y(), high.x(), high.y())) +
               R"(</ows:UpperCorner></ows:WGS84BoundingBox><Style isDefault="true"><ows:Identifier>default</ows:Identifier></Style>
 <Format>image/png</Format><TileMatrixSetLink><TileMatrixSet>web</TileMatrixSet></TileMatrixSetLink><ResourceURL format="image/png"
 resourceType="tile" template="http://)" +
               server.address() +
               R"(/{TileMatrix}/{TileCol}/{TileRow}.png"/></Layer><TileMatrixSet><ows:Identifier>web</ows:Identifier>
 <ows:SupportedCRS>urn:ogc:def:crs:EPSG::3857</ows:SupportedCRS>)" +
               matrices + "</TileMatrixSet></Contents>" + more + "</Capabilities>";
    };
    const std::string saved = _folder.write("service.xml", document(""));
    _folder.write("served/caps.xml", document(""));
    // By the address, and as a document that a person has saved.
    for (const std::string& file : {"WMTS:http://" + server.address() + "/caps.xml", saved})
    {
        SCOPED_TRACE(file);
        _reader = OverlayReader();
        server.forgetRequests();
        ASSERT_TRUE(read(file));
        ASSERT_EQ(_reader.overlays.size(), 1u);
        for (int y = -1; y <= 1; ++y)
        {
            for (int x = -1; x <= 1; ++x)
            {
                const osg::Vec2d corner = cornerOf(column + x, row + y),
                                 next = cornerOf(column + x + 1, row + y + 1);
                // A tenth of a tile from the corner, and the middle.
                for (const double share : {0.1, 0.5, 0.9})
                {
                    const std::array<int, 4> texel =
                        texelAt(_reader.overlays[0], placed(_reader, 0, corner + (next - corner) * share));
                    EXPECT_NEAR(texel[0], 100 + 50 * x, 2) << x << " " << y;
                    EXPECT_NEAR(texel[1], 100 + 50 * y, 2) << x << " " << y;
                    EXPECT_NEAR(texel[2], 10 * finest, 2);
                    EXPECT_EQ(texel[3], 255);
                }
            }
        }
    }
    EXPECT_FALSE(std::filesystem::exists("gdalwmscache")) << "in the folder that the program runs in";
    // What is wrong is told with the name; nothing of it is shown.
    _reader = OverlayReader();
    const std::string address = "WMTS:http://" + server.address();
    EXPECT_TRUE(contains(faultOf(address + "/none.xml"), "none.xml: ")) << "404";
    _folder.write("served/broken.xml", document("<a>"));
    EXPECT_TRUE(contains(faultOf(address + "/broken.xml"), "broken.xml: "));
    EXPECT_TRUE(contains(faultOf(_folder.write("cut.xml", document("").substr(0, 900))), "cut.xml: "));
    server.stop();
    EXPECT_TRUE(contains(faultOf(address + "/caps.xml"), "caps.xml: ")) << "nobody answers";
    CPLSetConfigOption("GDAL_DEFAULT_WMS_CACHE_PATH", nullptr);
}

TEST_F(OverlayReaderTest, WhatIsNoPictureIsRefused)
{
    EXPECT_TRUE(contains(faultOf(archive(groundOverlay("files/none.png", latLonBox(7.0, 45.0, 8.0, 46.0)))),
                         "over.kmz/doc.kml:2: \"files/none.png\" is not there"));
    EXPECT_TRUE(contains(faultOf((_folder / "none.tif").string()), "none.tif"));
    // A format that names further files.
    _folder.write(
        "a.vrt",
        "<VRTDataset rasterXSize=\"1\" rasterYSize=\"1\"><VRTRasterBand dataType=\"Byte\" band=\"1\">"
        "<SimpleSource><SourceFilename>/etc/passwd</SourceFilename></SimpleSource>"
        "</VRTRasterBand></VRTDataset>");
    EXPECT_TRUE(contains(
        faultOf(
            _folder.write("doc.kml", kml(groundOverlay("a.vrt", latLonBox(7.0, 45.0, 8.0, 46.0)))).string()),
        "a.vrt: it is not there, or no PNG"));
}

// GDAL opens what a picture's sidecars name, whatever its format, when it reads a picture at a lower resolution.
TEST_F(OverlayReaderTest, SidecarsOfPicturesOpenNothing)
{
    const auto red = [](int, int)
    {
        return std::array<int, 4>{255, 0, 0, 255};
    };
    writePicture((_folder / "secret.tif").string(), 128, 128, red, "GTiff");
    const std::string secret = (_folder / "secret.tif").string();
    const std::string virtualSecret =
        "<VRTDataset rasterXSize=\"128\" rasterYSize=\"128\"><VRTRasterBand dataType=\"Byte\" "
        "band=\"1\"><SimpleSource><SourceFilename>" +
        secret + "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>";
    const std::string metadata = "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" +
                                 secret + "</MDI></Metadata></PAMDataset>";
    std::filesystem::create_directories(_folder / "inner");
    OverlayReader::Options options;
    options.maxSide = 128;
    for (const std::string sidecar : {".aux.xml", ".ovr"})
    {
        for (const std::string format : {"PNG", "GTiff"})
        {
            SCOPED_TRACE(format + sidecar);
            const std::filesystem::path picture = _folder / "inner" / ("x." + format);
            writePicture(picture.string(), 256, 256, ramp, format.c_str());
            const std::string text = sidecar == ".aux.xml" ? metadata : virtualSecret;
            _folder.write("inner/x." + format + sidecar, text);
            const std::string features =
                groundOverlay("x." + format, latLonBox(7.0, 45.0, 7.01, 45.006)); // small: not warped
            const std::string file = _folder.write("inner/doc.kml", kml(features)).string();
            const std::string archived = (_folder / "inner/over.kmz").string();
            writeArchive(archived, {{"doc.kml", kml(features)},
                                    {"x." + format, bytesOf(picture.string())},
                                    {"x." + format + sidecar, text}});
            for (const std::string& each : {file, archived})
            {
                _reader = OverlayReader();
                ASSERT_TRUE(read(each, options));
                const GroundOverlay& overlay = _reader.overlays.at(0);
                ASSERT_EQ(overlay.layer->getImage()->s(), 128);
                const std::array<int, 4> texel = texelAt(overlay, placed(_reader, 0, {7.005, 45.003}));
                EXPECT_NEAR(texel[0], 128, 3);
                EXPECT_EQ(texel[2], 77);
                EXPECT_EQ(texel[3], 255);
            }
            std::filesystem::remove(picture.string() + sidecar);
        }
    }
    // A TIFF may name the file in itself.
    const std::string own = (_folder / "inner/own.tif").string();
    writePicture(own, 256, 256, ramp, "GTiff");
    GDALDataset* const dataset = GDALDataset::Open(own.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE);
    ASSERT_TRUE(dataset);
    dataset->SetMetadataItem("OVERVIEW_FILE", secret.c_str(), "OVERVIEWS");
    GDALClose(dataset);
    _reader = OverlayReader();
    EXPECT_TRUE(contains(
        faultOf(
            _folder.write("inner/doc.kml", kml(groundOverlay("own.tif", latLonBox(7.0, 45.0, 7.01, 45.006))))
                .string()),
        "own.tif: it names another file"));
}

// A header that promises 10^5 x 10^5 pixels, with and without pixels behind it; and one that is cut off.
TEST_F(OverlayReaderTest, LyingPicturesCostNothing)
{
    const std::string picture = (_folder / "ramp.png").string();
    writePicture(picture, 256, 256, ramp);
    const std::string whole = bytesOf(picture);
    const auto withSize = [&](std::uint32_t width, std::uint32_t height)
    {
        std::string bytes = whole;
        for (int i = 0; i < 4; ++i)
        {
            bytes[16 + static_cast<std::size_t>(i)] = static_cast<char>(width >> (24 - 8 * i));
            bytes[20 + static_cast<std::size_t>(i)] = static_cast<char>(height >> (24 - 8 * i));
        }
        // The header's check sum, bit by bit.
        std::uint32_t sum = ~0u;
        for (std::size_t i = 12; i < 29; ++i)
        {
            sum ^= static_cast<unsigned char>(bytes[i]);
            for (int bit = 0; bit < 8; ++bit)
                sum = sum >> 1 ^ (sum & 1u ? 0xedb88320u : 0u);
        }
        sum = ~sum;
        for (int i = 0; i < 4; ++i)
            bytes[29 + static_cast<std::size_t>(i)] = static_cast<char>(sum >> (24 - 8 * i));
        return bytes;
    };
    const auto faultOfPicture = [&](const std::string& bytes)
    {
        _folder.write("lying.png", bytes);
        return faultOf(
            _folder.write("doc.kml", kml(groundOverlay("lying.png", latLonBox(7.0, 45.0, 8.0, 46.0))))
                .string());
    };
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    const std::string huge = faultOfPicture(withSize(100000, 100000));
    EXPECT_TRUE(contains(huge, "lying.png: it says that it has 100000 × 100000 pixels")) << huge;
    EXPECT_TRUE(contains(huge, "gdaladdo")) << huge;
    const std::string lying = faultOfPicture(withSize(30000, 30000));
    EXPECT_TRUE(contains(lying, "lying.png: its pixels cannot be read")) << lying;
    const std::string cut = faultOfPicture(whole.substr(0, whole.size() / 2));
    EXPECT_TRUE(contains(cut, "lying.png")) << cut;
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 128 * 1024) << "KiB";
}

TEST_F(OverlayReaderTest, PicturesOfOneHugeBlockAreRefused)
{
    // GDAL reads a TIFF of one strip by its rows, but not one of two.
    const std::string file = (_folder / "strip.tif").string();
    CPLStringList creation;
    for (const char* const option : {"COMPRESS=DEFLATE", "SPARSE_OK=TRUE", "BLOCKYSIZE=25000"})
        creation.AddString(option);
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDataset* const dataset = driver->Create(file.c_str(), 30000, 30000, 1, GDT_Byte, creation.List());
    ASSERT_TRUE(dataset);
    GDALClose(dataset);
    const std::string fault = faultOf(
        _folder.write("doc.kml", kml(groundOverlay("strip.tif", latLonBox(7.0, 45.0, 8.0, 46.0)))).string());
    EXPECT_TRUE(contains(fault, "strip.tif: its pixels lie in blocks of 30000 × 25000")) << fault;
}

TEST_F(OverlayReaderTest, ARasterAroundTheGlobeMayBeOfFewTexels)
{
    OverlayReader::Options options;
    options.maxSide = 8;
    EXPECT_TRUE(
        read(archive(groundOverlay("files/ramp.png", latLonBox(-180.0, -90.0, 180.0, 90.0))), options));
}

namespace
{

/// Places all over the globe, degrees.
std::vector<osg::Vec2d> allOver(int count)
{
    std::vector<osg::Vec2d> places;
    for (int i = 0; i < count; ++i)
        places.emplace_back(std::remainder(137.507764 * i, 360.0),
                            osg::RadiansToDegrees(std::asin(1.0 - (2.0 * i + 1.0) / count)));
    return places;
}

/// Where a place lies in an overlay's frame; empty on the far side of the globe.
std::optional<osg::Vec2d> placedIn(const OverlayReader& reader, const GroundOverlay& overlay,
                                   const osg::Vec2d& degrees)
{
    const LocalOrigin& origin = reader.frames[overlay.frame];
    const double east = osg::DegreesToRadians(degrees.x()) - origin.longitude,
                 north = osg::DegreesToRadians(degrees.y());
    if (std::sin(north) * std::sin(origin.latitude) +
            std::cos(north) * std::cos(origin.latitude) * std::cos(east) <
        0.3)
        return std::nullopt;
    std::string error;
    static std::map<std::pair<double, double>, std::function<std::optional<osg::Vec2d>(const osg::Vec2d&)>>
        placers;
    auto& placer = placers[{origin.longitude, origin.latitude}];
    MappingFrame frame;
    frame.origin = origin;
    if (!placer) placer = OverlayRaster::placer(frame, "test");
    return placer(degrees);
}

float valueAt(const GroundOverlay& overlay, const osg::Vec2d& place)
{
    const osg::Image& image = *overlay.layer->getImage();
    const osg::Vec2d low = overlay.corners[0], size = overlay.corners[2] - low;
    const double u = (place.x() - low.x()) / size.x(), v = (place.y() - low.y()) / size.y();
    if (!(u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0)) return std::numeric_limits<float>::quiet_NaN();
    return *reinterpret_cast<const float*>(
        image.data(static_cast<unsigned int>(u * image.s()), static_cast<unsigned int>(v * image.t())));
}

} // namespace

// Grids of climate and weather models: the first and the last row of cells lie half beyond the poles.
TEST_F(OverlayReaderTest, GridsCentredOnThePolesReachThem)
{
    for (const double west : {-0.5, -180.5})
    {
        SCOPED_TRACE(west);
        _reader = OverlayReader();
        TestRaster grid(360, 181);
        grid.placed(west, 90.5, 1.0, 1.0).crs("EPSG:4326").fill([](int, int row, int) { return 90.0 - row; });
        ASSERT_TRUE(read(grid.write(_folder / "grid.tif")));
        ASSERT_EQ(_reader.overlays.size(), 6u);
        EXPECT_NEAR(_reader.overlays[0].lowest, -90.0, 0.5);
        EXPECT_NEAR(_reader.overlays[0].highest, 90.0, 0.5);
        int parts = 0;
        constexpr int count = 2000;
        for (const osg::Vec2d& degrees : allOver(count))
        {
            int here = 0;
            for (const GroundOverlay& overlay : _reader.overlays)
            {
                const std::optional<osg::Vec2d> place = placedIn(_reader, overlay, degrees);
                const float value =
                    place ? valueAt(overlay, *place) : std::numeric_limits<float>::quiet_NaN();
                if (std::isnan(value)) continue;
                ++here;
                EXPECT_NEAR(value, degrees.y(), 0.3) << degrees.x() << ", " << degrees.y();
            }
            EXPECT_GE(here, 1) << degrees.x() << ", " << degrees.y();
            parts += here;
        }
        EXPECT_LT(parts, 1.02 * count) << "a part of the globe is drawn twice";
    }
}

// A map of the world is paged as other large rasters are, by its overviews.
TEST_F(OverlayReaderTest, ALargeMapOfTheWorldHasTiles)
{
    constexpr int columns = 8192, rows = 4096;
    TestRaster world(columns, rows, 3, GDT_Byte);
    world.placed(-180.0, 90.0, 360.0 / columns, 180.0 / rows).crs("EPSG:4326");
    world.fill(
        [](int column, int row, int band) {
            return band == 0 ? column * 255.0 / columns : band == 1 ? row * 255.0 / rows : column % 2 * 255.0;
        });
    const std::string file = world.write(_folder / "world.tif", {"TILED=YES", "COMPRESS=DEFLATE"});
    {
        const std::unique_ptr<GDALDataset> dataset(
            GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        std::array<int, 3> factors{2, 4, 8};
        ASSERT_EQ(dataset->BuildOverviews("AVERAGE", 3, factors.data(), 0, nullptr, nullptr, nullptr),
                  CE_None);
    }
    OverlayReader::Options options;
    options.paged = true;
    options.maxSide = 1024;
    ASSERT_TRUE(read(file, options));
    EXPECT_TRUE(_reader.notices.empty());
    ASSERT_EQ(_reader.overlays.size(), 6u);
    for (const GroundOverlay& overlay : _reader.overlays)
    {
        ASSERT_TRUE(overlay.tiles);
        EXPECT_LE(overlay.layer->getImage()->s(), 512) << "a coarse picture beside the tiles";
    }
    for (const osg::Vec2d& degrees : allOver(12))
    {
        SCOPED_TRACE(std::to_string(degrees.x()) + ", " + std::to_string(degrees.y()));
        int shown = 0;
        for (const GroundOverlay& overlay : _reader.overlays)
        {
            const std::optional<osg::Vec2d> place = placedIn(_reader, overlay, degrees);
            if (!place) continue;
            std::string error;
            const double texel = overlay.tiles->texel() / 4.0;
            const osg::Vec2d half(texel / 2.0, texel / 2.0);
            const osg::ref_ptr<osg::Image> image =
                overlay.tiles->read(*place - half, *place + half, 1, 1, error);
            ASSERT_TRUE(image) << error;
            const unsigned char* const color = image->data();
            if (color[3] == 0) continue;
            ++shown;
            EXPECT_NEAR(color[0], (degrees.x() + 180.0) / 360.0 * 255.0, 1.5);
            EXPECT_NEAR(color[1], (90.0 - degrees.y()) / 180.0 * 255.0, 1.5);
        }
        EXPECT_EQ(shown, 1);
    }
    // What an overview would have made grey.
    const GroundOverlay& front = _reader.overlays[0];
    std::string error;
    const double texel = front.tiles->texel();
    const osg::ref_ptr<osg::Image> row = front.tiles->read({0.0, 0.0}, {8.0 * texel, texel}, 32, 4, error);
    ASSERT_TRUE(row) << error;
    int least = 255, most = 0;
    for (unsigned int i = 0; i < 32; ++i)
    {
        least = std::min<int>(least, row->data(i, 1)[2]);
        most = std::max<int>(most, row->data(i, 1)[2]);
    }
    EXPECT_GT(most - least, 180);
}

TEST_F(OverlayReaderTest, WhatDoesNotFitIsLeftOutAndTold)
{
    std::string features;
    // Each has a picture of its own for its color.
    for (int i = 1; i <= 6; ++i)
        features += groundOverlay("files/ramp.png", latLonBox(7.0, 45.0, 7.01, 45.006),
                                  "<color>ff00000" + std::to_string(i) + "</color>");
    OverlayReader::Options options;
    options.maxTexels = 2.5 * 256 * 256;
    ASSERT_TRUE(read(archive(features), options));
    EXPECT_EQ(_reader.overlays.size(), 3u);
    ASSERT_EQ(_reader.notices.size(), 1u);
    EXPECT_TRUE(contains(_reader.notices[0], "3 of its 6 ground overlays are left out"))
        << _reader.notices[0];
}
