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

    Sides are powers of two, and a slot lies at a multiple of its side, so that its mip levels lie alone in the page's
    down to one texel. A new slot goes where the smallest free square takes it, in the fullest page of those; a page
    is begun only where no other has room. Freed squares merge. Not thread-safe. */
class LayerAtlas
{
public:
    /// Texels from x to x + side − 1 and from y to y + side − 1 of a page.
    struct Slot
    {
        int page = 0;
        int x = 0;
        int y = 0;
        int side = 0;
    };

    /// A page's side is a power of two from 1 to 32768; any other is taken as the next below, or as the limit.
    LayerAtlas(int pageSide, int maxPages);

    /// Room for a slot; nothing where the side is no power of two or larger than a page, or where all pages are full.
    std::optional<Slot> add(int side);

    /// Gives a slot back. False, and nothing changes, where it is not one that add() gave and that is still in use.
    bool release(const Slot& slot);

    int pageSide() const { return _pageSide; }
    int maxPages() const { return _maxPages; }
    /// Pages that were begun; they stay when they become empty.
    int pages() const { return static_cast<int>(_pages.size()); }
    /// Texels in use, of the page or of all.
    std::int64_t used(int page) const { return _pages[page].used; }
    std::int64_t used() const;

private:
    /// Squares of one size are numbered along the Z curve: a square's quarters are 4n … 4n + 3.
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
