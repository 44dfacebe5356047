// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_panorama: any DEM to a panorama map.
#include "layers/SceneLayers.h"
#include "names/PictureMap.h"
#include "osggeofx_render_output.h"
#include "panorama/GroundBuilder.h"
#include "panorama/Recipe.h"
#include "panorama/RecipeLiberties.h"
#include "plan/PicturePlan.h"
#include "print/PrintOptions.h"
#include "process/CommandLine.h"
#include "web/ScenePage.h"

#include <osgGeoFX/batch/OwnFolder.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/terrain/ProgressLine.h>
#include <osgGeoFX/viewer/Scene.h>

#include <CLI/CLI.hpp>
#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

namespace fs = std::filesystem;
using geofx::panorama::Failure;
using geofx::panorama::GroundBuilder;
using geofx::panorama::Recipe;
using osgGeoFX::PanoramaComposer;
using osgGeoFX::PanoramaMap;
using osgGeoFX::PanoramaWishes;
using osgGeoFX::TerrainRelief;

namespace
{

constexpr int badInput = 2;
/// Cells of the relief from which the view is chosen, along the longer side.
constexpr int reliefCells = 512;
/// The height of pictures for which strokes have their own size.
constexpr double usualHeight = 900.0;
using geofx::panorama::colorBlind;

struct Arguments
{
    std::vector<std::string> sources, picks;
    std::string output, size, viewFrom, focus, place, palette, recipe, work, vertical, plan;
    std::string landCover, landCoverTable, treeCover;
    std::optional<double> around, width, exaggeration, horizonLine, horizonDistance;
    std::optional<unsigned int> samples;
    std::vector<std::string> settings;
    std::string liberties; ///< the strength of those that are chosen; empty for none
    std::vector<std::string> liberty;
    geofx::names::Options names;
    geofx::layers::Options layers;
    geofx::web::Options web;
    geofx::print::Options print;
    bool allHeights = false, explain = false, quiet = false;
};

void addOptions(CLI::App& app, Arguments& arguments)
{
    app.add_option(
           "sources", arguments.sources,
           "Elevation rasters, of any kind that GDAL reads; coarse ones first. Or one terrain or scene of "
           "OpenSceneGraph's, such as a database of osggeofx_build. Or one recipe, the JSON file beside a "
           "map, which makes the same map again")
        ->required()
        ->type_name("DEM…|TERRAIN.osgb|RECIPE.json");
    app.add_option(
           "-o,--output", arguments.output,
           "The picture; its extension names the format (png, jpg, tiff, exr; pdf with names and lines "
           "as vectors)")
        ->required()
        ->type_name("FILE");
    app.add_option("--size", arguments.size,
                   "Its size: in pixels (1600x900), or on paper, such as A1@300dpi, A3-portrait@300dpi, "
                   "Letter, 90x60cm@200dpi")
        ->type_name("WxH|PAPER@DPI");
    app.add_option(
           "--view-from", arguments.viewFrom,
           "Where the viewer stands: south, north-east, …; or the place at the middle of the picture's base")
        ->type_name("SIDE|LON,LAT");
    app.add_option("--focus", arguments.focus, "A place to be seen in the middle of the picture")
        ->type_name("LON,LAT");
    app.add_option("--around", arguments.around,
                   "A cylindrical strip: so many degrees of the horizon around a place, such as 360. "
                   "--view-from LON,LAT "
                   "says where the viewer stands")
        ->check(CLI::Range(1.0, 360.0))
        ->type_name("DEGREES");
    app.add_option("--width", arguments.width, "Width of the ground at the picture's base, metres")
        ->check(CLI::PositiveNumber)
        ->type_name("METRES");
    app.add_option("--exaggeration", arguments.exaggeration, "Scale of heights over that of widths")
        ->check(CLI::Range(0.0, 20.0))
        ->type_name("FACTOR");
    app.add_option("--horizon-line", arguments.horizonLine, "Where a flat sea ends, of the picture's height")
        ->check(CLI::Range(0.1, 1.0))
        ->type_name("SHARE");
    app.add_option("--horizon-distance", arguments.horizonDistance,
                   "How far the horizon is (D2), in halves of the width at the base")
        ->check(CLI::Range(0.5, 50.0))
        ->type_name("HALVES");
    app.add_option("--palette", arguments.palette,
                   "The colors: summer (the default), autumn, winter, spring or colorblind; or an image as "
                   "data/panorama/palette.png")
        ->type_name("NAME|FILE");
    app.add_option("--landcover,--land-cover", arguments.landCover, "Raster of land-cover classes")
        ->type_name("FILE");
    app.add_option("--landcover-table,--land-cover-table", arguments.landCoverTable,
                   "What its classes mean; as osggeofx_build's")
        ->type_name("CSV|NAME");
    app.add_option("--trees,--tree-cover", arguments.treeCover,
                   "Raster of the ground's share under trees, percent")
        ->type_name("FILE");
    app.add_option("--vertical", arguments.vertical,
                   "What the heights are measured from: none, ellipsoid, egm96")
        ->check(CLI::IsMember({"none", "ellipsoid", "egm96"}));
    app.add_flag(
        "--all-heights", arguments.allHeights,
        "Take all values of a DEM as heights, also those that plainly are none; as osggeofx_build's");
    app.add_option("--set", arguments.settings,
                   "Any property of the map, such as snowLine=2500 or strokes=false; osggeofx_render "
                   "--help-effects lists "
                   "those of panoramaMap. As often as wanted")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("NAME=VALUE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--samples", arguments.samples, "Samples per pixel (4)")->check(CLI::Range(0u, 64u));
    app.add_option("--recipe", arguments.recipe,
                   "Where to write all choices (beside the picture: its name with .json); none for nowhere")
        ->type_name("FILE.json|none");
    auto* work =
        app.add_option("--work", arguments.work,
                       "Keep the terrain that is built here, for the next map of it; otherwise it is removed "
                       "when the picture "
                       "is there, and an interrupted run goes on with it")
            ->type_name("DIR");
    geofx::plan::addOption(app, arguments.plan)->excludes(work);
    app.add_option("--pick", arguments.picks,
                   "Print the place that a pixel shows: longitude, latitude and height; pixels count from "
                   "the upper left. As often as wanted")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("X,Y")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_flag(
        "--liberties{0.7}", arguments.liberties,
        "Take liberties as painters did: enlarge summits that look small, widen the main valley, turn a "
        "mountain to the viewer; --liberties=STRENGTH takes less or more of them, 0 to 1 (0.7). Otherwise "
        "none is taken");
    static_assert(PanoramaComposer::usualLiberties == 0.7);
    app.add_option(
           "--liberty", arguments.liberty,
           "A liberty of your own, such as '7.66,45.98 radius=6000 enlarge=1.3 turn=10': its center, and "
           "properties of "
           "regionalLiberty, which osggeofx_render --help-effects lists. As often as wanted")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("'LON,LAT NAME=VALUE …'")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    geofx::names::addOptions(app, arguments.names);
    geofx::layers::addOptions(app, arguments.layers);
    geofx::web::addOptions(app, arguments.web);
    geofx::print::addOptions(app, arguments.print);
    app.add_flag("--explain", arguments.explain, "Say what was chosen, and why");
    app.add_flag("--quiet", arguments.quiet, "No progress");
    app.footer(
        "Whatever is not given is chosen from the terrain. Exit code: 0; 2 if something is at fault, with a "
        "sentence.\n\n"
        "Examples:\n"
        "  osggeofx_panorama alps.tif -o alps.png\n"
        "  osggeofx_panorama n46.tif n47.tif --view-from north --palette winter --size 3200x1800 -o ski.png\n"
        "  osggeofx_panorama alps.tif --around 360 --view-from 7.66,45.98 -o ring.png\n"
        "  osggeofx_panorama alps.json -o again.png");
}

osg::Vec2d pairOf(const std::string& option, const std::string& text)
{
    const auto numbers = osgGeoFX::parseNumbers(text);
    if (!numbers || numbers->size() != 2)
        throw Failure(option + " " + text + ": write two numbers, such as 7.66,45.98.");
    return {(*numbers)[0], (*numbers)[1]};
}

/// The heading of a view from a side of the sky; nothing if the text names none.
std::optional<double> headingFrom(std::string side)
{
    std::transform(side.begin(), side.end(), side.begin(), [](unsigned char c) { return std::tolower(c); });
    side.erase(
        std::remove_if(side.begin(), side.end(), [](char c) { return c == '-' || c == '_' || c == ' '; }),
        side.end());
    static const std::map<std::string, double> sides = {
        {"n", 0.0},       {"ne", 45.0},         {"e", 90.0},     {"se", 135.0},
        {"s", 180.0},     {"sw", 225.0},        {"w", 270.0},    {"nw", 315.0},
        {"north", 0.0},   {"northeast", 45.0},  {"east", 90.0},  {"southeast", 135.0},
        {"south", 180.0}, {"southwest", 225.0}, {"west", 270.0}, {"northwest", 315.0}};
    const auto found = sides.find(side);
    if (found == sides.end()) return std::nullopt;
    return std::remainder(osg::DegreesToRadians(found->second) + osg::PI, 2.0 * osg::PI);
}

PanoramaWishes wishesOf(const Arguments& arguments, const Recipe& recipe)
{
    PanoramaWishes wishes;
    wishes.aspect = static_cast<double>(recipe.width) / recipe.height;
    if (!arguments.viewFrom.empty())
    {
        wishes.heading = headingFrom(arguments.viewFrom);
        if (!wishes.heading)
        {
            if (!osgGeoFX::parseNumbers(arguments.viewFrom))
                throw Failure("--view-from " + arguments.viewFrom +
                              ": write a side such as south or north-east, or a place such as 7.66,45.98.");
            wishes.place = pairOf("--view-from", arguments.viewFrom);
        }
    }
    if (!arguments.focus.empty()) wishes.focus = pairOf("--focus", arguments.focus);
    if (arguments.width) wishes.viewRadius = 0.5 * *arguments.width;
    wishes.exaggeration = arguments.exaggeration;
    wishes.horizonLine = arguments.horizonLine;
    wishes.horizonDistance = arguments.horizonDistance;
    wishes.horizontalAngle = osg::DegreesToRadians(arguments.around.value_or(0.0));
    // The view is chosen for the curve and the scale of heights that were asked for.
    const osg::ref_ptr<PanoramaMap> asked = new PanoramaMap;
    std::string ignored;
    for (const auto& [name, value] : recipe.map)
        asked->setPropertyText(name, value, ignored);
    wishes.horizonExaggeration = asked->getHorizonExaggeration();
    wishes.curvePoints = asked->getCurvePoints();
    return wishes;
}

osgGeoFX::Scene load(const std::string& file)
{
    std::string error;
    std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(file, error);
    if (!scene) throw Failure(error);
    return *scene;
}

osg::ref_ptr<osg::Image> readPalette(const std::string& file)
{
    std::string error;
    osg::ref_ptr<osg::Image> palette = osgGeoFX::readPalette(file, error);
    if (!palette) throw Failure("--palette: " + error);
    return palette;
}

/// Seasons and palettes by name.
void takePalette(const std::string& name, Recipe& recipe)
{
    static const std::map<std::string, std::string> seasons = {
        {"winter", "0"}, {"spring", "0.25"}, {"summer", "0.5"}, {"autumn", "0.75"}};
    const auto season = seasons.find(name);
    if (season != seasons.end())
    {
        recipe.map["season"] = season->second;
        return;
    }
    if (name != colorBlind) readPalette(name);
    recipe.palette = name;
}

void takeSize(const Arguments& arguments, Recipe& recipe)
{
    if (arguments.size.empty()) return;
    std::string error;
    const auto size = osgGeoFX::PrintSize::parse(arguments.size, error);
    if (!size) throw Failure("--size " + error);
    if (std::min(size->width, size->height) < 16)
        throw Failure("--size " + arguments.size +
                      ": write width and height in pixels, at least 16 each, such as 1600x900.");
    recipe.width = size->width;
    recipe.height = size->height;
    recipe.dpi = size->dpi;
}

/// A recipe's strokes in another size of the picture.
void growStrokes(double factor, Recipe& recipe)
{
    if (std::abs(factor - 1.0) < 0.001) return;
    const osg::ref_ptr<const PanoramaMap> usual = new PanoramaMap;
    const std::pair<const char*, double> sizes[] = {{"strokeSize", usual->getStrokeSize()},
                                                    {"strokeSpacing", usual->getStrokeSpacing()}};
    for (const auto& [name, byDefault] : sizes)
    {
        const auto found = recipe.map.find(name);
        const double former = found == recipe.map.end() ? byDefault : std::stod(found->second);
        char text[64];
        std::snprintf(text, sizeof(text), "%.4g", std::clamp(former * factor, 1.0, 200.0));
        recipe.map[name] = text;
    }
}

/// Names and lines as the recipe has them, and the files for them that are asked for now.
geofx::names::Options mapOptions(const Arguments& arguments, const Recipe& recipe)
{
    return {recipe.labels, recipe.labelField,   recipe.lines,           recipe.labelStyle,
            recipe.font,   arguments.names.svg, arguments.names.geoJson};
}

void takeOptions(const Arguments& arguments, Recipe& recipe)
{
    takeSize(arguments, recipe);
    const auto take = [](const std::string& given, std::string& value)
    {
        if (!given.empty()) value = given;
    };
    take(arguments.landCover, recipe.landCover);
    take(arguments.landCoverTable, recipe.landCoverTable);
    take(arguments.treeCover, recipe.treeCover);
    take(arguments.vertical, recipe.vertical);
    if (arguments.allHeights) recipe.allHeights = true;
    take(arguments.names.style, recipe.labelStyle);
    take(arguments.names.field, recipe.labelField);
    take(arguments.names.font, recipe.font);
    if (!arguments.names.files.empty()) recipe.labels = arguments.names.files;
    if (!arguments.names.lines.empty()) recipe.lines = arguments.names.lines;
    const std::string fault = geofx::names::faultOf(mapOptions(arguments, recipe), recipe.terrain);
    if (!fault.empty()) throw Failure(fault);
    for (const std::string& file : {arguments.names.svg, arguments.names.geoJson})
    {
        const std::string outputFault = file.empty() ? std::string() : faultOfOutput(file);
        if (!outputFault.empty()) throw Failure(outputFault);
    }
    if (arguments.samples) recipe.samples = *arguments.samples;
    if (!arguments.palette.empty()) takePalette(arguments.palette, recipe);
    const osg::ref_ptr<PanoramaMap> check = new PanoramaMap;
    for (const std::string& setting : arguments.settings)
    {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos)
            throw Failure("--set " + setting + ": write NAME=VALUE, such as snowLine=2500.");
        const std::string name = setting.substr(0, equals), value = setting.substr(equals + 1);
        std::string error;
        if (!check->setPropertyText(name, value, error))
        {
            std::string sentence = "--set ";
            sentence += setting;
            throw Failure(sentence.append(": ").append(error));
        }
        recipe.map[name] = value;
    }
}

