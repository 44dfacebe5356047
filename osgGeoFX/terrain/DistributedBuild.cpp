// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/DistributedBuild.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/PlanFile.h>
#include <osgGeoFX/terrain/detail/TilePass.h>
#include <osgGeoFX/terrain/detail/UnitLog.h>
#include <osgGeoFX/terrain/detail/WorkQueue.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// Facts that are kept in memory are dropped after so many units.
constexpr std::uint64_t BATCH = 500;
/// A sentence names so many gaps at most.
constexpr std::size_t NAMED_GAPS = 5;

struct Range
{
    std::size_t stage = 0;
    std::uint64_t first = 0, end = 0;
};

/// A whole number below 10¹⁸; empty if the text is something else.
std::optional<std::uint64_t> numberOf(const std::string& text)
{
    if (text.empty() || text.size() > 18 || text.find_first_not_of("0123456789") != std::string::npos)
        return {};
    return std::stoull(text);
}

std::size_t stageOf(const PlanFile& plan, const std::string& name)
{
    std::string names;
    for (std::size_t i = 0; i < plan.stages.size(); ++i)
    {
        if (plan.stages[i].first == name) return i;
        names += (i > 0 ? ", " : "") + plan.stages[i].first;
    }
    if (const auto number = numberOf(name); number && *number < plan.stages.size())
        return static_cast<std::size_t>(*number);
    throw BuildError(PlanFile::file(plan.options.output) + ": the plan has no stage \"" + name +
                     "\"; it has " + names + ".");
}

Range parseRange(const PlanFile& plan, const std::string& text)
{
    const std::size_t colon = text.find(':');
    Range range;
    range.stage = stageOf(plan, text.substr(0, colon));
    const auto& [name, units] = plan.stages[range.stage];
    if (colon == std::string::npos) return {range.stage, 0, units};
    const std::string rest = text.substr(colon + 1);
    const std::size_t sign = rest.find_first_of("-/");
    const auto first = numberOf(rest.substr(0, sign));
    const auto second = sign == std::string::npos ? first : numberOf(rest.substr(sign + 1));
    if (!first || !second)
        throw BuildError("--unit " + text +
                         ": write it as STAGE:A-B, the units A to B, or as STAGE:I/N, the part I of N.");
    if (sign != std::string::npos && rest[sign] == '/')
    {
        if (*first >= *second || *second > 1000000000)
            throw BuildError("--unit " + text + ": parts are counted from 0, so of " +
                             std::to_string(*second) + " parts the last is " +
                             std::to_string(std::max<std::uint64_t>(*second, 1) - 1) + ".");
        range.first = units * *first / *second;
        range.end = units * (*first + 1) / *second;
        return range;
    }
    if (*first > *second || *second >= units)
        throw BuildError("--unit " + text + ": the stage " + name + " has the units 0 to " +
                         std::to_string(units - 1) + "; name the lower one first.");
    range.first = *first;
    range.end = *second + 1;
    return range;
}

/// Throws BuildError unless all units of a stage are done.
void requireDone(const std::string& folder, const std::string& stage, std::uint64_t units)
{
    if (fs::exists(stageDoneFile(folder, stage))) return;
    std::vector<bool> done;
    const StageStatus status = readUnitLogs(folder, stage, units, &done);
    if (status.done == units)
    {
        writeFileAtomically(stageDoneFile(folder, stage), "", 0);
        return;
    }
    std::string gaps;
    std::size_t count = 0;
    for (std::uint64_t unit = 0; unit < units;)
    {
        std::uint64_t end = unit;
        while (end < units && !done[end])
            ++end;
        if (end > unit && ++count <= NAMED_GAPS)
            gaps += " " + stage + ":" + std::to_string(unit) + "-" + std::to_string(end - 1);
        unit = end + 1;
    }
    throw BuildError(folder + ": of the stage " + stage + ", " + std::to_string(units - status.done) +
                     " of " + std::to_string(units) + " units are missing; build them first, with --unit" +
                     gaps + (count > NAMED_GAPS ? " and more." : "."));
}

