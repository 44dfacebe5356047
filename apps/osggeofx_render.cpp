// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_render: an OSG file or .geofx scene to pictures, off-screen.
#include "layers/SceneLayers.h"
#include "names/PictureMap.h"
#include "names/SceneMappings.h"
#include "osggeofx_render_output.h"
#include "plan/PicturePlan.h"
#include "print/PrintOptions.h"
#include "process/CommandLine.h"
#include "render/Camera.h"
#include "render/Deadline.h"
#include "render/Values.h"
#include "web/ScenePage.h"

#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/paging/FreedMemory.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <osgGeoFX/viewer/AboveGround.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <CLI/CLI.hpp>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>

namespace
{

constexpr int badInput = 2;
constexpr int tookTooLong = 1;

/// One sentence for the person at the keyboard, and the exit code.
struct Failure : public std::runtime_error
{
    Failure(int code, const std::string& sentence) : std::runtime_error(sentence), exitCode(code) {}
    int exitCode;
};

struct Arguments
{
    std::string scene;
    std::string output;
    std::string size = "1600x900";
    geofx::render::CameraOptions camera;
    std::string stats;
    std::string plan;
    double fieldOfView = 0.0;
    std::vector<std::string> effects;
    std::vector<std::string> cities;
    geofx::mappings::Options mappings;
    geofx::names::Options names;
    geofx::layers::Options layers;
    geofx::web::Options web;
    geofx::print::Options print;
    bool inset = false;
    std::string insetCorner = "lower-right";
    bool sky = false;
    bool noCull = false;
    geofx::render::Values values;
    bool noCompensation = false;
    bool debugBounds = false;
    bool allowOutside = false;
    osgGeoFX::SceneRenderer::Options renderer;
};

void addOptions(CLI::App& app, Arguments& arguments)
{
    using Platform = osgGeoFX::SceneRenderer::Platform;
    app.add_option("scene", arguments.scene, "Any file that OpenSceneGraph reads, or a .geofx scene")
        ->required()
        ->type_name("SCENE");
    app.add_option(
           "-o,--output", arguments.output,
           "Picture to write; its extension names the format (png, jpg, tiff, …; pdf with names and lines as "
           "vectors). With --path a pattern "
           "such as f%04d.png")
        ->required()
        ->type_name("FILE");
    app.add_option("--size", arguments.size,
                   "Size of the picture: in pixels, or on paper, such as A1@300dpi, A3-portrait@300dpi, "
                   "Letter, 90x60cm@200dpi")
        ->type_name("WxH|PAPER@DPI")
        ->capture_default_str();
    app.add_option("--fov", arguments.fieldOfView,
                   "Vertical field of view in degrees (default: the scene's, or 30)")
        ->type_name("DEG");

    auto* view =
        app.add_option("--view", arguments.camera.view,
                       "Camera on the ground's terms: degrees; metres above the database's zero height; "
                       "heading clockwise from north; pitch negative downwards; roll positive with the "
                       "right wing down")
            ->type_name("LON,LAT,HEIGHT,HEADING,PITCH[,ROLL]");
    auto* eye = app.add_option("--eye", arguments.camera.eye, "Camera in world coordinates: where it is")
                    ->type_name("X,Y,Z")
                    ->excludes(view);
    auto* look = app.add_option("--look", arguments.camera.look, "… the point that it looks at")
                     ->type_name("X,Y,Z")
                     ->needs(eye);
    eye->needs(look);
    app.add_option("--up", arguments.camera.up, "… its upward direction (default: away from the ground)")
        ->type_name("X,Y,Z")
        ->needs(eye);
    auto* path =
        app.add_option("--path", arguments.camera.path,
                       "Camera along a way: CSV with the header time,lon,lat,alt,heading,pitch[,roll], or a "
                       "path that a viewer has recorded (osgviewer: z)")
            ->type_name("FILE.csv|FILE.path")
            ->excludes(view)
            ->excludes(eye);
    app.add_option("--frames", arguments.camera.frames,
                   "… the number of pictures, evenly in time; or with --fps, those from A to B alone, "
                   "counted from 0")
        ->type_name("N|A-B")
        ->needs(path);
    app.add_option("--fps", arguments.camera.framesASecond, "… pictures for each second of the path")
        ->type_name("N")
        ->check(CLI::PositiveNumber)
        ->needs(path);
    geofx::plan::addOption(app, arguments.plan);

    app.add_option(
           "--effect", arguments.effects,
           "Add an effect to the scene's: KIND PROPERTY=VALUE …, in one word; --help-effects lists kinds and "
           "properties, which are the scene file's. As often as wanted")
        ->type_name("'KIND …'")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    // What CLI11 has for a version is a text that takes the place of everything else.
    app.set_version_flag("--help-effects", osgGeoFX::effectsHelp,
                         "List the effects with all their properties");
    app.add_option(
           "--city", arguments.cities,
           "A city model of others to add, in the scene's coordinates; each building keeps its shape in "
           "bends. As often as wanted")
        ->expected(1)
        ->allow_extra_args(false)
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    geofx::mappings::addOptions(app, arguments.mappings);
    geofx::names::addOptions(app, arguments.names);
    arguments.values.addOptions(app);
    geofx::layers::addOptions(app, arguments.layers);
    geofx::web::addOptions(app, arguments.web);
    geofx::print::addOptions(app, arguments.print);
    app.add_flag("--inset", arguments.inset,
                 "Put the same view without effects, a quarter as wide, into a corner");
    app.add_option("--inset-corner", arguments.insetCorner,
                   "Which corner: lower-right, lower-left, upper-left or upper-right")
        ->check(CLI::IsMember({"lower-right", "lower-left", "upper-left", "upper-right"}))
        ->needs("--inset")
        ->capture_default_str();
    app.add_flag("--sky", arguments.sky,
                 "Put a sky around the Earth in place of the plain background (geocentric scenes)");
    app.add_flag("--no-compensation", arguments.noCompensation,
                 "Cull as if nothing were deformed, to see what that would draw");
    app.add_flag("--debug-bounds", arguments.debugBounds, "Draw the deformed bounds that culling decides on");
    app.add_flag("--no-cull", arguments.noCull, "Switch frustum and small-feature culling off");
    app.add_flag("--allow-outside", arguments.allowOutside,
                 "Let a .geofx scene or a KML file name files outside its own folder, and addresses");
    app.add_option("--samples", arguments.renderer.samples, "Samples per pixel (multisampling)")
        ->type_name("N")
        ->check(CLI::Range(0u, 64u))
        ->capture_default_str();
    app.add_flag("--wait-for-tiles,!--no-wait-for-tiles", arguments.renderer.waitForTiles,
                 "Wait until every tile that the picture needs is there (the default), or do not");
    app.add_option("--timeout", arguments.renderer.timeout,
                   "Longest wait for the scene's files, and for each picture, in seconds")
        ->type_name("S")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    auto* stats =
        app.add_option(
               "--stats", arguments.stats,
               "Write figures as JSON: for each picture cull_ms, draw_ms (with reading it back), total_ms, "
               "triangles, drawables, tiles_drawn, tiles_loaded, bytes_read; once renderer, gl_version, "
               "peak_memory_bytes, size, samples")
            ->type_name("FILE.json");
    app.add_flag("--least-triangles", arguments.renderer.leastTriangles,
                 "With --stats: also least_triangles, how few would show the terrain within its pixel error; "
                 "reads the "
                 "whole database, which takes a while")
        ->needs(stats);
    const std::map<std::string, Platform> platforms = {{"egl", Platform::Egl}, {"x11", Platform::X11}};
    app.add_option("--platform", arguments.renderer.platform, "egl needs no X server (the default); or x11")
        ->transform(CLI::CheckedTransformer(platforms).description("egl|x11"));
    app.footer(
        "Without --view, --eye or --path the scene's home view is taken, or one that shows the whole scene. "
        "The same command gives the same bytes.\n"
        "Exit code: 0; 1 if tiles or files did not arrive in time, or could not be read (the picture is "
        "coarser then); 2 if the input, the output or the "
        "machine's "
        "OpenGL is at fault.\n\n"
        "Examples:\n"
        "  osggeofx_render oahu.geofx -o oahu.png\n"
        "  osggeofx_render terrain.osgb -o ridge.jpg --size 1920x1080 --view -157.86,21.27,900,45,-8\n"
        "  osggeofx_render oahu.geofx -o bird.png --view -157.95,21.2,5000,20,-45 --effect 'birdsEyeView "
        "focusLine=0.4 horizonLine=0.85'\n"
        "  osggeofx_render oahu.geofx -o f%04d.png --path flight.csv --frames 240 --stats flight.json\n"
        "  osggeofx_render oahu.geofx -o f%05d.png --path saved_animation.path --fps 25 --plan film\n"
        "  osggeofx_render oahu.geofx -o fire.png --mapping fire.kmz --mapping rain.tif --colors rain.sld\n"
        "  osggeofx_cluster make film | make -j 8 -f -");
}

osgGeoFX::PrintSize readSize(Arguments& arguments)
{
    std::string error;
    const auto size = osgGeoFX::PrintSize::parse(arguments.size, error);
    if (!size) throw Failure(badInput, "--size " + error);
    arguments.renderer.width = size->width;
    arguments.renderer.height = size->height;
    return *size;
}

void addEffects(const Arguments& arguments, osgGeoFX::EffectScene& scene)
{
    for (const std::string& text : arguments.effects)
    {
        std::string error;
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::parseEffect(text, error);
        if (!effect) throw Failure(badInput, "--effect: " + error);
        scene.addEffect(effect);
    }
    scene.setCompensation(!arguments.noCompensation);
    scene.setDebugBounds(arguments.debugBounds);
}

/// The picture of a camera without effects, small, in a corner of the one with them.
void addInset(const std::string& corner, osg::Image& image, osgGeoFX::SceneRenderer& renderer,
              const geofx::render::Camera& camera, unsigned int frame, osgGeoFX::EffectScene& scene)
{
    std::vector<bool> enabled;
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        enabled.push_back(scene.getEffect(i)->getEnabled());
        scene.getEffect(i)->setEnabled(false);
    }
    std::string error;
    osgGeoFX::FrameStatistics unused;
    const osg::ref_ptr<osg::Image> straight =
        renderer.render(camera.view(frame), camera.time(frame), unused, error);
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
        scene.getEffect(i)->setEnabled(enabled[i]);
    if (!straight) throw Failure(tookTooLong, error);

