// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TileVertices.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Indices from here on stand for vertices that are no posts.
constexpr std::uint32_t STAND_IN = 0x80000000u;
constexpr std::uint32_t NONE = 0xffffffffu;

/// Vertices lie on a grid of so many metres, or of this share of the way from post to post, whichever is less.
constexpr double QUANTUM = 1.0 / 32.0;
constexpr double SHARE_OF_CELL = 1.0 / 1024.0;

/// The grid's step: a power of two, at least what floats can tell apart on a tile.
double quantum(double tileMetres, int intervals)
{
    const double wanted = std::min(QUANTUM, SHARE_OF_CELL * tileMetres / intervals);
    return std::exp2(std::floor(std::log2(std::max(wanted, 0x1p-23 * tileMetres))));
}

} // namespace

TileVertices::TileVertices(const BuildPlan& plan, const TileKey& key, const LevelArrays& arrays, int x, int y,
                           const TileBlock& block)
    : _plan(plan), _key(key), _arrays(arrays), _frame(plan.scheme, key), _x(x), _y(y),
      _intervals((arrays.heights.columns - 1) / arrays.span), _block(block),
      _finestPosts(static_cast<double>(plan.scheme.intervals) * plan.scheme.step(key.level) / _intervals),
      _quantum(quantum(plan.scheme.tileMetres(key.level), _intervals)),
      _indices(static_cast<std::size_t>(block.size + 1) * static_cast<std::size_t>(block.size + 1), NONE)
{
    normals->setNormalize(true);
}

void TileVertices::addAll()
{
    for (int row = 0; row <= _block.size; ++row)
        for (int column = 0; column <= _block.size; ++column)
            post({_block.column + column, _block.row + row});
}

double TileVertices::gridX(int column) const
{
    return _plan.scheme.gridX(_plan.scheme.firstColumn(_key) + column * _finestPosts);
}

double TileVertices::gridY(int row) const
{
    return _plan.scheme.gridY(_plan.scheme.firstRow(_key) + row * _finestPosts);
}

osg::Vec3d TileVertices::position(const Post& post) const
{
    float height = _arrays.heights.at(_x * _intervals + post.column, _y * _intervals + post.row);
    // No triangle uses such a post. It must not widen the tile's box.
    if (std::isnan(height)) height = _plan.fact(_key).minHeight;
    return _frame.position(gridX(post.column), gridY(post.row), static_cast<double>(height));
}

osg::Vec3d TileVertices::ground(const Post& post) const
{
    return _frame.position(gridX(post.column), gridY(post.row), 0.0);
}

osg::Vec3d TileVertices::up(const Post& post) const
{
    osg::Vec3d east, north, up;
    _frame.axes(gridX(post.column), gridY(post.row), east, north, up);
    return up;
}

osg::Vec3d TileVertices::pole(bool north, double height) const
{
    return _frame.position(_frame.centerX(), north ? 90.0 : -90.0, height);
}

/// The level's slopes lie on its own posts. Between them they are interpolated.
double TileVertices::slope(const std::vector<float>& values, const Post& post) const
{
    const int n = _plan.scheme.intervals, stride = _arrays.span * n + 1;
    const double c = _x * n + static_cast<double>(post.column) * n / _intervals;
    const double r = _y * n + static_cast<double>(post.row) * n / _intervals;
    const int c0 = std::min(static_cast<int>(c), stride - 2), r0 = std::min(static_cast<int>(r), stride - 2);
    const double u = c - c0, v = r - r0;
    const auto at = [&](int i, int j)
    {
        return static_cast<double>(values[static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) +
                                          static_cast<std::size_t>(i)]);
    };
    return (at(c0, r0) * (1.0 - u) + at(c0 + 1, r0) * u) * (1.0 - v) +
           (at(c0, r0 + 1) * (1.0 - u) + at(c0 + 1, r0 + 1) * u) * v;
}

std::uint32_t TileVertices::post(const Post& post)
{
    std::uint32_t& index =
        _indices[static_cast<std::size_t>(post.row - _block.row) * static_cast<std::size_t>(_block.size + 1) +
                 static_cast<std::size_t>(post.column - _block.column)];
    if (index == NONE)
    {
        index = static_cast<std::uint32_t>(_posts.size());
        add(post);
    }
    return index;
}

double TileVertices::rounding() const
{
    return 0.5 * std::sqrt(3.0) * _quantum;
}

osg::Vec3 TileVertices::rounded(const osg::Vec3d& place) const
{
    const auto round = [&](double value)
    {
        return static_cast<float>(std::round(value / _quantum) * _quantum);
    };
    return {round(place.x()), round(place.y()), round(place.z())};
}

void TileVertices::add(const Post& post)
{
    const TilingScheme& scheme = _plan.scheme;
    _posts.push_back(post);
    vertices->push_back(rounded(position(post)));
    osg::Vec3d east, north, up;
    _frame.axes(gridX(post.column), gridY(post.row), east, north, up);
    osg::Vec3d normal = up - east * slope(_arrays.slopeX, post) - north * slope(_arrays.slopeY, post);
    normal.normalize();
    const auto byte = [](double share)
    {
        return static_cast<GLbyte>(std::lround(share * 127.0));
    };
    normals->push_back(osg::Vec3b(byte(normal.x()), byte(normal.y()), byte(normal.z())));
    // Texels lie on the tile's border, so that neighbours of a level meet without a seam.
    const int texels = scheme.textureIntervals(_key.level), size = scheme.textureSize(texels);
    const auto coordinate = [&](int index, int last)
    {
        const double share = std::min<double>(index * _finestPosts, last) / (_finestPosts * _intervals);
        return static_cast<float>((0.5 + texels * share) / size);
    };
    texCoords->push_back(osg::Vec2(coordinate(post.column, scheme.lastColumn - scheme.firstColumn(_key)),
                                   coordinate(post.row, scheme.lastRow - scheme.firstRow(_key))));
}

std::uint32_t TileVertices::below(const Post& post, double depth, double outX, double outY)
{
    osg::Vec3d east, north, up;
    _frame.axes(gridX(post.column), gridY(post.row), east, north, up);
    const std::uint32_t top = this->post(post);
    _others.push_back({rounded(osg::Vec3d((*vertices)[top]) + east * outX + north * outY - up * depth), top});
    return STAND_IN + static_cast<std::uint32_t>(_others.size() - 1);
}

std::uint32_t TileVertices::atPole(const Post& post, bool north, double height)
{
    _others.push_back({rounded(pole(north, height)), this->post(post)});
    return STAND_IN + static_cast<std::uint32_t>(_others.size() - 1);
}

void TileVertices::finish(std::vector<std::vector<std::uint32_t>*>& indices)
{
    const auto first = static_cast<std::uint32_t>(_posts.size());
    for (const Other& other : _others)
    {
        vertices->push_back(other.vertex);
        normals->push_back(osg::Vec3b((*normals)[other.post]));
        texCoords->push_back(osg::Vec2((*texCoords)[other.post]));
    }
    for (auto* list : indices)
        for (std::uint32_t& each : *list)
            if (each >= STAND_IN) each = each - STAND_IN + first;
}

} // namespace osgGeoFX
