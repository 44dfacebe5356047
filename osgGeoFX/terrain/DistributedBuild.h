// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/PlannedWork.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>

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

    If the folder has the database already, made of the same, no plan is written.

    It reads the headers of the rasters only. The plan holds for these rasters: if one changes, no unit is built any
    more. The options `threads` and `memoryMiB` are those of each process. Unless `resume` is set, it empties a folder
    that an earlier build has begun. Throws BuildError. Any thread may call it.
    @ingroup terrain */
OSGGEOFXDATA_EXPORT BuildEstimate planBuild(const BuildOptions& options);

/// What buildUnits() has done.
/// @ingroup terrain
struct BuiltDatabaseUnits : BuiltUnits
{
    std::uint64_t tilesKept = 0; ///< tiles of the former database that stay, of units that were built or kept
};

/** Does units of a planned build.

    `ranges` are those of doUnits(), and the same promises hold. Throws BuildError: if the plan is missing or does not hold
    any more, for ranges that the plan does not have, and if a stage before is not done. Any thread may call it.

    `threads` and `memoryMiB` replace those of the plan if they are greater than 0.
    @ingroup terrain */
OSGGEOFXDATA_EXPORT BuiltDatabaseUnits buildUnits(const std::string& folder,
                                                  const std::vector<std::string>& ranges, int threads = 0,
                                                  int memoryMiB = 0);

/// How far a planned build is.
/// @ingroup terrain
using BuildStatus = WorkStatus;

/// Reads the plan and the accounts that processes leave in the folder. Throws BuildError if there is no plan. Any thread
/// may call it, while processes build.
OSGGEOFXDATA_EXPORT BuildStatus readBuildStatus(const std::string& folder);

} // namespace osgGeoFX
