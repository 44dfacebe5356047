// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SingleMesh.h"

#include "BenchError.h"

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Texture2D>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace geofx::bench
{

namespace
{

constexpr int TEXTURE_LIMIT = 2048;

/// Goes through a whole database, tile by tile, and hands each to add().
class TileVisitor : public osg::NodeVisitor
{
public:
    TileVisitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void readFile(const std::string& file)
    {
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file);
        if (!node) throw BenchError(file + ": this tile cannot be read; build the database again.");
        node->accept(*this);
    }

    void apply(osg::PagedLOD& lod) override
    {
        traverse(lod);
        for (unsigned int i = 0; i < lod.getNumFileNames(); ++i)
        {
            if (!lod.getFileName(i).empty())
                readFile(osgDB::concatPaths(lod.getDatabasePath(), lod.getFileName(i)));
        }
    }

    void apply(osg::MatrixTransform& node) override
    {
        const std::optional<osgGeoFX::TileInfo> tile = osgGeoFX::TileInfo::read(node);
        const osg::ref_ptr<osg::Geometry> ground = tile ? osgGeoFX::TileInfo::ground(node) : nullptr;
        if (ground)
            add(*tile, node.getMatrix(), *ground);
        else
            traverse(node);
    }

    virtual void add(const osgGeoFX::TileInfo& tile, const osg::Matrixd& localToWorld,
                     osg::Geometry& geometry) = 0;
};

template<class Array>
const Array& as(const osg::Array* array)
{
    const auto* typed = dynamic_cast<const Array*>(array);
    if (!typed)
        throw BenchError(
            "A tile's arrays are not those that this version of osggeofx_build writes; build the "
            "database again.");
    return *typed;
}

class Merger : public TileVisitor
{
public:
    Merger(int finestLevel, const osg::Vec3d& origin) : _finestLevel(finestLevel), _origin(origin) {}

    void add(const osgGeoFX::TileInfo& tile, const osg::Matrixd& localToWorld,
             osg::Geometry& geometry) override
    {
        const auto* texture = dynamic_cast<const osg::Texture2D*>(
            geometry.getOrCreateStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        if (!texture || !texture->getImage())
            throw BenchError("A tile has no texture; build the database again.");
        const osg::Image& image = *texture->getImage();
        if (image.isCompressed())
            throw BenchError("The database's textures are compressed, and cannot be joined; build it without "
                             "--compress-textures.");
        if (((image.s() - 1) << tile.level) <= TEXTURE_LIMIT) addTexture(tile, image);
        if (tile.level == _finestLevel) addMesh(tile, localToWorld, geometry, image.s());
    }

    osg::ref_ptr<osg::Node> result() const
    {
        if (_images.empty()) throw BenchError("The terrain has no texture small enough for one mesh.");
        const osg::ref_ptr<osg::Image> image = _images.rbegin()->second;
        // As in the tiles, the outermost texels' middles lie on the border.
        const auto texels = static_cast<float>(image->s());
        for (osg::Vec2& coordinate : *_coordinates)
            coordinate = (coordinate * (texels - 1.0f) + osg::Vec2(0.5f, 0.5f)) / texels;

        osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
        white->front().set(1.0f, 1.0f, 1.0f, 1.0f);
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setUseDisplayList(false);
        geometry->setUseVertexBufferObjects(true);
        geometry->setVertexArray(_vertices);
        geometry->setNormalArray(_normals);
        geometry->setColorArray(white);
        geometry->setTexCoordArray(0, _coordinates);
        geometry->addPrimitiveSet(_elements);

        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
        texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        texture->setResizeNonPowerOfTwoHint(false);
        texture->setMaxAnisotropy(4.0f);
        geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);

        osg::ref_ptr<osg::MatrixTransform> transform =
            new osg::MatrixTransform(osg::Matrixd::translate(_origin));
        transform->addChild(geometry);
        return transform;
    }

private:
    void addTexture(const osgGeoFX::TileInfo& tile, const osg::Image& image)
    {
        const int intervals = image.s() - 1, size = (intervals << tile.level) + 1;
        osg::ref_ptr<osg::Image>& whole = _images[tile.level];
        if (!whole)
        {
            whole = new osg::Image;
            whole->allocateImage(size, size, 1, image.getPixelFormat(), image.getDataType(), 1);
            whole->setInternalTextureFormat(image.getInternalTextureFormat());
            std::memset(whole->data(), 128, whole->getTotalSizeInBytes());
        }
        for (int row = 0; row <= intervals; ++row)
        {
            std::memcpy(whole->data(static_cast<unsigned int>(tile.x * intervals),
                                    static_cast<unsigned int>(tile.y * intervals + row)),
                        image.data(0, static_cast<unsigned int>(row)), image.getRowSizeInBytes());
        }
    }

    /// All posts of a tile's lattice, those that its finest mesh leaves out on plains, too.
    void addMesh(const osgGeoFX::TileInfo& tile, const osg::Matrixd& localToWorld,
                 const osg::Geometry& geometry, int texels)
    {
        const auto& vertices = as<osg::Vec3Array>(geometry.getVertexArray());
        const auto& normals = as<osg::Vec3bArray>(geometry.getNormalArray());
        const auto& coordinates = as<osg::Vec2Array>(geometry.getTexCoordArray(0));
        const int cells = tile.cells, posts = cells + 1;
        // Of the posts, none where there is no ground.
        std::vector<std::optional<GLuint>> indices(static_cast<std::size_t>(posts) *
                                                   static_cast<std::size_t>(posts));
        const auto indexAt = [&](int column, int row) -> std::optional<GLuint>&
        {
            return indices[static_cast<std::size_t>(row) * static_cast<std::size_t>(posts) +
                           static_cast<std::size_t>(column)];
        };
        const double across = 1 << _finestLevel;
        const auto addPost = [&](int column, int row, const osg::Vec3d& place, osg::Vec3d normal)
        {
            indexAt(column, row) = static_cast<GLuint>(_vertices->size());
            if (column == 0 || row == 0 || column == cells || row == cells)
            {
                // Neighbours round theirs in frames of their own; here are no walls behind the gaps.
                const auto [entry, isNew] = _borders.try_emplace(
                    {tile.x * cells + column, tile.y * cells + row}, *indexAt(column, row));
                indexAt(column, row) = entry->second;
                if (!isNew) return;
            }
            _vertices->push_back(osg::Vec3(place * localToWorld - _origin));
            normal = osg::Matrixd::transform3x3(normal, localToWorld);
            normal.normalize();
            normal *= 32767.0;
            _normals->push_back(osg::Vec3s(static_cast<GLshort>(normal.x()), static_cast<GLshort>(normal.y()),
                                           static_cast<GLshort>(normal.z())));
            _coordinates->push_back((osg::Vec2d(tile.x, tile.y) + osg::Vec2d(column, row) / cells) / across);
        };
        const auto latticePlace = [&](unsigned int vertex)
        {
            return (osg::Vec2d(coordinates[vertex]) * texels - osg::Vec2d(0.5, 0.5)) * cells / (texels - 1.0);
        };
        for (const auto& set : geometry.getPrimitiveSetList())
        {
            for (unsigned int i = 0; i + 2 < set->getNumIndices(); i += 3)
            {
                const unsigned int corners[] = {set->index(i), set->index(i + 1), set->index(i + 2)};
                const osg::Vec2d a = latticePlace(corners[0]);
                const osg::Vec2d ab = latticePlace(corners[1]) - a, ac = latticePlace(corners[2]) - a;
                const double area = ab.x() * ac.y() - ab.y() * ac.x();
                if (std::abs(area) < 0.5) continue;
                constexpr double hair = 1e-3;
                const auto first = [&](double from, double b, double c)
                {
                    return std::max(0, static_cast<int>(std::ceil(from + std::min({0.0, b, c}) - hair)));
                };
                const auto last = [&](double from, double b, double c)
                {
                    return std::min(cells, static_cast<int>(std::floor(from + std::max({0.0, b, c}) + hair)));
                };
                for (int row = first(a.y(), ab.y(), ac.y()); row <= last(a.y(), ab.y(), ac.y()); ++row)
                {
                    for (int column = first(a.x(), ab.x(), ac.x()); column <= last(a.x(), ab.x(), ac.x());
                         ++column)
                    {
                        if (indexAt(column, row)) continue;
                        const osg::Vec2d from = osg::Vec2d(column, row) - a;
                        const double b = (from.x() * ac.y() - from.y() * ac.x()) / area;
                        const double c = (ab.x() * from.y() - ab.y() * from.x()) / area;
                        if (b < -hair || c < -hair || b + c > 1.0 + hair) continue;
                        const auto mixed = [&](const auto& array)
                        {
                            const auto at = [&](int corner)
                            {
                                const auto& value = array[corners[corner]];
                                return osg::Vec3d(value.x(), value.y(), value.z());
                            };
                            return at(0) * (1.0 - b - c) + at(1) * b + at(2) * c;
                        };
                        addPost(column, row, mixed(vertices), mixed(normals));
                    }
                }
            }
        }
        for (int row = 0; row < cells; ++row)
        {
            for (int column = 0; column < cells; ++column)
            {
                const std::optional<GLuint> a = indexAt(column, row), b = indexAt(column + 1, row),
                                            c = indexAt(column + 1, row + 1), d = indexAt(column, row + 1);
                if (!a || !b || !c || !d) continue;
                for (const GLuint corner : {*a, *b, *c, *a, *c, *d})
                    _elements->push_back(corner);
            }
        }
    }

    const int _finestLevel;
    const osg::Vec3d _origin;
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3sArray> _normals = new osg::Vec3sArray(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> _coordinates = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::DrawElementsUInt> _elements = new osg::DrawElementsUInt(osg::PrimitiveSet::TRIANGLES);
    std::map<int, osg::ref_ptr<osg::Image>> _images; ///< by level
    std::map<std::pair<int, int>, GLuint>
        _borders; ///< posts on tiles' borders, by their places in the whole lattice
};

} // namespace

osg::ref_ptr<osg::Node> readAsSingleMesh(const std::filesystem::path& terrain)
{
    const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(terrain.string());
    if (!root)
        throw BenchError(terrain.string() + ": it cannot be read; name a database with --terrain FILE.");
    std::string error;
    const std::optional<osgGeoFX::TerrainInfo> info = osgGeoFX::TerrainInfo::read(root, error);
    if (!info)
    {
        throw BenchError(
            terrain.string() + ": " +
            (error.empty() ? "it is no database of osggeofx_build; name one with --terrain FILE." : error));
    }
    Merger merger(info->levels - 1, root->getBound().center());
    root->accept(merger);
    return merger.result();
}

} // namespace geofx::bench
