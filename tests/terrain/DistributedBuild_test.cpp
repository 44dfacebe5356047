// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A planned build that many processes do: the bytes of one process, whatever the order, the number and the fate of the
// processes.
#include <osgGeoFX/terrain/DistributedBuild.h>
#include <tools/FolderContents.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <random>
#include <thread>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

class DistributedBuild : public ::testing::Test
{
protected:
    /// Reprojected elevation with a hole, on three tiers of units.
    void SetUp() override
    {
        TestRaster dem(190, 170);
        dem.placed(600000.0, 2400000.0, 30.0, 30.0).crs("EPSG:32604");
        dem.dataset().GetRasterBand(1)->SetNoDataValue(-9999.0);
        dem.fill([](int column, int row, int)
                 { return std::hypot(column - 100, row - 90) < 12 ? -9999.0 : relief(column, row); });
        _options.dems = {dem.write(_folder / "dem.tif")};
        _options.tileSize = 8;
        _options.textureSize = 512;
        _options.output = planned();
        _options.threads = 1;
    }
    std::string planned() const { return (_folder / "planned").string(); }

    /// The files of a build by one process. The plan's folder must have them in the end.
    std::map<std::string, std::string> expected() const
    {
        BuildOptions options = _options;
        options.output = (_folder / "one").string();
        EXPECT_GT(buildDatabase(options).filledShare, 0.0) << "the stages of voids have nothing to do";
        return contents(options.output);
    }
    /// The stages of the plan, as plan.json has them.
    std::vector<std::pair<std::string, std::uint64_t>> stages() const
    {
        std::vector<std::pair<std::string, std::uint64_t>> result;
        const nlohmann::json document = json();
        for (const auto& stage : document.at("stages"))
            result.emplace_back(stage.at("name"), stage.at("units"));
        return result;
    }
    /// Where the build keeps its files while it goes on.
    fs::path work() const { return fs::path(planned()) / "work"; }
    nlohmann::json json() const
    {
        std::ifstream stream(work() / "plan.json");
        return nlohmann::json::parse(stream);
    }
    void write(const nlohmann::json& document) const { std::ofstream(work() / "plan.json") << document; }
    /// The sentence of the error that units end with.
    std::string refusal(const std::vector<std::string>& ranges) const
    {
        try
        {
            buildUnits(planned(), ranges);
        }
        catch (const BuildError& error)
        {
            return error.what();
        }
        return "no error";
    }
    std::vector<std::string> worker(const std::string& range) const
    {
        return {builtProgram("osggeofx_build"),
                "--quiet",
                "--threads",
                "1",
                "--work",
                planned(),
                "--unit",
                range};
    }
    static std::string units(const std::string& stage, std::uint64_t first, std::uint64_t last)
    {
        return stage + ":" + std::to_string(first) + "-" + std::to_string(last);
    }

    const TempDir _folder;
    BuildOptions _options;
};

TEST_F(DistributedBuild, UnitsInReverseGiveTheBytesOfOneProcess)
{
    const auto whole = expected();
    planBuild(_options);
    std::uint64_t most = 0;
    for (const auto& [name, count] : stages())
    {
        most = std::max(most, count);
        // Each unit by a plan that has just been opened.
        for (std::uint64_t unit = count; unit-- > 0;)
            buildUnits(planned(), {units(name, unit, unit)});
    }
    EXPECT_GT(most, 5u) << "hardly any stage has several units";
    EXPECT_TRUE(contents(planned()) == whole);
    EXPECT_TRUE(readBuildStatus(planned()).finished);
    // One that comes too late finds all done, and leaves all as it is.
    EXPECT_TRUE(buildUnits(planned(), {"finish"}).finished);
    EXPECT_TRUE(contents(planned()) == whole);
}

