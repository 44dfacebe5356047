// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace osgGeoFX
{

/** Finds room for square slots in square pages, the layers of one texture array. It holds no texels.

    Sides are powers of two. A slot lies at a multiple of its side, so that its mip levels share no texel with others,
    down to one texel. A new slot takes the smallest free square that fits, in the fullest page with one. A new page
    is begun only if no other has room. Freed squares merge. Not thread-safe. */
class LayerAtlas
{
public:
    /// The texels from x to x + side − 1 and from y to y + side − 1 of a page.
    struct Slot
    {
        int page = 0;
        int x = 0;
        int y = 0;
        int side = 0;
    };

    /// A page's side is a power of two from 1 to 32768. Any other number is rounded down or limited to that.
    LayerAtlas(int pageSide, int maxPages);

    /// Room for a slot. Nothing if the side is no power of two, if it is larger than a page, or if all pages are
    /// full.
    std::optional<Slot> add(int side);

    /// Gives a slot back. False, without a change, if add() did not give it or if it is no longer in use.
    bool release(const Slot& slot);

    int pageSide() const { return _pageSide; }
    int maxPages() const { return _maxPages; }
    /// The pages begun so far. Empty pages stay.
    int pages() const { return static_cast<int>(_pages.size()); }
    /// The texels in use, of one page or of all.
    std::int64_t used(int page) const { return _pages[page].used; }
    std::int64_t used() const;

private:
    /// Squares of one size are numbered along the Z curve. The quarters of square n are 4n … 4n + 3.
    using Squares = std::set<std::uint32_t>;

    struct Page
    {
        std::vector<Squares> free; ///< by level; level 0 is the whole page
        std::vector<Squares> taken;
        std::int64_t used = 0;
    };

    std::size_t levelOf(int side) const;

    int _pageSide = 1;
    int _maxPages = 0;
    std::size_t _levels = 1;
    std::vector<Page> _pages;
};

} // namespace osgGeoFX
