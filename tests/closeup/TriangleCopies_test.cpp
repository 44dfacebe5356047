// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Copies of the triangles over a region have what lies there, are drawn as often, and follow the geometry.
#include <gtest/gtest.h>
#include <osgGeoFX/closeup/detail/TriangleCopies.h>
#include <tools/TileBlock.h>

#include <cmath>

using namespace osgGeoFX;

namespace
{

/// A row of squares, x from 0 to 10.
osg::ref_ptr<osg::Geometry> makeRow()
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int i = 0; i <= 10; ++i)
    {
        for (const float y : {0.0f, 1.0f})
            vertices->push_back({static_cast<float>(i), y, 0.0f});
        if (i == 10) continue;
        for (const int index : {0, 2, 1, 1, 2, 3})
            triangles->push_back(static_cast<GLushort>(2 * i + index));
    }
    osg::ref_ptr<osg::Geometry> row = new osg::Geometry;
    row->setVertexArray(vertices);
    row->addPrimitiveSet(triangles);
    return row;
}

/// A region around the first of the squares.
std::vector<TriangleCopies::Region> aroundFirst()
{
    return {{0, osg::Matrixd::translate(-0.5, -0.5, 0.0)}};
}

/// A wall of one triangle, `depth` below y from 0.4 to 0.6 of the row.
void addWall(osg::Geometry& row, float x, float depth)
{
    auto& vertices = dynamic_cast<osg::Vec3Array&>(*row.getVertexArray());
    auto& triangles = dynamic_cast<osg::DrawElementsUShort&>(*row.getPrimitiveSet(0));
    for (const osg::Vec3& corner :
         {osg::Vec3(x, 0.4f, 0.0f), osg::Vec3(x, 0.5f, -depth), osg::Vec3(x, 0.6f, 0.0f)})
    {
        triangles.push_back(static_cast<GLushort>(vertices.size()));
        vertices.push_back(corner);
    }
}

} // namespace

TEST(TriangleCopies, HaveNoWallsNearARegionsBorder)
{
    // A region 8 wide and deep, around x = 5, whose base is the ground.
    const osg::Matrixd toPlaces =
        osg::Matrixd::translate(-5.0, -0.5, 0.0) * osg::Matrixd::scale(0.25, 0.25, 1.0);
    const osg::ref_ptr<RegionOfInterest> shape = new RegionOfInterest;
    shape->setShape(RegionOfInterest::RECTANGLE);
    shape->setSize(8.0, 8.0);
    for (const auto extent : {TriangleCopies::OVER_REGIONS, TriangleCopies::EVERYWHERE})
    {
        const auto walls = [&](float x, float depth, bool shaped, bool block)
        {
            const osg::ref_ptr<osg::Geometry> row = makeRow();
            const osg::ref_ptr<osg::LOD> node = geofx::test::makeTileBlock(*row);
            addWall(*row, x, depth);
            if (!block) node->removeChildren(0, 1);
            TriangleCopies copies;
            TriangleCopies::Region region{0, toPlaces};
            if (shaped) region.shape = shape;
            const osg::Geometry* copy = copies.of(*row, {region}, false, extent);
            return copy->getPrimitiveSet(0)->getNumIndices() / 3 - 20;
        };
        // 1 from the border, at x = 9: a wall that is 0.4 deep could be seen.
        EXPECT_EQ(walls(8.0f, 0.4f, true, true), 0u);
        EXPECT_EQ(walls(8.0f, 0.3f, true, true), 1u);
        EXPECT_EQ(walls(5.0f, 0.4f, true, true), 1u);
        EXPECT_EQ(walls(8.5f, 0.3f, true, true), 0u);
        // Not a wall, or no border.
        EXPECT_EQ(walls(8.0f, 0.4f, true, false), 1u);
        EXPECT_EQ(walls(8.0f, 0.4f, false, true), 1u);
    }
}

TEST(TriangleCopies, FollowTheShapeOfARegion)
{
    const osg::ref_ptr<osg::Geometry> row = makeRow();
    const osg::ref_ptr<osg::LOD> node = geofx::test::makeTileBlock(*row);
    addWall(*row, 5.0f, 0.2f);
    const osg::ref_ptr<RegionOfInterest> shape = new RegionOfInterest;
    shape->setShape(RegionOfInterest::RECTANGLE);
    shape->setSize(40.0, 40.0);
    TriangleCopies copies;
    const auto indices = [&]
    {
        const osg::Matrixd toPlaces =
            osg::Matrixd::translate(-5.0, -0.5, 0.0) * osg::Matrixd::scale(0.05, 0.05, 1.0);
        return copies.of(*row, {{0, toPlaces, -1e9, shape, shape->revision()}}, false)
            ->getPrimitiveSet(0)
            ->getNumIndices();
    };
    EXPECT_EQ(indices(), 63u);
    // Its border runs beside the wall.
    shape->setOutline({{-1.0, -1.0}, {0.01, -1.0}, {0.01, 1.0}, {-1.0, 1.0}});
    shape->setShape(RegionOfInterest::POLYGON);
    EXPECT_EQ(indices(), 60u);
}

