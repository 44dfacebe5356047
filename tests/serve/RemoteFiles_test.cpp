// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Files on a web server, one at a time: what is read, what is kept in the cache, and what is said of faults.
#include <osgGeoFX/paging/RemoteFiles.h>
#include <tools/NotifyWatch.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>
#include <tools/TestServer.h>

#include <gtest/gtest.h>
#include <osg/PagedLOD>
#include <osgDB/FileCache>
#include <osgDB/Registry>

#include <chrono>
#include <fstream>
#include <iterator>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

namespace fs = std::filesystem;
using Fault = RemoteFiles::Fault;
using Order = RemoteFiles::Order;

std::string contentOf(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

const osg::PagedLOD* firstLod(const osg::Node& root)
{
    return root.asGroup() ? dynamic_cast<const osg::PagedLOD*>(root.asGroup()->getChild(0)) : nullptr;
}

class Remote : public ::testing::Test
{
protected:
    Remote()
    {
        PagedScene::write(folder / "site", PagedScene::Kind::Flat);
        options->setFileCache(new osgDB::FileCache((folder / "cache").string()));
    }

    RemoteFiles::Node read(const std::string& name, Order order, std::size_t messages = 0)
    {
        RemoteFiles::Node result;
        heard = watch.messagesOf([&] { result = RemoteFiles::readNode(server.url(name), options, order); });
        EXPECT_EQ(heard.size(), messages) << ::testing::PrintToString(heard);
        return result;
    }
    fs::path kept(const std::string& name) const { return folder / "cache" / server.address() / name; }
    /// All files below a folder.
    std::size_t count(const fs::path& below) const
    {
        std::size_t files = 0;
        if (fs::exists(below))
            for (const auto& each : fs::recursive_directory_iterator(below))
                files += each.is_regular_file() ? 1 : 0;
        return files;
    }

    TempDir folder;
    NotifyWatch watch;
    TestServer server{folder / "site"};
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("OSG_CURL_TIMEOUT=1");
    std::vector<std::string> heard;
};

const std::string tile = "tiles/0_0_0.osgb";

TEST_F(Remote, ANodeIsReadAndKeptByteByByte)
{
    const RemoteFiles::Node root = read("terrain.osgb", Order::ServerFirst);
    ASSERT_TRUE(root.node.valid()) << root.reason;
    EXPECT_EQ(root.fault, Fault::None);
    EXPECT_EQ(root.bytes, fs::file_size(folder / "site/terrain.osgb"));
    ASSERT_NE(firstLod(*root.node), nullptr);
    EXPECT_EQ(firstLod(*root.node)->getDatabasePath(), server.url(""))
        << "its tiles are looked for elsewhere";
    EXPECT_EQ(contentOf(kept("terrain.osgb")), contentOf(folder / "site/terrain.osgb"));
    EXPECT_EQ(count(folder / "cache"), 1u) << "something else was left there";
    EXPECT_EQ(server.requests(), std::vector<std::string>{"terrain.osgb"});
}

TEST_F(Remote, TilesComeFromTheCacheAndRootsFromTheServer)
{
    for (const Order order : {Order::ServerFirst, Order::CacheFirst})
    {
        server.forgetRequests();
        for (int turn = 0; turn < 3; ++turn)
            EXPECT_TRUE(read(tile, order).node.valid());
        EXPECT_EQ(server.requests().size(), order == Order::CacheFirst ? 0u : 3u);
    }
}

TEST_F(Remote, WithoutACacheNothingIsKept)
{
    options = nullptr;
    EXPECT_TRUE(read(tile, Order::CacheFirst).node.valid());
    EXPECT_TRUE(read(tile, Order::CacheFirst).node.valid());
    EXPECT_EQ(server.requestsOf(tile), 2u);
    EXPECT_FALSE(fs::exists(folder / "cache"));
}

TEST_F(Remote, ADamagedCopyIsFetchedAgain)
{
    EXPECT_TRUE(read(tile, Order::CacheFirst).node.valid());
    const std::string whole = contentOf(kept(tile));
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{5}, std::size_t{40}, whole.size() / 2, whole.size() - 1})
    {
        server.forgetRequests();
        std::ofstream(kept(tile), std::ios::binary) << whole.substr(0, size);
        EXPECT_TRUE(read(tile, Order::CacheFirst).node.valid()) << size;
        EXPECT_EQ(server.requestsOf(tile), 1u) << size;
        EXPECT_EQ(contentOf(kept(tile)), whole) << size;
    }
}

