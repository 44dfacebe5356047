// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/DistributedBuild.h>

#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/PlanFile.h>
#include <osgGeoFX/terrain/detail/TilePass.h>

#include <algorithm>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// The same file, whatever the folder that a process runs in.
void makeAbsolute(std::string& name)
{
    const auto [file, variable] = RasterFile::parse(name);
    const auto legends = readyLegends();
    if (file.empty() || file.rfind("/vsi", 0) == 0 ||
        std::find(legends.begin(), legends.end(), file) != legends.end())
        return;
    // What is no file is a name that GDAL alone understands.
    if (fs::exists(file))
        name = fs::absolute(file).lexically_normal().string() + (variable.empty() ? "" : ":" + variable);
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

BuiltDatabaseUnits buildUnits(const std::string& folder, const std::vector<std::string>& ranges, int threads,
                              int memoryMiB)
{
    BuiltDatabaseUnits result;
    // Workers share the folder. Whoever plans or builds alone must wait for them.
    const std::shared_ptr<const FolderLock> lock = lockFolder(folder, FolderLock::TOGETHER);
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
    if (threads > 0) file.options.threads = threads;
    if (memoryMiB > 0) file.options.memoryMiB = memoryMiB;
    BuildPlan plan(file.options, BuildPlan::Workers::MANY_PROCESSES);
    file.compare(plan);
    joinBuild(plan);
    const GdalCacheLimit cache(static_cast<GIntBig>(file.options.memoryMiB) * 1024 * 1024 / 4);
    TilePassResult tiles;
    const BuildStages stages = createStages(plan, tiles);
    UnitOptions how;
    how.threads = plan.threads;
    // Facts that are kept in memory.
    how.pause = [&]
    {
        plan.forgetFacts();
    };
    static_cast<BuiltUnits&>(result) = sayAsBuildError([&] { return doUnits(folder, stages, ranges, how); });
    if (result.finished)
    {
        // Not before, since the accounts of units are work files.
        completeFolder(folder);
        removeLeftovers(plan);
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
    return sayAsBuildError([&] { return readWorkStatus(folder); });
}

} // namespace osgGeoFX
