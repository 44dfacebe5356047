// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Files that are read: by which names they are known, and what may be written.
#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/batch/WorkError.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

class InputFiles : public ::testing::Test
{
protected:
    /// The sentence of a refusal; empty where the file may be written.
    std::string claim(const fs::path& file)
    {
        try
        {
            _inputs.claim("The picture", file.string(), "-o");
            return {};
        }
        catch (const osgGeoFX::WorkError& error)
        {
            return error.what();
        }
    }
    std::string claimFolder(const fs::path& folder)
    {
        try
        {
            _inputs.claimFolder("The web page", folder.string(), "--web");
            return {};
        }
        catch (const osgGeoFX::WorkError& error)
        {
            return error.what();
        }
    }

    TempDir _folder;
    osgGeoFX::InputFiles _inputs;
};

TEST_F(InputFiles, AreKnownByEachOfTheirNames)
{
    const fs::path file = _folder.write("data/dem.tif", "dem");
    fs::create_hard_link(file, _folder / "hard.png");
    fs::create_symlink("data/dem.tif", _folder / "soft.png");
    fs::create_directory_symlink("data", _folder / "alias");
    _inputs.add(file.string());
    for (const char* name :
         {"data/dem.tif", "data/./dem.tif", "data/../data/dem.tif", "hard.png", "soft.png", "alias/dem.tif"})
    {
        const std::string sentence = claim(_folder / name);
        EXPECT_EQ(sentence, "The picture " + (_folder / name).string() + " would replace the file " +
                                file.string() + ", which is read; choose another -o.");
    }
    EXPECT_EQ(claim(_folder / "data/map.png"), "");
    EXPECT_EQ(claim(_folder.write("other.tif", "dem")), "");
}

TEST_F(InputFiles, HaveNoTwoOutputsOfOneName)
{
    EXPECT_EQ(claim(_folder / "map.png"), "");
    fs::create_directory_symlink(".", _folder / "alias");
    EXPECT_NE(claim(_folder / "alias/map.png").find("which is written, too"), std::string::npos);
    EXPECT_EQ(claim(_folder / "map.svg"), "");
}

TEST_F(InputFiles, AreFoundInNamesWithMore)
{
    const std::string file = _folder.write("a.nc", "").string();
    for (const std::string& name :
         {file + ":rain", file + ":t[level=500,number=2]", "NETCDF:\"" + file + "\":rain",
          "GTIFF_DIR:1:" + file, "/vsigzip/" + file, "/vsizip/" + file + "/b/c.tif"})
    {
        _inputs = osgGeoFX::InputFiles();
        _inputs.add(name);
        EXPECT_NE(claim(file), "") << name;
    }
}

TEST_F(InputFiles, ComeWithTheirSourcesAndTheFilesThatTextsName)
{
    const std::string scene =
        _folder
            .write("scene.geofx", "<geofx>\n <raster file=\"a&amp;b.tif\"/> <overlays file='fire.kml'/>\n"
                                  " <sequence file=\"radar/\"/><x y=\"/\" z=\".\"/></geofx>")
            .string();
    _folder.write("fire.kml", "<kml><href>\n  red%20fire.png </href></kml>");
    for (const char* file : {"a&b.tif", "a&b.tfw", "red fire.png", "radar/1.tif", "free.tif"})
        _folder.write(file, "");
    _inputs = osgGeoFX::InputFiles(
        [&](const std::string& file) -> std::vector<std::string>
        {
            if (fs::path(file).filename() != "a&b.tif") return {};
            return {(_folder / "a&b.tfw").string(), "WMS:no file"};
        });
    _inputs.add(scene);
    for (const char* file : {"scene.geofx", "a&b.tif", "a&b.tfw", "fire.kml", "red fire.png", "radar/1.tif"})
        EXPECT_NE(claim(_folder / file), "") << file;
    EXPECT_EQ(claim(_folder / "free.tif"), "");
    EXPECT_EQ(claim(_folder / "radar/new.png"), "");
}

TEST_F(InputFiles, AreAllTilesOfADatabase)
{
    const fs::path tile = _folder.write("db/tiles/1/2/3.osgb", ""),
                   town = _folder.write("db/buildings/1.osgb", "");
    _folder.write("db/terrain.osgb", "");
    _inputs.add((_folder / "db/terrain.osgb").string());
    fs::create_hard_link(tile, _folder / "linked.png");
    for (const fs::path& file : {_folder / "db/terrain.osgb", tile, town, _folder / "linked.png"})
        EXPECT_NE(claim(file), "") << file;
    EXPECT_EQ(claim(_folder.write("db/picture.png", "")), "");
}

TEST_F(InputFiles, KeepFoldersFromBeingReplaced)
{
    _inputs.add(_folder.write("page/data/names.json", "").string());
    fs::create_directory_symlink("page", _folder / "alias");
    for (const char* folder : {"page", "page/data", "alias", "page/../page", "."})
        EXPECT_NE(claimFolder(_folder / folder).find("names.json in it, which is read; choose another --web"),
                  std::string::npos)
            << folder;
    EXPECT_EQ(claimFolder(_folder / "pag"), "");
    EXPECT_EQ(claimFolder(_folder / "new"), "");
}

} // namespace
