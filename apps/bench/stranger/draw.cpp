// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// geofx_bench_draw: draws one view of a file of any terrain engine that OSG has a plugin for, and tells as JSON what it
// took. osggeofx_bench runs it once for each engine, so that neither shares memory, caches or settings with the other.
#include "bench/BenchError.h"
#include "bench/Figure.h"
#include "bench/SingleMesh.h"

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/viewer/Scene.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/GLExtensions>
#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgViewer/Viewer>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <thread>

namespace
{

using geofx::bench::BenchError;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Engines that ask OSG for a context of their own get one without a window.
struct Windowless : public osg::GraphicsContext::WindowingSystemInterface
{
    unsigned int getNumScreens(const osg::GraphicsContext::ScreenIdentifier&) override { return 1; }
    void getScreenSettings(const osg::GraphicsContext::ScreenIdentifier&,
                           osg::GraphicsContext::ScreenSettings& settings) override
    {
        settings = osg::GraphicsContext::ScreenSettings(1920, 1080, 60.0, 24);
    }
    bool setScreenSettings(const osg::GraphicsContext::ScreenIdentifier&,
                           const osg::GraphicsContext::ScreenSettings&) override
    {
        return false;
    }
    void enumerateScreenSettings(const osg::GraphicsContext::ScreenIdentifier&,
                                 osg::GraphicsContext::ScreenSettingsList&) override
    {
    }
    osg::GraphicsContext* createGraphicsContext(osg::GraphicsContext::Traits* traits) override
    {
        osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
        return context->valid() ? context.release() : nullptr;
    }
};

/// Counts what a frame sends through the pipeline, whoever sends it, and keeps its picture and what it covers.
struct Frame
{
    GLuint query = 0;
    std::uint64_t triangles = 0;
    bool keep = false;
    osg::ref_ptr<osg::Image> picture = new osg::Image;
    osg::ref_ptr<osg::Image> depth = new osg::Image;
};

constexpr GLenum primitivesGenerated = 0x8C87;

struct Begin : public osg::Camera::DrawCallback
{
    explicit Begin(Frame& of) : frame(of) {}
    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo& info) const override
    {
        auto* gl = info.getState()->get<osg::GLExtensions>();
        if (!frame.query) gl->glGenQueries(1, &frame.query);
        gl->glBeginQuery(primitivesGenerated, frame.query);
    }
    Frame& frame;
};

struct End : public osg::Camera::DrawCallback
{
    explicit End(Frame& of) : frame(of) {}
    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo& info) const override
    {
        auto* gl = info.getState()->get<osg::GLExtensions>();
        gl->glEndQuery(primitivesGenerated);
        glFinish();
        if (!frame.keep) return;
        GLuint count = 0;
        gl->glGetQueryObjectuiv(frame.query, GL_QUERY_RESULT_ARB, &count);
        frame.triangles = count;
        const osg::Viewport& port = *info.getCurrentCamera()->getViewport();
        const int width = static_cast<int>(port.width()), height = static_cast<int>(port.height());
        frame.picture->readPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE);
        frame.depth->readPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    }
    Frame& frame;
};

struct Task
{
    std::string file, single, behind, image, mask;
    std::vector<double> view; ///< degrees and metres
    std::vector<int> size{1089, 690};
    double fieldOfView = 40.0; ///< degrees
    double still = 2.0;        ///< seconds without a change
    double patience = 300.0;   ///< seconds
    int frames = 30;
};

/// World to eye, of a place on the Earth.
osg::Matrixd viewMatrix(const std::vector<double>& place)
{
    const osg::ref_ptr<osg::EllipsoidModel> earth = new osg::EllipsoidModel;
    osg::Matrixd frame;
    earth->computeLocalToWorldTransformFromLatLongHeight(osg::DegreesToRadians(place[1]),
                                                         osg::DegreesToRadians(place[0]), place[2], frame);
    const osg::Matrixd turn = osg::Matrixd::rotate(osg::DegreesToRadians(90.0 + place[4]), osg::X_AXIS) *
                              osg::Matrixd::rotate(-osg::DegreesToRadians(place[3]), osg::Z_AXIS);
    return osg::Matrixd::inverse(turn * frame);
}

struct Loaded
{
    osg::ref_ptr<osg::Node> node;
    double lodScale = 1.0;
};

Loaded load(const Task& task)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    Loaded result{root, 1.0};
    if (!task.single.empty()) root->addChild(geofx::bench::readAsSingleMesh(task.single));
    for (const std::string& file : {task.file, task.behind})
    {
        if (file.empty()) continue;
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file);
        if (!node)
            throw BenchError(file + ": OSG cannot read it; is the folder of its plugin in OSG_LIBRARY_PATH?");
        root->addChild(node);
        // Databases of the kit hold for the screen that they name.
        std::string error;
        if (file.size() < 5 || file.substr(file.size() - 5) != ".osgb") continue;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(file, error);
        if (scene && scene->terrain)
            result.lodScale = osgGeoFX::lodScaleFor(
                *scene->terrain,
                osgGeoFX::pixelsPerRadian(task.size[1], osg::DegreesToRadians(task.fieldOfView)));
    }
    // The same light for all: none.
    osg::StateSet& state = *root->getOrCreateStateSet();
    state.setMode(GL_LIGHTING, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE);
    return result;
}

double memory(const char* entry)
{
    std::ifstream status("/proc/self/status");
    std::string word;
    double kibibytes = 0.0;
    while (status >> word)
    {
        if (word == entry) status >> kibibytes;
    }
    return kibibytes / 1024.0;
}

