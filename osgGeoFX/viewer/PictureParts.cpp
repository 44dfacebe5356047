// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/PictureParts.h>

#include <osg/NodeCallback>
#include <osgViewer/ViewerBase>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// The view's camera itself draws nothing.
struct DrawsNothing : public osg::NodeCallback
{
    void operator()(osg::Node*, osg::NodeVisitor*) override {}
};

class PartsHandler : public osgGA::GUIEventHandler
{
public:
    explicit PartsHandler(EffectScene& scene) : _scene(&scene) {}

    using osgGA::GUIEventHandler::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override
    {
        if (_done || event.getEventType() != osgGA::GUIEventAdapter::FRAME) return false;
        auto* view = dynamic_cast<osgViewer::View*>(action.asView());
        osg::ref_ptr<EffectScene> scene;
        if (view && _scene.lock(scene)) _done = !drawInParts(*view, scene->leastParts()).empty();
        return false;
    }

private:
    osg::observer_ptr<EffectScene> _scene;
    bool _done = false;
};

} // namespace

std::vector<osg::ref_ptr<osg::Camera>> drawInParts(osgViewer::View& view, unsigned int parts)
{
    std::vector<osg::ref_ptr<osg::Camera>> cameras;
    osg::Camera& whole = *view.getCamera();
    const osg::Viewport* port = whole.getViewport();
    if (parts < 2 || !port) return cameras;
    osgViewer::ViewerBase* viewer = view.getViewerBase();
    const bool threads = viewer && viewer->areThreadsRunning();
    if (threads) viewer->stopThreading();
    whole.setCullCallback(new DrawsNothing);
    for (unsigned int i = 0; i < parts; ++i)
    {
        // Columns of whole pixels.
        const double left = std::round(port->width() * i / parts);
        const double right = std::round(port->width() * (i + 1) / parts);
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setGraphicsContext(whole.getGraphicsContext());
        camera->setViewport(new osg::Viewport(port->x() + left, port->y(), right - left, port->height()));
        // OSG changes the whole camera's projection with the window, and the columns follow it.
        camera->setProjectionResizePolicy(osg::Camera::FIXED);
        camera->setAllowEventFocus(false);
        camera->setClearColor(whole.getClearColor());
        const double scale = port->width() / (right - left);
        const double middle = (left + right) / port->width() - 1.0;
        view.addSlave(camera,
                      osg::Matrixd::translate(-middle, 0.0, 0.0) * osg::Matrixd::scale(scale, 1.0, 1.0),
                      osg::Matrixd::identity(), true);
        cameras.push_back(camera);
    }
    if (threads) viewer->startThreading();
    return cameras;
}

osg::ref_ptr<osgGA::GUIEventHandler> makePartsHandler(EffectScene& scene)
{
    return new PartsHandler(scene);
}

} // namespace osgGeoFX
