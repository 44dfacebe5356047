// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TileNode.h"

#include "NormalMap.h"

#include <osg/BoundingBox>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Texture2D>
#include <osg/ValueObject>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

namespace osgGeoFX
{

namespace
{

// A skirt leans outwards a little, so that it also closes hair lines when one looks straight down.
constexpr double SKIRT_LEAN = 0.1;
/// Metres; no camera is as near to a tile's middle.
constexpr double RANGE_OF_PLAINS = 1e-3;
// Metres along an edge from which on a tile's part of the globe must be taken exactly.
constexpr double LARGE_TILE = 25000.0;
constexpr int COLOR_UNIT = 0, LAND_COVER_UNIT = 1, COVER_UNIT = 7;

/// The side of a tile (0 south, 1 east, 2 north, 3 west) along which two neighbours on its border lie.
int sideOf(const TileMesh::Post& a, const TileMesh::Post& b)
{
    if (a.row == b.row) return a.row == 0 ? 0 : 2;
    return a.column > 0 ? 1 : 3;
}

osg::ref_ptr<osg::Image> cutImage(const std::vector<unsigned char>& texels, int columns, int x0, int y0,
                                  int size, int channels)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    const GLenum format = channels == 4 ? GL_RGBA : channels == 3 ? GL_RGB : GL_RED;
    image->allocateImage(size, size, 1, format, GL_UNSIGNED_BYTE, 1);
    image->setInternalTextureFormat(channels == 4 ? GL_RGBA8 : channels == 3 ? GL_RGB8 : GL_R8);
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
    // With a buffer object of their own, shared arrays do not join that of the first geometry that takes them, which
    // would make a file's bytes depend on the order of the work.
    _sharedBuffer = new osg::VertexBufferObject;
    _white = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
    _white->front().set(1.0f, 1.0f, 1.0f, UNLIT_ALPHA);
    _white->setVertexBufferObject(_sharedBuffer);
}

TileMesh TileNodeFactory::createMesh(const TileKey& key, const LevelArrays& arrays, int x, int y) const
{
    const TilingScheme& scheme = _plan.scheme;
    const int intervals = (arrays.heights.columns - 1) / arrays.span; // of the tile, at the heights' density
    const int posts = scheme.intervals * scheme.step(key.level) / intervals; // finest posts to each of these
    const int firstColumn = scheme.firstColumn(key), firstRow = scheme.firstRow(key);
    TileLattice lattice{arrays.heights,
                        x * intervals,
                        y * intervals,
                        intervals,
                        (scheme.lastColumn - firstColumn + posts - 1) / posts,
                        (scheme.lastRow - firstRow + posts - 1) / posts,
                        {},
                        {},
                        {}};
    const double middle = scheme.gridY(firstRow + 0.5 * posts * intervals);
    const auto drop = [&](int index, double metres)
    {
        if (!scheme.crs.geographic) return 0.0f;
        const double radius = GeographicLib::Constants::WGS84_a();
        const double angle = std::min((index - 0.5 * intervals) * posts * metres / radius, osg::PI);
        return static_cast<float>(radius * (1.0 - std::cos(angle)));
    };
    for (int i = 0; i <= intervals; ++i)
    {
        lattice.dropX.push_back(drop(i, scheme.metresX(middle)));
        lattice.dropY.push_back(drop(i, scheme.metresY(middle)));
    }
    if (key.level == scheme.finestLevel) return createFullMesh(lattice);
    if (scheme.crs.geographic && scheme.tileMetres(key.level) > LARGE_TILE)
    {
        const TileFrame frame(scheme, key);
        for (int r = 0; r <= intervals; ++r)
            for (int c = 0; c <= intervals; ++c)
                lattice.places.push_back(osg::Vec3f(frame.position(
                    scheme.gridX(firstColumn + c * posts), scheme.gridY(firstRow + r * posts),
                    static_cast<double>(arrays.heights.at(lattice.column + c, lattice.row + r)))));
    }
    const TileSlopes slopes{arrays.slopeX,        arrays.slopeY,        arrays.span * scheme.intervals + 1,
                            x * scheme.intervals, y * scheme.intervals, scheme.intervals};
    return createAdaptiveMesh(lattice, slopes, _plan.tolerance(key.level));
}

osg::ref_ptr<osg::Geometry> TileNodeFactory::createGeometry(const TileKey& key, const LevelArrays& arrays,
                                                            int x, int y, const TileMesh& mesh)
{
    const TilingScheme& scheme = _plan.scheme;
    const int n = scheme.intervals, intervals = (arrays.heights.columns - 1) / arrays.span;
    const double posts = static_cast<double>(n) * scheme.step(key.level) / intervals;
    const int firstColumn = scheme.firstColumn(key), firstRow = scheme.firstRow(key);
    const double texels = scheme.textureIntervals(key.level);
    const TileFrame frame(scheme, key);
    const auto gridX = [&](int column)
    {
        return scheme.gridX(firstColumn + column * posts);
    };
    const auto gridY = [&](int row)
    {
        return scheme.gridY(firstRow + row * posts);
    };

    const std::size_t count = mesh.posts.size() + mesh.edge.size();
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3sArray> normals = new osg::Vec3sArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> texCoords = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    normals->setNormalize(true);
    vertices->reserve(count);
    normals->reserve(count);
    texCoords->reserve(count);

    // The level's slopes lie on its own posts; between them they are interpolated.
    const int stride = arrays.span * n + 1;
    const auto slope = [&](const std::vector<float>& values, int column, int row)
    {
        const double c = x * n + static_cast<double>(column) * n / intervals;
        const double r = y * n + static_cast<double>(row) * n / intervals;
        const int c0 = std::min(static_cast<int>(c), stride - 2),
                  r0 = std::min(static_cast<int>(r), stride - 2);
        const double u = c - c0, v = r - r0;
        const auto at = [&](int i, int j)
        {
            return static_cast<double>(values[static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) +
                                              static_cast<std::size_t>(i)]);
        };
        return (at(c0, r0) * (1.0 - u) + at(c0 + 1, r0) * u) * (1.0 - v) +
               (at(c0, r0 + 1) * (1.0 - u) + at(c0 + 1, r0 + 1) * u) * v;
    };
    osg::Vec3d east, north, up;
    for (const TileMesh::Post& post : mesh.posts)
    {
        const double gx = gridX(post.column), gy = gridY(post.row);
        float height = arrays.heights.at(x * intervals + post.column, y * intervals + post.row);
        if (std::isnan(height)) // no triangle uses it; it must only not widen the tile's box
            height = _plan.fact(key).minHeight;
        vertices->push_back(osg::Vec3(frame.position(gx, gy, static_cast<double>(height))));
        frame.axes(gx, gy, east, north, up);
        osg::Vec3d normal = up - east * slope(arrays.slopeX, post.column, post.row) -
                            north * slope(arrays.slopeY, post.column, post.row);
        normal.normalize();
        normals->push_back(osg::Vec3s(static_cast<GLshort>(std::lround(normal.x() * 32767.0)),
                                      static_cast<GLshort>(std::lround(normal.y() * 32767.0)),
                                      static_cast<GLshort>(std::lround(normal.z() * 32767.0))));
        // Texels lie on the tile's border, so that neighbours of a level meet without a seam.
        const double u =
            std::min<double>(post.column * posts, scheme.lastColumn - firstColumn) / (posts * intervals);
        const double v = std::min<double>(post.row * posts, scheme.lastRow - firstRow) / (posts * intervals);
        texCoords->push_back(osg::Vec2(static_cast<float>((0.5 + texels * u) / (texels + 1.0)),
                                       static_cast<float>((0.5 + texels * v) / (texels + 1.0))));
    }

