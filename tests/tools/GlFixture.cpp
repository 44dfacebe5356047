// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/GlFixture.h>
#include <tools/GlRequired.h>
#include <tools/RandomSamples.h>

#include <set>
#include <sstream>

namespace geofx::test
{

namespace
{

// Constants of GL_KHR_debug, which OSG's headers lack.
constexpr GLenum typeError = 0x824C;
constexpr GLenum typeDeprecatedBehavior = 0x824D;
constexpr GLenum typeUndefinedBehavior = 0x824E;
constexpr GLenum typePortability = 0x824F;
constexpr GLenum severityHigh = 0x9146;
constexpr GLenum severityMedium = 0x9147;

} // namespace

GlFixture::GlFixture(int width, int height, unsigned int samples)
    : _width(width), _height(height), _samples(samples)
{
}

GlFixture::~GlFixture() = default;

void GlFixture::SetUp()
{
    _watch = std::make_unique<NotifyWatch>();
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = _width;
    traits->height = _height;
    traits->samples = _samples;
    traits->alpha = 8;
    osgGeoFX::EglGraphicsContext::Options options;
    options.debugCallback = [this](const auto& message)
    {
        reportGl(message);
    };
    _context = new osgGeoFX::EglGraphicsContext(traits.get(), options);
    if (!_context->valid())
    {
        if (glIsRequired())
        {
            FAIL() << _context->error();
        }
        GTEST_SKIP() << _context->error();
    }
    _viewer = new osgViewer::Viewer;
    _viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    _viewer->setUseConfigureAffinity(false); // or all tests that run at once would share one core
    osg::Camera* camera = _viewer->getCamera();
    camera->setGraphicsContext(_context.get());
    camera->setViewport(0, 0, _width, _height);
    camera->setClearColor(osg::Vec4(0, 0, 0, 1));
    _capture = osgGeoFX::ImageCapture::attach(camera, osgGeoFX::ImageCapture::Format::Rgba);
    _viewer->realize();
}

void GlFixture::TearDown()
{
    // GL objects go while the context lives, and messages about them still count.
    _viewer = nullptr;
    _capture = nullptr;
    if (_context.valid()) _context->close();
    _context = nullptr;
    _watch.reset();
}

osg::ref_ptr<osg::Image> GlFixture::render(osg::Node* scene)
{
    if (_viewer->getSceneData() != scene) _viewer->setSceneData(scene);
    // OSG knows the array that was drawn last by its address. Where its geometry is gone and that of this frame lies at the same
    // place, what is gone would be drawn.
    withContext(
        [](osg::State& state)
        {
            state.lazyDisablingOfVertexAttributes();
            state.applyDisablingOfVertexAttributes();
        });
    _capture->request();
    _viewer->frame();
    return _capture->take();
}

void GlFixture::withContext(const std::function<void(osg::State&)>& action)
{
    ASSERT_TRUE(_context->makeCurrent());
    action(*_context->getState());
    _context->releaseContext();
}

void GlFixture::reportGl(const osgGeoFX::EglGraphicsContext::DebugMessage& message)
{
    static const std::set<GLenum> fatalTypes = {typeError, typeDeprecatedBehavior, typeUndefinedBehavior,
                                                typePortability};
    static const std::set<GLenum> fatalSeverities = {severityHigh, severityMedium};
    // In the many scenes of a full run OSG hands the buffers of drawables that are gone to new ones. Mesa counts the uploads and
    // thinks that one object changes.
    if (fullTest() && message.text.find("update a GL_STATIC_DRAW buffer") != std::string::npos) return;
    if (fatalTypes.count(message.type) || fatalSeverities.count(message.severity))
    {
        std::ostringstream text;
        text << "OpenGL (type 0x" << std::hex << message.type << ", severity 0x" << message.severity
             << ", id " << std::dec << message.id << "): " << message.text;
        _watch->report(text.str());
    }
}

} // namespace geofx::test
