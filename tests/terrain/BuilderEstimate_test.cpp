// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a build will take is told before its first byte, and what cannot be is refused with a remedy.
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <chrono>
#include <regex>
#include <sys/resource.h>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

class BuilderEstimate : public ::testing::Test
{
protected:
    /// 36 × 18 pixels of 10°.
    std::string coarseWorld() const { return writeRelief(_folder / "world.tif", 36, 18, -180.0, 90.0, 10.0); }
    BuildOptions options(const std::vector<std::string>& dems) const
    {
        BuildOptions result;
        result.dems = dems;
        result.output = (_folder / "db").string();
        return result;
    }
    /// Refused at once, with a sentence, and without a byte.
    void expectRefusal(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) const
    {
        std::vector<std::string> command{builtProgram("osggeofx_build")};
        command.insert(command.end(), arguments.begin(), arguments.end());
        command.insert(command.end(), {"-o", _folder / "db"});
        const ProgramResult result = runProgram(command);
        EXPECT_FALSE(result.timedOut);
        EXPECT_EQ(result.exitCode, 2);
        for (const std::string& part : parts)
            EXPECT_NE(result.standardError.find(part), std::string::npos)
                << "no \"" << part << "\" in: " << result.standardError;
        EXPECT_EQ(std::count(result.standardError.begin(), result.standardError.end(), '\n'), 1)
            << result.standardError;
        EXPECT_FALSE(fs::exists(_folder / "db"));
    }

    /// What the process has had of cores, seconds.
    static double coreSeconds()
    {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return static_cast<double>(usage.ru_utime.tv_sec) +
               1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
    }

    const TempDir _folder;
};

TEST_F(BuilderEstimate, IsAboutWhatTheBuildTakes)
{
    const std::string smooth = TestRaster(700, 500)
                                   .placed(10.0, 47.0, 1.0 / 3600.0, 1.0 / 3600.0)
                                   .crs("EPSG:4326")
                                   .fill([](int column, int row, int) { return 2.0 * column + row; })
                                   .write(_folder / "smooth.tif");
    const std::string oahu =
        writeCrop(GEOFX_SOURCE_DIR "/data/oahu/elevation.tif", _folder / "oahu.tif", 1500, 1300, 900, 700);
    for (const std::string& dem : {smooth, oahu})
    {
        SCOPED_TRACE(dem);
        fs::remove_all(_folder / "db");
        auto o = options({dem});
        o.threads = 1;
        const BuildEstimate estimate = estimateBuild(o);
        EXPECT_FALSE(fs::exists(o.output));
        const double start = coreSeconds();
        const BuildSummary summary = buildDatabase(o);
        // A plain takes less.
        EXPECT_GT(estimate.seconds, (coreSeconds() - start) / 4.0);
        EXPECT_LT(estimate.seconds, (coreSeconds() - start) * (dem == smooth ? 12.0 : 4.0));
        EXPECT_EQ(estimate.samples, summary.samples);
        EXPECT_EQ(estimate.levels, summary.levels);
        EXPECT_EQ(estimate.tiles, summary.tiles);
        EXPECT_GT(estimate.bytes, summary.bytes / 3);
        EXPECT_LT(estimate.bytes, summary.bytes * 6);
    }
}

