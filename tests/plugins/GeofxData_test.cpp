// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The plugin osgdb_geofxdata, through osgDB.
#include <osgGeoFX/paging/Georeference.h>
#include <tools/GeofxPlugins.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <GeographicLib/UTMUPS.hpp>
#include <gdal_priv.h>
#include <osg/CoordinateSystemNode>
#include <osg/LightSource>
#include <osg/Math>
#include <osg/NodeVisitor>
#include <osg/PagedLOD>
#include <osgDB/ReadFile>

#include <array>
#include <atomic>
#include <thread>

namespace
{

namespace fs = std::filesystem;
using geofx::test::TempDir;
using geofx::test::wktOf;
using osg::DegreesToRadians;
using osg::RadiansToDegrees;
using osgGeoFX::Georeference;
using GeofxData = geofx::test::GeofxPlugins;

osg::ref_ptr<Georeference> reference(const std::string& wkt, std::string& error)
{
    const osg::ref_ptr<osg::Node> root = new osg::CoordinateSystemNode("WKT", wkt);
    return Georeference::create(root, error);
}
osg::ref_ptr<Georeference> reference(int epsg)
{
    std::string error;
    osg::ref_ptr<Georeference> result = reference(wktOf(epsg), error);
    EXPECT_TRUE(result) << error;
    return result;
}

TEST_F(GeofxData, ProjectedGeoreferenceIsGeographicLibsUtm)
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

TEST_F(GeofxData, ProjectedWorldIsInMetres)
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

TEST_F(GeofxData, PoleOfAProjectionHasAFrame)
{
    const auto polar = reference(3413); // its meridian towards -y is 45 degrees west
    ASSERT_TRUE(polar);
    osg::Matrixd frame;
    ASSERT_TRUE(polar->localToWorld(DegreesToRadians(-45.0), osg::PI_2, 7.0, frame));
    EXPECT_LT((frame.getTrans() - osg::Vec3d(0, 0, 7)).length(), 0.001);
    EXPECT_LT((osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), frame) - osg::Vec3d(0, 1, 0)).length(), 1e-6);
}

TEST_F(GeofxData, OutsideTheProjectionIsFalse)
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

TEST_F(GeofxData, GeoreferenceServesThreadsAtOnce)
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

TEST_F(GeofxData, GeoreferenceRefusesOtherSystemsInASentence)
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
           ">\n<dem file='dem.tif'/></rasters></terrain>\n<sun azimuth='0' elevation='90'/></geofx>";
}

/// The databases in a cache folder.
std::vector<fs::path> databasesIn(const fs::path& cache)
{
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(cache))
        if (fs::exists(entry.path() / "terrain.osgb")) found.push_back(entry.path() / "terrain.osgb");
    return found;
}

TEST_F(GeofxData, RastersAreBuiltOnceAndAgainWhenTheyChange)
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

    // So are other sources of what lies on the ground.
    fs::copy(folder / "dem.tif", folder / "trees.tif");
    const std::string trees = "<geofx version='1'>\n<terrain>\n<rasters cache='cache'>\n<dem file='dem.tif'/>"
                              "<treeCover file='trees.tif'/></rasters></terrain></geofx>";
    ASSERT_TRUE(osgDB::readRefNodeFile(folder.write("c.geofx", trees).string()));
    EXPECT_EQ(databasesIn(folder / "cache").size(), 4u);
}

TEST_F(GeofxData, ATableOfAFileIsARasterOfItsOwn)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    GDALDataset* const dem = GDALDataset::Open((folder / "dem.tif").c_str(), GDAL_OF_RASTER);
    ASSERT_TRUE(dem);
    const auto append = [&](const char* table)
    {
        const std::string name = std::string("RASTER_TABLE=") + table;
        const std::array<const char*, 4> options = {name.c_str(), "APPEND_SUBDATASET=YES", "TILE_FORMAT=TIFF",
                                                    nullptr};
        GDALClose(GetGDALDriverManager()->GetDriverByName("GPKG")->CreateCopy(
            (folder / "all.gpkg").c_str(), dem, FALSE,
            const_cast<char**>(fs::exists(folder / "all.gpkg") ? options.data() : options.data() + 2),
            nullptr, nullptr));
    };
    append("all");
    append("ground");
    const auto scene = [&](const std::string& table)
    {
        return folder
            .write("a.geofx",
                   "<geofx version='1'><terrain><rasters cache='cache'><dem file='all.gpkg' variable='" +
                       table + "'/></rasters></terrain></geofx>")
            .string();
    };
    ASSERT_TRUE(osgDB::readRefNodeFile(scene("ground")));
    EXPECT_EQ(databasesIn(folder / "cache").size(), 1u);
    ASSERT_TRUE(osgDB::readRefNodeFile(scene("all")));
    EXPECT_EQ(databasesIn(folder / "cache").size(), 2u) << "each table is another source";
    // A file that changed is, too.
    fs::last_write_time(folder / "all.gpkg",
                        fs::last_write_time(folder / "all.gpkg") - std::chrono::hours(1));
    ASSERT_TRUE(osgDB::readRefNodeFile(scene("all")));
    EXPECT_EQ(databasesIn(folder / "cache").size(), 3u);
    GDALClose(dem);
}

