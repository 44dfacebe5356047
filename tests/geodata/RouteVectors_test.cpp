// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Ways of GPX, KML and other vector data, with their heights and altitude modes. GDAL's drivers GPX, LIBKML and GeoJSON write files,
// too.
#include <osgGeoFX/geodata/RouteVectors.h>
#include <tools/KmlFiles.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>

#include <ogrsf_frmts.h>

#include <map>
#include <memory>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

class RouteVectorsTest : public ::testing::Test
{
protected:
    static std::vector<RoutePath> readAll(const std::string& file, const std::string& layer = {})
    {
        std::vector<RoutePath> routes;
        std::string error;
        EXPECT_TRUE(RouteVectors::read(file, layer, routes, error)) << error;
        return routes;
    }
    std::vector<RoutePath> readKml(const std::string& features)
    {
        return readAll(_folder.write("doc.kml", kml(features)).string());
    }
    static std::string faultOf(const std::string& file, const std::string& layer = {})
    {
        std::vector<RoutePath> routes(1);
        std::string error;
        EXPECT_FALSE(RouteVectors::read(file, layer, routes, error));
        EXPECT_EQ(routes.size(), 1u) << "unchanged";
        EXPECT_TRUE(!error.empty() && error.back() == '.') << error;
        return error;
    }
    static std::string placemark(const std::string& content)
    {
        return "<Placemark><name>way</name>" + content + "</Placemark>";
    }
    static std::string line(const std::string& more,
                            const std::string& coordinates = "7,45,1000 7.1,45.1,1200")
    {
        return "<LineString>" + more + "<coordinates>" + coordinates + "</coordinates></LineString>";
    }
    /// A layer of lines written by one of GDAL's drivers.
    std::string written(const char* format, const std::string& name, const std::string& wkt,
                        std::vector<const char*> layerOptions = {})
    {
        GDALAllRegister();
        const std::string file = (_folder / name).string();
        GDALDataset* const dataset = GetGDALDriverManager()->GetDriverByName(format)->Create(
            file.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
        EXPECT_TRUE(dataset);
        OGRSpatialReference degrees;
        degrees.importFromEPSG(4326);
        degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        layerOptions.push_back(nullptr);
        OGRLayer* const layer = dataset->CreateLayer(
            "ways", &degrees, std::string(format) == "GPX" ? wkbLineString25D : wkbUnknown,
            const_cast<char**>(layerOptions.data()));
        EXPECT_TRUE(layer);
        OGRFieldDefn field("name", OFTString);
        if (layer->GetLayerDefn()->GetFieldIndex("name") < 0) layer->CreateField(&field);
        OGRFeature feature(layer->GetLayerDefn());
        feature.SetField("name", "way");
        OGRGeometry* geometry = nullptr;
        OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &geometry);
        feature.SetGeometryDirectly(geometry);
        EXPECT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
        GDALClose(dataset);
        return file;
    }

    TempDir _folder;
};

const std::string gpx =
    R"(<?xml version="1.0"?><gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
<wpt lat="45" lon="7"><name>a point</name></wpt>
<rte><name>plan</name><rtept lat="45" lon="7"/><rtept lat="45.1" lon="7.1"><ele>5</ele></rtept></rte>
<trk><name>walk</name><trkseg><trkpt lat="45" lon="7"><ele>100</ele></trkpt><trkpt lat="45.1" lon="7.1"><ele>0</ele></trkpt></trkseg>
<trkseg><trkpt lat="46" lon="7"/><trkpt lat="46.1" lon="7.1"><ele>5</ele></trkpt><trkpt lat="46.2" lon="7.1"/></trkseg>
<trkseg><trkpt lat="46" lon="7"/></trkseg></trk></gpx>)";

/// A track of two places with heights, and of another one.
std::string gpxOf(const std::string& point)
{
    return R"(<?xml version="1.0"?><gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
<trk><trkseg><trkpt lat="45" lon="7"><ele>100</ele></trkpt><trkpt lat="45" lon="7.1"><ele>0</ele></trkpt>)" +
           point + "</trkseg></trk></gpx>";
}

} // namespace

