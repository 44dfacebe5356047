// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/MappingIndex.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

constexpr double roundingShare = 1e-6;            // of the root's size: the error of a place in the shader
constexpr double smallestShare = 1.0 / (1 << 18); // 1 / 8^6; four times the rounding
constexpr double slack = 1.5; // the root's size over the footprints', so that small moves stay inside
constexpr std::int64_t wordsPerMapping = 64;
constexpr std::int64_t wordsAnyway = 1 << 20;
constexpr std::size_t fewToMerge =
    2; // boundaries in a block; fewer than a split needs, so that it does not flicker
constexpr std::uint32_t longestToMerge =
    64; // mappings in a list; comparing longer lists costs more than a merge saves

/// A square around a box. Its size is a power of two, at least `smallest`.
PlaneSquare squareAround(const osg::Vec2d& low, const osg::Vec2d& high, double smallest)
{
    const double extent = std::max(high.x() - low.x(), high.y() - low.y());
    // Far away, numbers are coarse. The square must still be larger than their rounding.
    const double far =
        std::max({std::abs(low.x()), std::abs(low.y()), std::abs(high.x()), std::abs(high.y())});
    const double wanted = std::max({slack * extent, smallest, std::ldexp(far, -24), 1.0});
    const double size = std::exp2(std::ceil(std::log2(wanted)));
    const double step = size / 64;
    const auto snap = [&](double middle)
    {
        return std::floor((middle - size / 2) / step + 0.5) * step;
    };
    return {{snap((low.x() + high.x()) / 2), snap((low.y() + high.y()) / 2)}, size};
}

template<class Items>
PlaneSquare squareAround(const Items& items, double smallest)
{
    osg::Vec2d low = items.begin()->second.shape.low();
    osg::Vec2d high = low;
    for (const auto& [id, item] : items)
    {
        low.set(std::min(low.x(), item.shape.low().x()), std::min(low.y(), item.shape.low().y()));
        high.set(std::max(high.x(), item.shape.high().x()), std::max(high.y(), item.shape.high().y()));
    }
    return squareAround(low, high, smallest);
}

bool drawnBefore(const GridItem* a, const GridItem* b)
{
    return a->drawnBefore(*b);
}

} // namespace

double MappingIndex::margin() const
{
    return roundingShare * _root.size;
}

/// Whether a footprint stays within the root.
bool MappingIndex::holds(const FootprintShape& shape) const
{
    const osg::Vec2d end = _root.origin + osg::Vec2d(_root.size, _root.size);
    return _root.block != 0 && shape.low().x() - margin() >= _root.origin.x() &&
           shape.low().y() - margin() >= _root.origin.y() && shape.high().x() + margin() < end.x() &&
           shape.high().y() + margin() < end.y();
}

/// The limits of a grid of `count` mappings that has taken so many texels.
GridLimits MappingIndex::limits(double rootSize, std::size_t count, std::uint32_t taken) const
{
    const TexelArena& arena = _store.arena();
    const std::int64_t others = std::int64_t(arena.used()) - _store.texels();
    const std::int64_t room = arena.limit() - others; // texels, a quarter of the words
    const std::int64_t words =
        std::min(wordsPerMapping * static_cast<std::int64_t>(count) + wordsAnyway, room);
    return {roundingShare * rootSize, smallestShare * rootSize, words - 4 * std::int64_t(taken)};
}

/// Makes a grid for these mappings beside the old one, and then releases the old one.
bool MappingIndex::rebuild(const Items& items, double formerSize)
{
    PlaneSquare square;
    std::uint32_t block = 0;
    if (!items.empty())
    {
        // The next move would undo a small shrinking.
        square = squareAround(items, 0.0);
        if (square.size * 16 > formerSize) square = squareAround(items, formerSize);
        std::vector<const GridItem*> order;
        order.reserve(items.size());
        std::transform(items.begin(), items.end(), std::back_inserter(order),
                       [](const auto& item) { return &item.second; });
        std::sort(order.begin(), order.end(), drawnBefore);
        GridLimits allowed = limits(square.size, items.size(), 0);
        block = _store.write(planGrid(square, order, allowed, true));
        if (block == 0)
        {
            // Long lists are better than none.
            allowed.words = 0;
            block = _store.write(planGrid(square, order, allowed, true));
        }
        if (block == 0) return false;
    }
    if (_root.block != 0) _store.release(_root.block);
    _root = {square.origin, square.size, block};
    _texelsWhenBuilt = _store.texels();
    return true;
}

bool MappingIndex::empty(const osg::Vec2d& low, const osg::Vec2d& high) const
{
    return _root.block == 0 || empty(_root.block, rootSquare(), low, high);
}

