// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/Footprint.h>
#include <osgGeoFX/mapping/detail/GridStatistics.h>
#include <osgGeoFX/mapping/detail/GridStore.h>

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/** Tells which mappings lie over a place of the plane: a hierarchical grid in an arena, for a fragment shader to walk.

    A block has 8 x 8 cells of one word each, in 16 texels: the word of cell (i % 8, i / 8) is component i % 4 of texel
    i / 4. A cell without a mapping has the word 0. A word with the highest bit set is the first texel of the block that
    the cell is split into. Any other word is the texel of a list: the number of mappings, and then their ids in drawing
    order, the last one on top. A list of up to three mappings costs one fetch.

    This is the walk. `place` is in metres from the root's origin, `inverseSize` is the root's 1 / size, and `block` is
    its block. The result is the texel of the list, or 0:

        uint geofx_mappingList(vec2 place, float inverseSize, uint block)
        {
            vec2 p = place * inverseSize;
            // Written so that NaN finds nothing.
            bool inside = all(greaterThanEqual(p, vec2(0.0))) && all(lessThan(p, vec2(1.0)));
            if (block == 0u || !inside) return 0u;
            uint word = block | 0x80000000u;
            while ((word & 0x80000000u) != 0u) // at most 6 times
            {
                p *= 8.0;
                vec2 cell = clamp(floor(p), vec2(0.0), vec2(7.0));
                p -= cell;
                int i = 8 * int(cell.y) + int(cell.x);
                word = texelFetch(texels, int(word & 0x7fffffffu) + i / 4)[i % 4];
            }
            return word;
        }

    The root's size is a power of two, so everything but `place` is exact. Footprints are wider by a millionth of the
    root's size, for the rounding of `place`. So a list lacks no mapping. It may have mappings that end just before a
    place, and mappings whose footprint passes elsewhere through the cell.

    Cells follow the density; see planGrid(). No cell is smaller than 1 / 8^6 of the root. The grid takes about 64 words
    for each mapping and a million more, but at most a quarter of the words that its arena may have. Without words for
    splitting, lists are longer. An edit touches the lists of the cells that a footprint leaves or enters.

    Texels that are no longer needed are given back. The root shrinks only when it is made anew for another reason. For
    one thread at a time. */
class MappingIndex
{
public:
    struct Entry
    {
        std::uint32_t id = 0;
        std::uint64_t rank = 0; ///< the lowest is drawn first; among equal ones, the lowest id
        PlaneFootprint footprint;
    };

    /// The square around all footprints; metres.
    struct Root
    {
        osg::Vec2d origin;
        double size = 0.0;       ///< a power of two; 0 without mappings
        std::uint32_t block = 0; ///< the texel of its block; 0 without mappings
    };

    /// The arena must outlive the index.
    explicit MappingIndex(TexelArena& arena) : _store(arena) {}
    ~MappingIndex() { clear(); }
    MappingIndex(const MappingIndex&) = delete;
    MappingIndex& operator=(const MappingIndex&) = delete;

    /// Adds a mapping. False, without a change, if the id is there already, if the footprint is not valid(), or if
    /// the arena is full.
    bool insert(const Entry& entry);
    /// Removes a mapping. False if there is no such id.
    bool erase(std::uint32_t id);
    /// Moves or reorders a mapping. False if there is no such id, if the footprint is not valid(), or if the arena is
    /// full. A walk then finds what it found before.
    bool update(std::uint32_t id, std::uint64_t rank, const PlaneFootprint& footprint);
    /// Replaces all mappings, without those that insert() would refuse. False, without a change, if the arena has no
    /// room for the new grid beside the old one.
    bool assign(const std::vector<Entry>& entries);
    void clear();

    const Root& root() const { return _root; }
    std::size_t size() const { return _items.size(); }
    bool contains(std::uint32_t id) const { return _items.count(id) != 0; }

    /// What a shader finds for a place: all mappings over it and perhaps some nearby, in drawing order.
    std::vector<std::uint32_t> at(const osg::Vec2d& place) const;

    /// Whether a shader finds nothing anywhere in a box, metres. It may be false although no mapping lies there.
    bool empty(const osg::Vec2d& low, const osg::Vec2d& high) const;

    /// The number of mappings in the longest list so far.
    std::size_t longestList() const { return _store.longestList(); }

    GridStatistics statistics() const { return statisticsOf(_store, _root.block); }

private:
    using Items = std::unordered_map<std::uint32_t, GridItem>;

    /// A cell whose list has become longer.
    struct Grown
    {
        std::uint32_t block;
        unsigned int cell;
        PlaneSquare square;
    };

    PlaneSquare rootSquare() const { return {_root.origin, _root.size}; }
    bool empty(std::uint32_t block, const PlaneSquare& square, const osg::Vec2d& low,
               const osg::Vec2d& high) const;
    double margin() const;
    bool holds(const FootprintShape& shape) const;
    GridLimits limits(double rootSize, std::size_t count, std::uint32_t taken) const;
    bool rebuild(const Items& items, double formerSize);

    bool place(const GridItem& item, std::uint32_t block, const PlaneSquare& square);
    bool placeInList(const GridItem& item, std::uint32_t block, unsigned int cell, const PlaneSquare& square);
    void splitGrown();
    bool remove(const GridItem& item, const FootprintShape* except, std::uint32_t block,
                const PlaneSquare& square);
    bool removeFromList(const GridItem& item, std::uint32_t block, unsigned int cell);
    void mergeChild(std::uint32_t block, unsigned int cell, const PlaneSquare& square);
    bool mayMerge(std::uint32_t block, const PlaneSquare& square, std::vector<const GridItem*>& items) const;

    GridStore _store;
    Root _root;
    Items _items;
    std::uint32_t _texelsWhenBuilt = 0;
    std::vector<Grown> _grown;
    std::vector<std::uint32_t> _ids; ///< of the current list
};

} // namespace osgGeoFX
