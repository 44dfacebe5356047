// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "cluster/Prediction.h"

#include <osgGeoFX/batch/WholeFile.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <queue>
#include <random>
#include <stdexcept>

namespace geofx::cluster
{

using osgGeoFX::ProcessTime;
using osgGeoFX::StageStatus;
using osgGeoFX::StageTimes;
using osgGeoFX::UnitTime;

namespace
{

constexpr const char* FORMAT = "osgGeoFX unit times";
constexpr int VERSION = 1;
/// So many times tell a stage's distribution.
constexpr std::size_t MOST_SAMPLES = 5000;

double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// How long the places of ended processes were empty, until the next ones of a stage took them.
void addGaps(std::vector<ProcessTime> processes, std::vector<double>& gaps)
{
    std::sort(processes.begin(), processes.end(),
              [](const ProcessTime& a, const ProcessTime& b) { return a.start < b.start; });
    std::map<std::string, std::vector<double>> ends; // of places that are free, by host
    std::vector<const ProcessTime*> running;
    for (const ProcessTime& each : processes)
    {
        std::vector<double>& free = ends[each.host];
        for (auto other = running.begin(); other != running.end();)
        {
            const bool ended = (*other)->end <= each.start;
            if (ended) ends[(*other)->host].push_back((*other)->end);
            other = ended ? running.erase(other) : other + 1;
        }
        const auto last = std::max_element(free.begin(), free.end());
        if (last != free.end())
        {
            if (each.startWall > 0.0) gaps.push_back(each.start - *last);
            free.erase(last);
        }
        running.push_back(&each);
    }
}

/// What a job needs, seconds.
struct Job
{
    double cpu = 0.0;
    double wait = 0.0; ///< for disks, the network and the engine
};

/// The time that jobs take which begin in their order.
double schedule(const std::vector<Job>& jobs, const Machines& machines)
{
    const std::size_t places = static_cast<std::size_t>(
        std::min<std::uint64_t>(machines.workers, std::max<std::size_t>(jobs.size(), 1)));
    // Jobs that run are known by the work that is left of them, of 1. Those who share cores all get the same share.
    struct Running
    {
        double left = 1.0;
        const Job* job = nullptr;
    };
    if (machines.cores >= static_cast<double>(places))
    {
        std::priority_queue<double, std::vector<double>, std::greater<>> free;
        for (std::size_t i = 0; i < places; ++i)
            free.push(0.0);
        double end = 0.0;
        for (const Job& job : jobs)
        {
            const double ended = free.top() + job.cpu + job.wait;
            free.pop();
            free.push(ended);
            end = std::max(end, ended);
        }
        return end;
    }
    std::vector<Running> running;
    double now = 0.0;
    std::size_t next = 0;
    while (next < jobs.size() || !running.empty())
    {
        while (running.size() < places && next < jobs.size())
            running.push_back({1.0, &jobs[next++]});
        // While some wait, the others have more of the cores.
        double load = 0.0;
        for (const Running& each : running)
            if (each.job->cpu > 0.0) load += each.job->cpu / (each.job->cpu + each.job->wait);
        const double share = std::min(1.0, machines.cores / std::max(load, 1e-9));
        const auto duration = [&](const Running& each)
        {
            return each.job->cpu / share + each.job->wait;
        };
        double step = HUGE_VAL;
        for (const Running& each : running)
            step = std::min(step, each.left * duration(each));
        now += step;
        for (Running& each : running)
        {
            const double whole = duration(each);
            each.left = whole > 0.0 ? each.left - step / whole : 0.0;
        }
        running.erase(std::remove_if(running.begin(), running.end(),
                                     [](const Running& each) { return each.left <= 1e-12; }),
                      running.end());
    }
    return now;
}

/// The name of a stage without its tier, and the tier; −1 if it has none.
std::pair<std::string, int> kindOf(const std::string& name)
{
    const std::size_t dash = name.rfind('-');
    if (dash == std::string::npos || dash + 1 == name.size() ||
        name.find_first_not_of("0123456789", dash + 1) != std::string::npos || name.size() - dash > 5)
        return {name, -1};
    return {name.substr(0, dash), std::stoi(name.substr(dash + 1))};
}

} // namespace

MeasuredTimes MeasuredTimes::of(const std::vector<StageTimes>& stages)
{
    MeasuredTimes result;
    std::vector<double> startWalls, startCpus, gaps, pauses;
    double lastEnd = 0.0;
    for (const StageTimes& stage : stages)
    {
        const double units = static_cast<double>(stage.units.size());
        const double idle = static_cast<double>(stage.idle);
        if (units + idle > 0.0) result.stages.push_back({stage.name, stage.units, idle / (units + idle)});
        double first = HUGE_VAL, end = 0.0;
        for (const ProcessTime& process : stage.processes)
        {
            end = std::max(end, process.end);
            if (process.startWall <= 0.0) continue;
            startWalls.push_back(process.startWall);
            startCpus.push_back(process.startCpu);
            first = std::min(first, process.start);
        }
        addGaps(stage.processes, gaps);
        if (lastEnd > 0.0 && first < HUGE_VAL && first > lastEnd) pauses.push_back(first - lastEnd);
        lastEnd = std::max(lastEnd, end);
    }
    result.startWall = median(startWalls);
    result.startCpu = median(startCpus);
    result.betweenJobs = median(gaps);
    result.betweenStages = median(pauses);
    return result;
}

MeasuredTimes MeasuredTimes::read(const std::string& path)
{
    if (std::filesystem::is_directory(path)) return of(osgGeoFX::readWorkTimes(path));
    std::ifstream stream(path);
    if (!stream)
        throw std::runtime_error(path + ": the times cannot be opened; write them with osggeofx_cluster "
                                        "predict DIR --save FILE.");
    try
    {
        const nlohmann::json json = nlohmann::json::parse(stream);
        if (json.at("format") != FORMAT || json.at("version") != VERSION)
            throw std::runtime_error(path + ": these are no times of this version; write them anew with "
                                            "osggeofx_cluster predict DIR --save FILE.");
        MeasuredTimes result;
        json.at("startWall").get_to(result.startWall);
        json.at("startCpu").get_to(result.startCpu);
        json.at("betweenJobs").get_to(result.betweenJobs);
        json.at("betweenStages").get_to(result.betweenStages);
        for (const auto& stage : json.at("stages"))
        {
            Stage each;
            stage.at("name").get_to(each.name);
            stage.at("idle").get_to(each.idle);
            for (const auto& unit : stage.at("units"))
                each.units.push_back({unit.at(0).get<double>(), unit.at(1).get<double>()});
            result.stages.push_back(std::move(each));
        }
        return result;
    }
    catch (const nlohmann::json::exception& error)
    {
        throw std::runtime_error(path + ": the times are damaged (" + error.what() +
                                 "); write them anew with osggeofx_cluster predict DIR --save FILE.");
    }
}

void MeasuredTimes::write(const std::string& file) const
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Stage& stage : stages)
    {
        nlohmann::ordered_json units = nlohmann::ordered_json::array();
        const std::size_t count = std::min(stage.units.size(), MOST_SAMPLES);
        for (std::size_t i = 0; i < count; ++i)
        {
            // Units that follow each other are alike, so they are taken from all over.
            const UnitTime& unit = stage.units[i * stage.units.size() / count];
            units.push_back({unit.wall, unit.cpu});
        }
        list.push_back({{"name", stage.name}, {"idle", stage.idle}, {"units", units}});
    }
    const nlohmann::ordered_json json = {
        {"format", FORMAT},     {"version", VERSION},         {"startWall", startWall},
        {"startCpu", startCpu}, {"betweenJobs", betweenJobs}, {"betweenStages", betweenStages},
        {"stages", list}};
    const std::string text = json.dump() + "\n";
    if (const int error = osgGeoFX::writeWholeFile(file, text.data(), text.size()))
        throw std::runtime_error(file + ": cannot be written (" + std::generic_category().message(error) +
                                 "); choose another place with --save.");
}

