// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Behind its horizon a panorama map gathers ground in one point. Triangles that reach there are drawn flat, where no ground goes;
// what is picked on them is a place of theirs all the same.
#include <osg/Geometry>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{

constexpr int CELLS = 60;
constexpr double HALF = 60000.0;

osg::ref_ptr<osg::Geometry> makePlain()
{
    osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int row = 0; row <= CELLS; ++row)
    {
        for (int column = 0; column <= CELLS; ++column)
            places->push_back(osg::Vec3d(2.0 * column / CELLS - 1.0, 2.0 * row / CELLS - 1.0, 0.0) * HALF);
    }
    for (int row = 0; row < CELLS; ++row)
    {
        for (int column = 0; column < CELLS; ++column)
        {
            const int low = row * (CELLS + 1) + column, high = low + CELLS + 1;
            for (const int corner : {low, low + 1, high, high, low + 1, high + 1})
                triangles->push_back(static_cast<GLushort>(corner));
        }
    }
    osg::ref_ptr<osg::Geometry> plain = new osg::Geometry;
    plain->setVertexArray(places);
    plain->addPrimitiveSet(triangles);
    return plain;
}

} // namespace

TEST(PanoramaPicking, WhatIsPickedLiesOnTheGround)
{
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addChild(makePlain());
    const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    map->setHorizonLine(0.5);
    scene->addEffect(map);
    const osg::Matrixd view = osg::Matrixd::lookAt(osg::Vec3d(0.0, -20000.0, 9000.0),
                                                   osg::Vec3d(0.0, 0.0, 0.0), osg::Vec3d(0.0, 0.0, 1.0));
    const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 4.0 / 3.0, 10.0, 1e6);
    const osgGeoFX::DeformedView picture(*scene, view, projection, 160.0, 120.0);
    int hits = 0;
    int gathered = 0;
    for (int y = 0; y < 120; y += 4)
    {
        for (int x = 0; x < 160; x += 4)
        {
            const auto hit = picture.pick(x + 0.5, y + 0.5);
            if (!hit) continue;
            ++hits;
            SCOPED_TRACE(std::to_string(x) + " " + std::to_string(y));
            EXPECT_LE(std::max(std::abs(hit->world.x()), std::abs(hit->world.y())), 1.001 * HALF);
            // No farther from the triangle than an edge is long.
            EXPECT_LE(std::abs(hit->world.z()), std::sqrt(2.0) * 2.0 * HALF / CELLS);
            const osg::Vec3d back = picture.chain().deform(hit->world * view);
            gathered += (back - hit->deformed).length() > 1e-3 * hit->deformed.length() ? 1 : 0;
        }
    }
    EXPECT_GT(hits, 200);
    EXPECT_GT(gathered, 0) << "no triangle reaches to where ground is gathered";
}
