// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_build --buildings: with a terrain and into one, and its refusals.
#include <tools/FolderContents.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>
#include <town/TownFiles.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace geofx::test;

namespace
{

/// MiB, see below.
constexpr double MOST_MORE = 8.0;

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

// A town on four times the ground takes some bytes more for each building, and not their outlines, meshes or blocks.
TEST(TownProgram, MemoryDoesNotGrowWithTheTown)
{
    const TempDir folder;
    // Some twenty of a town's large cells, of which one at a time is in memory.
    const std::string dem = writeRelief(folder / "dem.tif", 400, 300, 10.0, 47.0, 0.001);
    const std::string output = (folder / "database").string();
    ASSERT_EQ(build({"--dem", dem, "--tile-size", "32", "-o", output, "--quiet"}).exitCode, 0);
    const int most = fullTest() ? 1000000 : 8000;
    const int across = static_cast<int>(std::sqrt(most)), rows = most / across + 1;
    std::vector<double> peaks;
    for (const int count : {most / 4, most})
    {
        const std::string file = (folder / (std::to_string(count) + ".gpkg")).string();
        // As dense in both. One after the other: the kernel counts our own largest size into the program's.
        writeFeatures(file, {"height:real"}, static_cast<std::size_t>(count),
                      [&](std::size_t i)
                      {
                          const int number = static_cast<int>(i);
                          return Feature{rectangle(10.005 + 0.39 * (number % across) / across,
                                                   46.995 - 0.29 * (number / across) / rows, 0.06 / across,
                                                   0.04 / across),
                                         {std::to_string(4 + number % 30)}};
                      });
        ProgramOptions options;
        options.seconds = 0.0;
        const ProgramResult result = runProgram(
            {builtProgram("osggeofx_build"), "--buildings", file, "-o", output, "--threads", "2"}, options);
        ASSERT_EQ(result.exitCode, 0) << result.standardError;
        EXPECT_NE(result.standardOutput.find("buildings a second"), std::string::npos)
            << result.standardOutput;
        peaks.push_back(result.peakMiB);
    }
    // 16 bytes for each building, twice that while the list grows; and what the heap does not get back.
    EXPECT_LT(peaks[1] - peaks[0], MOST_MORE + 32.0 * (most - most / 4) / 1048576.0)
        << peaks[0] << " and " << peaks[1] << " MiB";
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
