// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TileBlocks.h>

#include <GeographicLib/Constants.hpp>

#include <osg/BoundingBox>
#include <osg/Math>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Four finer blocks replace a block within so many of its radii. With a larger number, blocks fit their distance
/// better, and more of them are drawn. The architecture page has the measurements.
constexpr double FINER_WITHIN = 20.0;
/// Not all posts can be left out. Of those that can, a mesh has at most this share of the mesh before it.
constexpr double STEP = 0.65;
/// A coarser mesh with more than this share of the triangles is not worth its bytes.
constexpr double LEAST_GAIN = 0.85;
/// A mesh is left out if it would be shown over a range of distances no wider than this factor.
constexpr double LEAST_STEP = 1.1;
/// The errors of an edge and of its parts add up, so posts may be off by so many times the tolerance. That is one and
/// a half pixels in the corners of a wide picture, where an angle takes more pixels than in the middle.
constexpr double ACCUMULATION = 1.2;
/// The cells along the smallest block of a finest tile, and of a coarser one, whatever the size of tiles. Posts of a
/// coarser one may be denser than its cells.
constexpr int FINEST_CELLS = 16;
constexpr int COARSE_CELLS = 32;
/// A finest tile leaves out posts whose errors are below this share of a cell and below a millimetre. No camera comes
/// near enough to see these errors.
constexpr double NEGLIGIBLE = 1.0 / 32768.0, NEGLIGIBLE_METRES = 1e-3;
/// The longest edges on a plain's finest tile, cells. Deformations bend the plain at their ends.
constexpr int PLAIN_CELLS = 2;
/// A wall leans outwards a little. So it also closes hair lines seen from straight above.
constexpr double LEAN = 0.1;

int smallestBlock(const TilingScheme& scheme, bool finest, int intervals)
{
    if (finest) return std::min(intervals, FINEST_CELLS);
    return intervals / std::max(scheme.intervals / COARSE_CELLS, 1);
}

/// Twice the area of a triangle, positive if it is counter-clockwise.
double turn(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

} // namespace

/// One side of a block.
struct TileBlocks::Side
{
    int number = 0;      ///< 0 south, 1 east, 2 north, 3 west
    int line = 0;        ///< the row or the column that it lies on
    double depth = 0.0;  ///< how far its wall reaches below the ground at least, metres
    bool border = false; ///< of the tile
    std::size_t vertices = 0;

    bool alongColumns() const { return number % 2 == 0; }
    /// The place along the side. It grows with the block's inside on the left.
    int place(const Post& post) const
    {
        const int along = alongColumns() ? post.column : post.row;
        return number < 2 ? along : -along;
    }
    bool holds(const Post& post) const { return (alongColumns() ? post.row : post.column) == line; }
    Post post(int place) const
    {
        const int along = number < 2 ? place : -place;
        return alongColumns() ? Post{along, line} : Post{line, along};
    }
    osg::Vec2d out() const
    {
        return {number == 1 ? 1.0 : number == 3 ? -1.0 : 0.0, number == 2 ? 1.0 : number == 0 ? -1.0 : 0.0};
    }
};

/// The meshes of a block before they have vertices, the nearest one first.
struct TileBlocks::Draft
{
    std::vector<BlockMesh> meshes;
    std::vector<double> from; ///< metres from the block's middle
    double tolerance = -1.0;  ///< of the nearest one, metres; negative if it leaves out no post
    bool dense = false;       ///< whether the nearest one has all posts of the block
};

TileBlocks::TileBlocks(const BuildPlan& plan, const TileKey& key, const TileNetwork& network,
                       const LevelArrays& arrays, int x, int y)
    : _plan(plan), _key(key), _network(network), _lattice(network.lattice()), _arrays(arrays), _x(x), _y(y)
{
    addVertices({0, 0, _lattice.intervals});
    for (int side = 0; side < 4; ++side)
    {
        _skirts[static_cast<std::size_t>(side)] = plan.skirt(key, side);
        _poles[static_cast<std::size_t>(side)] = plan.poleHeight(key, side);
    }
    // Only tiles of the coarsest level are far enough away for larger blocks than these.
    const int intervals = _lattice.intervals, smallest = smallestBlock(plan.scheme, isFinest(), intervals);
    const int size = key.level == 0 ? intervals : std::min(intervals, 2 * smallest);
    std::vector<Block> roots;
    for (int row = 0; row < intervals; row += size)
        for (int column = 0; column < intervals; column += size)
        {
            Block block = make({column, row, size});
            if (!block.meshes.empty() || !block.finer.empty()) roots.push_back(std::move(block));
        }
    // The roots come first.
    _roots = roots.size();
    for (Block& block : _blocks)
    {
        for (std::size_t& each : block.finer)
            each += _roots;
        roots.push_back(std::move(block));
    }
    for (std::size_t i = 0; i < _roots; ++i)
        for (std::size_t& each : roots[i].finer)
            each += _roots;
    _blocks = std::move(roots);
    std::vector<std::vector<std::vector<std::uint32_t>*>> lists(_vertices.size());
    for (Block& block : _blocks)
        for (Mesh& mesh : block.meshes)
            lists[block.vertices].push_back(&mesh.triangles);
    for (std::size_t i = 0; i < lists.size(); ++i)
        _vertices[i]->finish(lists[i]);
}