    const int width = std::max(image.s() / 4, 1);
    const int height = std::max(image.t() / 4, 1);
    straight->scaleImage(width, height, 1);
    const int margin = std::max(image.s() / 80, 1);
    const int frameWidth = std::max(image.s() / 600, 1);
    const int left =
        corner.find("left") != std::string::npos ? margin : std::max(image.s() - width - margin, 0);
    const int low =
        corner.find("upper") != std::string::npos ? std::max(image.t() - height - margin, 0) : margin;
    for (int y = low - frameWidth; y < low + height + frameWidth; ++y)
    {
        for (int x = left - frameWidth; x < left + width + frameWidth; ++x)
        {
            if (x < 0 || y < 0 || x >= image.s() || y >= image.t()) continue;
            image.setColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f), static_cast<unsigned int>(x),
                           static_cast<unsigned int>(y));
        }
    }
    image.copySubImage(left, low, 0, straight);
}

/// What a print shows, for its metadata: JSON with the scene, its effects, and the camera, in world coordinates and, where the scene has
/// a georeference, on the ground's terms.
std::string describe(const Arguments& arguments, const osgGeoFX::Scene& scene, const osg::Matrixd& view)
{
    nlohmann::json json = {{"scene", arguments.scene},
                           {"effects", arguments.effects},
                           {"fieldOfView", arguments.renderer.fieldOfView},
                           {"viewMatrix", std::vector<double>(view.ptr(), view.ptr() + 16)}};
    osg::Vec3d eye, at, up;
    view.getLookAt(eye, at, up);
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    if (scene.reference && scene.reference->toGeodetic(eye, longitude, latitude, height))
        json["eye"] = {{"longitude", osg::RadiansToDegrees(longitude)},
                       {"latitude", osg::RadiansToDegrees(latitude)},
                       {"height", height}};
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// The files that pictures are made of.
std::string madeOf(const Arguments& arguments)
{
    return arguments.scene + geofx::names::ageOf(arguments.scene) + "; " + arguments.camera.path +
           geofx::names::ageOf(arguments.camera.path) + geofx::mappings::agesOf(arguments.mappings) +
           geofx::names::agesOf(arguments.names);
}

/// About how long a picture takes on one core without a GPU, seconds.
double secondsOf(const osgGeoFX::SceneRenderer::Options& options)
{
    const double pixels = static_cast<double>(options.width) * options.height;
    return 0.3 + 1e-6 * pixels * (0.3 + 0.1 * options.samples);
}

/// A picture that is larger than the GPU draws at once, or has a resolution.
void print(const Arguments& arguments, const osgGeoFX::PrintSize& size, geofx::names::PictureMap& map,
           const osg::Matrixd& view, osgGeoFX::Scene& scene, const geofx::web::ScenePage* page,
           const geofx::plan::Division& division)
{
    if (!arguments.camera.path.empty() || arguments.inset || !arguments.stats.empty())
        throw Failure(
            badInput,
            "A picture with a resolution, of more than 4096 pixels or 8 bits, an exr or a pdf is drawn in "
            "tiles, "
            "without --path, --inset and --stats; leave them out, or take another --size, --bits or -o.");
    const std::string raster = geofx::names::PictureMap::rasterOf(arguments.output);
    osgGeoFX::PicturePrint::Options options;
    options.size = size;
    options.bits = arguments.print.bits;
    options.renderer = arguments.renderer;
    options.names = map.names();
    options.work = division.any() ? division.tileFolder() : geofx::print::tileFolderOf(arguments.output);
    options.recipe = arguments.scene + geofx::names::ageOf(arguments.scene) +
                     geofx::mappings::agesOf(arguments.mappings) + geofx::names::agesOf(arguments.names) +
                     map.digest() + std::filesystem::path(raster).filename().string();
    for (const std::string& effect : arguments.effects)
        options.recipe += "; " + effect;
    options.metadata = {{"Software", "osgGeoFX osggeofx_render"},
                        {"ImageDescription", describe(arguments, scene, view)}};
    if (page) options.plain = page->plain();
    const auto putTogether = [&]
    {
        osgGeoFX::PicturePrint::Options whole = options;
        map.prepare(whole, view);
        std::string error;
        if (!osgGeoFX::PicturePrint::write(scene, whole, view, raster, error)) throw Failure(badInput, error);
        map.writeFiles();
        if (page) page->write(scene, arguments.renderer, view, map.names());
        geofx::layers::write(arguments.layers, scene, size, arguments.renderer, map, view);
    };
    if (!division.any())
    {
        const geofx::print::TileFolder folder(arguments.output);
        putTogether();
        return;
    }
    std::string error;
    auto tiles = osgGeoFX::PicturePrint::create(scene, options, view, raster, error);
    if (!tiles) throw Failure(badInput, error);
    const double seconds = secondsOf(arguments.renderer);
    division.run(
        geofx::plan::printStages(std::move(tiles), osgGeoFX::PicturePrint::countTiles(options), putTogether),
        madeOf(arguments), {seconds, 0.2 * seconds});
}

/// What is asked for together and cannot be had, or cannot be written.
void check(const Arguments& arguments, const geofx::plan::Division& division, const osgGeoFX::PrintSize& size)
{
    const std::string bitsFault = geofx::print::faultOf(arguments.print, arguments.output);
    if (!bitsFault.empty()) throw Failure(badInput, bitsFault);
    arguments.values.check();
    const bool film = !arguments.camera.path.empty();
    if (arguments.layers.any() && (film || arguments.inset))
        throw Failure(
            badInput,
            "--layers and --mesh are for one picture as it is drawn; leave --path and --inset out.");
    if (arguments.values.any() && (film || geofx::print::isPrint(arguments.print, arguments.output, size)))
        throw Failure(
            badInput,
            "--values is for one picture that is drawn at once; leave --path out, and take a --size in "
            "pixels, up to 4096, with --bits 8.");
    if (arguments.web.wanted() && film)
        throw Failure(badInput, "--web shows one picture; leave --path out, or --web.");
    if (division.any() && !film && !geofx::print::isPrint(arguments.print, arguments.output, size))
        throw Failure(badInput,
                      "--plan is for what has parts: a film along a --path, or a print, whose --size "
                      "is large or has a resolution; leave it out, or add one of these.");
    if (division.any() && (!arguments.stats.empty() || arguments.layers.any() || arguments.web.wanted()))
        throw Failure(badInput,
                      "--stats, --layers, --mesh and --web are for pictures that one process draws; "
                      "leave them out, or --plan.");
    const std::string statsFault = arguments.stats.empty() ? std::string() : faultOfOutput(arguments.stats);
    if (!statsFault.empty()) throw Failure(badInput, statsFault);
    const std::string mapFault = geofx::names::faultOf(arguments.names, arguments.scene);
    if (!mapFault.empty()) throw Failure(badInput, mapFault);
    for (const std::string& file : {arguments.names.svg, arguments.names.geoJson})
    {
        const std::string outputFault = file.empty() ? std::string() : faultOfOutput(file);
        if (!outputFault.empty()) throw Failure(badInput, outputFault);
    }
    if (film && !(arguments.names.svg + arguments.names.geoJson).empty())
        throw Failure(badInput, "--svg and --geojson are for one picture; leave --path out.");
}

/// Makes sure that nothing which is read is written over. Pictures of a film are left to claimFilm().
osgGeoFX::InputFiles claimOutputs(const Arguments& arguments, const osgGeoFX::PrintSize& size)
{
    osgGeoFX::InputFiles inputs = geofx::names::makeInputFiles();
    inputs.add(arguments.scene);
    inputs.add(arguments.camera.path);
    for (const std::string& city : arguments.cities)
        inputs.add(city);
    geofx::mappings::addInputs(arguments.mappings, inputs);
    geofx::names::addInputs(arguments.names, inputs);
    if (arguments.camera.path.empty()) geofx::names::PictureMap::claimOutput(arguments.output, inputs);
    if (!arguments.stats.empty()) inputs.claim("The file of figures", arguments.stats, "--stats");
    if (!arguments.values.series.empty()) inputs.claim("The table", arguments.values.series, "--series");
    geofx::names::claimOutputs(arguments.names, inputs);
    geofx::layers::claimOutputs(arguments.layers, inputs);
    geofx::web::claimOutputs(arguments.web, inputs);
    if (geofx::print::isPrint(arguments.print, arguments.output, size))
        geofx::print::claimTileFolder(arguments.output, inputs);
    return inputs;
}

/// Claims the pictures of a film.
void claimFilm(const PictureFiles& files, const geofx::render::Camera& camera, osgGeoFX::InputFiles& inputs)
{
    for (unsigned int frame = camera.first(); frame <= camera.last(); ++frame)
        inputs.claim("The picture", files.nameOf(frame), "-o");
}

/// One picture, or those of a film.
class Pictures
{
public:
    Pictures(const Arguments& arguments, osgGeoFX::Scene& scene, const geofx::render::Camera& camera,
             geofx::names::PictureMap& map, PictureFiles& files, geofx::web::ScenePage* page)
        : _arguments(arguments), _scene(scene), _camera(camera), _map(map), _files(files), _page(page)
    {
        _map.prepare();
    }

    void draw(unsigned int frame)
    {
        start();
        osgGeoFX::FrameStatistics figures;
        std::string error;
        const auto image = _renderer->render(_camera.view(frame), _camera.time(frame), figures, error);
        if (!image) throw Failure(tookTooLong, error);
        sayIfBuried(frame);
        _map.draw(_renderer->camera(), *image,
                  [&](const osg::Image& plain)
                  {
                      if (_page) _page->setPicture(plain);
                  });
        if (_arguments.inset)
            addInset(_arguments.insetCorner, *image, *_renderer, _camera, frame, *_scene.effects);
        if (!_files.write(*image, frame)) throw Failure(badInput, _files.error());
        _map.writeFiles();
        _statistics->add(figures);
    }
    void writeStatistics()
    {
        if (_arguments.stats.empty() || _statistics->write(_arguments.stats)) return;
        throw Failure(badInput, "The figures cannot be written to \"" + _arguments.stats +
                                    "\"; check the folder, its permissions and the disk's space.");
    }

    void printValues() const
    {
        if (_renderer) _arguments.values.print(_scene, _renderer->camera());
    }

private:
    /// A sentence for the first picture whose eye is below the ground.
    void sayIfBuried(unsigned int frame)
    {
        constexpr double least = 0.5; // metres: ground is drawn with an error
        if (_buried || !_scene.effects->getTerrain() || isPanorama()) return;
        const double rise =
            osgGeoFX::AboveGround::rise(*_scene.effects, _camera.view(frame), _renderer->camera(), 0.0);
        if (rise < least) return;
        _buried = true;
        std::cerr << "osggeofx_render: the camera's eye is " << std::lround(rise)
                  << " m below the ground, so the picture shows the ground from below; raise the eye by that "
                     "much or more."
                  << std::endl;
    }
    /// The eye of a panorama map is no place.
    bool isPanorama() const
    {
        for (unsigned int i = 0; i < _scene.effects->getNumEffects(); ++i)
            if (dynamic_cast<const osgGeoFX::PanoramaMap*>(_scene.effects->getEffect(i))) return true;
        return false;
    }

    void start()
    {
        if (_renderer) return;
        std::string error;
        _renderer = osgGeoFX::SceneRenderer::create(_scene, _arguments.renderer, error);
        if (!_renderer) throw Failure(badInput, error);
        _statistics.emplace(*_renderer, _arguments.renderer);
    }

    const Arguments& _arguments;
    osgGeoFX::Scene& _scene;
    const geofx::render::Camera& _camera;
    geofx::names::PictureMap& _map;
    PictureFiles& _files;
    geofx::web::ScenePage* const _page;
    std::unique_ptr<osgGeoFX::SceneRenderer> _renderer; ///< null until a picture must be drawn
    std::optional<StatisticsFile> _statistics;
    bool _buried = false; ///< whether an eye below the ground was met
};

/// A film by many processes.
void divide(const Arguments& arguments, const geofx::render::Camera& camera, Pictures& pictures,
            const PictureFiles& files, const geofx::plan::Division& division)
{
    const std::size_t count = camera.last() - camera.first() + 1;
    const auto frameOf = [&](std::size_t unit)
    {
        return camera.first() + static_cast<unsigned int>(unit);
    };
    osgGeoFX::WorkStages stages;
    // The folder was empty when the film was planned, so a picture that is there is of this film.
    stages.push_back(std::make_unique<geofx::plan::PictureStage>(
        "frames", count,
        [&](std::size_t unit) { return std::filesystem::exists(files.nameOf(frameOf(unit))); },
        [&](std::size_t unit) { pictures.draw(frameOf(unit)); }));
    stages.push_back(std::make_unique<geofx::plan::PictureStage>(
        "film", 1, [](std::size_t) { return false; },
        [&](std::size_t)
        {
            for (std::size_t unit = 0; unit < count; ++unit)
                if (!std::filesystem::exists(files.nameOf(frameOf(unit))))
                    throw Failure(badInput, files.nameOf(frameOf(unit)) +
                                                ": this picture was drawn and is not there any more; draw it "
                                                "again with --unit frames:" +
                                                std::to_string(unit) + ".");
        }));
    division.run(stages, madeOf(arguments),
                 {secondsOf(arguments.renderer) * static_cast<double>(count), 0.1});
}

void run(Arguments& arguments, const geofx::plan::Division& division, geofx::render::Deadline& deadline)
{
    arguments.renderer.waits = [&](bool waits)
    {
        if (waits)
            deadline.start(arguments.renderer.timeout);
        else
            deadline.stop();
    };
    std::string lack;
    arguments.renderer.lacks = [&](const std::string& fault)
    {
        if (lack.empty()) lack = fault;
    };
    const auto checkData = [&]
    {
        if (!lack.empty()) throw Failure(tookTooLong, lack + " A coarser part stands in its place.");
    };
    arguments.renderer.waits(true);
    if (!arguments.camera.path.empty() && arguments.camera.frames.empty() &&
        !(arguments.camera.framesASecond > 0.0))
        throw Failure(badInput, "--path: say how many pictures there are, with --frames or --fps.");
    std::string error;
    arguments.output = division.outputOf(arguments.output);
    const osgGeoFX::PrintSize size = readSize(arguments);
    PictureFiles files(geofx::names::PictureMap::rasterOf(arguments.output), !arguments.camera.path.empty());
    if (!files.error().empty()) throw Failure(badInput, files.error());
    check(arguments, division, size);
    // Workers write into the folder of their plan, which was empty.
    const bool works = division.any() && !division.plans();
    osgGeoFX::InputFiles inputs;
    if (!works) inputs = claimOutputs(arguments, size);
    geofx::layers::check(arguments.layers);
    std::optional<geofx::web::ScenePage> page;
    if (arguments.web.wanted()) page.emplace(arguments.web, arguments.output);

    const osg::ref_ptr<osgDB::Options> reading =
        new osgDB::Options(arguments.allowOutside ? "allowOutside" : "");
    std::optional<osgGeoFX::Scene> scene =
        osgGeoFX::Scene::load(arguments.scene, error, arguments.allowOutside ? reading.get() : nullptr);
    if (!scene) throw Failure(badInput, error);
    for (const std::string& city : arguments.cities)
        if (!scene->addCity(city, error, arguments.allowOutside ? reading.get() : nullptr))
            throw Failure(badInput, "--city: " + error);
    if (arguments.sky && !scene->addSky(error)) throw Failure(badInput, "--sky: " + error);
    addEffects(arguments, *scene->effects);
    std::vector<std::string> notices;
    geofx::mappings::show(arguments.mappings, arguments.allowOutside, *scene, notices);
    for (const std::string& notice : notices)
        std::cerr << "osggeofx_render: " << notice << std::endl;
    scene->effects->listenTo(*scene->guard);
    osgGeoFX::SceneRenderer::Options& options = arguments.renderer;
    options.fieldOfView =
        arguments.fieldOfView != 0.0 ? arguments.fieldOfView : scene->settings.homeFov.value_or(30.0);
    if (!(options.fieldOfView > 0.0 && options.fieldOfView < 180.0))
    {
        throw Failure(badInput, "--fov must lie between 0 and 180 degrees.");
    }
    options.cull = !arguments.noCull;
    options.countTriangles = !arguments.stats.empty();
    const geofx::render::Camera camera(arguments.camera, *scene, options.fieldOfView,
                                       static_cast<double>(options.width) / options.height);
    if (!works && !arguments.camera.path.empty()) claimFilm(files, camera, inputs);
    geofx::names::PictureMap map(arguments.names, arguments.output, size, *scene,
                                 !arguments.layers.folder.empty());
    for (const std::string& notice : map.notices())
        std::cerr << "osggeofx_render: " << notice << std::endl;
    arguments.renderer.waits(false);
    if (geofx::print::isPrint(arguments.print, arguments.output, size))
    {
        print(arguments, size, map, camera.view(0), *scene, page ? &*page : nullptr, division);
        checkData();
        return;
    }
    {
        Pictures pictures(arguments, *scene, camera, map, files, page ? &*page : nullptr);
        if (division.any())
        {
            divide(arguments, camera, pictures, files, division);
            checkData();
            return;
        }
        for (unsigned int frame = camera.first(); frame <= camera.last(); ++frame)
            pictures.draw(frame);
        if (page) page->write(*scene, options, camera.view(0), map.names());
        pictures.writeStatistics();
        pictures.printValues();
    }
    geofx::layers::write(arguments.layers, *scene, size, options, map, camera.view(0));
    checkData();
}

} // namespace