bool MappingIndex::empty(std::uint32_t block, const PlaneSquare& square, const osg::Vec2d& low,
                         const osg::Vec2d& high) const
{
    const auto cellOf = [&](double metres, double origin)
    {
        return static_cast<unsigned int>(
            std::clamp(std::floor((metres - origin) / square.size * 8), 0.0, 7.0));
    };
    const osg::Vec2d end = square.origin + osg::Vec2d(square.size, square.size);
    if (high.x() < square.origin.x() || high.y() < square.origin.y() || low.x() > end.x() ||
        low.y() > end.y())
        return true;
    for (unsigned int row = cellOf(low.y(), square.origin.y()); row <= cellOf(high.y(), square.origin.y());
         ++row)
    {
        for (unsigned int column = cellOf(low.x(), square.origin.x());
             column <= cellOf(high.x(), square.origin.x()); ++column)
        {
            const unsigned int cell = 8 * row + column;
            const std::uint32_t word = _store.word(block, cell);
            if (word == 0) continue;
            if (!GridStore::isChild(word) || !empty(GridStore::offsetOf(word), square.cell(cell), low, high))
                return false;
        }
    }
    return true;
}

bool MappingIndex::insert(const Entry& entry)
{
    if (contains(entry.id) || !entry.footprint.valid()) return false;
    const GridItem& item =
        _items.emplace(entry.id, GridItem{entry.id, entry.rank, FootprintShape(entry.footprint)})
            .first->second;
    const bool held = holds(item.shape);
    if (held && place(item, _root.block, rootSquare()))
    {
        splitGrown();
        return true;
    }
    _grown.clear();
    if (rebuild(_items, _root.size)) return true;
    if (held) remove(item, nullptr, _root.block, rootSquare());
    _items.erase(entry.id);
    return false;
}

bool MappingIndex::erase(std::uint32_t id)
{
    const auto found = _items.find(id);
    if (found == _items.end()) return false;
    if (_items.size() == 1)
    {
        clear();
        return true;
    }
    remove(found->second, nullptr, _root.block, rootSquare());
    _items.erase(found);
    return true;
}

bool MappingIndex::update(std::uint32_t id, std::uint64_t rank, const PlaneFootprint& footprint)
{
    const auto found = _items.find(id);
    if (found == _items.end() || !footprint.valid()) return false;
    GridItem& item = found->second;
    const GridItem before = item;
    item = {id, rank, FootprintShape(footprint)};
    const bool held = holds(item.shape);
    if (held && place(item, _root.block, rootSquare()))
    {
        splitGrown();
        remove(before, &item.shape, _root.block, rootSquare());
        return true;
    }
    _grown.clear();
    if (rebuild(_items, _root.size)) return true;
    const GridItem refused = item;
    item = before;
    if (held)
    {
        remove(refused, &item.shape, _root.block, rootSquare());
        // These lists still have it, so they need no room.
        place(item, _root.block, rootSquare());
        _grown.clear();
    }
    return false;
}

bool MappingIndex::assign(const std::vector<Entry>& entries)
{
    Items items;
    items.reserve(entries.size());
    for (const Entry& entry : entries)
    {
        if (!entry.footprint.valid()) continue;
        items.emplace(entry.id, GridItem{entry.id, entry.rank, FootprintShape(entry.footprint)});
    }
    if (!rebuild(items, 0.0)) return false;
    _items.swap(items);
    return true;
}

void MappingIndex::clear()
{
    if (_root.block != 0) _store.release(_root.block);
    _root = {};
    _items.clear();
}

/// Puts a mapping into the lists of all cells under it, at the place of its rank, and notes the lists that got
/// longer. False if one list had no room. Some lists may have it then.
bool MappingIndex::place(const GridItem& item, std::uint32_t block, const PlaneSquare& square)
{
    bool fits = true;
    forCellsUnder(item.shape, square, margin(),
                  [&](unsigned int cell, const PlaneSquare& under)
                  {
                      if (!fits) return;
                      const std::uint32_t word = _store.word(block, cell);
                      fits = GridStore::isChild(word) ? place(item, GridStore::offsetOf(word), under)
                                                      : placeInList(item, block, cell, under);
                  });
    return fits;
}

bool MappingIndex::placeInList(const GridItem& item, std::uint32_t block, unsigned int cell,
                               const PlaneSquare& square)
{
    std::uint32_t list = _store.word(block, cell);
    const std::uint32_t before = _store.count(list);
    _store.read(list, _ids);
    _ids.erase(std::remove(_ids.begin(), _ids.end(), item.id), _ids.end());
    const auto position = std::lower_bound(_ids.begin(), _ids.end(), item,
                                           [&](std::uint32_t id, const GridItem& other)
                                           { return _items.at(id).drawnBefore(other); });
    _ids.insert(position, item.id);
    if (!_store.replace(list, _ids)) return false;
    _store.setWord(block, cell, list);
    if (_ids.size() > before) _grown.push_back({block, cell, square});
    return true;
}

