// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "OahuTerrain.h"

#include "ChildProcess.h"
#include "OahuSource.h"
#include "TerrainSuite.h"

namespace geofx::bench
{

std::filesystem::path terrainToDraw(const Settings& settings, const WorkFolder& folder)
{
    if (!settings.terrain.empty()) return settings.terrain;
    const std::filesystem::path oahu = settings.data / "oahu";
    std::vector<std::string> command =
        builderCommand(settings, oahu / "elevation.tif", folder.path() / "oahu", 2);
    command.insert(command.end(), {"--landcover", (oahu / "landcover.tif").string(), "--landcover-table",
                                   (oahu / "landcover.csv").string()});
    announce("building the terrain to draw");
    runChild(command);
    return folder.path() / "oahu" / "terrain.osgb";
}

std::filesystem::path windowToDraw(const Settings& settings, const std::filesystem::path& folder,
                                   double pixelsPerRadian)
{
    if (!settings.terrain.empty()) return settings.terrain;
    const int samples = settings.smoke ? 256 : 1621;
    const std::filesystem::path oahu = settings.data / "oahu", source = folder / "window.vrt";
    writeWindowOfOahu(oahu / "elevation.tif", samples, source);
    std::vector<std::string> command = builderCommand(settings, source, folder / "window", 2);
    command.insert(command.end(), {"--landcover", (oahu / "landcover.tif").string(), "--landcover-table",
                                   (oahu / "landcover.csv").string(), "--pixels-per-radian",
                                   std::to_string(pixelsPerRadian)});
    announce("building the terrain to draw");
    runChild(command);
    return folder / "window" / "terrain.osgb";
}

} // namespace geofx::bench
