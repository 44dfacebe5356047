// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TileMesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

// A change of slope along an edge that shading shows: about 6°.
constexpr float VISIBLE_SLOPE = 0.1f;
constexpr std::uint32_t UNUSED = std::numeric_limits<std::uint32_t>::max();

using Post = TileMesh::Post;

class Network
{
public:
    Network(const TileLattice& lattice, const TileSlopes& slopes)
        : _lattice(lattice), _slopes(slopes), _side(lattice.intervals + 1),
          _errors(static_cast<std::size_t>(_side) * static_cast<std::size_t>(_side)),
          _indices(_errors.size(), UNUSED)
    {
    }

    /// Splits where the relief's error times `perMetre`, or the slope's, exceeds 1.
    TileMesh triangulate(float perMetre)
    {
        gatherErrors(perMetre);
        TileMesh mesh;
        std::fill(_indices.begin(), _indices.end(), UNUSED);
        const int n = _lattice.intervals;
        split(mesh, {n, n}, {0, 0}, {n, 0});
        split(mesh, {0, 0}, {n, n}, {0, n});
        gatherEdge(mesh);
        return mesh;
    }

private:
    float& error(int c, int r)
    {
        return _errors[static_cast<std::size_t>(r) * static_cast<std::size_t>(_side) +
                       static_cast<std::size_t>(c)];
    }

    /// How much the middle of an edge is missed by the straight line between its ends.
    float edgeError(int c, int r, int dc, int dr, float perMetre) const
    {
        const float h = _lattice.height(c, r), a = _lattice.height(c - dc, r - dr),
                    b = _lattice.height(c + dc, r + dr);
        const int holes = std::isnan(h) + std::isnan(a) + std::isnan(b);
        if (holes == 3) return 0.0f;
        if (holes > 0) return std::numeric_limits<float>::max();
        // Posts beyond the end of the ground are drawn on it, so nothing may lie on both sides.
        const auto crosses = [](int from, int to, int end)
        {
            return std::min(from, to) < end && std::max(from, to) > end;
        };
        if (crosses(c - dc, c + dc, _lattice.endColumn) || crosses(r - dr, r + dr, _lattice.endRow))
            return std::numeric_limits<float>::max();
        if (2 * std::max(std::abs(dc), std::abs(dr)) * leastCells(_lattice.intervals) > _lattice.intervals)
            return std::numeric_limits<float>::max();
        float result = std::abs(h - 0.5f * (a + b)) * perMetre;
        if (!_lattice.places.empty())
            result = (_lattice.place(c, r) -
                      (_lattice.place(c - dc, r - dr) + _lattice.place(c + dc, r + dr)) * 0.5f)
                         .length() *
                     perMetre;

        const int step = _lattice.intervals / _slopes.intervals;
        if (c % step == 0 && r % step == 0 && dc % step == 0 && dr % step == 0)
        {
            const int sc = c / step, sr = r / step, sdc = dc / step, sdr = dr / step;
            const float x = _slopes.slopeX(sc, sr) -
                            0.5f * (_slopes.slopeX(sc - sdc, sr - sdr) + _slopes.slopeX(sc + sdc, sr + sdr));
            const float y = _slopes.slopeY(sc, sr) -
                            0.5f * (_slopes.slopeY(sc - sdc, sr - sdr) + _slopes.slopeY(sc + sdc, sr + sdr));
            result = std::max(result, std::max(std::abs(x), std::abs(y)) / VISIBLE_SLOPE);
        }
        return result;
    }