TEST_F(Remote, ADamagedCopyOfARootIsNoLastResort)
{
    EXPECT_TRUE(read("terrain.osgb", Order::ServerFirst).node.valid());
    std::ofstream(kept("terrain.osgb"), std::ios::binary) << "half";
    server.setFault(TestServer::Fault::Broken);
    const RemoteFiles::Node root = read("terrain.osgb", Order::ServerFirst);
    EXPECT_FALSE(root.node.valid());
    EXPECT_EQ(root.fault, Fault::Refused);
}

TEST_F(Remote, ACopyServesWhileTheServerFails)
{
    EXPECT_TRUE(read("terrain.osgb", Order::ServerFirst).node.valid());
    server.setFault(TestServer::Fault::Broken);
    const RemoteFiles::Node broken = read("terrain.osgb", Order::ServerFirst, 1);
    EXPECT_TRUE(broken.node.valid());
    EXPECT_NE(heard.front().find(server.url("terrain.osgb")), std::string::npos) << heard.front();
    EXPECT_NE(heard.front().find("500"), std::string::npos) << heard.front();
    EXPECT_EQ(firstLod(*broken.node)->getDatabasePath(), server.url(""));
    server.setFault(TestServer::Fault::NotFound);
    EXPECT_FALSE(read("terrain.osgb", Order::ServerFirst).node.valid())
        << "the file is gone, and the server says so";
}

TEST_F(Remote, AnotherRootEmptiesTheCacheBelowIt)
{
    EXPECT_TRUE(read("terrain.osgb", Order::ServerFirst).node.valid());
    EXPECT_TRUE(read(tile, Order::CacheFirst).node.valid());
    std::ofstream(kept("notes.txt")) << "not a tile";
    EXPECT_TRUE(read("terrain.osgb", Order::ServerFirst).node.valid());
    EXPECT_TRUE(fs::exists(kept(tile))) << "the root is the same";
    PagedScene::write(folder / "site", PagedScene::Kind::Geocentric);
    EXPECT_TRUE(read("terrain.osgb", Order::ServerFirst).node.valid());
    EXPECT_FALSE(fs::exists(kept(tile))) << "a tile of another build is shown below this root";
    EXPECT_EQ(contentOf(kept("terrain.osgb")), contentOf(folder / "site/terrain.osgb"));
    EXPECT_TRUE(fs::exists(kept("notes.txt")));
}

TEST_F(Remote, ACacheThatCannotBeWrittenIsToldOfOnce)
{
    folder.write("file", "");
    options->setFileCache(new osgDB::FileCache((folder / "file").string()));
    EXPECT_TRUE(read(tile, Order::CacheFirst, 1).node.valid());
    EXPECT_NE(heard.front().find("OSG_FILE_CACHE"), std::string::npos) << heard.front();
    EXPECT_TRUE(read(tile, Order::CacheFirst, 0).node.valid());
}

TEST_F(Remote, NamesDoNotLeadOutOfTheCache)
{
    const std::string cache = (folder / "cache").string();
    const auto file = [&](const std::string& url)
    {
        return RemoteFiles::cacheFileOf(url, options);
    };
    EXPECT_EQ(file("http://example.org/a/b.osgb"), cache + "/example.org/a/b.osgb");
    EXPECT_EQ(file("https://example.org:8080/a/../b/./c.osgb"), cache + "/example.org:8080/b/c.osgb");
    EXPECT_EQ(file("http://example.org/a/../../../../etc/x.osgb"), cache + "/example.org/etc/x.osgb");
    EXPECT_EQ(file("http://me:secret@example.org/a.osgb"), cache + "/example.org/a.osgb");
    EXPECT_EQ(file("http://example.org/a.osgb#part"), cache + "/example.org/a.osgb");
    for (const char* none : {"http://../a.osgb", "http://./a.osgb", "http:///a.osgb", "http://example.org/",
                             "http://me@../a.osgb", "/etc/passwd", "a.osgb", ""})
        EXPECT_EQ(file(none), "") << none;
    EXPECT_EQ(RemoteFiles::cacheFileOf("http://example.org/a.osgb", nullptr), "") << "there is no cache";
}

