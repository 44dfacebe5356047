// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "names/SceneNames.h"

#include <osgGeoFX/labels/NameFile.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <osg/Group>
#include <osgDB/FileUtils>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace geofx::names
{

namespace
{

using osgGeoFX::LabelCandidate;
using osgGeoFX::NameStyle;

/// Cells of the relief in which summits are looked for, along the longer side.
constexpr int reliefCells = 2048;

class Fault : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

osg::Vec4 colorOf(const std::string& text, const std::string& where)
{
    unsigned int value = 0;
    int used = 0;
    const bool withAlpha = text.size() == 9;
    if ((text.size() != 7 && !withAlpha) || std::sscanf(text.c_str(), "#%8x%n", &value, &used) != 1 ||
        static_cast<std::size_t>(used) != text.size())
        throw Fault(where + " \"" + text + "\" is no color; write #rrggbb or #rrggbbaa.");
    if (!withAlpha) value = value << 8 | 255u;
    const auto channel = [&](int shift)
    {
        return static_cast<float>(value >> shift & 255u) / 255.0f;
    };
    return {channel(24), channel(16), channel(8), channel(0)};
}

void readStyle(const nlohmann::json& json, const std::string& where, NameStyle& style)
{
    const auto number = [&](const char* key, double low, double high, double& value)
    {
        if (!json.contains(key)) return;
        const nlohmann::json& found = json.at(key);
        if (!found.is_number() || !(found.get<double>() >= low && found.get<double>() <= high))
        {
            char text[80];
            std::snprintf(text, sizeof(text), "%g to %g.", low, high);
            throw Fault(where + " \"" + key + "\" must be a number from " + text);
        }
        value = found.get<double>();
    };
    const auto flag = [&](const char* key, bool& value)
    {
        if (!json.contains(key)) return;
        if (!json.at(key).is_boolean()) throw Fault(where + " \"" + key + "\" must be true or false.");
        value = json.at(key).get<bool>();
    };
    const auto text = [&](const char* key) -> std::optional<std::string>
    {
        if (!json.contains(key)) return std::nullopt;
        if (!json.at(key).is_string()) throw Fault(where + " \"" + key + "\" must be a text.");
        return json.at(key).get<std::string>();
    };
    static const std::vector<std::string> known = {"font",    "size",    "bold", "italic",
                                                   "spacing", "color",   "halo", "haloWidth",
                                                   "manner",  "longest", "line", "dot"};
    for (const auto& [key, value] : json.items())
        if (std::find(known.begin(), known.end(), key) == known.end())
            throw Fault(where + " \"" + key +
                        "\" is not known; there are font, size, bold, italic, spacing, color, halo, "
                        "haloWidth, manner, longest, line and dot.");
    if (const auto font = text("font")) style.text.font = *font;
    number("size", 1.0, 500.0, style.text.size);
    number("spacing", 0.0, 4.0, style.text.spacing);
    number("haloWidth", 0.0, 1.0, style.text.haloWidth);
    number("longest", 1.0, 1000.0, style.text.longest);
    number("line", 0.0, 50.0, style.lineWidth);
    number("dot", 0.0, 50.0, style.dot);
    flag("bold", style.text.bold);
    flag("italic", style.text.italic);
    if (const auto color = text("color")) style.text.color = colorOf(*color, where + " \"color\"");
    if (const auto halo = text("halo")) style.text.halo = colorOf(*halo, where + " \"halo\"");
    if (const auto manner = text("manner"))
    {
        if (*manner != "leader" && *manner != "beside")
            throw Fault(where + " \"manner\" must be leader (above, with a line) or beside.");
        style.manner = *manner == "leader" ? LabelCandidate::LEADER : LabelCandidate::BESIDE;
    }
}

/// FILE, or FILE:LAYER where there is no file of the whole name.
osgGeoFX::NameFile fileOf(const std::string& text)
{
    osgGeoFX::NameFile file;
    file.file = text;
    const std::size_t colon = text.rfind(':');
    if (!osgDB::fileExists(text) && colon != std::string::npos && osgDB::fileExists(text.substr(0, colon)))
    {
        file.file = text.substr(0, colon);
        file.layer = text.substr(colon + 1);
    }
    return file;
}

std::string wktOf(osg::Node& node)
{
    struct Finder : public osg::NodeVisitor
    {
        Finder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
        void apply(osg::CoordinateSystemNode& found) override { wkt = found.getCoordinateSystem(); }
        void apply(osg::LOD&) override {}
        std::string wkt;
    } finder;
    node.accept(finder);
    return finder.wkt;
}

} // namespace

void addOptions(CLI::App& app, Options& options)
{
    app.add_option("--labels", options.files,
                   "Names to put onto the picture: vector data of any kind that GDAL reads, FILE or "
                   "FILE:LAYER. As often as "
                   "wanted")
        ->expected(1)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--style", options.style,
                   "How names look: JSON such as {\"names\": {\"peak\": {\"size\": 16}}}")
        ->type_name("FILE.json");
    app.add_option("--font", options.font,
                   "The names' font: the families of installed ones, or a font's file")
        ->type_name("NAME|FILE");
}

