// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/LayerAtlas.h>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

bool isPowerOfTwo(int number)
{
    return number > 0 && (number & (number - 1)) == 0;
}

/// The number of a column and row on the Z curve, where the bits of both alternate.
std::uint32_t interleave(std::uint32_t column, std::uint32_t row)
{
    std::uint32_t number = 0;
    for (std::uint32_t bit = 0; bit < 16; ++bit)
        number |= ((column >> bit) & 1u) << (2 * bit) | ((row >> bit) & 1u) << (2 * bit + 1);
    return number;
}

/// The even bits of a number on the Z curve: its column. Shifted by one, its row.
int evenBits(std::uint32_t number)
{
    std::uint32_t bits = 0;
    for (std::uint32_t bit = 0; bit < 16; ++bit)
        bits |= ((number >> (2 * bit)) & 1u) << bit;
    return static_cast<int>(bits);
}

} // namespace

LayerAtlas::LayerAtlas(int pageSide, int maxPages) : _maxPages(std::max(0, maxPages))
{
    while (_pageSide < 32768 && _pageSide * 2 <= pageSide)
    {
        _pageSide *= 2;
        ++_levels;
    }
}

std::size_t LayerAtlas::levelOf(int side) const
{
    std::size_t level = 0;
    while ((_pageSide >> level) > side)
        ++level;
    return level;
}

std::optional<LayerAtlas::Slot> LayerAtlas::add(int side)
{
    if (!isPowerOfTwo(side) || side > _pageSide) return std::nullopt;
    const std::size_t level = levelOf(side);

    // The smallest free square that is large enough. Among equal ones, that of the fullest page.
    Page* best = nullptr;
    std::size_t bestLevel = 0;
    for (Page& page : _pages)
    {
        std::size_t from = level + 1;
        while (from > 0 && page.free[from - 1].empty())
            --from;
        if (from == 0) continue;
        const bool better =
            !best || from - 1 > bestLevel || (from - 1 == bestLevel && page.used > best->used);
        if (!better) continue;
        best = &page;
        bestLevel = from - 1;
    }
    if (!best)
    {
        if (pages() >= _maxPages) return std::nullopt;
        _pages.push_back({std::vector<Squares>(_levels), std::vector<Squares>(_levels), 0});
        best = &_pages.back();
        best->free[0].insert(0);
        bestLevel = 0;
    }

    std::uint32_t square = *best->free[bestLevel].begin();
    best->free[bestLevel].erase(best->free[bestLevel].begin());
    for (; bestLevel < level; ++bestLevel)
    {
        square *= 4;
        for (std::uint32_t quarter = 1; quarter < 4; ++quarter)
            best->free[bestLevel + 1].insert(square + quarter);
    }
    best->taken[level].insert(square);
    best->used += static_cast<std::int64_t>(side) * side;
    return Slot{static_cast<int>(best - _pages.data()), evenBits(square) * side, evenBits(square >> 1) * side,
                side};
}

bool LayerAtlas::release(const Slot& slot)
{
    if (slot.page < 0 || slot.page >= pages() || !isPowerOfTwo(slot.side) || slot.side > _pageSide ||
        slot.x < 0 || slot.y < 0 || slot.x >= _pageSide || slot.y >= _pageSide || slot.x % slot.side != 0 ||
        slot.y % slot.side != 0)
        return false;
    Page& page = _pages[slot.page];
    std::size_t level = levelOf(slot.side);
    std::uint32_t square = interleave(static_cast<std::uint32_t>(slot.x / slot.side),
                                      static_cast<std::uint32_t>(slot.y / slot.side));
    if (page.taken[level].erase(square) == 0) return false;
    page.used -= static_cast<std::int64_t>(slot.side) * slot.side;

    // Four free quarters make one free square again.
    page.free[level].insert(square);
    while (level > 0)
    {
        Squares& free = page.free[level];
        const auto first = free.lower_bound(square / 4 * 4);
        const auto end = free.upper_bound(square / 4 * 4 + 3);
        if (std::distance(first, end) < 4) break;
        free.erase(first, end);
        square /= 4;
        --level;
        page.free[level].insert(square);
    }
    return true;
}

std::int64_t LayerAtlas::used() const
{
    std::int64_t sum = 0;
    for (const Page& page : _pages)
        sum += page.used;
    return sum;
}

} // namespace osgGeoFX
