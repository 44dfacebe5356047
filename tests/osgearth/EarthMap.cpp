// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "EarthMap.h"

#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <osg/DisplaySettings>
#include <osg/Math>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgEarth/Extension>
#include <osgEarth/GLUtils>
#include <osgEarth/GeoData>
#include <osgEarth/ImageLayer>
#include <osgEarth/Registry>
#include <osgEarth/ScreenSpaceLayout>
#include <osgEarth/XmlUtils>
#include <osgEarth/weejobs.h>
#include <osgUtil/RenderStage>
#include <osgViewer/Renderer>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace geofx::test
{

namespace
{

/** Ends the program before its static objects are destroyed. osgEarth's plugins are unloaded while OSG's registry still
    holds objects of theirs, and any program that has shown an osgEarth map crashes then, with and without the kit. */
class EndBeforeStaticObjects : public ::testing::EmptyTestEventListener
{
    void OnTestProgramEnd(const ::testing::UnitTest& tests) override
    {
        std::printf("%d of %d tests passed.\n", tests.successful_test_count(), tests.test_to_run_count());
        std::fflush(nullptr);
        std::_Exit(tests.Passed() ? 0 : 1);
    }
};

[[maybe_unused]] const bool endsEarly = []
{
    ::testing::UnitTest::GetInstance()->listeners().Append(new EndBeforeStaticObjects);
    return true;
}();

/// osgEarth makes a context of its own to see what the driver can do.
class EglContexts : public osg::GraphicsContext::WindowingSystemInterface
{
public:
    unsigned int getNumScreens(const osg::GraphicsContext::ScreenIdentifier&) override { return 1; }
    void getScreenSettings(const osg::GraphicsContext::ScreenIdentifier&,
                           osg::GraphicsContext::ScreenSettings& settings) override
    {
        settings.width = 1920;
        settings.height = 1080;
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

void initialize()
{
    static const bool once = []
    {
        const auto systems = osg::GraphicsContext::getWindowingSystemInterfaces();
        systems->getInterfaces().insert(systems->getInterfaces().begin(), new EglContexts);
        osgEarth::initialize();
        // Loaded at its first use, and not in silence.
        osgDB::Registry::instance()->getImageProcessorForExtension("fastdxt");
        return true;
    }();
    (void)once;
}

/// A viewer whose time goes on by the same step with each frame. Maps may move, so pictures are taken at moments of one phase.
class SteadyViewer : public osgViewer::Viewer
{
public:
    void advance(double) override
    {
        osgViewer::Viewer::advance(_time);
        getFrameStamp()->setReferenceTime(_time);
        _time += step;
    }
    /// Lets the next frame be at a whole number of turns.
    void completeTurn() { _time = std::ceil(_time / (2.0 * osg::PI)) * 2.0 * osg::PI; }

private:
    static constexpr double step = 1.0 / 60.0;
    double _time = 0.0;
};

class Capture : public osg::Camera::DrawCallback
{
public:
    void operator()(osg::RenderInfo&) const override
    {
        image->readPixels(0, 0, 320, 200, GL_RGB, GL_UNSIGNED_BYTE);
    }
    const osg::ref_ptr<osg::Image> image = new osg::Image;
};

class SceneFinder : public osg::NodeVisitor
{
public:
    SceneFinder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Group& node) override
    {
        if (!found) found = dynamic_cast<osgGeoFX::EffectScene*>(&node);
        if (!found && !dynamic_cast<osgEarth::MapNode*>(&node)) traverse(node);
    }
    osgGeoFX::EffectScene* found = nullptr;
};

/// Reads where osgEarth's layout has put its leaves.
void collectLaidOut(osgUtil::RenderBin& bin, std::map<const osg::Drawable*, osg::Vec2d>& anchors)
{
    if (bin.getName() == OSGEARTH_SCREEN_SPACE_LAYOUT_BIN)
        for (const osgUtil::RenderLeaf* leaf : bin.getRenderLeafList())
        {
            const osg::Vec3d at = leaf->_modelview->getTrans();
            anchors[leaf->getDrawable()] = {at.x(), at.y()};
        }
    for (const auto& [number, each] : bin.getRenderBinList())
        collectLaidOut(*each, anchors);
}

} // namespace

EarthMaps::EarthMaps() : _folder(std::make_unique<TempDir>()) {}
EarthMaps::~EarthMaps() = default;

void EarthMaps::SetUp()
{
    initialize();
    constexpr int side = 400;
    writeRelief(_folder->path() / "hills.tif", side, side, 10.0, 1.0, 1.0 / side);
    TestRaster(side, side, 3, GDT_Byte)
        .placed(10.0, 1.0, 1.0 / side, 1.0 / side)
        .crs("EPSG:4326")
        .fill([](int column, int row, int band)
              { return 60.0 + 40.0 * ((column / (8 + 5 * band) + row / (11 - 3 * band)) % 4); })
        .write(_folder->path() / "picture.tif");
}

std::string EarthMaps::extension(const std::string& effects, const std::string& culling)
{
    return "<geofx version=\"1\"><terrain><engine minHeight=\"-10\" maxHeight=\"1100\" culling=\"" + culling +
           "\"/></terrain><effects>" + effects + "</effects></geofx>";
}

bool EarthMaps::startViewer()
{
    // One for all tests: osgEarth keeps OpenGL objects by context, and does not expect a context to go.
    // It stays until the program ends, after osgEarth's own registries.
    static auto* const viewer = new osg::ref_ptr<osgViewer::Viewer>;
    if ((_viewer = *viewer)) return true;
    const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = WIDTH;
    traits->height = HEIGHT;
    traits->depth = 24;
    traits->alpha = 8;
    traits->pbuffer = true;
    traits->doubleBuffer = false;
    const osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
    if (!context->valid())
    {
        ADD_FAILURE() << context->error();
        return false;
    }
    // Without vertex array objects OSG 3.6.5 knows an array by its address. After osgEarth has let a tile go, another one's array may
    // have that address: OpenGL then reads vertices from a buffer that is gone.
    osg::DisplaySettings::instance()->setVertexBufferHint(osg::DisplaySettings::VERTEX_ARRAY_OBJECT);
    _viewer = *viewer = new SteadyViewer;
    _viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    camera().setGraphicsContext(context);
    camera().setViewport(0, 0, WIDTH, HEIGHT);
    camera().setDrawBuffer(GL_FRONT);
    camera().setReadBuffer(GL_FRONT);
    camera().setClearColor({0.7f, 0.8f, 0.9f, 1.0f});
    // As osgEarth's own viewer has it. A label is smaller than a pixel otherwise.
    camera().setSmallFeatureCullingPixelSize(-1.0f);
    _viewer->setRealizeOperation(new osgEarth::GL3RealizeOperation);
    _viewer->realize();
    return true;
}

bool EarthMaps::show(const std::string& geofx, const std::string& terrainOptions)
{
    _file = (_folder->path() / "map.earth").string();
    const std::string profile = _profile.empty() ? "" : "<profile>" + _profile + "</profile>";
    std::ofstream(_file) << "<map name=\"hills\" version=\"3\">\n<options>" << profile << "<terrain "
                         << terrainOptions << " color=\"#7f9f5f\"/></options>\n"
                         << "<GDALImage name=\"picture\"><url>picture.tif</url></GDALImage>\n"
                         << "<GDALElevation name=\"hills\"><url>hills.tif</url></GDALElevation>\n"
                         << geofx << "\n</map>\n";
    return showMap(_file);
}

bool EarthMaps::showFile(const std::string& file)
{
    _file = file;
    return showMap(file);
}

bool EarthMaps::showMap(const std::string& file)
{
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file);
    _map = osgEarth::MapNode::get(node.get());
    if (!_map)
    {
        ADD_FAILURE() << "no map";
        return false;
    }
    if (!startViewer()) return false;
    _root = new osg::Group;
    _root->addChild(node);
    _viewer->setSceneData(_root);
    setProjection(20.0, 2e7);
    camera().setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    // The map puts its extensions in place in the first frame.
    _viewer->frame();
    return true;
}

bool EarthMaps::addExtension(const std::string& geofx)
{
    std::istringstream text(geofx);
    const osg::ref_ptr<osgEarth::XmlDocument> document = osgEarth::XmlDocument::load(text);
    if (!document) ADD_FAILURE() << "no XML";
    if (!document) return false;
    const osgEarth::ConfigOptions options(document->getConfig().child("geofx"));
    const osg::ref_ptr<osgEarth::Extension> extension = osgEarth::Extension::create("geofx", options);
    if (extension) _map->addExtension(extension);
    if (!scene()) ADD_FAILURE() << "no scene";
    return scene() != nullptr;
}

void EarthMaps::setProjection(double near, double far)
{
    _projection.makePerspective(40.0, static_cast<double>(WIDTH) / HEIGHT, near, far);
}

osgGeoFX::EffectScene* EarthMaps::scene()
{
    SceneFinder finder;
    _root->accept(finder);
    return finder.found;
}

osg::Matrixd EarthMaps::viewFrom(double longitude, double latitude, double height, double heading,
                                 double pitch)
{
    osg::Matrixd ground;
    const osgEarth::GeoPoint place(osgEarth::SpatialReference::get("wgs84"), longitude, latitude, height);
    if (!place.transform(_map->getMapSRS()).createLocalToWorld(ground)) ADD_FAILURE() << "no place";
    const osg::Matrixd turn =
        osg::Matrixd::rotate(osg::DegreesToRadians(90.0 + pitch), osg::Vec3d(1.0, 0.0, 0.0)) *
        osg::Matrixd::rotate(-osg::DegreesToRadians(heading), osg::Vec3d(0.0, 0.0, 1.0));
    return osg::Matrixd::inverse(turn * ground);
}

osg::ref_ptr<osg::Image> EarthMaps::draw(double longitude, double latitude, double height, double heading,
                                         double pitch)
{
    return draw(viewFrom(longitude, latitude, height, heading, pitch));
}

osg::ref_ptr<osg::Image> EarthMaps::draw(const osg::Matrixd& view)
{
    camera().setViewMatrix(view);
    // Tiles are loaded, then merged, then drawn. Some maps keep a job for ever.
    constexpr int still = 10, stillBusy = 150, most = 2000;
    int waiting = 0;
    for (int i = 0, quiet = 0; i < most && quiet < (waiting > 0 ? stillBusy : still); ++i)
    {
        // What computes near and far leaves them in the projection.
        camera().setProjectionMatrix(_projection);
        _viewer->frame();
        const int former = waiting;
        waiting = jobs::get_metrics()->total();
        quiet = waiting == former ? quiet + 1 : 0;
        if (waiting > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (fading > 0)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(fading));
        camera().setProjectionMatrix(_projection);
        _viewer->frame();
    }
    static_cast<SteadyViewer&>(*_viewer).completeTurn();
    const osg::ref_ptr<Capture> capture = new Capture;
    camera().setFinalDrawCallback(capture);
    camera().setProjectionMatrix(_projection);
    _viewer->frame();
    camera().setFinalDrawCallback(nullptr);
    return capture->image;
}

std::map<const osg::Drawable*, osg::Vec2d> EarthMaps::laidOut()
{
    std::map<const osg::Drawable*, osg::Vec2d> anchors;
    auto* renderer = dynamic_cast<osgViewer::Renderer*>(camera().getRenderer());
    if (renderer) collectLaidOut(*renderer->getSceneView(0)->getRenderStage(), anchors);
    return anchors;
}

void EarthMaps::hideImages()
{
    std::vector<osg::ref_ptr<osgEarth::ImageLayer>> layers;
    _map->getMap()->getLayers(layers);
    for (const auto& layer : layers)
        layer->setVisible(false);
}

int EarthMaps::differing(const osg::Image& a, const osg::Image& b)
{
    int count = 0;
    for (int y = 0; y < HEIGHT; ++y)
    {
        for (int x = 0; x < WIDTH; ++x)
            count += std::equal(a.data(x, y), a.data(x, y) + 3, b.data(x, y)) ? 0 : 1;
    }
    return count;
}

} // namespace geofx::test
