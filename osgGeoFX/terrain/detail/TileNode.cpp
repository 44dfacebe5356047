// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TileNode.h>

#include <osgGeoFX/terrain/detail/NormalMap.h>
#include <osgGeoFX/terrain/detail/TileBlocks.h>
#include <osgGeoFX/terrain/detail/TileHorizon.h>

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

namespace osgGeoFX
{

namespace
{

/// A distance, metres. No camera is as near to a tile's middle.
constexpr double RANGE_OF_PLAINS = 1e-3;
// From this edge length on, metres, the globe's curve in a tile is computed exactly.
constexpr double LARGE_TILE = 25000.0;
constexpr int COLOR_UNIT = 0, LAND_COVER_UNIT = 1, COVER_UNIT = 7;

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

/// Makes the nodes of a tile's blocks.
class BlockNodes
{
public:
    BlockNodes(const TileBlocks& blocks, osg::Array* color, osg::StateSet* state)
        : _blocks(blocks), _color(color), _state(state)
    {
        // The arrays have a buffer of their own, whichever geometry takes them first. They do not share one: drivers
        // count how often a buffer is written.
        for (const auto& vertices : blocks.vertices())
        {
            osg::ref_ptr<osg::VertexBufferObject> buffer = new osg::VertexBufferObject;
            vertices->vertices->setVertexBufferObject(buffer);
            vertices->normals->setVertexBufferObject(buffer);
            vertices->texCoords->setVertexBufferObject(buffer);
        }
    }

    osg::ref_ptr<osg::Node> all() const
    {
        if (_blocks.roots() == 1) return node(_blocks.blocks().front());
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (std::size_t i = 0; i < _blocks.roots(); ++i)
            group->addChild(node(_blocks.blocks()[i]));
        return group;
    }

private:
    osg::ref_ptr<osg::Node> node(const TileBlocks::Block& block) const
    {
        const TileVertices& vertices = *_blocks.vertices()[block.vertices];
        osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        osg::ref_ptr<osg::Vec2Array> meshes = new osg::Vec2Array;
        lod->setRangeMode(osg::LOD::DISTANCE_FROM_EYE_POINT);
        lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        lod->setCenter(osg::Vec3(block.middle));
        double radius = 0.0;
        if (!block.finer.empty())
        {
            osg::ref_ptr<osg::Group> finer = new osg::Group;
            for (const std::size_t each : block.finer)
                finer->addChild(node(_blocks.blocks()[each]));
            for (unsigned int i = 0; i < finer->getNumChildren(); ++i)
            {
                const osg::BoundingSphere& bound = finer->getChild(i)->getBound();
                radius = std::max(radius, (osg::Vec3d(bound.center()) - block.middle).length() +
                                              static_cast<double>(bound.radius()));
            }
            const double to = block.meshes.empty() ? NO_LIMIT : block.finerWithin;
            lod->addChild(finer, 0.0f, static_cast<float>(to));
            meshes->push_back(osg::Vec2());
        }
        for (std::size_t i = 0; i < block.meshes.size(); ++i)
        {
            const TileBlocks::Mesh& mesh = block.meshes[i];
            for (const std::uint32_t index : mesh.triangles)
                radius = std::max(radius, (osg::Vec3d((*vertices.vertices)[index]) - block.middle).length());
            const double to = i + 1 < block.meshes.size() ? block.meshes[i + 1].from : NO_LIMIT;
            lod->addChild(geometry(mesh, vertices), static_cast<float>(mesh.from), static_cast<float>(to));
            meshes->push_back(osg::Vec2(osg::Vec2d(mesh.longestEdge, static_cast<double>(mesh.ground))));
        }
        lod->setRadius(static_cast<float>(radius));
        lod->setUserData(meshes);
        return lod;
    }

