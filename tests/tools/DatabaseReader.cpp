// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/DatabaseReader.h>

#include <osg/NodeVisitor>
#include <osg/Texture2D>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>

#include <GeographicLib/Geocentric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

namespace geofx::test
{

namespace
{

osg::ref_ptr<osg::Node> readNode(const std::string& file)
{
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file);
    if (!node) throw std::runtime_error("osgDB cannot read " + file);
    return node;
}

/// Collects the tiles of one file, with their PagedLODs.
class TileCollector : public osg::NodeVisitor
{
public:
    TileCollector() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::PagedLOD& lod) override
    {
        _lod = &lod;
        traverse(lod);
        _lod = nullptr;
    }

    void apply(osg::MatrixTransform& transform) override
    {
        DatabaseTile tile;
        if (std::sscanf(transform.getName().c_str(), "tile %d/%d/%d", &tile.level, &tile.x, &tile.y) != 3)
            throw std::runtime_error("a tile has the name \"" + transform.getName() + "\"");
        tile.transform = &transform;
        tile.lod = _lod;
        if (transform.getNumChildren() > 0) tile.geometry = transform.getChild(0)->asGeometry();
        if (tile.geometry) sort(tile);
        tiles.push_back(tile);
    }

    std::vector<DatabaseTile> tiles;

private:
    /// A skirt's triangles stand upright: two of their vertices, the lower one added later, have the same
    /// texture coordinates.
    static void sort(DatabaseTile& tile)
    {
        const auto& coordinates = dynamic_cast<const osg::Vec2Array&>(*tile.geometry->getTexCoordArray(0));
        const osg::PrimitiveSet& primitives = *tile.geometry->getPrimitiveSet(0);
        if (!dynamic_cast<const osg::Vec3Array*>(tile.geometry->getVertexArray()) ||
            coordinates.size() != tile.vertices().size() || primitives.getMode() != GL_TRIANGLES)
            throw std::runtime_error(tile.transform->getName() + " is not a mesh");
        std::map<unsigned int, unsigned int> below;
        std::vector<std::array<unsigned int, 2>> tops;
        for (unsigned int i = 0; i + 2 < primitives.getNumIndices(); i += 3)
        {
            const std::array<unsigned int, 3> t{primitives.index(i), primitives.index(i + 1),
                                                primitives.index(i + 2)};
            bool upright = false;
            for (const auto& [a, b, c] :
                 {std::tuple(t[0], t[1], t[2]), std::tuple(t[1], t[2], t[0]), std::tuple(t[2], t[0], t[1])})
            {
                if (coordinates[a] != coordinates[b]) continue;
                upright = true;
                const unsigned int top = std::min(a, b), other = c;
                below[top] = std::max(a, b);
                if (coordinates[other] != coordinates[top]) tops.push_back({top, other});
            }
            if (!upright) tile.surface.push_back(t);
        }
        for (const auto& [a, b] : tops)
            // The other triangle of a wall names the lower vertex, and is the same wall.
            if (below.count(a) && below.count(b)) tile.skirt.push_back({{a, b}, {below[a], below[b]}});
    }

    osg::PagedLOD* _lod = nullptr;
};

} // namespace

std::vector<bool> DatabaseTile::used() const
{
    std::vector<bool> result(vertices().size(), false);
    for (const auto& triangle : surface)
        for (const unsigned int vertex : triangle)
            result[vertex] = true;
    return result;
}

const osg::Image* DatabaseTile::image(unsigned int unit) const
{
    const osg::StateSet* state = geometry ? geometry->getStateSet() : nullptr;
    const auto* texture = state ? dynamic_cast<const osg::Texture2D*>(
                                      state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE))
                                : nullptr;
    return texture ? texture->getImage() : nullptr;
}

DatabaseRoot::DatabaseRoot(const std::string& folder) : _node(readNode(folder + "/terrain.osgb")) {}

osg::Vec3d DatabaseRoot::fromWorld(const osg::Vec3d& world) const
{
    if (!geocentric()) return world;
    osg::Vec3d place;
    GeographicLib::Geocentric::WGS84().Reverse(world.x(), world.y(), world.z(), place.y(), place.x(),
                                               place.z());
    place.x() += 360.0 * std::round((0.5 * (west() + east()) - place.x()) / 360.0);
    return place;
}

osg::Vec3d DatabaseRoot::toWorld(const osg::Vec3d& place) const
{
    if (!geocentric()) return place;
    osg::Vec3d world;
    GeographicLib::Geocentric::WGS84().Forward(place.y(), place.x(), place.z(), world.x(), world.y(),
                                               world.z());
    return world;
}

