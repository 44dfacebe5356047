// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The plugins osgdb_geofx and osgdb_geofxdata, through osgDB.
#include <osgGeoFX/paging/Georeference.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <osg/CoordinateSystemNode>
#include <osg/Geode>
#include <osg/LightSource>
#include <osg/Math>
#include <osg/Shape>
#include <osg/ShapeDrawable>
#include <osg/ValueObject>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <atomic>
#include <filesystem>
#include <thread>

namespace
{

namespace fs = std::filesystem;
using geofx::test::TempDir;
using osg::DegreesToRadians;
using osg::RadiansToDegrees;
using osgGeoFX::Georeference;

std::string wktOf(int epsg)
{
    OGRSpatialReference srs;
    EXPECT_EQ(srs.importFromEPSG(epsg), OGRERR_NONE);
    char* text = nullptr;
    srs.exportToWkt(&text);
    const std::string wkt = text;
    CPLFree(text);
    return wkt;
}

class GeofxPlugins : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        // Before the folders of an installed osgGeoFX.
        osgDB::Registry::instance()->getLibraryFilePathList().push_front(GEOFX_BUILD_DIR "/lib");
    }

    static osg::ref_ptr<Georeference> reference(const std::string& wkt, std::string& error)
    {
        const osg::ref_ptr<osg::Node> root = new osg::CoordinateSystemNode("WKT", wkt);
        return Georeference::create(root, error);
    }
    static osg::ref_ptr<Georeference> reference(int epsg)
    {
        std::string error;
        osg::ref_ptr<Georeference> result = reference(wktOf(epsg), error);
        EXPECT_TRUE(result) << error;
        return result;
    }

    /// The message of a scene that cannot be read.
    static std::string messageOf(const fs::path& scene)
    {
        const osgDB::ReaderWriter::ReadResult result =
            osgDB::Registry::instance()->readNode(scene.string(), nullptr);
        EXPECT_EQ(result.status(), osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
        return result.message();
    }
};

TEST_F(GeofxPlugins, ProjectedGeoreferenceIsGeographicLibsUtm)
{
    const auto utm = reference(32604);
    ASSERT_TRUE(utm);
    EXPECT_FALSE(utm->isGeocentric());
    for (int i = 0; i < 500; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        geofx::test::Random random(static_cast<std::uint64_t>(i));
        const double longitude = random.uniform(-162.0, -156.0), latitude = random.uniform(0.0, 83.0);
        const double height = random.uniform(-400.0, 8000.0);
        const double lambda = DegreesToRadians(longitude), phi = DegreesToRadians(latitude);
        int zone = 0;
        bool isNorth = false;
        double x = 0.0, y = 0.0, convergence = 0.0, scale = 0.0;
        GeographicLib::UTMUPS::Forward(latitude, longitude, zone, isNorth, x, y, convergence, scale, 4);

        osg::Vec3d world;
        ASSERT_TRUE(utm->toWorld(lambda, phi, height, world));
        EXPECT_LT((world - osg::Vec3d(x, y, height)).length(), 0.001) << longitude << " " << latitude;

        double longitudeBack = 0.0, latitudeBack = 0.0, heightBack = 0.0;
        ASSERT_TRUE(utm->toGeodetic(world, longitudeBack, latitudeBack, heightBack));
        EXPECT_NEAR(longitudeBack * std::cos(phi), lambda * std::cos(phi), 1e-10);
        EXPECT_NEAR(latitudeBack, phi, 1e-10);
        EXPECT_DOUBLE_EQ(heightBack, height);

        // True north lies the grid's convergence west of the grid's north.
        osg::Matrixd frame;
        ASSERT_TRUE(utm->localToWorld(lambda, phi, height, frame));
        const double gamma = DegreesToRadians(convergence);
        const auto turned = [&](const osg::Vec3d& v)
        {
            return osg::Matrixd::transform3x3(v, frame);
        };
        EXPECT_LT((turned({0, 1, 0}) - osg::Vec3d(-std::sin(gamma), std::cos(gamma), 0)).length(), 1e-7);
        EXPECT_LT((turned({1, 0, 0}) - osg::Vec3d(std::cos(gamma), std::sin(gamma), 0)).length(), 1e-7);
        EXPECT_EQ(turned({0, 0, 1}), osg::Vec3d(0, 0, 1));
        EXPECT_EQ(frame.getTrans(), world);
    }
}

