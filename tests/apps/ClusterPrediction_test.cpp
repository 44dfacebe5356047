// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How a planned work is cut into jobs, and how long it is said to take, where that can be worked out by hand.
#include <cluster/Prediction.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

using geofx::cluster::arraysOf;
using geofx::cluster::JobOptions;
using geofx::cluster::MeasuredTimes;
using geofx::cluster::predict;
using geofx::test::TempDir;
using osgGeoFX::StageStatus;
using osgGeoFX::WorkStatus;

namespace
{

StageStatus stage(const std::string& name, std::uint64_t units, double seconds)
{
    StageStatus result;
    result.name = name;
    result.units = units;
    result.estimatedSeconds = seconds;
    return result;
}

WorkStatus work(const std::vector<StageStatus>& stages)
{
    WorkStatus result;
    result.stages = stages;
    return result;
}

/// All units of a stage alike.
MeasuredTimes::Stage measured(const std::string& name, double wall, double cpu, double idle = 0.0)
{
    return {name, {{wall, cpu}}, idle};
}

double predicted(const WorkStatus& what, const MeasuredTimes& times, std::uint64_t workers, double cores,
                 std::uint64_t unitsPerJob = 1)
{
    return predict(what, arraysOf({workers, unitsPerJob}, what), times, {workers, cores}, 7);
}

} // namespace

TEST(ClusterJobs, AreWorthTheirStart)
{
    const auto jobs = [](double seconds, std::uint64_t units, JobOptions options)
    {
        const auto arrays = arraysOf(options, work({stage("a", units, seconds)}));
        return arrays.front().jobs;
    };
    EXPECT_EQ(jobs(0.5, 100, {8, 0}), 1u) << "nothing to divide";
    EXPECT_EQ(jobs(3.5, 100, {8, 0}), 4u) << "a second each";
    EXPECT_EQ(jobs(20.0, 100, {8, 0}), 8u) << "no worker stands idle";
    EXPECT_EQ(jobs(100.0, 100, {8, 0}), 20u) << "five seconds each, so that workers end together";
    EXPECT_EQ(jobs(100.0, 100, {2, 0}), 8u) << "but not more than four for each";
    EXPECT_EQ(jobs(3000.0, 200, {8, 0}), 100u) << "half a minute each";
    EXPECT_EQ(jobs(1e9, 1000000, {8, 0}), 1000u);
    EXPECT_EQ(jobs(1e9, 1000000, {4096, 0}), 16384u) << "several for each worker";
    EXPECT_EQ(jobs(1e9, 50, {4096, 0}), 50u) << "no more than units";
    EXPECT_EQ(jobs(1.0, 100, {8, 30}), 4u) << "as was asked for";
}

