// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// One program in a folder at a time, or those that work together.
#include <osgGeoFX/batch/FolderLock.h>
#include <osgGeoFX/batch/WorkError.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

using namespace geofx::test;
using osgGeoFX::FolderLock;
namespace fs = std::filesystem;

namespace
{

std::string lock(const fs::path& folder, FolderLock::Kind kind)
{
    try
    {
        const FolderLock ignored(folder.string(), kind, "-o");
        return {};
    }
    catch (const osgGeoFX::WorkError& error)
    {
        return error.what();
    }
}

TEST(FolderLock, KeepsOthersOut)
{
    const TempDir place;
    const std::string sentence =
        place.path().string() +
        ": another process is at work in this folder; wait until it has ended, or choose another -o.";
    {
        const FolderLock alone(place.path().string(), FolderLock::ALONE, "-o");
        EXPECT_EQ(lock(place.path(), FolderLock::ALONE), sentence);
        EXPECT_EQ(lock(place.path(), FolderLock::TOGETHER), sentence);
        // By another name, too.
        EXPECT_NE(lock(place / "../" / place.path().filename(), FolderLock::ALONE), "");
    }
    {
        const FolderLock together(place.path().string(), FolderLock::TOGETHER, "-o");
        EXPECT_EQ(lock(place.path(), FolderLock::TOGETHER), "");
        EXPECT_EQ(lock(place.path(), FolderLock::ALONE), sentence);
    }
    EXPECT_EQ(lock(place.path(), FolderLock::ALONE), "");
    EXPECT_TRUE(fs::is_empty(place.path()));
}

TEST(FolderLock, EndsWithItsProcess)
{
    const TempDir place;
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0)
    {
        const FolderLock alone(place.path().string(), FolderLock::ALONE, "-o");
        const ssize_t written = write(ready[1], "x", 1);
        if (written == 1) pause();
        _exit(1);
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_NE(lock(place.path(), FolderLock::ALONE), "");
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(lock(place.path(), FolderLock::ALONE), "");
    close(ready[0]);
    close(ready[1]);
}

TEST(FolderLock, OfNoFolderLocksNothing)
{
    const TempDir place;
    const FolderLock none((place / "none").string(), FolderLock::ALONE, "-o");
    EXPECT_EQ(lock(place / "none", FolderLock::ALONE), "");
    EXPECT_FALSE(fs::exists(place / "none"));
}

// A folder that may be read alone can be locked, too.
TEST(FolderLock, NeedsNoRightToWrite)
{
    const TempDir place;
    fs::create_directory(place / "read");
    fs::permissions(place / "read", fs::perms::owner_read | fs::perms::owner_exec);
    {
        const FolderLock alone((place / "read").string(), FolderLock::ALONE, "-o");
        EXPECT_NE(lock(place / "read", FolderLock::ALONE), "");
    }
    fs::permissions(place / "read", fs::perms::owner_all);
}

} // namespace
