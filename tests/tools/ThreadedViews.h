// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/ImageCapture.h>
#include <osgViewer/CompositeViewer>

#include <vector>

namespace geofx::test
{

/// Views of one scene or several, each in a context of its own.
class ThreadedViews
{
public:
    using Threading = osgViewer::ViewerBase::ThreadingModel;
    static constexpr Threading models[] = {osgViewer::ViewerBase::SingleThreaded,
                                           osgViewer::ViewerBase::CullDrawThreadPerContext,
                                           osgViewer::ViewerBase::DrawThreadPerContext,
                                           osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext};

    explicit ThreadedViews(Threading model) : _viewer(new osgViewer::CompositeViewer)
    {
        _viewer->setThreadingModel(model);
        _viewer->setKeyEventSetsDone(0);
    }
    ~ThreadedViews()
    {
        _viewer->stopThreading();
        _viewer = nullptr;
        for (const auto& context : _contexts)
            context->close();
    }
    ThreadedViews(const ThreadedViews&) = delete;
    ThreadedViews& operator=(const ThreadedViews&) = delete;

    /// A view of a scene with another camera's matrices, viewport and background.
    void add(osg::Node* scene, const osg::Camera& like)
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = static_cast<int>(like.getViewport()->width());
        traits->height = static_cast<int>(like.getViewport()->height());
        traits->alpha = 8;
        _contexts.push_back(new osgGeoFX::EglGraphicsContext(traits));
        osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        view->setLightingMode(osg::View::NO_LIGHT);
        osg::Camera& camera = *view->getCamera();
        camera.setGraphicsContext(_contexts.back());
        camera.setViewport(0, 0, traits->width, traits->height);
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setClearColor(like.getClearColor());
        camera.setProjectionMatrix(like.getProjectionMatrix());
        camera.setViewMatrix(like.getViewMatrix());
        _captures.push_back(osgGeoFX::ImageCapture::attach(&camera, osgGeoFX::ImageCapture::Format::Rgba));
        view->setSceneData(scene);
        _viewer->addView(view);
    }
    void realize()
    {
        // Room for the contexts of all threads: OSG's own, in the first frame of a shared scene, is made without a lock.
        for (unsigned int i = 0; i < _viewer->getNumViews(); ++i)
            _viewer->getView(i)->getSceneData()->resizeGLObjectBuffers(32);
        _viewer->realize();
    }
    void frame() { _viewer->frame(++_frames / 1000.0); }
    /// So far.
    int frames() const { return _frames; }
    /// Of the next frame; the frames on their way may be of an older state.
    std::vector<osg::ref_ptr<osg::Image>> pictures()
    {
        frame();
        frame();
        for (const auto& capture : _captures)
            capture->request();
        frame();
        frame();
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (const auto& capture : _captures)
            images.push_back(capture->take());
        return images;
    }

private:
    osg::ref_ptr<osgViewer::CompositeViewer> _viewer;
    std::vector<osg::ref_ptr<osgGeoFX::EglGraphicsContext>> _contexts;
    std::vector<osg::ref_ptr<osgGeoFX::ImageCapture>> _captures;
    int _frames = 0;
};

} // namespace geofx::test