TEST_F(GeofxPlugins, ProjectedWorldIsInMetres)
{
    // California zone 1 twice: in metres, and in US survey feet.
    const auto metres = reference(26941), feet = reference(2225);
    ASSERT_TRUE(metres && feet);
    osg::Vec3d a, b;
    ASSERT_TRUE(metres->toWorld(DegreesToRadians(-122.5), DegreesToRadians(41.0), 100.0, a));
    ASSERT_TRUE(feet->toWorld(DegreesToRadians(-122.5), DegreesToRadians(41.0), 100.0, b));
    EXPECT_LT((a - b).length(), 0.001);
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    ASSERT_TRUE(feet->toGeodetic(a, longitude, latitude, height));
    EXPECT_NEAR(RadiansToDegrees(longitude), -122.5, 1e-8);
    EXPECT_NEAR(RadiansToDegrees(latitude), 41.0, 1e-8);
}

TEST_F(GeofxPlugins, PoleOfAProjectionHasAFrame)
{
    const auto polar = reference(3413); // its meridian towards -y is 45 degrees west
    ASSERT_TRUE(polar);
    osg::Matrixd frame;
    ASSERT_TRUE(polar->localToWorld(DegreesToRadians(-45.0), osg::PI_2, 7.0, frame));
    EXPECT_LT((frame.getTrans() - osg::Vec3d(0, 0, 7)).length(), 0.001);
    EXPECT_LT((osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), frame) - osg::Vec3d(0, 1, 0)).length(), 1e-6);
}

TEST_F(GeofxPlugins, OutsideTheProjectionIsFalse)
{
    const auto utm = reference(32604);
    ASSERT_TRUE(utm);
    osg::Vec3d world;
    osg::Matrixd frame;
    double a = 0.0, b = 0.0, c = 0.0;
    EXPECT_FALSE(utm->toWorld(DegreesToRadians(-69.0), 0.0, 0.0, world));
    EXPECT_FALSE(utm->localToWorld(DegreesToRadians(-69.0), 0.0, 0.0, frame));
    EXPECT_FALSE(utm->toGeodetic(osg::Vec3d(1e12, 1e12, 0.0), a, b, c));
}

