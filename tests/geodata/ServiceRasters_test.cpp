// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Rasters of services whose servers fail, are silent or send something else, on this machine.
#include <osgGeoFX/geodata/MappingRaster.h>
#include <tools/TempDir.h>
#include <tools/TestServer.h>
#include <tools/WebTiles.h>

#include <cpl_conv.h>
#include <gtest/gtest.h>
#include <osg/Math>

#include <chrono>
#include <filesystem>
#include <fstream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int levels = 8;

std::optional<std::string> tileOf(const std::string& name)
{
    static const std::string green = pngTile([](int, int) { return std::array<int, 4>{20, 200, 40, 255}; });
    return WebTile::parse(name) ? std::optional(green) : std::nullopt;
}

class ServiceRasters : public ::testing::Test
{
protected:
    ServiceRasters() { CPLSetConfigOption("GDAL_DEFAULT_WMS_CACHE_PATH", (_folder / "cache").c_str()); }

    /// Some tiles of the finest level around 7° east, 45° north.
    std::optional<MappingRaster> read(const std::string& more = {})
    {
        // GDAL keeps datasets of one text.
        const std::string file =
            _folder.write("map.xml", serviceText(_server.address(), levels, more)).string();
        MappingFrame frame;
        frame.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(7.0), osg::DegreesToRadians(45.0));
        MappingRaster::Options options;
        options.maxSide = 256;
        options.window = MappingRaster::Window{{-60000.0, -60000.0}, {60000.0, 60000.0}, 500.0};
        _error.clear();
        return MappingRaster::read(file, frame, options, _error);
    }
    static bool isGreen(const std::optional<MappingRaster>& raster)
    {
        const osg::Image& image = *raster->layer->getImage();
        for (int i = 0; i < image.s() * image.t(); ++i)
        {
            const unsigned char* const texel = image.data() + 4 * i;
            if (texel[0] != 20 || texel[1] != 200 || texel[2] != 40 || texel[3] != 255) return false;
        }
        return true;
    }
    bool says(const std::string& words) const { return _error.find(words) != std::string::npos; }

    TempDir _folder;
    TestServer _server{&tileOf};
    std::string _error;
};

} // namespace

TEST_F(ServiceRasters, ATileThatFailsOnceIsAskedForAgain)
{
    _server.setFault(TestServer::Fault::Busy, "", 2);
    const std::optional<MappingRaster> raster = read();
    ASSERT_TRUE(raster) << _error;
    EXPECT_TRUE(isGreen(raster));
}

TEST_F(ServiceRasters, EachCauseHasItsRemedy)
{
    _server.setFault(TestServer::Fault::Busy);
    EXPECT_FALSE(read());
    EXPECT_TRUE(
        says("map.xml: its pixels cannot be read (the server has failed, HTTP 503); try again later."))
        << _error;
    EXPECT_EQ(_error.find('\n'), std::string::npos) << _error;
    _server.setFault(TestServer::Fault::Page);
    EXPECT_FALSE(read());
    EXPECT_TRUE(says("sends something that is no picture")) << _error;
    _server.stop();
    EXPECT_FALSE(read());
    EXPECT_TRUE(says("the server does not answer: Failed to connect")) << _error;
}

TEST_F(ServiceRasters, ASilentServerEndsTheWait)
{
    ASSERT_TRUE(read()) << _error;
    EXPECT_STREQ(CPLGetConfigOption("GDAL_HTTP_LOW_SPEED_TIME", ""), "30") << "as long as terrain waits";
    const CPLConfigOptionSetter shorter("GDAL_HTTP_LOW_SPEED_TIME", "1", false);
    _server.setFault(TestServer::Fault::Silent);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(read());
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    EXPECT_TRUE(says("the server does not answer: Operation too slow")) << _error;
}

TEST_F(ServiceRasters, BrokenCopiesInTheCacheAreFetchedAgain)
{
    ASSERT_TRUE(isGreen(read("<Cache/>"))) << _error;
    _server.forgetRequests();
    ASSERT_TRUE(isGreen(read("<Cache/>"))) << _error;
    EXPECT_EQ(_server.requests().size(), 0u) << "all are in the cache";
    std::vector<std::filesystem::path> copies;
    for (const auto& each : std::filesystem::recursive_directory_iterator(_folder / "cache"))
        if (each.is_regular_file()) copies.push_back(each.path());
    ASSERT_GE(copies.size(), 4u);
    const std::uintmax_t whole = std::filesystem::file_size(copies[0]);
    const auto expectMended = [&](const std::filesystem::path& copy)
    {
        _server.forgetRequests();
        ASSERT_TRUE(read("<Cache/>")) << _error;
        EXPECT_TRUE(isGreen(read("<Cache/>"))) << _error;
        EXPECT_EQ(_server.requests().size(), 1u);
        EXPECT_EQ(std::filesystem::file_size(copy), whole);
    };
    std::ofstream(copies[0]) << "<html>Welcome to the network of this hotel.</html>";
    expectMended(copies[0]);
    std::filesystem::resize_file(copies[1], whole / 2);
    expectMended(copies[1]);
    std::filesystem::resize_file(copies[2], 0);
    expectMended(copies[2]);
}
