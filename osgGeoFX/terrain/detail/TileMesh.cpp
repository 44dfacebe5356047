// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TileMesh.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace osgGeoFX
{

namespace
{

/// The error of a post that every mesh must have.
constexpr float ALWAYS = std::numeric_limits<float>::max();

} // namespace

/// Splits the triangles of one mesh.
struct TileNetwork::Splitter
{
    const TileNetwork& network;
    const float tolerance;
    const int longest;
    BlockMesh mesh;

    /// A triangle with the longest edge from a to b and the right angle at c. The order a, b, c is counter-clockwise.
    void split(Post a, Post b, Post c)
    {
        const Post m{(a.column + b.column) / 2, (a.row + b.row) / 2};
        const int leg = std::abs(a.column - c.column) + std::abs(a.row - c.row);
        const int reach = std::max({std::abs(a.column - b.column), std::abs(a.row - b.row)});
        if (leg > 1 && (reach > longest || network.error(m.column, m.row) > tolerance))
        {
            split(c, a, m);
            split(b, c, m);
            return;
        }
        const TileLattice& lattice = network._lattice;
        for (const Post& post : {a, b, c})
            if (std::isnan(lattice.height(post.column, post.row))) return;
        if (std::min({a.column, b.column, c.column}) >= lattice.endColumn ||
            std::min({a.row, b.row, c.row}) >= lattice.endRow)
            return;
        mesh.corners.insert(mesh.corners.end(), {a, b, c});
        mesh.deviation = std::max(mesh.deviation, network.deviation(a, b, c));
    }
};

TileNetwork::TileNetwork(const TileLattice& lattice)
    : _lattice(lattice), _errors(static_cast<std::size_t>(lattice.intervals + 1) *
                                 static_cast<std::size_t>(lattice.intervals + 1))
{
    gatherErrors();
}

BlockMesh TileNetwork::triangulate(const TileBlock& block, double tolerance, int longest) const
{
    Splitter splitter{*this, static_cast<float>(tolerance), longest, {}};
    const int west = block.column, south = block.row, east = west + block.size, north = south + block.size;
    // The diagonals of neighbouring cells alternate.
    if ((west / block.size + south / block.size) % 2 == 0)
    {
        splitter.split({east, north}, {west, south}, {east, south});
        splitter.split({west, south}, {east, north}, {west, north});
    }
    else
    {
        splitter.split({east, south}, {west, north}, {west, south});
        splitter.split({west, north}, {east, south}, {east, north});
    }
    return std::move(splitter.mesh);
}

std::vector<float> TileNetwork::errors(const TileBlock& block, double tolerance) const
{
    std::vector<float> result;
    for (int r = block.row; r <= block.row + block.size; ++r)
        for (int c = block.column; c <= block.column + block.size; ++c)
        {
            const float each = error(c, r);
            if (each<ALWAYS&& static_cast<double>(each)> tolerance) result.push_back(each);
        }
    std::sort(result.begin(), result.end(), std::greater<>());
    return result;
}

/// The distance of an edge's middle from the straight line between its ends, metres.
float TileNetwork::edgeError(int c, int r, int dc, int dr) const
{
    const float h = _lattice.height(c, r), a = _lattice.height(c - dc, r - dr),
                b = _lattice.height(c + dc, r + dr);
    const int holes = std::isnan(h) + std::isnan(a) + std::isnan(b);
    if (holes == 3) return 0.0f;
    if (holes > 0) return ALWAYS;
    // Posts beyond the end of the ground are drawn on the end, so an edge must not cross it.
    const auto crosses = [](int from, int to, int end)
    {
        return std::min(from, to) < end && std::max(from, to) > end;
    };
    if (crosses(c - dc, c + dc, _lattice.endColumn) || crosses(r - dr, r + dr, _lattice.endRow))
        return ALWAYS;
    if (_lattice.places.empty()) return std::abs(h - 0.5f * (a + b));
    return (_lattice.place(c, r) - (_lattice.place(c - dc, r - dr) + _lattice.place(c + dc, r + dr)) * 0.5f)
        .length();
}

/// The middle of an edge gets the largest error of all posts that depend on it, so that a split never leaves a gap.
void TileNetwork::gatherErrors()
{
    const int n = _lattice.intervals;
    const auto include = [&](float& target, int c, int r)
    {
        if (c >= 0 && r >= 0 && c <= n && r <= n) target = std::max(target, error(c, r));
    };
    for (int half = 1; half < n; half *= 2)
    {
        const int step = 2 * half, quarter = half / 2;
        for (int r = 0; r <= n; r += half)
            for (int c = (r / half) % 2 ? 0 : half; c <= n; c += step)
            {
                const bool alongX = (c / half) % 2 != 0;
                float e = edgeError(c, r, alongX ? half : 0, alongX ? 0 : half);
                if (quarter > 0)
                    for (const int dr : {-quarter, quarter})
                        for (const int dc : {-quarter, quarter})
                            include(e, c + dc, r + dr);
                error(c, r) = e;
            }
        for (int r = half; r <= n; r += step)
            for (int c = half; c <= n; c += step)
            {
                // The diagonals of neighbouring cells alternate.
                const bool main = ((c / step) + (r / step)) % 2 == 0;
                float e = edgeError(c, r, main ? half : -half, half);
                include(e, c - half, r);
                include(e, c + half, r);
                include(e, c, r - half);
                include(e, c, r + half);
                error(c, r) = e;
            }
    }
}

/// The largest distance of the posts over a triangle from it. Its right angle is at c.
double TileNetwork::deviation(Post a, Post b, Post c) const
{
    const float ha = _lattice.height(a.column, a.row), hb = _lattice.height(b.column, b.row),
                hc = _lattice.height(c.column, c.row);
    const int ax = a.column - c.column, ay = a.row - c.row, bx = b.column - c.column, by = b.row - c.row;
    const int squared = ax * ax + ay * ay;
    const float scale = 1.0f / static_cast<float>(squared);
    const auto [c0, c1] = std::minmax({a.column, b.column, c.column});
    const auto [r0, r1] = std::minmax({a.row, b.row, c.row});
    float worst = 0.0f;
    for (int r = r0; r <= r1; ++r)
        for (int col = c0; col <= c1; ++col)
        {
            const int px = col - c.column, py = r - c.row;
            const int u = px * ax + py * ay, v = px * bx + py * by;
            if (u < 0 || v < 0 || u + v > squared) continue;
            const float s = scale * static_cast<float>(u), t = scale * static_cast<float>(v);
            float difference = std::abs(_lattice.height(col, r) - (hc + s * (ha - hc) + t * (hb - hc)));
            if (!_lattice.places.empty())
            {
                const osg::Vec3f& corner = _lattice.place(c.column, c.row);
                difference =
                    (_lattice.place(col, r) - corner - (_lattice.place(a.column, a.row) - corner) * s -
                     (_lattice.place(b.column, b.row) - corner) * t)
                        .length();
            }
            if (difference > worst) // false for a hole
                worst = difference;
        }
    return static_cast<double>(worst);
}

} // namespace osgGeoFX