TEST_F(GeofxPlugins, GeoreferenceServesThreadsAtOnce)
{
    // Half of the threads ask for places outside the projection: PROJ notes that in what the others use, too.
    const auto utm = reference(32604);
    ASSERT_TRUE(utm);
    std::atomic<int> ready{0}, wrong{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back(
            [&, t]
            {
                ++ready;
                while (ready < 4)
                    std::this_thread::yield();
                for (int i = 0; i < 20000; ++i)
                {
                    osg::Vec3d world;
                    double longitude = DegreesToRadians(-161.0 + 0.0002 * i), latitude = 0.3, back = 0.0,
                           height = 0.0;
                    if (t % 2)
                        wrong += utm->toWorld(longitude + osg::PI_2, 0.0, 0.0, world);
                    else
                        wrong += !utm->toWorld(longitude, latitude, 0.0, world) ||
                                 !utm->toGeodetic(world, back, latitude, height) ||
                                 std::abs(back - longitude) > 1e-9;
                }
            });
    for (auto& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST_F(GeofxPlugins, GeoreferenceRefusesOtherSystemsInASentence)
{
    std::string error;
    EXPECT_FALSE(reference(wktOf(4326), error));
    EXPECT_NE(error.find("\"WGS 84\" is not a projected one; build the database again"), std::string::npos)
        << error;
    EXPECT_FALSE(reference("nonsense", error));
    EXPECT_NE(error.find("is not understood; build it again"), std::string::npos) << error;
    EXPECT_FALSE(reference("", error));
    EXPECT_NE(error.find("is not understood; build it again"), std::string::npos) << error;
}

/// A terrain without pages: a box of 2 km around a point of the world, below a node with a coordinate system.
fs::path writeTerrain(const TempDir& folder, osg::CoordinateSystemNode* root, const osg::Vec3d& center)
{
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(new osg::ShapeDrawable(new osg::Box(center, 2000.0f)));
    root->addChild(geode);
    const fs::path file = folder / "terrain.osgb";
    EXPECT_TRUE(osgDB::writeNodeFile(*root, file.string()));
    return file;
}

osg::ref_ptr<osg::CoordinateSystemNode> geocentricRoot()
{
    osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
    root->setEllipsoidModel(new osg::EllipsoidModel);
    return root;
}

std::string sceneWith(const std::string& more)
{
    return "<geofx version='1'>\n<terrain><database file='terrain.osgb'/></terrain>\n" + more + "</geofx>";
}

const osg::Light* sunOf(const osg::Node* scene)
{
    const osg::Group* group = scene ? scene->asGroup() : nullptr;
    for (unsigned int i = 0; group && i < group->getNumChildren(); ++i)
        if (const auto* source = dynamic_cast<const osg::LightSource*>(group->getChild(i)))
            return source->getLight();
    return nullptr;
}

osg::Vec3d directionOf(const osg::Light* sun)
{
    EXPECT_EQ(sun->getPosition().w(), 0.0f);
    return osg::Vec3d(sun->getPosition().x(), sun->getPosition().y(), sun->getPosition().z());
}

TEST_F(GeofxPlugins, SceneTellsProgramsWhatItSays)
{
    const TempDir folder;
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    const auto file = folder.write(
        "a.geofx", sceneWith("<homeView longitude='-157.905' latitude='21.25' altitude='1400' heading='25' "
                             "pitch='-12' verticalFieldOfView='35'/><background colour='#ff0033'/>"
                             "<sun azimuth='0' elevation='0' colour='#00ff00' ambient='#0000ff'/>"));
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file.string());
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->getName(), "osgGeoFX scene");
    std::string text;
    double fov = 0.0;
    bool hasLight = false;
    EXPECT_TRUE(scene->getUserValue("geofx.homeView", text));
    EXPECT_EQ(text, "-157.905,21.25,1400,25,-12,0");
    EXPECT_TRUE(scene->getUserValue("geofx.background", text));
    EXPECT_EQ(text, "1,0,0.2");
    EXPECT_TRUE(scene->getUserValue("geofx.homeFov", fov));
    EXPECT_EQ(fov, 35.0);
    EXPECT_TRUE(scene->getUserValue("geofx.hasLight", hasLight) && hasLight);
    const osg::Light* sun = sunOf(scene);
    ASSERT_TRUE(sun);
    EXPECT_EQ(sun->getLightNum(), 0);
    EXPECT_EQ(sun->getDiffuse(), osg::Vec4(0, 1, 0, 1));
    EXPECT_EQ(sun->getAmbient(), osg::Vec4(0, 0, 1, 1));

    const auto bare = folder.write("b.geofx", sceneWith(""));
    const osg::ref_ptr<osg::Node> other = osgDB::readRefNodeFile(bare.string());
    ASSERT_TRUE(other);
    EXPECT_FALSE(sunOf(other));
    EXPECT_FALSE(other->getStateSet());
    EXPECT_FALSE(other->getUserValue("geofx.homeView", text) || other->getUserValue("geofx.homeFov", fov) ||
                 other->getUserValue("geofx.background", text) ||
                 other->getUserValue("geofx.hasLight", hasLight));
}

TEST_F(GeofxPlugins, SunStandsWhereTheSceneSays)
{
    const TempDir folder;
    const double longitude = -157.8, latitude = 21.4, azimuth = 245.0, elevation = 35.0;
    const GeographicLib::LocalCartesian local(latitude, longitude, 0.0);
    const double a = DegreesToRadians(azimuth), e = DegreesToRadians(elevation);
    osg::Vec3d origin, tip, expected(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
    double lat = 0.0, lon = 0.0, h = 0.0;
    const GeographicLib::Geocentric earth(GeographicLib::Constants::WGS84_a(),
                                          GeographicLib::Constants::WGS84_f());
    earth.Forward(latitude, longitude, 0.0, origin.x(), origin.y(), origin.z());
    local.Reverse(expected.x() * 1000.0, expected.y() * 1000.0, expected.z() * 1000.0, lat, lon, h);
    earth.Forward(lat, lon, h, tip.x(), tip.y(), tip.z());
    const osg::Vec3d world = (tip - origin) / 1000.0;
    const std::string sun = "<sun azimuth='245' elevation='35'/>";

    // At the terrain's centre, and at the home view's place, which is where the terrain is not.
    writeTerrain(folder, geocentricRoot(), origin);
    osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(folder.write("a.geofx", sceneWith(sun)).string());
    ASSERT_TRUE(sunOf(scene));
    EXPECT_LT((directionOf(sunOf(scene)) - world).length(), 1e-5);
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    scene = osgDB::readRefNodeFile(folder.write("b.geofx", sceneWith(sun)).string());
    ASSERT_TRUE(sunOf(scene));
    EXPECT_GT((directionOf(sunOf(scene)) - world).length(), 0.5);
    const std::string view =
        "<homeView longitude='-157.8' latitude='21.4' altitude='0' heading='0' pitch='0'/>";
    scene = osgDB::readRefNodeFile(folder.write("c.geofx", sceneWith(sun + view)).string());
    ASSERT_TRUE(sunOf(scene));
    EXPECT_LT((directionOf(sunOf(scene)) - world).length(), 1e-5);

    // On a projected terrain the azimuth is turned by the grid's convergence.
    int zone = 0;
    bool isNorth = false;
    double x = 0.0, y = 0.0, convergence = 0.0, scale = 0.0;
    GeographicLib::UTMUPS::Forward(latitude, longitude, zone, isNorth, x, y, convergence, scale, 4);
    writeTerrain(folder, new osg::CoordinateSystemNode("WKT", wktOf(32604)), osg::Vec3d(x, y, 0.0));
    scene = osgDB::readRefNodeFile((folder / "a.geofx").string());
    ASSERT_TRUE(sunOf(scene));
    const double grid = a - DegreesToRadians(convergence);
    EXPECT_GT(std::abs(convergence), 0.4);
    EXPECT_LT((directionOf(sunOf(scene)) -
               osg::Vec3d(std::sin(grid) * std::cos(e), std::cos(grid) * std::cos(e), std::sin(e)))
                  .length(),
              1e-5);
}

TEST_F(GeofxPlugins, SceneErrorsReachThePersonThroughOsgviewer)
{
    const TempDir folder;
    folder.write("a.geofx", sceneWith("<effects/>"));
    geofx::test::ProgramOptions options;
    options.folder = folder.path().string();
    options.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
    const auto result = geofx::test::runProgram({"osgviewer", "a.geofx"}, options);
    EXPECT_NE(result.exitCode, 0);
    EXPECT_NE(
        result.standardError.find("a.geofx:3: <effects>: this element is not known in <geofx>; expected: "),
        std::string::npos)
        << result.standardError;
}

TEST_F(GeofxPlugins, SceneSaysWhyItCannotBeRead)
{
    const TempDir folder;
    EXPECT_NE(messageOf(folder.write("a.geofx", sceneWith(""))).find("a.geofx:2: <database>: the file \""),
              std::string::npos);
    folder.write("terrain.osgb", "not a database");
    EXPECT_NE(messageOf(folder / "a.geofx").find("a.geofx:2: <database>: the terrain \""), std::string::npos);

    // A sun needs to know where north is.
    writeTerrain(folder, new osg::CoordinateSystemNode("WKT", "nonsense"), osg::Vec3d());
    EXPECT_TRUE(osgDB::readRefNodeFile((folder / "a.geofx").string()));
    EXPECT_NE(messageOf(folder.write("b.geofx", sceneWith("<sun azimuth='0' elevation='1'/>")))
                  .find("b.geofx:3: <sun>: The scene's coordinate system cannot be used: "),
              std::string::npos);

    EXPECT_EQ(osgDB::Registry::instance()->readNode((folder / "none.geofx").string(), nullptr).status(),
              osgDB::ReaderWriter::ReadResult::FILE_NOT_FOUND);
}

/// A hill of 48 × 32 samples near Oahu.
void writeDem(const fs::path& file)
{
    GDALAllRegister();
    GDALDataset* dataset = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), 48, 32, 1,
                                                                                    GDT_Float32, nullptr);
    ASSERT_TRUE(dataset);
    std::array<double, 6> transform{-158.0, 0.001, 0.0, 21.5, 0.0, -0.001};
    dataset->SetGeoTransform(transform.data());
    dataset->SetProjection(wktOf(4326).c_str());
    std::vector<float> heights;
    for (int i = 0; i < 48 * 32; ++i)
        heights.push_back(float(500.0 - std::hypot(i % 48 - 24, i / 48 - 16) * 10.0));
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 48, 32, heights.data(), 48, 32, GDT_Float32,
                                                  0, 0),
              CE_None);
    GDALClose(dataset);
}

