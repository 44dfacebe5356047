// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where a scene file may reach: beside itself and below, unless the program consents.
#include <geofx/SceneReach.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/GeofxPlugins.h>
#include <tools/NotifyWatch.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osg/CoordinateSystemNode>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <filesystem>

namespace
{

namespace fs = std::filesystem;
using geofx::test::NotifyWatch;
using geofx::test::TempDir;
using osgGeoFX::isWithin;
using osgGeoFX::parseScene;
using osgGeoFX::SceneResult;

TEST(SceneReach, IsTheFolderAndWhatLiesBelow)
{
    const TempDir place;
    const std::string folder = (place / "scene").string();
    place.write("scene/a.tif", "");
    place.write("scene/below/b.tif", "");
    place.write("secret.tif", "");
    place.write("scene-2/c.tif", "");
    fs::create_symlink("../secret.tif", place / "scene/link.tif");
    fs::create_symlink("..", place / "scene/up");
    fs::create_symlink("below", place / "scene/down");
    fs::create_symlink("scene", place / "other-name");
    const auto at = [&](const std::string& name)
    {
        return folder + "/" + name;
    };
    for (const char* inside : {"a.tif", "below/b.tif", "below/../a.tif", "down/b.tif", "not-there.tif",
                               "not/there.tif", "../scene/a.tif", "."})
        EXPECT_TRUE(isWithin(at(inside), folder)) << inside;
    EXPECT_TRUE(isWithin(at("a.tif"), (place / "other-name").string())) << "the folder itself is a link";
    EXPECT_TRUE(isWithin((place / "other-name/a.tif").string(), folder));
    for (const char* outside : {"../secret.tif", "link.tif", "up/secret.tif", "../scene-2/c.tif",
                                "below/../../x", "up/scene-2/c.tif", "..", "../not-there.tif"})
        EXPECT_FALSE(isWithin(at(outside), folder)) << outside;
    for (const char* outside : {"/etc/passwd", "/", "http://example.org/a.tif", "file:///etc/passwd",
                                "/vsicurl/http://example.org/a.tif", "/vsizip/a.zip", "/vsistdin/",
                                "WMS:http://example.org", "<VRTDataset><!-- :// --></VRTDataset>"})
        EXPECT_FALSE(isWithin(outside, folder)) << outside;
}

TEST(SceneReach, OfASceneOnAServerIsWhatLiesBelowItsAddress)
{
    const std::string folder = "http://example.org/maps/oahu";
    for (const char* inside :
         {"http://example.org/maps/oahu/terrain.osgb", "http://example.org/maps/oahu/a/../b.osgb",
          "http://example.org/maps/../maps/oahu/b.osgb"})
        EXPECT_TRUE(isWithin(inside, folder)) << inside;
    for (const char* outside :
         {"http://example.org/maps/oahu-2/terrain.osgb", "http://example.org/maps/oahu/../terrain.osgb",
          "http://example.org/maps/oahu/%2e%2e/terrain.osgb", "https://example.org/maps/oahu/terrain.osgb",
          "http://example.org.evil.org/maps/oahu/terrain.osgb",
          "http://me@example.org/maps/oahu/terrain.osgb", "http://example.org:81/maps/oahu/terrain.osgb",
          "http://example.org", "maps/oahu/terrain.osgb", "/etc/passwd",
          "/vsicurl/http://example.org/maps/oahu/a.tif"})
        EXPECT_FALSE(isWithin(outside, folder)) << outside;
    EXPECT_FALSE(isWithin("http://example.org.evil.org/a.osgb", "http://example.org"));
    EXPECT_TRUE(isWithin("http://example.org/a.osgb", "http://example.org"));
}

TEST(SceneReach, EveryAttributeThatNamesAFileIsLookedAt)
{
    const TempDir place;
    const std::string folder = (place / "scene").string();
    fs::create_directory(folder);
    const auto scene = [](const std::string& terrain, const std::string& effects, const std::string& map = "")
    {
        return "<geofx version='1'><terrain>\n" + terrain + "</terrain>\n<effects>" + effects + "</effects>" +
               map + "</geofx>";
    };
    const std::string database = "<database file='terrain.osgb'/>";
    const std::string out = "='../x'";
    const std::pair<std::string, std::string> cases[] = {
        {scene("<database file" + out + "/>", ""), "2: <database>: file"},
        {scene("<rasters><dem file" + out + "/></rasters>", ""), "2: <dem>: file"},
        {scene("<rasters><dem file='a'/><dem file" + out + "/></rasters>", ""), "2: <dem>: file"},
        {scene("<rasters><dem file='a'/><imagery file" + out + "/></rasters>", ""), "2: <imagery>: file"},
        {scene("<rasters><dem file='a'/><landCover file" + out + " table='worldcover'/></rasters>", ""),
         "2: <landCover>: file"},
        {scene("<rasters><dem file='a'/><landCover file='a' table" + out + "/></rasters>", ""),
         "2: <landCover>: table"},
        {scene("<rasters><dem file='a'/><treeCover file" + out + "/></rasters>", ""), "2: <treeCover>: file"},
        {scene("<rasters cache" + out + "><dem file='a'/></rasters>", ""), "2: <rasters>: cache"},
        {scene(database, "<projectiveMappings><layer name='a' file" + out + "/></projectiveMappings>"),
         "3: <layer>: file"},
        {scene(database, "<projectiveMappings><colorTable name='a' file" + out + "/></projectiveMappings>"),
         "3: <colorTable>: file"},
        {scene(database, "<projectiveMappings><raster file" + out + "/></projectiveMappings>"),
         "3: <raster>: file"},
        {scene(database, "<closeUps><colorTable name='a' file" + out + "/></closeUps>"),
         "3: <colorTable>: file"},
        {scene(database, "<closeUps><surfaceData><dem file" + out + "/></surfaceData></closeUps>"),
         "3: <dem>: file"},
        {scene(database, "<closeUps><surfaceData><dem file='a'/><surface name='s' file" + out +
                             "/></surfaceData></closeUps>"),
         "3: <surface>: file"},
        {scene(database, "<closeUps><surfaceData><dem file='a'/><vectors name='s' file" + out +
                             "/></surfaceData></closeUps>"),
         "3: <vectors>: file"},
        {scene(database, "<closeUps><closeUp><region image" + out + "/></closeUp></closeUps>"),
         "3: <region>: image"},
        {scene(database, "<panoramaMap palette" + out + "/>"), "3: <panoramaMap>: palette"},
        {scene(database, "<panoramaMap skyImage" + out + "/>"), "3: <panoramaMap>: skyImage"},
        {scene(database, "<panoramaMap><lines kind='road' file" + out + "/></panoramaMap>"),
         "3: <lines>: file"},
        {scene(database, "", "<map><mapNames file" + out + "/></map>"), "3: <mapNames>: file"},
        {scene(database, "", "<map><mapNames file='a'/><mapLines file" + out + "/></map>"),
         "3: <mapLines>: file"},
        {scene(database, "", "<map style" + out + "><mapNames file='a'/></map>"), "3: <map>: style"},
        {scene(database, "", "<map fontFile" + out + "><mapNames file='a'/></map>"), "3: <map>: fontFile"},
    };
    for (const auto& [text, begins] : cases)
    {
        const SceneResult result = parseScene(text, "x.geofx", folder);
        ASSERT_TRUE(result.scene) << text << testing::PrintToString(result.errors);
        const std::vector<std::string> errors = osgGeoFX::outsidePaths(*result.scene, folder);
        ASSERT_EQ(errors.size(), 1u) << text;
        EXPECT_EQ(errors[0].rfind("x.geofx:" + begins + "=\"" + (place / "x").string() + "\" leads out", 0),
                  0u)
            << errors[0];
        EXPECT_NE(errors[0].find("--allow-outside"), std::string::npos) << errors[0];
        EXPECT_NE(errors[0].find("\"allowOutside\""), std::string::npos) << errors[0];
    }
    const SceneResult plain = parseScene(
        scene("<rasters cache='c'><dem file='a'/><landCover file='b' table='worldcover'/></rasters>",
              "<panoramaMap palette='below/p.png'/>"),
        "x.geofx", folder);
    ASSERT_TRUE(plain.scene);
    EXPECT_TRUE(osgGeoFX::outsidePaths(*plain.scene, folder).empty());
}

/// A folder with a scene's folder in it, and what lies outside.
class SceneReachPlugin : public geofx::test::GeofxPlugins
{
protected:
    void SetUp() override
    {
        fs::create_directories(_place / "scene/below");
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        root->setEllipsoidModel(new osg::EllipsoidModel);
        root->setFormat("WKT");
        for (const char* file : {"scene/terrain.osgb", "terrain.osgb"})
            ASSERT_TRUE(osgDB::writeNodeFile(*root, (_place / file).string()));
        geofx::test::TestRaster raster(8, 8);
        raster.placed(-158.0, 21.5, 0.01, 0.01)
            .crs("EPSG:4326")
            .fill([](int column, int, int) { return column; });
        for (const char* file : {"scene/in.tif", "scene/below/in.tif", "out.tif"})
            raster.write(_place / file);
        for (const char* file : {"scene/in.geojson", "out.geojson"})
            _place.write(file, R"({"type": "LineString", "coordinates": [[-158, 21.4], [-157.9, 21.45]]})");
    }