std::size_t TileBlocks::addVertices(const TileBlock& block)
{
    _vertices.push_back(std::make_unique<TileVertices>(_plan, _key, _arrays, _x, _y, block));
    return _vertices.size() - 1;
}

double TileBlocks::metres() const
{
    return _plan.scheme.tileMetres(_key.level) / _lattice.intervals;
}

TileBlocks::Block TileBlocks::make(const TileBlock& block)
{
    Block result;
    float low = FLT_MAX, high = -FLT_MAX;
    for (int row = block.row; row <= block.row + block.size; ++row)
        for (int column = block.column; column <= block.column + block.size; ++column)
        {
            const float height = _lattice.heights.at(_lattice.column + column, _lattice.row + row);
            low = std::min(low, height); // this order ignores NaN
            high = std::max(high, height);
        }
    if (low > high || block.column >= _lattice.endColumn || block.row >= _lattice.endRow) return result;
    // The box of a grid of points. Between them the globe is as good as a plane.
    constexpr int parts = 4;
    osg::BoundingBoxd box;
    const int step = std::max(1, block.size / parts);
    for (int row = 0; row <= block.size; row += step)
        for (int column = 0; column <= block.size; column += step)
        {
            const Post post{block.column + column, block.row + row};
            const osg::Vec3d ground = _vertices.front()->ground(post), up = _vertices.front()->up(post);
            box.expandBy(ground + up * static_cast<double>(low));
            box.expandBy(ground + up * static_cast<double>(high));
        }
    const std::array<int, 4> lines = linesOf(block), ends = borders();
    for (const std::size_t side : {0u, 2u})
        if (_poles[side] && lines[side] == ends[side])
            box.expandBy(_vertices.front()->pole(side == 2, *_poles[side]));
    result.middle = box.center();
    result.radius = box.radius();

    if (!isSmallest(block))
    {
        const int half = block.size / 2;
        for (int quarter = 0; quarter < 4; ++quarter)
        {
            Block finer =
                make({block.column + (quarter & 1) * half, block.row + (quarter >> 1) * half, half});
            if (finer.meshes.empty() && finer.finer.empty()) continue;
            _blocks.push_back(std::move(finer));
            result.finer.push_back(_blocks.size() - 1);
        }
        // At the end of the ground blocks are small. They wait until the tile's own error is small enough.
        if (!result.finer.empty())
            result.finerWithin = std::max(FINER_WITHIN * result.radius,
                                          result.radius + _plan.tolerance(_key.level) * perMetre());
    }
    makeMeshes(block, result);
    return result;
}

bool TileBlocks::isSmallest(const TileBlock& block) const
{
    return block.size == smallestBlock(_plan.scheme, isFinest(), _lattice.intervals);
}

void TileBlocks::makeMeshes(const TileBlock& block, Block& result)
{
    Draft draft = nearest(block, result);
    if (draft.meshes.front().corners.empty()) return;
    addCoarser(block, result, draft);
    // A plain is off by rounding alone, which is no reason to load finer tiles.
    if (isSmallest(block) && draft.meshes.front().deviation > NEGLIGIBLE_METRES)
        _error = std::max(_error, draft.meshes.front().deviation + rounding());
    addShortEdges(block, draft);
    if (isSmallest(block) && isFinest()) result.vertices = addVertices(block);
    if (draft.dense) _vertices[result.vertices]->addAll();
    for (std::size_t i = 0; i < draft.meshes.size(); ++i)
        result.meshes.push_back(made(block, result, draft, i));
}

