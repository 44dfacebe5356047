// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/StrokeTiles.h>

#include <cmath>

namespace geofx::test
{

using namespace osgGeoFX;

namespace
{

osg::ref_ptr<osg::Texture2D> texture(const StrokeTiles& tiles, double west, double south, double east,
                                     double north)
{
    constexpr int texels = 65; // on the border, too
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(texels, texels, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int row = 0; row < texels; ++row)
    {
        for (unsigned int column = 0; column < texels; ++column)
        {
            const glsl::Rgba texel = glsl::geofx_coverTexel(tiles.cover(
                west + (east - west) * column / (texels - 1), south + (north - south) * row / (texels - 1)));
            image->setColor(osg::Vec4d(texel.x, texel.y, texel.z, texel.w), column, row);
        }
    }
    osg::ref_ptr<osg::Texture2D> result = new osg::Texture2D(image);
    result->setResizeNonPowerOfTwoHint(false);
    return result;
}

} // namespace

osg::Vec3d StrokeTiles::world(double x, double y, double z) const
{
    osg::Vec3d place(x, y, z);
    if (ellipsoid) ellipsoid->convertLatLongHeightToXYZ(y, x, z, place.x(), place.y(), place.z());
    return place;
}

osg::ref_ptr<osg::MatrixTransform> StrokeTiles::tile(double west, double south, double east,
                                                     double north) const
{
    osg::Matrixd toWorld = osg::Matrixd::translate(0.5 * (west + east), 0.5 * (south + north), 0.0);
    if (ellipsoid)
        ellipsoid->computeLocalToWorldTransformFromLatLongHeight(0.5 * (south + north), 0.5 * (west + east),
                                                                 0.0, toWorld);
    const osg::Matrixd toLocal = osg::Matrixd::inverse(toWorld);
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3sArray> directions = new osg::Vec3sArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    directions->setNormalize(true);
    const auto add = [&](double column, double row, double outX, double outY, double below)
    {
        const double u = column / cells, v = row / cells;
        const double x = west + (east - west) * u, y = south + (north - south) * v;
        const double dx = (east - west) * 1e-4, dy = (north - south) * 1e-4;
        const osg::Vec3d here = world(x, y, height(x, y)) * toLocal;
        osg::Vec3d across = world(x + dx, y, height(x + dx, y)) * toLocal - here;
        osg::Vec3d along = world(x, y + dy, height(x, y + dy)) * toLocal - here;
        osg::Vec3d normal = across ^ along;
        normal.normalize();
        // Skirts lean outwards, as those of the databases.
        vertices->push_back(here + osg::Vec3d(outX, outY, 0.0) * (0.1 * below) - osg::Vec3d(0.0, 0.0, below));
        directions->push_back(osg::Vec3s(static_cast<GLshort>(std::lround(32767.0 * normal.x())),
                                         static_cast<GLshort>(std::lround(32767.0 * normal.y())),
                                         static_cast<GLshort>(std::lround(32767.0 * normal.z()))));
        const int texels = 64;
        coordinates->push_back(
            osg::Vec2d((0.5 + texels * u) / (texels + 1.0), (0.5 + texels * v) / (texels + 1.0)));
    };
    for (int row = 0; row <= cells; ++row)
        for (int column = 0; column <= cells; ++column)
            add(column, row, 0.0, 0.0, 0.0);
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    const auto post = [&](int column, int row)
    {
        return static_cast<unsigned int>(row * (cells + 1) + column);
    };
    for (int row = 0; row < cells; ++row)
    {
        for (int column = 0; column < cells; ++column)
        {
            const unsigned int a = post(column, row), b = post(column + 1, row),
                               c = post(column + 1, row + 1), d = post(column, row + 1);
            for (const unsigned int index : {a, b, c, a, c, d})
                triangles->push_back(index);
        }
    }
    // The four borders, anticlockwise.
    for (int edge = 0; edge < 4 && skirt > 0.0; ++edge)
    {
        for (int i = 0; i < cells; ++i)
        {
            const auto at = [&](int k)
            {
                const int ends[4][2] = {{k, 0}, {cells, k}, {cells - k, cells}, {0, cells - k}};
                return std::make_pair(ends[edge][0], ends[edge][1]);
            };
            const double outs[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
            const auto [x0, y0] = at(i);
            const auto [x1, y1] = at(i + 1);
            const auto low = static_cast<unsigned int>(vertices->size());
            add(x0, y0, outs[edge][0], outs[edge][1], skirt);
            add(x1, y1, outs[edge][0], outs[edge][1], skirt);
            const unsigned int a = post(x0, y0), b = post(x1, y1);
            for (const unsigned int index : {a, low, b, b, low, low + 1})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    if (normals) geometry->setNormalArray(directions);
    geometry->setTexCoordArray(0, coordinates);
    geometry->addPrimitiveSet(triangles);
    if (cover)
        geometry->getOrCreateStateSet()->setTextureAttribute(7, texture(*this, west, south, east, north));
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(toWorld);
    transform->addChild(geometry);
    return transform;
}

} // namespace geofx::test
