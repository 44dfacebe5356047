// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/PlanFile.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/batch/PathText.h>
#include <osgGeoFX/batch/PlannedWork.h>
#include <osgGeoFX/geodata/BuildError.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace osgGeoFX
{

namespace
{

using nlohmann::json;

constexpr const char* FORMAT = "osgGeoFX build plan";

std::vector<std::string> mapped(std::vector<std::string> names, std::string (*map)(const std::string&))
{
    std::transform(names.begin(), names.end(), names.begin(), map);
    return names;
}

json optionsOf(const BuildOptions& o)
{
    json result = {{"dems", mapped(o.dems, &PathText::of)},
                   {"imagery", mapped(o.imagery, &PathText::of)},
                   {"stretch", nullptr},
                   {"landCover", PathText::of(o.landCover)},
                   {"landCoverTable", PathText::of(o.landCoverTable)},
                   {"treeCover", PathText::of(o.treeCover)},
                   {"allHeights", o.allHeights},
                   {"epsg", o.epsg},
                   {"vertical", static_cast<int>(o.vertical)},
                   {"voids", static_cast<int>(o.voids)},
                   {"voidReach", o.voidReach},
                   {"voidSmoothing", o.voidSmoothing},
                   {"treeLine", nullptr},
                   {"lakeArea", o.lakeArea},
                   {"tileSize", o.tileSize},
                   {"textureSize", o.textureSize},
                   {"pixelError", o.pixelError},
                   {"texelError", o.texelError},
                   {"anisotropy", o.anisotropy},
                   {"compressTextures", o.compressTextures},
                   {"pixelsPerRadian", o.pixelsPerRadian},
                   {"threads", o.threads},
                   {"memoryMiB", o.memoryMiB},
                   {"keep", o.keep}};
    if (o.stretch) result["stretch"] = *o.stretch;
    if (o.treeLine) result["treeLine"] = *o.treeLine;
    return result;
}

BuildOptions readOptions(const json& object)
{
    BuildOptions o;
    const auto take = [&](const char* name, auto& value)
    {
        object.at(name).get_to(value);
    };
    const auto takeKind = [&](const char* name, auto& value)
    {
        value = static_cast<std::decay_t<decltype(value)>>(object.at(name).get<int>());
    };
    take("dems", o.dems);
    take("imagery", o.imagery);
    if (!object.at("stretch").is_null()) o.stretch = object.at("stretch").get<std::pair<double, double>>();
    take("landCover", o.landCover);
    take("landCoverTable", o.landCoverTable);
    take("treeCover", o.treeCover);
    take("allHeights", o.allHeights);
    take("epsg", o.epsg);
    takeKind("vertical", o.vertical);
    takeKind("voids", o.voids);
    take("voidReach", o.voidReach);
    take("voidSmoothing", o.voidSmoothing);
    if (!object.at("treeLine").is_null()) o.treeLine = object.at("treeLine").get<double>();
    take("lakeArea", o.lakeArea);
    take("tileSize", o.tileSize);
    take("textureSize", o.textureSize);
    take("pixelError", o.pixelError);
    take("texelError", o.texelError);
    take("anisotropy", o.anisotropy);
    take("compressTextures", o.compressTextures);
    take("pixelsPerRadian", o.pixelsPerRadian);
    take("threads", o.threads);
    take("memoryMiB", o.memoryMiB);
    take("keep", o.keep);
    o.dems = mapped(o.dems, &PathText::path);
    o.imagery = mapped(o.imagery, &PathText::path);
    for (std::string* const name : {&o.landCover, &o.landCoverTable, &o.treeCover})
        *name = PathText::path(*name);
    return o;
}

json gridOf(const TilingScheme& scheme)
{
    return {{"west", scheme.west},
            {"south", scheme.south},
            {"east", scheme.east},
            {"north", scheme.north},
            {"columns", scheme.lastColumn},
            {"rows", scheme.lastRow},
            {"levels", scheme.finestLevel + 1},
            {"tileIntervals", scheme.intervals},
            {"textureIntervals", scheme.textureIntervals(scheme.finestLevel)}};
}

/// What the units of stages take, in those of the finest tiles, by the beginnings of the stages' names; measured on Oahu.
double shareOf(const std::string& stage)
{
    const std::pair<const char*, double> shares[] = {{"tiles-0", 1.0},  {"tiles-", 0.4},  {"heights-", 0.005},
                                                     {"ground", 0.007}, {"shores", 0.35}, {"", 0.02}};
    for (const auto& [beginning, share] : shares)
        if (stage.rfind(beginning, 0) == 0) return share;
    return 0.0;
}

std::vector<std::string> linesOf(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

} // namespace

void PlanFile::write(const BuildPlan& plan, const BuildStages& stages)
{
    json document = {{"format", FORMAT},
                     {"version", VERSION},
                     {"program", "osggeofx_build"},
                     {"options", optionsOf(plan.options)},
                     {"builtFrom", mapped(linesOf(plan.fingerprint), &PathText::of)},
                     {"grid", gridOf(plan.scheme)},
                     {"estimate",
                      {{"samples", plan.estimate.samples},
                       {"tiles", plan.estimate.tiles},
                       {"bytes", plan.estimate.bytes},
                       {"workBytes", plan.estimate.workBytes},
                       {"seconds", plan.estimate.seconds}}},
                     {"stages", json::array()}};
    double shares = 0.0;
    for (const auto& stage : stages)
        shares += shareOf(stage->name()) * static_cast<double>(stage->units());
    // The estimate is for all cores of a machine.
    const double share =
        plan.estimate.seconds * (plan.options.threads > 0 ? plan.options.threads : coreCount()) / shares;
    for (const auto& stage : stages)
        document["stages"].push_back(
            {{"name", stage->name()},
             {"units", stage->units()},
             {"seconds", share * shareOf(stage->name()) * static_cast<double>(stage->units())}});
    const std::string text = document.dump(2) + "\n";
    writeFileAtomically(file(plan.options.output), text.data(), text.size());
}

std::string PlanFile::file(const std::string& folder)
{
    return WorkPlan::file(folder);
}

PlanFile PlanFile::read(const std::string& folder)
{
    const std::string path = file(folder);
    std::ifstream stream(path);
    if (!stream)
        throw BuildError(folder + ": no build is planned here; plan one with osggeofx_build … --plan " +
                         folder + ".");
    try
    {
        const json document = json::parse(stream);
        if (document.at("format").get<std::string>() != FORMAT)
            throw BuildError(path + ": this is no plan of a build; plan anew with --plan.");
        const int version = document.at("version").get<int>();
        if (version != VERSION)
            throw BuildError(path + ": the plan has version " + std::to_string(version) +
                             ", but this program reads version " + std::to_string(VERSION) +
                             "; use the program that has made it, or plan anew with --plan.");
        PlanFile result;
        result.options = readOptions(document.at("options"));
        result.options.output = folder;
        for (const json& line : document.at("builtFrom"))
            result.fingerprint += PathText::path(line.get<std::string>()) + "\n";
        return result;
    }
    catch (const json::exception& error)
    {
        throw BuildError(path + ": the plan is damaged (" + error.what() + "); plan anew with --plan.");
    }
}

void PlanFile::compare(const BuildPlan& now) const
{
    if (now.fingerprint == fingerprint) return;
    const std::vector<std::string> planned = linesOf(fingerprint);
    std::string changed = "the number of its sources or options";
    for (const std::string& line : linesOf(now.fingerprint))
        if (std::find(planned.begin(), planned.end(), line) == planned.end())
        {
            changed = line;
            break;
        }
    throw BuildError(file(options.output) + ": the plan was made from something else than there is now (" +
                     changed + "); put back what was changed, or plan anew with --plan.");
}

} // namespace osgGeoFX