/// Splits the grown lists where it pays. Makes the whole grid anew if it has become far too large; only mappings over
/// very many cells can cause this.
void MappingIndex::splitGrown()
{
    const GridLimits now = limits(_root.size, _items.size(), _store.texels());
    std::int64_t words = now.words;
    std::vector<const GridItem*> items;
    for (const Grown& grown : _grown)
    {
        std::uint32_t list = _store.word(grown.block, grown.cell);
        const std::uint32_t count = _store.count(list);
        // A long list that cannot be split is not tried again for each further mapping.
        if (count < partialsWorthSplitting || (count > 16 && count % 16 != 0)) continue;
        _store.read(list, _ids);
        items.clear();
        std::transform(_ids.begin(), _ids.end(), std::back_inserter(items),
                       [&](std::uint32_t id) { return &_items.at(id); });
        const std::int64_t taken = _store.texels();
        const std::uint32_t child =
            _store.write(planGrid(grown.square, items, {now.margin, now.smallestCell, words}, false));
        if (child == 0) continue;
        _ids.clear();
        _store.replace(list, _ids);
        _store.setWord(grown.block, grown.cell, child | GridStore::childBit);
        words -= 4 * (_store.texels() - taken);
    }
    _grown.clear();
    const std::int64_t most = 2 * limits(_root.size, _items.size(), 0).words;
    if (4 * std::int64_t(_store.texels()) > most && _store.texels() / 2 > _texelsWhenBuilt)
    {
        if (!rebuild(_items, _root.size)) _texelsWhenBuilt = _store.texels();
    }
}

/// Takes a mapping out of the lists of all cells under it, except cells under `except` too. Whether any list had it.
bool MappingIndex::remove(const GridItem& item, const FootprintShape* except, std::uint32_t block,
                          const PlaneSquare& square)
{
    bool removed = false;
    forCellsUnder(item.shape, square, margin(),
                  [&](unsigned int cell, const PlaneSquare& under)
                  {
                      const FootprintShape* stays =
                          except && except->overlaps(under, margin()) ? except : nullptr;
                      const std::uint32_t word = _store.word(block, cell);
                      if (GridStore::isChild(word))
                      {
                          if (!remove(item, stays, GridStore::offsetOf(word), under)) return;
                          mergeChild(block, cell, under);
                          removed = true;
                      }
                      else if (word != 0 && !stays)
                      {
                          removed = removeFromList(item, block, cell) || removed;
                      }
                  });
    return removed;
}

bool MappingIndex::removeFromList(const GridItem& item, std::uint32_t block, unsigned int cell)
{
    std::uint32_t list = _store.word(block, cell);
    _store.read(list, _ids);
    const auto found = std::find(_ids.begin(), _ids.end(), item.id);
    if (found == _ids.end()) return false;
    _ids.erase(found);
    _store.replace(list, _ids);
    _store.setWord(block, cell, list);
    return true;
}

/// Turns a block back into a list if a split no longer pays.
void MappingIndex::mergeChild(std::uint32_t block, unsigned int cell, const PlaneSquare& square)
{
    const std::uint32_t child = GridStore::offsetOf(_store.word(block, cell));
    std::vector<const GridItem*> items;
    if (!mayMerge(child, square, items)) return;
    std::sort(items.begin(), items.end(), drawnBefore);
    _ids.clear();
    std::transform(items.begin(), items.end(), std::back_inserter(_ids),
                   [](const GridItem* item) { return item->id; });
    std::uint32_t list = 0;
    if (!_store.replace(list, _ids)) return;
    _store.release(child);
    _store.setWord(block, cell, list);
}

/// Whether few boundaries run through a block. `items` gets all of its mappings.
bool MappingIndex::mayMerge(std::uint32_t block, const PlaneSquare& square,
                            std::vector<const GridItem*>& items) const
{
    std::size_t boundaries = 0;
    std::vector<std::uint32_t> ids;
    for (unsigned int cell = 0; cell < 64; ++cell)
    {
        const std::uint32_t word = _store.word(block, cell);
        if (GridStore::isChild(word) || _store.count(word) > longestToMerge) return false;
        _store.read(word, ids);
        for (const std::uint32_t id : ids)
        {
            const GridItem* item = &_items.at(id);
            if (std::find(items.begin(), items.end(), item) != items.end()) continue;
            if (!item->shape.covers(square, margin()) && ++boundaries > fewToMerge) return false;
            items.push_back(item);
        }
    }
    return true;
}

std::vector<std::uint32_t> MappingIndex::at(const osg::Vec2d& place) const
{
    const auto inverseSize = static_cast<float>(1.0 / _root.size);
    float x = static_cast<float>(place.x() - _root.origin.x()) * inverseSize;
    float y = static_cast<float>(place.y() - _root.origin.y()) * inverseSize;
    std::vector<std::uint32_t> ids;
    if (_root.block == 0 || !(x >= 0.0f && x < 1.0f && y >= 0.0f && y < 1.0f)) return ids;
    std::uint32_t word = _root.block | GridStore::childBit;
    while (GridStore::isChild(word))
    {
        x *= 8.0f;
        y *= 8.0f;
        const float column = std::clamp(std::floor(x), 0.0f, 7.0f);
        const float row = std::clamp(std::floor(y), 0.0f, 7.0f);
        x -= column;
        y -= row;
        const auto cell = static_cast<unsigned int>(8 * static_cast<int>(row) + static_cast<int>(column));
        word = _store.word(GridStore::offsetOf(word), cell);
    }
    _store.read(word, ids);
    return ids;
}

} // namespace osgGeoFX