/// What follows from the picture's size and the terrain's latitude, and was not asked for.
void chooseTheRest(Recipe& recipe)
{
    const double scale = recipe.height / usualHeight;
    const auto choose = [&](const std::string& name, double value, const std::string& why)
    {
        if (recipe.map.count(name)) return;
        char text[64];
        std::snprintf(text, sizeof(text), "%.4g", value);
        recipe.map[name] = text;
        recipe.reasons.push_back(why);
    };
    if (recipe.geocentric)
    {
        const double snow = osgGeoFX::glsl::geofx_snowLine(osg::DegreesToRadians(recipe.view.place.y()));
        char text[300];
        std::snprintf(
            text, sizeof(text),
            "Snow lies above about %.0f m in midsummer and woods end at about %.0f m, by the latitude of "
            "%.1f degrees, where no raster says otherwise.",
            snow, 0.8 * snow, recipe.view.place.y());
        recipe.reasons.emplace_back(text);
    }
    if (std::abs(scale - 1.0) > 0.01)
    {
        const osg::ref_ptr<const PanoramaMap> usual = new PanoramaMap;
        choose("strokeSize", std::clamp(usual->getStrokeSize() * scale, 1.0, 200.0),
               "Strokes grow with the picture's height.");
        choose("strokeSpacing", std::clamp(usual->getStrokeSpacing() * scale, 1.0, 200.0),
               "So does the distance between them.");
    }
    recipe.reasons.emplace_back("Light: from the upper left, 32 degrees high, as in most painted maps.");
    if (!recipe.map.count("season") && recipe.palette.empty())
        recipe.reasons.emplace_back("Season: midsummer, which shows most of the ground's colors.");
}

