// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Ground overlays of KML: what is read of them, what is refused, and how far they reach. Azimuths and distances are GeographicLib's.
// GDAL writes the archives and the pyramids.
#include <osgGeoFX/geodata/KmlOverlays.h>
#include <tools/KmlFiles.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <GeographicLib/Geodesic.hpp>

#include <chrono>
#include <cmath>
#include <fstream>
#include <sys/resource.h>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class KmlOverlaysTest : public ::testing::Test
{
protected:
    std::vector<KmlOverlay> readAll(const std::string& file, bool allowOutside = false)
    {
        std::vector<KmlOverlay> overlays;
        std::string error;
        EXPECT_TRUE(KmlOverlays::read(file, allowOutside, overlays, _notices, error)) << error;
        return overlays;
    }
    std::vector<KmlOverlay> readText(const std::string& features)
    {
        return readAll(_folder.write("doc.kml", kml(features)).string());
    }
    KmlOverlay one(const std::string& features)
    {
        std::vector<KmlOverlay> overlays = readText(features);
        EXPECT_EQ(overlays.size(), 1u);
        overlays.resize(1);
        return overlays[0];
    }
    std::string faultOf(const std::string& file)
    {
        std::vector<KmlOverlay> overlays(1);
        std::string error;
        EXPECT_FALSE(KmlOverlays::read(file, false, overlays, _notices, error));
        EXPECT_EQ(overlays.size(), 1u) << "unchanged";
        EXPECT_FALSE(error.empty());
        if (error.empty()) return error;
        EXPECT_EQ(error.back(), '.') << error;
        EXPECT_NE(error.find(std::filesystem::path(file).filename().string()), std::string::npos) << error;
        return error;
    }
    std::string faultOfText(const std::string& features)
    {
        return faultOf(_folder.write("doc.kml", kml(features)).string());
    }

    TempDir _folder;
    std::vector<std::string> _notices;
};

const std::string somewhere = latLonBox(7.0, 45.0, 8.0, 46.0);

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_F(KmlOverlaysTest, ABoxIsItsCorners)
{
    const KmlOverlay overlay = one(groundOverlay("", latLonBox(7.0, 45.0, 8.5, 46.0)));
    EXPECT_EQ(overlay.corners[0], osg::Vec2d(7.0, 45.0));
    EXPECT_EQ(overlay.corners[1], osg::Vec2d(8.5, 45.0));
    EXPECT_EQ(overlay.corners[2], osg::Vec2d(8.5, 46.0));
    EXPECT_EQ(overlay.corners[3], osg::Vec2d(7.0, 46.0));
    EXPECT_EQ(overlay.name, "plain");
    EXPECT_TRUE(overlay.image.empty());
    EXPECT_TRUE(overlay.visible);
}

// osgEarth turned them the other way (its issue 130), CesiumJS changed their shape (its issue 5914).
TEST_F(KmlOverlaysTest, ARotationIsCounterClockwiseAndKeepsTheShape)
{
    const GeographicLib::Geodesic& earth = GeographicLib::Geodesic::WGS84();
    for (const double latitude : {0.0, 47.0, -62.0, 75.0})
    {
        for (const double angle : {30.0, -100.0, 170.0})
        {
            SCOPED_TRACE(std::to_string(latitude) + " " + std::to_string(angle));
            const auto cornersOf = [&](double rotation)
            {
                return one(groundOverlay("",
                                         latLonBox(10.0, latitude - 0.02, 10.1, latitude + 0.02, rotation)))
                    .corners;
            };
            const auto before = cornersOf(0.0), after = cornersOf(angle);
            for (std::size_t i = 0; i < 4; ++i)
            {
                double distance = 0.0, azimuth = 0.0, turnedDistance = 0.0, turnedAzimuth = 0.0, unused = 0.0;
                earth.Inverse(latitude, 10.05, before[i].y(), before[i].x(), distance, azimuth, unused);
                earth.Inverse(latitude, 10.05, after[i].y(), after[i].x(), turnedDistance, turnedAzimuth,
                              unused);
                // The ellipsoid's two radii differ by 0.7 % at most.
                EXPECT_NEAR(turnedDistance, distance, 0.01 * distance);
                EXPECT_NEAR(std::remainder(azimuth - turnedAzimuth - angle, 360.0), 0.0, 0.6);
            }
        }
    }
}

