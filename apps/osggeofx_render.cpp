// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// osggeofx_render: an OSG file or .geofx scene to pictures, off-screen.
#include "layers/SceneLayers.h"
#include "names/PictureMap.h"
#include "osggeofx_render_output.h"
#include "print/PrintOptions.h"
#include "web/ScenePage.h"

#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <osgGeoFX/viewer/CameraPath.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <CLI/CLI.hpp>
#include <osg/Math>

#include <algorithm>
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
    std::string view;
    std::string eye;
    std::string look;
    std::string up;
    std::string path;
    std::string stats;
    double fieldOfView = 0.0;
    unsigned int frames = 0;
    std::vector<std::string> effects;
    geofx::names::Options names;
    geofx::layers::Options layers;
    geofx::web::Options web;
    geofx::print::Options print;
    bool inset = false;
    bool sky = false;
    bool noCull = false;
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
                   "90x60cm@200dpi")
        ->type_name("WxH|PAPER@DPI")
        ->capture_default_str();
    app.add_option("--fov", arguments.fieldOfView,
                   "Vertical field of view in degrees (default: the scene's, or 30)")
        ->type_name("DEG");

    auto* view =
        app.add_option("--view", arguments.view,
                       "Camera on the ground's terms: degrees; metres above the database's zero height; "
                       "heading clockwise from north; pitch negative downwards; roll positive with the "
                       "right wing down")
            ->type_name("LON,LAT,HEIGHT,HEADING,PITCH[,ROLL]");
    auto* eye = app.add_option("--eye", arguments.eye, "Camera in world coordinates: where it is")
                    ->type_name("X,Y,Z")
                    ->excludes(view);
    auto* look = app.add_option("--look", arguments.look, "… the point that it looks at")
                     ->type_name("X,Y,Z")
                     ->needs(eye);
    eye->needs(look);
    app.add_option("--up", arguments.up, "… its upward direction (default: away from the ground)")
        ->type_name("X,Y,Z")
        ->needs(eye);
    auto* path =
        app.add_option("--path", arguments.path,
                       "Camera along a way: CSV with the header time,lon,lat,alt,heading,pitch[,roll]")
            ->type_name("FILE.csv")
            ->excludes(view)
            ->excludes(eye);
    auto* frames = app.add_option("--frames", arguments.frames, "… the number of pictures, evenly in time")
                       ->type_name("N")
                       ->check(CLI::Range(1u, 1000000u))
                       ->needs(path);
    path->needs(frames);

    app.add_option(
           "--effect", arguments.effects,
           "Add an effect to the scene's: KIND PROPERTY=VALUE …, in one word; --help-effects lists kinds and "
           "properties, which are the scene file's. As often as wanted")
        ->type_name("'KIND …'")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    // What CLI11 has for a version is a text that takes the place of everything else.
    app.set_version_flag("--help-effects", osgGeoFX::effectsHelp,
                         "List the effects with all their properties");
    geofx::names::addOptions(app, arguments.names);
    geofx::layers::addOptions(app, arguments.layers);
    geofx::web::addOptions(app, arguments.web);
    geofx::print::addOptions(app, arguments.print);
    app.add_flag("--inset", arguments.inset,
                 "Put the same view without effects, a quarter as wide, into the lower right corner");
    app.add_flag("--sky", arguments.sky,
                 "Put a sky around the Earth in place of the plain background (geocentric scenes)");
    app.add_flag("--no-compensation", arguments.noCompensation,
                 "Cull as if nothing were deformed, to see what that would draw");
    app.add_flag("--debug-bounds", arguments.debugBounds, "Draw the deformed bounds that culling decides on");
    app.add_flag("--no-cull", arguments.noCull, "Switch frustum and small-feature culling off");
    app.add_flag("--allow-outside", arguments.allowOutside,
                 "Let a .geofx scene name files outside its own folder, and addresses");
    app.add_option("--samples", arguments.renderer.samples, "Samples per pixel (multisampling)")
        ->type_name("N")
        ->check(CLI::Range(0u, 64u))
        ->capture_default_str();
    app.add_flag("--wait-for-tiles,!--no-wait-for-tiles", arguments.renderer.waitForTiles,
                 "Wait until every tile that the picture needs is there (the default), or do not");
    app.add_option("--timeout", arguments.renderer.timeout, "Longest wait for each picture, in seconds")
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
        "Exit code: 0; 1 if tiles did not arrive in time; 2 if the input, the output or the machine's "
        "OpenGL is at fault.\n\n"
        "Examples:\n"
        "  osggeofx_render oahu.geofx -o oahu.png\n"
        "  osggeofx_render terrain.osgb -o ridge.jpg --size 1920x1080 --view -157.86,21.27,900,45,-8\n"
        "  osggeofx_render oahu.geofx -o bird.png --view -157.95,21.2,5000,20,-45 --effect 'birdsEyeView "
        "focusLine=0.4 horizonLine=0.85'\n"
        "  osggeofx_render oahu.geofx -o f%04d.png --path flight.csv --frames 240 --stats flight.json");
}

