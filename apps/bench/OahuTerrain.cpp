// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "OahuTerrain.h"

#include "ChildProcess.h"
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

} // namespace geofx::bench
