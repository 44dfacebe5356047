// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Scenes on a web server: the same pictures as from a disk, with a cache without the server, too; what a bad server does
// to them; how many files are fetched at once.
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/GlFixture.h>
#include <tools/PagedScene.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestServer.h>

#include <osg/PagedLOD>
#include <osg/ShapeDrawable>
#include <osgDB/FileCache>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

const osg::Vec3i red(255, 0, 0), green(0, 255, 0), blue(0, 0, 255);

osg::Matrixd fromAbove(double height = 8000.0)
{
    return osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, height), osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0));
}

/// Colors at the middles of the quadrants: south-west, south-east, north-west, north-east.
std::vector<osg::Vec3i> quadrants(const osg::Image& image)
{
    std::vector<osg::Vec3i> colors;
    for (const auto& [x, y] : {std::pair(48, 48), std::pair(80, 48), std::pair(48, 80), std::pair(80, 80)})
    {
        const unsigned char* const p = image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        colors.emplace_back(p[0], p[1], p[2]);
    }
    return colors;
}

std::string contentOf(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::size_t filesBelow(const fs::path& folder)
{
    std::size_t count = 0;
    if (fs::exists(folder))
        for (const auto& each : fs::recursive_directory_iterator(folder))
            count += each.is_regular_file() ? 1 : 0;
    return count;
}

class Serving : public GlFixture
{
protected:
    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        PagedScene::write(folder / "site", PagedScene::Kind::Flat);
        // The pager's options are the registry's.
        former = osgDB::Registry::instance()->getOptions();
        osgDB::Registry::instance()->setOptions(new osgDB::Options("OSG_CURL_TIMEOUT=1"));
    }
    void TearDown() override
    {
        if (!IsSkipped()) osgDB::Registry::instance()->setOptions(former);
        osgDB::Registry::instance()->setFileCache(nullptr);
        GlFixture::TearDown();
    }

    std::unique_ptr<SceneRenderer> rendererOf(const std::string& url)
    {
        std::string error;
        scene = Scene::load(url, error);
        EXPECT_TRUE(scene) << error;
        if (!scene) return nullptr;
        scene->guard->setRetryDelay(0.2);
        SceneRenderer::Options options;
        options.width = options.height = 128;
        options.timeout = 60.0;
        auto renderer = SceneRenderer::create(*scene, options, error);
        EXPECT_TRUE(renderer) << error;
        return renderer;
    }
    osg::ref_ptr<osg::Image> draw(SceneRenderer& renderer)
    {
        std::string error;
        FrameStatistics statistics;
        osg::ref_ptr<osg::Image> image = renderer.render(fromAbove(), time += 0.1, statistics, error);
        EXPECT_TRUE(image.valid()) << error;
        return image;
    }
    ProgramResult render(const std::string& name, const std::string& output,
                         const std::vector<std::string>& environment = {})
    {
        ProgramOptions options;
        options.folder = folder.path().string();
        options.environment = environment;
        options.environment.push_back("DISPLAY=");
        return runProgram({builtProgram("osggeofx_render"), name, "-o", output, "--size", "160x120"},
                          options);
    }

    TempDir folder;
    TestServer server{folder / "site"};
    osg::ref_ptr<osgDB::Options> former;
    std::optional<Scene> scene;
    double time = 0.0;
};

TEST_F(Serving, AllTilesComeOnceAndAreCounted)
{
    const auto renderer = rendererOf(server.url("terrain.osgb"));
    ASSERT_TRUE(renderer);
    for (int turn = 0; turn < 2; ++turn)
        EXPECT_EQ(quadrants(*draw(*renderer)), std::vector<osg::Vec3i>(4, blue));
    std::uintmax_t bytes = 0;
    for (const auto& tile : fs::directory_iterator(folder / "site/tiles"))
        bytes += tile.file_size();
    EXPECT_EQ(scene->guard->counts().tilesRead, 5u);
    EXPECT_EQ(scene->guard->counts().bytesRead, bytes);
    EXPECT_EQ(server.requests().size(), 6u) << ::testing::PrintToString(server.requests());
}

struct Bad
{
    const char* name;
    TestServer::Fault fault;
    bool isTold; ///< by osgdb_curl, too, for each request
};

std::ostream& operator<<(std::ostream& stream, const Bad& bad)
{
    return stream << bad.name;
}

class BadServer : public Serving, public ::testing::WithParamInterface<Bad>
{
};