/// Parts cover each unit once, however many there are.
TEST_F(DistributedBuild, PartsAreTheWhole)
{
    planBuild(_options);
    const auto [name, count] = stages().front();
    for (const std::uint64_t parts : {std::uint64_t{3}, count + 4})
    {
        fs::remove_all(work() / "log");
        std::uint64_t all = 0;
        for (std::uint64_t part = 0; part < parts; ++part)
        {
            const BuiltUnits built =
                buildUnits(planned(), {name + ":" + std::to_string(part) + "/" + std::to_string(parts)});
            all += built.built + built.takenOver;
        }
        EXPECT_EQ(all, count) << parts << " parts";
        EXPECT_EQ(readBuildStatus(planned()).stages.front().done, count);
    }
}

TEST_F(DistributedBuild, PlanTellsOptionsAndStages)
{
    _options.treeLine = 1234.5;
    _options.voidReach = 77;
    planBuild(_options);
    const auto document = json();
    EXPECT_EQ(document.at("version"), 1);
    EXPECT_EQ(document.at("options").at("treeLine"), 1234.5);
    EXPECT_EQ(document.at("options").at("voidReach"), 77);
    EXPECT_EQ(document.at("options").at("dems").at(0), _options.dems[0]);
    EXPECT_EQ(document.at("grid").at("tileIntervals"), 8);
    EXPECT_EQ(document.at("stages").front().at("name"), "heights");
    EXPECT_EQ(document.at("stages").back().at("name"), "finish");
    // What is read from the file is what counts: a changed option is another build.
    auto changed = document;
    changed.at("options").at("treeLine") = 1000.0;
    write(changed);
    EXPECT_NE(refusal({"heights:0"}).find("tree line 1000"), std::string::npos) << refusal({"heights:0"});
    write(document);
    EXPECT_EQ(refusal({"heights:0"}), "no error");
}

TEST_F(DistributedBuild, NamesNeedNotBeUtf8)
{
    const fs::path name = _folder / "m\xe4p.tif";
    fs::rename(_options.dems[0], name);
    _options.dems = {name.string()};
    planBuild(_options);
    EXPECT_EQ(refusal({"heights:0"}), "no error");
}

/// A worker compares what its options say with what the plan was made from, so it would refuse if one were lost.
TEST_F(DistributedBuild, PlanKeepsEveryOption)
{
    _options.imagery = {TestRaster(100, 100, 3, GDT_Byte)
                            .placed(600000.0, 2400000.0, 50.0, 50.0)
                            .crs("EPSG:32604")
                            .write(_folder / "imagery.tif")};
    const auto bytes = [&](const char* name)
    {
        return TestRaster(100, 100, 1, GDT_Byte)
            .placed(600000.0, 2400000.0, 50.0, 50.0)
            .crs("EPSG:32604")
            .fill([](int column, int, int) { return 1 + column % 2; })
            .write(_folder / name);
    };
    _options.landCover = bytes("landcover.tif");
    _options.landCoverTable =
        _folder.write("table.csv", "value,class,name,red,green,blue\n1,a,A,40,90,20\n2,b,B,160,150,90\n")
            .string();
    _options.treeCover = bytes("trees.tif");
    _options.epsg = 32604;
    _options.allHeights = true;
    _options.vertical = VerticalDatum::Ellipsoid;
    _options.voids = Voids::KEEP;
    _options.treeLine = 0.1 + 0.2; // no short decimal
    _options.lakeArea = 1.0 / 3.0;
    _options.tileSize = 16;
    _options.textureSize = 64;
    _options.pixelError = 1.5;
    _options.texelError = 2.5;
    _options.anisotropy = 3.0;
    _options.compressTextures = true;
    _options.pixelsPerRadian = 1234.5;
    planBuild(_options);
    EXPECT_EQ(refusal({"heights:0"}), "no error");
    for (const auto& [name, count] : stages())
        EXPECT_EQ(name.find("void"), std::string::npos)
            << name << " has " << count << " units, but voids are kept";
    const auto options = json().at("options");
    EXPECT_EQ(options.at("threads"), 1);
    EXPECT_EQ(options.at("memoryMiB"), 1024);
    // Filled voids have two more options.
    _options.voids = Voids::FILL;
    _options.voidReach = 33;
    _options.voidSmoothing = 7;
    planBuild(_options);
    EXPECT_EQ(refusal({"heights:0"}), "no error");
}

