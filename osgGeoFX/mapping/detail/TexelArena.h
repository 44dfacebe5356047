// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace osgGeoFX
{

/** The CPU's copy of a texture buffer of RGBA32UI texels (a usamplerBuffer). Records, grid blocks and lists take
    whole texels of it.

    Offsets are indices of texels. Offset 0 stands for nothing and is never handed out. Free space consists of blocks
    of 2^k texels, aligned to their size. A block is halved when a part is taken, and joined again when it is given
    back. The rest of a block stays free. So random use does not fragment the array without bound. The lowest place
    goes first.

    The array grows and never shrinks. For one thread at a time. */
class TexelArena
{
public:
    using Texel = std::array<std::uint32_t, 4>;

    struct Range
    {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    /// What must be uploaded.
    struct Changes
    {
        bool all = false;          ///< one range over everything; the size may have changed, too
        std::vector<Range> ranges; ///< in ascending order, neither overlapping nor touching
    };

    TexelArena();

    /// The number of texels that the array may have (GL_MAX_TEXTURE_BUFFER_SIZE); 2^31 - 1 by default and at most. It
    /// never shrinks.
    void setLimit(std::uint32_t texels);
    std::uint32_t limit() const { return _limit; }

    /// The offset of `count` texels in a row, with undefined contents. 0, without a change, if the limit leaves no
    /// room, or if `count` is 0.
    std::uint32_t allocate(std::uint32_t count);
    /// Gives back `count` texels from `offset` on: a whole allocation or a part of one.
    void release(std::uint32_t offset, std::uint32_t count);

    /// `count` texels for writing. takeChanges() tells of them. Valid until the next allocate().
    Texel* edit(std::uint32_t offset, std::uint32_t count);

    const std::vector<Texel>& texels() const { return _texels; }
    std::uint32_t size() const { return static_cast<std::uint32_t>(_texels.size()); }
    /// The number of allocated texels.
    std::uint32_t used() const { return _used; }

    /// What was edited since the last call. Gaps of up to four texels are joined. It is all texels if more than a
    /// quarter of the array changed, or if the array has grown.
    Changes takeChanges();

private:
    static constexpr unsigned int orders = 31;

    std::uint32_t takeFree(unsigned int order);
    void addFree(std::uint32_t first, unsigned int order);
    std::uint32_t startOfFreeTail() const;
    bool grow(unsigned int order);
    void joinChanges();

    std::vector<Texel> _texels;
    std::array<std::set<std::uint32_t>, orders> _free; ///< free blocks of 2^k texels
    std::vector<Range> _changes;
    std::size_t _joinAt; ///< so that many edits between two calls of takeChanges() stay few ranges
    std::uint32_t _limit;
    std::uint32_t _used = 0;
    bool _grown = true;
};

} // namespace osgGeoFX
