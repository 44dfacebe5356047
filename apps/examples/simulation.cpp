// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A flood that rises over the coast of Oahu, and a fire that spreads on its slopes: layers that a program writes in each frame, in a
// window with a time bar, or as pictures.
#include "simulation/Fire.h"
#include "simulation/Flood.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/geodata/FileSources.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/ValueLegend.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Overlay.h>
#include <osgGeoFX/viewer/Scene.h>
#include <osgGeoFX/viewer/TimeBar.h>

#include <CLI/CLI.hpp>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osgDB/WriteFile>
#include <osgGA/TerrainManipulator>
#include <osgText/Text>
#include <osgViewer/Viewer>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

using namespace osgGeoFX;

namespace
{

struct Arguments
{
    std::string terrain, data, kind, frames, view, size = "1200x750";
    std::vector<std::string> effects;
    int count = 48;
    int width = 1200, height = 750;
};

/// Where a simulation takes place, and how it is seen.
struct Stage
{
    double longitude, latitude; ///< of the middle, degrees
    int side;                   ///< cells
    double seconds;             ///< from its begin to its end
    const char* view;           ///< LON,LAT,HEIGHT,HEADING,PITCH
    double fieldOfView;         ///< vertical, degrees
    const char* title;
    const char* unit;
    double legendWidth;
};

constexpr double cell = 30.0;                                   ///< metres
constexpr double floodLevel = 12.0;                             ///< of the sea at the end, metres
constexpr double fireLongitude = -158.15, fireLatitude = 21.47; // scrub above Waianae

const Stage floodStage = {-157.92,           21.32, 768,  21600.0, "-157.872,21.262,1500,20,-17", 36.0,
                          "Water over land", "m",   300.0};
const Stage fireStage = {
    -158.13, 21.47, 640, 36000.0, "-158.235,21.405,3000,55,-19", 34.0, "Since the fire came", "h", 300.0};

osg::Vec4 color(int rgb, double alpha)
{
    return osg::Vec4(
        osg::Vec4d((rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0, alpha));
}

osg::ref_ptr<ColorTable> waterColors()
{
    osg::ref_ptr<ColorTable> table = new ColorTable;
    table->addStop(-5.0, color(0xbfe9f2, 0.0));
    table->addStop(0.0, color(0xbfe9f2, 0.0));
    table->addStop(0.0, color(0xbfe9f2, 0.5));
    table->addStop(0.5, color(0x7fd0e6, 0.65));
    table->addStop(3.0, color(0x2f8fcb, 0.8));
    table->addStop(12.0, color(0x123f80, 0.9));
    return table;
}

/// Of seconds since the fire came.
osg::ref_ptr<ColorTable> fireColors(double second)
{
    osg::ref_ptr<ColorTable> table = new ColorTable;
    table->addStop(-3600.0 * second, color(0xfff3a0, 0.0));
    table->addStop(0.0, color(0xfff3a0, 0.0));
    table->addStop(0.0, color(0xfff3a0, 1.0));
    table->addStop(300.0 * second, color(0xffb21e, 1.0));
    table->addStop(900.0 * second, color(0xe8500f, 0.97));
    table->addStop(1800.0 * second, color(0x8c1f10, 0.92));
    table->addStop(3600.0 * second, color(0x3a2620, 0.88));
    table->addStop(14400.0 * second, color(0x2b2a2a, 0.78));
    return table;
}

class Simulation
{
public:
    Simulation(const Arguments& arguments, const Stage& stage) : _stage(stage)
    {
        std::string error;
        std::optional<Scene> loaded = Scene::load(arguments.terrain, error);
        if (!loaded) throw std::runtime_error(error);
        scene = *loaded;
        if (!scene.reference || !scene.reference->isGeocentric())
            throw std::runtime_error(arguments.terrain + ": the simulations want Oahu on the globe.");
        _mappings->setGeodeticOrigin(osg::DegreesToRadians(stage.longitude),
                                     osg::DegreesToRadians(stage.latitude));
        _heights = simulation::Field(*read(arguments.data + "/elevation.tif", DataLayer::VALUE));
        _cover = simulation::Field(*read(arguments.data + "/landcover.tif", DataLayer::CLASS));
        _image->allocateImage(stage.side, stage.side, 1, GL_RED, GL_FLOAT);
        osg::ref_ptr<DataLayer> layer = new DataLayer(_image);
        layer->setKind(DataLayer::VALUE);
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setName(stage.title);
        mapping->setLayer(layer);
        const double half = 0.5 * cell * stage.side;
        mapping->setRectangle({0.0, 0.0}, half, half);
        mapping->getTransfer()->setSource(ColorTransfer::TABLE);
        _mapping = mapping;
        _mappings->addMapping(mapping);
        for (const std::string& line : arguments.effects)
        {
            const osg::ref_ptr<Effect> effect = parseEffect(line, error);
            if (!effect) throw std::runtime_error(error);
            scene.effects->addEffect(effect);
        }
        scene.effects->addEffect(_mappings);
        caption->setFont(osgText::readRefFontFile("DejaVuSans.ttf"));
        caption->setCharacterSize(22.0f);
        caption->setFontResolution(32, 32);
        caption->setColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
        caption->setBackdropType(osgText::Text::OUTLINE);
        caption->setBackdropColor(osg::Vec4(0.05f, 0.08f, 0.12f, 1.0f));
        caption->setDataVariance(osg::Object::DYNAMIC);
        clock->setRange(0.0, stage.seconds);
        clock->setSpeed(stage.seconds / 20.0);
        scene.effects->addUpdateCallback(_player);
    }

    void flood()
    {
        const auto isSea = [this](int column, int row)
        {
            const int cover = static_cast<int>(_cover.at(column, row));
            return cover == 1 || !(_heights.at(column, row) > -1e6f);
        };
        _flood = std::make_unique<simulation::Flood>(_heights, isSea);
        setColors(waterColors(), waterColors());
        _player->add([this](double time) { _flood->draw(floodLevel * time / _stage.seconds, *_image); });
    }

    void fire()
    {
        simulation::Fire::Ground ground;
        ground.heights = _heights;
        ground.speeds = simulation::Field(_stage.side, _stage.side);
        for (std::size_t i = 0; i < ground.speeds.cells.size(); ++i)
        {
            if (!std::isfinite(_heights.cells[i])) ground.heights.cells[i] = 0.0f;
            ground.speeds.cells[i] =
                static_cast<float>(simulation::fireSpeed(static_cast<int>(_cover.cells[i])));
        }
        ground.cell = cell;
        ground.wind.set(0.5, 0.3); // from the sea
        osg::Vec3d world;
        scene.reference->toWorld(osg::DegreesToRadians(fireLongitude), osg::DegreesToRadians(fireLatitude),
                                 0.0, world);
        const osg::Vec3d place = _mappings->placeOf(world, scene.effects->ground().ellipsoid);
        const auto cellOf = [&](double metres)
        {
            return static_cast<int>(std::floor(metres / cell + 0.5 * _stage.side));
        };
        _fire = std::make_unique<simulation::Fire>(ground, cellOf(place.x()), cellOf(place.y()));
        setColors(fireColors(1.0), fireColors(1.0 / 3600.0));
        _player->add([this](double time) { _fire->draw(time, *_image); });
    }

    /// Adds what is written over the picture.
    void addCaption()
    {
        _player->add([this](double time)
                     { caption->setText(osgText::String(say(time), osgText::String::ENCODING_UTF8)); });
    }

    /// What the simulation says of a time.
    std::string say(double time) const
    {
        char text[200];
        const double area = cell * cell / 1e6;
        if (_flood)
        {
            const double level = floodLevel * time / _stage.seconds;
            std::snprintf(text, sizeof text, "The sea %.1f m higher: %.1f km² of land under water", level,
                          static_cast<double>(_flood->flooded(level)) * area);
        }
        else
            std::snprintf(text, sizeof text, "After %.1f hours: %.1f km² burning or burnt", time / 3600.0,
                          static_cast<double>(_fire->burnt(time)) * area);
        return text;
    }

    Scene scene;
    osg::ref_ptr<LayerClock> clock = new LayerClock;
    osg::ref_ptr<osg::Group> legend;
    osg::ref_ptr<osgText::Text> caption = new osgText::Text;

private:
    void setColors(ColorTable* table, ColorTable* shown)
    {
        _mapping->setTable(table);
        const auto [low, high] = table->range();
        _mapping->getTransfer()->setValueRange(low, high);
        LegendStyle style;
        style.title = _stage.title;
        style.unit = _stage.unit;
        style.width = _stage.legendWidth;
        style.font = osgText::readRefFontFile("DejaVuSans.ttf");
        legend = makeLegend(*shown, 0.0, shown->range().second, style);
    }

    osg::ref_ptr<osg::Image> read(const std::string& file, DataLayer::Kind kind) const
    {
        MappingFrame frame;
        frame.origin = _mappings->getLocalOrigin();
        MappingRaster::Options options;
        options.kind = kind;
        options.maxSide = _stage.side;
        const double half = 0.5 * cell * _stage.side;
        options.window = MappingRaster::Window{{-half, -half}, {half, half}, cell};
        std::string error;
        const std::optional<MappingRaster> raster = MappingRaster::read(file, frame, options, error);
        if (!raster) throw std::runtime_error(error);
        return raster->layer->getImage();
    }

    const Stage& _stage;
    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;
    osg::ref_ptr<ProjectiveMapping> _mapping;
    osg::ref_ptr<LayerPlayer> _player = new LayerPlayer(clock);
    osg::ref_ptr<osg::Image> _image = new osg::Image;
    simulation::Field _heights, _cover;
    std::unique_ptr<simulation::Flood> _flood;
    std::unique_ptr<simulation::Fire> _fire;
};

std::string frameName(const Arguments& arguments, int frame)
{
    char name[40];
    std::snprintf(name, sizeof name, "%s-%03d.jpg", arguments.kind.c_str(), frame);
    return (std::filesystem::path(arguments.frames) / name).string();
}

/// Makes sure that no picture replaces a file that is read.
void claimFrames(const Arguments& arguments)
{
    if (arguments.frames.empty()) return;
    InputFiles inputs([](const std::string& file) { return FileSources::of(file).files; });
    inputs.add(arguments.terrain);
    for (const char* raster : {"elevation.tif", "landcover.tif"})
        inputs.add((std::filesystem::path(arguments.data) / raster).string());
    for (int i = 0; i < arguments.count; ++i)
        inputs.claim("The picture", frameName(arguments, i), "--frames");
}

/// The scene with its legend in the lower left corner.
osg::ref_ptr<osg::Node> withLegend(const Simulation& simulation, int width, int height)
{
    const osg::ref_ptr<osg::Camera> overlay = makeOverlay(width, height);
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::translate(16.0, 16.0, 0.0));
    place->addChild(simulation.legend);
    overlay->addChild(place);
    simulation.caption->setPosition(osg::Vec3(osg::Vec3d(16.0, static_cast<double>(height) - 38.0, 0.0)));
    overlay->addChild(simulation.caption);
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(simulation.scene.node);
    both->addChild(overlay);
    return both;
}

osg::Matrixd viewOf(const Arguments& arguments, const Stage& stage, const Scene& scene)
{
    std::string error;
    const auto point = ViewPoint::parse(arguments.view.empty() ? stage.view : arguments.view, error);
    if (!point) throw std::runtime_error(error);
    osg::Matrixd view;
    point->viewMatrix(*scene.reference, view);
    return view;
}

void drawFrames(const Arguments& arguments, const Stage& stage, Simulation& simulation)
{
    std::string error;
    SceneRenderer::Options options;
    options.width = arguments.width;
    options.height = arguments.height;
    options.fieldOfView = stage.fieldOfView;
    options.samples = 4;
    Scene scene = simulation.scene;
    scene.node = withLegend(simulation, arguments.width, arguments.height);
    // The program's time is the simulation's.
    simulation.clock->setSpeed(1.0);
    simulation.clock->setLoop(false);
    const auto renderer = SceneRenderer::create(scene, options, error);
    if (!renderer) throw std::runtime_error(error);
    const osg::Matrixd view = viewOf(arguments, stage, scene);
    std::filesystem::create_directories(arguments.frames);
    const osg::ref_ptr<osgDB::Options> quality = new osgDB::Options("JPEG_QUALITY 87");
    for (int i = 0; i < arguments.count; ++i)
    {
        const double time = stage.seconds * i / std::max(1, arguments.count - 1);
        FrameStatistics statistics;
        const osg::ref_ptr<osg::Image> image = renderer->render(view, time, statistics, error);
        if (!image) throw std::runtime_error(error);
        const std::string file = frameName(arguments, i);
        if (!osgDB::writeImageFile(*image, file, quality))
            throw std::runtime_error(file + " cannot be written.");
        std::cout << file << ": " << simulation.say(time) << std::endl;
    }
}

int showWindow(const Arguments& arguments, const Stage& stage, Simulation& simulation)
{
    osgViewer::Viewer viewer;
    viewer.setSceneData(withLegend(simulation, arguments.width, arguments.height));
    simulation.scene.setUpView(viewer);
    viewer.setUpViewInWindow(50, 50, arguments.width, arguments.height);
    viewer.addEventHandler(new TimeBar(*simulation.clock));
    osg::Vec3d eye, center, up;
    viewOf(arguments, stage, simulation.scene).getLookAt(eye, center, up, 10000.0);
    const osg::ref_ptr<osgGA::TerrainManipulator> manipulator = new osgGA::TerrainManipulator;
    manipulator->setHomePosition(eye, center, up);
    viewer.setCameraManipulator(manipulator);
    return viewer.run();
}

} // namespace