TEST_F(DistributedBuild, RefusesWhatThePlanDoesNotHold)
{
    EXPECT_NE(refusal({"heights:0"}).find("no build is planned here"), std::string::npos);
    planBuild(_options);
    const auto document = json();
    const std::uint64_t count = stages().front().second;
    for (const std::string& range : {"heights:" + std::to_string(count), "heights:0-" + std::to_string(count),
                                     std::string("heights:2-1")})
        EXPECT_NE(refusal({range}).find("has the units 0 to " + std::to_string(count - 1)), std::string::npos)
            << refusal({range});
    for (const char* range : {"heights:", "heights:x", "heights:1-", "heights:-1", "heights:1-2-3",
                              "heights:0/", "heights:99999999999999999999"})
        EXPECT_NE(refusal({range}).find("write it as STAGE:A-B"), std::string::npos)
            << range << refusal({range});
    for (const char* range : {"heights:3/3", "heights:0/0"})
        EXPECT_NE(refusal({range}).find("parts are counted from 0"), std::string::npos) << refusal({range});
    EXPECT_NE(refusal({"peaks:0"}).find("no stage \"peaks\"; it has heights, "), std::string::npos);

    auto other = document;
    other.at("version") = 2;
    write(other);
    EXPECT_NE(refusal({"heights:0"}).find("has version 2, but this program reads version 1"),
              std::string::npos);
    other.erase("version");
    write(other);
    EXPECT_NE(refusal({"heights:0"}).find("the plan is damaged"), std::string::npos);
    other.at("format") = "a recipe";
    write(other);
    EXPECT_NE(refusal({"heights:0"}).find("no plan of a build"), std::string::npos);
    std::ofstream(work() / "plan.json") << "{";
    EXPECT_NE(refusal({"heights:0"}).find("the plan is damaged"), std::string::npos);
    write(document);
    // A source that has changed since is another source.
    fs::last_write_time(_options.dems[0], fs::last_write_time(_options.dems[0]) + std::chrono::seconds(5));
    EXPECT_NE(refusal({"heights:0"}).find("something else than there is now (elevation "), std::string::npos)
        << refusal({"heights:0"});
}

TEST_F(DistributedBuild, NamesTheUnitsThatAreMissing)
{
    planBuild(_options);
    const auto [name, count] = stages().front();
    ASSERT_GT(count, 4u);
    buildUnits(planned(), {units(name, 1, 2)});
    const std::string sentence = refusal({"finish"});
    EXPECT_NE(
        sentence.find(std::to_string(count - 2) + " of " + std::to_string(count) + " units are missing"),
        std::string::npos)
        << sentence;
    EXPECT_NE(sentence.find("--unit heights:0-0 " + units(name, 3, count - 1) + "."), std::string::npos)
        << sentence;
    const ProgramResult result = runProgram(worker("finish"));
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_FALSE(fs::exists(planned() + "/terrain.osgb"));
}

TEST_F(DistributedBuild, StatusTellsWhatIsDoneAndWhatFailed)
{
    planBuild(_options);
    const auto [name, count] = stages().front();
    EXPECT_EQ(readBuildStatus(planned()).stages.front().done, 0u);
    buildUnits(planned(), {units(name, 0, 2)});
    // A process that was killed within a line, and one whose disk was full.
    std::ofstream(work() / "log" / "heights" / "far:1.log") << "begin 3 1000.0\nbegin 4 1000.0\ndone 4 10";
    std::ofstream(work() / "log" / "heights" / "near:2.log")
        << "begin 5 1000.0\nfail 5 1001.0 The disk is full.\nbegin 0 1000.0\nfail 0 1001.0 But done by "
           "another.\n";
    const StageStatus status = readBuildStatus(planned()).stages.front();
    EXPECT_EQ(status.name, name);
    EXPECT_EQ(status.units, count);
    EXPECT_EQ(status.done, 3u);
    EXPECT_GT(status.unitSeconds, 0.0);
    EXPECT_GT(status.rate, 0.0);
    ASSERT_EQ(status.failed.size(), 1u);
    EXPECT_EQ(status.failed[0].unit, 5u);
    EXPECT_EQ(status.failed[0].sentence, "The disk is full.");
    ASSERT_EQ(status.begun.size(), 2u);
    EXPECT_TRUE(status.isSlow(status.begun[0])) << status.begun[0].seconds << " of " << status.unitSeconds;
    EXPECT_EQ(status.begun[0].process, "far:1");
}