TEST_F(RouteVectorsTest, GpxHasRoutesAndTheSegmentsOfTracks)
{
    const std::string file = _folder.write("walk.gpx", gpx).string();
    const std::vector<RoutePath> routes = readAll(file);
    ASSERT_EQ(routes.size(), 3u) << "a segment of one point is no way";
    EXPECT_EQ(routes[0].name, "plan");
    EXPECT_TRUE(routes[0].wayPoints);
    EXPECT_EQ(routes[0].altitude, RoutePath::CLAMPED) << "not all of its points have a height";
    EXPECT_EQ(routes[0].places[1], osg::Vec3d(7.1, 45.1, 0.0));
    EXPECT_EQ(routes[1].name, "walk");
    EXPECT_FALSE(routes[1].wayPoints);
    // A height of 0 is one.
    EXPECT_EQ(routes[1].altitude, RoutePath::ABSOLUTE);
    EXPECT_EQ(routes[1].places[0], osg::Vec3d(7.0, 45.0, 100.0));
    EXPECT_EQ(routes[2].altitude, RoutePath::CLAMPED);
    EXPECT_EQ(routes[2].places.size(), 3u);
    EXPECT_EQ(readAll(file, "routes").size(), 1u);
    EXPECT_TRUE(contains(faultOf(file, "waypoints"), "\"waypoints\""));
}

TEST_F(RouteVectorsTest, SegmentsOfOnePointAreOneTrack)
{
    std::string points;
    for (int i = 0; i < 5; ++i)
        points += "<trkseg><trkpt lat=\"45\" lon=\"7.00" + std::to_string(i) + "\"><ele>" +
                  std::to_string(i) + "</ele></trkpt></trkseg>\n";
    const std::string text =
        R"(<?xml version="1.0"?><gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
<trk><name>a</name>)" +
        points + "</trk><trk><name>b</name>" + points + "</trk></gpx>";
    const std::vector<RoutePath> routes = readAll(_folder.write("lone.gpx", text).string());
    ASSERT_EQ(routes.size(), 2u) << "no way reaches into the next track";
    EXPECT_EQ(routes[0].name, "a");
    ASSERT_EQ(routes[0].places.size(), 5u);
    EXPECT_EQ(routes[0].places[4], osg::Vec3d(7.004, 45.0, 4.0));
    EXPECT_EQ(routes[1].places.size(), 5u);
    EXPECT_EQ(routes[1].altitude, RoutePath::ABSOLUTE);
}

namespace
{

/// Points 10 m apart, with others in between.
std::string trackOf(int count, const std::map<int, std::string>& others)
{
    std::string text =
        R"(<?xml version="1.0"?><gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
<trk><name>walk</name><trkseg>)";
    for (int i = 0; i < count; ++i)
    {
        if (const auto other = others.find(i); other != others.end()) text += other->second;
        text += "<trkpt lat=\"" + std::to_string(45.0 + i * 1e-4) + "\" lon=\"7\"/>";
    }
    return text + "</trkseg></trk></gpx>";
}

} // namespace

TEST_F(RouteVectorsTest, LostFixesAreToldAndLeftOut)
{
    const std::string zero = "<trkpt lat=\"0\" lon=\"0\"/>", elsewhere = "<trkpt lat=\"46\" lon=\"9\"/>";
    const struct
    {
        const char* name;
        std::map<int, std::string> others;
    } cases[] = {{"first", {{0, zero}}},
                 {"middle", {{7, zero}}},
                 {"row", {{7, elsewhere + elsewhere + elsewhere}}},
                 {"twice", {{7, elsewhere}, {9, elsewhere}}},
                 {"begin", {{0, elsewhere}}}};
    for (const auto& each : cases)
    {
        SCOPED_TRACE(each.name);
        const std::string file =
            _folder.write(std::string(each.name) + ".gpx", trackOf(30, each.others)).string();
        NotifyWatch watch;
        std::vector<RoutePath> routes;
        const std::vector<std::string> messages = watch.messagesOf([&] { routes = readAll(file); });
        ASSERT_EQ(routes.size(), 1u);
        EXPECT_EQ(routes[0].places.size(), 30u);
        for (const osg::Vec3d& place : routes[0].places)
            EXPECT_NEAR(place.y(), 45.0, 0.01);
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_TRUE(contains(messages[0], "places of the way \"walk\" lie far from the others"))
            << messages[0];
    }
}

TEST_F(RouteVectorsTest, AJourneyIsNoLostFix)
{
    const NotifyWatch watch; // nothing is told
    // A gap of 200 km, as in a tunnel or an aeroplane.
    std::string far;
    for (int i = 0; i < 20; ++i)
        far += "<trkpt lat=\"" + std::to_string(47.0 + i * 1e-4) + "\" lon=\"7\"/>";
    EXPECT_EQ(readAll(_folder.write("gap.gpx", trackOf(30, {{30, ""}, {12, far}})).string())[0].places.size(),
              50u);
    // A boat that begins its way at 0, 0.
    const std::string gulf = R"({"type":"LineString","coordinates":[[0,0],[0.1,0.1],[0.2,0.1]]})";
    EXPECT_EQ(readAll(_folder.write("gulf.geojson", gulf).string())[0].places.size(), 3u);
}