bool isIsland(const TerrainRelief& relief)
{
    int sea = 0, all = 0;
    for (int row = 0; row < relief.rows; ++row)
    {
        for (int column = 0; column < relief.columns; ++column)
        {
            if (row > 0 && column > 0 && row + 1 < relief.rows && column + 1 < relief.columns) continue;
            ++all;
            const std::size_t cell = relief.index(column, row);
            sea += relief.water[cell] && relief.heights[cell] < 10.0f ? 1 : 0;
        }
    }
    return 2 * sea > all;
}

void chooseView(const Arguments& arguments, const PanoramaWishes& wishes, const std::string& terrain,
                Recipe& recipe)
{
    const osgGeoFX::Scene scene = load(terrain);
    std::string error;
    const std::optional<TerrainRelief> relief =
        TerrainRelief::read(*scene.node, scene.effects->ground().ellipsoid.get(), reliefCells, error);
    if (!relief) throw Failure(terrain + ": " + error);
    recipe.geocentric = relief->geocentric;
    const PanoramaComposer composer(*relief, wishes);
    recipe.view = composer.compose();
    recipe.island = isIsland(*relief);
    recipe.reasons = composer.explain(recipe.view);
    recipe.reasons.emplace_back(recipe.island ? "Beyond the data: sea, since most of its border is sea."
                                              : "Beyond the data: haze, since its border is land.");
    chooseTheRest(recipe);
    geofx::panorama::takeLiberties(arguments.liberties, arguments.liberty, composer, recipe);
}