TEST_F(GeofxData, SunOfRastersStandsOverTheirMiddle)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    for (const std::string srs : {"geocentric", "EPSG:32604"})
    {
        SCOPED_TRACE(srs);
        const auto file = folder.write("a.geofx", rasterScene("cache='cache' srs='" + srs + "'"));
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file.string());
        ASSERT_TRUE(scene);
        const auto* source = dynamic_cast<osg::LightSource*>(scene->asGroup()->getChild(1));
        ASSERT_TRUE(source);
        const osg::Vec4d position = source->getLight()->getPosition();
        std::string error;
        const osg::ref_ptr<Georeference> place = Georeference::create(scene, error);
        ASSERT_TRUE(place) << error;
        osg::Matrixd frame;
        place->localToWorld(DegreesToRadians(-157.976), DegreesToRadians(21.484), 0.0, frame);
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), frame);
        EXPECT_LT((osg::Vec3d(position.x(), position.y(), position.z()) - up).length(), 1e-4);
    }
}

/// Whether all PagedLODs below a node read through a callback, as they do with a TileGuard; false without any.
bool isGuarded(osg::Node& node)
{
    class Visitor : public osg::NodeVisitor
    {
    public:
        Visitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::PagedLOD& lod) override
        {
            ++all;
            const auto* options = dynamic_cast<osgDB::Options*>(lod.getDatabaseOptions());
            guarded += options && options->getReadFileCallback();
            traverse(lod);
        }
        int all = 0, guarded = 0;
    } visitor;
    node.accept(visitor);
    return visitor.all > 0 && visitor.guarded == visitor.all;
}

TEST_F(GeofxData, TilesOfASceneAreGuarded)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    const auto file = folder.write("a.geofx", rasterScene("cache='cache' tileSize='8'"));
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file.string());
    ASSERT_TRUE(scene);
    EXPECT_TRUE(isGuarded(*scene));
}

TEST_F(GeofxData, FilesThatARasterStandsOnCountAsSources)
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

TEST_F(GeofxData, CacheIsThePersonsByDefault)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    folder.write("a.geofx", rasterScene(""));
    geofx::test::ProgramOptions options;
    options.folder = folder.path().string();
    options.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib",
                           "XDG_CACHE_HOME=" + (folder / "xdg").string()};
    auto result = geofx::test::runProgram({geofx::test::builtProgram("read_scene"), "a.geofx"}, options);
    EXPECT_EQ(result.exitCode, 0) << result.standardError;
    EXPECT_NE(result.standardError.find("osgGeoFX: building the terrain of "), std::string::npos)
        << result.standardError;
    EXPECT_EQ(databasesIn(folder / "xdg/osgGeoFX").size(), 1u);
    options.environment[1] = "XDG_CACHE_HOME=";
    options.environment.push_back("HOME=" + (folder / "home").string());
    result = geofx::test::runProgram({geofx::test::builtProgram("read_scene"), "a.geofx"}, options);
    EXPECT_EQ(result.exitCode, 0) << result.standardError;
    EXPECT_EQ(databasesIn(folder / "home/.cache/osgGeoFX").size(), 1u);
}

TEST_F(GeofxData, ProgramsThatStartAtOnceShareOneBuild)
{
    const TempDir folder;
    writeDem(folder / "dem.tif");
    folder.write("a.geofx", rasterScene("cache='cache' tileSize='8'"));
    geofx::test::ProgramOptions options;
    options.folder = folder.path().string();
    options.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
    std::array<geofx::test::ProgramResult, 3> results;
    std::vector<std::thread> threads;
    for (auto& result : results)
        threads.emplace_back(
            [&] {
                result =
                    geofx::test::runProgram({geofx::test::builtProgram("read_scene"), "a.geofx"}, options);
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

TEST_F(GeofxData, RastersThatCannotBeBuiltAreNamed)
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

TEST_F(GeofxData, WithoutTheDataPluginRastersSayWhatIsMissing)
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
    const auto result =
        geofx::test::runProgram({geofx::test::builtProgram("read_scene"), "a.geofx"}, options);
    EXPECT_NE(result.exitCode, 0);
    EXPECT_NE(
        result.standardError.find("a.geofx:3: <rasters>: rasters are built into a database by the OSG plugin "
                                  "osgdb_geofxdata, which was not found"),
        std::string::npos)
        << result.standardError;
}

} // namespace
