// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/lines/MapLines.h>

#include <osg/LOD>
#include <osg/NodeVisitor>

#include <vector>

namespace osgGeoFX
{

/// Finds the nodes of names and lines in a scene, but for those in levels of detail and in files that are paged.
struct MapNodes : public osg::NodeVisitor
{
    MapNodes() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
    void apply(osg::Group& group) override
    {
        if (auto* const label = dynamic_cast<MapLabels*>(&group))
            names.emplace_back(label);
        else if (auto* const line = dynamic_cast<MapLines*>(&group))
            lines.emplace_back(line);
        else
            traverse(group);
    }
    void apply(osg::LOD&) override {}

    std::vector<osg::ref_ptr<MapLabels>> names;
    std::vector<osg::ref_ptr<MapLines>> lines;
};

} // namespace osgGeoFX
