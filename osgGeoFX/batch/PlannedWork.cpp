// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/PlannedWork.h>

#include <osgGeoFX/batch/WholeFile.h>
#include <osgGeoFX/batch/WorkError.h>
#include <osgGeoFX/batch/detail/UnitLog.h>
#include <osgGeoFX/batch/detail/WorkQueue.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <optional>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// Units that are done between two pauses, at most.
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

std::size_t stageOf(const std::string& folder, const WorkStages& stages, const std::string& name)
{
    std::string names;
    for (std::size_t i = 0; i < stages.size(); ++i)
    {
        if (stages[i]->name() == name) return i;
        names += (i > 0 ? ", " : "") + stages[i]->name();
    }
    if (const auto number = numberOf(name); number && *number < stages.size())
        return static_cast<std::size_t>(*number);
    throw WorkError(WorkPlan::file(folder) + ": the plan has no stage \"" + name + "\"; it has " + names +
                    ".");
}

Range parseRange(const std::string& folder, const WorkStages& stages, const std::string& text)
{
    const std::size_t colon = text.find(':');
    Range range;
    range.stage = stageOf(folder, stages, text.substr(0, colon));
    const std::uint64_t units = stages[range.stage]->units();
    if (colon == std::string::npos) return {range.stage, 0, units};
    const std::string rest = text.substr(colon + 1);
    const std::size_t sign = rest.find_first_of("-/");
    const auto first = numberOf(rest.substr(0, sign));
    const auto second = sign == std::string::npos ? first : numberOf(rest.substr(sign + 1));
    if (!first || !second)
        throw WorkError("--unit " + text +
                        ": write it as STAGE:A-B, the units A to B, or as STAGE:I/N, the part I of N.");
    if (sign != std::string::npos && rest[sign] == '/')
    {
        if (*first >= *second || *second > 1000000000)
            throw WorkError("--unit " + text + ": parts are counted from 0, so of " +
                            std::to_string(*second) + " parts the last is " +
                            std::to_string(std::max<std::uint64_t>(*second, 1) - 1) + ".");
        range.first = units * *first / *second;
        range.end = units * (*first + 1) / *second;
        return range;
    }
    if (*first > *second || *second >= units)
        throw WorkError("--unit " + text + ": the stage " + stages[range.stage]->name() +
                        " has the units 0 to " + std::to_string(units - 1) + "; name the lower one first.");
    range.first = *first;
    range.end = *second + 1;
    return range;
}

/// Throws WorkError unless all units of a stage are done.
void requireDone(const std::string& folder, const std::string& stage, std::uint64_t units)
{
    if (fs::exists(stageDoneFile(folder, stage))) return;
    const StageAccount account = readUnitLogs(folder, {stage, units});
    if (account.status.done == units)
    {
        const std::string mark = stageDoneFile(folder, stage);
        if (const int error = writeWholeFile(mark, "", 0))
            throw WorkError(mark + ": cannot be written (" + std::generic_category().message(error) +
                            "); make the folder writable.");
        return;
    }
    std::string gaps;
    std::size_t count = 0;
    for (std::uint64_t unit = 0; unit < units;)
    {
        std::uint64_t end = unit;
        while (end < units && !account.done[end])
            ++end;
        if (end > unit && ++count <= NAMED_GAPS)
            gaps += " " + stage + ":" + std::to_string(unit) + "-" + std::to_string(end - 1);
        unit = end + 1;
    }
    throw WorkError(folder + ": of the stage " + stage + ", " + std::to_string(units - account.status.done) +
                    " of " + std::to_string(units) + " units are missing; build them first, with --unit" +
                    gaps + (count > NAMED_GAPS ? " and more." : "."));
}

void doRange(const std::string& folder, WorkStage& stage, const Range& range, const UnitOptions& options,
             BuiltUnits& result)
{
    const int threads = stage.threads(options.threads);
    UnitLog log(folder, stage.name(), threads);
    std::atomic<std::uint64_t> built{0}, takenOver{0}, kept{0};
    const bool needed = stage.isNeeded();
    if (needed) stage.begin();
    for (std::uint64_t first = range.first; first < range.end; first += BATCH)
    {
        const std::uint64_t count = std::min(BATCH, range.end - first);
        runOnWorkers(threads, count,
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
        if (options.pause) options.pause();
    }
    result.built += built;
    result.takenOver += takenOver;
    result.kept += kept;
}

} // namespace