/// Many processes at once, of which every third is killed at some moment, and each unit is given to two of them.
TEST_F(DistributedBuild, SameBytesThroughKillsOfProcessesThatMeet)
{
    const auto whole = expected();
    planBuild(_options);
    const char* given = std::getenv("GEOFX_TEST_SEED");
    const std::uint64_t seed = given ? std::strtoull(given, nullptr, 10) : std::random_device()();
    SCOPED_TRACE("GEOFX_TEST_SEED=" + std::to_string(seed));
    Random random(seed);
    int killed = 0;
    double usual = 1.0;
    for (const auto& [name, count] : stages())
    {
        const std::uint64_t parts = std::min<std::uint64_t>(count, 4);
        std::vector<std::pair<std::string, double>> jobs; // ranges, and when they are killed
        for (std::uint64_t part = 0; part < parts; ++part)
            for (const bool twin : {false, true})
                jobs.emplace_back(name + ":" + std::to_string(part) + "/" + std::to_string(parts),
                                  !twin && random.integer(0, 2) == 0 ? random.uniform(0.01, usual) : 0.0);
        std::atomic<std::size_t> next{0};
        std::atomic<int> kills{0};
        const bool last = name == "finish"; // which removes what the twin reads
        const auto start = std::chrono::steady_clock::now();
        const auto work = [&]
        {
            for (std::size_t job = next++; job < (last ? 1 : jobs.size()); job = next++)
            {
                ProgramOptions options;
                options.signal = SIGKILL;
                options.seconds = jobs[job].second;
                ProgramResult result = runProgram(worker(jobs[job].first), options);
                kills += result.timedOut;
                if (result.timedOut) result = runProgram(worker(jobs[job].first));
                EXPECT_EQ(result.exitCode, 0) << jobs[job].first << ": " << result.standardError;
            }
        };
        std::vector<std::thread> threads;
        for (int thread = 0; thread < 4; ++thread)
            threads.emplace_back(work);
        for (auto& thread : threads)
            thread.join();
        killed += kills;
        usual = 0.5 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    EXPECT_GE(killed, 3) << "hardly any process was killed at all";
    EXPECT_TRUE(contents(planned()) == whole);
}

/// What nobody may build on one machine can be planned.
TEST_F(DistributedBuild, PlansMoreThanOneProcessCanTakeAccountOf)
{
    // 10⁹ samples of nothing; tests/cluster/large-plan plans a thousand times more.
    std::ofstream(_folder / "large.vrt")
        << "<VRTDataset rasterXSize=\"32768\" rasterYSize=\"32768\"><SRS>EPSG:32604</SRS>"
           "<GeoTransform>0, 1, 0, 2000000, 0, -1</GeoTransform>"
           "<VRTRasterBand dataType=\"Float32\" band=\"1\"/></VRTDataset>";
    _options.dems = {(_folder / "large.vrt").string()};
    _options.epsg = 32604;
    _options.memoryMiB = 128;
    _options.output = (_folder / "one").string();
    EXPECT_THROW(buildDatabase(_options), BuildError);
    _options.output = planned();
    EXPECT_GT(planBuild(_options).samples, 1000000000u);
    EXPECT_GT(stages().front().second, 10000u);
}

} // namespace