// OpenSphere and GDAL leave quadrilaterals out (opensphere 641 and 644, gdal 6093).
TEST_F(KmlOverlaysTest, AQuadIsItsFourCorners)
{
    const KmlOverlay overlay = one(groundOverlay(
        "", "<gx:LatLonQuad><coordinates>\n 179.5,-17.1 -179.8,-17,12.5\n-179.9,-16.2,0  179.6,-16.3 "
            "</coordinates></gx:LatLonQuad>"));
    const osg::Vec2d expected[] = {{179.5, -17.1}, {180.2, -17.0}, {180.1, -16.2}, {179.6, -16.3}};
    for (std::size_t i = 0; i < 4; ++i)
    {
        EXPECT_NEAR(overlay.corners[i].x(), expected[i].x(), 1e-9) << "over the antimeridian";
        EXPECT_NEAR(overlay.corners[i].y(), expected[i].y(), 1e-9);
    }
}

TEST_F(KmlOverlaysTest, ABoxGoesOnOverTheAntimeridian)
{
    const KmlOverlay overlay = one(groundOverlay("", latLonBox(170.0, -10.0, -175.0, 10.0)));
    EXPECT_DOUBLE_EQ(overlay.corners[1].x() - overlay.corners[0].x(), 15.0);
}

// CesiumJS lost the alpha (its issue 2688).
TEST_F(KmlOverlaysTest, AColorIsAlphaBlueGreenRed)
{
    const KmlOverlay overlay = one(groundOverlay("", somewhere, "<color>80ff4000</color>"));
    EXPECT_EQ(overlay.color, osg::Vec4(0.0f, 64.0f / 255.0f, 1.0f, 128.0f / 255.0f));
}

TEST_F(KmlOverlaysTest, DrawOrderAndThenTheTextDecide)
{
    const auto named = [](const char* name, const char* order)
    {
        return "<GroundOverlay><name>" + std::string(name) + "</name>" + order + somewhere +
               "</GroundOverlay>";
    };
    std::string order;
    for (const KmlOverlay& each :
         readText(named("c", "<drawOrder>7</drawOrder>") + named("a", "") +
                  named("d", "<drawOrder>7</drawOrder>") + named("0", "<drawOrder>-3</drawOrder>") +
                  named("b", "<drawOrder>0</drawOrder>")))
        order += each.name;
    EXPECT_EQ(order, "0abcd");
}

TEST_F(KmlOverlaysTest, FoldersSwitchThemOffAndLimitTheirSizes)
{
    const std::string lod = "<Region><Lod><minLodPixels>128</minLodPixels><maxLodPixels>512</maxLodPixels>"
                            "<minFadeExtent>16</minFadeExtent></Lod></Region>";
    const std::vector<KmlOverlay> overlays =
        readText("<Placemark><visibility>0</visibility></Placemark><Folder><visibility>0</visibility>" + lod +
                 groundOverlay("", somewhere) + "</Folder>" + groundOverlay("", somewhere) +
                 groundOverlay("", somewhere, "<visibility>0</visibility>"));
    // What other features say of themselves is not their folder's.
    for (const std::string feature : {"Placemark", "ScreenOverlay", "PhotoOverlay", "Tour"})
    {
        const std::string other = "<" + feature + "><visibility>0</visibility>" + lod + "</" + feature + ">";
        const KmlOverlay overlay = one(other + groundOverlay("", somewhere));
        EXPECT_TRUE(overlay.visible) << feature;
        EXPECT_EQ(overlay.pixelsFull, 0.0) << feature;
    }
    ASSERT_EQ(overlays.size(), 3u);
    EXPECT_FALSE(overlays[0].visible);
    EXPECT_EQ(overlays[0].pixelsNone, 128.0);
    EXPECT_EQ(overlays[0].pixelsFull, 144.0);
    EXPECT_TRUE(overlays[1].visible);
    EXPECT_EQ(overlays[1].pixelsFull, 0.0);
    EXPECT_FALSE(overlays[2].visible);
}