osg::ref_ptr<PanoramaMap> mapOf(const Recipe& recipe)
{
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    recipe.view.applyTo(*map);
    map->setEdge(recipe.island ? PanoramaMap::SEA : PanoramaMap::HAZE);
    std::string error;
    for (const auto& [name, value] : recipe.map)
    {
        if (map->setPropertyText(name, value, error)) continue;
        std::string sentence = "The recipe's ";
        sentence += name;
        throw Failure(sentence.append(": ").append(error));
    }
    if (!recipe.palette.empty())
        map->setPalette(recipe.palette == colorBlind ? osgGeoFX::makeColorBlindPalette()
                                                     : readPalette(recipe.palette));
    return map;
}

void printPicks(const Arguments& arguments, const Recipe& recipe, const osgGeoFX::Scene& scene,
                const osgGeoFX::DeformedView& view)
{
    for (const std::string& pick : arguments.picks)
    {
        const osg::Vec2d pixel = pairOf("--pick", pick);
        double longitude = 0.0, latitude = 0.0, height = 0.0;
        if (scene.reference && view.unproject(pixel.x() + 0.5, recipe.height - pixel.y() - 0.5,
                                              *scene.reference, longitude, latitude, height))
            std::printf("%s: longitude %.6f, latitude %.6f, height %.1f m\n", pick.c_str(),
                        osg::RadiansToDegrees(longitude), osg::RadiansToDegrees(latitude), height);
        else
            std::printf("%s: no ground\n", pick.c_str());
    }
}

