// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_build: rasters to a paged terrain database, and buildings into it.
#include "process/CommandLine.h"

#include <osgGeoFX/raster/RasterBands.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/terrain/DistributedBuild.h>
#include <osgGeoFX/terrain/ProgressLine.h>
#include <osgGeoFX/town/TownBuilder.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace
{

/// Does units of a planned build.
void work(const std::string& folder, const std::vector<std::string>& units, int threads, int memoryMiB,
          bool quiet)
{
    const osgGeoFX::BuiltDatabaseUnits built = osgGeoFX::buildUnits(folder, units, threads, memoryMiB);
    if (quiet) return;
    std::printf("%s: %llu units are built, %llu were done or had nothing to do.\n", folder.c_str(),
                static_cast<unsigned long long>(built.built),
                static_cast<unsigned long long>(built.takenOver + built.kept));
    if (built.kept > 0 || built.tilesKept > 0)
        std::printf("Update: %llu units and %llu tiles stay as they were.\n",
                    static_cast<unsigned long long>(built.kept),
                    static_cast<unsigned long long>(built.tilesKept));
    if (built.finished) std::printf("%s/terrain.osgb: the database is finished.\n", folder.c_str());
}

/// Puts buildings into the finished database.
void buildTown(const osgGeoFX::TownOptions& options, bool quiet)
{
    osgGeoFX::ProgressLine line("osggeofx_build");
    const auto summary = osgGeoFX::buildTown(options, quiet ? osgGeoFX::TownProgress() : std::ref(line));
    if (!quiet) std::printf("%s/buildings: %s", options.database.c_str(), summary.text().c_str());
}

/// What an update has done, and what the next one will find.
void tellUpdate(const osgGeoFX::BuildSummary& summary, const std::string& folder)
{
    const auto count = [](std::uint64_t value)
    {
        return static_cast<unsigned long long>(value);
    };
    if (!summary.allBecause.empty())
        std::printf("Update: all tiles were built, since %s.\n", summary.allBecause.c_str());
    else if (summary.updated)
        std::printf("Update: %llu tiles were built and %llu kept; %llu of %llu units had nothing to do.\n",
                    count(summary.tiles - summary.tilesKept - summary.tilesReused), count(summary.tilesKept),
                    count(summary.unitsKept), count(summary.units));
    else if (summary.tilesKept > 0)
        std::printf("Nothing has changed since this database was built.\n");
    if (summary.keptBytes > 0)
        std::printf("Kept for updates: %.1f MB in %s/kept.\n", static_cast<double>(summary.keptBytes) * 1e-6,
                    folder.c_str());
}

} // namespace

