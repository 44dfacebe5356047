// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_render with --mapping, as a person calls it: archives and rasters that GDAL writes, on a piece of the globe.
#include <tools/GlFixture.h>
#include <tools/KmlFiles.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>
#include <tools/TestServer.h>
#include <tools/WebTiles.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace geofx::test;

namespace
{

constexpr int width = 200, height = 150;

class MappingProgram : public GlFixture
{
protected:
    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        writeGround();
        writePicture((_folder / "red.png").string(), 16, 16,
                     [](int, int) {
                         return std::array<int, 4>{255, 0, 0, 255};
                     });
    }

    /// A dark square around 7° east, 45° north, so many degrees wide, in pieces of a twentieth of a degree: their boxes are those of tiles.
    void writeGround(double size = 0.1) const
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> node =
            new osg::CoordinateSystemNode("WKT", "EPSG:4326");
        node->setEllipsoidModel(new osg::EllipsoidModel);
        constexpr double piece = 0.05;
        const int pieces = static_cast<int>(std::lround(size / piece));
        for (int i = 0; i < pieces * pieces; ++i)
            node->addChild(makeGround(7.0 - size / 2.0 + piece * (i % pieces),
                                      45.0 - size / 2.0 + piece * (i / pieces), piece));
        node->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        osgDB::writeNodeFile(*node, (_folder / "ground.osgt").string());
    }

    /// A piece, by its south-western corner and its width, degrees.
    static osg::ref_ptr<osg::Node> makeGround(double west, double south, double size)
    {
        const osg::EllipsoidModel earth;
        const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        const osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
        const auto placeAt = [&](double east, double north)
        {
            osg::Vec3d place;
            earth.convertLatLongHeightToXYZ(osg::DegreesToRadians(south + north * size),
                                            osg::DegreesToRadians(west + east * size), 0.0, place.x(),
                                            place.y(), place.z());
            return place;
        };
        // Its own box must be level, as a tile's.
        osg::Matrixd toWorld;
        earth.computeLocalToWorldTransformFromLatLongHeight(osg::DegreesToRadians(south + 0.5 * size),
                                                            osg::DegreesToRadians(west + 0.5 * size), 0.0,
                                                            toWorld);
        const osg::Matrixd toPiece = osg::Matrixd::inverse(toWorld);
        constexpr int cells = 10;
        // Pieces overlap, so that no crack shows between them.
        const auto share = [](int cell)
        {
            return 1.01 * cell / cells - 0.005;
        };
        for (int i = 0; i < (cells + 1) * (cells + 1); ++i)
        {
            const int column = i % (cells + 1), row = i / (cells + 1);
            vertices->push_back(osg::Vec3(placeAt(share(column), share(row)) * toPiece));
            if (column == cells || row == cells) continue;
            for (const int corner : {i, i + 1, i + cells + 2, i, i + cells + 2, i + cells + 1})
                triangles->push_back(static_cast<GLushort>(corner));
        }
        const osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
        const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array;
        color->push_back({0.1f, 0.1f, 0.1f, 1.0f});
        ground->setVertexArray(vertices);
        ground->setColorArray(color, osg::Array::BIND_OVERALL);
        ground->addPrimitiveSet(triangles);
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(toWorld);
        place->addChild(ground);
        return place;
    }

    ProgramResult run(std::vector<std::string> arguments, const std::string& scene = "ground.osgt") const
    {
        const auto addUnless = [&](const std::string& option, const std::string& value)
        {
            if (std::find(arguments.begin(), arguments.end(), option) == arguments.end())
                arguments.insert(arguments.end(), {option, value});
        };
        addUnless("--size", std::to_string(width) + "x" + std::to_string(height));
        addUnless("--view", "7,45,5000,0,-90");
        addUnless("-o", "out.png");
        arguments.insert(arguments.begin(), {builtProgram("osggeofx_render"), scene});
        ProgramOptions options;
        options.folder = _folder.path().string();
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8",
                               "XDG_CACHE_HOME=" + (_folder / "cache").string()};
        return runProgram(arguments, options);
    }

    /// Where the picture is red: the columns and rows from the upper left, and how many pixels.
    struct Red
    {
        int left = width, right = -1, top = height, bottom = -1, count = 0;
        double middleX() const { return (left + right) / 2.0; }
    };
    Red redOf(const std::vector<std::string>& arguments, const std::string& from = "ground.osgt") const
    {
        const ProgramResult result = run(arguments, from);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        EXPECT_EQ(result.standardError, "");
        const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile((_folder / "out.png").string());
        Red red;
        for (int i = 0; image && i < width * height; ++i)
        {
            const int x = i % width, y = i / width;
            const unsigned char* const pixel =
                image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(height - 1 - y));
            if (!(pixel[0] > 200 && pixel[1] < 60 && pixel[2] < 60)) continue;
            red.left = std::min(red.left, x);
            red.right = std::max(red.right, x);
            red.top = std::min(red.top, y);
            red.bottom = std::max(red.bottom, y);
            ++red.count;
        }
        return red;
    }

    void expectRefusal(const std::vector<std::string>& arguments, const std::string& word) const
    {
        std::filesystem::remove(_folder / "out.png");
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 2) << result.standardError;
        EXPECT_NE(result.standardError.find(word), std::string::npos) << result.standardError;
        EXPECT_EQ(std::count(result.standardError.begin(), result.standardError.end(), '\n'), 1)
            << result.standardError;
        EXPECT_FALSE(std::filesystem::exists(_folder / "out.png"));
    }

    TempDir _folder;
};

