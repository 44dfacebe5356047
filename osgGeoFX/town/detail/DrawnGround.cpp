// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/DrawnGround.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/TriangleIndexFunctor>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgGeoFX
{

namespace
{

/// Files whose finest tiles are kept: four tiles each, some 2 MB for a tile. A large cell of a town touches four where tiles are as
/// wide as half of it.
constexpr std::size_t MOST_READ = 5;
/// Files whose tiles are remembered.
constexpr std::size_t MOST_FILES = 20000;

double cross(const osg::Vec2d& a, const osg::Vec2d& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

/// Collects the numbers of triangles' corners.
struct Corners
{
    std::vector<unsigned int> found;
    void operator()(unsigned int a, unsigned int b, unsigned int c) { found.insert(found.end(), {a, b, c}); }
};

/// The tiles of a file of the database; null if it cannot be read.
osg::ref_ptr<osg::Node> readTiles(const std::string& file)
{
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    return osgDB::readRefNodeFile(file, options);
}

} // namespace

/// The triangles of a finest tile, over the grid.
class DrawnGround::Surface
{
public:
    Surface(const osg::Transform& tile, const TownGrid& grid)
    {
        const osg::ref_ptr<osg::Geometry> ground = TileInfo::ground(tile);
        if (!ground) return;
        osg::Matrixd toWorld;
        tile.computeLocalToWorldMatrix(toWorld, nullptr);
        const auto* vertices = dynamic_cast<const osg::Vec3Array*>(ground->getVertexArray());
        if (!vertices) return;
        osg::TriangleIndexFunctor<Corners> corners;
        ground->accept(corners);
        _corners = std::move(corners.found);
        for (const osg::Vec3& vertex : *vertices)
        {
            _places.push_back(grid.fromWorld(osg::Vec3d(vertex) * toWorld));
            // About the tile's first vertex, so that no triangle goes around the globe.
            const osg::Vec2d place = grid.turned({_places.back().x(), _places.back().y()},
                                                 {_places.front().x(), _places.front().y()});
            _places.back().x() = place.x();
            _low.set(std::min(_low.x(), place.x()), std::min(_low.y(), place.y()));
            _high.set(std::max(_high.x(), place.x()), std::max(_high.y(), place.y()));
        }
        if (_corners.empty()) return;
        _side = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(_corners.size()) / 6.0)), 1, 256);
        // In one list: a vector for each cell would take several times the memory, in pieces that the heap does not get back.
        _starts.assign(static_cast<std::size_t>(_side) * static_cast<std::size_t>(_side) + 1, 0);
        forEachCell([this](std::size_t index, unsigned int) { ++_starts[index + 1]; });
        std::partial_sum(_starts.begin(), _starts.end(), _starts.begin());
        _touching.resize(_starts.back());
        std::vector<unsigned int> next(_starts.begin(), _starts.end() - 1);
        forEachCell([&](std::size_t index, unsigned int triangle) { _touching[next[index]++] = triangle; });
    }

    std::optional<double> at(const osg::Vec2d& anywhere, const TownGrid& grid) const
    {
        const osg::Vec2d place = grid.turned(anywhere, (_low + _high) * 0.5);
        const double tolerance = 1e-9 * (_high - _low).length();
        if (_touching.empty() || place.x() < _low.x() - tolerance || place.y() < _low.y() - tolerance ||
            place.x() > _high.x() + tolerance || place.y() > _high.y() + tolerance)
            return {};
        const std::size_t index =
            static_cast<std::size_t>(cell(place.y(), _low.y(), _high.y())) * static_cast<std::size_t>(_side) +
            static_cast<std::size_t>(cell(place.x(), _low.x(), _high.x()));
        for (unsigned int i = _starts[index]; i < _starts[index + 1]; ++i)
        {
            const unsigned int triangle = _touching[i];
            const osg::Vec3d &a = _places[_corners[triangle]], &b = _places[_corners[triangle + 1]],
                             &c = _places[_corners[triangle + 2]];
            const osg::Vec2d ab(b.x() - a.x(), b.y() - a.y()), ac(c.x() - a.x(), c.y() - a.y()),
                to(place.x() - a.x(), place.y() - a.y());
            const double twice = cross(ab, ac);
            if (twice == 0.0) continue;
            const double u = cross(to, ac) / twice, v = cross(ab, to) / twice;
            // Neighbours share their edges; vertices are rounded.
            constexpr double slack = 1e-6;
            if (u >= -slack && v >= -slack && u + v <= 1.0 + slack)
                return a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z());
        }
        return {};
    }

private:
    /// Hands out each triangle, by its first corner, with each cell that it touches.
    template<typename Take>
    void forEachCell(Take take) const
    {
        for (unsigned int i = 0; i < _corners.size(); i += 3)
        {
            osg::Vec2d low(1e300, 1e300), high(-1e300, -1e300);
            for (unsigned int c = 0; c < 3; ++c)
            {
                const osg::Vec3d& place = _places[_corners[i + c]];
                low.set(std::min(low.x(), place.x()), std::min(low.y(), place.y()));
                high.set(std::max(high.x(), place.x()), std::max(high.y(), place.y()));
            }
            for (int row = cell(low.y(), _low.y(), _high.y()); row <= cell(high.y(), _low.y(), _high.y());
                 ++row)
                for (int column = cell(low.x(), _low.x(), _high.x());
                     column <= cell(high.x(), _low.x(), _high.x()); ++column)
                    take(static_cast<std::size_t>(row) * static_cast<std::size_t>(_side) +
                             static_cast<std::size_t>(column),
                         i);
        }
    }

    int cell(double value, double low, double high) const
    {
        const double share = high > low ? (value - low) / (high - low) : 0.0;
        return std::clamp(static_cast<int>(share * _side), 0, _side - 1);
    }

    std::vector<osg::Vec3d> _places; ///< x and y of the grid, and the height
    std::vector<unsigned int> _corners;
    osg::Vec2d _low = osg::Vec2d(1e300, 1e300), _high = osg::Vec2d(-1e300, -1e300);
    int _side = 0;
    /// Of the cells of a grid over the tile: the triangles that touch each, and where they begin.
    std::vector<unsigned int> _touching, _starts;
};

