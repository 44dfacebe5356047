// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/DatabaseBuilder.h>

#include <osgGeoFX/batch/detail/WorkQueue.h>
#include <osgGeoFX/paging/FilesByOthers.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/BuildStage.h>
#include <osgGeoFX/terrain/detail/DatabaseRoot.h>

#include <osg/ValueObject>
#include <osgDB/ReadFile>

#include <sys/resource.h>

#include <chrono>
#include <optional>
#include <string>

namespace osgGeoFX
{

namespace
{

/// Does all units of all stages, stage after stage.
void runStages(BuildPlan& plan, const BuildStages& stages)
{
    const std::optional<std::string> folder = FilesByOthers::Scope::folder();
    // Whether voids must be filled is known after the heights.
    std::vector<bool> counted;
    for (const auto& stage : stages)
    {
        counted.push_back(stage->isNeeded());
        if (counted.back()) plan.unitsTotal += stage->units();
    }
    for (std::size_t i = 0; i < stages.size(); ++i)
    {
        BuildStage& stage = *stages[i];
        if (!stage.isNeeded()) continue;
        for (std::size_t later = i; later < stages.size(); ++later)
            if (!counted[later] && stages[later]->isNeeded())
            {
                plan.unitsTotal += stages[later]->units();
                counted[later] = true;
            }
        stage.begin();
        runOnWorkers(stage.threads(plan.threads), stage.units(),
                     [&](int worker, std::size_t unit)
                     {
                         const FilesByOthers::Scope scope(folder);
                         if (!(plan.options.resume && stage.takeOver(unit)) && stage.hasWork(unit) &&
                             !stage.keep(unit))
                             stage.run(worker, unit);
                         plan.advance(stage.phase());
                     });
    }
}

} // namespace

BuildSummary buildDatabase(const BuildOptions& options, const BuildProgress& progress)
{
    const auto start = std::chrono::steady_clock::now();
    BuildPlan plan(options);
    plan.progress = progress;
    const GdalCacheLimit cache(static_cast<GIntBig>(options.memoryMiB) * 1024 * 1024 / 4);

    BuildSummary summary;
    summary.file = options.output + "/terrain.osgb";
    summary.levels = plan.scheme.finestLevel + 1;
    summary.samples = plan.estimate.samples;
    summary.heightUnits = plan.heightUnits;
    const FolderState state = prepareFolder(plan);
    summary.updated = state.update;
    summary.allBecause = state.allBecause;
    if (state.finished)
    {
        const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(summary.file);
        double tiles = 0.0;
        if (!root || !root->getUserValue("geofx.tiles", tiles))
            throw BuildError(summary.file +
                             ": the finished database cannot be read; build again without --resume.");
        summary.tiles = static_cast<std::uint64_t>(tiles);
        (options.resume ? summary.tilesReused : summary.tilesKept) = summary.tiles;
        root->getUserValue("geofx.minHeight", summary.lowestHeight);
        root->getUserValue("geofx.maxHeight", summary.highestHeight);
        root->getUserValue("geofx.filledShare", summary.filledShare);
        root->getUserValue("geofx.openShare", summary.openShare);
        summary.textures = readTextures(*root);
    }
    else
    {
        const std::string range = readText(keptFolderOf(options.output) / RANGE_FILE);
        TilePassResult result;
        runStages(plan, createStages(plan, result));
        completeFolder(options.output);
        if (state.update && result.tilesKept == 0 && state.allBecause.empty() && !plan.landCoverSource &&
            heightRange(plan) != range)
            summary.allBecause = "the range of heights has changed, from " + range + " to " +
                                 heightRange(plan) + ", and colors follow it";
        summary.tiles = result.tiles;
        summary.tilesReused = result.tilesReused;
        summary.tilesKept = result.tilesKept;
        summary.units = result.units;
        summary.unitsKept = result.unitsKept;
        summary.textures = result.textures.summary();
        summary.lowestHeight = static_cast<double>(plan.whole().minHeight);
        summary.highestHeight = static_cast<double>(plan.whole().maxHeight);
        summary.filledShare = filledShare(plan);
        summary.openShare = openShare(plan);
    }
    removeLeftovers(plan);

    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    summary.peakMemoryBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    summary.keptBytes = bytesBelow(keptFolderOf(options.output));
    summary.bytes = bytesBelow(options.output) - summary.keptBytes;
    summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return summary;
}

} // namespace osgGeoFX