void buildRange(BuildPlan& plan, BuildStage& stage, const Range& range, BuiltUnits& result)
{
    UnitLog log(plan.options.output, stage.name());
    std::atomic<std::uint64_t> built{0}, takenOver{0}, kept{0};
    const bool needed = stage.isNeeded();
    if (needed) stage.begin();
    for (std::uint64_t first = range.first; first < range.end; first += BATCH)
    {
        const std::uint64_t count = std::min(BATCH, range.end - first);
        runOnWorkers(stage.threads(plan.threads), count,
                     [&](int worker, std::size_t index)
                     {
                         const std::uint64_t unit = first + index;
                         try
                         {
                             if (!needed || stage.takeOver(unit) || !stage.hasWork(unit))
                                 ++takenOver;
                             else if (stage.keep(unit))
                                 ++kept;
                             else
                             {
                                 log.begin(unit);
                                 stage.run(worker, unit);
                                 ++built;
                             }
                         }
                         catch (const std::exception& error)
                         {
                             log.fail(unit, error.what());
                             throw;
                         }
                         log.done(unit);
                     });
        plan.forgetFacts();
    }
    result.built += built;
    result.takenOver += takenOver;
    result.kept += kept;
}

/// The same file, whatever the folder that a process runs in.
void makeAbsolute(std::string& file)
{
    const auto legends = readyLegends();
    if (file.empty() || file.rfind("/vsi", 0) == 0 ||
        std::find(legends.begin(), legends.end(), file) != legends.end())
        return;
    // What is no file is a name that GDAL alone understands.
    if (fs::exists(file)) file = fs::absolute(file).lexically_normal().string();
}

} // namespace

BuildEstimate planBuild(const BuildOptions& options)
{
    BuildOptions absolute = options;
    for (auto* files : {&absolute.dems, &absolute.imagery})
        std::for_each(files->begin(), files->end(), makeAbsolute);
    for (auto* file : {&absolute.landCover, &absolute.landCoverTable, &absolute.treeCover})
        makeAbsolute(*file);
    BuildPlan plan(absolute, BuildPlan::Workers::MANY_PROCESSES);
    TilePassResult result;
    const BuildStages stages = createStages(plan, result);
    if (!prepareFolder(plan).finished) PlanFile::write(plan, stages);
    return plan.estimate;
}

BuiltUnits buildUnits(const std::string& folder, const std::vector<std::string>& ranges, int threads,
                      int memoryMiB)
{
    BuiltUnits result;
    const fs::path root = fs::path(folder) / "terrain.osgb";
    // A process that was killed while it put files into their places, or one that comes too late.
    completeFolder(folder);
    if (fs::exists(root) && !fs::exists(PlanFile::file(folder)) &&
        !fs::exists(workFolderOf(folder) / ORIGIN_FILE))
    {
        std::error_code code;
        fs::remove_all(workFolderOf(folder), code);
        result.finished = true;
        return result;
    }
    PlanFile file = PlanFile::read(folder);
    std::vector<Range> parsed;
    for (const std::string& range : ranges)
        parsed.push_back(parseRange(file, range));
    if (threads > 0) file.options.threads = threads;
    if (memoryMiB > 0) file.options.memoryMiB = memoryMiB;
    BuildPlan plan(file.options, BuildPlan::Workers::MANY_PROCESSES);
    file.compare(plan);
    joinBuild(plan);
    const GdalCacheLimit cache(static_cast<GIntBig>(file.options.memoryMiB) * 1024 * 1024 / 4);
    TilePassResult tiles;
    const BuildStages stages = createStages(plan, tiles);
    for (const Range& range : parsed)
    {
        // Whether a stage is needed is known once those before it are done.
        for (std::size_t before = 0; before < range.stage; ++before)
            if (stages[before]->isNeeded())
                requireDone(folder, file.stages[before].first, file.stages[before].second);
        buildRange(plan, *stages[range.stage], range, result);
        if (range.stage + 1 == stages.size())
        {
            removeLeftovers(plan);
            result.finished = true;
            break;
        }
    }
    result.tilesKept = tiles.tilesKept;
    return result;
}

BuildStatus readBuildStatus(const std::string& folder)
{
    BuildStatus status;
    status.finished = fs::exists(fs::path(folder) / "terrain.osgb") &&
                      fs::exists(fs::path(folder) / ORIGIN_FILE) && !fs::exists(PlanFile::file(folder));
    if (status.finished) return status;
    const PlanFile plan = PlanFile::read(folder);
    status.logFolder = (workFolderOf(folder) / LOG_FOLDER).string();
    status.estimatedSeconds = plan.estimatedSeconds;
    for (const auto& [name, units] : plan.stages)
        status.stages.push_back(readUnitLogs(folder, name, units));
    return status;
}

} // namespace osgGeoFX