DrawnGround::DrawnGround(const TownGrid& grid, const osg::Node& root, std::string folder)
    : _grid(grid), _root(&root), _folder(std::move(folder)), _top(tilesOf(root, _folder))
{
}

DrawnGround::~DrawnGround() = default;

DrawnGround::Tiles DrawnGround::tilesOf(const osg::Node& node, const std::string& folder)
{
    Tiles tiles;
    const osg::Group* group = node.asGroup();
    for (unsigned int i = 0; group && i < group->getNumChildren(); ++i)
    {
        const osg::Node& child = *group->getChild(i);
        const auto* paged = dynamic_cast<const osg::PagedLOD*>(&child);
        const bool finest = child.asTransform() && TileInfo::isTile(child);
        if (!finest && !(paged && TileInfo::coarseOf(*paged) && paged->getNumFileNames() > 1)) continue;
        const osg::BoundingSphere ball = child.getBound();
        Tile tile;
        tile.center = ball.center();
        tile.radius = static_cast<double>(ball.radius());
        if (paged && !finest)
            tile.finer = osgDB::getRealPath(osgDB::concatPaths(folder, paged->getFileName(1)));
        tiles.push_back(tile);
    }
    return tiles;
}

DrawnGround::Tiles& DrawnGround::tilesIn(const std::string& file)
{
    const auto known = _files.find(file);
    if (known != _files.end()) return known->second;
    const osg::ref_ptr<osg::Node> node = readTiles(file);
    if (!node)
        throw BuildError(file +
                         ": this tile of the ground cannot be read; build the database again with --anew.");
    Tiles& tiles = _files[file] = tilesOf(*node, osgDB::getFilePath(file));
    // Who asks for finest tiles will soon ask for their ground.
    if (std::any_of(tiles.begin(), tiles.end(), [](const Tile& tile) { return tile.finer.empty(); }))
        makeSurfaces(tiles, *node);
    return tiles;
}

const DrawnGround::Surface& DrawnGround::surfaceOf(Tiles& tiles, const std::string& file, std::size_t index)
{
    if (!tiles[index].surface)
    {
        const osg::ref_ptr<const osg::Node> node =
            file.empty() ? _root : osg::ref_ptr<const osg::Node>(readTiles(file));
        if (node) makeSurfaces(tiles, *node);
    }
    if (!tiles[index].surface)
        throw BuildError(file +
                         ": this tile of the ground cannot be read; build the database again with --anew.");
    if (_kept.front() != &tiles)
    {
        _kept.remove(&tiles);
        _kept.push_front(&tiles);
    }
    return *tiles[index].surface;
}

/// Those of all tiles of a file at once: most of the time is that of reading it.
void DrawnGround::makeSurfaces(Tiles& tiles, const osg::Node& node)
{
    const osg::Group* group = node.asGroup();
    std::size_t count = 0;
    for (unsigned int i = 0; group && i < group->getNumChildren() && count < tiles.size(); ++i)
    {
        const osg::Node& child = *group->getChild(i);
        const auto* paged = dynamic_cast<const osg::PagedLOD*>(&child);
        const bool finest = child.asTransform() && TileInfo::isTile(child);
        if (!finest && !(paged && TileInfo::coarseOf(*paged) && paged->getNumFileNames() > 1)) continue;
        Tile& tile = tiles[count++];
        if (finest && tile.finer.empty())
            tile.surface = std::make_shared<Surface>(*child.asTransform(), _grid);
    }
    _kept.push_front(&tiles);
    if (_kept.size() <= MOST_READ) return;
    for (Tile& tile : *_kept.back())
        tile.surface = nullptr;
    _kept.pop_back();
}

std::optional<double> DrawnGround::find(Tiles& tiles, const std::string& file, const osg::Vec2d& place,
                                        const osg::Vec3d& low, const osg::Vec3d& up)
{
    for (std::size_t i = 0; i < tiles.size(); ++i)
    {
        Tile& tile = tiles[i];
        // The vertical through the place must come as near as the ball reaches.
        const osg::Vec3d toCenter = tile.center - low;
        if ((toCenter - up * (toCenter * up)).length() > tile.radius * (1.0 + 1e-6) + 1.0) continue;
        std::optional<double> height;
        if (!tile.finer.empty())
        {
            const std::string finer = tile.finer;
            height = find(tilesIn(finer), finer, place, low, up);
        }
        else
            height = surfaceOf(tiles, file, i).at(place, _grid);
        if (height) return height;
    }
    return {};
}

std::optional<double> DrawnGround::at(const osg::Vec2d& place)
{
    if (!_grid.contains(_grid.turned(place))) return {};
    if (_files.size() > MOST_FILES)
    {
        for (Tile& tile : _top)
            tile.surface = nullptr;
        _files.clear();
        _kept.clear();
    }
    const osg::Vec3d low = _grid.toWorld(place, 0.0);
    osg::Vec3d up = _grid.toWorld(place, 1000.0) - low;
    up.normalize();
    return find(_top, {}, place, low, up);
}

} // namespace osgGeoFX
