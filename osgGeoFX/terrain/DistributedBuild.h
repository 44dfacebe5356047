// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/DatabaseBuilder.h>

#include <cstdint>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Plans a build that any number of processes do, on one machine or on many with a shared folder.

    The plan is among the work files in the folder of the database, as `plan.json`: options, sources, the grid, and the build's
    stages with their numbers of units. buildUnits() does the units. The stages follow each other. The units of a stage do
    not need each other. The last stage, "finish", writes `terrain.osgb` and removes the work files. The database then has
    the same bytes as that of buildDatabase().

    If the folder has a finished database and `update` is set, the plan is for an update (buildDatabase()). The former
    database then stays until "finish".

    It reads the headers of the rasters only. The plan holds for these rasters: if one changes, no unit is built any
    more. The options `threads` and `memoryMiB` are those of each process. Unless `resume` is set, it empties a folder
    that an earlier build has begun. Throws BuildError. Any thread may call it.
    @ingroup terrain */
OSGGEOFXDATA_EXPORT BuildEstimate planBuild(const BuildOptions& options);

/// What buildUnits() has done.
/// @ingroup terrain
struct BuiltUnits
{
    std::uint64_t built = 0;     ///< by this call
    std::uint64_t takenOver = 0; ///< done before
    std::uint64_t kept = 0;      ///< an update had nothing to do for them
    std::uint64_t tilesKept = 0; ///< tiles of the former database that stay, of units that were built or kept
    bool finished = false;       ///< terrain.osgb is there
};

/** Does units of a planned build.

    Each of `ranges` is STAGE:A-B (units A to B, from 0), STAGE:A, or STAGE:I/N: the part I, from 0, of N parts of about
    the same size. STAGE is a stage's name or its number, from 0. Ranges are done one after the other.

    Any number of processes may do any units at once, even the same ones. A process may be killed at any time. Its
    units are then done again by the same call. Throws BuildError: if the plan is missing or does not hold any more, for
    ranges that the plan does not have, and if a stage before is not done. Any thread may call it.

    `threads` and `memoryMiB` replace those of the plan if they are greater than 0.
    @ingroup terrain */
OSGGEOFXDATA_EXPORT BuiltUnits buildUnits(const std::string& folder, const std::vector<std::string>& ranges,
                                          int threads = 0, int memoryMiB = 0);

/// How far a stage of a planned build is.
/// @ingroup terrain
struct StageStatus
{
    std::string name;
    std::uint64_t units = 0; ///< in all
    std::uint64_t done = 0;
    /// Begun at a time, and neither done nor failed since: in work, or its process was killed.
    struct Begun
    {
        std::uint64_t unit = 0;
        double seconds = 0.0; ///< since its begin
        std::string process;  ///< the machine and the process's number there
    };
    std::vector<Begun> begun;
    struct Failed
    {
        std::uint64_t unit = 0;
        std::string sentence;
    };
    std::vector<Failed> failed; ///< not done since
    double unitSeconds = 0.0;   ///< the median time of a unit; 0 if none was timed
    double rate = 0.0;          ///< units done for each second, from the first begin on; 0 if unknown
    double remainingSeconds() const { return rate > 0.0 ? static_cast<double>(units - done) / rate : 0.0; }

    /// A unit in work is slow if it has taken more than three times the median, and more than ten seconds.
    bool isSlow(const Begun& each) const
    {
        return unitSeconds > 0.0 && each.seconds > 10.0 && each.seconds > 3.0 * unitSeconds;
    }
};

/// How far a planned build is.
/// @ingroup terrain
struct BuildStatus
{
    bool finished = false;           ///< terrain.osgb is there
    std::vector<StageStatus> stages; ///< empty if finished
    double estimatedSeconds = 0.0;   ///< of the whole build, as planned
    std::string logFolder;           ///< where processes keep their accounts, until the build is finished
};

/// Reads the plan and the accounts that processes leave in the folder. Throws BuildError if there is no plan. Any thread
/// may call it, while processes build.
OSGGEOFXDATA_EXPORT BuildStatus readBuildStatus(const std::string& folder);

} // namespace osgGeoFX
