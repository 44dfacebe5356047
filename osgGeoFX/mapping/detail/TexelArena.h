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

/** The CPU's copy of a texture buffer of RGBA32UI texels (a usamplerBuffer), from which records, grid blocks and
    lists take whole texels.

    Offsets are texel indices; 0 is never handed out and stands for nothing. Free space is kept in blocks of two to
    the power of k, aligned to their size, that are halved when taken and joined again when given back; what a
    piece does not need of its block stays free. So random use does not fragment it without bound. The lowest place
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

    /// What is to be uploaded.
    struct Changes
    {
        bool all = false;          ///< then there is one range over all, and the size may be another one
        std::vector<Range> ranges; ///< from first to last, neither overlapping nor touching
    };

    TexelArena();

    /// Texels that the array may have, as in GL_MAX_TEXTURE_BUFFER_SIZE; 2^31 - 1 by default and at most. What it
    /// has already stays.
    void setLimit(std::uint32_t texels);
    std::uint32_t limit() const { return _limit; }

    /// The offset of `count` texels in a row, their contents undefined; 0 where the limit leaves no room for them,
    /// or none are asked for. Then nothing changes.
    std::uint32_t allocate(std::uint32_t count);
    /// Gives back `count` texels from `offset` on: all that were allocated there or a part of them.
    void release(std::uint32_t offset, std::uint32_t count);

    /// `count` texels for writing, which takeChanges() will tell of. Valid until the next allocate().
    Texel* edit(std::uint32_t offset, std::uint32_t count);

    const std::vector<Texel>& texels() const { return _texels; }
    std::uint32_t size() const { return static_cast<std::uint32_t>(_texels.size()); }
    /// Texels that are allocated.
    std::uint32_t used() const { return _used; }

    /// What was edited since the last call. Gaps of up to four texels are joined; where more than a quarter of the
    /// array changed, or it has grown, it is all.
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