TEST(TriangleCopies, HaveWhatLiesOverARegion)
{
    TriangleCopies copies;
    const osg::ref_ptr<osg::Geometry> row = makeRow();
    const osg::Geometry* copy = copies.of(*row, aroundFirst(), false);
    ASSERT_TRUE(copy && copy != row.get());
    // The first square and, with the border around the region, the second's corners.
    EXPECT_EQ(copy->getPrimitiveSet(0)->getNumIndices(), 12u);
    EXPECT_EQ(copies.of(*row, aroundFirst(), false), copy);
    EXPECT_EQ(copies.of(*row, {{0, osg::Matrixd::translate(-50.0, 0.0, 0.0)}}, false), nullptr);
    EXPECT_DOUBLE_EQ(copies.longestEdge(*row), std::sqrt(2.0));
}

// Houses are often one geometry at many places.
TEST(TriangleCopies, OfOneGeometryAtSeveralPlacesDoNotChangeEachOther)
{
    TriangleCopies copies;
    const osg::ref_ptr<osg::Geometry> row = makeRow();
    const auto at = [](double x)
    {
        return std::vector<TriangleCopies::Region>{{0, osg::Matrixd::translate(-x, -0.5, 0.0)}};
    };
    const auto first = [](const osg::Geometry& copy)
    {
        return copy.getPrimitiveSet(0)->index(0);
    };
    osg::Geometry* const west = copies.of(*row, at(0.5), false);
    osg::Geometry* const east = copies.of(*row, at(9.5), false);
    ASSERT_TRUE(west && east);
    EXPECT_NE(west, east);
    EXPECT_EQ(first(*west), 0u);
    EXPECT_GT(first(*east), 12u);
    copies.startFrame();
    EXPECT_EQ(copies.of(*row, at(9.5), false), east);
    EXPECT_EQ(copies.of(*row, at(0.5), false), west);
    // A place that is no longer there gives its copy to a new one.
    copies.startFrame();
    EXPECT_EQ(copies.of(*row, at(9.5), false), east);
    EXPECT_GT(first(*copies.of(*row, at(5.5), false)), 4u);
    EXPECT_EQ(first(*east), first(*copies.of(*row, at(9.5), false)));
}

TEST(TriangleCopies, FollowNewArrays)
{
    TriangleCopies copies;
    const osg::ref_ptr<osg::Geometry> row = makeRow();
    copies.of(*row, aroundFirst(), false);
    EXPECT_DOUBLE_EQ(copies.longestEdge(*row), std::sqrt(2.0));
    osg::ref_ptr<osg::Vec3Array> wider =
        new osg::Vec3Array(static_cast<osg::Vec3Array&>(*row->getVertexArray()));
    for (osg::Vec3& vertex : *wider)
        vertex.x() *= 4.0f;
    row->setVertexArray(wider);
    const osg::Geometry* copy = copies.of(*row, aroundFirst(), false);
    ASSERT_TRUE(copy);
    EXPECT_EQ(copy->getVertexArray(), wider.get());
    EXPECT_EQ(copy->getPrimitiveSet(0)->getNumIndices(), 6u);
    EXPECT_DOUBLE_EQ(copies.longestEdge(*row), std::sqrt(17.0));
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(22);
    row->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    copy = copies.of(*row, aroundFirst(), false);
    EXPECT_EQ(copy->getColorArray(), colors.get());
}

TEST(TriangleCopies, AreDrawnAsOften)
{
    TriangleCopies copies;
    const osg::ref_ptr<osg::Geometry> row = makeRow();
    row->getPrimitiveSet(0)->setNumInstances(5);
    row->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    // Where instances stand no one knows: all are wanted, wherever the region lies.
    for (const double away : {0.0, 50.0})
    {
        const std::vector<TriangleCopies::Region> region = {{0, osg::Matrixd::translate(-away, 0.0, 0.0)}};
        EXPECT_EQ(copies.of(*row, region, false), row.get());
        const osg::Geometry* patches = copies.of(*row, region, true);
        ASSERT_TRUE(patches && patches != row.get());
        ASSERT_EQ(patches->getNumPrimitiveSets(), 2u);
        EXPECT_EQ(patches->getPrimitiveSet(0)->getMode(), static_cast<GLenum>(GL_PATCHES));
        EXPECT_EQ(patches->getPrimitiveSet(0)->getNumInstances(), 5);
        EXPECT_EQ(patches->getPrimitiveSet(0)->getNumIndices(), 60u);
        EXPECT_EQ(patches->getPrimitiveSet(1)->getNumInstances(), 0);
        EXPECT_EQ(patches->getPrimitiveSet(1)->getNumIndices(), 3u);
    }
    // A box that the owner has told: a shader may move the vertices into the region.
    const osg::ref_ptr<osg::Geometry> told = makeRow();
    told->setInitialBound(osg::BoundingBox(0, 0, 0, 100, 1, 1));
    EXPECT_EQ(copies.of(*told, {{0, osg::Matrixd::translate(-50.0, 0.0, 0.0)}}, false), told.get());
}
