// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Two builds into one folder at once: the second ends with a sentence, and the first has the bytes of a build alone.
#include <osgGeoFX/batch/FolderLock.h>
#include <tools/FolderContents.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

using namespace geofx::test;
using osgGeoFX::FolderLock;
namespace fs = std::filesystem;

namespace
{

class BuilderLock : public ::testing::Test
{
protected:
    void SetUp() override
    {
        _dem = writeRelief(_folder / "dem.tif", 90, 80, 7.0, 46.0, 0.001);
        _other = writeRelief(_folder / "other.tif", 70, 60, 8.0, 46.0, 0.001);
    }
    ProgramResult build(std::vector<std::string> arguments, const ProgramOptions& options = {}) const
    {
        arguments.insert(arguments.begin(), {builtProgram("osggeofx_build"), "--quiet", "--tile-size", "16"});
        return runProgram(arguments, options);
    }
    std::string path(const std::string& name) const { return (_folder / name).string(); }
    void expectRefusal(const ProgramResult& result) const
    {
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_NE(result.standardError.find("another process is at work in this folder"), std::string::npos)
            << result.standardError;
    }

    TempDir _folder;
    std::string _dem, _other;
};

TEST_F(BuilderLock, TheSecondBuildEndsWithASentence)
{
    ASSERT_EQ(build({"--dem", _dem, "-o", path("alone")}).exitCode, 0);
    // The first one stands still as soon as it has begun, unless it was too fast.
    for (int attempt = 0;; ++attempt)
    {
        const std::string database = path("db" + std::to_string(attempt));
        ProgramResult second;
        bool inTime = false;
        std::atomic<bool> ended{false};
        std::thread visitor;
        ProgramOptions options;
        options.seconds = 0.0; // else another program stands between
        options.runs = [&](pid_t process)
        {
            if (process == 0)
            {
                ended = true;
                return;
            }
            visitor = std::thread(
                [&, process]
                {
                    while (!ended && !fs::exists(database + "/built-from.txt"))
                        std::this_thread::yield();
                    if (ended) return;
                    kill(process, SIGSTOP);
                    inTime = !fs::exists(database + "/terrain.osgb");
                    second = build({"--dem", _other, "-o", database});
                    kill(process, SIGCONT);
                });
        };
        const ProgramResult first = build({"--dem", _dem, "-o", database}, options);
        visitor.join();
        if (!inTime && attempt < 20) continue;
        EXPECT_EQ(first.exitCode, 0) << first.standardError;
        expectRefusal(second);
        EXPECT_TRUE(contents(database) == contents(_folder / "alone"));
        return;
    }
}

TEST_F(BuilderLock, EveryWayIntoTheFolderIsClosed)
{
    ASSERT_EQ(build({"--dem", _dem, "-o", path("db")}).exitCode, 0);
    const auto before = contents(_folder / "db");
    {
        const FolderLock alone(path("db"), FolderLock::ALONE, "-o");
        for (const std::vector<std::string>& more : {std::vector<std::string>{"-o", path("db")},
                                                     {"--anew", "-o", path("db")},
                                                     {"--resume", "-o", path("db")},
                                                     {"--plan", path("db")}})
        {
            std::vector<std::string> arguments = {"--dem", _other};
            arguments.insert(arguments.end(), more.begin(), more.end());
            expectRefusal(build(arguments));
        }
        expectRefusal(build({"--work", path("db"), "--unit", "finish"}));
        expectRefusal(build({"--buildings", _other, "-o", path("db")}));
    }
    EXPECT_TRUE(contents(_folder / "db") == before);
    EXPECT_EQ(build({"--dem", _dem, "-o", path("db")}).exitCode, 0);
}

TEST_F(BuilderLock, WorkersOfAPlanShareTheFolder)
{
    ASSERT_EQ(build({"--dem", _dem, "--plan", path("db")}).exitCode, 0);
    {
        const FolderLock worker(path("db"), FolderLock::TOGETHER, "--work");
        const ProgramResult other = build({"--work", path("db"), "--unit", "heights"});
        EXPECT_EQ(other.exitCode, 0) << other.standardError;
        expectRefusal(build({"--dem", _other, "--plan", path("db")}));
        expectRefusal(build({"--dem", _other, "-o", path("db")}));
    }
}

// What is read is not removed with the tiles of a former build.
TEST_F(BuilderLock, SourcesInTheDatabaseStay)
{
    ASSERT_EQ(build({"--dem", _dem, "-o", path("db")}).exitCode, 0);
    for (const char* name : {"tiles/dem.tif", "kept/dem.tif"})
    {
        fs::copy_file(_dem, _folder / "db" / name);
        const auto before = contents(_folder / "db");
        for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--anew"}})
        {
            std::vector<std::string> arguments = {"--dem", path("db") + "/" + name, "-o", path("db")};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const ProgramResult result = build(arguments);
            EXPECT_EQ(result.exitCode, 2);
            EXPECT_NE(result.standardError.find("would be replaced with"), std::string::npos)
                << result.standardError;
        }
        EXPECT_TRUE(contents(_folder / "db") == before);
    }
}

// A name is no mark: only a file that a build has written makes a folder a database.
TEST_F(BuilderLock, AFolderOfOthersIsNoDatabase)
{
    _folder.write("mine/built-from.txt", "oak and steel\n");
    _folder.write("mine/tiles/roof.txt", "red");
    const auto before = contents(_folder / "mine");
    for (const char* option : {"--keep-nothing", "--anew"})
    {
        const ProgramResult result = build({"--dem", _dem, option, "-o", path("mine")});
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_NE(result.standardError.find("the folder holds other files"), std::string::npos)
            << result.standardError;
    }
    EXPECT_TRUE(contents(_folder / "mine") == before);
}

} // namespace
