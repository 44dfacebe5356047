// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/MappingRecords.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// With so many changes at once, the whole grid is made anew.
constexpr std::size_t bulk = 2000;
/// Numbers between one mapping and the next, for the parts of the first.
constexpr std::uint64_t mostParts = 1u << 14u;

bool needsLayer(const ProjectiveMapping& mapping)
{
    const ColorTransfer::Source source = mapping.getTransfer()->getSource();
    return source == ColorTransfer::LAYER || source == ColorTransfer::TABLE;
}

/// Whether `a` stays rather than `b` if there is room for one.
bool outranks(const ProjectiveMapping& a, const ProjectiveMapping& b)
{
    if (a.getImportance() != b.getImportance()) return a.getImportance() > b.getImportance();
    const auto area = [](const ProjectiveMapping& mapping)
    {
        return mapping.getU().length() * mapping.getV().length();
    };
    return area(a) > area(b);
}

} // namespace

MappingRecords::MappingRecords(MappingChanges& changes, const LayerResidency& layers, const TableRows& tables)
    : _changes(changes), _layers(layers), _tables(tables), _arena(std::make_shared<TexelArena>()),
      _index(std::make_unique<MappingIndex>(*_arena))
{
}

void MappingRecords::add(ProjectiveMapping& mapping, std::uint64_t rank)
{
    Item& item = _items[&mapping];
    item.mapping = &mapping;
    item.sequence = rank > 0 ? rank : _sequence += mostParts;
    _changes.mappings.insert(&mapping);
}

bool MappingRecords::addPart(ProjectiveMapping& part, ProjectiveMapping& whole)
{
    const auto found = _items.find(&whole);
    if (found == _items.end() || found->second.parts.size() + 1 >= mostParts) return false;
    Item& owner = found->second;
    std::uint64_t number = 1;
    for (const std::uint64_t taken : owner.parts)
    {
        if (taken != number) break;
        ++number;
    }
    if (owner.parts.empty()) _changes.mappings.insert(&whole);
    owner.parts.insert(number);
    const std::uint64_t sequence = owner.sequence + number;
    // The reference above may be invalid from here on.
    Item& item = _items[&part];
    item.mapping = &part;
    item.sequence = sequence;
    item.whole = &whole;
    _changes.mappings.insert(&part);
    return true;
}

void MappingRecords::remove(ProjectiveMapping& mapping)
{
    const auto found = _items.find(&mapping);
    if (found == _items.end()) return;
    takeOff(found->second);
    if (found->second.leftOut) --_leftOut;
    const auto owner = _items.find(found->second.whole);
    if (found->second.whole && owner != _items.end())
    {
        owner->second.parts.erase(found->second.sequence - owner->second.sequence);
        if (owner->second.parts.empty()) _changes.mappings.insert(found->second.whole);
    }
    _changes.mappings.erase(&mapping);
    _items.erase(found);
}

void MappingRecords::clear()
{
    // All at once: taking one after the other out of a long list takes time with the square of its length.
    _index->clear();
    for (const auto& [mapping, item] : _items)
    {
        if (item.record != 0) _arena->release(item.record, item.texels);
    }
    _items.clear();
    _bases.clear();
    _exact = 0;
    _planeChanges.addAll();
    _changes.mappings.clear();
    _sorted.clear();
    _leftOut = 0;
    _changes.roomMade = true;
}

MappingRecords::Sources* MappingRecords::sources(ProjectiveMapping& mapping)
{
    const auto found = _items.find(&mapping);
    return found != _items.end() ? &found->second.sources : nullptr;
}

void MappingRecords::changeAll()
{
    for (const auto& [mapping, item] : _items)
        _changes.mappings.insert(mapping);
}

void MappingRecords::reset()
{
    for (auto& [mapping, item] : _items)
    {
        forget(item);
        item.record = 0;
    }
    _planeChanges.addAll();
    changeAll();
    _sorted.clear();
    _index.reset();
    _arena = std::make_shared<TexelArena>();
    _index = std::make_unique<MappingIndex>(*_arena);
}