std::string rasterScene(const std::string& attributes)
{
    return "<geofx version='1'>\n<terrain>\n<rasters " + attributes +
           ">\n<dem file='dem.tif'/></rasters></terrain>\n<sun azimuth='1' elevation='2'/></geofx>";
}

/// The databases in a cache folder.
std::vector<fs::path> databasesIn(const fs::path& cache)
{
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(cache))
        if (fs::exists(entry.path() / "terrain.osgb")) found.push_back(entry.path() / "terrain.osgb");
    return found;
}

TEST_F(GeofxPlugins, RastersAreBuiltOnceAndAgainWhenTheyChange)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    const std::string scene = folder.write("a.geofx", rasterScene("cache='cache'")).string();
    ASSERT_TRUE(osgDB::readRefNodeFile(scene));
    ASSERT_EQ(databasesIn(folder / "cache").size(), 1u);
    const fs::path database = databasesIn(folder / "cache")[0];

    // What is there is not written again.
    const fs::file_time_type past = fs::last_write_time(database) - std::chrono::hours(1);
    fs::last_write_time(database, past);
    ASSERT_TRUE(osgDB::readRefNodeFile(scene));
    EXPECT_EQ(fs::last_write_time(database), past);
    ASSERT_EQ(databasesIn(folder / "cache").size(), 1u);

    // Other options, and a source of another time, are other databases.
    ASSERT_TRUE(
        osgDB::readRefNodeFile(folder.write("b.geofx", rasterScene("cache='cache' tileSize='16'")).string()));
    EXPECT_EQ(databasesIn(folder / "cache").size(), 2u);
    fs::last_write_time(folder / "dem.tif", past);
    ASSERT_TRUE(osgDB::readRefNodeFile(scene));
    EXPECT_EQ(databasesIn(folder / "cache").size(), 3u);
}

