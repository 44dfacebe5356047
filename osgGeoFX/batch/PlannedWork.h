// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/batch/WorkStage.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** The plan of a work that any number of processes do, on one machine or on many with a shared folder: `work/plan.json`
    in the folder of the result. Here is what all plans have; the program that has made one adds what it needs itself.
    Beside the plan, processes keep accounts of their units, which tell what is done.
    @ingroup batch */
struct OSGGEOFX_EXPORT WorkPlan
{
    std::string program = "osggeofx_build"; ///< that does the units, with --work and --unit
    struct Stage
    {
        std::string name;
        std::uint64_t units = 0;
        double seconds = 0.0; ///< of one core, as the plan estimates; 0 if it does not say
    };
    std::vector<Stage> stages;     ///< in their order
    double estimatedSeconds = 0.0; ///< of the whole work, as the plan estimates

    /// Where a work keeps its files while it goes on.
    static std::string workFolder(const std::string& folder);
    /// The plan's own: JSON with `program`, `estimate.seconds` and `stages`, a list of `name`, `units`, `seconds`.
    static std::string file(const std::string& folder);
    /// Whether a folder has a plan that is not finished.
    static bool isIn(const std::string& folder);
    /// Throws WorkError if there is none, or a damaged one.
    static WorkPlan read(const std::string& folder);

    /// Where finish() leaves the plan.
    static std::string finishedFile(const std::string& folder);
    /// Moves the plan out of the work files and removes these, and what killed processes have left beside the results: the
    /// work is finished. Nothing is left to do where another process has done so. Throws WorkError. Any thread may call it.
    static void finish(const std::string& folder);
};

/// What doUnits() has done.
/// @ingroup batch
struct BuiltUnits
{
    std::uint64_t built = 0;     ///< by this call
    std::uint64_t takenOver = 0; ///< done before
    std::uint64_t kept = 0;      ///< an update had nothing to do for them
    bool finished = false;       ///< the last stage is done
};

/// How doUnits() does them.
/// @ingroup batch
struct UnitOptions
{
    int threads = 1;
    /// Called now and then while no unit is in work, to drop what can be read again; empty for nobody.
    std::function<void()> pause;
};

/** Does units of a planned work.

    Each of `ranges` is STAGE:A-B (units A to B, from 0), STAGE:A, or STAGE:I/N: the part I, from 0, of N parts of about
    the same size. STAGE is a stage's name or its number, from 0. Ranges are done one after the other.

    Any number of processes may do any units at once, even the same ones. A process may be killed at any time. Its
    units are then done again by the same call. Throws WorkError for ranges that the stages do not have, and if a stage
    before is not done; and what units throw. Any thread may call it, with stages of its own.
    @ingroup batch */
OSGGEOFX_EXPORT BuiltUnits doUnits(const std::string& folder, const WorkStages& stages,
                                   const std::vector<std::string>& ranges, const UnitOptions& options);

/// How far a stage of a planned work is.
/// @ingroup batch
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
    std::vector<Failed> failed;    ///< not done since
    double unitSeconds = 0.0;      ///< the median time of a unit; 0 if none was timed
    double rate = 0.0;             ///< units done for each second, from the first begin on; 0 if unknown
    double estimatedSeconds = 0.0; ///< of one core, for all units, as planned
    double remainingSeconds() const { return rate > 0.0 ? static_cast<double>(units - done) / rate : 0.0; }

    /// A unit in work is slow if it has taken more than three times the median, and more than ten seconds.
    bool isSlow(const Begun& each) const
    {
        return unitSeconds > 0.0 && each.seconds > 10.0 && each.seconds > 3.0 * unitSeconds;
    }
};

/// How far a planned work is.
/// @ingroup batch
struct WorkStatus
{
    bool finished = false;           ///< the last stage is done
    std::string program;             ///< that does the units
    std::vector<StageStatus> stages; ///< empty if finished
    double estimatedSeconds = 0.0;   ///< of the whole work, as planned
    std::string logFolder;           ///< where processes keep their accounts, until the work is finished
};

/// Reads the plan and the accounts that processes leave in the folder. Throws WorkError if there is no plan. Any thread
/// may call it, while processes work.
/// @ingroup batch
OSGGEOFX_EXPORT WorkStatus readWorkStatus(const std::string& folder);

} // namespace osgGeoFX