TileBlocks::Draft TileBlocks::nearest(const TileBlock& block, const Block& result) const
{
    const bool smallest = isSmallest(block);
    const bool own = smallest && isFinest();
    Draft draft;
    if (own)
    {
        // If hardly any post can be left out, all stay.
        const double negligible = std::min(NEGLIGIBLE * metres(), NEGLIGIBLE_METRES);
        const auto posts =
            static_cast<std::size_t>(block.size + 1) * static_cast<std::size_t>(block.size + 1);
        draft.dense = 2 * _network.errors(block, negligible).size() > posts;
        if (!draft.dense) draft.tolerance = negligible;
    }
    else
        draft.tolerance =
            std::max(_plan.tolerance(_key.level), (result.finerWithin - result.radius) / perMetre());
    // The walls of neighbours reach down by the error of the finest meshes, so it has a bound.
    const double most = own        ? HUGE_VAL
                        : smallest ? _plan.finestError(_key.level)
                                   : std::min(_plan.largestError(_key.level), ACCUMULATION * draft.tolerance);
    BlockMesh mesh = _network.triangulate(block, draft.tolerance, block.size);
    while (draft.tolerance > 0.0 && mesh.deviation > most)
        mesh = _network.triangulate(block, draft.tolerance *= 0.7, block.size);
    // A mesh with all posts is off by rounding alone.
    if (draft.tolerance < 0.0) mesh.deviation = 0.0;
    draft.meshes.push_back(std::move(mesh));
    draft.from.push_back(result.finerWithin);
    return draft;
}

void TileBlocks::addCoarser(const TileBlock& block, const Block& result, Draft& draft) const
{
    auto& [meshes, from, tolerance, dense] = draft;
    const std::vector<float> errors = _network.errors(block, tolerance);
    for (auto count = errors.size(); count > 0;)
    {
        count = static_cast<std::size_t>(STEP * static_cast<double>(count));
        const auto coarser = static_cast<double>(errors[count]);
        BlockMesh mesh = _network.triangulate(block, coarser, block.size);
        if (mesh.deviation > _plan.largestError(_key.level)) break;
        if (static_cast<double>(mesh.corners.size()) >
            LEAST_GAIN * static_cast<double>(meshes.back().corners.size()))
            continue;
        const double error = std::max(coarser, mesh.deviation / ACCUMULATION) +
                             static_cast<double>(_plan.fact(_key).latticeError) + rounding();
        const double distance = result.radius + error * perMetre();
        // If the nearer mesh would hardly ever be seen, this one replaces it. The nearest one of all is replaced only
        // if it would never be seen.
        const bool replaces = distance <= (meshes.size() > 1 ? LEAST_STEP : 1.0) * from.back();
        if (replaces)
        {
            meshes.back() = std::move(mesh);
            from.back() = std::max(from.back(), distance);
        }
        else
        {
            meshes.push_back(std::move(mesh));
            from.push_back(distance);
        }
    }
}

void TileBlocks::addShortEdges(const TileBlock& block, Draft& draft) const
{
    const int longest = isFinest() ? PLAIN_CELLS : _lattice.intervals / leastCells(_plan.scheme.intervals);
    if (!isSmallest(block) || longestEdge(draft.meshes.front()) <= 1.5 * longest) return;
    draft.meshes.insert(draft.meshes.begin(), _network.triangulate(block, draft.tolerance, longest));
    draft.from.insert(draft.from.begin(), 0.0);
    draft.from[1] = std::max(draft.from[1], NEARER_THAN_ANY_CAMERA);
}

TileBlocks::Mesh TileBlocks::made(const TileBlock& block, const Block& result, const Draft& draft,
                                  std::size_t mesh)
{
    const BlockMesh& surface = draft.meshes[mesh];
    TileVertices& vertices = *_vertices[result.vertices];
    Mesh made;
    made.from = draft.from[mesh];
    made.longestEdge = longestEdge(surface) * metres();
    for (const Post& corner : surface.corners)
        made.triangles.push_back(vertices.post(corner));
    std::vector<std::uint32_t> walls;
    addCaps(block, result.vertices, surface, made.triangles, walls);
    if (!walls.empty()) made.longestEdge = std::max(made.longestEdge, toPole());
    made.ground = made.triangles.size();
    made.triangles.insert(made.triangles.end(), walls.begin(), walls.end());
    // A neighbour of the same tile or level is hardly farther away than the farthest place where this mesh is drawn.
    // The distance counts twice, since deformations stretch it.
    double other = _plan.largestError(_key.level);
    if (mesh + 1 < draft.meshes.size())
        other = std::min(other, 2.0 * (draft.from[mesh + 1] + result.radius) / perMetre());
    other += static_cast<double>(_plan.fact(_key).latticeError);
    addWalls(block, result.vertices, surface, surface.deviation + other, made.triangles);
    return made;
}