/// Tiles of the world whose color tells their level, in stripes of eight pixels.
std::optional<std::string> stripedTile(const std::string& name)
{
    static const std::vector<std::string> tiles = []
    {
        std::vector<std::string> made;
        for (int level = 0; level <= 18; ++level)
            made.push_back(pngTile(
                [&](int x, int) {
                    return std::array<int, 4>{12 * level, x / 8 % 2 == 0 ? 250 : 5, 128, 255};
                }));
        return made;
    }();
    const std::optional<WebTile> tile = WebTile::parse(name);
    if (!tile || tile->level < 0 || tile->level > 18) return std::nullopt;
    return tiles[static_cast<std::size_t>(tile->level)];
}

} // namespace

// From 5 km above, a pixel spans about 18 m, and the box is 0.01° wide: 43 pixels, and 62 high.
TEST_F(MappingProgram, AnArchiveIsInThePicture)
{
    EXPECT_EQ(redOf({}).count, 0);
    writeArchive((_folder / "over.kmz").string(),
                 {{"doc.kml", kml(groundOverlay("a.png", latLonBox(6.995, 44.995, 7.005, 45.005)))},
                  {"a.png", bytesOf((_folder / "red.png").string())}});
    const Red red = redOf({"--mapping", "over.kmz"});
    EXPECT_NEAR(red.middleX(), width / 2 - 0.5, 1.0);
    EXPECT_NEAR((red.top + red.bottom) / 2.0, height / 2 - 0.5, 1.0);
    EXPECT_NEAR((red.bottom - red.top + 1.0) / (red.right - red.left + 1.0),
                1.0 / std::cos(osg::DegreesToRadians(45.0)), 0.1);
    EXPECT_NEAR(red.count, 43 * 62, 300);
}