osgGeoFX::PrintSize sizeOf(const Recipe& recipe)
{
    return {recipe.width, recipe.height, recipe.dpi};
}

/// The files that a print is made of.
std::string madeOf(const Arguments& arguments, const Recipe& recipe, const std::string& ground)
{
    return ground + geofx::names::ageOf(ground) + geofx::names::agesOf(mapOptions(arguments, recipe));
}

void print(const Arguments& arguments, const Recipe& recipe, const osgGeoFX::SceneRenderer::Options& renderer,
           geofx::names::PictureMap& map, osgGeoFX::Scene& scene, const osg::Matrixd& view,
           const std::string& ground, const geofx::web::ScenePage* page,
           const geofx::plan::Division& division)
{
    const std::string raster = geofx::names::PictureMap::rasterOf(arguments.output);
    osgGeoFX::PicturePrint::Options options;
    options.size = sizeOf(recipe);
    options.bits = arguments.print.bits;
    options.renderer = renderer;
    options.names = map.names();
    options.work = division.any() ? division.tileFolder() : geofx::print::tileFolderOf(arguments.output);
    options.recipe = recipe.text() + geofx::names::ageOf(ground) +
                     geofx::names::agesOf(mapOptions(arguments, recipe)) + map.digest() +
                     fs::path(raster).filename().string();
    options.metadata = {{"Software", "osgGeoFX osggeofx_panorama"}, {"ImageDescription", recipe.text()}};
    if (page) options.plain = page->plain();
    osgGeoFX::ProgressLine line("osggeofx_panorama");
    if (!arguments.quiet && !division.any())
        options.progress = [&](int done, int all)
        {
            line(static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(all), "drawing");
        };
    const auto putTogether = [&]
    {
        osgGeoFX::PicturePrint::Options whole = options;
        map.prepare(whole, view);
        std::string error;
        if (!osgGeoFX::PicturePrint::write(scene, whole, view, raster, error)) throw Failure(error);
        map.writeFiles();
    };
    if (division.any())
    {
        std::string error;
        auto tiles = osgGeoFX::PicturePrint::create(scene, options, view, raster, error);
        if (!tiles) throw Failure(error);
        // About what it takes without a GPU.
        const double seconds = 1e-6 * recipe.width * recipe.height * (1.0 + 0.2 * recipe.samples);
        division.run(geofx::plan::printStages(std::move(tiles), osgGeoFX::PicturePrint::countTiles(options),
                                              putTogether),
                     madeOf(arguments, recipe, ground), {seconds, 0.2 * seconds});
        return;
    }
    const geofx::print::TileFolder folder(arguments.output);
    putTogether();
    if (page) page->write(scene, renderer, view, map.names());
    if (arguments.picks.empty()) return;
    const double aspect = static_cast<double>(recipe.width) / recipe.height;
    printPicks(
        arguments, recipe, scene,
        {*scene.effects, view, osg::Matrixd::perspective(renderer.fieldOfView, aspect, 1.0, 1e6),
         static_cast<double>(recipe.width), static_cast<double>(recipe.height),
         static_cast<double>(scene.lodScale(recipe.height, osg::DegreesToRadians(renderer.fieldOfView)))});
}

