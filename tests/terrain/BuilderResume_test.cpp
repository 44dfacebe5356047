// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The same bytes for any number of threads, any memory, and through any number of kills.
#include <osgGeoFX/terrain/BuilderCode.h>
#include <tools/FolderContents.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <vector>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

::testing::AssertionResult sameFiles(const fs::path& a, const fs::path& b)
{
    const auto left = contents(a), right = contents(b);
    for (const auto& [name, bytes] : left)
    {
        const auto other = right.find(name);
        if (other == right.end()) return ::testing::AssertionFailure() << name << " is missing";
        if (other->second != bytes) return ::testing::AssertionFailure() << name << " differs";
    }
    for (const auto& [name, bytes] : right)
        if (!left.count(name)) return ::testing::AssertionFailure() << name << " is one file too many";
    return left.size() > 20 ? ::testing::AssertionSuccess()
                            : ::testing::AssertionFailure() << "only " << left.size() << " files";
}

/// A build with everything: reprojected elevation with holes, imagery on a part of it, land cover.
class BuilderResume : public ::testing::Test
{
protected:
    void SetUp() override
    {
        makeDem(190, 170);
        _imagery =
            TestRaster(150, 120, 3, GDT_Byte)
                .placed(601000.0, 2399000.0, 20.0, 20.0)
                .crs("EPSG:32604")
                .fill([](int column, int row, int band)
                      { return (column * 7919 + row * 104729 * (band + 1)) % 251; }) // hard to compress
                .write(_folder / "imagery.tif");
        _landCover = TestRaster(240, 210, 1, GDT_Byte)
                         .placed(600000.0, 2400000.0, 25.0, 25.0)
                         .crs("EPSG:32604")
                         .fill([](int column, int row, int) { return 1 + (column / 20 + row / 30) % 2; })
                         .write(_folder / "landcover.tif");
        _table =
            _folder.write("table.csv", "value,class,name,red,green,blue\n1,a,A,40,90,20\n2,b,B,160,150,90\n");
    }