TEST_F(MappingProgram, RastersHaveColorsByTables)
{
    TestRaster raster(40, 40, 1, GDT_Float32);
    raster.placed(6.995, 45.005, 0.00025, 0.00025)
        .crs("EPSG:4326")
        .fill([](int column, int, int) { return column; });
    raster.write(_folder / "values.tif");
    _folder.write(
        "right.sld",
        R"(<StyledLayerDescriptor xmlns="http://www.opengis.net/sld"><NamedLayer><UserStyle><FeatureTypeStyle>
        <Rule><RasterSymbolizer><ColorMap type="intervals"><ColorMapEntry color="#0000ff" quantity="20"/>
        <ColorMapEntry color="#ff0000" quantity="100"/></ColorMap></RasterSymbolizer></Rule>
        </FeatureTypeStyle></UserStyle></NamedLayer></StyledLayerDescriptor>)");
    _folder.write("left.txt", "0 255 0 0\n19.9 255 0 0\n20 0 0 255\n40 0 0 255\n");
    EXPECT_EQ(redOf({"--mapping", "values.tif"}).count, 0) << "greys";
    const Red right = redOf({"--mapping", "values.tif", "--colors", "right.sld"});
    EXPECT_NEAR(right.left, width / 2, 2);
    EXPECT_NEAR(right.count, 43 * 62 / 2, 250);
    const Red left = redOf({"--mapping", "values.tif", "--colors", "left.txt"});
    EXPECT_NEAR(left.right, width / 2, 2);
    EXPECT_NEAR(left.count, 43 * 62 / 2, 250);
    // The later file lies on top.
    writePicture((_folder / "a.png").string(), 8, 8,
                 [](int, int) {
                     return std::array<int, 4>{0, 0, 255, 255};
                 });
    _folder.write("blue.kml", kml(groundOverlay("a.png", latLonBox(6.99, 44.99, 7.01, 45.01))));
    _folder.write("red.kml", kml(groundOverlay("red.png", latLonBox(6.995, 44.995, 7.005, 45.005))));
    EXPECT_EQ(redOf({"--mapping", "red.kml", "--mapping", "blue.kml"}).count, 0);
    EXPECT_NEAR(redOf({"--mapping", "blue.kml", "--mapping", "red.kml"}).count, 43 * 62, 300);
}

// A picture of 12 bits and more is dark in bytes. Its numbers are told, or set.
TEST_F(MappingProgram, PicturesOfSatellitesAreStretched)
{
    TestRaster raster(40, 40, 4, GDT_UInt16);
    raster.placed(6.995, 45.005, 0.00025, 0.00025)
        .crs("EPSG:4326")
        .fill([](int column, int, int band) { return band == 2 && column >= 20 ? 2000.0 : 400.0; });
    for (const auto& [band, color] :
         {std::pair{1, GCI_BlueBand}, {2, GCI_GreenBand}, {3, GCI_RedBand}, {4, GCI_Undefined}})
        raster.dataset().GetRasterBand(band)->SetColorInterpretation(color);
    raster.write(_folder / "planet.tif");
    const ProgramResult told = run({"--mapping", "planet.tif"});
    EXPECT_EQ(told.exitCode, 0);
    EXPECT_NE(
        told.standardError.find("planet.tif: its numbers from 400 to 2000 (2 to 98 % of them) are shown"),
        std::string::npos)
        << told.standardError;
    EXPECT_EQ(std::count(told.standardError.begin(), told.standardError.end(), '\n'), 1)
        << told.standardError;
    const Red set = redOf({"--mapping", "planet.tif", "--stretch", "400,2000"});
    EXPECT_NEAR(set.left, width / 2, 2);
    EXPECT_NEAR(set.count, 43 * 62 / 2, 250);
    EXPECT_EQ(redOf({"--mapping", "planet.tif", "--stretch", "0,65535"}).count, 0) << "dark";
    expectRefusal({"--mapping", "planet.tif", "--stretch", "400"}, "--stretch: \"400\" is not LOW,HIGH");
    expectRefusal({"--stretch", "0,1"}, "--stretch is for pictures");
}