TEST_F(Remote, PathsDoNotGrowFromTileToTile)
{
    EXPECT_EQ(RemoteFiles::normalOf("http://example.org/tiles/0/0/../../1/./0/0.osgb?a=../b#c/.."),
              "http://example.org/tiles/1/0/0.osgb?a=../b#c/..");
    EXPECT_EQ(RemoteFiles::normalOf("http://example.org"), "http://example.org");
    EXPECT_EQ(RemoteFiles::normalOf("../a.osgb"), "../a.osgb") << "it is no address";
    const RemoteFiles::Node root = read("tiles/x/../../tiles/./../terrain.osgb", Order::ServerFirst);
    ASSERT_TRUE(root.node.valid()) << root.reason;
    EXPECT_EQ(firstLod(*root.node)->getDatabasePath(), server.url(""));
    EXPECT_EQ(server.requests(), std::vector<std::string>{"terrain.osgb"});
}

struct Failure
{
    const char* name;
    TestServer::Fault atServer;
    Fault fault;
    const char* word;
    std::size_t messages; ///< osgdb_curl says itself, at level NOTICE, what libcurl could not do
};

std::ostream& operator<<(std::ostream& stream, const Failure& failure)
{
    return stream << failure.name;
}

class FailingServer : public Remote, public ::testing::WithParamInterface<Failure>
{
};

TEST_P(FailingServer, IsAFaultWithAReasonAndNothingIsKept)
{
    server.setFault(GetParam().atServer);
    const auto start = std::chrono::steady_clock::now();
    const RemoteFiles::Node result = read(tile, Order::CacheFirst, GetParam().messages);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    EXPECT_FALSE(result.node.valid());
    EXPECT_EQ(result.fault, GetParam().fault);
    EXPECT_NE(result.reason.find(GetParam().word), std::string::npos) << result.reason;
    EXPECT_FALSE(RemoteFiles::remedyOf(result.fault).empty());
    EXPECT_EQ(server.requestsOf(tile), 1u) << "it was asked more than once";
    EXPECT_EQ(count(folder / "cache"), 0u) << "a fault was kept";
    server.setFault(TestServer::Fault::None);
    EXPECT_TRUE(read(tile, Order::CacheFirst).node.valid());
    EXPECT_EQ(contentOf(kept(tile)), contentOf(folder / "site" / tile));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, FailingServer,
    ::testing::Values(Failure{"NotFound", TestServer::Fault::NotFound, Fault::Refused, "404", 0},
                      Failure{"Broken", TestServer::Fault::Broken, Fault::Refused, "500", 0},
                      Failure{"Truncated", TestServer::Fault::Truncated, Fault::NoAnswer, "breaks off", 1},
                      Failure{"Unnoticed", TestServer::Fault::Unnoticed, Fault::Damaged, "", 0},
                      Failure{"Reset", TestServer::Fault::Reset, Fault::NoAnswer, "breaks off", 1},
                      Failure{"Silent", TestServer::Fault::Silent, Fault::NoAnswer, "in time", 1},
                      Failure{"Page", TestServer::Fault::Page, Fault::Damaged, "not an OpenSceneGraph", 0},
                      Failure{"Gzip", TestServer::Fault::Gzip, Fault::Damaged, "gzip", 0}),
    [](const ::testing::TestParamInfo<Failure>& parameter) { return std::string(parameter.param.name); });

TEST_F(Remote, AServerThatDoesNotAnswerRestsAWhile)
{
    server.setFault(TestServer::Fault::Reset);
    for (int turn = 0; turn < 3; ++turn)
        EXPECT_EQ(read(tile, Order::CacheFirst, 1).fault, Fault::NoAnswer);
    const std::size_t asked = server.requests().size();
    for (int turn = 0; turn < 20; ++turn)
        EXPECT_EQ(read(tile, Order::CacheFirst).fault, Fault::NoAnswer);
    EXPECT_EQ(server.requests().size(), asked) << "it is asked all the time";
    server.setFault(TestServer::Fault::None);
    const auto start = std::chrono::steady_clock::now();
    while (!read(tile, Order::CacheFirst).node)
    {
        ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30)) << "it rests for ever";
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_TRUE(read("terrain.osgb", Order::ServerFirst).node.valid());
}

TEST(RemoteThreads, AreOfTheirOwn)
{
    const osg::ref_ptr<osgDB::DatabasePager> pager = new osgDB::DatabasePager;
    RemoteFiles::setUpThreads(*pager, 2);
    EXPECT_EQ(pager->getNumDatabaseThreads(), 10u);
}

} // namespace