    // The skirt: the border's posts again, lower, in the border's order; corners go as deep as either side.
    double depths[4] = {};
    for (int side = 0; side < 4; ++side)
        depths[side] = _plan.skirt(key, side);
    for (const std::uint32_t index : mesh.edge)
    {
        const TileMesh::Post post = mesh.posts[index];
        double depth = 0.0, outX = 0.0, outY = 0.0;
        bool ends = false; // on the terrain's border, where all levels have the same post
        const auto onSide = [&](bool on, int side, double dx, double dy)
        {
            if (!on) return;
            ends = ends || depths[side] <= 0.0;
            depth = std::max(depth, depths[side]);
            outX += dx;
            outY += dy;
        };
        onSide(post.row == 0, 0, 0.0, -1.0);
        onSide(post.column == intervals || firstColumn + post.column * posts >= scheme.lastColumn, 1, 1.0,
               0.0);
        onSide(post.row == intervals || firstRow + post.row * posts >= scheme.lastRow, 2, 0.0, 1.0);
        onSide(post.column == 0, 3, -1.0, 0.0);
        // Above the first posts of a finer neighbour it may still stand, by its own error; deeper, or leaning, the
        // wall's end would show below the terrain's border.
        if (ends)
        {
            depth = std::min(depth, 1.5 * static_cast<double>(_plan.fact(key).error));
            outX = outY = 0.0;
        }
        frame.axes(gridX(post.column), gridY(post.row), east, north, up);
        const osg::Vec3d offset = (east * outX + north * outY) * (SKIRT_LEAN * depth) - up * depth;
        vertices->push_back((*vertices)[index] + osg::Vec3(offset));
        normals->push_back(osg::Vec3s((*normals)[index]));
        texCoords->push_back(osg::Vec2((*texCoords)[index]));
    }

