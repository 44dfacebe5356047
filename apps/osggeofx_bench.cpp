// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_bench: each figure that is asked of osgGeoFX beside the one measured.
#include "bench/BenchError.h"
#include "bench/Interruption.h"
#include "bench/Report.h"
#include "process/CommandLine.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/paging/FreedMemory.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace
{

using geofx::bench::BenchError;
namespace fs = std::filesystem;

fs::path programFolder()
{
    return fs::read_symlink("/proc/self/exe").parent_path();
}

/// The data of an installed osgGeoFX, or that of the sources which this program was built from.
fs::path defaultData()
{
    const fs::path installed = programFolder() / ".." / GEOFX_INSTALLED_DATA;
    return fs::exists(installed) ? installed.lexically_normal() : fs::path(GEOFX_SOURCE_DATA);
}

/// A program that lies beside this one; empty if there is none.
fs::path sibling(const std::string& name)
{
    const fs::path path = programFolder() / name;
    return fs::exists(path) ? path : fs::path();
}

void complete(fs::path& path)
{
    if (!path.empty()) path = fs::absolute(path).lexically_normal();
}

void checkGroups(const std::vector<std::string>& only, const std::vector<std::string>& names)
{
    for (const std::string& group : only)
    {
        const bool known =
            std::any_of(names.begin(), names.end(),
                        [&](const std::string& name)
                        {
                            const auto& groups = geofx::bench::findSuite(name)->groups;
                            return std::find(groups.begin(), groups.end(), group) != groups.end();
                        });
        if (!known) throw BenchError("--only " + group + ": no suite has such figures; --list names them.");
    }
}

void list()
{
    for (const auto& suite : geofx::bench::suites())
    {
        std::cout << suite.name << ": " << suite.summary << "\n  figures:";
        for (const std::string& group : suite.groups)
            std::cout << " " << group;
        std::cout << std::endl;
    }
}

int run(const std::vector<std::string>& names, const std::string& jsonFile, bool check,
        geofx::bench::Settings settings)
{
    if (names.empty()) throw BenchError("No suite is named; name one with --suite NAME (--list shows them).");
    for (const std::string& name : names)
    {
        if (!geofx::bench::findSuite(name))
            throw BenchError("--suite " + name + ": there is none; --list shows them.");
    }
    checkGroups(settings.only, names);
    for (fs::path* path : {&settings.builder, &settings.inventor, &settings.data, &settings.work,
                           &settings.terrain, &settings.pictures, &settings.osgEarth, &settings.fuji})
        complete(*path);
    if (!settings.pictures.empty()) fs::create_directories(settings.pictures);

    std::ofstream json;
    if (!jsonFile.empty())
    {
        osgGeoFX::InputFiles inputs;
        for (const fs::path& path : {settings.terrain, settings.fuji, settings.builder, settings.inventor,
                                     settings.data / "oahu", settings.osgEarth})
            inputs.add(path.string());
        inputs.claim("The file of figures", jsonFile, "--json");
        // Now rather than after minutes of measuring.
        json.open(jsonFile);
        if (!json)
            throw BenchError(jsonFile +
                             ": it cannot be written; name a file in a folder that can be written.");
    }

    const geofx::bench::Interruption interruption;
    std::vector<geofx::bench::SuiteResult> results;
    for (const std::string& name : names)
        results.push_back({name, geofx::bench::findSuite(name)->run(settings)});
    // Last, because drivers are large, and what is large counts into a child's memory.
    const geofx::bench::Machine machine = geofx::bench::Machine::describe();
    geofx::bench::printTable(std::cout, machine, results);
    if (json.is_open())
    {
        json << geofx::bench::toJson(machine, settings, results).dump(2) << std::endl;
        if (!json) throw BenchError(jsonFile + ": it cannot be written; is the disk full?");
    }
    return check && !geofx::bench::allReached(results) ? 1 : 0;
}

} // namespace

int main(int argc, char** argv)
{
    const osgGeoFX::FreedMemory freed;
    geofx::bench::Settings settings;
    std::vector<std::string> names;
    std::string json;
    bool check = false, listOnly = false;

    CLI::App app{"Measures what is asked of osgGeoFX and prints each figure asked beside the one measured",
                 "osggeofx_bench"};
    app.add_option("--suite", names, "The suites to run")->type_name("NAME…");
    app.add_flag("--list", listOnly, "List the suites and their figures");
    app.add_option("--only", settings.only, "Only these figures of the suites")->type_name("NAME…");
    app.add_option("--json", json, "Write the figures to this file too")->type_name("FILE");
    app.add_flag("--check", check, "Exit with 1 if a figure falls short");
    app.add_flag("--quick", settings.quick, "Smaller cases where the full one takes minutes");
    app.add_flag("--smoke", settings.smoke, "Tiny cases, which only show that this program works");
    app.add_option("--terrain", settings.terrain,
                   "Draw this database instead of building one; it must cover Oahu")
        ->type_name("DIR/terrain.osgb");
    app.add_option("--osgearth", settings.osgEarth, "Where osgEarth is installed, for the suite osgearth")
        ->type_name("DIR");
    app.add_option("--fuji", settings.fuji, "An elevation raster of Mount Fuji, for the suite osgearth")
        ->type_name("FILE");
    app.add_option("--builder", settings.builder, "osggeofx_build; the default lies beside this program")
        ->type_name("FILE");
    app.add_option("--inventor", settings.inventor,
                   "geofx_invent, which makes up a town; the default lies beside this program")
        ->type_name("FILE");
    app.add_option("--data", settings.data, "The data folder, which has the folder oahu")->type_name("DIR");
    app.add_option("--work", settings.work,
                   "Where temporary files are made (a full run needs 7 GB for a while)")
        ->type_name("DIR");
    app.add_option("--pictures", settings.pictures, "Write what was drawn into this folder, to look at")
        ->type_name("DIR");
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return geofx::exitCodeOf(app, error);
    }

    try
    {
        if (settings.builder.empty()) settings.builder = sibling("osggeofx_build");
        if (settings.inventor.empty()) settings.inventor = sibling("geofx_invent");
        if (settings.data.empty()) settings.data = defaultData();
        if (settings.work.empty()) settings.work = fs::temp_directory_path();
        if (listOnly)
        {
            list();
            return 0;
        }
        return run(names, json, check, settings);
    }
    catch (const std::exception& error)
    {
        std::cerr << "osggeofx_bench: " << error.what() << std::endl;
        return 2;
    }
}
