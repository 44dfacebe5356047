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
#include <set>
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
        _tile = &tile;
        traverse(transform);
        _tile = nullptr;
        _firstVertices.clear();
        // The tile's own border, as far as there is ground.
        osg::Vec2 first(1.0f, 1.0f), last(0.0f, 0.0f);
        for (const osg::Vec2& at : tile.places)
        {
            first.set(std::min(first.x(), at.x()), std::min(first.y(), at.y()));
            last.set(std::max(last.x(), at.x()), std::max(last.y(), at.y()));
        }
        for (DatabaseTile::Mesh& mesh : tile.meshes)
        {
            const bool border[] = {mesh.low.y() == first.y(), mesh.high.x() == last.x(),
                                   mesh.high.y() == last.y(), mesh.low.x() == first.x()};
            for (DatabaseTile::Wall& wall : mesh.walls)
                wall.border = border[wall.side];
            // A mesh that no camera is near enough for is there for deformations alone.
            if (!mesh.smallest || mesh.to < 0.01 || (mesh.from > 0.01)) continue;
            tile.surface.insert(tile.surface.end(), mesh.ground.begin(), mesh.ground.end());
            tile.cap.insert(tile.cap.end(), mesh.cap.begin(), mesh.cap.end());
            tile.skirt.insert(tile.skirt.end(), mesh.walls.begin(), mesh.walls.end());
        }
        tiles.push_back(tile);
    }

    void apply(osg::LOD& block) override
    {
        if (!_tile) throw std::runtime_error("a block is in no tile");
        const auto* meshes = dynamic_cast<const osg::Vec2Array*>(block.getUserData());
        if (!meshes || meshes->size() != block.getNumChildren())
            throw std::runtime_error(_tile->transform->getName() +
                                     " has a block that does not tell of its meshes");
        const bool smallest = block.getChild(0)->asGeometry() != nullptr;
        for (unsigned int i = 0; i < block.getNumChildren(); ++i)
        {
            osg::Geometry* geometry = block.getChild(i)->asGeometry();
            if (!geometry)
            {
                block.getChild(i)->accept(*this);
                continue;
            }
            DatabaseTile::Mesh mesh;
            mesh.block = &block;
            mesh.geometry = geometry;
            mesh.from = static_cast<double>(block.getMinRange(i));
            mesh.to = static_cast<double>(block.getMaxRange(i));
            mesh.smallest = smallest;
            sort(mesh, firstVertex(*geometry), static_cast<unsigned int>((*meshes)[i].y()));
            if (!_tile->geometry) _tile->geometry = geometry;
            _tile->meshes.push_back(mesh);
        }
    }

    std::vector<DatabaseTile> tiles;