TEST_F(BuilderEstimate, IsPrintedFirst)
{
    const std::string dem = writeRelief(_folder / "dem.tif", 300, 200, 10.0, 47.0, 0.001);
    const auto run = [&](const std::vector<std::string>& more)
    {
        std::vector<std::string> command{builtProgram("osggeofx_build"), "--dem", dem, "-o", _folder / "db"};
        command.insert(command.end(), more.begin(), more.end());
        return runProgram(command);
    };
    const std::regex line(
        R"(osggeofx_build: 0\.060 million samples, up to 29 tiles, 4 levels; about [0-9.]+ [kM]B on the )"
        R"(disk, and [0-9.]+ [kM]B more while it is built; about [0-9]+ s\.\n)");
    const ProgramResult told = run({"--estimate"});
    EXPECT_EQ(told.exitCode, 0) << told.standardError;
    EXPECT_TRUE(std::regex_match(told.standardOutput, line)) << told.standardOutput;
    EXPECT_FALSE(fs::exists(_folder / "db"));
    const ProgramResult built = run({});
    EXPECT_EQ(built.standardOutput.rfind(told.standardOutput, 0), 0u) << built.standardOutput;
    EXPECT_NE(built.standardOutput.find("/terrain.osgb: "), std::string::npos);
    EXPECT_EQ(run({"--quiet"}).standardOutput, "");
}

TEST_F(BuilderEstimate, WhatTheDiskCannotHoldIsRefused)
{
    // The whole Earth with a pixel every 10 m. A small patch so fine costs little.
    coarseWorld();
    const std::string fine = _folder / "fine.vrt";
    std::ofstream(fine) << R"(<VRTDataset rasterXSize="4000000" rasterYSize="2000000"><SRS>EPSG:4326</SRS>)"
                           R"(<GeoTransform>-180, 9e-5, 0, 90, 0, -9e-5</GeoTransform>)"
                           R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource>)"
                           R"(<SourceFilename relativeToVRT="1">world.tif</SourceFilename>)"
                           R"(<SrcRect xOff="0" yOff="0" xSize="36" ySize="18"/>)"
                           R"(<DstRect xOff="0" yOff="0" xSize="4000000" ySize="2000000"/>)"
                           R"(</SimpleSource></VRTRasterBand></VRTDataset>)";
    expectRefusal({"--dem", fine}, {"samples", "tiles", "on the disk", "are free", "another folder with -o",
                                    "coarser rasters"});
    EXPECT_THROW(estimateBuild(options({fine})), BuildError);
    const std::string patch = writeRelief(_folder / "patch.tif", 40, 40, 10.0, 47.0, 1e-5);
    EXPECT_LT(estimateBuild(options({coarseWorld(), patch})).samples, 100000000u);
}

TEST_F(BuilderEstimate, PixelsOfNothing)
{
    const std::string tiny = writeRelief(_folder / "tiny.tif", 40, 40, 10.0, 47.0, 1e-9);
    expectRefusal({"--dem", coarseWorld(), tiny}, {"levels", "coarser rasters"});
    // By itself it is a stone of 4 mm.
    const ProgramResult result =
        runProgram({builtProgram("osggeofx_build"), "--dem", tiny, "-o", _folder / "stone"});
    EXPECT_EQ(result.exitCode, 0) << result.standardError;
}

TEST_F(BuilderEstimate, ACrsThatDoesNotReach)
{
    const std::string antipode = writeRelief(_folder / "antipode.tif", 60, 60, -170.0, -51.5, 0.01);
    expectRefusal({"--dem", antipode, "--srs", "EPSG:3035"},
                  {"antipode.tif", "ETRS89-extended / LAEA Europe", "does not reach", "--geocentric"});
    expectRefusal({"--dem", antipode, "--srs", "EPSG:32632"}, {"UTM zone 32N", "does not reach"});
    // The zone beside one's own serves, and so does an area on both sides of the antimeridian.
    auto o = options({writeRelief(_folder / "beside.tif", 60, 60, 13.0, 47.5, 0.001)});
    o.epsg = 32632;
    EXPECT_NO_THROW(estimateBuild(o));
    o = options({writeRelief(_folder / "fiji.tif", 60, 60, 179.97, -17.0, 0.001)});
    o.epsg = 3460; // Fiji 1986
    EXPECT_NO_THROW(estimateBuild(o));
    // Around the whole Earth, and a few tiles high: only tiles that exist take memory.
    o.epsg = 3857;
    EXPECT_NO_THROW(estimateBuild(o));
}

} // namespace
