// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Drawing.h"

#include <osgGeoFX/offscreen/EglGraphicsContext.h>

#include <osgUtil/RenderBin>
#include <osgUtil/RenderLeaf>
#include <osgUtil/StateGraph>

#include <simgear/scene/util/SGNodeMasks.hxx>

#include <algorithm>
#include <cmath>
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

/// Draws from back to front, and in the order of the nodes where leaves are equally far.
class SteadyBin : public osgUtil::RenderBin
{
public:
    SteadyBin() : osgUtil::RenderBin(SORT_BACK_TO_FRONT) {}
    SteadyBin(const SteadyBin& other, const osg::CopyOp& copy) : osgUtil::RenderBin(other, copy) {}
    osg::Object* cloneType() const override { return new SteadyBin; }
    osg::Object* clone(const osg::CopyOp& copy) const override { return new SteadyBin(*this, copy); }

    void sortBackToFront() override
    {
        copyLeavesFromStateGraphListToRenderLeafList();
        std::sort(_renderLeafList.begin(), _renderLeafList.end(),
                  [](const osgUtil::RenderLeaf* a, const osgUtil::RenderLeaf* b)
                  {
                      return a->_depth != b->_depth ? a->_depth > b->_depth
                                                    : a->_traversalOrderNumber < b->_traversalOrderNumber;
                  });
    }
};

/// OSG draws in the order of states, which is that of the first leaf of each that is in sight, and leaves that are equally
/// far as std::sort leaves them. Where two triangles meet in a pixel, culling would change the picture. A viewer has a
/// bin of its own, so this comes first.
StillViewer* makeViewer()
{
    using osgUtil::RenderBin;
    RenderBin::setDefaultRenderBinSortMode(RenderBin::TRAVERSAL_ORDER);
    for (const char* name : {"RenderBin", "StateSortedBin"})
        RenderBin::addRenderBinPrototype(name, new RenderBin(RenderBin::TRAVERSAL_ORDER));
    RenderBin::addRenderBinPrototype("DepthSortedBin", new SteadyBin);
    return new StillViewer;
}

} // namespace

void hideLamps(osg::Camera& camera)
{
    using namespace simgear;
    camera.setCullMask(camera.getCullMask() &
                       ~(GROUNDLIGHTS0_BIT | GROUNDLIGHTS1_BIT | GROUNDLIGHTS2_BIT | RUNWAYLIGHTS_BIT));
}

osg::Matrixd Frame::projection() const
{
    return osg::Matrixd::perspective(fieldOfView, static_cast<double>(width) / height, 5.0, 250000.0);
}

double Frame::pixel() const
{
    return 2.0 * std::tan(0.5 * osg::DegreesToRadians(fieldOfView)) / height;
}

bool same(const osg::Image& a, const osg::Image& b)
{
    return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

Drawing::Drawing(const osgGeoFX::Scene& scene, const Frame& frame) : _viewer(makeViewer())
{
    const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = frame.width;
    traits->height = frame.height;
    traits->stencil = 8;
    traits->samples = static_cast<unsigned int>(frame.samples);
    const osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
    if (!context->valid()) throw std::runtime_error(context->error());
    camera().setGraphicsContext(context);
    camera().setViewport(0, 0, frame.width, frame.height);
    camera().setProjectionMatrix(frame.projection());
    if (!frame.lamps) hideLamps(camera());
    scene.setUpView(*_viewer);
    _capture = osgGeoFX::ImageCapture::attach(&camera());
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