std::string WorkPlan::workFolder(const std::string& folder)
{
    return (fs::path(folder) / "work").string();
}

std::string WorkPlan::file(const std::string& folder)
{
    return (fs::path(workFolder(folder)) / "plan.json").string();
}

bool WorkPlan::isIn(const std::string& folder)
{
    std::error_code code;
    return fs::exists(file(folder), code);
}

std::string WorkPlan::finishedFile(const std::string& folder)
{
    return (fs::path(folder) / "finished.json").string();
}

void WorkPlan::finish(const std::string& folder)
{
    std::error_code code;
    fs::rename(file(folder), finishedFile(folder), code);
    if (code && !fs::exists(finishedFile(folder)))
        throw WorkError(finishedFile(folder) + ": cannot be written (" + code.message() +
                        "); make the folder writable.");
    fs::remove_all(workFolder(folder), code);
    // What killed processes have left. It does no harm.
    std::vector<fs::path> leftovers;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code))
        if (entry->path().extension() == TEMPORARY_ENDING) leftovers.push_back(entry->path());
    for (const fs::path& path : leftovers)
        fs::remove(path, code);
}

WorkPlan WorkPlan::read(const std::string& folder)
{
    using nlohmann::json;
    const std::string path = file(folder);
    std::ifstream stream(path);
    if (!stream)
        throw WorkError(folder + ": no work is planned here; plan one with --plan " + folder +
                        ", of osggeofx_build, osggeofx_render or osggeofx_panorama.");
    try
    {
        const json document = json::parse(stream);
        WorkPlan plan;
        plan.program = document.value("program", plan.program);
        plan.estimatedSeconds = document.at("estimate").at("seconds").get<double>();
        for (const json& stage : document.at("stages"))
            plan.stages.push_back({stage.at("name").get<std::string>(),
                                   stage.at("units").get<std::uint64_t>(), stage.value("seconds", 0.0)});
        return plan;
    }
    catch (const json::exception& error)
    {
        throw WorkError(path + ": the plan is damaged (" + error.what() + "); plan anew with --plan.");
    }
}

BuiltUnits doUnits(const std::string& folder, const WorkStages& stages,
                   const std::vector<std::string>& ranges, const UnitOptions& options)
{
    std::vector<Range> parsed;
    for (const std::string& range : ranges)
        parsed.push_back(parseRange(folder, stages, range));
    BuiltUnits result;
    for (const Range& range : parsed)
    {
        // Whether a stage is needed is known once those before it are done.
        for (std::size_t before = 0; before < range.stage; ++before)
            if (stages[before]->isNeeded())
                requireDone(folder, stages[before]->name(), stages[before]->units());
        doRange(folder, *stages[range.stage], range, options, result);
        // A part may have no unit: then somebody else does the last one.
        const WorkStage& stage = *stages[range.stage];
        if (range.stage + 1 == stages.size() &&
            readUnitLogs(folder, {stage.name(), stage.units()}).status.done == stage.units())
        {
            result.finished = true;
            break;
        }
    }
    return result;
}

WorkStatus readWorkStatus(const std::string& folder)
{
    WorkStatus status;
    status.finished = !WorkPlan::isIn(folder) && fs::exists(WorkPlan::finishedFile(folder));
    if (status.finished) return status;
    const WorkPlan plan = WorkPlan::read(folder);
    status.program = plan.program;
    status.logFolder = (fs::path(WorkPlan::workFolder(folder)) / LOG_FOLDER).string();
    status.estimatedSeconds = plan.estimatedSeconds;
    for (const WorkPlan::Stage& stage : plan.stages)
        status.stages.push_back(readUnitLogs(folder, stage).status);
    return status;
}

std::vector<StageTimes> readWorkTimes(const std::string& folder)
{
    std::vector<StageTimes> times;
    for (const WorkPlan::Stage& stage : WorkPlan::read(folder).stages)
        times.push_back(readUnitLogs(folder, stage).times);
    return times;
}

} // namespace osgGeoFX
