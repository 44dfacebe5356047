// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/FolderLock.h>
#include <osgGeoFX/batch/WorkError.h>
#include <osgGeoFX/geodata/BuildError.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

class BuildPlan;

/// The file of a database's folder that says what it was built from. An update that goes on has one among its work files.
constexpr const char* ORIGIN_FILE = "built-from.txt";
/// How that file begins, which tells a database from folders of others.
constexpr const char* ORIGIN_BEGIN = "osgGeoFX terrain database";
/// The file among what is kept that says what all units depend on (BuildPlan::common).
constexpr const char* COMMON_FILE = "common.txt";
/// The file among what is kept that has the range of all heights, which colors may follow.
constexpr const char* RANGE_FILE = "heights.txt";
/// The folder of the units' records (UnitRecord), among the work files and among what is kept.
constexpr const char* UNIT_RECORDS = "records";

/// Where a build keeps its files while it goes on, in the database's folder.
std::filesystem::path workFolderOf(const std::filesystem::path& database);
/// Where a build leaves what updates need.
std::filesystem::path keptFolderOf(const std::filesystem::path& database);
/// Where an update puts the files of the new database until all are ready. They have the names that they will have.
std::filesystem::path stagedFolderOf(const std::filesystem::path& database);

/// What RANGE_FILE says of a plan whose heights are known.
std::string heightRange(const BuildPlan& plan);

/// All of a file; empty if it cannot be read.
std::string readText(const std::filesystem::path& path);

/// The result of a call. What it says of a work or a folder, it says of a build.
template<typename Call>
auto sayAsBuildError(Call call)
{
    try
    {
        return call();
    }
    catch (const WorkError& error)
    {
        throw BuildError(error.what());
    }
}

/// Locks a database's folder. Throws BuildError if somebody else has it.
std::shared_ptr<const FolderLock> lockFolder(const std::filesystem::path& folder, FolderLock::Kind kind);

/// How a build begins.
struct FolderState
{
    bool finished = false;  ///< the database is there, made from the same
    bool update = false;    ///< another one is there, to be updated
    std::string allBecause; ///< why the update must build everything, as a clause; else empty
};

/** Empties or adopts the output folder, which nobody else may use as long as the plan lives. Sets the plan's `folderLock`, `staged` and `kept`. Throws
    BuildError.

    What makes a folder what it is:
    - `built-from.txt` and no `terrain.osgb`: a build was begun.
    - both: a database.
    - `work/built-from.txt` besides: an update was begun. The database is the former one.
    - `work/commit` besides: the update is ready, and its files are being put into their places. Any call ends this. */
FolderState prepareFolder(BuildPlan& plan);

/// Sets the plan's `staged` and `kept` for a build that prepareFolder() has begun, in another process.
void joinBuild(BuildPlan& plan);

/// Says that a build is ready, whose root file is there or waits among the staged files. `obsolete`: tiles that no longer belong,
/// below the database's folder. completeFolder() does the rest.
void finishFolder(const BuildPlan& plan, const std::vector<std::string>& obsolete);

/// Ends a build that is ready, even if that was interrupted: puts staged files into their places, removes what no longer belongs,
/// keeps what updates need if the options say so, and removes all other work files. Does nothing if no build is ready. Any number of
/// processes may.
void completeFolder(const std::filesystem::path& database);

/// Removes the temporary files of processes that were killed, when the build has ended. What cannot be removed does no harm.
void removeLeftovers(const BuildPlan& plan);

/// The size of all files in a folder; 0 without one.
std::uint64_t bytesBelow(const std::filesystem::path& folder);

} // namespace osgGeoFX