    fs::path sceneOf(const std::string& effects,
                     const std::string& terrain = "<database file='terrain.osgb'/>")
    {
        return _place.write("scene/x.geofx", "<geofx version='1'><terrain>" + terrain +
                                                 "</terrain>\n<effects>" + effects + "</effects></geofx>");
    }

    osgDB::ReaderWriter::ReadResult readWith(const fs::path& file, const char* options)
    {
        const osg::ref_ptr<osgDB::Options> consent = new osgDB::Options(options);
        return osgDB::Registry::instance()->readNode(file.string(), consent);
    }

    /// Refused without consent, with a sentence that names the file and the remedy.
    void expectRefused(const fs::path& file, const std::string& holds)
    {
        for (const char* options : {"", "allowOutsider", "noRotation"})
        {
            const std::string message = readWith(file, options).message();
            EXPECT_NE(message.find("x.geofx:"), std::string::npos) << message;
            EXPECT_NE(message.find(holds), std::string::npos) << message;
            EXPECT_NE(message.find("--allow-outside"), std::string::npos) << message;
        }
        EXPECT_NE(messageOf(file).find(holds), std::string::npos) << "without options";
    }

    void expectRead(const fs::path& file, const char* options = "")
    {
        osgDB::ReaderWriter::ReadResult result = readWith(file, options);
        EXPECT_TRUE(result.validNode()) << result.message();
    }