void readDatabase(const std::string& folder, const std::function<void(const DatabaseTile&)>& visit)
{
    std::vector<std::string> files{folder + "/terrain.osgb"};
    while (!files.empty())
    {
        const std::string file = files.back();
        files.pop_back();
        const osg::ref_ptr<osg::Node> node = readNode(file);
        TileCollector collector;
        node->accept(collector);
        for (auto& tile : collector.tiles)
        {
            tile.file = file;
            visit(tile);
            if (tile.lod)
                files.push_back(osgDB::concatPaths(osgDB::getFilePath(file), tile.lod->getFileName(1)));
        }
    }
}

std::vector<DatabaseTile> readTiles(const std::string& folder)
{
    std::vector<DatabaseTile> tiles;
    readDatabase(folder, [&](const DatabaseTile& tile) { tiles.push_back(tile); });
    return tiles;
}

FinestLevel::FinestLevel(const std::string& folder)
{
    const DatabaseRoot root(folder);
    const int level = root.finestLevel();
    int across = 0; // posts along the quadtree, which may reach beyond the extent
    std::vector<osg::Vec3d> all;
    std::vector<double> sizes;
    std::vector<bool> drawn;
    readDatabase(
        folder,
        [&](const DatabaseTile& tile)
        {
            if (tile.level != level || !tile.geometry) return;
            if (all.empty())
            {
                // Posts lie row by row, and a row has one texture coordinate t; the skirt's vertices follow.
                const auto& t = static_cast<const osg::Vec2Array&>(*tile.geometry->getTexCoordArray(0));
                while (t[static_cast<std::size_t>(tileIntervals)].y() == t[0].y())
                    ++tileIntervals;
                --tileIntervals;
                if (tile.vertices().size() <
                    static_cast<std::size_t>((tileIntervals + 1) * (tileIntervals + 1)))
                    throw std::runtime_error(tile.transform->getName() + " is not a full grid");
                across = (tileIntervals << level) + 1;
                const auto posts = static_cast<std::size_t>(across) * static_cast<std::size_t>(across);
                all.resize(posts);
                sizes.resize(posts);
                drawn.resize(posts);
            }
            const std::vector<bool> inTile = tile.used();
            for (int row = 0; row <= tileIntervals; ++row)
                for (int column = 0; column <= tileIntervals; ++column)
                {
                    const auto vertex = static_cast<unsigned int>(row * (tileIntervals + 1) + column);
                    if (!inTile[vertex]) continue;
                    const auto i = static_cast<std::size_t>(tile.y * tileIntervals + row) *
                                       static_cast<std::size_t>(across) +
                                   static_cast<std::size_t>(tile.x * tileIntervals + column);
                    const osg::Vec3d local = tile.local(vertex);
                    all[i] = tile.world(vertex);
                    sizes[i] = std::max({std::abs(local.x()), std::abs(local.y()), std::abs(local.z())});
                    drawn[i] = true;
                }
        });
    if (all.empty()) throw std::runtime_error("no tile of the finest level has a mesh");

    // The spacing, from two posts far apart on the best filled line; the file does not tell it.
    const auto spacing = [&](bool alongX, double extent)
    {
        const auto at = [&](int line, int i)
        {
            return static_cast<std::size_t>(alongX ? line : i) * static_cast<std::size_t>(across) +
                   static_cast<std::size_t>(alongX ? i : line);
        };
        std::vector<int> best;
        int bestLine = 0;
        for (int line = 0; line < across; ++line)
        {
            std::vector<int> posts;
            for (int i = 0; i < across; ++i)
                if (drawn[at(line, i)]) posts.push_back(i);
            if (posts.size() <= best.size()) continue;
            best = posts;
            bestLine = line;
        }
        // Not the ends of the line, which may be the same meridian.
        const int a = best[best.size() / 4], b = best[best.size() - 1 - best.size() / 4];
        const osg::Vec3d pa = root.fromWorld(all[at(bestLine, a)]), pb = root.fromWorld(all[at(bestLine, b)]);
        const double step = alongX ? (pb.x() - pa.x()) / (b - a) : (pb.y() - pa.y()) / (b - a);
        return static_cast<int>(std::lround(extent / step)) + 1;
    };
    x0 = root.west();
    y0 = root.south();
    columns = spacing(true, root.east() - x0);
    rows = spacing(false, root.north() - y0);
    dx = (root.east() - x0) / (columns - 1);
    dy = (root.north() - y0) / (rows - 1);
    if (columns > across || rows > across)
        throw std::runtime_error("the finest level does not fill its extent");
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
        {
            const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(across) +
                           static_cast<std::size_t>(column);
            world.push_back(all[i]);
            localSize.push_back(sizes[i]);
            used.push_back(drawn[i]);
        }
}

} // namespace geofx::test
