// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "cluster/Jobs.h"

#include <osgGeoFX/batch/WorkTimes.h>

#include <cstdint>
#include <string>
#include <vector>

namespace geofx::cluster
{

/// What was measured of the units of a work and of its processes. As a file it is JSON.
struct MeasuredTimes
{
    struct Stage
    {
        std::string name;
        std::vector<osgGeoFX::UnitTime> units;
        double idle = 0.0; ///< the share of units that had nothing to do
    };
    std::vector<Stage> stages;
    // Medians, seconds.
    double startWall = 0.0; ///< of a process, until its first unit
    double startCpu = 0.0;  ///< the same in CPU time
    double betweenJobs =
        0.0; ///< from the last unit of a process to the start of the one that takes its place
    double betweenStages =
        0.0; ///< from the last unit of a stage to the start of the first process of the next one

    static MeasuredTimes of(const std::vector<osgGeoFX::StageTimes>& stages);
    /// From a file that write() has written, or from the folder of a plan. Throws std::runtime_error with a sentence.
    static MeasuredTimes read(const std::string& path);
    void write(const std::string& file) const;
    /// The times of a stage, or of the one that is most like it: `tiles-4` has those of `tiles-2` if no higher tier was
    /// measured. Null if there is none.
    const Stage* like(const std::string& name) const;
};

struct Machines
{
    std::uint64_t workers = 1; ///< processes at once
    double cores = 1.0;        ///< that they share
};

/** The wall time that a work would take, seconds: each unit gets the times of one that was measured, drawn at random by
    `seed`. Jobs begin in their order as soon as a worker is free, and those of an array when the one before is done. More
    workers than cores share these. */
double predict(const osgGeoFX::WorkStatus& work, const std::vector<JobArray>& arrays,
               const MeasuredTimes& times, const Machines& machines, std::uint64_t seed);

} // namespace geofx::cluster