    std::vector<std::uint32_t> elements = mesh.triangles;
    bool whole = key.level == scheme.finestLevel && firstColumn + n <= scheme.lastColumn &&
                 firstRow + n <= scheme.lastRow;
    whole = whole && *std::min_element(std::begin(depths), std::end(depths)) > 0.0 &&
            elements.size() == std::size_t{6} * static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    // A wall hangs from each edge of the surface along the border; not across a hole, nor beyond the ground's end.
    std::vector<bool> onBorder(mesh.posts.size(), false);
    for (const std::uint32_t index : mesh.edge)
        onBorder[index] = true;
    std::set<std::pair<std::uint32_t, std::uint32_t>> borders;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    {
        const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i % 3 == 2 ? i - 2 : i + 1];
        if (onBorder[a] && onBorder[b]) borders.insert({a, b});
    }
    for (std::size_t k = 0; k + 1 < mesh.edge.size(); ++k)
    {
        const std::uint32_t a = mesh.edge[k], b = mesh.edge[k + 1];
        if (!borders.count({a, b}) || depths[sideOf(mesh.posts[a], mesh.posts[b])] <= 0.0) continue;
        const auto lowA = static_cast<std::uint32_t>(mesh.posts.size() + k);
        for (const std::uint32_t index : {a, lowA, b, b, lowA, lowA + 1})
            elements.push_back(index);
    }

    osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
    vertices->setVertexBufferObject(buffer);
    normals->setVertexBufferObject(buffer);
    texCoords->setVertexBufferObject(buffer);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals);
    osg::ref_ptr<osg::PrimitiveSet> primitives;
    if (count <= 65536)
        primitives =
            new osg::DrawElementsUShort(osg::PrimitiveSet::TRIANGLES, elements.begin(), elements.end());
    else
        primitives =
            new osg::DrawElementsUInt(osg::PrimitiveSet::TRIANGLES, elements.begin(), elements.end());
    if (whole)
    {
        // The four of a file share what is the same in all of them.
        if (!_wholePrimitives)
        {
            _wholeTexCoords = texCoords;
            _wholeTexCoords->setVertexBufferObject(_sharedBuffer);
            _wholePrimitives = primitives;
            _wholePrimitives->getDrawElements()->setElementBufferObject(new osg::ElementBufferObject);
        }
        texCoords = _wholeTexCoords;
        primitives = _wholePrimitives;
    }
    geometry->setTexCoordArray(COLOR_UNIT, texCoords);
    geometry->setColorArray(_white);
    geometry->addPrimitiveSet(primitives);
    return geometry;
}

