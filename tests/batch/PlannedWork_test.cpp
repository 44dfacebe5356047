// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Works in units by any number of processes: what is done, what is measured, and how a work ends.
#include <osgGeoFX/batch/PlannedWork.h>
#include <osgGeoFX/batch/WorkError.h>
#include <osgGeoFX/batch/WorkTimes.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

using namespace osgGeoFX;
using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

/// Leaves a file for each unit.
class FileStage : public WorkStage
{
public:
    FileStage(const std::string& name, std::size_t units, fs::path folder, std::function<void()> work = {})
        : WorkStage(name, name), _units(units), _folder(std::move(folder)), _work(std::move(work))
    {
    }
    std::size_t units() const override { return _units; }
    bool takeOver(std::size_t unit) override { return fs::exists(file(unit)); }
    void run(int, std::size_t unit) override
    {
        if (_work) _work();
        std::ofstream(file(unit)) << unit;
    }

private:
    fs::path file(std::size_t unit) const { return _folder / (name() + "-" + std::to_string(unit)); }

    const std::size_t _units;
    const fs::path _folder;
    const std::function<void()> _work;
};

void spin(double seconds)
{
    const std::clock_t end = std::clock() + static_cast<std::clock_t>(seconds * CLOCKS_PER_SEC);
    while (std::clock() < end)
    {
    }
}

class PlannedWork : public ::testing::Test
{
protected:
    void SetUp() override
    {
        fs::create_directories(fs::path(WorkPlan::file(folder())).parent_path());
        std::ofstream(WorkPlan::file(folder()))
            << R"({"program": "osggeofx_render", "estimate": {"seconds": 12.5},
                   "stages": [{"name": "first", "units": 6, "seconds": 12}, {"name": "last", "units": 1}]})";
    }
    std::string folder() const { return (_folder / "plan").string(); }
    WorkStages stages(const std::function<void()>& work = {}) const
    {
        WorkStages result;
        result.push_back(std::make_unique<FileStage>("first", 6, _folder.path(), work));
        result.push_back(std::make_unique<FileStage>("last", 1, _folder.path()));
        return result;
    }

    const TempDir _folder;
};

} // namespace

TEST_F(PlannedWork, PlansTellProgramAndStages)
{
    const WorkPlan plan = WorkPlan::read(folder());
    EXPECT_EQ(plan.program, "osggeofx_render");
    EXPECT_EQ(plan.estimatedSeconds, 12.5);
    ASSERT_EQ(plan.stages.size(), 2u);
    EXPECT_EQ(plan.stages[0].name, "first");
    EXPECT_EQ(plan.stages[0].units, 6u);
    EXPECT_EQ(plan.stages[0].seconds, 12.0);
    EXPECT_EQ(plan.stages[1].seconds, 0.0);
    EXPECT_THROW(WorkPlan::read((_folder / "elsewhere").string()), WorkError);
    std::ofstream(WorkPlan::file(folder())) << "{";
    EXPECT_THROW(WorkPlan::read(folder()), WorkError);
}

TEST_F(PlannedWork, UnitsAreDoneOnceAndInTheOrderOfStages)
{
    EXPECT_THROW(doUnits(folder(), stages(), {"last"}, {}), WorkError) << "the first stage is not done";
    BuiltUnits done = doUnits(folder(), stages(), {"first:1/3", "first:0"}, {});
    EXPECT_EQ(done.built, 3u);
    EXPECT_FALSE(done.finished);
    EXPECT_TRUE(fs::exists(_folder / "first-2") && fs::exists(_folder / "first-3"));
    EXPECT_FALSE(fs::exists(_folder / "first-1") || fs::exists(_folder / "first-4"));
    doUnits(folder(), stages(), {"first"}, {});
    EXPECT_FALSE(doUnits(folder(), stages(), {"last:0/2"}, {}).finished) << "this part has no unit";
    fs::remove(_folder / "first-0");
    done = doUnits(folder(), stages(), {"first", "last"}, {});
    EXPECT_EQ(done.built, 2u);
    EXPECT_EQ(done.takenOver, 5u);
    EXPECT_TRUE(done.finished);
    WorkPlan::finish(folder());
    EXPECT_TRUE(fs::exists(WorkPlan::finishedFile(folder())));
    EXPECT_FALSE(fs::exists(WorkPlan::workFolder(folder())));
    EXPECT_TRUE(readWorkStatus(folder()).finished);
    EXPECT_NO_THROW(WorkPlan::finish(folder())) << "another process was there first";
    fs::remove(WorkPlan::finishedFile(folder()));
    EXPECT_THROW(readWorkStatus(folder()), WorkError) << "nothing is planned here";
}

