// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TileNode.h"

#include <osg/BoundingBox>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Texture2D>
#include <osg/ValueObject>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace osgGeoFX
{

namespace
{

// A skirt leans outwards a little, so that it also closes hair lines when one looks straight down.
constexpr double SKIRT_LEAN = 0.1;
constexpr int COLOR_UNIT = 0, LAND_COVER_UNIT = 1;

osg::ref_ptr<osg::Image> cutImage(const std::vector<unsigned char>& texels, int columns, int x0, int y0, int size,
                                  int channels)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size, size, 1, channels == 3 ? GL_RGB : GL_RED, GL_UNSIGNED_BYTE, 1);
    image->setInternalTextureFormat(channels == 3 ? GL_RGB8 : GL_R8);
    for (int row = 0; row < size; ++row)
        std::memcpy(image->data(0, row),
                    texels.data() + (static_cast<std::size_t>(y0 + row) * static_cast<std::size_t>(columns) +
                                     static_cast<std::size_t>(x0)) *
                                        static_cast<std::size_t>(channels),
                    static_cast<std::size_t>(size) * static_cast<std::size_t>(channels));
    return image;
}

} // namespace

TileNodeFactory::TileNodeFactory(const BuildPlan& plan) : _plan(plan)
{
    const int nx = plan.scheme.intervalsX, ny = plan.scheme.intervalsY, stride = nx + 1;
    for (int i = 0; i < nx; ++i)
        _edge.push_back(i);
    for (int j = 0; j < ny; ++j)
        _edge.push_back(j * stride + nx);
    for (int i = nx; i > 0; --i)
        _edge.push_back(ny * stride + i);
    for (int j = ny; j >= 0; --j)
        _edge.push_back(j * stride);

    // Texels lie on the tile's border, so that neighbours of a level meet without a seam.
    const auto coordinate = [&](int index, int intervals)
    {
        const double m = plan.scheme.textureIntervals;
        return static_cast<float>((0.5 + m * index / intervals) / (m + 1.0));
    };
    _texCoords = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i)
            _texCoords->push_back(osg::Vec2(coordinate(i, nx), coordinate(j, ny)));
    for (const int post : _edge)
        _texCoords->push_back((*_texCoords)[static_cast<std::size_t>(post)]);
    _white = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
    _white->front().set(1.0f, 1.0f, 1.0f, 1.0f);
    _wholeElements = createElements(std::vector<bool>(static_cast<std::size_t>((nx + 1) * (ny + 1)), true));

    // Left alone, an array joins the buffer object of the first geometry that takes it; which one that is depends
    // on the order of the work, and a file's bytes must not.
    osg::ref_ptr<osg::VertexBufferObject> shared = new osg::VertexBufferObject;
    _texCoords->setVertexBufferObject(shared);
    _white->setVertexBufferObject(shared);
}

osg::ref_ptr<osg::DrawElementsUShort> TileNodeFactory::createElements(const std::vector<bool>& valid) const
{
    const int nx = _plan.scheme.intervalsX, ny = _plan.scheme.intervalsY, stride = nx + 1;
    osg::ref_ptr<osg::DrawElementsUShort> elements = new osg::DrawElementsUShort(osg::PrimitiveSet::TRIANGLES);
    const auto triangle = [&](int a, int b, int c)
    {
        if (!valid[static_cast<std::size_t>(a)] || !valid[static_cast<std::size_t>(b)] ||
            !valid[static_cast<std::size_t>(c)])
            return;
        for (const int index : {a, b, c})
            elements->push_back(static_cast<GLushort>(index));
    };
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
        {
            const int sw = j * stride + i, se = sw + 1, nw = sw + stride, ne = nw + 1;
            triangle(sw, se, ne);
            triangle(sw, ne, nw);
        }
    elements->setElementBufferObject(new osg::ElementBufferObject);
    const int posts = (nx + 1) * (ny + 1);
    for (std::size_t k = 0; k + 1 < _edge.size(); ++k)
    {
        const int a = _edge[k], b = _edge[k + 1];
        if (!valid[static_cast<std::size_t>(a)] || !valid[static_cast<std::size_t>(b)])
            continue;
        const int lowA = posts + static_cast<int>(k), lowB = lowA + 1;
        for (const int index : {a, lowA, b, b, lowA, lowB})
            elements->push_back(static_cast<GLushort>(index));
    }
    return elements;
}