void paint(const Arguments& arguments, const std::string& ground, const Recipe& recipe,
           PictureFiles& pictures, const geofx::web::ScenePage* page, const geofx::plan::Division& division)
{
    osgGeoFX::Scene scene = load(ground);
    // A scene of one's own may have a projection already.
    for (unsigned int i = 0; i < scene.effects->getNumEffects(); ++i)
        if (dynamic_cast<osgGeoFX::Deformation*>(scene.effects->getEffect(i)))
            scene.effects->getEffect(i)->setEnabled(false);
    geofx::panorama::addLiberties(recipe, *scene.effects);
    scene.effects->addEffect(mapOf(recipe));
    scene.effects->listenTo(*scene.guard);
    osgGeoFX::SceneRenderer::Options options;
    options.width = recipe.width;
    options.height = recipe.height;
    options.samples = recipe.samples;
    std::string error;
    geofx::names::PictureMap map(mapOptions(arguments, recipe), arguments.output, sizeOf(recipe), scene,
                                 !arguments.layers.folder.empty());
    for (const std::string& notice : map.notices())
        if (!arguments.quiet) std::fprintf(stderr, "%s\n", notice.c_str());
    TerrainRelief frame;
    frame.geocentric = recipe.geocentric;
    const osg::Matrixd view = recipe.view.viewMatrix(frame);
    if (geofx::print::isPrint(arguments.print, arguments.output, sizeOf(recipe)))
    {
        print(arguments, recipe, options, map, scene, view, ground, page, division);
        if (!division.any())
            geofx::layers::write(arguments.layers, scene, sizeOf(recipe), options, map, view);
        return;
    }
    map.prepare();
    auto renderer = osgGeoFX::SceneRenderer::create(scene, options, error);
    if (!renderer) throw Failure(error);
    osgGeoFX::FrameStatistics unused;
    const auto image = renderer->render(view, 0.0, unused, error);
    if (!image) throw Failure(error);
    map.draw(renderer->camera(), *image,
             [&](const osg::Image& plain)
             {
                 if (page) page->setPicture(plain);
             });
    if (!pictures.write(*image, 0)) throw Failure(pictures.error());
    map.writeFiles();
    if (!arguments.picks.empty()) printPicks(arguments, recipe, scene, {*scene.effects, renderer->camera()});
    renderer.reset();
    if (page) page->write(scene, options, view, map.names());
    geofx::layers::write(arguments.layers, scene, sizeOf(recipe), options, map, view);
}