TEST_F(GeofxPlugins, FilesThatARasterStandsOnCountAsSources)
{
    const TempDir folder;
    writeDem(folder / "part.tif");
    folder.write("dem.tif", R"(<VRTDataset rasterXSize="48" rasterYSize="32"><SRS>EPSG:4326</SRS>
<GeoTransform>-158, 0.001, 0, 21.5, 0, -0.001</GeoTransform><VRTRasterBand dataType="Float32" band="1">
<SimpleSource><SourceFilename relativeToVRT="1">part.tif</SourceFilename><SourceBand>1</SourceBand></SimpleSource>
</VRTRasterBand></VRTDataset>)");
    const std::string scene = folder.write("a.geofx", rasterScene("cache='cache'")).string();
    ASSERT_TRUE(osgDB::readRefNodeFile(scene));
    fs::last_write_time(folder / "part.tif",
                        fs::last_write_time(folder / "part.tif") - std::chrono::hours(1));
    ASSERT_TRUE(osgDB::readRefNodeFile(scene));
    EXPECT_EQ(databasesIn(folder / "cache").size(), 2u);
}

TEST_F(GeofxPlugins, CacheIsThePersonsByDefault)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    folder.write("a.geofx", rasterScene(""));
    geofx::test::ProgramOptions options;
    options.folder = folder.path().string();
    options.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib",
                           "XDG_CACHE_HOME=" + (folder / "xdg").string()};
    auto result = geofx::test::runProgram({"osgconv", "a.geofx", "a.osgt"}, options);
    EXPECT_EQ(result.exitCode, 0) << result.standardError;
    EXPECT_NE(result.standardError.find("osgGeoFX: building the terrain of "), std::string::npos)
        << result.standardError;
    EXPECT_EQ(databasesIn(folder / "xdg/osgGeoFX").size(), 1u);
    options.environment[1] = "XDG_CACHE_HOME=";
    options.environment.push_back("HOME=" + (folder / "home").string());
    result = geofx::test::runProgram({"osgconv", "a.geofx", "a.osgt"}, options);
    EXPECT_EQ(result.exitCode, 0) << result.standardError;
    EXPECT_EQ(databasesIn(folder / "home/.cache/osgGeoFX").size(), 1u);
}