osg::ref_ptr<osg::Geometry> TileNodeFactory::createGeometry(const TileKey& key, const LevelArrays& arrays, int x,
                                                            int y) const
{
    const TilingScheme& scheme = _plan.scheme;
    const int nx = scheme.intervalsX, ny = scheme.intervalsY, stride = nx + 1;
    const Lattice lattice = scheme.lattice(key.level, key.x, key.y, 1, nx, ny);
    const TileFrame frame(scheme, key);
    const std::size_t posts = static_cast<std::size_t>(stride) * static_cast<std::size_t>(ny + 1);

    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3sArray> normals = new osg::Vec3sArray(osg::Array::BIND_PER_VERTEX);
    normals->setNormalize(true);
    vertices->reserve(posts + _edge.size());
    normals->reserve(posts + _edge.size());
    std::vector<bool> valid(posts, true);
    bool whole = true;
    osg::Vec3d east, north, up;
    for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i)
        {
            const double gx = lattice.x0 + i * lattice.dx, gy = lattice.y0 + j * lattice.dy;
            const int column = x * nx + i, row = y * ny + j;
            float height = arrays.heights.at(column, row);
            const std::size_t index = static_cast<std::size_t>(row) * static_cast<std::size_t>(arrays.heights.columns) +
                                      static_cast<std::size_t>(column);
            if (std::isnan(height))
            {
                // No triangle uses it; it must only not widen the tile's box.
                height = _plan.fact(key).minHeight;
                valid[static_cast<std::size_t>(j * stride + i)] = false;
                whole = false;
            }
            vertices->push_back(osg::Vec3(frame.position(gx, gy, static_cast<double>(height))));
            frame.axes(gx, gy, east, north, up);
            osg::Vec3d normal = up - east * static_cast<double>(arrays.slopeX[index]) -
                                north * static_cast<double>(arrays.slopeY[index]);
            normal.normalize();
            normals->push_back(osg::Vec3s(static_cast<GLshort>(std::lround(normal.x() * 32767.0)),
                                          static_cast<GLshort>(std::lround(normal.y() * 32767.0)),
                                          static_cast<GLshort>(std::lround(normal.z() * 32767.0))));
        }

    // The skirt: each edge's posts again, lower, in the order of the edge; corners go as deep as either edge.
    const float depths[] = {_plan.horizontalSkirt(key.level, key.y, key.x),
                            _plan.verticalSkirt(key.level, key.x + 1, key.y),
                            _plan.horizontalSkirt(key.level, key.y + 1, key.x),
                            _plan.verticalSkirt(key.level, key.x, key.y)};
    for (const int post : _edge)
    {
        const int i = post % stride, j = post / stride;
        double depth = 0.0, outX = 0.0, outY = 0.0;
        const auto edge = [&](bool on, int side, double dx, double dy)
        {
            if (!on)
                return;
            depth = std::max(depth, static_cast<double>(depths[side]));
            outX += dx;
            outY += dy;
        };
        edge(j == 0, 0, 0.0, -1.0);
        edge(i == nx, 1, 1.0, 0.0);
        edge(j == ny, 2, 0.0, 1.0);
        edge(i == 0, 3, -1.0, 0.0);
        frame.axes(lattice.x0 + i * lattice.dx, lattice.y0 + j * lattice.dy, east, north, up);
        const osg::Vec3d offset = (east * outX + north * outY) * (SKIRT_LEAN * depth) - up * depth;
        vertices->push_back((*vertices)[static_cast<std::size_t>(post)] + osg::Vec3(offset));
        normals->push_back((*normals)[static_cast<std::size_t>(post)]);
    }

    osg::ref_ptr<osg::DrawElementsUShort> elements = whole ? _wholeElements : createElements(valid);
    if (elements->empty())
        return nullptr;
    osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    vertices->setVertexBufferObject(buffer);
    normals->setVertexBufferObject(buffer);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals);
    geometry->setColorArray(_white);
    geometry->setTexCoordArray(COLOR_UNIT, _texCoords);
    geometry->addPrimitiveSet(elements);
    return geometry;
}

