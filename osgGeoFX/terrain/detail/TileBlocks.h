// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/TileMesh.h>
#include <osgGeoFX/terrain/detail/TileVertices.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

namespace osgGeoFX
{

/** The levels of detail of a tile: a quadtree of blocks, each with meshes for several distances.

    From its own distance on, a mesh is right to a pixel, with hardly more triangles than needed. Meshes are index
    lists over shared vertices. Each mesh has walls along the block's border, down to what may stand on the other
    side. The lower end of a wall is a straight line. So a wall costs one triangle for each edge of the border, and
    one more. Beside a pole, a mesh has its part of the cap: triangles from its border to the pole.

    Not thread-safe. */
class TileBlocks
{
public:
    struct Mesh
    {
        std::vector<std::uint32_t> triangles; ///< the ground's, then the walls'
        std::size_t ground = 0;               ///< the number of indices of the ground, with its part of a cap
        double from = 0.0;                    ///< metres from the block's middle
        double longestEdge = 0.0;             ///< of the surface, along the ground, metres
    };
    struct Block
    {
        osg::Vec3d middle;
        double radius = 0.0;            ///< around the ground, without walls
        double error = 0.0;             ///< the error of its first mesh against the lattice, metres
        std::vector<Mesh> meshes;       ///< the nearest first
        std::size_t vertices = 0;       ///< the place of its meshes' vertices in vertices()
        double finerWithin = 0.0;       ///< the four finer blocks are drawn within this distance, metres
        std::vector<std::size_t> finer; ///< their places in the list of all blocks; none, or up to four
    };

    /// A distance, metres. No camera is as near to a block's middle, but a deformation may act as if it were.
    static constexpr double NEARER_THAN_ANY_CAMERA = 1e-3;

    /// x and y are the tile's place in the arrays, counted in tiles from their south-west corner.
    TileBlocks(const BuildPlan& plan, const TileKey& key, const TileNetwork& network,
               const LevelArrays& arrays, int x, int y);

    /// All blocks. The roots, which no other block holds, come first.
    const std::vector<Block>& blocks() const { return _blocks; }
    std::size_t roots() const { return _roots; }
    /// The vertices that blocks share. A smallest block of a finest tile has its own.
    const std::vector<std::unique_ptr<TileVertices>>& vertices() const { return _vertices; }
    /// The error of the tile's finest meshes against the lattice, metres. It must not show as a pixel.
    double error() const { return _error; }
    bool empty() const { return _blocks.empty(); }

private:
    using Post = BlockMesh::Post;
    struct Side;
    struct Draft;

    Block make(const TileBlock& block);
    void makeMeshes(const TileBlock& block, Block& result);
    bool isSmallest(const TileBlock& block) const;
    bool isFinest() const { return _plan.isLeaf(_key); }
    /// The distance from which an error of a metre is as small as the pixel error, metres.
    double perMetre() const { return _plan.options.pixelsPerRadian / _plan.options.pixelError; }
    double rounding() const { return 2.0 * _vertices.front()->rounding(); }
    /// A draft of the block's nearest mesh alone.
    Draft nearest(const TileBlock& block, const Block& result) const;
    void addCoarser(const TileBlock& block, const Block& result, Draft& draft) const;
    /// Makes the edges of a smallest block's nearest mesh short enough for deformations.
    void addShortEdges(const TileBlock& block, Draft& draft) const;
    /// A mesh of a draft with its vertices and walls.
    Mesh made(const TileBlock& block, const Block& result, const Draft& draft, std::size_t mesh);
    /// Makes the vertices of a block, or of the whole tile.
    std::size_t addVertices(const TileBlock& block);
    static double longestEdge(const BlockMesh& mesh);
    /// The edges of a mesh along a side, in the order of Side::place, as ways without gaps.
    static std::vector<std::vector<Post>> border(const Side& side, const BlockMesh& mesh);
    /// The lines that a block's sides lie on, and those of the tile's sides: 0 south, 1 east, 2 north, 3 west.
    std::array<int, 4> linesOf(const TileBlock& block) const;
    std::array<int, 4> borders() const { return {0, _lattice.eastColumn(), _lattice.northRow(), 0}; }
    /// From the border of the ground to the pole. `walls` gets the walls between these triangles and those of other blocks.
    void addCaps(const TileBlock& block, std::size_t vertices, const BlockMesh& mesh,
                 std::vector<std::uint32_t>& triangles, std::vector<std::uint32_t>& walls);
    void addWalls(const TileBlock& block, std::size_t vertices, const BlockMesh& mesh, double depth,
                  std::vector<std::uint32_t>& triangles);
    void addWall(const Side& side, const std::vector<Post>& top, std::vector<std::uint32_t>& triangles);
    void addStrip(const Side& side, const std::vector<Post>& top, std::vector<std::uint32_t>& triangles);
    bool ends(const Post& post) const;
    /// How far walls reach down at the terrain's border, metres: by the tile's own error only, since a finer neighbour's first
    /// posts may be so much lower. A deeper end would show below the border.
    double endDepth() const { return 1.5 * _plan.largestError(_key.level) / 4.0; }
    double toPole() const; ///< from the end of the ground to the farther pole, metres
    double metres() const; ///< from post to post

    const BuildPlan& _plan;
    const TileKey _key;
    const TileNetwork& _network;
    const TileLattice& _lattice;
    const LevelArrays& _arrays;
    const int _x, _y;
    std::vector<std::unique_ptr<TileVertices>> _vertices; ///< the tile's own first
    std::array<double, 4> _skirts{}; ///< what the tile's sides ask for: 0 south, 1 east, 2 north, 3 west
    std::array<std::optional<double>, 4> _poles; ///< the heights of poles beyond these sides, metres
    std::vector<Block> _blocks;
    std::size_t _roots = 0;
    double _error = 0.0;
    struct Line
    {
        std::array<std::uint32_t, 2> ends{};
        std::array<double, 2> depths{}; ///< below the border's first and last post, metres
    };
    /// By the vertices, the side, its row or column, the border's first and last place, and the least depth. Meshes
    /// share these lines.
    std::map<std::tuple<std::size_t, int, int, int, int, double>, Line> _lines;
    /// By the vertices, the side, the post and the depth.
    std::map<std::tuple<std::size_t, int, int, int, double>, std::uint32_t> _strips, _atPoles;
};

} // namespace osgGeoFX
