// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/ViewerHandlers.h>

#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/Overlay.h>

#include <osg/Math>

#include <cmath>
#include <cstdio>

namespace osgGeoFX
{

bool LodScaleFollower::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    osg::View* view = action.asView();
    if (event.getEventType() != osgGA::GUIEventAdapter::FRAME || !view)
    {
        return false;
    }
    osg::Camera& camera = *view->getCamera();
    double fieldOfView = 0.0;
    double aspect = 0.0;
    double zNear = 0.0;
    double zFar = 0.0;
    if (!_terrain || !camera.getViewport() || camera.getViewport()->height() <= 0.0 ||
        !camera.getProjectionMatrixAsPerspective(fieldOfView, aspect, zNear, zFar))
    {
        return false;
    }
    const float base = lodScaleFor(
        *_terrain, pixelsPerRadian(camera.getViewport()->height(), osg::DegreesToRadians(fieldOfView)));
    if (base != _base)
    {
        camera.setLODScale(camera.getLODScale() * base / _base);
        _base = base;
    }
    return false;
}

CursorReadout::CursorReadout(const Scene& scene)
    : _effects(scene.effects), _reference(scene.reference), _whyNone(scene.referenceError),
      _overlay(makeOverlay(0, 0)), _text(new osgText::Text)
{
    _text->setDataVariance(osg::Object::DYNAMIC);
    _text->setCharacterSize(18.0f);
    _text->setPosition(osg::Vec3(10.0f, 10.0f, 0.0f));
    _text->setColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    _text->setBackdropType(osgText::Text::OUTLINE);
    _text->setBackdropColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    _overlay->setRenderOrder(osg::Camera::POST_RENDER, 10);
    _overlay->addChild(_text);
}

void CursorReadout::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding(_key > ' ' && _key < 127 ? std::string(1, static_cast<char>(_key))
                                                           : "its key",
                                  "Toggle the coordinates below the pointer");
}

std::string CursorReadout::text() const
{
    return _shown ? _text->getText().createUTF8EncodedString() : std::string();
}

void CursorReadout::toggle(osgViewer::View& view)
{
    _shown = !_shown;
    const osg::Viewport* viewport = view.getCamera()->getViewport();
    if (!_overlay->getGraphicsContext() && viewport)
    {
        _overlay->setViewport(0, 0, static_cast<int>(viewport->width()),
                              static_cast<int>(viewport->height()));
        _overlay->setProjectionMatrixAsOrtho2D(0.0, viewport->width(), 0.0, viewport->height());
        attachOverlay(view, *_overlay);
    }
    _overlay->setNodeMask(_shown ? ~0u : 0u);
    _text->setText(_reference ? std::string("move the pointer over the ground") : _whyNone);
}

void CursorReadout::show(osgViewer::View& view, float x, float y)
{
    const DeformedView picture(*_effects, *view.getCamera());
    const osg::Viewport& port = *view.getCamera()->getViewport();
    double longitude = 0.0;
    double latitude = 0.0;
    double height = 0.0;
    if (!picture.unproject(static_cast<double>(x) - port.x(), static_cast<double>(y) - port.y(), *_reference,
                           longitude, latitude, height))
    {
        _text->setText("");
        return;
    }
    char line[128];
    std::snprintf(line, sizeof line, "%.6f %s  %.6f %s  %.1f m", std::abs(osg::RadiansToDegrees(longitude)),
                  longitude < 0.0 ? "W" : "E", std::abs(osg::RadiansToDegrees(latitude)),
                  latitude < 0.0 ? "S" : "N", height);
    _text->setText(line);
}

bool CursorReadout::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    auto* view = dynamic_cast<osgViewer::View*>(&action);
    if (!view)
    {
        return false;
    }
    using Clock = std::chrono::steady_clock;
    switch (event.getEventType())
    {
    case osgGA::GUIEventAdapter::KEYDOWN:
        if (event.getKey() != _key) return false;
        toggle(*view);
        return true;
    case osgGA::GUIEventAdapter::MOVE:
        _moved = true;
        _lastMove = Clock::now();
        return false;
    case osgGA::GUIEventAdapter::RESIZE:
        // OSG gives the slave its new viewport; its projection is ours.
        _overlay->setProjectionMatrixAsOrtho2D(0.0, event.getWindowWidth(), 0.0, event.getWindowHeight());
        return false;
    case osgGA::GUIEventAdapter::FRAME:
        // A ray through all tiles costs milliseconds, so it waits until the pointer rests.
        if (_shown && _moved && _reference && Clock::now() - _lastMove > std::chrono::milliseconds(60))
        {
            _moved = false;
            show(*view, event.getX(), event.getY());
        }
        return false;
    default:
        return false;
    }
}

} // namespace osgGeoFX