int main(int argc, char** argv)
{
    osgGeoFX::BuildOptions options;
    osgGeoFX::TownOptions town;
    std::string plan, workFolder, stretch;
    std::vector<std::string> units;
    bool geocentric = false, quiet = false, estimate = false, anew = false, keepNothing = false;
    std::string srs;

    CLI::App app{"Builds a paged terrain database from rasters. Plain osgviewer reads the result: osgviewer "
                 "DIR/terrain.osgb",
                 "osggeofx_build"};
    app.add_option("--dem", options.dems,
                   "Elevation rasters; where several overlap, the later one wins, so name coarse ones first. "
                   "Tiles are as "
                   "deep as the densest raster that touches them. Voids of a later one show those before it")
        ->type_name("FILE…");
    app.add_option("--imagery", options.imagery, "Color rasters for the surface; the later one wins")
        ->type_name("FILE…");
    app.add_option(
           "--stretch", stretch,
           "The numbers of the imagery that become black and white (default: bytes stay as they are; of "
           "larger numbers 2 to 98 % are shown, or the whole range where they fill half of it)")
        ->type_name("LOW,HIGH");
    app.add_option("--landcover,--land-cover", options.landCover,
                   "Raster of land-cover classes, one byte for each pixel")
        ->type_name("FILE");
    app.add_option("--landcover-table,--land-cover-table", options.landCoverTable,
                   "Its classes: value,class,name,red,green,blue and, where wanted, trees,town,bare,water; "
                   "or a ready "
                   "legend: worldcover, corine, nlcd, flightgear. Without imagery they color the surface")
        ->type_name("CSV|NAME");
    app.add_option("--tree-cover", options.treeCover,
                   "Raster of the ground's share under trees, percent; in place of the land cover's")
        ->type_name("FILE");
    app.add_option("--buildings", town.buildings,
                   "Polygons of buildings with heights, in any CRS: walls and roofs on the terrain, with "
                   "levels of detail. "
                   "Without --dem, for the database that is in the folder")
        ->type_name("FILE");
    auto* buildings = app.get_option("--buildings");
    app.add_option("--buildings-layer", town.layer, "Its layer; all layers of polygons without it")
        ->needs(buildings)
        ->type_name("NAME");
    app.add_option(
           "--height-field", town.heightField,
           "Its field of heights, from the ground to the top of the roof; without it one of the usual names, "
           "or storeys, or a guess by area")
        ->needs(buildings)
        ->type_name("NAME");
    app.add_option("--roof-field", town.roofField, "Its field of roofs' shapes: gabled, pitched, flat …")
        ->needs(buildings)
        ->type_name("NAME");
    const std::map<std::string, osgGeoFX::HeightUnit> heightUnits{{"m", osgGeoFX::HeightUnit::METRES},
                                                                  {"ft", osgGeoFX::HeightUnit::FEET}};
    app.add_option("--height-unit", town.unit,
                   "The unit of heights that do not say theirs: m (the default) or ft")
        ->needs(buildings)
        ->transform(CLI::CheckedTransformer(heightUnits).description("m|ft"));
    app.add_flag("!--no-ambient-occlusion", town.ambientOcclusion,
                 "Without it, walls and roofs are darker where neighbours, courtyards or the ground shut "
                 "them in, and "
                 "the ground around buildings")
        ->needs(buildings);
    auto* globe =
        app.add_flag("--geocentric", geocentric, "Curved, in geocentric WGS 84 coordinates (the default)");
    app.add_option("--srs", srs, "Flat, in a projected CRS: EPSG:N")->excludes(globe)->type_name("EPSG:N");
    const std::map<std::string, osgGeoFX::VerticalDatum> datums{
        {"none", osgGeoFX::VerticalDatum::None},
        {"ellipsoid", osgGeoFX::VerticalDatum::Ellipsoid},
        {"egm96", osgGeoFX::VerticalDatum::Egm96}};
    app.add_option(
           "--vertical", options.vertical,
           "What the heights are measured from: the ellipsoid, the EGM96 geoid (they are then moved to the "
           "ellipsoid), or none: used as they are (the default)")
        ->transform(CLI::CheckedTransformer(datums).description("ellipsoid|egm96|none"));
    app.add_option(
        "--tree-line", options.treeLine,
        "Height up to which trees are likely where no raster tells, metres; without it by latitude: 3800 up "
        "to 25°, down to 0 at 70°");
    app.add_option_function<double>(
        "--lake-area", [&](double area) { options.lakeArea = 1e6 * area; },
        "Least area of level ground that is taken for a lake where no land cover tells, km² (0.2)");
    const std::map<std::string, osgGeoFX::Voids> voids{{"fill", osgGeoFX::Voids::FILL},
                                                       {"keep", osgGeoFX::Voids::KEEP}};
    app.add_option(
           "--voids", options.voids,
           "What becomes of places inside the elevation that have none: fill them from what lies around "
           "them (the default), or keep them as holes")
        ->transform(CLI::CheckedTransformer(voids).description("fill|keep"));
    app.add_flag(
        "--all-heights", options.allHeights,
        "Take all values of the elevation as heights. Without it, those that plainly are none count as "
        "missing: a single "
        "value far from all others (-9999), one all around turned data, heights beyond -12000 and 9500 m");
    app.add_option("--void-reach", options.voidReach,
                   "How far from the data voids are filled, samples, 1 to 500; larger ones stay")
        ->capture_default_str();
    app.add_option("--void-smoothing", options.voidSmoothing,
                   "How often filled heights are smoothed, 0 to 100 times")
        ->capture_default_str();
    app.add_option("--tile-size", options.tileSize, "Grid intervals along a tile's edge, at most")
        ->capture_default_str();
    app.add_option("--texture-size", options.textureSize,
                   "Texture intervals along a tile's edge, at most; 0 for four times the tile size in finest "
                   "tiles, twice in others")
        ->capture_default_str();
    app.add_option("--pixel-error", options.pixelError, "Largest error of the relief on the screen, pixels")
        ->capture_default_str();
    app.add_option("--anisotropy", options.anisotropy,
                   "Anisotropic filtering of the colors, 1 to 16; 0 for 4 with imagery and 1 without")
        ->capture_default_str();
    app.add_flag("--compress-textures", options.compressTextures,
                 "Colors in BC1 and normals in BC5: a fraction of the memory on the GPU; sizes and errors "
                 "are printed");
    app.add_option("--texel-error", options.texelError, "Largest texel on the screen where it shows, pixels")
        ->capture_default_str();
    app.add_option("--pixels-per-radian", options.pixelsPerRadian,
                   "The screen for which the errors hold; the default is osgviewer's view on 1080 lines")
        ->capture_default_str();
    auto* memory =
        app.add_option("--memory", options.memoryMiB, "Memory for the data, MiB")->capture_default_str();
    app.add_option("--threads", options.threads, "Worker threads; 0 for one for each core")
        ->capture_default_str();
    auto* resume =
        app.add_flag("--resume", options.resume, "Continue a build or an update that was interrupted");
    app.add_flag(
           "--anew", anew,
           "Remove the database that is in the folder first. Without it, it is updated: only tiles that "
           "other sources or options change are built, with the same result")
        ->excludes(resume);
    app.add_flag("--keep-nothing", keepNothing,
                 "Save disk space: leave nothing for later updates, which will have to build everything");
    app.add_flag("--estimate", estimate, "Say what the build would take, and build nothing");
    app.add_flag("--quiet", quiet, "No progress and no summary");
    auto* output = app.add_option("-o,--output", options.output, "Folder of the database")->type_name("DIR");
    auto* planOption =
        app.add_option("--plan", plan,
                       "Build nothing yet: plan the database in DIR, for many processes with --work")
            ->excludes(output)
            ->type_name("DIR");
    auto* workOption = app.add_option("--work", workFolder, "Do units of the plan in DIR; needs --unit")
                           ->excludes(output)
                           ->excludes(planOption)
                           ->type_name("DIR");
    app.add_option("--unit", units,
                   "With --work: units A to B of a stage of the plan, or the part I, from 0, of N parts")
        ->needs(workOption)
        ->type_name("STAGE:A-B|STAGE:I/N…");
    try
    {
        app.parse(argc, argv);
        if (workFolder.empty() && options.dems.empty() && town.buildings.empty())
            throw CLI::RequiredError("--dem");
        if (!town.buildings.empty() && (!workFolder.empty() || !plan.empty()))
            throw CLI::ValidationError(
                "--buildings", "a town is not planned for many processes; build the terrain first, then "
                               "call osggeofx_build --buildings FILE -o DIR.");
        if (workFolder.empty() && plan.empty() && options.output.empty())
            throw CLI::RequiredError("--output");
        if (!workFolder.empty() && units.empty()) throw CLI::RequiredError("--unit");
        if (!workFolder.empty() && !options.dems.empty()) throw CLI::ExcludesError("--work", "--dem");
    }
    catch (const CLI::ParseError& error)
    {
        return geofx::exitCodeOf(app, error);
    }

    try
    {
        if (!srs.empty())
        {
            const std::string number = srs.rfind("EPSG:", 0) == 0 ? srs.substr(5) : srs;
            if (number.empty() || number.size() > 9 ||
                number.find_first_not_of("0123456789") != std::string::npos)
                throw osgGeoFX::BuildError("--srs " + srs +
                                           ": write it as EPSG: and a number, such as EPSG:32604.");
            options.epsg = std::stoi(number);
        }
        if (!stretch.empty())
        {
            osgGeoFX::RasterBands bands;
            if (!bands.setRange(stretch))
                throw osgGeoFX::BuildError("--stretch: \"" + stretch +
                                           "\" is not LOW,HIGH; write two different numbers with a comma "
                                           "between them.");
            if (options.imagery.empty())
                throw osgGeoFX::BuildError("--stretch is for imagery; give some with --imagery.");
            options.stretch = bands.channels[0].range;
        }
        if (!workFolder.empty())
        {
            work(workFolder, units, options.threads, memory->count() > 0 ? options.memoryMiB : 0, quiet);
            return 0;
        }
        town.database = options.output;
        town.threads = options.threads;
        if (options.dems.empty())
        {
            if (estimate)
                throw osgGeoFX::BuildError(
                    "--estimate: only a terrain is estimated; leave it out, or give --dem.");
            buildTown(town, quiet);
            return 0;
        }
        options.update = !anew;
        options.keep = !keepNothing;
        if (!plan.empty())
        {
            options.output = plan;
            const auto planned = osgGeoFX::planBuild(options);
            if (!quiet && osgGeoFX::readBuildStatus(plan).finished)
                std::printf("%s/terrain.osgb: nothing has changed since this database was built; nothing is "
                            "planned.\n",
                            plan.c_str());
            else if (!quiet)
                std::printf("%s: planned: %s.\n", plan.c_str(), planned.text().c_str());
            return 0;
        }
        if (!quiet || estimate)
        {
            std::printf("osggeofx_build: %s.\n", osgGeoFX::estimateBuild(options).text().c_str());
            std::fflush(stdout);
        }
        if (estimate) return 0;
        osgGeoFX::ProgressLine line("osggeofx_build");
        const auto summary =
            osgGeoFX::buildDatabase(options, quiet ? osgGeoFX::BuildProgress() : std::ref(line));
        if (!quiet)
        {
            std::printf(
                "%s: %llu tiles (%llu taken over), %d levels, %.3f million samples, %.1f MB, %.1f s, peak "
                "memory %.0f MiB\n",
                summary.file.c_str(), static_cast<unsigned long long>(summary.tiles),
                static_cast<unsigned long long>(summary.tilesReused), summary.levels,
                static_cast<double>(summary.samples) * 1e-6, static_cast<double>(summary.bytes) * 1e-6,
                summary.seconds, static_cast<double>(summary.peakMemoryBytes) / (1024.0 * 1024.0));
            std::printf("Heights: %.1f to %.1f m; %s.\n", summary.lowestHeight, summary.highestHeight,
                        summary.heightUnits.c_str());
            tellUpdate(summary, options.output);
            if (options.compressTextures) std::printf("%s", summary.textures.text().c_str());
            if (summary.filledShare > 0.0)
                std::printf("Voids: %.3g %% of the heights are filled from those around them.\n",
                            100.0 * summary.filledShare);
            if (summary.openShare > 0.0)
                std::printf("Without heights: %.3g %% of the samples lie in gaps that are too large to be "
                            "filled, or at the "
                            "data's edge.\n",
                            100.0 * summary.openShare);
        }
        if (!town.buildings.empty())
            buildTown(town, quiet);
        else if (osgGeoFX::removeStrayTown(options.output) && !quiet)
            std::printf(
                "%s/buildings: the town was removed, since the terrain has changed; build it again with "
                "--buildings.\n",
                options.output.c_str());
        return 0;
    }
    catch (const std::exception& error)
    {
        std::cerr << "osggeofx_build: " << error.what() << std::endl;
        return 2;
    }
}