TEST_F(KmlOverlaysTest, PicturesAreThoseOfTheFolderOrTheArchive)
{
    const std::string picture = _folder.write("files/a b.png", "x").string();
    EXPECT_EQ(one(groundOverlay("files/a%20b.png", somewhere)).image, picture);
    EXPECT_EQ(one(groundOverlay("./files/../files/a b.png", somewhere)).image, picture);

    const std::string archive = (_folder / "over.kmz").string();
    writeArchive(archive,
                 {{"first.kml", kml(groundOverlay("files/x.png", somewhere))}, {"files/x.png", "x"}});
    EXPECT_EQ(bytesOf(readAll(archive).at(0).image), "x");
    // A text of this name comes first, whatever the order.
    writeArchive(archive, {{"first.kml", kml(groundOverlay("files/x.png", somewhere))},
                           {"doc.kml", kml(groundOverlay("y.png", somewhere))},
                           {"y.png", "y"}});
    EXPECT_EQ(bytesOf(readAll(archive).at(0).image), "y");
}

TEST_F(KmlOverlaysTest, NothingLeadsOutOfTheFolder)
{
    const std::filesystem::path inner = _folder / "inner";
    _folder.write("secret.png", "x");
    std::filesystem::create_directories(inner);
    std::filesystem::create_symlink(_folder / "secret.png", inner / "link.png");
    for (const std::string& href :
         {std::string("../secret.png"), (_folder / "secret.png").string(), std::string("link.png"),
          "file://" + (_folder / "secret.png").string(), std::string("http://localhost:1/a.png"),
          std::string("/vsicurl/http://localhost:1/a.png"), std::string("%2e%2e/secret.png"),
          std::string("/vsizip/../secret.png")})
    {
        const std::string file =
            _folder.write("inner/doc.kml", kml("\n" + groundOverlay(href, somewhere))).string();
        const std::string fault = faultOf(file);
        EXPECT_TRUE(contains(fault, "doc.kml:3: \"" + href + "\" leads out of the folder")) << fault;
        EXPECT_TRUE(contains(fault, "--allow-outside")) << fault;
        if (href.rfind("/vsizip/", 0) != 0)
        {
            EXPECT_EQ(readAll(file, true).size(), 1u) << "with consent";
        }
        // The same of links.
        const std::string link = "<NetworkLink><Link><href>" + href + "</href></Link></NetworkLink>";
        EXPECT_TRUE(contains(faultOf(_folder.write("inner/doc.kml", kml(link)).string()), "leads out"))
            << href;
        // And from within an archive.
        const std::string archive = (inner / "over.kmz").string();
        writeArchive(archive, {{"doc.kml", kml(groundOverlay(href, somewhere))}});
        if (href == "link.png") continue;
        EXPECT_TRUE(contains(faultOf(archive), "leads out")) << href;
    }
}