osg::Vec3d vectorOf(const std::string& option, const std::string& text)
{
    const auto numbers = osgGeoFX::parseNumbers(text);
    if (!numbers || numbers->size() != 3)
    {
        throw Failure(badInput, option + " " + text + ": write three numbers, X,Y,Z.");
    }
    return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
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

/// One view matrix for each picture, and its time.
class Camera
{
public:
    Camera(const Arguments& arguments, const osgGeoFX::Scene& scene) : _scene(scene)
    {
        std::string error;
        if (!arguments.path.empty())
        {
            _path = osgGeoFX::CameraPath::read(arguments.path, error);
            if (!_path) throw Failure(badInput, error);
            _count = arguments.frames;
            requireReference("--path");
        }
        else if (!arguments.view.empty())
        {
            const auto point = osgGeoFX::ViewPoint::parse(arguments.view, error);
            if (!point) throw Failure(badInput, "--view: " + error);
            requireReference("--view");
            _single = matrixOf(*point);
        }
        else if (!arguments.eye.empty())
        {
            lookAt(arguments);
        }
        else
        {
            if (scene.settings.homeView) requireReference("The scene's home view");
            const double aspect = static_cast<double>(arguments.renderer.width) /
                                  static_cast<double>(arguments.renderer.height);
            _single = scene.homeViewMatrix(osg::DegreesToRadians(arguments.renderer.fieldOfView), aspect);
        }
    }

    unsigned int count() const { return _count; }
    double time(unsigned int frame) const { return _path ? _path->timeOfFrame(frame, _count) : 0.0; }
    osg::Matrixd view(unsigned int frame) const { return _path ? matrixOf(_path->at(time(frame))) : _single; }

private:
    void requireReference(const std::string& what) const
    {
        if (!_scene.reference) throw Failure(badInput, what + " cannot be used: " + _scene.referenceError);
    }

    osg::Matrixd matrixOf(const osgGeoFX::ViewPoint& point) const
    {
        osg::Matrixd view;
        if (!point.viewMatrix(*_scene.reference, view))
        {
            throw Failure(badInput,
                          "The camera's longitude and latitude lie outside the scene's projection; move "
                          "it nearer to the terrain.");
        }
        return view;
    }

    void lookAt(const Arguments& arguments)
    {
        const osg::Vec3d eye = vectorOf("--eye", arguments.eye);
        const osg::Vec3d look = vectorOf("--look", arguments.look);
        osg::Vec3d up = arguments.up.empty() ? osg::Vec3d(0.0, 0.0, 1.0) : vectorOf("--up", arguments.up);
        if (arguments.up.empty() && _scene.reference && _scene.reference->isGeocentric())
        {
            up = eye;
        }
        if (((look - eye) ^ up).length2() == 0.0)
        {
            throw Failure(badInput,
                          "--eye, --look and --up do not make a camera: it must not look along its upward "
                          "direction; give another --up.");
        }
        _single = osg::Matrixd::lookAt(eye, look, up);
    }

    const osgGeoFX::Scene& _scene;
    std::optional<osgGeoFX::CameraPath> _path;
    osg::Matrixd _single;
    unsigned int _count = 1;
};

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

/// The picture of a camera without effects, small, in the corner of the one with them.
void addInset(osg::Image& image, osgGeoFX::SceneRenderer& renderer, const Camera& camera, unsigned int frame,
              osgGeoFX::EffectScene& scene)
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
    const int left = std::max(image.s() - width - margin, 0);
    for (int y = margin - frameWidth; y < margin + height + frameWidth; ++y)
    {
        for (int x = left - frameWidth; x < left + width + frameWidth; ++x)
        {
            if (x < 0 || y < 0 || x >= image.s() || y >= image.t()) continue;
            image.setColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f), static_cast<unsigned int>(x),
                           static_cast<unsigned int>(y));
        }
    }
    image.copySubImage(left, margin, 0, straight);
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
    return json.dump();
}