/// What a plan's workers are called with: the recipe, and what is not in it.
std::vector<std::string> workersArguments(const Arguments& arguments, const Recipe& recipe,
                                          const geofx::plan::Division& division)
{
    const std::string file = division.workFile("recipe.json");
    std::error_code ignored;
    fs::create_directories(fs::path(file).parent_path(), ignored);
    recipe.write(file);
    std::vector<std::string> result = {file,
                                       "-o",
                                       fs::path(arguments.output).filename().string(),
                                       "--bits",
                                       std::to_string(arguments.print.bits),
                                       "--quiet",
                                       "--recipe",
                                       "none"};
    for (const auto& [option, value] :
         {std::pair("--svg", arguments.names.svg), std::pair("--geojson", arguments.names.geoJson)})
        if (!value.empty()) result.insert(result.end(), {option, value});
    return result;
}

void checkPlan(const Arguments& arguments, const Recipe& recipe)
{
    if (!geofx::print::isPrint(arguments.print, arguments.output, sizeOf(recipe)))
        throw Failure(
            "--plan is for what has parts: a print, whose --size is large or has a resolution; leave "
            "it out, or take another --size.");
    if (arguments.layers.any() || arguments.web.wanted() || !arguments.picks.empty())
        throw Failure(
            "--layers, --mesh, --web and --pick are for pictures that one process draws; leave them "
            "out, or --plan.");
}

/// Where the recipe is written; empty for nowhere. A recipe that is read stays as it is, unless --recipe names it.
std::string recipeFileOf(const Arguments& arguments, const fs::path& beside)
{
    if (arguments.recipe == "none") return {};
    if (!arguments.recipe.empty()) return arguments.recipe;
    const std::string file = beside.string() + ".json";
    std::error_code ignored;
    return arguments.sources.size() == 1 && Recipe::isRecipe(arguments.sources.front()) &&
                   fs::equivalent(file, arguments.sources.front(), ignored)
               ? std::string()
               : file;
}

/// Makes sure that nothing which is read is written over. `work`: the folder for the terrain; empty for none.
void claimOutputs(const Arguments& arguments, const Recipe& recipe, const std::string& recipeFile,
                  const std::string& work)
{
    osgGeoFX::InputFiles inputs = geofx::names::makeInputFiles();
    for (const std::string& source : arguments.sources)
        inputs.add(source);
    recipe.addInputs(inputs);
    geofx::names::PictureMap::claimOutput(arguments.output, inputs);
    geofx::names::claimOutputs(arguments.names, inputs);
    geofx::layers::claimOutputs(arguments.layers, inputs);
    geofx::web::claimOutputs(arguments.web, inputs);
    if (geofx::print::isPrint(arguments.print, arguments.output, sizeOf(recipe)))
        geofx::print::claimTileFolder(arguments.output, inputs);
    if (!work.empty())
    {
        inputs.claimFolder("The work folder", work, "--work");
        osgGeoFX::OwnFolder::check(work, "--work");
    }
    if (recipeFile.empty()) return;
    inputs.claim("The recipe", recipeFile, "--recipe");
    if (fs::exists(recipeFile) && !Recipe::isIn(recipeFile))
        throw Failure(recipeFile +
                      ": the recipe of the map would replace this file, which is no recipe; choose another "
                      "--recipe, or --recipe none.");
}

