// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TerrainSuite.h"

#include "BenchError.h"
#include "WorkFolder.h"

namespace geofx::bench
{

namespace
{

std::vector<Figure> run(const Settings& settings)
{
    const WorkFolder folder(settings.work);
    // Building comes first: while we are small, a child's peak memory is its own.
    std::vector<Figure> figures = measureBuilding(settings, folder.path());
    for (const Figure& figure : measureDrawing(settings, folder.path()))
        figures.push_back(figure);
    return figures;
}

} // namespace

Suite terrainSuite()
{
    return {"terrain",
            "Builds large terrains (memory, linearity, threads) and draws one, paged and as a single mesh "
            "(drawing)",
            {"memory", "linearity", "threads", "drawing"},
            run};
}

std::vector<std::string> builderCommand(const Settings& settings, const std::filesystem::path& dem,
                                        const std::filesystem::path& output, int threads, int memoryMiB)
{
    if (settings.builder.empty())
        throw BenchError(
            "The program osggeofx_build was not found beside osggeofx_bench; name it with --builder FILE, "
            "or measure a database that is there with --only drawing --terrain DIR/terrain.osgb.");
    return {settings.builder.string(),
            "--dem",
            dem.string(),
            "--memory",
            std::to_string(memoryMiB),
            "--threads",
            std::to_string(threads),
            "--output",
            output.string()};
}

} // namespace geofx::bench