std::uint64_t MappingRecords::rankOf(const Item& item)
{
    return static_cast<std::uint64_t>(item.mapping->getOrder() + 1000) << 48u | item.sequence;
}

bool MappingRecords::isReady(const Item& item) const
{
    const ProjectiveMapping& mapping = *item.mapping;
    const LayerResidency::Pair& layers = item.sources.layers;
    if (!item.parts.empty()) return false; // which show in its place
    if (!mapping.getEnabled() || mapping.getOpacity() <= 0.0 || mapping.getChannels() == 0) return false;
    if ((needsLayer(mapping) || mapping.getLayer()) && !_layers.placed(layers.layer)) return false;
    if (mapping.getTransfer()->getSource() == ColorTransfer::TABLE && !mapping.getTable()) return false;
    return mapping.getTransfer()->getAlpha() != ColorTransfer::FROM_MASK || _layers.placed(layers.mask);
}

/// Counts a mapping as it is now on the GPU.
void MappingRecords::note(Item& item)
{
    forget(item);
    const FootprintShape shape(item.mapping->footprint());
    item.noted = true;
    item.kind = pageKindOf(*item.mapping);
    item.notedRank = item.rank;
    const osg::Vec2d low = shape.low(), high = shape.high();
    // As much as writeProjector() widens it for the rounding of floats.
    const double rounding = 3e-7 * (std::max(std::abs(low.x()), std::abs(high.x())) +
                                    std::max(std::abs(low.y()), std::abs(high.y())) + (high - low).length());
    item.box = PlaneBox{low, high}.grown(rounding);
    if (item.kind == PageKind::Exact) ++_exact;
    if (item.kind == PageKind::Base) _bases[item.rank] = item.mapping;
    // What a base does is in no page.
    if (item.kind == PageKind::Page) _planeChanges.add(item.box);
}

void MappingRecords::forget(Item& item)
{
    if (!item.noted) return;
    item.noted = false;
    if (item.kind == PageKind::Exact) --_exact;
    if (item.kind == PageKind::Base) _bases.erase(item.notedRank);
    if (item.kind == PageKind::Page) _planeChanges.add(item.box);
}

void MappingRecords::repaint(ProjectiveMapping& mapping)
{
    const auto found = _items.find(&mapping);
    if (found != _items.end() && found->second.noted && found->second.kind == PageKind::Page)
        _planeChanges.add(found->second.box);
}

int MappingRecords::exact() const
{
    return _exact + static_cast<int>(_bases.size()) - (base() ? 1 : 0);
}

const ProjectiveMapping* MappingRecords::base() const
{
    const bool below = !_bases.empty() && !_sorted.empty() && _bases.begin()->first == _sorted.begin()->first;
    return below ? _bases.begin()->second : nullptr;
}

void MappingRecords::takeOff(Item& item)
{
    forget(item);
    if (item.record == 0) return;
    _index->erase(item.record);
    _arena->release(item.record, item.texels);
    _sorted.erase(item.rank);
    item.record = 0;
    _changes.roomMade = true;
}

bool MappingRecords::writeRecord(Item& item, const PositionOf& positionOf)
{
    const ProjectiveMapping& mapping = *item.mapping;
    const std::uint32_t texels = MappingRecord::sizeOf(mapping);
    if (item.record != 0 && item.texels != texels) takeOff(item);
    if (item.record == 0)
    {
        item.record = _arena->allocate(texels);
        item.texels = texels;
    }
    if (item.record == 0) return false;
    const Sources& sources = item.sources;
    const osg::Vec2d center = mapping.getCenter();
    TexelArena::Texel* record = _arena->edit(item.record, texels);
    MappingRecord::write(mapping, _layers.placed(sources.layers.layer), _layers.placed(sources.layers.mask),
                         _tables.row(sources.table),
                         positionOf(osg::Vec3d(center.x(), center.y(), mapping.getHeight())), record);
    _features |= MappingRecord::featuresOf(record);
    return true;
}

