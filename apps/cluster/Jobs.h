// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/PlannedWork.h>

#include <cstdint>
#include <string>
#include <vector>

/// Planned works on batch engines.
namespace geofx::cluster
{

struct JobOptions
{
    std::uint64_t maxWorkers = 8;  ///< processes at once
    std::uint64_t unitsPerJob = 0; ///< 0: so many that a job is worth its start
};

/// Stages that one array of jobs does: one stage in parts, or several stages in a row that have one part each.
struct JobArray
{
    std::vector<std::string> stages;
    std::uint64_t jobs = 1;
};

/// The arrays of jobs that do what is left of a work, in their order.
std::vector<JobArray> arraysOf(const JobOptions& options, const osgGeoFX::WorkStatus& work);

} // namespace geofx::cluster