// A line from west to east north of the middle, as a GPX track; KML lines have a color of their own.
TEST_F(MappingProgram, WaysAreInThePicture)
{
    const std::string gpx =
        R"(<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>
        <trkpt lat="45.003" lon="6.99"/><trkpt lat="45.003" lon="7.01"/></trkseg></trk></gpx>)";
    _folder.write("way.gpx", gpx);
    EXPECT_EQ(redOf({"--route", "way.gpx", "--route-width", "100"}).count, 0) << "blue";
    _folder.write("way.kml",
                  kml("<Placemark><Style><LineStyle><color>ff0000ff</color></LineStyle></Style><LineString>"
                      "<coordinates>6.99,45.003,0 7.01,45.003,0</coordinates></LineString></Placemark>"));
    const Red red = redOf({"--route", "way.kml", "--route-width", "100"});
    // 0.003° of latitude are 333.4 m, and 0.02° of longitude 1577 m.
    const double pixel = 2.0 * 5000.0 * std::tan(osg::DegreesToRadians(15.0)) / height;
    EXPECT_NEAR((red.top + red.bottom) / 2.0, height / 2 - 0.5 - 333.4 / pixel, 1.0);
    EXPECT_NEAR(red.bottom - red.top + 1.0, 100.0 / pixel, 1.1);
    EXPECT_NEAR(red.middleX(), width / 2 - 0.5, 1.0);
    EXPECT_NEAR(red.right - red.left + 1.0, (1577.0 + 100.0) / pixel, 3.0);
    // A way lies over the rasters.
    _folder.write("blue.kml",
                  kml(groundOverlay("", latLonBox(6.98, 44.98, 7.02, 45.02), "<color>ffff0000</color>")));
    EXPECT_NEAR(redOf({"--route", "way.kml", "--route-width", "100", "--mapping", "blue.kml"}).count,
                red.count, 40);
    // By default a 120th of its extent: less than a pixel.
    EXPECT_LT(redOf({"--route", "way.kml"}).count, red.count / 5);
}

