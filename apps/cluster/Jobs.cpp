// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "cluster/Jobs.h"

#include <algorithm>
#include <cmath>

namespace geofx::cluster
{

using osgGeoFX::StageStatus;
using osgGeoFX::WorkStatus;

namespace
{

// A job should take about so long, seconds: its start takes a tenth of a second. It may be shorter so that all workers end
// at about the same time, and no less than a second if workers would stand idle otherwise.
constexpr double JOB_SECONDS = 30.0, EVEN_JOB_SECONDS = 5.0, LEAST_JOB_SECONDS = 1.0;
// So many are worth their starts where a stage takes days.
constexpr std::uint64_t USUAL_MOST_JOBS = 1000, JOBS_PER_WORKER = 4;

/// Of one core.
double secondsOf(const WorkStatus& work, const StageStatus& stage)
{
    if (stage.estimatedSeconds > 0.0) return stage.estimatedSeconds;
    // Units of different stages count as alike.
    std::uint64_t all = 0;
    for (const StageStatus& each : work.stages)
        all += each.units;
    return work.estimatedSeconds * static_cast<double>(stage.units) /
           static_cast<double>(std::max<std::uint64_t>(all, 1));
}

std::uint64_t jobsOf(const JobOptions& options, const WorkStatus& work, const StageStatus& stage)
{
    const std::uint64_t units = std::max<std::uint64_t>(stage.units, 1);
    const std::uint64_t most =
        std::min(units, std::max(USUAL_MOST_JOBS, JOBS_PER_WORKER * options.maxWorkers));
    if (options.unitsPerJob > 0)
        return std::clamp<std::uint64_t>((units + options.unitsPerJob - 1) / options.unitsPerJob, 1, most);
    const double seconds = secondsOf(work, stage);
    const auto jobs = [&](double each)
    {
        return static_cast<std::uint64_t>(std::min(std::ceil(seconds / each), 1e15));
    };
    const std::uint64_t busy = std::min(options.maxWorkers, jobs(LEAST_JOB_SECONDS));
    const std::uint64_t even = std::min(JOBS_PER_WORKER * options.maxWorkers, jobs(EVEN_JOB_SECONDS));
    return std::clamp<std::uint64_t>(std::max({busy, even, jobs(JOB_SECONDS)}), 1, most);
}

} // namespace

std::vector<JobArray> arraysOf(const JobOptions& options, const WorkStatus& work)
{
    std::vector<JobArray> arrays;
    for (const StageStatus& stage : work.stages)
    {
        // If all of the last one is done but the work is not finished, its process was lost on the way.
        if (stage.done == stage.units && &stage != &work.stages.back()) continue;
        const std::uint64_t jobs = jobsOf(options, work, stage);
        if (jobs == 1 && !arrays.empty() && arrays.back().jobs == 1)
            arrays.back().stages.push_back(stage.name);
        else
            arrays.push_back({{stage.name}, jobs});
    }
    return arrays;
}

} // namespace geofx::cluster