/// Times of units are wall and CPU times: one waits, one works. What the process took before counts once.
TEST_F(PlannedWork, TimesAreThoseOfUnits)
{
    for (const int threads : {1, 2})
    {
        SCOPED_TRACE(threads);
        fs::remove_all(fs::path(WorkPlan::workFolder(folder())) / "log");
        for (int i = 0; i < 6; ++i)
            fs::remove(_folder / ("first-" + std::to_string(i)));
        UnitOptions how;
        how.threads = threads;
        doUnits(folder(), stages([] { std::this_thread::sleep_for(std::chrono::milliseconds(150)); }),
                {"first:0-1"}, how);
        doUnits(folder(), stages([] { spin(0.1); }), {"first:2"}, how);
        doUnits(folder(), stages(), {"first:0-2"}, how); // which are there already
        const std::vector<StageTimes> times = readWorkTimes(folder());
        ASSERT_EQ(times.size(), 2u);
        EXPECT_EQ(times[0].name, "first");
        EXPECT_EQ(times[0].idle, 3u);
        EXPECT_EQ(times[0].processes.size(), 3u);
        ASSERT_EQ(times[0].units.size(), 3u);
        int waited = 0, worked = 0;
        for (const UnitTime& unit : times[0].units)
        {
            waited += unit.wall >= 0.149 && unit.cpu < 0.05;
            worked += unit.cpu >= 0.09 && unit.wall >= 0.9 * unit.cpu;
        }
        EXPECT_EQ(waited, 2);
        EXPECT_EQ(worked, 1);
        EXPECT_TRUE(times[1].units.empty());
        int starts = 0;
        for (const ProcessTime& process : times[0].processes)
        {
            EXPECT_FALSE(process.host.empty());
            EXPECT_EQ(process.host.find(':'), std::string::npos) << process.host;
            EXPECT_GE(process.end, process.start);
            starts += process.startCpu > 0.0;
        }
        EXPECT_LE(starts, 1);
    }
}

/// A unit whose process was killed is open; one that another process has done since is not.
TEST_F(PlannedWork, KilledProcessesLeaveOpenUnits)
{
    doUnits(folder(), stages(), {"first:0"}, {});
    const fs::path log = fs::path(WorkPlan::workFolder(folder())) / "log" / "first";
    std::ofstream(log / "far:7.1-0.log") << "start 0 1000.5 0.75 0.25 0.25\nbegin 0 1001.0\nbegin 3 1002.0\n";
    // One that shared its core: of four seconds, others had it for one.
    std::ofstream(log / "near:8.1-0.log") << "begin 1 1000.0\ndone 1 1004.0 2.5 1.0\n";
    const StageTimes times = readWorkTimes(folder())[0];
    const auto shared = std::find_if(times.units.begin(), times.units.end(),
                                     [](const UnitTime& each) { return each.cpu == 2.5; });
    ASSERT_NE(shared, times.units.end());
    EXPECT_EQ(shared->wall, 3.0);
    const auto killed = std::find_if(times.processes.begin(), times.processes.end(),
                                     [](const ProcessTime& each) { return each.host == "far"; });
    ASSERT_NE(killed, times.processes.end());
    EXPECT_EQ(killed->start, 999.75);
    EXPECT_EQ(killed->startWall, 0.5);
    EXPECT_EQ(killed->startCpu, 0.25);
    EXPECT_EQ(killed->end, 1002.0);
    const StageStatus status = readWorkStatus(folder()).stages[0];
    ASSERT_EQ(status.begun.size(), 1u);
    EXPECT_EQ(status.begun[0].unit, 3u);
    EXPECT_EQ(status.estimatedSeconds, 12.0);
}