private:
    /// Where a mesh's vertices begin among the tile's.
    unsigned int firstVertex(const osg::Geometry& mesh)
    {
        const auto* vertices = dynamic_cast<const osg::Vec3Array*>(mesh.getVertexArray());
        const auto* places = dynamic_cast<const osg::Vec2Array*>(mesh.getTexCoordArray(0));
        if (!vertices || !places || places->size() != vertices->size())
            throw std::runtime_error(_tile->transform->getName() + " has a mesh without vertices or places");
        const auto [entry, isNew] =
            _firstVertices.try_emplace(vertices, static_cast<unsigned int>(_tile->vertices.size()));
        if (isNew)
        {
            _tile->vertices.insert(_tile->vertices.end(), vertices->begin(), vertices->end());
            _tile->places.insert(_tile->places.end(), places->begin(), places->end());
        }
        return entry->second;
    }

    /// Whether a triangle reaches to a pole from the border of the ground: it covers none of the tile's texture.
    bool isOfCap(const DatabaseTile::Triangle& triangle) const
    {
        const osg::Vec2 &a = _tile->places[triangle[0]], ab = _tile->places[triangle[1]] - a,
                        ac = _tile->places[triangle[2]] - a;
        if (ab.x() * ac.y() != ab.y() * ac.x()) return false;
        return std::any_of(triangle.begin(), triangle.end(),
                           [&](unsigned int vertex)
                           {
                               const osg::Vec3d place = _tile->world(vertex);
                               return std::abs(place.z()) > 6e6 && std::hypot(place.x(), place.y()) < 10.0;
                           });
    }

    void sort(DatabaseTile::Mesh& mesh, unsigned int first, unsigned int ground) const
    {
        const std::vector<osg::Vec3>& vertices = _tile->vertices;
        const std::vector<osg::Vec2>& coordinates = _tile->places;
        const osg::PrimitiveSet& primitives = *mesh.geometry->getPrimitiveSet(0);
        if (primitives.getMode() != GL_TRIANGLES || ground % 3 != 0 || ground > primitives.getNumIndices())
            throw std::runtime_error(_tile->transform->getName() + " has a mesh that is none");
        const auto triangle = [&](unsigned int i)
        {
            return DatabaseTile::Triangle{first + primitives.index(i), first + primitives.index(i + 1),
                                          first + primitives.index(i + 2)};
        };
        std::set<unsigned int> posts;
        osg::Vec2 low(2.0f, 2.0f), high(-1.0f, -1.0f);
        for (unsigned int i = 0; i < ground; i += 3)
        {
            if (isOfCap(triangle(i)))
            {
                mesh.cap.push_back(triangle(i));
                continue;
            }
            mesh.ground.push_back(triangle(i));
            for (const unsigned int vertex : mesh.ground.back())
            {
                posts.insert(vertex);
                const osg::Vec2& at = coordinates[vertex];
                low.set(std::min(low.x(), at.x()), std::min(low.y(), at.y()));
                high.set(std::max(high.x(), at.x()), std::max(high.y(), at.y()));
            }
        }
        // The lower ends of the walls on each side, by their place along it: texture coordinates are exact.
        std::array<std::map<float, osg::Vec3d>, 4> lowerEnds;
        const auto onSide = [&](unsigned int vertex, unsigned int side)
        {
            const osg::Vec2& at = coordinates[vertex];
            const float lines[] = {low.y(), high.x(), high.y(), low.x()};
            return (side % 2 == 0 ? at.y() : at.x()) == lines[side];
        };
        const auto along = [&](unsigned int vertex, unsigned int side)
        {
            return coordinates[vertex][side % 2 == 0 ? 0 : 1];
        };
        for (unsigned int i = ground; i + 2 < primitives.getNumIndices(); i += 3)
        {
            const DatabaseTile::Triangle corners = triangle(i);
            if (isOfCap(corners))
            {
                mesh.capWalls.push_back(corners);
                continue;
            }
            unsigned int side = 0;
            while (side < 4 && !std::all_of(corners.begin(), corners.end(),
                                            [&](unsigned int vertex) { return onSide(vertex, side); }))
                ++side;
            if (side == 4)
                throw std::runtime_error(_tile->transform->getName() + " has a wall that is on no side");
            for (const unsigned int vertex : corners)
            {
                if (posts.count(vertex) != 0) continue;
                // The higher one, where two walls meet.
                const osg::Vec3d place = vertices[vertex];
                const auto [entry, isNew] = lowerEnds[side].emplace(along(vertex, side), place);
                if (!isNew && entry->second.z() < place.z()) entry->second = place;
            }
        }
        mesh.low = low;
        mesh.high = high;
        for (const DatabaseTile::Triangle& each : mesh.ground)
            for (std::size_t k = 0; k < 3; ++k)
                for (unsigned int side = 0; side < 4; ++side)
                {
                    const unsigned int ends[] = {each[k], each[(k + 1) % 3]};
                    if (!onSide(ends[0], side) || !onSide(ends[1], side)) continue;
                    DatabaseTile::Wall wall;
                    wall.side = side;
                    bool whole = true;
                    for (const std::size_t end : {0u, 1u})
                    {
                        wall.top[end] = vertices[ends[end]];
                        whole = whole && lowerEnd(lowerEnds[side], along(ends[end], side), wall.bottom[end]);
                    }
                    if (whole) mesh.walls.push_back(wall);
                }
    }

    /// Between the lower ends on both sides of a place; false beyond the last of them.
    static bool lowerEnd(const std::map<float, osg::Vec3d>& lowerEnds, float place, osg::Vec3d& result)
    {
        const auto after = lowerEnds.lower_bound(place);
        if (after == lowerEnds.end() || (after == lowerEnds.begin() && after->first != place)) return false;
        result = after->second;
        if (after->first == place) return true;
        const auto before = std::prev(after);
        const auto share = static_cast<double>((place - before->first) / (after->first - before->first));
        result = before->second + (after->second - before->second) * share;
        return true;
    }

    osg::PagedLOD* _lod = nullptr;
    DatabaseTile* _tile = nullptr;
    std::map<const osg::Array*, unsigned int> _firstVertices; ///< of the tile's arrays
};

} // namespace