osg::ref_ptr<osg::StateSet> TileNodeFactory::createState(const LevelArrays& arrays, int x, int y) const
{
    const int m = _plan.scheme.textureIntervals;
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Texture2D> color = new osg::Texture2D(
        cutImage(arrays.colors, arrays.texelColumns, x * m, y * m, m + 1, 3));
    color->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    color->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    color->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    color->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    color->setResizeNonPowerOfTwoHint(false);
    color->setMaxAnisotropy(4.0f);
    state->setTextureAttributeAndModes(COLOR_UNIT, color);
    if (!arrays.classes.empty())
    {
        // Bound for shaders that want it, but not enabled: the fixed pipeline must not draw it.
        osg::ref_ptr<osg::Texture2D> classes = new osg::Texture2D(
            cutImage(arrays.classes, arrays.texelColumns, x * m, y * m, m + 1, 1));
        classes->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        classes->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
        classes->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        classes->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        classes->setResizeNonPowerOfTwoHint(false);
        state->setTextureAttribute(LAND_COVER_UNIT, classes);
    }
    return state;
}

osg::ref_ptr<osg::Node> TileNodeFactory::create(const TileKey& key, const LevelArrays& arrays, int x, int y,
                                                const std::string& file)
{
    const TileFacts& facts = _plan.fact(key);
    if (!facts.any)
        return nullptr;

    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(TileFrame(_plan.scheme, key).localToWorld());
    transform->setName("tile " + key.path());
    osg::BoundingBoxd box;
    // Null where data is so scattered that no triangle of this level holds any; the finer levels draw it.
    if (const osg::ref_ptr<osg::Geometry> geometry = createGeometry(key, arrays, x, y))
    {
        geometry->setStateSet(createState(arrays, x, y));
        transform->addChild(geometry);
        for (const auto& vertex : static_cast<const osg::Vec3Array&>(*geometry->getVertexArray()))
            box.expandBy(osg::Vec3d(vertex));
    }
    else
    {
        const TilingScheme& scheme = _plan.scheme;
        const Lattice corners = scheme.lattice(key.level, key.x, key.y, 1, 1, 1);
        const TileFrame frame(scheme, key);
        for (int c = 0; c < 4; ++c)
            for (const float height : {facts.minHeight, facts.maxHeight})
                box.expandBy(frame.position(corners.x0 + (c & 1) * corners.dx, corners.y0 + (c >> 1) * corners.dy,
                                            static_cast<double>(height)));
    }
    transform->setUserValue("geofx.boxMin", osg::Vec3d(box._min));
    transform->setUserValue("geofx.boxMax", osg::Vec3d(box._max));
    if (key.level == _plan.scheme.finestLevel)
        return transform;

    double radius = 0.0;
    if (transform->getNumChildren() > 0)
    {
        const auto* geometry = transform->getChild(0)->asDrawable()->asGeometry();
        for (const auto& vertex : static_cast<const osg::Vec3Array&>(*geometry->getVertexArray()))
            radius = std::max(radius, (osg::Vec3d(vertex) - box.center()).length());
    }
    else
        radius = box.radius();

    // Seen from d metres, a length e covers e·k/d pixels. The nearest point of the tile is at least d − R away, so
    // the finer tiles are due where d < R + e·k/limit.
    const double sag = _plan.scheme.chordSag(key.level);
    const double error = std::max((static_cast<double>(facts.error) + sag) / _plan.options.pixelError,
                                  static_cast<double>(arrays.textureError[static_cast<std::size_t>(
                                      y * ((arrays.texelColumns - 1) / _plan.scheme.textureIntervals) + x)]) /
                                      _plan.options.texelError);
    const double range = error > 0.0 ? radius + error * _plan.options.pixelsPerRadian : 0.0;

    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setName("tile " + key.path());
    lod->setRangeMode(osg::LOD::DISTANCE_FROM_EYE_POINT);
    lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    lod->setCenter(osg::Vec3(box.center() * transform->getMatrix()));
    lod->setRadius(static_cast<float>(radius + static_cast<double>(facts.error + facts.skirtBelow) + sag));
    lod->addChild(transform, static_cast<float>(range), std::numeric_limits<float>::max());
    lod->setFileName(1, file);
    lod->setRange(1, 0.0f, static_cast<float>(range));
    lod->setNumChildrenThatCannotBeExpired(1);
    return lod;
}

} // namespace osgGeoFX
