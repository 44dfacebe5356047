// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <cstdint>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// What a unit of a planned work took, seconds.
/// @ingroup batch
struct UnitTime
{
    double wall = 0.0; ///< but for the time in which others had its core
    double cpu = 0.0;  ///< of the thread that did it, or of the whole process where that had one thread
};

/// A process that has done units of a stage. Times are in seconds, points in time since 1970.
/// @ingroup batch
struct ProcessTime
{
    std::string host;
    double start = 0.0; ///< when it was started
    double end = 0.0;   ///< its last sign of life
    /// From its start to its first unit, but for the time in which others had its core; 0 if it did other units before.
    double startWall = 0.0;
    double startCpu = 0.0; ///< the same in CPU time
};

/// The times that were measured of a stage.
/// @ingroup batch
struct StageTimes
{
    std::string name;
    std::vector<UnitTime> units; ///< those that were done, in no order
    std::uint64_t idle = 0;      ///< units that had nothing to do
    std::vector<ProcessTime> processes;
};

/// Reads the times of all stages that a work's plan has from the accounts of its processes. Accounts are there until
/// the last stage is done. Throws WorkError if there is no plan. Any thread may call it, while processes work.
/// @ingroup batch
OSGGEOFX_EXPORT std::vector<StageTimes> readWorkTimes(const std::string& folder);

} // namespace osgGeoFX