/// In cells.
double TileBlocks::longestEdge(const BlockMesh& mesh)
{
    int squared = 0;
    for (std::size_t i = 0; i < mesh.corners.size(); ++i)
    {
        const Post &a = mesh.corners[i], &b = mesh.corners[i % 3 == 2 ? i - 2 : i + 1];
        const int across = a.column - b.column, up = a.row - b.row;
        squared = std::max(squared, across * across + up * up);
    }
    return std::sqrt(squared);
}

void TileBlocks::addWalls(const TileBlock& block, std::size_t vertices, const BlockMesh& mesh, double depth,
                          std::vector<std::uint32_t>& triangles)
{
    // Even in a plain, rounding opens hair lines between meshes of different density. A power of two lets meshes of
    // about the same depth share a wall's lower end.
    const double inner = std::exp2(std::ceil(std::log2(depth + _plan.leastSkirt(_key.level))));
    const std::array<int, 4> lines = linesOf(block), ends = borders();
    for (int number = 0; number < 4; ++number)
    {
        const auto index = static_cast<std::size_t>(number);
        Side side{number, lines[index], inner, false, vertices};
        side.border = side.line == ends[index];
        const double neighbours = _skirts[index];
        if (side.border) side.depth = neighbours > 0.0 ? std::max(inner, mesh.deviation + neighbours) : 0.0;
        if (side.depth <= 0.0) continue;
        // A wall hangs from each edge of the surface along the side. Holes, and posts beyond the end of the ground,
        // have none.
        for (const std::vector<Post>& way : border(side, mesh))
            addWall(side, way, triangles);
    }
}

std::array<int, 4> TileBlocks::linesOf(const TileBlock& block) const
{
    // There is nothing beyond the end of the ground.
    return {block.row, std::min(block.column + block.size, _lattice.eastColumn()),
            std::min(block.row + block.size, _lattice.northRow()), block.column};
}

std::vector<std::vector<BlockMesh::Post>> TileBlocks::border(const Side& side, const BlockMesh& mesh)
{
    std::vector<std::pair<int, int>> edges;
    for (std::size_t i = 0; i < mesh.corners.size(); ++i)
    {
        const Post &a = mesh.corners[i], &b = mesh.corners[i % 3 == 2 ? i - 2 : i + 1];
        if (side.holds(a) && side.holds(b) && side.place(a) < side.place(b))
            edges.emplace_back(side.place(a), side.place(b));
    }
    std::sort(edges.begin(), edges.end());
    std::vector<std::vector<Post>> ways;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
        if (i == 0 || edges[i - 1].second != edges[i].first) ways.push_back({side.post(edges[i].first)});
        ways.back().push_back(side.post(edges[i].second));
    }
    return ways;
}

double TileBlocks::toPole() const
{
    const TilingScheme& scheme = _plan.scheme;
    // The radius of curvature at the poles, where it is largest.
    const double radius = GeographicLib::Constants::WGS84_a() / (1.0 - GeographicLib::Constants::WGS84_f());
    return osg::DegreesToRadians(std::max(90.0 + scheme.south, 90.0 - scheme.north)) * radius;
}

void TileBlocks::addCaps(const TileBlock& block, std::size_t vertices, const BlockMesh& mesh,
                         std::vector<std::uint32_t>& triangles, std::vector<std::uint32_t>& walls)
{
    const std::array<int, 4> lines = linesOf(block), ends = borders();
    TileVertices& all = *_vertices[vertices];
    // Blocks beside each other have the corner and the pole in common. Only rounding parts them there.
    const double depth = std::min(_plan.leastSkirt(_key.level), endDepth());
    for (const int number : {0, 2})
    {
        const auto index = static_cast<std::size_t>(number);
        if (!_poles[index] || lines[index] != ends[index]) continue;
        const Side side{number, lines[index], depth, true, vertices};
        const auto pole = [&](const Post& post, double below)
        {
            const auto [entry, isNew] =
                _atPoles.try_emplace(std::make_tuple(vertices, number, post.column, post.row, below), 0u);
            if (isNew) entry->second = all.atPole(post, number == 2, *_poles[index] - below);
            return entry->second;
        };
        const auto low = [&](const Post& post)
        {
            const auto [entry, isNew] =
                _strips.try_emplace(std::make_tuple(vertices, number, post.column, post.row, depth), 0u);
            if (isNew) entry->second = all.below(post, depth, 0.0, 0.0);
            return entry->second;
        };
        for (const std::vector<Post>& way : border(side, mesh))
        {
            for (std::size_t i = 0; i + 1 < way.size(); ++i)
                triangles.insert(triangles.end(),
                                 {all.post(way[i + 1]), all.post(way[i]), pole(way[i], 0.0)});
            const Post &first = way.front(), &last = way.back();
            walls.insert(walls.end(), {all.post(first), low(first), pole(first, 0.0),      //
                                       pole(first, 0.0), low(first), pole(first, depth),   //
                                       pole(last, 0.0), pole(last, depth), all.post(last), //
                                       all.post(last), pole(last, depth), low(last)});
        }
    }
}