    static std::string rasterElement(const std::string& file)
    {
        return "<projectiveMappings><raster file='" + file + "'/></projectiveMappings>";
    }

    const TempDir _place;
    NotifyWatch _watch;
};

TEST_F(SceneReachPlugin, FilesBesideAndBelowAreRead)
{
    expectRead(sceneOf(rasterElement("in.tif")));
    expectRead(sceneOf(rasterElement("below/in.tif")));
    expectRead(sceneOf(rasterElement("below/../in.tif")));
    expectRead(sceneOf(rasterElement((_place / "scene/in.tif").string())));
    // Through a link to the folder.
    fs::create_directory_symlink("scene", _place / "link");
    sceneOf(rasterElement("in.tif"));
    expectRead(_place / "link/x.geofx");
}

TEST_F(SceneReachPlugin, WhatReachesOutNeedsConsent)
{
    fs::create_symlink("../out.tif", _place / "scene/link.tif");
    fs::create_directory_symlink("..", _place / "scene/up");
    for (const std::string& file :
         {std::string("../out.tif"), (_place / "out.tif").string(), std::string("link.tif"),
          std::string("up/out.tif"), std::string("below/../../out.tif")})
    {
        SCOPED_TRACE(file);
        const fs::path scene = sceneOf(rasterElement(file));
        expectRefused(scene, "leads out of the scene's folder");
        expectRead(scene, "allowOutside");
        expectRead(scene, "noRotation allowOutside");
    }
    const fs::path scene = sceneOf("", "<database file='../terrain.osgb'/>");
    expectRefused(scene, "terrain.osgb\" leads out of the scene's folder");
    expectRead(scene, "allowOutside");
    std::string error;
    EXPECT_FALSE(osgGeoFX::Scene::load(scene.string(), error));
    EXPECT_NE(error.find("leads out of the scene's folder"), std::string::npos) << error;
    const osg::ref_ptr<osgDB::Options> consent = new osgDB::Options("allowOutside");
    EXPECT_TRUE(osgGeoFX::Scene::load(scene.string(), error, consent)) << error;
    // What lies outside is not even looked for.
    const std::string there = messageOf(sceneOf(rasterElement("../out.tif")));
    const std::string nowhere = messageOf(sceneOf(rasterElement("../not.tif")));
    EXPECT_EQ(nowhere.find("does not exist"), std::string::npos) << nowhere;
    EXPECT_EQ(there.size(), nowhere.size());
}

TEST_F(SceneReachPlugin, AddressesAndGdalsOwnNamesNeedConsent)
{
    for (const char* name :
         {"http://127.0.0.1:9/a.tif", "https://127.0.0.1:9/a.tif", "file:///etc/passwd",
          "ftp://127.0.0.1/a.tif", "/vsicurl/http://127.0.0.1:9/a.tif", "/vsizip/in.zip/in.tif",
          "/vsis3/bucket/a.tif", "/vsistdin/", "WMS:http://127.0.0.1:9/?", "vrt://in.tif?bands=1",
          "&lt;GDAL_WMS&gt;&lt;Service "
          "name=&quot;TMS&quot;&gt;&lt;ServerUrl&gt;http://127.0.0.1:9/&lt;/ServerUrl&gt;"
          "&lt;/Service&gt;&lt;/GDAL_WMS&gt;"})
    {
        SCOPED_TRACE(name);
        expectRefused(sceneOf(rasterElement(name)), "leads out of the scene's folder");
        expectRefused(sceneOf("", "<database file='" + std::string(name) + "'/>"), "leads out of");
    }
    // Names without an address are files, and not there.
    for (const char* name : {"PG:dbname=a", "MYSQL:a", "&lt;VRTDataset/&gt;", "NETCDF:in.nc:a"})
        EXPECT_NE(messageOf(sceneOf(rasterElement(name))).find("does not exist"), std::string::npos) << name;
}

TEST_F(SceneReachPlugin, FilesThatTakeTheirDataFromOutsideNeedConsent)
{
    const auto virtualRaster = [](const std::string& source, bool beside)
    {
        return "<VRTDataset rasterXSize='8' rasterYSize='8'><SRS>EPSG:4326</SRS><GeoTransform>-158, 0.01, 0, "
               "21.5, "
               "0, -0.01</GeoTransform><VRTRasterBand dataType='Float32' "
               "band='1'><SimpleSource><SourceFilename "
               "relativeToVRT='" +
               std::string(beside ? "1" : "0") + "'>" + source +
               "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    };
    _place.write("scene/in.vrt", virtualRaster("in.tif", true));
    expectRead(sceneOf(rasterElement("in.vrt")));
    _place.write("scene/twice.vrt", virtualRaster("in.vrt", true));
    expectRead(sceneOf(rasterElement("twice.vrt")));
    const std::pair<const char*, std::string> outside[] = {
        {"up.vrt", virtualRaster("../out.tif", true)},
        {"absolute.vrt", virtualRaster((_place / "out.tif").string(), false)},
        {"disguised.tif", virtualRaster("../out.tif", true)},
        {"spaced.vrt", "\n\n <?xml version='1.0'?>\n" + virtualRaster("../out.tif", true)},
    };
    for (const auto& [name, text] : outside)
    {
        SCOPED_TRACE(name);
        _place.write(std::string("scene/") + name, text);
        expectRefused(sceneOf(rasterElement(name)), "takes data from \"");
    }
    expectRead(sceneOf(rasterElement("up.vrt")), "allowOutside");
    _place.write("scene/upon.vrt", virtualRaster("up.vrt", true));
    expectRefused(sceneOf(rasterElement("upon.vrt")), "out.tif\", which lies outside");
    _place.write("scene/web.vrt", virtualRaster("/vsicurl/http://127.0.0.1:9/a.tif", false));
    expectRefused(sceneOf(rasterElement("web.vrt")), "/vsicurl/");
    // One that names itself ends, too.
    _place.write("scene/self.vrt", virtualRaster("self.vrt", true));
    _watch.messagesOf([&] { messageOf(sceneOf(rasterElement("self.vrt"))); });

    _place.write("scene/lines.vrt",
                 "<OGRVRTDataSource><OGRVRTLayer name='out'><SrcDataSource relativeToVRT='1'>"
                 "../out.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>");
    expectRefused(sceneOf("<panoramaMap><lines kind='road' file='lines.vrt'/></panoramaMap>"),
                  "out.geojson\", which lies");
    expectRead(sceneOf("<panoramaMap><lines kind='road' file='in.geojson'/></panoramaMap>"));
    // A description of a service; nothing is fetched to find that out.
    _place.write("scene/map.xml",
                 "<GDAL_WMS><Service name='TMS'><ServerUrl>http://127.0.0.1:9/${z}/${x}/${y}.png"
                 "</ServerUrl></Service><DataWindow><SizeX>256</SizeX><SizeY>256</SizeY>"
                 "</DataWindow></GDAL_WMS>");
    expectRefused(sceneOf(rasterElement("map.xml")), "takes its data from elsewhere (WMS)");
    // As a DEM of a database that would be built, too.
    expectRefused(sceneOf("", "<rasters cache='cache'><dem file='up.vrt'/></rasters>"), "takes data from \"");
    EXPECT_FALSE(fs::exists(_place / "scene/cache"));
    expectRefused(sceneOf("", "<rasters cache='../cache'><dem file='in.tif'/></rasters>"), "cache=\"");
    EXPECT_FALSE(fs::exists(_place / "cache"));
}

TEST_F(SceneReachPlugin, ScenesWithinScenesComeToAnEnd)
{
    const auto naming = [&](const std::string& name, const std::string& other)
    {
        return _place.write("scene/" + name, "<geofx version='1'>\n<terrain><database file='" + other +
                                                 "'/></terrain></geofx>");
    };
    expectRead(naming("outer.geofx", naming("inner.geofx", "terrain.osgb").filename().string()));
    const char* endless = "scenes are read within each other without end, or more than 16 deep";
    EXPECT_NE(messageOf(naming("self.geofx", "self.geofx")).find(endless), std::string::npos);
    naming("b.geofx", "a.geofx");
    EXPECT_NE(messageOf(naming("a.geofx", "b.geofx")).find(endless), std::string::npos);
    fs::create_symlink("twin.geofx", _place / "scene/link.geofx");
    EXPECT_NE(messageOf(naming("twin.geofx", "link.geofx")).find(endless), std::string::npos);
    std::string next = "terrain.osgb";
    for (int i = 0; i < 30; ++i)
        next = naming("deep" + std::to_string(i) + ".geofx", next).filename().string();
    EXPECT_NE(messageOf(_place / ("scene/" + next)).find(endless), std::string::npos);
    // After all that, another one is read.
    expectRead(_place / "scene/outer.geofx");
}

TEST_F(SceneReachPlugin, ProgramsAskForConsentInWords)
{
    const fs::path scene = sceneOf(rasterElement("../out.tif"));
    geofx::test::ProgramOptions options;
    options.environment = {"DISPLAY="};
    const auto render = geofx::test::runProgram(
        {geofx::test::builtProgram("osggeofx_render"), scene.string(), "-o", (_place / "x.png").string()},
        options);
    EXPECT_EQ(render.exitCode, 2);
    EXPECT_NE(render.standardError.find("leads out of the scene's folder"), std::string::npos)
        << render.standardError;
    const auto help = geofx::test::runProgram({geofx::test::builtProgram("osggeofx_viewer"), "--help"});
    EXPECT_NE(help.standardOutput.find("--allow-outside"), std::string::npos);
    // Any OSG program, by osgDB's own option.
    options.environment.emplace_back("OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib");
    const auto plain =
        geofx::test::runProgram({geofx::test::builtProgram("read_scene"), scene.string()}, options);
    EXPECT_EQ(plain.exitCode, 1);
    EXPECT_NE(plain.standardError.find("\"allowOutside\""), std::string::npos) << plain.standardError;
    const auto consenting = geofx::test::runProgram(
        {geofx::test::builtProgram("read_scene"), scene.string(), "allowOutside"}, options);
    EXPECT_EQ(consenting.exitCode, 0) << consenting.standardError;
}

TEST(SceneExtremes, EndInOneSentenceEach)
{
    const auto errorsOf = [](const std::string& text)
    {
        return parseScene(text, "x.geofx", "/scenes").errors;
    };
    const auto with = [](const std::string& more)
    {
        return "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain>\n" + more + "</geofx>";
    };
    // A hundred thousand elements within each other.
    std::string deep;
    for (int i = 0; i < 100000; ++i)
        deep += "<effects>";
    std::vector<std::string> errors = errorsOf(with(deep));
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_NE(errors[0].find("not well-formed XML"), std::string::npos) << errors[0];
    EXPECT_LT(errors[0].size(), 400u);

    // Numbers of any length are refused, or read as they are: never as another number.
    const std::string nines(400, '9');
    for (const std::string& number : {nines, std::string("-" + nines), std::string("0." + nines),
                                      std::string("1e5"), std::string("INF"), std::string("0x10")})
    {
        SCOPED_TRACE(number);
        const std::string view =
            "<homeView longitude='1' latitude='2' height='" + number + "' heading='0' pitch='0'/>";
        EXPECT_EQ(errorsOf(with(view)).size(), 1u);
        EXPECT_EQ(errorsOf(with("<effects><projectiveMappings originX='" + number + "'/></effects>")).size(),
                  1u);
        EXPECT_EQ(errorsOf(with("<effects><projectiveMappings><mapping west='" + number +
                                "' south='2' east='3' north='4'/></projectiveMappings></effects>"))
                      .size(),
                  1u);
        EXPECT_EQ(errorsOf(with("<effects><closeUps><closeUp><region centerX='" + number +
                                "'/></closeUp></closeUps></effects>"))
                      .size(),
                  1u);
        EXPECT_EQ(errorsOf(with("<effects><closeUps><surfaceData maxSide='" + number +
                                "'><dem file='a'/></surfaceData></closeUps></effects>"))
                      .size(),
                  1u);
    }
    // Values of rasters may be written as floats are, within their range.
    const auto stop = [&](const std::string& value)
    {
        return errorsOf(with("<effects><projectiveMappings><colorTable name='a'><stop value='" + value +
                             "' color='#000000'/></colorTable></projectiveMappings></effects>"))
            .size();
    };
    for (const std::string& number : {nines, std::string("1e31"), std::string("1e400"), std::string("-INF"),
                                      std::string("NaN"), std::string("0x10")})
        EXPECT_EQ(stop(number), 1u) << number;
    EXPECT_EQ(stop("1e5") + stop("0." + nines), 0u);
    // A path longer than any file system has it.
    const SceneResult result = parseScene("<geofx version='1'><terrain><database file='" +
                                              std::string(1000000, 'a') + "'/></terrain></geofx>",
                                          "x.geofx", "/scenes");
    ASSERT_TRUE(result.scene);
    EXPECT_EQ(osgGeoFX::missingFiles(*result.scene).size(), 1u);
}

} // namespace
