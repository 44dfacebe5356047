// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/Geometry>

#include <functional>

namespace geofx::test
{

/// A mesh of so many cells along each side. `at`: the place of a share of the way to the east and to the north.
inline osg::ref_ptr<osg::Geometry> makeMesh(int cells, const std::function<osg::Vec3d(double, double)>& at)
{
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    const auto row = static_cast<unsigned int>(cells + 1);
    for (int j = 0; j <= cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            vertices->push_back(at(1.0 * i / cells, 1.0 * j / cells));
            if (i == cells || j == cells) continue;
            const auto a = static_cast<unsigned int>(vertices->size()) - 1;
            for (const unsigned int index : {a, a + 1, a + row + 1, a, a + row + 1, a + row})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(triangles);
    return geometry;
}

/// A terrain of 20 × 20 km on a plane, around the origin, of which the heights are a formula.
struct HeightMesh
{
    std::function<double(double x, double y)> heightAt;

    /// So many cells along each side.
    osg::ref_ptr<osg::Geometry> mesh(int cells) const
    {
        return makeMesh(cells,
                        [this](double east, double north)
                        {
                            const double x = -1e4 + 2e4 * east, y = -1e4 + 2e4 * north;
                            return osg::Vec3d(x, y, heightAt(x, y));
                        });
    }

    osgGeoFX::TerrainRelief relief(int cells) const
    {
        osgGeoFX::TerrainRelief result;
        result.west = result.south = -1e4;
        result.east = result.north = 1e4;
        result.columns = result.rows = cells;
        for (int row = 0; row < cells; ++row)
        {
            for (int column = 0; column < cells; ++column)
            {
                const osg::Vec2d place = result.place(column, row);
                result.heights.push_back(static_cast<float>(heightAt(place.x(), place.y())));
                result.water.push_back(0);
            }
        }
        return result;
    }
};

} // namespace geofx::test