// Areas, lines and points of vector data: where they lie, by a style file beside them, by one of the option, and in a scene file.
TEST_F(MappingProgram, VectorDataAreInThePicture)
{
    const double pixel = 2.0 * 5000.0 * std::tan(osg::DegreesToRadians(15.0)) / height;
    const auto feature = [](const std::string& type, const std::string& coordinates, const std::string& kind)
    {
        return R"({"type":"Feature","properties":{"kind":")" + kind + R"("},"geometry":{"type":")" + type +
               R"(","coordinates":)" + coordinates + "}}";
    };
    const auto collection = [](const std::string& features)
    {
        return R"({"type":"FeatureCollection","features":[)" + features + "]}";
    };
    const auto sld = [](const std::string& rules)
    {
        return R"(<StyledLayerDescriptor xmlns="http://www.opengis.net/sld" xmlns:ogc="http://www.opengis.net/ogc"><NamedLayer><UserStyle>
        <FeatureTypeStyle>)" +
               rules + "</FeatureTypeStyle></UserStyle></NamedLayer></StyledLayerDescriptor>";
    };
    const std::string red = "<Fill><CssParameter name=\"fill\">#ff0000</CssParameter></Fill>";
    const std::string area = "<Rule><PolygonSymbolizer>" + red + "</PolygonSymbolizer></Rule>";
    // 0.01 degrees a side, with a hole of half of that in its middle.
    _folder.write(
        "area.geojson",
        collection(
            feature("Polygon",
                    "[[[6.995,44.995],[7.005,44.995],[7.005,45.005],[6.995,45.005],[6.995,44.995]],"
                    "[[6.9975,44.9975],[7.0025,44.9975],[7.0025,45.0025],[6.9975,45.0025],[6.9975,44.9975]]]",
                    "a")));
    EXPECT_EQ(redOf({"--mapping", "area.geojson"}).count, 0) << "plain colors";
    _folder.write("area.sld", sld(area));
    const Red ring = redOf({"--mapping", "area.geojson"});
    const double metresX = 788.5, metresY = 1111.3;
    EXPECT_NEAR(ring.right - ring.left + 1.0, metresX / pixel, 1.0);
    EXPECT_NEAR(ring.bottom - ring.top + 1.0, metresY / pixel, 1.0);
    EXPECT_NEAR(ring.middleX(), width / 2 - 0.5, 0.6);
    EXPECT_NEAR((ring.top + ring.bottom) / 2.0, height / 2 - 0.5, 0.6);
    EXPECT_NEAR(ring.count, 0.75 * metresX * metresY / pixel / pixel, 70);
    // A line of 60 m and a point of 20 pixels, of one file of two kinds.
    _folder.write("both.geojson", collection(feature("LineString", "[[6.99,45.003],[7.01,45.003]]", "line") +
                                             "," + feature("Point", "[7.0,44.997]", "point")));
    const std::string filter =
        "<ogc:Filter><ogc:PropertyIsEqualTo><ogc:PropertyName>kind</ogc:PropertyName><ogc:Literal>";
    const std::string end = "</ogc:Literal></ogc:PropertyIsEqualTo></ogc:Filter>";
    _folder.write(
        "line.sld",
        sld("<Rule>" + filter + "line" + end +
            "<LineSymbolizer uom=\"http://www.opengeospatial.org/se/units/metre\"><Stroke><CssParameter "
            "name=\"stroke\">#ff0000</CssParameter><CssParameter "
            "name=\"stroke-width\">100</CssParameter></Stroke>"
            "</LineSymbolizer></Rule>"));
    const Red line = redOf({"--mapping", "both.geojson", "--mapping-style", "line.sld"});
    EXPECT_NEAR((line.top + line.bottom) / 2.0, height / 2 - 0.5 - 333.4 / pixel, 1.0);
    EXPECT_NEAR(line.bottom - line.top + 1.0, 100.0 / pixel, 1.1);
    EXPECT_NEAR(line.right - line.left + 1.0, 1577.0 / pixel, 2.0);
    _folder.write("point.sld", sld("<Rule>" + filter + "point" + end +
                                   "<PointSymbolizer><Graphic><Mark><WellKnownName>square</WellKnownName>" +
                                   red + "</Mark><Size>20</Size></Graphic></PointSymbolizer></Rule>"));
    const Red point = redOf({"--mapping", "both.geojson", "--mapping-style", "point.sld"});
    EXPECT_NEAR(point.middleX(), width / 2 - 0.5, 1.0);
    EXPECT_NEAR((point.top + point.bottom) / 2.0, height / 2 - 0.5 + 333.4 / pixel, 1.0);
    EXPECT_NEAR(point.right - point.left + 1.0, 20.0, 2.0);
    EXPECT_NEAR(point.bottom - point.top + 1.0, 20.0, 2.0);
    expectRefusal({"--mapping", "both.geojson:roads", "--mapping-style", "point.sld"}, "no layer \"roads\"");
    expectRefusal({"--mapping-style", "point.sld"}, "--mapping-style is for vector data");
    // The same in scene files.
    const auto scene = [&](const std::string& overlays)
    {
        _folder.write("scene.geofx",
                      "<geofx version=\"1\"><terrain><database file=\"ground.osgt\"/></terrain><effects>"
                      "<projectiveMappings><overlays " +
                          overlays + "/></projectiveMappings></effects></geofx>");
        return redOf({}, "scene.geofx");
    };
    EXPECT_NEAR(scene("file=\"area.geojson\" layer=\"area\"").count, ring.count, 3);
    EXPECT_NEAR(scene("file=\"both.geojson\" style=\"point.sld\"").count, point.count, 3);
}

// The usual description of a service of 18 levels; each request takes 20 ms.
TEST_F(MappingProgram, AServiceOfTheWorldIsAskedForWhatAViewNeeds)
{
    writeGround(0.4);
    TestServer server(&stripedTile);
    server.setDelay(std::chrono::milliseconds(20));
    _folder.write("map.xml", serviceText(server.address(), 18, "<Cache/>"));
    const auto start = std::chrono::steady_clock::now();
    const ProgramResult result =
        run({"--mapping", "map.xml", "--size", "960x640", "--fov", "30", "--view", "7,45,18700,0,-90"});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(result.exitCode, 0) << result.standardError;
    EXPECT_EQ(result.standardError, "");
    std::vector<std::string> requests = server.requests();
    std::sort(requests.begin(), requests.end());
    EXPECT_LE(requests.size(), 80u);
    EXPECT_TRUE(std::adjacent_find(requests.begin(), requests.end()) == requests.end()) << "one came twice";
    RecordProperty("requests", static_cast<int>(requests.size()));
    RecordProperty("seconds", std::to_string(seconds.count()));
    // 15 km are 960 pixels of 15.6 m; a pixel of the level 12 has 27 m there, one of the level 13 has 13.5 m.
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile((_folder / "out.png").string());
    ASSERT_TRUE(image);
    int fine = 0, all = 0;
    double contrast = 0.0;
    for (unsigned int y = 20; y < 620; y += 20)
        for (unsigned int x = 20; x < 900; x += 20)
        {
            ++all;
            const int level = (image->data(x, y)[0] + 6) / 12;
            if (level >= 12 && level <= 14) ++fine;
            int least = 255, most = 0;
            for (unsigned int i = 0; i < 40; ++i)
            {
                least = std::min<int>(least, image->data(x + i, y)[1]);
                most = std::max<int>(most, image->data(x + i, y)[1]);
            }
            contrast += most - least;
        }
    EXPECT_EQ(fine, all);
    EXPECT_GT(contrast / all, 180.0) << "its stripes are blurred";
}