    /// An edge's middle carries the largest error of all that depends on it, so that a split never leaves a gap.
    void gatherErrors(float perMetre)
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
                    float e = edgeError(c, r, alongX ? half : 0, alongX ? 0 : half, perMetre);
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
                    float e = edgeError(c, r, main ? half : -half, half, perMetre);
                    include(e, c - half, r);
                    include(e, c + half, r);
                    include(e, c, r - half);
                    include(e, c, r + half);
                    error(c, r) = e;
                }
        }
    }

    /// The triangle with the longest edge from a to b and the right angle at c, anticlockwise as a, b, c.
    void split(TileMesh& mesh, Post a, Post b, Post c)
    {
        const Post m{(a.column + b.column) / 2, (a.row + b.row) / 2};
        if (std::abs(a.column - c.column) + std::abs(a.row - c.row) > 1 && error(m.column, m.row) > 1.0f)
        {
            split(mesh, c, a, m);
            split(mesh, b, c, m);
            return;
        }
        const float ha = _lattice.height(a.column, a.row), hb = _lattice.height(b.column, b.row),
                    hc = _lattice.height(c.column, c.row);
        if (std::isnan(ha) || std::isnan(hb) || std::isnan(hc)) return;
        if (std::min({a.column, b.column, c.column}) >= _lattice.endColumn ||
            std::min({a.row, b.row, c.row}) >= _lattice.endRow)
            return;
        for (const Post& post : {a, b, c})
        {
            auto& index = _indices[static_cast<std::size_t>(post.row) * static_cast<std::size_t>(_side) +
                                   static_cast<std::size_t>(post.column)];
            if (index == UNUSED)
            {
                index = static_cast<std::uint32_t>(mesh.posts.size());
                mesh.posts.push_back(post);
            }
            mesh.triangles.push_back(index);
        }
        measure(mesh, a, b, c, ha, hb, hc);
    }

    void measure(TileMesh& mesh, Post a, Post b, Post c, float ha, float hb, float hc) const
    {
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
        mesh.deviation = std::max(mesh.deviation, static_cast<double>(worst));
    }

    void gatherEdge(TileMesh& mesh) const
    {
        const int east = _lattice.eastColumn(), north = _lattice.northRow();
        const auto include = [&](int c, int r)
        {
            const auto index = _indices[static_cast<std::size_t>(r) * static_cast<std::size_t>(_side) +
                                        static_cast<std::size_t>(c)];
            if (index != UNUSED) mesh.edge.push_back(index);
        };
        for (int i = 0; i < east; ++i)
            include(i, 0);
        for (int i = 0; i < north; ++i)
            include(east, i);
        for (int i = east; i > 0; --i)
            include(i, north);
        for (int i = north; i >= 0; --i)
            include(0, i);
    }

    const TileLattice& _lattice;
    const TileSlopes& _slopes;
    const int _side;
    std::vector<float> _errors;
    std::vector<std::uint32_t> _indices;
};

} // namespace

TileMesh createFullMesh(const TileLattice& lattice)
{
    const int n = lattice.intervals, stride = n + 1;
    TileMesh mesh;
    for (int r = 0; r <= n; ++r)
        for (int c = 0; c <= n; ++c)
            mesh.posts.push_back({c, r});
    const auto triangle = [&](Post a, Post b, Post c)
    {
        for (const Post& post : {a, b, c})
            if (std::isnan(lattice.height(post.column, post.row))) return;
        for (const Post& post : {a, b, c})
            mesh.triangles.push_back(static_cast<std::uint32_t>(post.row * stride + post.column));
    };
    for (int r = 0; r < n && r < lattice.endRow; ++r)
        for (int c = 0; c < n && c < lattice.endColumn; ++c)
        {
            triangle({c, r}, {c + 1, r}, {c + 1, r + 1});
            triangle({c, r}, {c + 1, r + 1}, {c, r + 1});
        }
    const int east = lattice.eastColumn(), north = lattice.northRow();
    const auto edge = [&](int c, int r)
    {
        mesh.edge.push_back(static_cast<std::uint32_t>(r * stride + c));
    };
    for (int i = 0; i < east; ++i)
        edge(i, 0);
    for (int i = 0; i < north; ++i)
        edge(east, i);
    for (int i = east; i > 0; --i)
        edge(i, north);
    for (int i = north; i >= 0; --i)
        edge(0, i);
    return mesh;
}

TileMesh createAdaptiveMesh(const TileLattice& lattice, const TileSlopes& slopes, double tolerance)
{
    // The errors of an edge and of the edges it is split into add up; how far is seen only when it is done.
    Network network(lattice, slopes);
    double aim = tolerance;
    for (;;)
    {
        TileMesh mesh = network.triangulate(static_cast<float>(1.0 / aim));
        if (mesh.deviation <= tolerance) return mesh;
        aim *= std::min(0.8, 0.95 * tolerance / mesh.deviation);
    }
}

} // namespace osgGeoFX
