// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/MapKeys.h>

#include <osgGeoFX/map/detail/MapNodes.h>

namespace osgGeoFX
{

namespace
{

constexpr int namesKey = 'n', linesKey = 'r';

/// All are shown, or none.
template<class Node>
void toggle(const std::vector<osg::ref_ptr<Node>>& nodes)
{
    const bool shown = nodes.front()->isShown();
    for (const osg::ref_ptr<Node>& node : nodes)
        node->setShown(!shown);
}

} // namespace

MapKeys::MapKeys(osg::Node& scene)
{
    MapNodes nodes;
    scene.accept(nodes);
    _names = nodes.names;
    _lines = nodes.lines;
}

void MapKeys::getUsage(osg::ApplicationUsage& usage) const
{
    if (hasNames()) usage.addKeyboardMouseBinding("n", "Hide or show the names");
    if (hasLines()) usage.addKeyboardMouseBinding("r", "Hide or show the lines: roads, rivers");
}

bool MapKeys::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN) return false;
    if (event.getKey() == namesKey && hasNames())
        toggle(_names);
    else if (event.getKey() == linesKey && hasLines())
        toggle(_lines);
    else
        return false;
    action.requestRedraw();
    return true;
}

} // namespace osgGeoFX