/// Whether a post lies on the terrain's border, where all levels have the same post.
bool TileBlocks::ends(const Post& post) const
{
    const bool on[4] = {post.row == 0, post.column >= _lattice.eastColumn(), post.row >= _lattice.northRow(),
                        post.column == 0};
    for (std::size_t side = 0; side < 4; ++side)
        if (on[side] && _skirts[side] <= 0.0) return true;
    return false;
}

void TileBlocks::addWall(const Side& side, const std::vector<Post>& top,
                         std::vector<std::uint32_t>& triangles)
{
    TileVertices& vertices = *_vertices[side.vertices];
    const Post first = top.front(), last = top.back();
    if (!_lattice.places.empty() || ends(first) || ends(last))
    {
        addStrip(side, top, triangles);
        return;
    }
    const int start = side.place(first), end = side.place(last);
    const auto height = [&](const Post& post)
    {
        return static_cast<double>(_lattice.height(post.column, post.row));
    };
    const auto [entry, isNew] =
        _lines.try_emplace(std::make_tuple(side.vertices, side.number, side.line, start, end, side.depth));
    Line& line = entry->second;
    if (isNew)
    {
        // The lower end is a straight line below everything between. It runs along the chord, unless this would take
        // it lower than a level line.
        const double a = height(first), b = height(last);
        double sag = 0.0, lowest = std::min(a, b);
        for (int place = start + 1; place < end; ++place)
        {
            const double each = height(side.post(place));
            const double share = static_cast<double>(place - start) / (end - start);
            sag = std::max(sag, a + share * (b - a) - each);
            lowest = std::min(lowest, each);
        }
        const bool chord = std::min(a, b) - sag >= lowest - 0.01;
        line.depths = {side.depth + (chord ? sag : a - lowest), side.depth + (chord ? sag : b - lowest)};
        const osg::Vec2d out = side.out() * (LEAN * side.depth);
        line.ends = {vertices.below(first, line.depths[0], out.x(), out.y()),
                     vertices.below(last, line.depths[1], out.x(), out.y())};
    }
    // The polygon between the border and the line, cut into triangles ear by ear.
    struct Corner
    {
        osg::Vec2d at;
        std::uint32_t index;
    };
    std::vector<Corner> open{{osg::Vec2d(start, height(first) - line.depths[0]), line.ends[0]}};
    const auto add = [&](const Corner& next)
    {
        while (open.size() > 1)
        {
            const Corner &from = open[open.size() - 2], &middle = open.back();
            if (turn(from.at, middle.at, next.at) >= 0.0) break;
            triangles.insert(triangles.end(), {from.index, next.index, middle.index});
            open.pop_back();
        }
        open.push_back(next);
    };
    for (const Post& post : top)
        add({osg::Vec2d(side.place(post), height(post)), vertices.post(post)});
    add({osg::Vec2d(end, height(last) - line.depths[1]), line.ends[1]});
}

void TileBlocks::addStrip(const Side& side, const std::vector<Post>& top,
                          std::vector<std::uint32_t>& triangles)
{
    TileVertices& vertices = *_vertices[side.vertices];
    const auto low = [&](const Post& post)
    {
        const auto [entry, isNew] = _strips.try_emplace(
            std::make_tuple(side.vertices, side.number, post.column, post.row, side.depth), 0u);
        if (isNew)
        {
            // A leaning end would show below the border.
            const bool end = ends(post);
            const double depth = end ? std::min(side.depth, endDepth()) : side.depth;
            const osg::Vec2d out = side.out() * (end ? 0.0 : LEAN * depth);
            entry->second = vertices.below(post, depth, out.x(), out.y());
        }
        return entry->second;
    };
    for (std::size_t i = 0; i + 1 < top.size(); ++i)
    {
        const std::uint32_t a = vertices.post(top[i]), b = vertices.post(top[i + 1]);
        const std::uint32_t lowA = low(top[i]), lowB = low(top[i + 1]);
        triangles.insert(triangles.end(), {a, lowA, b, b, lowA, lowB});
    }
}

} // namespace osgGeoFX
