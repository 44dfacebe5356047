// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/detail/SceneCrs.h>

#include <osg/CoordinateSystemNode>
#include <osg/LOD>
#include <osg/NodeVisitor>

namespace osgGeoFX
{

std::string crsOfScene(osg::Node& node)
{
    struct Finder : public osg::NodeVisitor
    {
        Finder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
        void apply(osg::CoordinateSystemNode& found) override { wkt = found.getCoordinateSystem(); }
        void apply(osg::LOD&) override {}
        std::string wkt;
    } finder;
    node.accept(finder);
    return finder.wkt;
}

} // namespace osgGeoFX
