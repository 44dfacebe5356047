// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "panorama/Recipe.h"

#include "names/SceneNames.h"

#include <osgGeoFX/batch/PathText.h>
#include <osgGeoFX/batch/WholeFile.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <set>

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using osgGeoFX::PathText;

namespace geofx::panorama
{

namespace
{

constexpr int newestFormat = 1;
/// The value of a recipe that other files do not have.
constexpr const char* formatName = "osggeofx_panorama";

/// A path, or FILE:LAYER, as a file in `folder` names it (PathText), and back. Addresses and GDAL's own file systems stay as they are.
std::string relativePath(const std::string& path, const fs::path& folder)
{
    const auto [file, layer] = names::fileAndLayer(path);
    std::error_code fault;
    if (file.empty() || !fs::exists(file, fault)) return PathText::of(path);
    const fs::path result = fs::relative(file, folder, fault);
    return PathText::of((fault || result.empty() ? fs::absolute(file).string() : result.string()) +
                        (layer.empty() ? "" : ":" + layer));
}

std::string pathFrom(const std::string& text, const fs::path& folder)
{
    const std::string path = PathText::path(text);
    if (path.empty() || fs::path(path).is_absolute()) return path;
    std::error_code fault;
    const std::string beside = (folder / path).string();
    return fs::exists(names::fileAndLayer(beside).first, fault) ? beside : path;
}

fs::path folderOf(const std::string& file)
{
    const fs::path folder = fs::path(file).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// The composition's values by name, in the order of the file.
template<class View, class Action>
void forValues(View& view, const Action& action)
{
    action("viewRadius", view.viewRadius);
    action("horizonLine", view.horizonLine);
    action("curveDistance", view.curveDistance);
    action("horizonDistance", view.horizonDistance);
    action("horizonBend", view.horizonBend);
    action("exaggeration", view.exaggeration);
    action("baseHeight", view.baseHeight);
    action("edgeWidth", view.edgeWidth);
    action("horizontalAngle", view.horizontalAngle);
}

} // namespace

bool Recipe::isRecipe(const std::string& file)
{
    return fs::path(file).extension() == ".json";
}

bool Recipe::isIn(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    const Json json = Json::parse(stream, nullptr, false);
    return json.is_object() && json.contains(formatName);
}

bool Recipe::isTerrain(const std::string& file)
{
    static const std::set<std::string> extensions = {".osgb", ".osgt",  ".osgx", ".osg",
                                                     ".ive",  ".geofx", ".earth"};
    return extensions.count(fs::path(file).extension().string()) > 0;
}

Recipe Recipe::read(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw Failure(file + ": cannot be opened; check the path.");
    Recipe recipe;
    const fs::path folder = folderOf(file);
    try
    {
        Json json;
        stream >> json;
        if (json.at(formatName).get<int>() != newestFormat)
            throw Failure(
                file + ": is a recipe of another version of osggeofx_panorama; make it again with this one.");
        recipe.terrain = pathFrom(json.value("terrain", ""), folder);
        recipe.geocentric = json.value("geocentric", true);
        for (const auto& dem : recipe.terrain.empty() ? json.at("dems") : Json::array())
            recipe.dems.push_back(pathFrom(dem.get<std::string>(), folder));
        recipe.landCover = pathFrom(json.value("landCover", ""), folder);
        recipe.landCoverTable = pathFrom(json.value("landCoverTable", ""), folder);
        recipe.treeCover = pathFrom(json.value("treeCover", ""), folder);
        recipe.vertical = json.value("vertical", "none");
        recipe.allHeights = json.value("allHeights", false);
        recipe.palette = json.value("palette", "");
        if (recipe.palette != colorBlind) recipe.palette = pathFrom(recipe.palette, folder);
        recipe.width = json.at("size").at(0).get<int>();
        recipe.height = json.at("size").at(1).get<int>();
        recipe.dpi = json.value("dpi", 0.0);
        recipe.samples = json.value("samples", recipe.samples);
        recipe.island = json.value("island", false);
        const Json& view = json.at("view");
        recipe.view.place.set(view.at("place").at(0).get<double>(), view.at("place").at(1).get<double>());
        recipe.view.heading = view.at("heading").get<double>();
        // Recipes of rectangles need not say that they are no part of a turn.
        const auto mayLack = [](const std::string& name)
        {
            return name == "horizontalAngle";
        };
        forValues(recipe.view,
                  [&](const char* name, double& value)
                  {
                      if (view.contains(name) || !mayLack(name)) value = view.at(name).get<double>();
                  });
        recipe.map = json.at("map").get<std::map<std::string, std::string>>();
        for (const auto& names : json.value("labels", Json::array()))
            recipe.labels.push_back(pathFrom(names.get<std::string>(), folder));
        for (const auto& lines : json.value("lines", Json::array()))
            recipe.lines.push_back(pathFrom(lines.get<std::string>(), folder));
        recipe.labelStyle = pathFrom(json.value("labelStyle", ""), folder);
        recipe.labelField = json.value("labelField", "");
        recipe.font = pathFrom(json.value("font", ""), folder);
        if (json.contains("liberties")) json.at("liberties").get_to(recipe.liberties);
    }
    catch (const nlohmann::json::exception& error)
    {
        throw Failure(file + ": is not a recipe of osggeofx_panorama (" + error.what() +
                      "); give a DEM, or a recipe that lies beside a map.");
    }
    if ((recipe.dems.empty() && recipe.terrain.empty()) || recipe.width < 1 || recipe.height < 1)
        throw Failure(file + ": names no DEM or no size; make the recipe again.");
    return recipe;
}

namespace
{

Json jsonOf(const Recipe& recipe, const fs::path& folder)
{
    Json json;
    json[formatName] = newestFormat;
    if (recipe.terrain.empty())
    {
        json["dems"] = Json::array();
        for (const std::string& dem : recipe.dems)
            json["dems"].push_back(relativePath(dem, folder));
    }
    else
    {
        json["terrain"] = relativePath(recipe.terrain, folder);
        json["geocentric"] = recipe.geocentric;
    }
    const auto put = [&](const char* name, const std::string& path)
    {
        if (!path.empty()) json[name] = relativePath(path, folder);
    };
    put("landCover", recipe.landCover);
    put("landCoverTable", recipe.landCoverTable);
    put("treeCover", recipe.treeCover);
    json["vertical"] = recipe.vertical;
    if (recipe.allHeights) json["allHeights"] = true;
    if (recipe.palette == colorBlind)
        json["palette"] = recipe.palette;
    else
        put("palette", recipe.palette);
    json["size"] = {recipe.width, recipe.height};
    if (recipe.dpi > 0.0) json["dpi"] = recipe.dpi;
    json["samples"] = recipe.samples;
    json["island"] = recipe.island;
    Json& inView = json["view"];
    inView["place"] = {recipe.view.place.x(), recipe.view.place.y()};
    inView["heading"] = recipe.view.heading;
    forValues(recipe.view, [&](const char* name, double value) { inView[name] = value; });
    json["map"] = recipe.map;
    if (!recipe.liberties.empty()) json["liberties"] = recipe.liberties;
    for (const std::string& names : recipe.labels)
        json["labels"].push_back(relativePath(names, folder));
    for (const std::string& lines : recipe.lines)
        json["lines"].push_back(relativePath(lines, folder));
    put("labelStyle", recipe.labelStyle);
    if (!recipe.labelField.empty()) json["labelField"] = recipe.labelField;
    put("font", recipe.font);
    json["reasons"] = recipe.reasons;
    return json;
}

} // namespace

std::string Recipe::text() const
{
    Json json = jsonOf(*this, ".");
    json.erase("reasons");
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void Recipe::addInputs(osgGeoFX::InputFiles& inputs) const
{
    for (const auto* const files : {&dems, &labels, &lines})
        for (const std::string& file : *files)
            inputs.add(file);
    for (const std::string& file : {terrain, landCover, landCoverTable, treeCover, palette, labelStyle, font})
        inputs.add(file);
}

void Recipe::write(const std::string& file) const
{
    const std::string text =
        jsonOf(*this, folderOf(file)).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    if (osgGeoFX::writeWholeFile(file, text.data(), text.size()) != 0)
        throw Failure(file + ": cannot be written; check the folder, its permissions and the disk's space.");
}

} // namespace geofx::panorama