TEST_F(GeofxPlugins, ProgramsThatStartAtOnceShareOneBuild)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    folder.write("a.geofx", rasterScene("cache='cache' tileSize='8'"));
    geofx::test::ProgramOptions options;
    options.folder = folder.path().string();
    options.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
    std::array<geofx::test::ProgramResult, 3> results;
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < results.size(); ++i)
        threads.emplace_back(
            [&, i]
            {
                results[i] = geofx::test::runProgram(
                    {"osgconv", "a.geofx", "out" + std::to_string(i) + ".osgt"}, options);
            });
    for (auto& thread : threads)
        thread.join();
    int builders = 0;
    for (const auto& result : results)
    {
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        builders += result.standardError.find("building the terrain of ") != std::string::npos;
    }
    EXPECT_EQ(builders, 1);
    EXPECT_EQ(databasesIn(folder / "cache").size(), 1u);
}

TEST_F(GeofxPlugins, RastersThatCannotBeBuiltAreNamed)
{
    const TempDir folder;
    folder.write("dem.tif", "not a raster");
    const auto scene = folder.write("a.geofx", rasterScene("cache='cache'"));
    std::string message = messageOf(scene);
    EXPECT_NE(message.find("a.geofx:3: <rasters>: "), std::string::npos) << message;
    EXPECT_NE(message.find("dem.tif"), std::string::npos) << message;

    writeDem(folder / "dem.tif");
    folder.write("file", "");
    message = messageOf(folder.write("b.geofx", rasterScene("cache='file/cache'")));
    EXPECT_NE(message.find("b.geofx:3: <rasters>: "), std::string::npos) << message;
    EXPECT_NE(message.find("; name another folder in the attribute \"cache\""), std::string::npos) << message;
}

TEST_F(GeofxPlugins, WithoutTheDataPluginRastersSayWhatIsMissing)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    folder.write("a.geofx", rasterScene("cache='cache'"));
    const std::string plugins = std::string("osgPlugins-") + osgGetVersion();
    fs::create_directories(folder / plugins);
    fs::copy_file(fs::path(GEOFX_BUILD_DIR "/lib") / plugins / "osgdb_geofx.so",
                  folder.path() / plugins / "osgdb_geofx.so");
    geofx::test::ProgramOptions options;
    options.folder = folder.path().string();
    options.environment = {"OSG_LIBRARY_PATH=" + folder.path().string(), "LD_LIBRARY_PATH="};
    const auto result = geofx::test::runProgram({"osgviewer", "a.geofx"}, options);
    EXPECT_NE(result.exitCode, 0);
    EXPECT_NE(
        result.standardError.find("a.geofx:3: <rasters>: rasters are built into a database by the OSG plugin "
                                  "osgdb_geofxdata, which was not found"),
        std::string::npos)
        << result.standardError;
}

} // namespace
