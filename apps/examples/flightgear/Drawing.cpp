// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Drawing.h"

#include <osgGeoFX/offscreen/EglGraphicsContext.h>

#include <cstring>
#include <stdexcept>

namespace flightgear
{

namespace
{

/// A viewer whose time stands still, so that nothing moves.
class StillViewer : public osgViewer::Viewer
{
public:
    void advance(double) override
    {
        osgViewer::Viewer::advance(0.0);
        getFrameStamp()->setReferenceTime(0.0);
    }
};

} // namespace

bool same(const osg::Image& a, const osg::Image& b)
{
    return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

Drawing::Drawing(const osgGeoFX::Scene& scene, const Frame& frame) : _viewer(new StillViewer)
{
    const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = frame.width;
    traits->height = frame.height;
    traits->stencil = 8;
    const osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
    if (!context->valid()) throw std::runtime_error(context->error());
    camera().setGraphicsContext(context);
    camera().setViewport(0, 0, frame.width, frame.height);
    camera().setProjectionMatrixAsPerspective(frame.fieldOfView,
                                              static_cast<double>(frame.width) / frame.height, 5.0, 250000.0);
    scene.setUpView(*_viewer);
    _capture = osgGeoFX::ImageCapture::attach(&camera());
    // Sorting by state would draw in the order of addresses in memory.
    _root->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    _root->addChild(scene.effects);
    _root->addChild(scene.effects->getChild(0), false);
    _viewer->setThreadingModel(osgViewer::Viewer::SingleThreaded);
    _viewer->setSceneData(_root);
    _viewer->getDatabasePager()->setUpThreads(1, 0); // SimGear's loaders share geometry
    _monitor = std::make_unique<osgGeoFX::PagerMonitor>(_viewer->getDatabasePager(), scene.guard.get(), 1);
    _viewer->realize();
}

osg::ref_ptr<osg::Image> Drawing::drawOnce()
{
    _capture->request();
    _viewer->frame();
    osg::ref_ptr<osg::Image> image = _capture->take();
    if (!image) throw std::runtime_error("The frame could not be read back; check the OpenGL driver.");
    return image;
}

osg::ref_ptr<osg::Image> Drawing::draw(const osg::Matrixd& view)
{
    camera().setViewMatrix(view);
    _monitor->restart();
    osg::ref_ptr<osg::Image> former;
    for (int still = 0, i = 0; i < 100; ++i)
    {
        const osg::ref_ptr<osg::Image> image = drawOnce();
        still = _monitor->frameFinished() && former && same(*former, *image) ? still + 1 : 0;
        if (still == 2) return image;
        former = image;
        _monitor->waitForReads(60.0);
    }
    throw std::runtime_error("The picture does not stand still; something below the scene moves.");
}

} // namespace flightgear