TEST_F(RouteVectorsTest, IgcIsAFlight)
{
    const std::string text = "AXXXABC FLIGHT:1\r\nHFDTE280826\r\nHFPLTPILOT:Nobody\r\nI023636LAD3737LOD\r\n"
                             "B1200000000000N00000000EV000000000000\r\n"
                             "B1200014545000N00712600EA011000115005\r\n"
                             "C not a fix\r\n"
                             "B1200024545060S00712600WA-0010-001200\r\n";
    const std::vector<RoutePath> routes = readAll(_folder.write("soaring.igc", text).string());
    ASSERT_EQ(routes.size(), 1u);
    EXPECT_EQ(routes[0].name, "soaring");
    EXPECT_FALSE(routes[0].wayPoints);
    EXPECT_EQ(routes[0].altitude, RoutePath::ABSOLUTE);
    ASSERT_EQ(routes[0].places.size(), 2u);
    EXPECT_NEAR(routes[0].places[0].x(), 7.0 + 12.6005 / 60.0, 1e-9);
    EXPECT_NEAR(routes[0].places[0].y(), 45.75, 1e-9);
    EXPECT_EQ(routes[0].places[0].z(), 1150.0) << "of the satellites";
    EXPECT_NEAR(routes[0].places[1].x(), -7.21, 1e-9);
    EXPECT_NEAR(routes[0].places[1].y(), -(45.0 + 45.06 / 60.0), 1e-9);
    EXPECT_EQ(routes[0].places[1].z(), -12.0);
    const std::string barometer =
        "AXXXABC\nB1200014545000N00712600EA0110000000\nB1200024545060N00712600EA0112000000\n";
    EXPECT_EQ(readAll(_folder.write("b.igc", barometer).string())[0].places[1].z(), 1120.0);
    const std::string bad =
        "AXXXABC\nB1200014545000N00712600EA0110000000\nB12000245450x0N00712600EA0112000000\n";
    const std::string fault = faultOf(_folder.write("bad.igc", bad).string());
    EXPECT_TRUE(contains(fault, "bad.igc:3: this fix cannot be read")) << fault;
}

TEST_F(RouteVectorsTest, AHeightThatIsNoNumberIsNone)
{
    const std::string text = gpxOf("<trkpt lat=\"45\" lon=\"7.2\"><ele>nan</ele></trkpt>");
    const std::vector<RoutePath> routes = readAll(_folder.write("high.gpx", text).string());
    ASSERT_EQ(routes.size(), 1u);
    EXPECT_EQ(routes[0].altitude, RoutePath::CLAMPED);
    EXPECT_EQ(routes[0].places,
              (std::vector<osg::Vec3d>{{7.0, 45.0, 0.0}, {7.1, 45.0, 0.0}, {7.2, 45.0, 0.0}}));
}

TEST_F(RouteVectorsTest, KmlLinesHaveTheirAltitudeMode)
{
    const std::vector<RoutePath> routes = readKml(
        placemark(line("")) + placemark(line("<altitudeMode>absolute</altitudeMode><extrude>1</extrude>")) +
        placemark("<MultiGeometry>" + line("<altitudeMode>relativeToGround</altitudeMode>") +
                  line("<altitudeMode>clampToGround</altitudeMode>") + "</MultiGeometry>"));
    ASSERT_EQ(routes.size(), 4u);
    EXPECT_EQ(routes[0].altitude, RoutePath::CLAMPED);
    EXPECT_EQ(routes[0].places[0], osg::Vec3d(7.0, 45.0, 0.0)) << "heights of clamped lines mean nothing";
    EXPECT_FALSE(routes[0].extruded);
    EXPECT_EQ(routes[1].altitude, RoutePath::ABSOLUTE);
    EXPECT_EQ(routes[1].places[1], osg::Vec3d(7.1, 45.1, 1200.0));
    EXPECT_TRUE(routes[1].extruded);
    EXPECT_EQ(routes[2].altitude, RoutePath::ABOVE_GROUND);
    EXPECT_EQ(routes[3].altitude, RoutePath::CLAMPED);
    for (const RoutePath& route : routes)
        EXPECT_EQ(route.name, "way");
}

