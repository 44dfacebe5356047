// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/CornerOverlay.h>

#include <utility>

namespace osgGeoFX
{

CornerOverlay::CornerOverlay(char key, std::string usage) : _key(key), _usage(std::move(usage)) {}

CornerOverlay::~CornerOverlay() = default;

void CornerOverlay::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding(std::string(1, _key), _usage);
}

void CornerOverlay::setShown(bool shown)
{
    _shown = shown;
    if (!_shown) hide();
}

void CornerOverlay::hide()
{
    if (_overlay) _overlay->setNodeMask(0u);
}

bool CornerOverlay::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (event.getEventType() == osgGA::GUIEventAdapter::KEYDOWN && event.getKey() == _key)
    {
        setShown(!_shown);
        action.requestRedraw();
        return true;
    }
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    if (event.getEventType() == osgGA::GUIEventAdapter::FRAME && _shown && view &&
        view->getCamera()->getViewport())
        show(*view);
    return false;
}

} // namespace osgGeoFX