    std::vector<std::string> command(const std::string& output,
                                     const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> arguments{builtProgram("osggeofx_build"),
                                           "--quiet",
                                           "--dem",
                                           _dem,
                                           "--imagery",
                                           _imagery,
                                           "--landcover",
                                           _landCover,
                                           "--landcover-table",
                                           _table,
                                           "--tile-size",
                                           "16",
                                           "--texture-size",
                                           "128",
                                           "-o",
                                           (_folder / output)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        // Updates have tests of their own (DatabaseUpdate).
        if (std::find(more.begin(), more.end(), "--resume") == more.end()) arguments.push_back("--anew");
        return arguments;
    }

    void build(const std::string& output, const std::vector<std::string>& more = {}) const
    {
        const ProgramResult result = runProgram(command(output, more));
        ASSERT_EQ(result.exitCode, 0) << result.standardError;
    }

    const TempDir _folder;
    void makeDem(int columns, int rows)
    {
        TestRaster dem(columns, rows);
        dem.placed(600000.0, 2400000.0, 30.0, 30.0).crs("EPSG:32604");
        dem.dataset().GetRasterBand(1)->SetNoDataValue(-9999.0);
        dem.fill([](int column, int row, int)
                 { return std::hypot(column - 100, row - 90) < 30 ? -9999.0 : relief(column, row); });
        _dem = dem.write(_folder / "dem.tif");
    }

    std::string _dem, _imagery, _landCover, _table;
};

TEST_F(BuilderResume, SameBytesForAnyThreadsAndMemory)
{
    build("one", {"--threads", "1"});
    for (const auto& more : std::vector<std::vector<std::string>>{{"--threads", "2"},
                                                                  {"--threads", "3"},
                                                                  {"--threads", "7", "--memory", "4000"},
                                                                  {"--threads", "2", "--memory", "128"},
                                                                  {}})
    {
        SCOPED_TRACE(::testing::PrintToString(more));
        build("other", more);
        EXPECT_TRUE(sameFiles(_folder / "one", _folder / "other"));
    }
}

TEST_F(BuilderResume, FinishedDatabaseIsTakenOverOrBuiltAnew)
{
    build("one");
    const auto before = contents(_folder / "one");
    const auto tile = std::find_if(before.begin(), before.end(),
                                   [](const auto& file) { return file.first.rfind("tiles/", 0) == 0; });
    ASSERT_NE(tile, before.end());
    const auto written = fs::last_write_time(_folder / "one" / tile->first);
    build("one", {"--resume"});
    EXPECT_EQ(fs::last_write_time(_folder / "one" / tile->first), written) << "--resume has built it again";
    EXPECT_EQ(contents(_folder / "one"), before);
    build("one");
    EXPECT_NE(fs::last_write_time(_folder / "one" / tile->first), written) << "nothing was built";
    EXPECT_EQ(contents(_folder / "one"), before);
}

/// Moments are drawn from a seed that a failure prints; GEOFX_TEST_SEED gives it again.
std::uint64_t seed()
{
    const char* given = std::getenv("GEOFX_TEST_SEED");
    return given ? std::strtoull(given, nullptr, 10) : std::random_device()();
}

TEST_F(BuilderResume, SameBytesAfterKills)
{
    if (fullTest()) makeDem(800, 700);
    const auto start = std::chrono::steady_clock::now();
    build("whole");
    const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;

    const std::uint64_t s = seed();
    SCOPED_TRACE("GEOFX_TEST_SEED=" + std::to_string(s));
    Random random(s);
    int killed = 0;
    // A build may end sooner than the first one did, on a machine that has other work.
    const int moments = fullTest() ? 10 : 4;
    for (int moment = 0; moment < moments || (killed < moments / 2 && moment < 5 * moments); ++moment)
    {
        const std::string output = "killed" + std::to_string(moment);
        ProgramOptions options;
        options.signal = SIGKILL;
        options.seconds = random.uniform(0.005, duration.count());
        SCOPED_TRACE("killed after " + std::to_string(options.seconds) + " of " +
                     std::to_string(duration.count()) + " s");
        const ProgramResult result = runProgram(command(output), options);
        killed += result.timedOut;
        ASSERT_TRUE(result.timedOut || result.exitCode == 0) << result.standardError;
        EXPECT_TRUE(!result.timedOut || !fs::exists(_folder / output / "terrain.osgb") ||
                    contents(_folder / output).size() >= contents(_folder / "whole").size())
            << "a part looks whole";
        build(output, {"--resume", "--threads", std::to_string(random.integer(1, 3))});
        ASSERT_TRUE(sameFiles(_folder / "whole", _folder / output));
        fs::remove_all(_folder / output);
    }
    EXPECT_GE(killed, moments / 2) << "hardly any build was killed at all";
}

TEST_F(BuilderResume, SameBytesAfterManyKillsOfOneBuild)
{
    if (fullTest()) makeDem(800, 700);
    build("whole");
    const std::uint64_t s = seed();
    SCOPED_TRACE("GEOFX_TEST_SEED=" + std::to_string(s));
    Random random(s);
    ProgramOptions options;
    options.signal = SIGKILL;
    options.seconds = 0.02;
    int kills = 0;
    // Each try gets a little more time, so that it ends at some point however slow the machine is.
    for (;; ++kills, options.seconds *= random.uniform(1.0, 1.4))
    {
        const ProgramResult result = runProgram(command("db", {"--resume"}), options);
        if (!result.timedOut)
        {
            ASSERT_EQ(result.exitCode, 0) << result.standardError;
            break;
        }
    }
    EXPECT_GE(kills, 3);
    EXPECT_TRUE(sameFiles(_folder / "whole", _folder / "db"));
}

TEST_F(BuilderResume, ResumeOfAnotherBuildIsRefused)
{
    build("db");
    const auto before = contents(_folder / "db");
    for (const auto& more : std::vector<std::vector<std::string>>{
             {"--tile-size", "32"}, {"--srs", "EPSG:32604"}, {"--vertical", "egm96"}, {"--pixel-error", "2"}})
    {
        auto arguments = command("db", {"--resume"});
        const auto same = std::find(arguments.begin(), arguments.end(), more[0]);
        if (same != arguments.end())
            same[1] = more[1];
        else
            arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, 2) << more[0];
        EXPECT_NE(result.standardError.find("other sources or options"), std::string::npos)
            << result.standardError;
        EXPECT_EQ(contents(_folder / "db"), before) << more[0];
    }
    // A source that has changed since is another source.
    fs::last_write_time(_dem, fs::last_write_time(_dem) + std::chrono::seconds(5));
    EXPECT_EQ(runProgram(command("db", {"--resume"})).exitCode, 2);
}

/// What one builder has begun another must not go on with, and a cache of the one is not one of the other.
TEST_F(BuilderResume, AnotherBuildersWorkIsNotTakenOver)
{
    build("db");
    const fs::path origin = _folder / "db" / "built-from.txt";
    std::string text = contents(_folder / "db").at("built-from.txt");
    const std::string line = std::string("builder ") + osgGeoFX::builderCode();
    ASSERT_EQ(line.size(), std::string("builder ").size() + 16);
    const std::size_t place = text.find(line);
    ASSERT_NE(place, std::string::npos) << text;
    text[place + line.size() - 1] = text[place + line.size() - 1] == '0' ? '1' : '0';
    std::ofstream(origin, std::ios::binary) << text;
    const ProgramResult result = runProgram(command("db", {"--resume"}));
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_NE(result.standardError.find("other sources or options"), std::string::npos)
        << result.standardError;
}