void run(Arguments& arguments, geofx::plan::Division& division)
{
    arguments.output = division.outputOf(arguments.output);
    PictureFiles pictures(geofx::names::PictureMap::rasterOf(arguments.output), false);
    if (!pictures.error().empty()) throw Failure(pictures.error());
    const std::string bitsFault = geofx::print::faultOf(arguments.print, arguments.output);
    if (!bitsFault.empty()) throw Failure(bitsFault);
    Recipe recipe;
    std::string formerText;
    const bool again = arguments.sources.size() == 1 && Recipe::isRecipe(arguments.sources.front());
    if (again)
    {
        recipe = Recipe::read(arguments.sources.front());
        formerText = recipe.text();
        if (!arguments.viewFrom.empty() || !arguments.focus.empty() || arguments.width ||
            arguments.exaggeration || arguments.horizonLine || arguments.horizonDistance || arguments.around)
            throw Failure("A recipe has its view already; leave --view-from, --focus, --around, --width, "
                          "--exaggeration, "
                          "--horizon-line and --horizon-distance out, or change the recipe.");
        if (!arguments.liberties.empty())
            throw Failure(
                "A recipe has its liberties already; leave --liberties out, or make the recipe again.");
        geofx::panorama::takeOwnLiberties(arguments.liberty, recipe);
    }
    else if (arguments.sources.size() == 1 && Recipe::isTerrain(arguments.sources.front()))
        recipe.terrain = arguments.sources.front();
    else
        recipe.dems = arguments.sources;
    if (arguments.around)
    {
        // A strip is long. 360 degrees are as wide as the screens that people join.
        recipe.width = static_cast<int>(std::lround(std::clamp(10.0 * *arguments.around, 960.0, 3600.0)));
        recipe.height = 720;
    }
    const int formerHeight = recipe.height;
    if (again)
    {
        takeSize(arguments, recipe);
        growStrokes(static_cast<double>(recipe.height) / formerHeight, recipe);
    }
    takeOptions(arguments, recipe);
    if (division.any()) checkPlan(arguments, recipe);
    const PanoramaWishes wishes = wishesOf(arguments, recipe);
    for (const std::string& pick : arguments.picks)
        pairOf("--pick", pick);
    geofx::panorama::checkLiberties(arguments.liberties, arguments.liberty);
    if (arguments.around && !arguments.liberties.empty())
        throw Failure("--liberties turns mountains to a viewer who stands before them; leave it out with "
                      "--around, or take "
                      "liberties of your own with --liberty.");

    const fs::path beside = fs::path(arguments.output).replace_extension();
    std::string work = arguments.work.empty() ? beside.string() + ".work" : arguments.work;
    if (division.any()) work = division.workFile("terrain");
    const bool builds = recipe.terrain.empty() && (!division.any() || division.plans());
    const std::string recipeFile = recipeFileOf(arguments, beside);
    // Workers write into the folder of their plan, which was empty.
    if (!division.any() || division.plans())
        claimOutputs(arguments, recipe, recipeFile, builds ? work : std::string());
    geofx::layers::check(arguments.layers);
    std::optional<geofx::web::ScenePage> page;
    if (arguments.web.wanted()) page.emplace(arguments.web, arguments.output);

    std::optional<GroundBuilder> builder;
    if (builds) builder.emplace(recipe, work, arguments.quiet);
    if (!again) chooseView(arguments, wishes, builder ? builder->overview() : recipe.terrain, recipe);
    // For workers it is there.
    const std::string ground = builder                  ? builder->ground(recipe.view)
                               : recipe.terrain.empty() ? GroundBuilder::groundIn(work)
                                                        : recipe.terrain;
    if (!again && builder)
        recipe.reasons.insert(recipe.reasons.end(), builder->notes().begin(), builder->notes().end());
    if (division.plans()) division.setArguments(workersArguments(arguments, recipe, division));
    if (arguments.explain)
    {
        for (const std::string& reason : recipe.reasons)
            std::printf("%s\n", reason.c_str());
        std::fflush(stdout);
    }
    paint(arguments, ground, recipe, pictures, page ? &*page : nullptr, division);
    if (!recipeFile.empty())
        recipe.write(recipeFile);
    else if (again && arguments.recipe.empty() && !arguments.quiet && recipe.text() != formerText)
        std::fprintf(stderr,
                     "osggeofx_panorama: %s, which was read, stays as it is; --recipe FILE keeps what was "
                     "changed.\n",
                     arguments.sources.front().c_str());
    builder.reset();
    if (arguments.work.empty() && builds && !division.any()) osgGeoFX::OwnFolder::remove(work);
}

} // namespace

int main(int argc, char** argv)
{
    Arguments arguments;
    CLI::App app("Makes a panorama map in the manner of Heinrich Berann from elevation data, in one command.",
                 "osggeofx_panorama");
    addOptions(app, arguments);
    try
    {
        int exitCode = 0;
        std::optional<geofx::plan::Call> call =
            geofx::plan::callOf("osggeofx_panorama", argc, argv, exitCode);
        if (!call) return exitCode;
        // CLI11 takes them from the last one on.
        app.parse(std::vector<std::string>(call->arguments.rbegin(), call->arguments.rend()));
        geofx::plan::Division division =
            call->units ? *call->units
                        : geofx::plan::Division("osggeofx_panorama", call->arguments, arguments.plan);
        run(arguments, division);
    }
    catch (const CLI::ParseError& error)
    {
        return geofx::exitCodeOf(app, error);
    }
    catch (const std::exception& error)
    {
        std::cerr << "osggeofx_panorama: " << error.what() << std::endl;
        return badInput;
    }
    return 0;
}
