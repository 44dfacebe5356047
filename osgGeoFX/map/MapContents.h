// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/lines/MapLines.h>
#include <osgGeoFX/map/MapStyles.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Node>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** The names and lines of a map, on the ground of a scene. A plain value.

    MapReader reads them. addTo() shows them live. A program that makes single pictures takes them out of a scene (take()), since live names
    fade in over some frames, and puts them onto the finished picture:

    @code
    osgGeoFX::MapContents map = osgGeoFX::MapContents::take(*scene.node); // what a .geofx file has put into the scene
    map.addLinesTo(*scene.effects, height / 900.0);
    // … draw, then:
    osgGeoFX::LabelPicture(*map.makeNames(), *scene.effects, camera, depths).drawOnto(image);
    @endcode
    @ingroup map */
struct OSGGEOFXMAPS_EXPORT MapContents
{
    std::vector<MapName> names; ///< placed ones (NamePlacement)
    std::vector<MapLine> lines; ///< placed ones (LinePlacement)
    MapStyles styles;

    bool empty() const { return names.empty() && lines.empty(); }

    /** Takes the nodes of names and lines (MapLabels, MapLines) out of a scene. Empty if there are none. `node`: the scene's outermost node; files
        that are paged are not looked into. Call it before the scene is shown, or between frames. */
    static MapContents take(osg::Node& node);

    /// Null if there are no names.
    osg::ref_ptr<NameSet> makeNames() const;
    /// Adds the lines to a scene, if there are any. `scale`: as for MapLines::setScale().
    void addLinesTo(EffectScene& scene, double scale = 1.0) const;
    /** Shows lines and names live in a scene. `node`: the scene's outermost node. The node to show in its place: itself, or a group of it
        and the names (MapLabels). */
    osg::ref_ptr<osg::Node> addTo(EffectScene& scene, osg::Node& node) const;

    /// A short text that differs where other names, lines or styles do, for programs that keep what they drew.
    std::string digest() const;
};

} // namespace osgGeoFX