TEST_F(KmlOverlaysTest, LinksWithinTheFolderAreFollowedOnce)
{
    const auto link = [](const std::string& href)
    {
        return "<NetworkLink><Link><href>" + href + "</href></Link></NetworkLink>";
    };
    _folder.write("tiles/a.kml",
                  kml(groundOverlay("", somewhere, "<drawOrder>2</drawOrder>") + link("b.kml")));
    _folder.write("tiles/b.kml", kml(groundOverlay("", somewhere) + link("../doc.kml") + link("none.kml")));
    writeArchive((_folder / "tiles/c.kmz").string(),
                 {{"doc.kml", kml(groundOverlay("p.png", somewhere))}, {"p.png", "p"}});
    const std::vector<KmlOverlay> overlays =
        readText("<NetworkLink><visibility>0</visibility><Url><href>tiles/a.kml</href></Url></NetworkLink>" +
                 link("tiles/c.kmz"));
    std::vector<KmlOverlay> again;
    std::vector<std::string> notices, files;
    std::string error;
    EXPECT_TRUE(KmlOverlays::read((_folder / "doc.kml").string(), false, again, notices, error, &files));
    std::vector<std::string> expected;
    for (const char* const name : {"doc.kml", "tiles/a.kml", "tiles/b.kml", "tiles/c.kmz"})
        expected.push_back(std::filesystem::canonical(_folder / name).string());
    EXPECT_EQ(files, expected);
    ASSERT_EQ(overlays.size(), 3u);
    EXPECT_EQ(bytesOf(overlays[0].image), "p");
    EXPECT_EQ(overlays[2].order, 2);
    EXPECT_FALSE(overlays[2].visible) << "by its link";
    ASSERT_EQ(_notices.size(), 1u);
    EXPECT_TRUE(contains(_notices[0], "b.kml:2: \"none.kml\" is not there")) << _notices[0];
}

// GDAL's writer of pyramids gives quadrilaterals to what is not in degrees, and its reader leaves them out (gdal 6093).
TEST_F(KmlOverlaysTest, PyramidsOfGdalAreRead)
{
    TestRaster raster(700, 600, 3, GDT_Byte);
    raster.placed(500000.0, 5100000.0, 50.0, 50.0).crs("EPSG:32632");
    raster.fill([](int column, int row, int band) { return band == 0 ? column % 256 : row % 256; });
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("KMLSUPEROVERLAY");
    ASSERT_TRUE(driver);
    for (const char* const name : {"pyramid.kmz", "pyramid.kml"})
    {
        const std::string file = (_folder / name).string();
        GDALDataset* const written =
            driver->CreateCopy(file.c_str(), &raster.dataset(), FALSE, nullptr, nullptr, nullptr);
        ASSERT_TRUE(written) << name;
        GDALClose(written);
        const std::vector<KmlOverlay> overlays = readAll(file);
        EXPECT_GE(overlays.size(), 5u) << name;
        osg::Vec2d low(1e9, 1e9), high(-1e9, -1e9);
        for (const KmlOverlay& each : overlays)
        {
            VSIStatBufL status;
            EXPECT_EQ(VSIStatL(each.image.c_str(), &status), 0) << each.image;
            for (const osg::Vec2d& corner : each.corners)
            {
                low.set(std::min(low.x(), corner.x()), std::min(low.y(), corner.y()));
                high.set(std::max(high.x(), corner.x()), std::max(high.y(), corner.y()));
            }
        }
        // The zone's middle is 9° east.
        EXPECT_NEAR(low.x(), 9.0, 0.03) << name;
        EXPECT_NEAR(high.y(), 46.05, 0.03) << name;
        EXPECT_NEAR(high.x(), 9.45, 0.05) << name;
        EXPECT_NEAR(low.y(), 45.78, 0.05) << name;
    }
}

TEST_F(KmlOverlaysTest, WhatCannotBeIsToldWithItsLine)
{
    EXPECT_TRUE(contains(faultOfText("\n<GroundOverlay><name>x</name></GroundOverlay>"),
                         "doc.kml:3: the ground overlay "
                         "has neither a LatLonBox"));
    EXPECT_TRUE(contains(faultOfText(groundOverlay("", latLonBox(7.0, 46.0, 8.0, 45.0))), "no area"));
    EXPECT_TRUE(contains(faultOfText(groundOverlay("", latLonBox(7.0, 45.0, 8.0, 145.0))), "north is \"145"));
    EXPECT_TRUE(contains(faultOfText(groundOverlay("", "<LatLonBox><north>nan</north></LatLonBox>")),
                         "north is \"nan\""));
    EXPECT_TRUE(
        contains(faultOfText(groundOverlay("", latLonBox(7.0, 88.0, 187.0, 89.9, 90.0))), "beyond a pole"));
    EXPECT_TRUE(contains(faultOfText(groundOverlay("", somewhere, "<color>red</color>")), "aabbggrr"));
    const auto quad = [](const std::string& places)
    {
        return groundOverlay("", "<gx:LatLonQuad><coordinates>" + places + "</coordinates></gx:LatLonQuad>");
    };
    EXPECT_TRUE(contains(faultOfText(quad("3,4 3,6 3,7")), "has 3 corners"));
    EXPECT_TRUE(contains(faultOfText(quad("0,0 1,1 1,0 0,1")), "not convex"));
    EXPECT_TRUE(contains(faultOfText("<Placemark/>"), "no ground overlays"));
}

