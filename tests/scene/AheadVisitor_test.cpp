// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a camera is going to ask for is not below its horizon.
#include <osgGeoFX/scene/detail/AheadVisitor.h>

#include <osg/ClusterCullingCallback>

#include <gtest/gtest.h>

using namespace osgGeoFX;

namespace
{

/// How many children that are not there a camera in the origin finds, which looks along −z.
int found(osg::PagedLOD& tile, bool horizons)
{
    const AheadVisitor::Outlook outlook = {
        ViewGeometry({}, osg::Matrixd::perspective(60.0, 1.0, 1.0, 1e4), Ground()),
        new DeformationChain,
        nullptr,
        1.0,
        true,
        horizons,
        true};
    osg::ref_ptr<AheadVisitor> visitor = new AheadVisitor;
    int count = 0;
    visitor->found = [&](const AheadVisitor::Missing& missing)
    {
        count += visitor->wants(missing) ? 1 : 100;
    };
    visitor->begin(outlook, 1);
    tile.accept(*visitor);
    return count;
}

} // namespace

TEST(AheadVisitor, LeavesOutWhatLiesBelowItsHorizon)
{
    osg::ref_ptr<osg::PagedLOD> tile = new osg::PagedLOD;
    tile->setCenter(osg::Vec3(0.0f, 0.0f, -100.0f));
    tile->setRadius(10.0f);
    tile->setFileName(0, "tile.osgb");
    tile->setRange(0, 0.0f, 1000.0f);
    EXPECT_EQ(found(*tile, true), 1);
    // Seen from within the half room that its normal points to, and from the other one.
    tile->setCullCallback(
        new osg::ClusterCullingCallback(tile->getCenter(), osg::Vec3(0.0f, 0.0f, 1.0f), 0.0f));
    EXPECT_EQ(found(*tile, true), 1);
    tile->setCullCallback(
        new osg::ClusterCullingCallback(tile->getCenter(), osg::Vec3(0.0f, 0.0f, -1.0f), 0.0f));
    EXPECT_EQ(found(*tile, true), 0);
    EXPECT_EQ(found(*tile, false), 1) << "where the camera's culling mode has no CLUSTER_CULLING";
}