/// A picture that is larger than the GPU draws at once, or has a resolution.
void print(const Arguments& arguments, const osgGeoFX::PrintSize& size, geofx::names::PictureMap& map,
           const osg::Matrixd& view, osgGeoFX::Scene& scene, const geofx::web::ScenePage* page)
{
    if (!arguments.path.empty() || arguments.inset || !arguments.stats.empty())
        throw Failure(
            badInput,
            "A picture with a resolution, of more than 4096 pixels or 8 bits, an exr or a pdf is drawn in "
            "tiles, "
            "without --path, --inset and --stats; leave them out, or take another --size, --bits or -o.");
    osgGeoFX::PicturePrint::Options options;
    options.size = size;
    options.bits = arguments.print.bits;
    options.renderer = arguments.renderer;
    map.prepare(options, view);
    options.work = std::filesystem::path(arguments.output).replace_extension().string() + ".tiles";
    options.recipe = arguments.scene + geofx::names::ageOf(arguments.scene) +
                     geofx::names::agesOf(arguments.names) + map.digest() +
                     geofx::names::PictureMap::rasterOf(arguments.output);
    for (const std::string& effect : arguments.effects)
        options.recipe += "; " + effect;
    options.metadata = {{"Software", "osgGeoFX osggeofx_render"},
                        {"ImageDescription", describe(arguments, scene, view)}};
    if (page) options.plain = page->plain();
    std::string error;
    const std::string raster = geofx::names::PictureMap::rasterOf(arguments.output);
    if (!osgGeoFX::PicturePrint::write(scene, options, view, raster, error)) throw Failure(badInput, error);
    map.finish();
    if (page) page->write(scene, arguments.renderer, view, map.names());
}

