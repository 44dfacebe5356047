// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/detail/EdgeSplitter.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Into 4,096 parts; a ground of a million kilometres for edges of 100 m.
constexpr int mostLevels = 12;

} // namespace

EdgeSplitter::EdgeSplitter(std::vector<osg::Vec3d> positions, double longest)
    : _positions(std::move(positions)), _longest(longest)
{
}

std::uint64_t EdgeSplitter::keyOf(unsigned int a, unsigned int b)
{
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

int EdgeSplitter::levelOf(unsigned int a, unsigned int b, double longest) const
{
    const double ratio = (_positions[a] - _positions[b]).length() / longest;
    if (!(ratio > 1.0)) return 0;
    // A little more is allowed: two tiles know the ends of an edge to the last bits of their own frames, and lengths like to be round.
    constexpr double more = 1e-3;
    return std::clamp(static_cast<int>(std::ceil(std::log2(ratio) - more)), 0, mostLevels);
}

unsigned int EdgeSplitter::middleOf(unsigned int a, unsigned int b)
{
    const auto [entry, isNew] =
        _middles.try_emplace(keyOf(a, b), static_cast<unsigned int>(_positions.size()));
    if (isNew)
    {
        _parents.emplace_back(a, b);
        _positions.push_back((_positions[a] + _positions[b]) * 0.5);
    }
    return entry->second;
}

void EdgeSplitter::countEdges(const std::vector<Triangles>& lists)
{
    for (const Triangles& list : lists)
    {
        for (std::size_t i = 0; i < list.size(); i += 3)
        {
            for (std::size_t side = 0; side < 3; ++side)
                ++_uses[keyOf(list[i + side], list[i + (side + 1) % 3])];
        }
    }
}

bool EdgeSplitter::split(std::vector<Triangles>& lists, std::size_t most)
{
    countEdges(lists);
    const std::vector<Triangles> originals = lists;
    const std::size_t vertices = _positions.size();
    for (int attempt = 0; attempt <= mostLevels; ++attempt)
    {
        lists = originals;
        _positions.resize(vertices);
        _parents.clear();
        _middles.clear();
        _count = 0;
        // The last one goes to its end.
        if (splitAll(lists, attempt < mostLevels ? most : static_cast<std::size_t>(-1))) break;
        _inside *= 2.0;
    }
    return _count <= most;
}

bool EdgeSplitter::splitAll(std::vector<Triangles>& lists, std::size_t most)
{
    for (Triangles& list : lists)
    {
        Triangles result;
        result.reserve(list.size());
        for (std::size_t i = 0; i < list.size(); i += 3)
        {
            Triangle triangle{{list[i], list[i + 1], list[i + 2]}, {}};
            for (std::size_t side = 0; side < 3; ++side)
            {
                const unsigned int a = triangle.corners[(side + 1) % 3], b = triangle.corners[(side + 2) % 3];
                const bool inside = _uses[keyOf(a, b)] > 1;
                triangle.levels[side] = levelOf(a, b, inside ? _longest * _inside : _longest);
            }
            if (!splitOne(triangle, result, most)) return false;
        }
        list = std::move(result);
    }
    return true;
}

bool EdgeSplitter::splitOne(const Triangle& triangle, Triangles& to, std::size_t most)
{
    // The edge with the most parts, of equal ones the longest: so triangles stay as round as they were.
    std::size_t side = 0;
    double longest = -1.0;
    for (std::size_t each = 0; each < 3; ++each)
    {
        const double length =
            (_positions[triangle.corners[(each + 1) % 3]] - _positions[triangle.corners[(each + 2) % 3]])
                .length2();
        const int level = triangle.levels[each], best = triangle.levels[side];
        if (level > best || (level == best && length > longest))
        {
            side = each;
            longest = length;
        }
    }
    if (triangle.levels[side] == 0)
    {
        to.insert(to.end(), triangle.corners, triangle.corners + 3);
        return ++_count <= most;
    }
    const unsigned int apex = triangle.corners[side];
    const std::size_t next = (side + 1) % 3, last = (side + 2) % 3;
    const unsigned int first = triangle.corners[next], second = triangle.corners[last];
    const unsigned int middle = middleOf(first, second);
    const int half = triangle.levels[side] - 1;
    const int between = levelOf(apex, middle, _longest * _inside);
    // An edge's side has the number of the corner opposite to it.
    return splitOne({{apex, first, middle}, {half, between, triangle.levels[last]}}, to, most) &&
           splitOne({{apex, middle, second}, {half, triangle.levels[next], between}}, to, most);
}

} // namespace osgGeoFX