TEST_P(BadServer, LeavesTheParentOnScreenAndIsAskedAgain)
{
    osgDB::Registry::instance()->setFileCache(new osgDB::FileCache((folder / "cache").string()));
    const std::string bad = "tiles/1_1_0.osgb";
    server.setFault(GetParam().fault, bad);
    std::unique_ptr<SceneRenderer> renderer;
    osg::ref_ptr<osg::Image> image;
    std::vector<std::string> heard = watch().messagesOf(
        [&]
        {
            renderer = rendererOf(server.url("terrain.osgb"));
            ASSERT_TRUE(renderer);
            scene->guard->setRetryDelay(1000.0);
            for (int turn = 0; turn < 5; ++turn)
                image = draw(*renderer);
        });
    ASSERT_TRUE(renderer);
    EXPECT_EQ(quadrants(*image), (std::vector<osg::Vec3i>{blue, green, blue, blue}));
    // libcurl tries a reset connection that it has used before once more.
    EXPECT_LE(server.requestsOf(bad), GetParam().fault == TestServer::Fault::Reset ? 2u : 1u)
        << "it is asked again and again";
    EXPECT_EQ(scene->guard->counts().tilesFailed, 1u);
    EXPECT_EQ(scene->guard->failedFiles(), std::set<std::string>{server.url(bad)});
    EXPECT_EQ(filesBelow(folder / "cache"), 5u) << "what stands in for the tile is kept, too";
    const auto isOurs = [](const std::string& message)
    {
        return message.find("osgGeoFX: ") != std::string::npos;
    };
    EXPECT_EQ(heard.size(), GetParam().isTold ? 2u : 1u) << ::testing::PrintToString(heard);
    const auto ours = std::find_if(heard.begin(), heard.end(), isOurs);
    ASSERT_NE(ours, heard.end());
    EXPECT_NE(ours->find(server.url(bad)), std::string::npos) << *ours;
    EXPECT_EQ(std::count_if(heard.begin(), heard.end(), isOurs), 1);

    // Another time, with little patience: it is asked for again, and comes when the server is whole.
    heard = watch().messagesOf(
        [&]
        {
            osgDB::Registry::instance()->setFileCache(nullptr);
            renderer = rendererOf(server.url("terrain.osgb"));
            ASSERT_TRUE(renderer);
            EXPECT_EQ(quadrants(*draw(*renderer))[1], green);
            server.setFault(TestServer::Fault::None);
            const auto start = Clock::now();
            do
            {
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                image = draw(*renderer);
            } while (quadrants(*image)[1] != blue && Clock::now() - start < std::chrono::seconds(30));
        });
    EXPECT_EQ(quadrants(*image), std::vector<osg::Vec3i>(4, blue));
    EXPECT_TRUE(scene->guard->failedFiles().empty());
    EXPECT_EQ(scene->guard->counts().tilesRead, 5u);
}

INSTANTIATE_TEST_SUITE_P(Faults, BadServer,
                         ::testing::Values(Bad{"NotFound", TestServer::Fault::NotFound, false},
                                           Bad{"Broken", TestServer::Fault::Broken, false},
                                           Bad{"Truncated", TestServer::Fault::Truncated, true},
                                           Bad{"Unnoticed", TestServer::Fault::Unnoticed, false},
                                           Bad{"Reset", TestServer::Fault::Reset, true},
                                           Bad{"Silent", TestServer::Fault::Silent, true},
                                           Bad{"Page", TestServer::Fault::Page, false}),
                         [](const ::testing::TestParamInfo<Bad>& parameter)
                         { return std::string(parameter.param.name); });

TEST_F(Serving, AServerThatGoesAwayAndComesBack)
{
    const auto renderer = rendererOf(server.url("terrain.osgb"));
    ASSERT_TRUE(renderer);
    server.stop();
    osg::ref_ptr<osg::Image> image;
    const std::vector<std::string> heard = watch().messagesOf(
        [&]
        {
            EXPECT_EQ(quadrants(*draw(*renderer)), std::vector<osg::Vec3i>(4, red));
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            EXPECT_EQ(quadrants(*draw(*renderer)), std::vector<osg::Vec3i>(4, red));
            server.start();
            const auto start = Clock::now();
            do
            {
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                image = draw(*renderer);
            } while (quadrants(*image) != std::vector<osg::Vec3i>(4, blue) &&
                     Clock::now() - start < std::chrono::seconds(60));
        });
    EXPECT_EQ(quadrants(*image), std::vector<osg::Vec3i>(4, blue));
    const auto ours = std::count_if(heard.begin(), heard.end(),
                                    [](const std::string& message)
                                    { return message.find("osgGeoFX: ") != std::string::npos; });
    EXPECT_EQ(ours, 1) << ::testing::PrintToString(heard);
}

/// Tiles beside each other, which are asked for at once.
void writeGrid(const fs::path& folder, int count)
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osgDB::Options> compressed = new osgDB::Options("Compressor=zlib");
    for (int i = 0; i < count; ++i)
    {
        const osg::Vec3 center(static_cast<float>(i % 8) * 400.0f - 1400.0f,
                               static_cast<float>(i / 8) * 400.0f - 1400.0f, 0.0f);
        const osg::ref_ptr<osg::ShapeDrawable> box = new osg::ShapeDrawable(new osg::Box(center, 300.0f));
        const osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
        lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        lod->setCenter(center);
        lod->setRadius(300.0f);
        lod->setFileName(0, "grid/" + std::to_string(i) + ".osgb");
        lod->setRange(0, 0.0f, 1e9f);
        root->addChild(lod);
        fs::create_directories(folder / "grid");
        osgDB::writeNodeFile(*box, (folder / "grid" / (std::to_string(i) + ".osgb")).string(), compressed);
    }
    osgDB::writeNodeFile(*root, (folder / "grid.osgb").string(), compressed);
}

