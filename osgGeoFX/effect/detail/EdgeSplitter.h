// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec3d>

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Splits triangles until no edge is longer than wished.

    Into how many equal parts an edge is split, a power of two, follows from its length alone. So two meshes that share an edge,
    and know nothing of each other, split it at the same points, and no crack opens between them. */
class EdgeSplitter
{
public:
    using Triangles = std::vector<unsigned int>; ///< three numbers of positions each

    /// `positions`, metres, grow by those of new vertices.
    EdgeSplitter(std::vector<osg::Vec3d> positions, double longest);

    /// Splits lists of triangles that may share vertices. Where more than `most` triangles would come of it, edges inside are
    /// split less, and those on the border (of one triangle alone) as ever. False if even that is too many; then too, what is on
    /// the border is right.
    bool split(std::vector<Triangles>& lists, std::size_t most);

    const std::vector<osg::Vec3d>& positions() const { return _positions; }
    /// Of each new vertex, the two in whose middle it lies, in the order of the new ones' numbers.
    const std::vector<std::pair<unsigned int, unsigned int>>& parents() const { return _parents; }
    /// By how much longer than wished edges inside are.
    double inside() const { return _inside; }

private:
    /// The side `edge` lies opposite to the corner of its number.
    struct Triangle
    {
        unsigned int corners[3];
        int levels[3]; ///< into 2^level parts
    };
    static std::uint64_t keyOf(unsigned int a, unsigned int b);
    int levelOf(unsigned int a, unsigned int b, double longest) const;
    unsigned int middleOf(unsigned int a, unsigned int b);
    void countEdges(const std::vector<Triangles>& lists);
    bool splitAll(std::vector<Triangles>& lists, std::size_t most);
    bool splitOne(const Triangle& triangle, Triangles& to, std::size_t most);

    std::vector<osg::Vec3d> _positions;
    double _longest;
    double _inside = 1.0;
    std::size_t _count = 0;
    std::vector<std::pair<unsigned int, unsigned int>> _parents;
    std::unordered_map<std::uint64_t, unsigned int> _middles;
    std::unordered_map<std::uint64_t, unsigned int> _uses; ///< by how many triangles each edge is used
};

} // namespace osgGeoFX
