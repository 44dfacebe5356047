// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/ClickAndFly.h>

#include <osgGeoFX/scene/DeformedView.h>

#include <algorithm>

namespace osgGeoFX
{

void ClickAndFly::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("Ctrl + left button", "Fly to the ground that the picture shows there");
}

bool ClickAndFly::aim(osgViewer::View& view, const osgGA::GUIEventAdapter& event)
{
    const osg::Camera& camera = *view.getCamera();
    const osg::Viewport* port = camera.getViewport();
    if (!port) return false;
    const DeformedView picture(*_scene, camera);
    const auto hit = picture.pick(static_cast<double>(event.getX()) - port->x(),
                                  static_cast<double>(event.getY()) - port->y());
    if (!hit) return false;
    osg::Matrixd toWorld;
    toWorld.invert(camera.getViewMatrix());
    _from = toWorld.getTrans();
    // From the frame of the scene's children to the viewer's world.
    osg::Matrixd childrenToWorld = picture.modelView() * toWorld;
    const osg::Vec3d ground = hit->world * childrenToWorld;
    _attitude = camera.getViewMatrix();
    _attitude.setTrans(osg::Vec3d());
    const Ground terrain = _scene->ground();
    const ViewGeometry geometry(camera.getViewMatrix(), camera.getProjectionMatrix(), terrain);
    const osg::Vec3d up = osg::Matrixd::transform3x3(geometry.up, toWorld);
    // The height above the ground that is flown to shrinks with the way that is left.
    _to = _from + (ground - _from) * _share;
    const double below = (ground - _to) * up;
    if (below > -2.0) _to += up * (below + 2.0);
    return true;
}

void ClickAndFly::fly(osgViewer::View& view, double time)
{
    const double share = std::clamp((time - _start) / _seconds, 0.0, 1.0);
    const double smooth = share * share * (3.0 - 2.0 * share);
    const osg::Vec3d eye = _from + (_to - _from) * smooth;
    const osg::Matrixd matrix = osg::Matrixd::translate(-eye) * _attitude;
    if (view.getCameraManipulator())
    {
        view.getCameraManipulator()->setByInverseMatrix(matrix);
    }
    else
    {
        view.getCamera()->setViewMatrix(matrix);
    }
    if (share >= 1.0) _start = -1.0;
}

bool ClickAndFly::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!view) return false;
    using Event = osgGA::GUIEventAdapter;
    if (event.getEventType() == Event::FRAME && flying())
    {
        fly(*view, event.getTime());
        action.requestRedraw();
        return false;
    }
    const bool wanted = event.getEventType() == Event::PUSH &&
                        event.getButton() == Event::LEFT_MOUSE_BUTTON &&
                        (event.getModKeyMask() & Event::MODKEY_CTRL);
    if (!wanted || !aim(*view, event)) return false;
    _start = event.getTime();
    action.requestRedraw();
    return true;
}

} // namespace osgGeoFX