TEST_F(Serving, EightFilesAreFetchedAtOnce)
{
    constexpr int count = 32;
    constexpr std::chrono::milliseconds delay(200);
    writeGrid(folder / "site", count);
    const auto renderer = rendererOf(server.url("grid.osgb"));
    ASSERT_TRUE(renderer);
    server.setDelay(delay);
    const auto start = Clock::now();
    draw(*renderer);
    const auto taken = Clock::now() - start;
    EXPECT_EQ(scene->guard->counts().tilesRead, static_cast<std::uint64_t>(count));
    EXPECT_EQ(server.mostAtOnce(), 8);
    EXPECT_GE(taken, count / 8 * delay);
    EXPECT_LT(taken, count * delay / 2) << "one after the other, it were 6.4 s";
    RecordProperty("milliseconds",
                   static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(taken).count()));
}

TEST_F(Serving, TheProgramMakesTheSameBytesFromDiskServerAndCache)
{
    PagedScene::write(folder / "site", PagedScene::Kind::Geocentric);
    folder.write("site/scene.geofx",
                 "<geofx version=\"1\">\n<terrain><database file=\"terrain.osgb\"/></terrain>\n"
                 "<homeView longitude=\"-157.8\" latitude=\"21.4\" height=\"8100\" heading=\"0\" "
                 "pitch=\"-90\"/>\n</geofx>\n");
    const std::string cache = "OSG_FILE_CACHE=" + (folder / "cache").string();
    for (const std::string name : {"terrain.osgb", "scene.geofx"})
    {
        SCOPED_TRACE(name);
        const ProgramResult disk = render("site/" + name, "disk.png");
        ASSERT_EQ(disk.exitCode, 0) << disk.standardError;
        server.forgetRequests();
        const ProgramResult plain = render(server.url(name), "plain.png");
        EXPECT_EQ(plain.exitCode, 0) << plain.standardError;
        EXPECT_EQ(plain.standardError, "");
        EXPECT_EQ(contentOf(folder / "plain.png"), contentOf(folder / "disk.png"));
        EXPECT_FALSE(server.requests().empty());
        const ProgramResult filling = render(server.url(name), "filling.png", {cache});
        EXPECT_EQ(filling.exitCode, 0) << filling.standardError;
        EXPECT_EQ(filling.standardError, "");
        server.stop();
        const ProgramResult cached = render(server.url(name), "cached.png", {cache});
        EXPECT_EQ(cached.exitCode, 0) << cached.standardError;
        EXPECT_NE(cached.standardError.find("its copy in the file cache is used"), std::string::npos)
            << cached.standardError;
        EXPECT_EQ(contentOf(folder / "cached.png"), contentOf(folder / "disk.png"));
        const ProgramResult nothing = render(server.url(name), "nothing.png");
        EXPECT_EQ(nothing.exitCode, 2);
        EXPECT_NE(nothing.standardError.find(server.url(name)), std::string::npos) << nothing.standardError;
        server.start();
    }
}

TEST_F(Serving, ASceneReachesWhatLiesBelowItAndNothingElse)
{
    PagedScene::write(folder / "site", PagedScene::Kind::Geocentric);
    folder.write("site/below/other.txt", "");
    const auto refused = [&](const std::string& terrain, const std::string& word)
    {
        folder.write("site/below/scene.geofx",
                     "<geofx version=\"1\">\n<terrain>" + terrain + "</terrain>\n</geofx>\n");
        server.forgetRequests();
        std::string error;
        EXPECT_FALSE(Scene::load(server.url("below/scene.geofx"), error)) << terrain;
        EXPECT_NE(error.find(word), std::string::npos) << error;
        EXPECT_EQ(server.requests(), std::vector<std::string>{"below/scene.geofx"}) << terrain;
    };
    const std::string outside = "leads out of the scene's folder";
    refused("<database file=\"../terrain.osgb\"/>", outside);
    refused("<database file=\"x/../../terrain.osgb\"/>", outside);
    refused("<database file=\"%2e%2e/terrain.osgb\"/>", outside);
    refused("<database file=\"/terrain.osgb\"/>", outside);
    refused("<database file=\"" + server.url("terrain.osgb") + "\"/>", outside);
    refused("<database file=\"http://127.0.0.1:1/below/terrain.osgb\"/>", outside);
    refused("<database file=\"/vsicurl/http://127.0.0.1:1/terrain.osgb\"/>", outside);
    refused("<rasters><dem file=\"dem.tif\"/></rasters>", "is not fetched");
}

} // namespace