// GDAL does not tell the altitude mode of a track.
TEST_F(RouteVectorsTest, KmlTracksHaveTheirAltitudeMode)
{
    const auto track = [](const std::string& more)
    {
        return "<gx:Track>" + more +
               "<when>2020-01-01T00:00:00Z</when><when>2020-01-01T00:01:00Z</when><gx:coord>7 45 "
               "1000</gx:coord>"
               "<gx:coord>7.2 45 1100.5</gx:coord></gx:Track>";
    };
    const std::vector<RoutePath> routes =
        readKml(placemark(track("<altitudeMode>absolute</altitudeMode>")) + placemark(track("")) +
                placemark("<gx:MultiTrack><altitudeMode>absolute</altitudeMode>" + track("") + track("") +
                          "</gx:MultiTrack>"));
    ASSERT_EQ(routes.size(), 4u);
    EXPECT_EQ(routes[0].altitude, RoutePath::ABSOLUTE);
    EXPECT_EQ(routes[0].places[1], osg::Vec3d(7.2, 45.0, 1100.5));
    EXPECT_EQ(routes[1].altitude, RoutePath::CLAMPED);
    EXPECT_EQ(routes[2].altitude, RoutePath::ABSOLUTE);
    EXPECT_EQ(routes[3].altitude, RoutePath::ABSOLUTE);
}

TEST_F(RouteVectorsTest, TracksMayHaveGapsAndAnySpaces)
{
    const std::vector<RoutePath> routes = readKml(
        placemark("<gx:Track><altitudeMode>absolute</altitudeMode><gx:coord>7  45\n\t 1000 "
                  "</gx:coord><gx:coord/><gx:coord></gx:coord><gx:coord>7.2 45 5</gx:coord></gx:Track>") +
        placemark(line("", "7,45,1 7.1,45")));
    ASSERT_EQ(routes.size(), 2u);
    EXPECT_EQ(routes[0].places, (std::vector<osg::Vec3d>{{7.0, 45.0, 1000.0}, {7.2, 45.0, 5.0}}));
    EXPECT_EQ(routes[1].places.size(), 2u);
}

// libxml2's own limit of a text is 10 MB.
TEST_F(RouteVectorsTest, AWayMayBeLong)
{
    std::string coordinates;
    for (int i = 0; i < 500000; ++i)
        coordinates += i % 2 ? "7.0000001,45.0000001,100 " : "7.0000002,45.0000001,100\n";
    ASSERT_GT(coordinates.size(), 12000000u);
    const std::vector<RoutePath> routes = readKml(placemark(line("", coordinates)));
    ASSERT_EQ(routes.size(), 1u);
    EXPECT_EQ(routes[0].places.size(), 500000u);
}

TEST_F(RouteVectorsTest, KmlColorsAreOwnOrShared)
{
    const std::vector<RoutePath> routes = readKml(
        "<Style id=\"a\"><LineStyle><color>ff0000ff</color></LineStyle></Style>"
        "<StyleMap id=\"m\"><Pair><key>normal</key><styleUrl>#a</styleUrl></Pair>"
        "<Pair><key>highlight</key><styleUrl>#b</styleUrl></Pair></StyleMap>" +
        placemark("<styleUrl>#m</styleUrl>" + line("")) +
        placemark("<Style><LineStyle><color>80ff0000</color></LineStyle></Style>" + line("")) +
        placemark(line("")) + "<Folder><visibility>0</visibility>" + placemark(line("")) + "</Folder>");
    ASSERT_EQ(routes.size(), 3u) << "what is switched off is left out";
    EXPECT_EQ(routes[0].color, osg::Vec4(1, 0, 0, 1));
    EXPECT_EQ(routes[1].color, osg::Vec4(0, 0, 1, 128.0f / 255.0f));
    EXPECT_FALSE(routes[2].color);
}

