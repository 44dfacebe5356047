// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Folders of a program's own, and those of others.
#include <osgGeoFX/batch/OwnFolder.h>
#include <osgGeoFX/batch/WorkError.h>
#include <tools/FolderContents.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

std::string take(const fs::path& folder)
{
    try
    {
        osgGeoFX::OwnFolder::take(folder.string(), "--work");
        return {};
    }
    catch (const osgGeoFX::WorkError& error)
    {
        return error.what();
    }
}

TEST(OwnFolder, IsRemovedWithAllInIt)
{
    const TempDir place;
    const fs::path folder = place / "a/map.work";
    for (int i = 0; i < 2; ++i)
    {
        EXPECT_EQ(take(folder), "");
        EXPECT_EQ(take(folder), "");
        place.write("a/map.work/ground/tile.osgb", "tile");
        EXPECT_EQ(take(folder), "");
        osgGeoFX::OwnFolder::remove(folder.string());
        EXPECT_FALSE(fs::exists(folder));
        // Somebody has made it for us.
        fs::create_directories(folder);
    }
    // Another process may be writing its mark.
    place.write(std::string("a/map.work/") + osgGeoFX::OwnFolder::MARK + ".host-1-1.tmp", "");
    EXPECT_EQ(take(folder), "");
}

TEST(OwnFolder, IsNoFolderOfOthers)
{
    const TempDir place;
    place.write("map.work/notes.txt", "three years");
    place.write(std::string("marked/") + osgGeoFX::OwnFolder::MARK, "mine");
    place.write("marked/notes.txt", "three years");
    place.write("file", "file");
    const auto before = contents(place.path());
    for (const char* name : {"map.work", "marked"})
    {
        EXPECT_EQ(take(place / name)
                      .find((place / name).string() + ": the folder for work files holds other files"),
                  0u)
            << take(place / name);
        EXPECT_NE(take(place / name).find("choose another --work, or move it away"), std::string::npos);
        osgGeoFX::OwnFolder::remove((place / name).string());
    }
    EXPECT_NE(take(place / "file").find("a file has the name"), std::string::npos);
    EXPECT_NE(take(place / "file/below").find("cannot be made"), std::string::npos);
    EXPECT_EQ(contents(place.path()), before);
}

} // namespace
