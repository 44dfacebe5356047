// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/TexelArena.h>

#include <algorithm>
#include <cassert>

namespace osgGeoFX
{

namespace
{

constexpr std::uint32_t highestLimit = 0x7fffffffu; // offsets leave one bit of a word to their users
constexpr std::uint32_t joinedGap = 4;              // an upload costs more than so many texels
constexpr std::size_t fewestToJoin = 4096;

/// The order of the smallest block with room for `count` texels.
unsigned int orderFor(std::uint32_t count)
{
    unsigned int order = 0;
    while ((1u << order) < count)
    {
        ++order;
    }
    return order;
}

/// The order of the largest block that may begin at `first` and has at most `count` texels.
unsigned int largestOrder(std::uint32_t first, std::uint32_t count)
{
    unsigned int order = 0;
    while ((first & (1u << order)) == 0 && (2u << order) <= count)
    {
        ++order;
    }
    return order;
}

} // namespace

TexelArena::TexelArena() : _texels(1), _joinAt(fewestToJoin), _limit(highestLimit) {}

void TexelArena::setLimit(std::uint32_t texels)
{
    _limit = std::min(texels, highestLimit);
}

std::uint32_t TexelArena::allocate(std::uint32_t count)
{
    if (count == 0 || count > (1u << (orders - 1))) return 0;
    const unsigned int order = orderFor(count);
    std::uint32_t offset = takeFree(order);
    if (offset == 0 && grow(order)) offset = takeFree(order);
    if (offset == 0) return 0;
    const std::uint32_t block = 1u << order;
    _used += block;
    if (block > count) release(offset + count, block - count);
    return offset;
}

void TexelArena::release(std::uint32_t offset, std::uint32_t count)
{
    assert(offset > 0 && offset + count <= size() && count <= _used);
    _used -= count;
    while (count > 0)
    {
        const unsigned int order = largestOrder(offset, count);
        addFree(offset, order);
        offset += 1u << order;
        count -= 1u << order;
    }
}

/// Takes the lowest of the smallest blocks that are large enough. Its unused upper halves stay free.
std::uint32_t TexelArena::takeFree(unsigned int order)
{
    unsigned int found = order;
    while (found < orders && _free[found].empty())
    {
        ++found;
    }
    if (found == orders) return 0;
    const std::uint32_t first = *_free[found].begin();
    _free[found].erase(_free[found].begin());
    while (found > order)
    {
        --found;
        _free[found].insert(first + (1u << found));
    }
    return first;
}

void TexelArena::addFree(std::uint32_t first, unsigned int order)
{
    while (order + 1 < orders)
    {
        const auto buddy = _free[order].find(first ^ (1u << order));
        if (buddy == _free[order].end()) break;
        _free[order].erase(buddy);
        first &= ~(1u << order);
        ++order;
    }
    const bool isNew = _free[order].insert(first).second;
    assert(isNew);
    static_cast<void>(isNew);
}

std::uint32_t TexelArena::startOfFreeTail() const
{
    std::uint32_t start = size();
    for (unsigned int order = 0; order < orders; ++order)
    {
        // Towards the end of the array, free blocks get smaller. From the end on, they are joined as long as they
        // touch.
        const std::set<std::uint32_t>& blocks = _free[order];
        if (!blocks.empty() && *blocks.rbegin() + (1u << order) == start) start = *blocks.rbegin();
    }
    return start;
}

/// Makes room for one more block, and half as much again, since a longer array means a new buffer.
bool TexelArena::grow(unsigned int order)
{
    const std::uint64_t block = 1ull << order;
    const std::uint64_t begin = (startOfFreeTail() + block - 1) / block * block;
    const std::uint64_t needed = begin + block;
    if (needed > _limit) return false;
    const std::uint64_t generous = std::uint64_t(size()) + size() / 2;
    const std::uint32_t before = size();
    _texels.resize(static_cast<std::size_t>(std::max(needed, std::min<std::uint64_t>(generous, _limit))));
    _grown = true;
    _used += size() - before;
    release(before, size() - before);
    return true;
}

TexelArena::Texel* TexelArena::edit(std::uint32_t offset, std::uint32_t count)
{
    assert(offset > 0 && offset + count <= size());
    if (_grown) return _texels.data() + offset; // everything is uploaded anyway
    const std::uint32_t end = offset + count;
    if (!_changes.empty() && offset >= _changes.back().first &&
        offset <= _changes.back().first + _changes.back().count)
    {
        Range& last = _changes.back();
        last.count = std::max(last.first + last.count, end) - last.first;
    }
    else if (count > 0)
    {
        _changes.push_back({offset, count});
        if (_changes.size() >= _joinAt) joinChanges();
    }
    return _texels.data() + offset;
}

void TexelArena::joinChanges()
{
    std::sort(_changes.begin(), _changes.end(),
              [](const Range& a, const Range& b) { return a.first < b.first; });
    std::size_t joined = 0;
    for (const Range& range : _changes)
    {
        Range* last = joined > 0 ? &_changes[joined - 1] : nullptr;
        if (last && range.first <= last->first + last->count + joinedGap)
        {
            last->count = std::max(last->first + last->count, range.first + range.count) - last->first;
        }
        else
        {
            _changes[joined] = range;
            ++joined;
        }
    }
    _changes.resize(joined);
    _joinAt = std::max(fewestToJoin, 2 * joined);
}

TexelArena::Changes TexelArena::takeChanges()
{
    joinChanges();
    std::uint64_t changed = 0;
    for (const Range& range : _changes)
    {
        changed += range.count;
    }
    Changes result;
    result.all = _grown || 4 * changed > size();
    if (result.all)
    {
        result.ranges.push_back({0, size()});
        _changes.clear();
    }
    else
    {
        result.ranges.swap(_changes);
    }
    _joinAt = fewestToJoin;
    _grown = false;
    return result;
}

} // namespace osgGeoFX
