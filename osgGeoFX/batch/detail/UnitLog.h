// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/PlannedWork.h>
#include <osgGeoFX/batch/WorkTimes.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// The folder of all accounts, among the work files.
constexpr const char* LOG_FOLDER = "log";

/** The account that a process keeps of the units of a stage: a file of its own, a line for each event, each written at once. A
    unit that it calls done has left all of its results before. Each thread does one unit at a time. Thread-safe. */
class UnitLog
{
public:
    /// `threads`: how many do units. Throws WorkError if the file cannot be made.
    UnitLog(const std::string& folder, const std::string& stage, int threads);
    ~UnitLog();
    UnitLog(const UnitLog&) = delete;
    UnitLog& operator=(const UnitLog&) = delete;

    void begin(std::uint64_t unit);
    void done(std::uint64_t unit);
    void fail(std::uint64_t unit, const std::string& sentence);

private:
    double cpuTime() const;
    void write(const std::string& line);

    std::string _path;
    int _descriptor = -1;
    const bool _wholeProcess; ///< whether the CPU time of all its threads counts
};

/// What all processes say of a stage.
struct StageAccount
{
    StageStatus status;
    StageTimes times;
    std::vector<bool> done; ///< by unit
};
StageAccount readUnitLogs(const std::string& folder, const WorkPlan::Stage& stage);

/// A mark that a stage is done, so that nobody needs to read its logs again.
std::string stageDoneFile(const std::string& folder, const std::string& stage);

} // namespace osgGeoFX