// One fault of many is no reason to show nothing.
TEST_F(KmlOverlaysTest, OverlaysWithoutAPictureAreLeftOutAndTold)
{
    _folder.write("a.png", "x");
    const std::vector<KmlOverlay> overlays = readText(
        "\n" + groundOverlay("none.png", somewhere) + "\n" +
        groundOverlay("http://localhost:1/a.png", somewhere) + "\n" + groundOverlay("a.png", somewhere) +
        "\n<NetworkLink><Link><href>http://localhost:1/a.kml</href></Link></NetworkLink>");
    ASSERT_EQ(overlays.size(), 1u);
    EXPECT_EQ(overlays[0].name, "a.png");
    ASSERT_EQ(_notices.size(), 3u);
    EXPECT_TRUE(contains(_notices[0], "doc.kml:3: \"none.png\" is not there")) << _notices[0];
    EXPECT_TRUE(contains(_notices[1], "doc.kml:4: \"http://localhost:1/a.png\" leads out")) << _notices[1];
    EXPECT_TRUE(contains(_notices[2], "doc.kml:6: \"http://localhost:1/a.kml\" leads out")) << _notices[2];
}

TEST_F(KmlOverlaysTest, AFeatureMayStandAlone)
{
    const std::string feature = "<GroundOverlay xmlns=\"http://www.opengis.net/kml/2.2\"><name>alone</name>" +
                                somewhere + "</GroundOverlay>";
    const std::vector<KmlOverlay> overlays = readAll(_folder.write("alone.kml", feature).string());
    ASSERT_EQ(overlays.size(), 1u);
    EXPECT_EQ(overlays[0].name, "alone");
}

// As Windows' programs pack and name them.
TEST_F(KmlOverlaysTest, NamesMayHaveBackSlashesAndAnotherCase)
{
    const std::string picture = _folder.write("Files/Map.PNG", "x").string();
    EXPECT_EQ(one(groundOverlay("files\\map.png", somewhere)).image, picture);
    EXPECT_EQ(one(groundOverlay("Files\\Map.PNG", somewhere)).image, picture);
    const std::string archive = (_folder / "over.kmz").string();
    writeArchive(archive, {{"Tiles/Map.PNG", "in"},
                           {"deep/er/a.kml", kml("")},
                           {"maps/Doc.kml", kml(groundOverlay("..\\tiles\\map.png", somewhere))}});
    EXPECT_EQ(bytesOf(readAll(archive).at(0).image), "in");
}

TEST_F(KmlOverlaysTest, OfTimesTheEarliestIsShown)
{
    const auto at = [](const std::string& name, const std::string& time)
    {
        return "<GroundOverlay><name>" + name + "</name>" + time + somewhere + "</GroundOverlay>";
    };
    std::string shown;
    for (const KmlOverlay& each :
         readText(at("always", "") + at("later", "<TimeSpan><begin>2026-05</begin></TimeSpan>") +
                  at("first", "<TimeSpan><begin>2026-04-01</begin><end>2026-04-30</end></TimeSpan>") +
                  at("year", "<TimeSpan><begin>2026</begin><end>2026</end></TimeSpan>") +
                  "<Folder><TimeStamp><when>2026-04-15T00:00:00Z</when></TimeStamp>" + at("in a folder", "") +
                  "</Folder>"))
        shown += each.visible ? each.name + " " : "";
    EXPECT_EQ(shown, "always year ");
    ASSERT_EQ(_notices.size(), 1u);
    EXPECT_TRUE(contains(_notices[0], "those of 2026 are shown; 3 of other times")) << _notices[0];
}

