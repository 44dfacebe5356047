// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SingleMesh.h"

#include "BenchError.h"

#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/TilePosts.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Texture2D>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

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
        const std::optional<osgGeoFX::TilePosts> posts = osgGeoFX::TilePosts::read(node);
        const osg::Geometry* mesh = osgGeoFX::TileInfo::firstMesh(node);
        if (tile && posts && mesh)
            add(*tile, node.getMatrix(), *posts, *mesh->getStateSet());
        else
            traverse(node);
    }

    virtual void add(const osgGeoFX::TileInfo& tile, const osg::Matrixd& localToWorld,
                     const osgGeoFX::TilePosts& posts, const osg::StateSet& state) = 0;
};

class Merger : public TileVisitor
{
public:
    Merger(int finestLevel, const osg::Vec3d& origin) : _finestLevel(finestLevel), _origin(origin) {}

    void add(const osgGeoFX::TileInfo& tile, const osg::Matrixd& localToWorld,
             const osgGeoFX::TilePosts& posts, const osg::StateSet& state) override
    {
        const auto* texture =
            dynamic_cast<const osg::Texture2D*>(state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        if (!texture || !texture->getImage())
            throw BenchError("A tile has no texture; build the database again.");
        const osg::Image& image = *texture->getImage();
        if (image.isCompressed())
            throw BenchError("The database's textures are compressed, and cannot be joined; build it without "
                             "--compress-textures.");
        if (((image.s() - 1) << tile.level) <= TEXTURE_LIMIT) addTexture(tile, image);
        if (tile.level == _finestLevel) addMesh(tile, localToWorld, posts);
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

    void addMesh(const osgGeoFX::TileInfo& tile, const osg::Matrixd& localToWorld,
                 const osgGeoFX::TilePosts& posts)
    {
        const int cells = posts.cells();
        const auto there = [&](int column, int row)
        {
            return column >= 0 && row >= 0 && column <= cells && row <= cells &&
                   !std::isnan(posts.at(column, row).x());
        };
        // Across a post, between its neighbours.
        const auto way = [&](int column, int row, int dc, int dr)
        {
            const bool before = there(column - dc, row - dr), after = there(column + dc, row + dr);
            return posts.at(column + (after ? dc : 0), row + (after ? dr : 0)) -
                   posts.at(column - (before ? dc : 0), row - (before ? dr : 0));
        };
        std::vector<GLuint> indices(static_cast<std::size_t>(cells + 1) *
                                    static_cast<std::size_t>(cells + 1));
        const auto indexAt = [&](int column, int row) -> GLuint&
        {
            return indices[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells + 1) +
                           static_cast<std::size_t>(column)];
        };
        const double across = 1 << _finestLevel;
        for (int row = 0; row <= cells; ++row)
        {
            for (int column = 0; column <= cells; ++column)
            {
                if (!there(column, row)) continue;
                const auto next = static_cast<GLuint>(_vertices->size());
                indexAt(column, row) = next;
                if (column == 0 || row == 0 || column == cells || row == cells)
                {
                    // Neighbours round theirs in frames of their own; here are no walls behind the gaps.
                    const auto [entry, isNew] =
                        _borders.try_emplace({tile.x * cells + column, tile.y * cells + row}, next);
                    indexAt(column, row) = entry->second;
                    if (!isNew) continue;
                }
                _vertices->push_back(osg::Vec3(posts.at(column, row) * localToWorld - _origin));
                osg::Vec3d normal =
                    osg::Matrixd::transform3x3(way(column, row, 1, 0) ^ way(column, row, 0, 1), localToWorld);
                normal.normalize();
                normal *= 32767.0;
                _normals->push_back(osg::Vec3s(static_cast<GLshort>(normal.x()),
                                               static_cast<GLshort>(normal.y()),
                                               static_cast<GLshort>(normal.z())));
                _coordinates->push_back((osg::Vec2d(tile.x, tile.y) + osg::Vec2d(column, row) / cells) /
                                        across);
            }
        }
        for (int row = 0; row < cells; ++row)
        {
            for (int column = 0; column < cells; ++column)
            {
                if (!there(column, row) || !there(column + 1, row) || !there(column, row + 1) ||
                    !there(column + 1, row + 1))
                    continue;
                const GLuint a = indexAt(column, row), c = indexAt(column + 1, row + 1);
                for (const GLuint corner : {a, indexAt(column + 1, row), c, a, c, indexAt(column, row + 1)})
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