/// The hash is that of the sources as they are, and another when a letter changes in one of them.
TEST(BuilderCode, FollowsTheSources)
{
    const TempDir folder;
    const std::string script = GEOFX_SOURCE_DIR "/osgGeoFX/cmake/HashSources.cmake";
    const std::string one = folder.write("one.cpp", "int one;\n"),
                      two = folder.write("two.cpp", "int two;\n");
    const auto hashed = [&]
    {
        const ProgramResult result = runProgram({"cmake", "-DFILES=" + one + ";" + two,
                                                 "-DOUTPUT=" + (folder / "hash.cpp").string(), "-P", script});
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        return contents(folder.path()).at("hash.cpp");
    };
    const std::string before = hashed();
    EXPECT_EQ(hashed(), before);
    folder.write("two.cpp", "int tvo;\n");
    EXPECT_NE(hashed(), before);
}

/// A file size limit kills the program in the midst of the first file that is longer.
TEST_F(BuilderResume, KilledInTheMidstOfAFile)
{
    build("whole");
    const auto whole = contents(_folder / "whole");
    bool inTiles = false;
    for (const int blocks : fullTest() ? std::vector{20, 60, 150, 300, 420, 500} : std::vector{60, 150, 420})
    {
        const std::string name = "db" + std::to_string(blocks);
        std::vector<std::string> limited{"sh", "-c", "ulimit -f " + std::to_string(blocks) + "; exec \"$@\"",
                                         "sh"};
        const auto arguments = command(name, {"--threads", "1"});
        limited.insert(limited.end(), arguments.begin(), arguments.end());
        if (runProgram(limited).exitCode != 0)
            for (const auto& [file, bytes] : contents(_folder / name))
            {
                const bool tile = file.rfind("tiles/", 0) == 0;
                inTiles = inTiles || tile;
                EXPECT_TRUE(!tile || file.find(".tmp") != std::string::npos || bytes == whole.at(file))
                    << file << " is cut short but has its name, with " << blocks << " blocks";
                EXPECT_NE(file, "terrain.osgb");
            }
        build(name, {"--resume"});
        EXPECT_TRUE(sameFiles(_folder / "whole", _folder / name)) << blocks << " blocks";
    }
    EXPECT_TRUE(inTiles) << "no tile was cut short";
}

TEST_F(BuilderResume, KilledBeforeAnythingWasDone)
{
    build("whole");
    _folder.write("db/built-from.txt.tmp", "osgGeoFX terr");
    build("db", {"--resume"});
    EXPECT_TRUE(sameFiles(_folder / "whole", _folder / "db"));
}

TEST_F(BuilderResume, ContinuesAfterTheDiskWasFull)
{
    build("whole");
    // Files may grow to so many blocks of 512 bytes; beyond, writing fails as on a full disk.
    bool inTiles = false;
    for (const int blocks : fullTest() ? std::vector{1, 60, 150, 200, 400, 1000} : std::vector{1, 150, 400})
    {
        std::vector<std::string> limited{
            "sh", "-c", "ulimit -f " + std::to_string(blocks) + "; trap '' XFSZ; exec \"$@\"", "sh"};
        const auto arguments = command("db" + std::to_string(blocks));
        limited.insert(limited.end(), arguments.begin(), arguments.end());
        const ProgramResult result = runProgram(limited);
        const fs::path output = _folder / ("db" + std::to_string(blocks));
        if (result.exitCode != 0)
        {
            EXPECT_EQ(result.exitCode, 2) << result.standardError;
            EXPECT_NE(result.standardError.find("cannot be written"), std::string::npos)
                << result.standardError;
            EXPECT_NE(result.standardError.find("free some space"), std::string::npos)
                << result.standardError;
            EXPECT_EQ(std::count(result.standardError.begin(), result.standardError.end(), '\n'), 1)
                << result.standardError;
            EXPECT_FALSE(fs::exists(output / "terrain.osgb"));
            for (const auto& [name, bytes] : contents(output))
                EXPECT_EQ(name.find(".tmp"), std::string::npos) << name << " is left behind";
            inTiles = inTiles || fs::exists(output / "work" / "tiles");
        }
        build("db" + std::to_string(blocks), {"--resume"});
        EXPECT_TRUE(sameFiles(_folder / "whole", output)) << blocks << " blocks";
    }
    EXPECT_TRUE(inTiles) << "the disk was never full in the midst of the tiles";
}

} // namespace
