// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/CoreView.h>

#include <osgGeoFX/scene/CoreProfile.h>

#include <osg/DisplaySettings>

using namespace osgGeoFX;

namespace geofx::test
{

namespace
{

/// An error of what OSG itself calls in any context, and of GL_CLAMP, with which its textures begin: in Mesa's words and NVIDIA's.
bool isOfOsg(const std::string& message)
{
    for (const char* part : {"deprecated function", "GL_COLOR_MATERIAL", "param=0x2900",
                             "is deprecated and not available", "Cannot enable <cap> in the current profile",
                             "<pname> requires feature(s) disabled in the current profile"})
        if (message.find(part) != std::string::npos) return true;
    return false;
}

} // namespace

CoreView::CoreView(int width, int height)
{
    const osg::ref_ptr<CoreProfileOperation> operation = new CoreProfileOperation;
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = width;
    traits->height = height;
    traits->alpha = 8;
    traits->glContextVersion = "3.3";
    traits->glContextProfileMask = 1;
    EglGraphicsContext::Options options;
    options.debugCallback = [this](const EglGraphicsContext::DebugMessage& message)
    {
        if (message.type == 0x824C && !isOfOsg(message.text)) errors.push_back(message.text);
    };
    _context = new EglGraphicsContext(traits, options);
    if (!_context->valid()) return;
    viewer = new osgViewer::Viewer;
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer->setUseConfigureAffinity(false);
    viewer->setLightingMode(osg::View::NO_LIGHT);
    osg::Camera* camera = viewer->getCamera();
    camera->setGraphicsContext(_context);
    camera->setViewport(0, 0, width, height);
    camera->setClearColor({0.0f, 0.0f, 0.0f, 1.0f});
    _capture = ImageCapture::attach(camera, ImageCapture::Format::Rgba);
    viewer->setRealizeOperation(operation);
    viewer->realize();
}
CoreView::~CoreView()
{
    viewer = nullptr;
    _capture = nullptr;
    _context->close();
    osg::DisplaySettings::instance()->setVertexBufferHint(osg::DisplaySettings::NO_PREFERENCE);
}

osg::ref_ptr<osg::Image> CoreView::render(osg::Node* scene, const osg::Camera& like, int frames)
{
    if (viewer->getSceneData() != scene) viewer->setSceneData(scene);
    osg::Camera* camera = viewer->getCamera();
    camera->setViewMatrix(like.getViewMatrix());
    camera->setProjectionMatrix(like.getProjectionMatrix());
    camera->setComputeNearFarMode(like.getComputeNearFarMode());
    for (int i = 1; i < frames; ++i)
        viewer->frame();
    _capture->request();
    viewer->frame();
    return _capture->take();
}

} // namespace geofx::test