TEST_F(RouteVectorsTest, FilesOfGdalsDriversAreRead)
{
    const std::string wkt = "LINESTRING Z (7 45 1000,7.1 45.1 1200)";
    const std::vector<RoutePath> track = readAll(written("GPX", "a.gpx", wkt, {"FORCE_GPX_TRACK=YES"}));
    ASSERT_EQ(track.size(), 1u);
    EXPECT_EQ(track[0].altitude, RoutePath::ABSOLUTE);
    EXPECT_EQ(track[0].places[1], osg::Vec3d(7.1, 45.1, 1200.0));
    // LIBKML writes no altitude mode: such lines are clamped.
    for (const char* const name : {"a.kml", "a.kmz"})
    {
        const std::vector<RoutePath> kmlWay = readAll(written("LIBKML", name, wkt));
        ASSERT_EQ(kmlWay.size(), 1u) << name;
        EXPECT_EQ(kmlWay[0].places[1].x(), 7.1);
        EXPECT_EQ(kmlWay[0].name, "way");
    }
    const std::vector<RoutePath> high = readAll(written("GeoJSON", "high.geojson", wkt));
    EXPECT_EQ(high.at(0).altitude, RoutePath::ABSOLUTE);
    EXPECT_EQ(high.at(0).places[0].z(), 1000.0);
    const std::vector<RoutePath> flat =
        readAll(written("GeoJSON", "flat.geojson", "MULTILINESTRING ((7 45,7.1 45.1),(8 45,8 46))"));
    EXPECT_EQ(flat.size(), 2u);
    EXPECT_EQ(flat.at(0).altitude, RoutePath::CLAMPED);
}

TEST_F(RouteVectorsTest, MissingLinksAreToldAndTooManyRefused)
{
    const auto link = [](const std::string& href)
    {
        return "<NetworkLink><Link><href>" + href + "</href></Link></NetworkLink>";
    };
    NotifyWatch watch;
    const std::vector<std::string> messages = watch.messagesOf(
        [&] { EXPECT_EQ(readKml(placemark(line("")) + link("none.kml") + link("../out.kml")).size(), 1u); });
    ASSERT_EQ(messages.size(), 2u);
    EXPECT_TRUE(contains(messages[0], "doc.kml: the file \"none.kml\" that it links is not there"));
    EXPECT_TRUE(contains(messages[1], "\"../out.kml\" that it links is not in its folder"));
    std::string features;
    for (int i = 0; i < 1000; ++i)
    {
        const std::string name = "part" + std::to_string(i) + ".kml";
        _folder.write(name, kml(placemark(line(""))));
        features += link(name);
    }
    EXPECT_TRUE(contains(faultOf(_folder.write("doc.kml", kml(features)).string()), "more than 1000 files"));
    std::string many;
    for (int i = 0; i < 10001; ++i)
        many += link("part0.kml");
    EXPECT_TRUE(contains(faultOf(_folder.write("doc.kml", kml(many)).string()), "more than 10000 links"));
}

TEST_F(RouteVectorsTest, LayersThatHoldNoLinesAreLeftOut)
{
    const std::string file = written("GPKG", "a.gpkg", "LINESTRING (7 45,7.1 45.1)");
    GDALDataset* const dataset = GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE);
    ASSERT_TRUE(dataset);
    ASSERT_TRUE(dataset->CreateLayer("table", nullptr, wkbNone, nullptr));
    ASSERT_TRUE(dataset->CreateLayer("points", nullptr, wkbPoint, nullptr));
    GDALClose(dataset);
    EXPECT_EQ(readAll(file).size(), 1u);
    EXPECT_TRUE(contains(faultOf(file, "table"), "is a table without places"));
}

TEST_F(RouteVectorsTest, WhatCannotBeReadIsTold)
{
    EXPECT_TRUE(
        contains(faultOf(_folder.write("cut.gpx", gpx.substr(0, gpx.size() / 2)).string()), "cut.gpx: "));
    EXPECT_TRUE(contains(faultOf(_folder.write("no.gpx", "<gpx/>").string()), "no.gpx: "));
    EXPECT_TRUE(contains(faultOf((_folder / "none.gpx").string()), "none.gpx: "));
    for (const std::string point :
         {"lat=\"nan\" lon=\"7\"", "lat=\"95\" lon=\"7\"", "lat=\"45\" lon=\"1e9\""})
        EXPECT_TRUE(contains(faultOf(_folder.write("bad.gpx", gpxOf("<trkpt " + point + "/>")).string()),
                             "bad.gpx: a place of its tracks is none"))
            << point;
    EXPECT_TRUE(
        contains(faultOf(_folder.write("none.kml", kml(groundOverlay("", latLonBox(7, 45, 8, 46)))).string()),
                 "none.kml: it has no way"));
    EXPECT_TRUE(
        contains(faultOf(_folder.write("a.kml", kml("\n" + placemark(line("", "7,45 7,95")))).string()),
                 "a.kml:3: the place \"7,95\""));
    EXPECT_TRUE(contains(faultOf(_folder.write("a.kml", kml(placemark(line("", "7,45 here")))).string()),
                         "\"here\""));
}