int main(int argc, char** argv)
{
    const osgGeoFX::FreedMemory freed;
    geofx::render::Deadline deadline("osggeofx_render", tookTooLong);
    Arguments arguments;
    CLI::App app(
        "Renders an OSG file or .geofx scene to a picture, or to one for each step of a camera path, "
        "without a screen.",
        "osggeofx_render");
    addOptions(app, arguments);
    try
    {
        int exitCode = 0;
        std::optional<geofx::plan::Call> call = geofx::plan::callOf("osggeofx_render", argc, argv, exitCode);
        if (!call) return exitCode;
        // CLI11 takes them from the last one on.
        app.parse(std::vector<std::string>(call->arguments.rbegin(), call->arguments.rend()));
        run(arguments,
            call->units ? *call->units
                        : geofx::plan::Division("osggeofx_render", call->arguments, arguments.plan),
            deadline);
    }
    catch (const CLI::ParseError& error)
    {
        return geofx::exitCodeOf(app, error);
    }
    catch (const Failure& failure)
    {
        std::cerr << "osggeofx_render: " << failure.what() << std::endl;
        return failure.exitCode;
    }
    catch (const std::exception& fault)
    {
        std::cerr << "osggeofx_render: " << fault.what() << std::endl;
        return badInput;
    }
    return 0;
}
