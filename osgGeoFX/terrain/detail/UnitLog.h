// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/DistributedBuild.h>

#include <mutex>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// The folder of all accounts, among the work files.
constexpr const char* LOG_FOLDER = "log";

/** The account that a process keeps of the units of a stage: a file of its own, a line for each event, each written at once. A
    unit that it calls done has left all of its results before. Thread-safe. */
class UnitLog
{
public:
    /// Throws BuildError if the file cannot be made.
    UnitLog(const std::string& folder, const std::string& stage);
    ~UnitLog();
    UnitLog(const UnitLog&) = delete;
    UnitLog& operator=(const UnitLog&) = delete;

    void begin(std::uint64_t unit);
    void done(std::uint64_t unit);
    void fail(std::uint64_t unit, const std::string& sentence);

private:
    void write(const std::string& line);

    std::string _path;
    int _descriptor = -1;
};

/// What all processes say of a stage. If `isDone` is given, it tells which of the units are done.
StageStatus readUnitLogs(const std::string& folder, const std::string& stage, std::uint64_t units,
                         std::vector<bool>* isDone = nullptr);

/// A mark that a stage is done, so that nobody needs to read its logs again.
std::string stageDoneFile(const std::string& folder, const std::string& stage);

} // namespace osgGeoFX
