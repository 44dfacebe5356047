// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_build --buildings: with a terrain and into one, and its refusals.
#include <tools/FolderContents.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>
#include <town/TownFiles.h>

#include <gtest/gtest.h>

using namespace geofx::test;

namespace
{

ProgramResult build(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), builtProgram("osggeofx_build"));
    return runProgram(arguments);
}

} // namespace

TEST(TownProgram, BuildsATownWithATerrainAndIntoOne)
{
    const TempDir folder;
    const std::string dem = writeRelief(folder / "dem.tif", 120, 80, 10.0, 47.0, 0.0005);
    std::vector<Feature> features;
    for (int i = 0; i < 20; ++i)
        features.push_back({rectangle(10.01 + 0.002 * i, 46.98, 3e-4, 2e-4),
                            {std::to_string(30 + i), i % 2 ? "Gabled" : "Flat"}});
    const std::string file = writeFeatures(folder / "town.gpkg", {"TALL:real", "TOP"}, features);
    const std::string one = (folder / "one").string(), two = (folder / "two").string();
    const std::vector<std::string> town = {"--buildings",  file,  "--height-field", "TALL",
                                           "--roof-field", "TOP", "--height-unit",  "ft"};
    std::vector<std::string> arguments = {"--dem", dem, "--tile-size", "32", "-o", one};
    arguments.insert(arguments.end(), town.begin(), town.end());
    const ProgramResult both = build(arguments);
    EXPECT_EQ(both.exitCode, 0) << both.standardError;
    EXPECT_NE(both.standardOutput.find("buildings: 20 buildings, 10 of them with gabled roofs"),
              std::string::npos)
        << both.standardOutput;
    EXPECT_EQ(build({"--dem", dem, "--tile-size", "32", "-o", two, "--quiet"}).exitCode, 0);
    arguments = {"-o", two, "--quiet"};
    arguments.insert(arguments.end(), town.begin(), town.end());
    const ProgramResult into = build(arguments);
    EXPECT_EQ(into.exitCode, 0) << into.standardError;
    EXPECT_EQ(into.standardOutput, "");
    // The same bytes either way.
    for (const char* part : {"buildings", "tiles"})
        EXPECT_EQ(contents(folder / "one" / part), contents(folder / "two" / part)) << part;
    EXPECT_EQ(buildingsOf(folder / "one", "detail").size(), 20u);
    // Called again without a town, the terrain stays as it is, and its town too.
    EXPECT_EQ(build({"--dem", dem, "--tile-size", "32", "-o", one, "--quiet"}).exitCode, 0);
    EXPECT_EQ(buildingsOf(folder / "one", "detail").size(), 20u);
}

TEST(TownProgram, Refusals)
{
    const TempDir folder;
    const std::string output = (folder / "database").string();
    const auto refuse = [&](const std::vector<std::string>& arguments, const std::string& words)
    {
        const ProgramResult result = build(arguments);
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_NE((result.standardError + result.standardOutput).find(words), std::string::npos)
            << result.standardError << result.standardOutput;
    };
    refuse({"--buildings", "town.gpkg", "-o", output}, "no finished terrain database");
    refuse({"--buildings", "town.gpkg", "--dem", "dem.tif", "--plan", output},
           "not planned for many processes");
    refuse({"--height-field", "h", "--dem", "dem.tif", "-o", output}, "--buildings");
    refuse({"--buildings", "town.gpkg", "--height-unit", "yards", "-o", output}, "height-unit");
    EXPECT_FALSE(std::filesystem::exists(folder / "database"));
}