    osg::ref_ptr<osg::Geometry> geometry(const TileBlocks::Mesh& mesh, const TileVertices& vertices) const
    {
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setUseDisplayList(false);
        geometry->setUseVertexBufferObjects(true);
        geometry->setVertexArray(vertices.vertices);
        geometry->setNormalArray(vertices.normals);
        geometry->setTexCoordArray(COLOR_UNIT, vertices.texCoords);
        geometry->setColorArray(_color);
        osg::ref_ptr<osg::DrawElements> elements;
        if (vertices.vertices->size() <= 65536)
            elements = new osg::DrawElementsUShort(osg::PrimitiveSet::TRIANGLES, mesh.triangles.begin(),
                                                   mesh.triangles.end());
        else
            elements = new osg::DrawElementsUInt(osg::PrimitiveSet::TRIANGLES, mesh.triangles.begin(),
                                                 mesh.triangles.end());
        // Indices have a buffer of their own: adding to a buffer in use makes drivers wait.
        elements->setElementBufferObject(new osg::ElementBufferObject);
        geometry->addPrimitiveSet(elements);
        geometry->setStateSet(_state);
        return geometry;
    }

    static constexpr auto NO_LIMIT = static_cast<double>(std::numeric_limits<float>::max());

    const TileBlocks& _blocks;
    const osg::ref_ptr<osg::Array> _color;
    const osg::ref_ptr<osg::StateSet> _state;
};

/// The color of a tile's vertices. Each tile has its own, so the bytes of a file do not tell which unit has made its tiles.
osg::ref_ptr<osg::Vec4Array> createWhite()
{
    osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
    white->front().set(1.0f, 1.0f, 1.0f, UNLIT_ALPHA);
    // Shared arrays have a buffer object of their own. Otherwise they would join that of the first geometry that
    // takes them, and a file's bytes would depend on the order of the work.
    white->setVertexBufferObject(new osg::VertexBufferObject);
    return white;
}

} // namespace

TileNodeFactory::TileNodeFactory(const BuildPlan& plan)
    : _plan(plan), _textures(plan.options.compressTextures)
{
}

TileLattice TileNodeFactory::createLattice(const TileKey& key, const LevelArrays& arrays, int x, int y) const
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
    if (scheme.crs.geographic && scheme.tileMetres(key.level) > LARGE_TILE)
    {
        const TileFrame frame(scheme, key);
        for (int r = 0; r <= intervals; ++r)
            for (int c = 0; c <= intervals; ++c)
                lattice.places.push_back(osg::Vec3f(frame.position(
                    scheme.gridX(firstColumn + c * posts), scheme.gridY(firstRow + r * posts),
                    static_cast<double>(arrays.heights.at(lattice.column + c, lattice.row + r)))));
    }
    return lattice;
}

osg::ref_ptr<osg::StateSet> TileNodeFactory::createState(const TileKey& key, const LevelArrays& arrays, int x,
                                                         int y)
{
    const int m = _plan.scheme.textureIntervals(arrays.level);
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Texture2D> color = new osg::Texture2D(
        _textures.picture(cutImage(arrays.colors, arrays.texelColumns, x * m, y * m, m + 1, 3)));
    color->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    color->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    color->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    color->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    color->setResizeNonPowerOfTwoHint(false);
    const double wanted = _plan.options.anisotropy;
    color->setMaxAnisotropy(wanted > 0.0                    ? static_cast<float>(wanted)
                            : _plan.options.imagery.empty() ? 1.0f
                                                            : 4.0f);
    state->setTextureAttributeAndModes(COLOR_UNIT, color);
    if (!arrays.classes.empty())
    {
        // Bound for shaders that want it, but not enabled: the fixed functions must not draw it.
        osg::ref_ptr<osg::Texture2D> classes = new osg::Texture2D(
            _textures.data(cutImage(arrays.classes, arrays.texelColumns, x * m, y * m, m + 1, 1), false));
        classes->setName("geofx classes");
        classes->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        classes->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
        classes->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        classes->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        classes->setResizeNonPowerOfTwoHint(false);
        state->setTextureAttribute(LAND_COVER_UNIT, classes);
    }
    osg::ref_ptr<osg::Texture2D> cover = new osg::Texture2D(
        _textures.data(cutImage(arrays.cover, arrays.texelColumns, x * m, y * m, m + 1, 4), true));
    cover->setName("geofx cover");
    cover->setInternalFormat(GL_RGBA8);
    cover->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    cover->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    cover->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    cover->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    cover->setResizeNonPowerOfTwoHint(false);
    state->setTextureAttribute(COVER_UNIT, cover);
    addNormalMap(*state, _textures, _plan.scheme, key, arrays, x, y);
    return state;
}