TEST_F(KmlOverlaysTest, AnAltitudeIsTold)
{
    const std::string high =
        groundOverlay("", somewhere, "<altitude>5000</altitude><altitudeMode>absolute</altitudeMode>");
    EXPECT_EQ(readText(high + high).size(), 2u);
    ASSERT_EQ(_notices.size(), 1u);
    EXPECT_TRUE(contains(_notices[0], "has an altitude, and is shown on the ground")) << _notices[0];
}

TEST_F(KmlOverlaysTest, AnArchiveIsNoPicture)
{
    writeArchive((_folder / "a.kmz").string(), {{"p.png", "p"}});
    for (const std::string href : {"a.kmz", "none.kmz"})
        EXPECT_TRUE(contains(faultOfText("\n" + groundOverlay(href, somewhere)),
                             "doc.kml:3: \"" + href + "\" is no picture"));
}

TEST_F(KmlOverlaysTest, DamagedFilesAreRefused)
{
    const std::string whole = kml(groundOverlay("a.png", somewhere));
    EXPECT_TRUE(contains(faultOf(_folder.write("cut.kml", whole.substr(0, whole.size() / 2)).string()),
                         "it is not KML"));
    EXPECT_TRUE(contains(faultOf(_folder.write("other.kml", "<gpx/>").string()), "no element <kml>"));
    EXPECT_TRUE(contains(faultOf(_folder.write("binary.kml", std::string("\x89PNG\0\0\0", 7)).string()),
                         "it is not KML"));
    EXPECT_TRUE(contains(faultOf((_folder / "none.kml").string()), "does not exist"));
    EXPECT_TRUE(contains(faultOf(_folder.write("no.kmz", whole).string()), "no KMZ file"));
    writeArchive((_folder / "cut.kmz").string(), {{"doc.kml", whole}});
    const std::string archive = bytesOf((_folder / "cut.kmz").string());
    EXPECT_TRUE(contains(faultOf(_folder.write("cut.kmz", archive.substr(0, archive.size() / 2)).string()),
                         "no KMZ"));
    // What would be 2^30 letters.
    std::string bomb = "<!DOCTYPE kml [<!ENTITY a0 \"aaaaaaaaaaaaaaaa\">";
    for (int i = 1; i < 8; ++i)
    {
        bomb += "<!ENTITY a" + std::to_string(i) + " \"";
        for (int j = 0; j < 16; ++j)
            bomb += "&a" + std::to_string(i - 1) + ";";
        bomb += "\">";
    }
    bomb += "]><kml><Document><name>&a7;</name></Document></kml>";
    EXPECT_TRUE(contains(faultOf(_folder.write("bomb.kml", bomb).string()), "document type"));
    std::string deep = "<kml>";
    for (int i = 0; i < 5000; ++i)
        deep += "<Folder>";
    EXPECT_TRUE(contains(faultOf(_folder.write("deep.kml", deep).string()), "it is not KML"));
}

// Read as a stream: the memory does not grow with the number of elements.
TEST_F(KmlOverlaysTest, AMillionElementsTakeNoMemory)
{
    std::string text = kml(groundOverlay("", somewhere));
    const std::string end = "</Document></kml>\n";
    text.resize(text.size() - end.size());
    const std::string file = (_folder / "many.kml").string();
    {
        std::ofstream stream(file);
        stream << text;
        for (int i = 0; i < 500000; ++i)
            stream << "<Placemark><name>n</name></Placemark>\n";
        stream << end;
    }
    const auto peak = []
    {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss; // KiB
    };
    readText(groundOverlay("", somewhere));
    const long before = peak();
    const std::vector<KmlOverlay> overlays = readAll(file);
    EXPECT_EQ(overlays.size(), 1u);
    EXPECT_LT(peak() - before, 16 * 1024);

    std::string many;
    for (int i = 0; i < 10001; ++i)
        many += groundOverlay("", somewhere);
    EXPECT_TRUE(contains(faultOfText(many), "more than 10000 ground overlays"));
}