int main(int argc, char** argv)
{
    Arguments arguments;
    CLI::App app("A flood that rises over the coast of Oahu, or a fire that spreads on its slopes.",
                 "example_simulation");
    app.add_option("terrain", arguments.terrain,
                   "Oahu: data/oahu/plain.geofx, or a database of it on the globe")
        ->required();
    app.add_option("data", arguments.data, "Folder of elevation.tif and landcover.tif")->required();
    app.add_option("kind", arguments.kind, "flood or fire")
        ->required()
        ->check(CLI::IsMember({"flood", "fire"}));
    app.add_option("effects", arguments.effects, "Effects: 'KIND PROPERTY=VALUE …'");
    app.add_option("--frames", arguments.frames, "Write pictures into this folder (default: open a window)");
    app.add_option("--count", arguments.count, "Number of pictures")
        ->capture_default_str()
        ->check(CLI::Range(1, 10000));
    app.add_option("--view", arguments.view, "Another view: LON,LAT,HEIGHT,HEADING,PITCH");
    app.add_option("--size", arguments.size, "WIDTHxHEIGHT")->capture_default_str();
    CLI11_PARSE(app, argc, argv)
    try
    {
        if (std::sscanf(arguments.size.c_str(), "%5dx%5d", &arguments.width, &arguments.height) != 2)
            throw std::runtime_error("--size " + arguments.size +
                                     ": write width and height, such as 1200x750.");
        claimFrames(arguments);
        const bool floods = arguments.kind == "flood";
        const Stage& stage = floods ? floodStage : fireStage;
        Simulation simulation(arguments, stage);
        if (floods)
            simulation.flood();
        else
            simulation.fire();
        simulation.addCaption();
        if (arguments.frames.empty()) return showWindow(arguments, stage, simulation);
        drawFrames(arguments, stage, simulation);
    }
    catch (const std::exception& failure)
    {
        std::cerr << failure.what() << '\n';
        return 1;
    }
    return 0;
}