osg::ref_ptr<osg::Node> TileNodeFactory::create(const TileKey& key, const LevelArrays& arrays, int x, int y)
{
    const TilingScheme& scheme = _plan.scheme;
    const TileFacts& facts = _plan.fact(key);
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(TileFrame(scheme, key).localToWorld());
    transform->setName("tile " + key.path());

    const TileLattice lattice = createLattice(key, arrays, x, y);
    const TileNetwork network(lattice);
    const TileBlocks blocks(_plan, key, network, arrays, x, y);
    osg::BoundingBoxd box;
    double radius = 0.0;
    if (!blocks.empty())
    {
        transform->addChild(BlockNodes(blocks, createWhite(), createState(key, arrays, x, y)).all());
        for (const auto& vertices : blocks.vertices())
            for (const auto& vertex : *vertices->vertices)
                box.expandBy(osg::Vec3d(vertex));
        for (const auto& vertices : blocks.vertices())
            for (const auto& vertex : *vertices->vertices)
                radius = std::max(radius, (osg::Vec3d(vertex) - box.center()).length());
    }
    else
    {
        // The data are so scattered that no triangle of this level has any. Finer levels draw them.
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
    transform->setUserValue("geofx.cells", lattice.intervals);
    const int texels = scheme.textureIntervals(key.level);
    if (scheme.textureSize(texels) != texels + 1) transform->setUserValue("geofx.texels", texels);
    const osg::ref_ptr<osg::ClusterCullingCallback> horizon =
        _plan.isWholeEarth() ? createHorizonCulling(scheme, key, static_cast<double>(facts.maxHeight))
                             : nullptr;
    if (_plan.isLeaf(key))
    {
        // OSG asks in the frame of what is below the transform.
        if (horizon) horizon->transform(osg::Matrixd::inverse(transform->getMatrix()));
        transform->setCullCallback(horizon);
        return transform;
    }

    // At a distance of d metres, a length e covers e·k/d pixels. The nearest point of the tile is at least d − R
    // away, so the finer tiles are drawn within R + e·k/limit.
    const double relief = blocks.error() + static_cast<double>(facts.latticeError);
    const double texel =
        static_cast<double>(arrays.textureError[static_cast<std::size_t>(y * arrays.span + x)]);
    const double error = std::max(relief / _plan.options.pixelError, texel / _plan.options.texelError);
    // Without an error, finer tiles are drawn only if a deformation asks for them (DeformationChain::lodLimit).
    const double range = error > 0.0 ? radius + error * _plan.options.pixelsPerRadian : RANGE_OF_PLAINS;

    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setName("tile " + key.path());
    lod->setRangeMode(osg::LOD::DISTANCE_FROM_EYE_POINT);
    lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    lod->setCenter(osg::Vec3(box.center() * transform->getMatrix()));
    lod->setRadius(static_cast<float>(radius + static_cast<double>(facts.error + facts.skirtBelow)));
    lod->addChild(transform, static_cast<float>(range), std::numeric_limits<float>::max());
    // A file has the four children of a tile. That of the root lies beside no other tile.
    lod->setFileName(1, (key.level == 0 ? "tiles/" : "../../") + key.path() + ".osgb");
    lod->setRange(1, 0.0f, static_cast<float>(range));
    lod->setNumChildrenThatCannotBeExpired(1);
    lod->setCullCallback(horizon);
    return lod;
}

} // namespace osgGeoFX