TEST(ClusterJobs, StagesOfOnePartShareAJob)
{
    StageStatus done = stage("done", 4, 100.0);
    done.done = 4;
    const auto arrays = arraysOf({8, 0}, work({done, stage("a", 1, 0.1), stage("b", 5, 0.2),
                                               stage("c", 50, 100.0), stage("d", 1, 0.1)}));
    ASSERT_EQ(arrays.size(), 3u);
    EXPECT_EQ(arrays[0].stages, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(arrays[1].stages, (std::vector<std::string>{"c"}));
    EXPECT_EQ(arrays[1].jobs, 20u);
    EXPECT_EQ(arrays[2].stages, (std::vector<std::string>{"d"}));
    // Without estimates of their own, units count as alike.
    WorkStatus alike = work({stage("a", 10, 0.0), stage("b", 30, 0.0)});
    alike.estimatedSeconds = 8.0;
    EXPECT_EQ(arraysOf({8, 0}, alike)[0].jobs, 2u);
    EXPECT_EQ(arraysOf({8, 0}, alike)[1].jobs, 6u);
}

TEST(ClusterPrediction, IsTheScheduleOfItsJobs)
{
    MeasuredTimes times;
    times.stages = {measured("a", 2.0, 2.0), measured("b", 1.0, 1.0)};
    const WorkStatus both = work({stage("a", 10, 0.0), stage("b", 3, 0.0)});
    EXPECT_DOUBLE_EQ(predicted(both, times, 1, 1.0), 23.0);
    EXPECT_DOUBLE_EQ(predicted(both, times, 4, 4.0), 3 * 2.0 + 1.0) << "10 jobs on 4 workers are 3 rounds";
    EXPECT_DOUBLE_EQ(predicted(both, times, 100, 100.0), 3.0) << "the second stage waits for the first";
    // Starts, and what lies between.
    times.startWall = 0.5;
    times.startCpu = 0.3;
    times.betweenJobs = 0.25;
    times.betweenStages = 5.0;
    EXPECT_DOUBLE_EQ(predicted(both, times, 1, 1.0), 23.0 + 13 * 0.75 + 5.0);
    EXPECT_DOUBLE_EQ(predicted(both, times, 1, 1.0, 5), 23.0 + 3 * 0.75 + 5.0) << "two jobs and one";
}

TEST(ClusterPrediction, WorkersShareCores)
{
    MeasuredTimes times;
    times.stages = {measured("a", 2.0, 2.0)};
    const WorkStatus eight = work({stage("a", 8, 0.0)});
    EXPECT_NEAR(predicted(eight, times, 8, 2.0), 8.0, 1e-9) << "as on two workers";
    EXPECT_NEAR(predicted(eight, times, 3, 2.0), 8.0, 1e-9) << "two whole rounds and two jobs alone";
    EXPECT_NEAR(predicted(work({stage("a", 9, 0.0)}), times, 8, 2.0), 8.0 + 2.0, 1e-9)
        << "one job alone has one core, not two";
    // Waiting needs no core.
    times.stages = {measured("a", 2.0, 0.5)};
    EXPECT_NEAR(predicted(eight, times, 8, 2.0), 2.0, 1e-9) << "eight quarters of work on two cores";
    EXPECT_NEAR(predicted(eight, times, 8, 1.0), 2.5, 1e-9) << "half of the cores, so half of the speed";
}

TEST(ClusterPrediction, DrawsFromWhatWasMeasured)
{
    MeasuredTimes times;
    times.stages = {{"a", {{1.0, 1.0}, {3.0, 3.0}}, 0.5}};
    const WorkStatus many = work({stage("a", 100000, 0.0)});
    EXPECT_NEAR(predicted(many, times, 1, 1.0, 1000), 100000.0, 1500.0)
        << "half of them take 2 s in the mean";
    const auto arrays = arraysOf({1, 1000}, many);
    const double first = predict(many, arrays, times, {1, 1.0}, 1);
    EXPECT_EQ(first, predict(many, arrays, times, {1, 1.0}, 1));
    EXPECT_NE(first, predict(many, arrays, times, {1, 1.0}, 2));
}

TEST(ClusterPrediction, TakesTheTimesOfTheStageThatIsMostLikeIt)
{
    MeasuredTimes times;
    times.stages = {measured("heights", 1.0, 1.0), measured("heights-1", 2.0, 2.0),
                    measured("tiles-0", 3.0, 3.0), measured("tiles-2", 4.0, 4.0)};
    const auto of = [&](const std::string& name)
    {
        const MeasuredTimes::Stage* found = times.like(name);
        return found ? found->name : "none";
    };
    EXPECT_EQ(of("heights"), "heights");
    EXPECT_EQ(of("heights-3"), "heights-1");
    EXPECT_EQ(of("tiles-0"), "tiles-0");
    EXPECT_EQ(of("tiles-9"), "tiles-2");
    EXPECT_EQ(of("shores"), "none");
    EXPECT_EQ(of("filled-heights"), "none");
}

TEST(ClusterPrediction, GapsBetweenProcessesAreMeasured)
{
    // Two places, until 10 and 12; the latter is taken again at 12.4. The next stage begins at 23.
    osgGeoFX::StageTimes first, second;
    first.name = "a";
    for (const auto& [start, end] : {std::pair(0.5, 10.0), {0.5, 12.0}, {12.4, 20.0}})
        first.processes.push_back({"here", 100.0 + start, 100.0 + end, 0.2, 0.1});
    first.units = {{9.0, 8.0}};
    second.name = "b";
    second.processes.push_back({"here", 123.0, 124.0, 0.4, 0.1});
    second.idle = 3;
    const MeasuredTimes times = MeasuredTimes::of({first, second});
    EXPECT_NEAR(times.betweenJobs, 0.4, 1e-9);
    EXPECT_NEAR(times.betweenStages, 3.0, 1e-9);
    EXPECT_NEAR(times.startWall, 0.2, 1e-9);
    EXPECT_NEAR(times.startCpu, 0.1, 1e-9);
    ASSERT_EQ(times.stages.size(), 2u);
    EXPECT_EQ(times.stages[1].idle, 1.0);
}

TEST(ClusterPrediction, TimesAreKeptInAFile)
{
    const TempDir folder;
    const std::string file = (folder / "times.json").string();
    MeasuredTimes times;
    times.startWall = 0.25;
    times.startCpu = 0.125;
    times.betweenJobs = 1.5;
    times.betweenStages = 2.5;
    times.stages = {{"a", {{1.0, 0.5}, {3.0, 2.0}}, 0.25}};
    times.write(file);
    const MeasuredTimes read = MeasuredTimes::read(file);
    EXPECT_EQ(read.startWall, 0.25);
    EXPECT_EQ(read.startCpu, 0.125);
    EXPECT_EQ(read.betweenJobs, 1.5);
    EXPECT_EQ(read.betweenStages, 2.5);
    ASSERT_EQ(read.stages.size(), 1u);
    EXPECT_EQ(read.stages[0].name, "a");
    EXPECT_EQ(read.stages[0].idle, 0.25);
    ASSERT_EQ(read.stages[0].units.size(), 2u);
    EXPECT_EQ(read.stages[0].units[1].wall, 3.0);
    EXPECT_EQ(read.stages[0].units[1].cpu, 2.0);
    std::ofstream(folder / "broken.json") << "{";
    EXPECT_THROW(MeasuredTimes::read((folder / "broken.json").string()), std::runtime_error);
    EXPECT_THROW(MeasuredTimes::read((folder / "missing.json").string()), std::runtime_error);
}
