// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/lines/MapLines.h>

#include <osg/Node>
#include <osgGA/GUIEventHandler>

#include <vector>

namespace osgGeoFX
{

/** Keys for the names and lines of a scene. n hides and shows names, which fade; r hides and shows lines (roads, rivers). A key does nothing
    where the scene has nothing of the kind. One handler serves one scene.
    @ingroup map */
class OSGGEOFXMAPS_EXPORT MapKeys : public osgGA::GUIEventHandler
{
public:
    /// `scene`: the outermost node, with its names and lines (MapLabels, MapLines) in it already.
    explicit MapKeys(osg::Node& scene);

    bool hasNames() const { return !_names.empty(); }
    bool hasLines() const { return !_lines.empty(); }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

private:
    std::vector<osg::ref_ptr<MapLabels>> _names;
    std::vector<osg::ref_ptr<MapLines>> _lines;
};

} // namespace osgGeoFX