bool MappingRecords::place(Item& item, const PositionOf& positionOf)
{
    const bool there = item.record != 0 && item.texels == MappingRecord::sizeOf(*item.mapping);
    if (!writeRecord(item, positionOf)) return false;
    const std::uint64_t rank = rankOf(item);
    const PlaneFootprint footprint = item.mapping->footprint();
    const bool placed =
        there ? _index->update(item.record, rank, footprint) : _index->insert({item.record, rank, footprint});
    if (!placed)
    {
        takeOff(item);
        return false;
    }
    setRank(item, rank);
    note(item);
    return true;
}

void MappingRecords::setRank(Item& item, std::uint64_t rank)
{
    if (item.rank != rank) _sorted.erase(item.rank);
    item.rank = rank;
    _sorted[rank] = item.record;
}

bool MappingRecords::placeAll(const std::vector<Item*>& items, const PositionOf& positionOf)
{
    for (Item* item : items)
    {
        if (!writeRecord(*item, positionOf)) return false;
        setRank(*item, rankOf(*item));
        note(*item);
    }
    std::vector<MappingIndex::Entry> entries;
    entries.reserve(_sorted.size());
    for (const auto& [mapping, item] : _items)
    {
        if (item.record != 0) entries.push_back({item.record, item.rank, mapping->footprint()});
    }
    std::sort(entries.begin(), entries.end(),
              [](const auto& one, const auto& other) { return one.rank < other.rank; });
    return _index->assign(entries);
}

void MappingRecords::placeByImportance(const PositionOf& positionOf)
{
    std::vector<Item*> items;
    for (auto& [mapping, item] : _items)
    {
        takeOff(item);
        if (isReady(item)) items.push_back(&item);
    }
    std::sort(items.begin(), items.end(),
              [](const Item* a, const Item* b)
              {
                  if (outranks(*a->mapping, *b->mapping)) return true;
                  return !outranks(*b->mapping, *a->mapping) && a->sequence < b->sequence;
              });
    bool full = false;
    for (Item* item : items)
    {
        full = full || !place(*item, positionOf);
        item->leftOut = full;
    }
}

void MappingRecords::update(const PositionOf& positionOf)
{
    if (_changes.roomMade && _leftOut > 0)
    {
        for (const auto& [mapping, item] : _items)
        {
            if (item.leftOut) _changes.mappings.insert(mapping);
        }
    }
    std::vector<Item*> items;
    for (ProjectiveMapping* mapping : _changes.mappings)
    {
        Item& item = _items.at(mapping);
        item.leftOut = false;
        if (isReady(item))
            items.push_back(&item);
        else
            takeOff(item);
    }
    // The splits of the grid depend on the order. The set's own order is that of addresses, so it is not used.
    std::sort(items.begin(), items.end(),
              [](const Item* one, const Item* other) { return one->sequence < other->sequence; });
    bool placed = true;
    if (items.size() >= bulk)
    {
        placed = placeAll(items, positionOf);
    }
    else
    {
        for (Item* item : items)
            placed = placed && place(*item, positionOf);
    }
    if (!placed) placeByImportance(positionOf);
    if (!placed || _leftOut > 0)
    {
        _leftOut = static_cast<int>(std::count_if(_items.begin(), _items.end(),
                                                  [](const auto& each) { return each.second.leftOut; }));
    }
}

void MappingRecords::fill(CameraList& list, const Wanted& wanted)
{
    std::unordered_map<std::uint32_t, const ProjectiveMapping*> mappings;
    for (const auto& [mapping, item] : _items)
    {
        if (item.record != 0) mappings[item.record] = mapping;
    }
    std::vector<std::uint32_t> records;
    for (const auto& [rank, record] : _sorted)
    {
        if (wanted(*mappings.at(record))) records.push_back(record);
    }
    list.write(_arena, records);
}

} // namespace osgGeoFX
