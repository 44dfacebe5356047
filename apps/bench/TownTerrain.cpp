// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TownTerrain.h"

#include "BenchError.h"
#include "ChildProcess.h"
#include "OahuSource.h"
#include "TerrainSuite.h"
#include "WorkFolder.h"

#include <osg/Node>
#include <osg/ValueObject>
#include <osgDB/ReadFile>

#include <cstdint>
#include <string>
#include <vector>

namespace geofx::bench
{

namespace
{

/// Of the picture and the database together, with a margin.
constexpr std::uint64_t DISK_BYTES = 2500000000;

bool hasTown(const std::filesystem::path& terrain)
{
    const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(terrain.string());
    double buildings = 0.0;
    return root && root->getUserValue("geofx.buildings", buildings) && buildings > 0.0;
}

} // namespace

std::filesystem::path townToDraw(const Settings& settings, const std::filesystem::path& folder)
{
    if (!settings.terrain.empty() && hasTown(settings.terrain)) return settings.terrain;
    if (settings.inventor.empty())
        throw BenchError(
            "There is no geofx_invent beside this program, which makes up a town; build it (it is one of "
            "the tests' tools), or name a database with a town with --terrain FILE.");
    if (!settings.smoke) requireSpace(folder, DISK_BYTES);
    const std::filesystem::path oahu = settings.data / "oahu", town = folder / "town.gpkg",
                                aerial = folder / "aerial.tif", database = folder / "town";
    std::filesystem::path elevation = oahu / "elevation.tif";
    if (settings.smoke)
    {
        elevation = folder / "elevation.vrt";
        writeResampledOahu(oahu / "elevation.tif", 128, elevation);
    }
    announce("making up a town, and an aerial picture of it");
    runChild({settings.inventor.string(), "town", town.string(), settings.smoke ? "400" : "16000"});
    runChild({settings.inventor.string(), "aerial", aerial.string(), settings.smoke ? "512" : "12960"});
    announce("building the terrain with the town");
    std::vector<std::string> command = builderCommand(settings, elevation, database, 2);
    command.insert(command.end(), {"--landcover", (oahu / "landcover.tif").string(), "--landcover-table",
                                   (oahu / "landcover.csv").string(), "--imagery", aerial.string(),
                                   "--buildings", town.string()});
    runChild(command);
    std::filesystem::remove(aerial);
    return database / "terrain.osgb";
}

} // namespace geofx::bench
