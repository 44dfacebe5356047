// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/Overlay.h>

#include <osgViewer/ViewerBase>

namespace osgGeoFX
{

osg::ref_ptr<osg::Camera> makeOverlay(int width, int height)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setProjectionMatrixAsOrtho2D(0.0, width, 0.0, height);
    camera->setViewMatrix(osg::Matrixd::identity());
    camera->setClearMask(0);
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->setAllowEventFocus(false);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    osg::StateSet* state = camera->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    return camera;
}

void attachOverlay(osgViewer::View& view, osg::Camera& overlay)
{
    osgViewer::ViewerBase* viewer = view.getViewerBase();
    const bool threads = viewer && viewer->areThreadsRunning();
    if (threads) viewer->stopThreading();
    overlay.setGraphicsContext(view.getCamera()->getGraphicsContext());
    view.addSlave(&overlay, false);
    if (threads) viewer->startThreading();
}

bool showOverlay(osgViewer::View& view, osg::ref_ptr<osg::Camera>& overlay, int order)
{
    const osg::Viewport& port = *view.getCamera()->getViewport();
    const bool made = !overlay;
    if (made)
    {
        overlay = makeOverlay(0, 0);
        overlay->setRenderOrder(osg::Camera::POST_RENDER, order);
        overlay->setProjectionResizePolicy(osg::Camera::FIXED);
        overlay->setViewport(new osg::Viewport(port));
    }
    osg::Viewport& own = *overlay->getViewport();
    const bool changed = made || own.x() != port.x() || own.y() != port.y() || own.width() != port.width() ||
                         own.height() != port.height();
    own.setViewport(port.x(), port.y(), port.width(), port.height());
    // OSG may have given the slave a projection for a window of another size.
    overlay->setProjectionMatrixAsOrtho2D(0.0, port.width(), 0.0, port.height());
    if (made) attachOverlay(view, *overlay);
    overlay->setNodeMask(~0u);
    return changed;
}

} // namespace osgGeoFX