TEST_F(MappingProgram, TilesOfServicesThatFailAreAskedForAgainOrTold)
{
    TestServer server(&stripedTile);
    _folder.write("map.xml", serviceText(server.address(), 18));
    const std::vector<std::string> view = {"--mapping", "map.xml", "--fov", "30"};
    const ProgramResult good = run(view);
    EXPECT_EQ(good.exitCode, 0) << good.standardError;
    const auto picture = [&]
    {
        return osgDB::readRefImageFile((_folder / "out.png").string());
    };
    const osg::ref_ptr<osg::Image> right = picture();
    ASSERT_TRUE(right);
    std::string finest;
    int level = 0;
    for (const std::string& each : server.requests())
        if (const auto tile = WebTile::parse(each); tile && tile->level > level)
        {
            level = tile->level;
            finest = each;
        }
    ASSERT_GE(level, 12);
    server.setFault(TestServer::Fault::Busy, finest, 2);
    const ProgramResult once = run(view);
    EXPECT_EQ(once.exitCode, 0) << once.standardError;
    EXPECT_EQ(once.standardError, "");
    const osg::ref_ptr<osg::Image> again = picture();
    ASSERT_TRUE(again && again->getTotalSizeInBytes() == right->getTotalSizeInBytes());
    // By the order in which tiles came, they lie at other places of the texture, so that colors are rounded otherwise.
    int worst = 0;
    for (unsigned int i = 0; i < right->getTotalSizeInBytes(); ++i)
        worst = std::max(worst, std::abs(right->data()[i] - again->data()[i]));
    EXPECT_LE(worst, 2);
    server.setFault(TestServer::Fault::Busy, finest);
    std::filesystem::remove(_folder / "out.png");
    const ProgramResult always = run(view);
    EXPECT_EQ(always.exitCode, 1) << always.standardError;
    EXPECT_NE(always.standardError.find(
                  "osggeofx_render: map.xml: its pixels cannot be read (the server has failed, HTTP "
                  "503); try again later. A coarser part stands in its place."),
              std::string::npos)
        << always.standardError;
    EXPECT_TRUE(picture()) << "what there is, is drawn";
    // A wait ends after --timeout.
    server.setFault(TestServer::Fault::Silent, finest);
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::string> waiting = view;
    waiting.insert(waiting.end(), {"--timeout", "1"});
    const ProgramResult silent = run(waiting);
    // GDAL would wait for 30 s.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    EXPECT_EQ(silent.exitCode, 1) << silent.standardError;
}

TEST_F(MappingProgram, WhatLiesElsewhereIsTold)
{
    const ProgramResult result =
        run({"--mapping", writeRelief(_folder / "far.tif", 4, 4, 20.0, 45.0, 0.001)});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_NE(result.standardError.find("far.tif: it lies beside the terrain"), std::string::npos)
        << result.standardError;
    // Its corner lies on the ground.
    const ProgramResult near = run({"--mapping", writeRelief(_folder / "near.tif", 4, 4, 7.0, 45.0, 0.5)});
    EXPECT_EQ(near.standardError, "");
}