const MeasuredTimes::Stage* MeasuredTimes::like(const std::string& name) const
{
    const auto [kind, tier] = kindOf(name);
    const Stage* best = nullptr;
    int bestDistance = 0;
    for (const Stage& stage : stages)
    {
        const auto [itsKind, itsTier] = kindOf(stage.name);
        const int distance = std::abs(itsTier - tier);
        if (itsKind != kind || (itsTier < 0) != (tier < 0) || (best && distance >= bestDistance)) continue;
        best = &stage;
        bestDistance = distance;
    }
    return best;
}

double predict(const osgGeoFX::WorkStatus& work, const std::vector<JobArray>& arrays,
               const MeasuredTimes& times, const Machines& machines, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    const auto draw = [&](const MeasuredTimes::Stage& stage, Job& job)
    {
        if (stage.units.empty() || std::uniform_real_distribution<>()(random) < stage.idle) return;
        const UnitTime& unit =
            stage.units[std::uniform_int_distribution<std::size_t>(0, stage.units.size() - 1)(random)];
        job.cpu += unit.cpu;
        job.wait += std::max(unit.wall - unit.cpu, 0.0);
    };
    double seconds = 0.0;
    for (const JobArray& array : arrays)
    {
        // Where there was one job, or one stage, nothing was measured between.
        if (seconds > 0.0) seconds += times.betweenStages;
        std::vector<Job> jobs(array.jobs);
        for (std::uint64_t part = 0; part < array.jobs; ++part)
        {
            Job& job = jobs[part];
            job.cpu = times.startCpu;
            job.wait = std::max(times.startWall - times.startCpu, 0.0) + times.betweenJobs;
            for (const std::string& name : array.stages)
            {
                const auto stage = std::find_if(work.stages.begin(), work.stages.end(),
                                                [&](const StageStatus& each) { return each.name == name; });
                const MeasuredTimes::Stage* measured = times.like(name);
                if (stage == work.stages.end() || !measured) continue;
                // As the worker divides them.
                const std::uint64_t first = stage->units * part / array.jobs;
                const std::uint64_t end = stage->units * (part + 1) / array.jobs;
                for (std::uint64_t unit = first; unit < end; ++unit)
                    draw(*measured, job);
            }
        }
        seconds += schedule(jobs, machines);
    }
    return seconds;
}

} // namespace geofx::cluster