osg::ref_ptr<osg::StateSet> TileNodeFactory::createState(const TileKey& key, const LevelArrays& arrays, int x,
                                                         int y) const
{
    const int m = _plan.scheme.textureIntervals(arrays.level);
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Texture2D> color =
        new osg::Texture2D(cutImage(arrays.colors, arrays.texelColumns, x * m, y * m, m + 1, 3));
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
        osg::ref_ptr<osg::Texture2D> classes =
            new osg::Texture2D(cutImage(arrays.classes, arrays.texelColumns, x * m, y * m, m + 1, 1));
        classes->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        classes->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
        classes->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        classes->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        classes->setResizeNonPowerOfTwoHint(false);
        state->setTextureAttribute(LAND_COVER_UNIT, classes);
    }
    osg::ref_ptr<osg::Texture2D> cover =
        new osg::Texture2D(cutImage(arrays.cover, arrays.texelColumns, x * m, y * m, m + 1, 4));
    cover->setName("geofx cover");
    cover->setInternalFormat(GL_RGBA8);
    cover->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    cover->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    cover->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    cover->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    cover->setResizeNonPowerOfTwoHint(false);
    state->setTextureAttribute(COVER_UNIT, cover);
    addNormalMap(*state, _plan.scheme, key, arrays, x, y);
    return state;
}

osg::ref_ptr<osg::Node> TileNodeFactory::create(const TileKey& key, const LevelArrays& arrays, int x, int y)
{
    const TilingScheme& scheme = _plan.scheme;
    const TileFacts& facts = _plan.fact(key);
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(TileFrame(scheme, key).localToWorld());
    transform->setName("tile " + key.path());

    const TileMesh mesh = createMesh(key, arrays, x, y);
    osg::BoundingBoxd box;
    double radius = 0.0;
    if (!mesh.triangles.empty())
    {
        const osg::ref_ptr<osg::Geometry> geometry = createGeometry(key, arrays, x, y, mesh);
        geometry->setStateSet(createState(key, arrays, x, y));
        transform->addChild(geometry);
        const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry->getVertexArray());
        for (const auto& vertex : vertices)
            box.expandBy(osg::Vec3d(vertex));
        for (const auto& vertex : vertices)
            radius = std::max(radius, (osg::Vec3d(vertex) - box.center()).length());
    }
    else
    {
        // Data so scattered that no triangle of this level holds any; the finer levels draw it.
        const TileFrame frame(scheme, key);
        const int span = scheme.intervals * scheme.step(key.level);
        for (int c = 0; c < 4; ++c)
            for (const float height : {facts.minHeight, facts.maxHeight})
                box.expandBy(frame.position(scheme.gridX(scheme.firstColumn(key) + (c & 1) * span),
                                            scheme.gridY(scheme.firstRow(key) + (c >> 1) * span),
                                            static_cast<double>(height)));
        radius = box.radius();
    }
    transform->setUserValue("geofx.boxMin", osg::Vec3d(box._min));
    transform->setUserValue("geofx.boxMax", osg::Vec3d(box._max));
    if (key.level == scheme.finestLevel) return transform;

    // Seen from d metres, a length e covers e·k/d pixels. The nearest point of the tile is at least d − R away, so
    // the finer tiles are due where d < R + e·k/limit.
    const double relief = mesh.deviation + static_cast<double>(facts.latticeError);
    const double texel =
        static_cast<double>(arrays.textureError[static_cast<std::size_t>(y * arrays.span + x)]);
    const double error = std::max(relief / _plan.options.pixelError, texel / _plan.options.texelError);
    // Without an error they are due where a deformation asks for them alone (DeformationChain::lodLimit).
    const double range = error > 0.0 ? radius + error * _plan.options.pixelsPerRadian : RANGE_OF_PLAINS;

    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setName("tile " + key.path());
    lod->setRangeMode(osg::LOD::DISTANCE_FROM_EYE_POINT);
    lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    lod->setCenter(osg::Vec3(box.center() * transform->getMatrix()));
    lod->setRadius(static_cast<float>(radius + static_cast<double>(facts.error + facts.skirtBelow)));
    lod->addChild(transform, static_cast<float>(range), std::numeric_limits<float>::max());
    // A file holds the four children of a tile; the root's lies beside no other tile.
    lod->setFileName(1, (key.level == 0 ? "tiles/" : "../../") + key.path() + ".osgb");
    lod->setRange(1, 0.0f, static_cast<float>(range));
    lod->setNumChildrenThatCannotBeExpired(1);
    return lod;
}

} // namespace osgGeoFX