std::string ageOf(const std::string& file)
{
    std::error_code fault;
    const auto time = std::filesystem::last_write_time(file, fault);
    return fault ? std::string() : " of " + std::to_string(time.time_since_epoch().count());
}

std::map<std::string, NameStyle> readStyles(const std::string& file)
{
    std::map<std::string, NameStyle> styles = osgGeoFX::usualNameStyles();
    std::ifstream stream(file);
    if (!stream) throw Fault("The style file \"" + file + "\" cannot be read; check its name.");
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false, true);
    if (json.is_discarded() || !json.is_object() || !json.contains("names") || !json.at("names").is_object())
        throw Fault("\"" + file +
                    "\" is no style file; it must be JSON such as {\"names\": {\"peak\": {\"size\": 16}}}.");
    for (const auto& [name, style] : json.at("names").items())
    {
        const std::string where = "\"" + file + "\", style \"" + name + "\":";
        if (!style.is_object()) throw Fault(where + " it must be an object, such as {\"size\": 16}.");
        // One that is new begins as the usual one.
        const auto found = styles.find(name);
        NameStyle changed = found != styles.end() ? found->second : styles[""];
        readStyle(style, where, changed);
        styles[name] = changed;
    }
    return styles;
}

osg::ref_ptr<osgGeoFX::NameSet> read(const Options& options, const osgGeoFX::Scene& scene,
                                     std::string& notice)
{
    std::map<std::string, NameStyle> styles =
        options.style.empty() ? osgGeoFX::usualNameStyles() : readStyles(options.style);
    std::string error;
    if (!options.font.empty())
    {
        const bool isFile = osgDB::fileExists(options.font);
        std::string families = options.font;
        if (isFile && !osgGeoFX::addFontFile(options.font, families, error)) throw Fault("--font: " + error);
        for (auto& [name, style] : styles)
            style.text.font = families + "," + style.text.font;
    }
    const osg::ref_ptr<const osg::EllipsoidModel> ellipsoid = scene.effects->ground().ellipsoid;
    std::vector<osgGeoFX::MapName> names;
    for (const std::string& each : options.files)
    {
        osgGeoFX::NameFile file = fileOf(each);
        file.globe = ellipsoid.valid();
        if (!file.globe) file.wkt = wktOf(*scene.node);
        if (!file.read(error)) throw Fault(error);
        std::move(file.names.begin(), file.names.end(), std::back_inserter(names));
    }
    const auto relief = osgGeoFX::TerrainRelief::read(*scene.node, ellipsoid.get(), reliefCells, error);
    if (!relief) throw Fault("--labels: " + error);
    const std::size_t all = names.size();
    const osgGeoFX::NamePlacement placement;
    const osgGeoFX::NamePlacement::Result result =
        placement.place(names, *scene.effects->getTerrain(), ellipsoid.get(), *relief);
    notice.clear();
    if (names.empty())
        throw Fault("--labels: all " + std::to_string(all) +
                    " names lie beside the terrain; check the file's coordinate reference system.");
    if (result.outside > 0)
        notice = std::to_string(result.outside) + " of " + std::to_string(all) +
                 " names lie beside the terrain and are left out.";
    const osg::ref_ptr<osgGeoFX::NameSet> set = new osgGeoFX::NameSet(std::move(names));
    for (const auto& [name, style] : styles)
        set->setStyle(name, style);
    return set;
}

PictureNames::PictureNames(osgGeoFX::NameSet& names, osgGeoFX::Scene& scene, int height)
    : _names(&names), _effects(scene.effects)
{
    names.setScale(height / usualHeight);
    _reader->setImmediate(true);
    _reader->setDepthConvention(scene.effects->getDepthConvention());
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(scene.node);
    both->addChild(_reader);
    scene.node = both;
}

osgGeoFX::LabelPicture PictureNames::place(const osg::Camera& camera) const
{
    return osgGeoFX::LabelPicture(*_names, *_effects, camera, _reader->pictures());
}

} // namespace geofx::names