void run(Arguments& arguments)
{
    std::string error;
    const osgGeoFX::PrintSize size = readSize(arguments);
    PictureFiles pictures(geofx::names::PictureMap::rasterOf(arguments.output), !arguments.path.empty());
    if (!pictures.error().empty()) throw Failure(badInput, pictures.error());
    const std::string bitsFault = geofx::print::faultOf(arguments.print, arguments.output);
    if (!bitsFault.empty()) throw Failure(badInput, bitsFault);
    geofx::layers::check(arguments.layers);
    if (arguments.layers.any() && (!arguments.path.empty() || arguments.inset))
        throw Failure(
            badInput,
            "--layers and --mesh are for one picture as it is drawn; leave --path and --inset out.");
    if (arguments.web.wanted() && !arguments.path.empty())
        throw Failure(badInput, "--web shows one picture; leave --path out, or --web.");
    std::optional<geofx::web::ScenePage> page;
    if (arguments.web.wanted()) page.emplace(arguments.web, arguments.output);
    const std::string statsFault = arguments.stats.empty() ? std::string() : faultOfOutput(arguments.stats);
    if (!statsFault.empty()) throw Failure(badInput, statsFault);

    const osg::ref_ptr<osgDB::Options> reading =
        new osgDB::Options(arguments.allowOutside ? "allowOutside" : "");
    const std::string mapFault = geofx::names::faultOf(arguments.names, arguments.scene);
    if (!mapFault.empty()) throw Failure(badInput, mapFault);
    for (const std::string& file : {arguments.names.svg, arguments.names.geoJson})
    {
        const std::string outputFault = file.empty() ? std::string() : faultOfOutput(file);
        if (!outputFault.empty()) throw Failure(badInput, outputFault);
    }
    if (!arguments.path.empty() && !(arguments.names.svg + arguments.names.geoJson).empty())
        throw Failure(badInput, "--svg and --geojson are for one picture; leave --path out.");
    std::optional<osgGeoFX::Scene> scene =
        osgGeoFX::Scene::load(arguments.scene, error, arguments.allowOutside ? reading.get() : nullptr);
    if (!scene) throw Failure(badInput, error);
    if (arguments.sky && !scene->addSky(error)) throw Failure(badInput, "--sky: " + error);
    addEffects(arguments, *scene->effects);
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
    const Camera camera(arguments, *scene);
    geofx::names::PictureMap map(arguments.names, arguments.output, size, *scene,
                                 !arguments.layers.folder.empty());
    for (const std::string& notice : map.notices())
        std::cerr << "osggeofx_render: " << notice << std::endl;
    if (geofx::print::isPrint(arguments.print, arguments.output, size))
    {
        print(arguments, size, map, camera.view(0), *scene, page ? &*page : nullptr);
        geofx::layers::write(arguments.layers, *scene, size, options, map, camera.view(0));
        return;
    }
    map.prepare();

    auto renderer = osgGeoFX::SceneRenderer::create(*scene, options, error);
    if (!renderer) throw Failure(badInput, error);
    StatisticsFile statistics(*renderer, options);
    for (unsigned int frame = 0; frame < camera.count(); ++frame)
    {
        osgGeoFX::FrameStatistics figures;
        const auto image = renderer->render(camera.view(frame), camera.time(frame), figures, error);
        if (!image) throw Failure(tookTooLong, error);
        map.finish(renderer->camera(), *image,
                   [&](const osg::Image& plain)
                   {
                       if (page) page->setPicture(plain);
                   });
        if (arguments.inset) addInset(*image, *renderer, camera, frame, *scene->effects);
        if (!pictures.write(*image, frame)) throw Failure(badInput, pictures.error());
        statistics.add(figures);
    }
    if (page) page->write(*scene, options, camera.view(0), map.names());
    if (!arguments.stats.empty() && !statistics.write(arguments.stats))
    {
        throw Failure(badInput, "The figures cannot be written to \"" + arguments.stats +
                                    "\"; check the folder, its permissions and the disk's space.");
    }
    renderer.reset();
    geofx::layers::write(arguments.layers, *scene, size, options, map, camera.view(0));
}

} // namespace

int main(int argc, char** argv)
{
    Arguments arguments;
    CLI::App app(
        "Renders an OSG file or .geofx scene to a picture, or to one for each step of a camera path, "
        "without a screen.",
        "osggeofx_render");
    addOptions(app, arguments);
    try
    {
        app.parse(argc, argv);
        run(arguments);
    }
    catch (const CLI::Success& help)
    {
        return app.exit(help);
    }
    catch (const CLI::ParseError& error)
    {
        std::cerr << "osggeofx_render: " << error.what() << "; see --help." << std::endl;
        return badInput;
    }
    catch (const Failure& failure)
    {
        std::cerr << "osggeofx_render: " << failure.what() << std::endl;
        return failure.exitCode;
    }
    catch (const std::runtime_error& fault)
    {
        std::cerr << "osggeofx_render: " << fault.what() << std::endl;
        return badInput;
    }
    return 0;
}