TEST_F(MappingProgram, WhatCannotBeShownIsToldInASentence)
{
    expectRefusal({"--route", "none.gpx"}, "none.gpx: ");
    expectRefusal({"--route-width", "10"}, "--route-width is for ways");
    expectRefusal({"--mapping", "none.kmz"}, "none.kmz: the file does not exist");
    expectRefusal({"--mapping", "none.tif"}, "none.tif: ");
    expectRefusal({"--colors", "ramp.txt"}, "--colors is for values");
    expectRefusal(
        {"--mapping", writeRelief(_folder / "relief.tif", 4, 4, 7.0, 45.0, 0.001), "--colors", "none.sld"},
        "none.sld: ");
    _folder.write("inner/doc.kml", kml(groundOverlay("../red.png", latLonBox(6.995, 44.995, 7.005, 45.005))));
    expectRefusal({"--mapping", "inner/doc.kml"}, "--allow-outside");
    EXPECT_GT(redOf({"--mapping", "inner/doc.kml", "--allow-outside"}).count, 2000);
}

// The middle of the picture lies at 7° east, 45° north.
TEST_F(MappingProgram, ValuesAndSeriesOfAPixel)
{
    TestRaster raster(40, 40, 1, GDT_Float32);
    raster.placed(6.98, 45.02, 0.001, 0.001)
        .crs("EPSG:4326")
        .fill([](int column, int row, int) { return 100.0 + column + 0.01 * row; });
    raster.dataset().GetRasterBand(1)->SetUnitType("mm");
    raster.write(_folder / "still.tif");
    TestRaster bands(40, 40, 3, GDT_Float32);
    bands.placed(6.98, 45.02, 0.001, 0.001)
        .crs("EPSG:4326")
        .fill([](int column, int, int band) { return 1000.0 * band + column; });
    bands.write(_folder / "rain.tif");
    const ProgramResult result = run({"--mapping", "still.tif", "--sequence", "rain.tif", "--values",
                                      "100,75", "--values", "110,75", "--series", "rain.csv"});
    ASSERT_EQ(result.exitCode, 0) << result.standardError;
    double longitude = 0.0, latitude = 0.0, rain = 0.0, still = 0.0;
    int pixels = 0;
    std::istringstream lines(result.standardOutput);
    std::string line;
    for (; std::getline(lines, line);)
    {
        if (std::sscanf(line.c_str(), "%*[^:]: longitude %lf, latitude %lf", &longitude, &latitude) == 2)
        {
            ++pixels;
            continue;
        }
        ASSERT_EQ(std::sscanf(line.c_str(), "  rain.tif: %lf", &rain), 1) << line;
        ASSERT_TRUE(std::getline(lines, line));
        ASSERT_EQ(std::sscanf(line.c_str(), "  still.tif: %lf mm", &still), 1) << line;
        // Pixels of rasters have their values in their middles.
        const double column = (longitude - 6.98) / 0.001 - 0.5, row = (45.02 - latitude) / 0.001 - 0.5;
        EXPECT_NEAR(still, 100.0 + column + 0.01 * row, 0.05);
        EXPECT_NEAR(rain, column, 0.05) << "the first step";
    }
    EXPECT_EQ(pixels, 2);
    EXPECT_NEAR(longitude, 7.0023, 0.0003);
    std::ifstream table(_folder / "rain.csv");
    ASSERT_TRUE(std::getline(table, line));
    EXPECT_EQ(line, "time (s),rain.tif");
    double first = -1.0;
    for (int step = 0; step < 3; ++step)
    {
        double time = -1.0, value = -1.0;
        ASSERT_TRUE(std::getline(table, line));
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf", &time, &value), 2) << line;
        EXPECT_EQ(time, step);
        if (step == 0) first = value;
        EXPECT_NEAR(value, first + 1000.0 * step, 1e-3);
    }
    EXPECT_NEAR(first, 19.5, 0.5);
    expectRefusal({"--values", "here"}, "--values here");
    EXPECT_EQ(run({"--values", "100,75", "--series", "none.csv"}).exitCode, 2) << "no layer in time";
}