nlohmann::ordered_json draw(const Task& task)
{
    const auto start = Clock::now();
    osg::GraphicsContext::getWindowingSystemInterfaces()->getInterfaces().insert(
        osg::GraphicsContext::getWindowingSystemInterfaces()->getInterfaces().begin(), new Windowless);
    const Loaded loaded = load(task);

    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = task.size[0];
    traits->height = task.size[1];
    const osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
    if (!context->valid()) throw BenchError("Nothing can be drawn: " + context->error());
    // As osgEarth's own programs set it, which draws by these uniforms.
    const bool modern = !task.file.empty() && task.file.find(".earth") != std::string::npos;
    if (modern)
    {
        osg::State& state = *context->getState();
        state.resetVertexAttributeAlias(false);
        state.setUseModelViewAndProjectionUniforms(true);
        state.setUseVertexAttributeAliasing(true);
    }

    Frame frame;
    osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer->setLightingMode(osg::View::NO_LIGHT);
    osg::Camera& camera = *viewer->getCamera();
    camera.setGraphicsContext(context);
    camera.setViewport(0, 0, task.size[0], task.size[1]);
    camera.setClearColor({0.7f, 0.8f, 0.9f, 1.0f});
    camera.setProjectionMatrixAsPerspective(task.fieldOfView,
                                            static_cast<double>(task.size[0]) / task.size[1], 1.0, 1e7);
    camera.setNearFarRatio(0.00002);
    camera.setLODScale(static_cast<float>(loaded.lodScale));
    camera.setViewMatrix(viewMatrix(task.view));
    camera.setInitialDrawCallback(new Begin(frame));
    camera.setFinalDrawCallback(new End(frame));
    viewer->setSceneData(loaded.node);
    viewer->realize();
    const osg::Matrixd projection = camera.getProjectionMatrix();

    const auto draw = [&]
    {
        camera.setProjectionMatrix(projection);
        viewer->frame();
    };
    // Until the picture stays as it is. The first one that looks so is the first complete one.
    frame.keep = true;
    std::vector<unsigned char> last;
    double changed = 0.0;
    do
    {
        draw();
        const unsigned char* pixels = frame.picture->data();
        const std::vector<unsigned char> now(pixels, pixels + frame.picture->getTotalSizeInBytes());
        if (now != last)
        {
            changed = secondsSince(start);
            last = now;
        }
        // Loading has the processor to itself.
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (secondsSince(start) > task.patience)
            throw BenchError("The picture still changed after " + std::to_string(task.patience) +
                             " seconds; give more with --patience.");
    } while (secondsSince(start) < changed + task.still);
    const std::uint64_t triangles = frame.triangles;
    if (!task.image.empty() && !osgDB::writeImageFile(*frame.picture, task.image))
        throw BenchError(task.image + ": it cannot be written.");
    if (!task.mask.empty())
    {
        osg::ref_ptr<osg::Image> mask = new osg::Image;
        mask->allocateImage(task.size[0], task.size[1], 1, GL_LUMINANCE, GL_UNSIGNED_BYTE);
        const auto* depth = reinterpret_cast<const float*>(frame.depth->data());
        for (int i = 0; i < task.size[0] * task.size[1]; ++i)
            mask->data()[i] = depth[i] < 1.0f ? 255 : 0;
        if (!osgDB::writeImageFile(*mask, task.mask)) throw BenchError(task.mask + ": it cannot be written.");
    }

    frame.keep = false;
    std::vector<double> seconds;
    for (int i = 0; i < task.frames; ++i)
    {
        const auto before = Clock::now();
        draw();
        seconds.push_back(secondsSince(before));
    }
    nlohmann::ordered_json result;
    result["complete"] = changed;
    result["triangles"] = triangles;
    result["frame"] = seconds.empty() ? 0.0 : geofx::bench::median(seconds);
    result["memory"] = memory("VmRSS:");
    result["peak"] = memory("VmHWM:");
    return result;
}

} // namespace

int main(int argc, char** argv)
{
    Task task;
    CLI::App app{
        "Draws one view of a terrain; prints seconds to the first complete picture, triangles, seconds for a "
        "frame and MiB of memory",
        "geofx_bench_draw"};
    app.add_option("file", task.file, "What to draw: a database, or a file of another engine")
        ->type_name("FILE");
    app.add_option("--single-mesh", task.single, "A database to draw as one mesh of all its finest tiles")
        ->type_name("FILE");
    app.add_option("--behind", task.behind, "Another one, drawn with it")->type_name("FILE");
    app.add_option("--view", task.view, "Longitude, latitude, height, heading, pitch: degrees and metres")
        ->required()
        ->delimiter(',')
        ->expected(5);
    app.add_option("--size", task.size, "Width and height, pixels")->delimiter('x')->expected(2);
    app.add_option("--fov", task.fieldOfView, "Vertical, degrees");
    app.add_option("--frames", task.frames, "How many frames are timed");
    app.add_option("--still", task.still, "A picture is complete that has not changed for so long, seconds");
    app.add_option("--patience", task.patience, "How long to wait for it, seconds");
    app.add_option("--image", task.image, "Write the picture")->type_name("PNG");
    app.add_option("--mask", task.mask, "Write what is covered, white on black")->type_name("PNG");
    CLI11_PARSE(app, argc, argv);
    try
    {
        osgGeoFX::InputFiles inputs;
        for (const std::string& file : {task.file, task.single, task.behind})
            inputs.add(file);
        if (!task.image.empty()) inputs.claim("The picture", task.image, "--image");
        if (!task.mask.empty()) inputs.claim("The picture", task.mask, "--mask");
        std::cout << draw(task).dump() << std::endl;
    }
    catch (const std::runtime_error& error)
    {
        std::cerr << "geofx_bench_draw: " << error.what() << std::endl;
        return 1;
    }
    // Some engines do not end in good order once their context is gone.
    std::_Exit(0);
}