osg::Vec2d DatabaseTile::share(const osg::Vec2& place) const
{
    const osg::Image* colors = image(0);
    if (!colors) throw std::runtime_error(transform->getName() + " has no texture");
    // The outermost texels' middles lie on the border, but for those that fill a compressed texture up.
    int texels = colors->s() - 1;
    transform->getUserValue("geofx.texels", texels);
    return (osg::Vec2d(place) * colors->s() - osg::Vec2d(0.5, 0.5)) / texels;
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
                if (!tile.transform->getUserValue("geofx.cells", tileIntervals))
                    throw std::runtime_error(tile.transform->getName() +
                                             " does not tell how many cells it has");
                across = (tileIntervals << level) + 1;
                const auto posts = static_cast<std::size_t>(across) * static_cast<std::size_t>(across);
                all.resize(posts);
                sizes.resize(posts);
                drawn.resize(posts);
            }
            const auto post = [&](unsigned int vertex)
            {
                const osg::Vec2d place = tile.share(tile.places[vertex]) * tileIntervals;
                return std::array<int, 2>{static_cast<int>(std::lround(place.x())),
                                          static_cast<int>(std::lround(place.y()))};
            };
            const auto put = [&](int column, int row, const osg::Vec3d& local)
            {
                const auto i = static_cast<std::size_t>(tile.y * tileIntervals + row) *
                                   static_cast<std::size_t>(across) +
                               static_cast<std::size_t>(tile.x * tileIntervals + column);
                all[i] = tile.world(local);
                sizes[i] = std::max({std::abs(local.x()), std::abs(local.y()), std::abs(local.z())});
                drawn[i] = true;
            };
            // Posts that were left out lie on the triangles, as near as nobody can see.
            for (const auto& triangle : tile.surface)
            {
                const auto a = post(triangle[0]), b = post(triangle[1]), c = post(triangle[2]);
                const osg::Vec3d at = tile.local(triangle[0]), toB = tile.local(triangle[1]) - at,
                                 toC = tile.local(triangle[2]) - at;
                const int bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
                const double area = bx * cy - by * cx;
                for (int row = std::min({a[1], b[1], c[1]}); row <= std::max({a[1], b[1], c[1]}); ++row)
                    for (int column = std::min({a[0], b[0], c[0]}); column <= std::max({a[0], b[0], c[0]});
                         ++column)
                    {
                        const int x = column - a[0], y = row - a[1];
                        const double s = (x * cy - y * cx) / area, t = (bx * y - by * x) / area;
                        if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) put(column, row, at + toB * s + toC * t);
                    }
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
    // Vertices lie on a grid of a power of two, at most 1/32 m and at most a 1,024th of a cell; floats may be coarser.
    const double metres = (root.geocentric() ? 111320.0 : 1.0) * std::max(dx, dy);
    const double grid = std::exp2(std::floor(std::log2(std::min(1.0 / 32.0, 1.01 * metres / 1024.0))));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
        {
            const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(across) +
                           static_cast<std::size_t>(column);
            world.push_back(all[i]);
            rounding.push_back(std::max(0.5 * grid, sizes[i] * 0x1p-24) * std::sqrt(3.0));
            used.push_back(drawn[i]);
        }
}

} // namespace geofx::test
