// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/GridPlan.h>
#include <osgGeoFX/mapping/detail/TexelArena.h>

#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/** The blocks and lists of a MappingIndex in an arena. A method that needs room fails without a change if the arena
    has none. */
class GridStore
{
public:
    static constexpr std::uint32_t blockTexels = 16;
    static constexpr std::uint32_t childBit = 0x80000000u;

    explicit GridStore(TexelArena& arena) : _arena(arena) {}

    static bool isChild(std::uint32_t word) { return (word & childBit) != 0; }
    static std::uint32_t offsetOf(std::uint32_t word) { return word & ~childBit; }

    std::uint32_t word(std::uint32_t block, unsigned int cell) const { return wordAt(block, cell); }
    void setWord(std::uint32_t block, unsigned int cell, std::uint32_t word);

    std::uint32_t count(std::uint32_t list) const { return list == 0 ? 0 : wordAt(list, 0); }
    void read(std::uint32_t list, std::vector<std::uint32_t>& ids) const;
    /// Replaces a list. It writes only texels that change, and stays in place unless it gets longer.
    bool replace(std::uint32_t& list, const std::vector<std::uint32_t>& ids);

    /// Stores planned blocks with their lists. The result is the offset of the first block, or 0 without room.
    std::uint32_t write(const std::vector<PlannedBlock>& blocks);
    /// Gives back a block and everything below it.
    void release(std::uint32_t block);

    /// The texels of all blocks and lists.
    std::uint32_t texels() const { return _texels; }
    /// The length of the longest list so far.
    std::size_t longestList() const { return _longestList; }
    const TexelArena& arena() const { return _arena; }

private:
    std::uint32_t wordAt(std::uint32_t offset, std::size_t index) const
    {
        return _arena.texels()[offset + index / 4][index % 4];
    }
    std::uint32_t writeBlock(const std::vector<PlannedBlock>& blocks, const PlannedBlock& block);
    std::uint32_t writeCell(const std::vector<PlannedBlock>& blocks, const PlannedBlock& block,
                            unsigned int cell);
    std::uint32_t allocate(std::uint32_t count);
    void giveBack(std::uint32_t offset, std::uint32_t count);

    TexelArena& _arena;
    std::uint32_t _texels = 0;
    std::size_t _longestList = 0;
};

} // namespace osgGeoFX
