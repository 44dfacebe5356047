// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/MappingDrawing.h>

#include <osg/Notify>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// From so many changes at once on the whole grid is made anew.
constexpr std::size_t bulk = 2000;

bool needsLayer(const ProjectiveMapping& mapping)
{
    const ColorTransfer::Source source = mapping.getTransfer()->getSource();
    return source == ColorTransfer::LAYER || source == ColorTransfer::TABLE;
}

/// Whether one is to stay rather than the other.
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

void MappingDrawing::add(ProjectiveMapping& mapping)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Item& item = _items[&mapping];
    item.mapping = &mapping;
    item.sequence = ++_sequence;
    _changed.insert(&mapping);
}

void MappingDrawing::remove(ProjectiveMapping& mapping)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _items.find(&mapping);
    if (found == _items.end()) return;
    takeOff(found->second);
    leave(found->second);
    if (found->second.leftOut) --_mappingsLeftOut;
    _changed.erase(&mapping);
    _items.erase(found);
}

void MappingDrawing::clear()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    // At once: out of a long list one after the other takes its length squared.
    if (_index) _index->clear();
    for (auto& [mapping, item] : _items)
    {
        if (item.record != 0) _arena.release(item.record, item.texels);
        leave(item);
    }
    _items.clear();
    _changed.clear();
    _sorted.clear();
    _mappingsLeftOut = 0;
    _roomMade = true;
}

void MappingDrawing::change(ProjectiveMapping& mapping)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_items.count(&mapping)) _changed.insert(&mapping);
}

void MappingDrawing::reset(Settings settings)
{
    if (_store)
    {
        const GpuStore::Limits limits = _store->limits();
        if (limits.texels > 0)
        {
            settings.pageSide = std::min(settings.pageSide, limits.pageSide);
            settings.maxPages = std::min(settings.maxPages, limits.pages);
            settings.maxTexels = std::min(settings.maxTexels, limits.texels);
        }
        if (!settings.sameFrame(_settings))
        {
            for (const auto& [mapping, item] : _items)
                _changed.insert(mapping);
        }
        if (settings.sameRoom(_settings))
        {
            _settings = settings;
            return;
        }
    }
    const bool texelsFit = static_cast<std::uint32_t>(settings.maxTexels) >= _arena.size();
    const bool pagesStay =
        _store && settings.pageSide == _settings.pageSide && settings.maxPages == _settings.maxPages;
    _settings = settings;
    _roomMade = true;
    if (!pagesStay || !texelsFit)
    {
        // Everything anew.
        for (auto& [mapping, item] : _items)
        {
            item.record = 0;
            _changed.insert(mapping);
        }
        _sorted.clear();
        for (auto& [data, layer] : _layers)
        {
            layer.placed.reset();
            layer.seen = false;
        }
        for (auto& [key, table] : _tables)
            table.seen = false;
        _index.reset();
        _arena = TexelArena();
        _index = std::make_unique<MappingIndex>(_arena);
        _atlas = std::make_unique<LayerAtlas>(settings.pageSide, settings.maxPages);
        _store = new GpuStore(settings.pageSide);
        _commit = {};
    }
    _arena.setLimit(static_cast<std::uint32_t>(settings.maxTexels));
}

void MappingDrawing::use(Item& item)
{
    ProjectiveMapping& mapping = *item.mapping;
    const ColorTransfer& transfer = *mapping.getTransfer();
    TableKey key;
    if (mapping.getTable() && transfer.getSource() == ColorTransfer::TABLE)
        key = {mapping.getTable(), transfer.getLowValue(), transfer.getHighValue()};
    DataLayer* layer = mapping.getLayer();
    DataLayer* mask = transfer.getAlpha() == ColorTransfer::FROM_MASK ? mapping.getMask() : nullptr;
    // A layer that it goes on to use keeps its place, and its texels there.
    for (osg::ref_ptr<DataLayer>* former : {&item.layer, &item.mask})
    {
        if (*former != layer && *former != mask) leaveLayer(*former, mapping);
    }
    item.layer = layer;
    item.mask = mask;
    if (layer) _layers[layer].users.insert(&mapping);
    if (mask) _layers[mask].users.insert(&mapping);
    if (!(key < item.table) && !(item.table < key)) return;
    leaveTable(item.table, mapping);
    item.table = key;
    if (!key.table) return;
    Table& table = _tables[key];
    table.table = mapping.getTable();
    table.users.insert(&mapping);
}

void MappingDrawing::leave(Item& item)
{
    leaveLayer(item.layer, *item.mapping);
    leaveLayer(item.mask, *item.mapping);
    leaveTable(item.table, *item.mapping);
    item.layer = nullptr;
    item.mask = nullptr;
    item.table = {};
}

void MappingDrawing::leaveLayer(DataLayer* data, ProjectiveMapping& mapping)
{
    const auto found = _layers.find(data);
    if (found == _layers.end()) return;
    found->second.users.erase(&mapping);
    if (!found->second.users.empty()) return;
    unplace(found->second);
    if (found->second.leftOut) --_layersLeftOut;
    _layers.erase(found);
}

void MappingDrawing::leaveTable(const TableKey& key, ProjectiveMapping& mapping)
{
    const auto found = _tables.find(key);
    if (found == _tables.end()) return;
    found->second.users.erase(&mapping);
    if (!found->second.users.empty()) return;
    if (found->second.row >= 0) _freeRows.insert(found->second.row);
    _tables.erase(found);
}

void MappingDrawing::unplace(Layer& layer)
{
    if (!layer.placed) return;
    _atlas->release(layer.placed->slot);
    _commit.layers.push_back({layer.placed->slot, nullptr});
    layer.placed.reset();
    _roomMade = true;
}

bool MappingDrawing::makeRoomFor(const DataLayer& data)
{
    std::pair<DataLayer* const, Layer>* least = nullptr;
    for (auto& entry : _layers)
    {
        const bool better = !least || entry.first->getImportance() < least->first->getImportance();
        if (entry.second.placed && better) least = &entry;
    }
    if (!least || least->first->getImportance() >= data.getImportance()) return false;
    unplace(least->second);
    least->second.leftOut = true;
    ++_layersLeftOut;
    _changed.insert(least->second.users.begin(), least->second.users.end());
    return true;
}

bool MappingDrawing::updateLayer(DataLayer& data, Layer& layer)
{
    const osg::Image* image = data.getImage();
    std::shared_ptr<LayerPixels> pixels;
    if (image && image->s() > 0)
    {
        LayerPixels::Options options;
        options.kind = static_cast<LayerPixels::Kind>(data.getKind());
        options.sRGB = data.getSRgb();
        if (data.getHasNoData()) options.noData = data.getNoData();
        options.maxSide = _settings.pageSide;
        std::string error;
        std::optional<LayerPixels> made = LayerPixels::make(*image, options, error);
        if (!made)
        {
            OSG_WARN << "osgGeoFX: DataLayer \"" << data.getName() << "\": " << error << " It is not drawn."
                     << std::endl;
        }
        else
        {
            if (made->reduced && layer.revision != data.revision())
            {
                OSG_WARN << "osgGeoFX: DataLayer \"" << data.getName() << "\" has " << image->s() << " x "
                         << image->t() << " texels, and is reduced to pages of " << _settings.pageSide
                         << "; raise ProjectiveMappings' pageSide to see all of it." << std::endl;
            }
            pixels = std::make_shared<LayerPixels>(std::move(*made));
        }
    }
    const auto former = layer.placed;
    if (layer.placed && (!pixels || pixels->side != layer.placed->slot.side)) unplace(layer);
    if (pixels && !layer.placed)
    {
        std::optional<LayerAtlas::Slot> slot = _atlas->add(pixels->side);
        while (!slot && makeRoomFor(data))
            slot = _atlas->add(pixels->side);
        if (slot) layer.placed = PlacedLayer{*slot, 0, 0};
    }
    const bool leftOut = pixels && !layer.placed;
    _layersLeftOut += static_cast<int>(leftOut) - static_cast<int>(layer.leftOut);
    layer.leftOut = leftOut;
    if (layer.placed)
    {
        layer.placed->width = pixels->width;
        layer.placed->height = pixels->height;
        _commit.layers.push_back({layer.placed->slot, pixels});
    }
    const auto same = [](const std::optional<PlacedLayer>& a, const std::optional<PlacedLayer>& b)
    {
        if (!a || !b) return a.has_value() == b.has_value();
        return a->slot.page == b->slot.page && a->slot.x == b->slot.x && a->slot.y == b->slot.y &&
               a->slot.side == b->slot.side && a->width == b->width && a->height == b->height;
    };
    return !same(former, layer.placed);
}

void MappingDrawing::updateLayers()
{
    const auto countOf = [](const DataLayer& data)
    {
        return data.getImage() ? data.getImage()->getModifiedCount() : 0;
    };
    const auto stale = [&](const auto& entry)
    {
        const auto& [data, layer] = entry;
        return !layer.seen || layer.revision != data->revision() || layer.imageCount != countOf(*data) ||
               (layer.leftOut && _roomMade);
    };
    if (std::none_of(_layers.begin(), _layers.end(), stale)) return;
    // The most important first: what has to go for them gets what room is left.
    std::vector<std::pair<DataLayer* const, Layer>*> entries;
    for (auto& entry : _layers)
        entries.push_back(&entry);
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto* a, const auto* b)
                     { return a->first->getImportance() > b->first->getImportance(); });
    for (auto* entry : entries)
    {
        if (!stale(*entry)) continue;
        auto& [data, layer] = *entry;
        const bool differs = layer.revision != data->revision();
        const bool moved = updateLayer(*data, layer);
        if (moved || differs || !layer.seen) _changed.insert(layer.users.begin(), layer.users.end());
        layer.seen = true;
        layer.revision = data->revision();
        layer.imageCount = countOf(*data);
    }
}

void MappingDrawing::updateTables()
{
    for (auto& [key, table] : _tables)
    {
        if (table.seen && table.revision == table.table->revision()) continue;
        if (table.row < 0)
        {
            table.row = _freeRows.empty() ? _rows++ : *_freeRows.begin();
            _freeRows.erase(table.row);
            _changed.insert(table.users.begin(), table.users.end());
        }
        std::vector<osg::Vec4us> row(GpuStore::tableWidth);
        table.table->row(key.low, key.high, row.data(), GpuStore::tableWidth);
        GpuStore::Table upload{table.row, std::vector<std::uint16_t>(4 * row.size())};
        for (std::size_t i = 0; i < row.size(); ++i)
            std::copy(row[i].ptr(), row[i].ptr() + 4,
                      upload.texels.begin() + static_cast<std::ptrdiff_t>(4 * i));
        _commit.tables.push_back(std::move(upload));
        if (!table.seen || table.revision != table.table->revision())
            _changed.insert(table.users.begin(), table.users.end());
        table.seen = true;
        table.revision = table.table->revision();
    }
}

std::uint64_t MappingDrawing::rankOf(const Item& item)
{
    return static_cast<std::uint64_t>(item.mapping->getOrder() + 1000) << 48u | item.sequence;
}

bool MappingDrawing::ready(const Item& item) const
{
    const ProjectiveMapping& mapping = *item.mapping;
    if (!mapping.getEnabled() || mapping.getOpacity() <= 0.0 || mapping.getChannels() == 0) return false;
    const auto placed = [&](DataLayer* data)
    {
        const auto found = _layers.find(data);
        return found != _layers.end() && found->second.placed;
    };
    if ((needsLayer(mapping) || mapping.getLayer()) && !placed(item.layer)) return false;
    if (mapping.getTransfer()->getSource() == ColorTransfer::TABLE && !mapping.getTable()) return false;
    return mapping.getTransfer()->getAlpha() != ColorTransfer::FROM_MASK || placed(item.mask);
}

void MappingDrawing::takeOff(Item& item)
{
    if (item.record == 0) return;
    if (_index) _index->erase(item.record);
    _arena.release(item.record, item.texels);
    _sorted.erase(item.rank);
    item.record = 0;
    _roomMade = true;
}

bool MappingDrawing::writeRecord(Item& item, const PositionOf& positionOf)
{
    const ProjectiveMapping& mapping = *item.mapping;
    const std::uint32_t texels = MappingRecord::sizeOf(mapping);
    if (item.record != 0 && item.texels != texels) takeOff(item);
    if (item.record == 0)
    {
        item.record = _arena.allocate(texels);
        item.texels = texels;
    }
    if (item.record == 0) return false;
    const auto placed = [&](DataLayer* data)
    {
        const auto found = _layers.find(data);
        return found != _layers.end() ? found->second.placed : std::nullopt;
    };
    const auto table = _tables.find(item.table);
    const osg::Vec2d centre = mapping.getCentre();
    TexelArena::Texel* record = _arena.edit(item.record, texels);
    MappingRecord::write(mapping, placed(item.layer), placed(item.mask),
                         table != _tables.end() ? table->second.row : 0,
                         positionOf(osg::Vec3d(centre.x(), centre.y(), mapping.getHeight())), record);
    _features |= MappingRecord::featuresOf(record);
    return true;
}

bool MappingDrawing::place(Item& item, const PositionOf& positionOf)
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
    return true;
}

void MappingDrawing::setRank(Item& item, std::uint64_t rank)
{
    if (item.rank != rank) _sorted.erase(item.rank);
    item.rank = rank;
    _sorted[rank] = item.record;
}

bool MappingDrawing::placeAll(const std::vector<Item*>& items, const PositionOf& positionOf)
{
    for (Item* item : items)
    {
        if (!writeRecord(*item, positionOf)) return false;
        setRank(*item, rankOf(*item));
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

void MappingDrawing::placeByImportance(const PositionOf& positionOf)
{
    std::vector<Item*> items;
    for (auto& [mapping, item] : _items)
    {
        takeOff(item);
        if (ready(item)) items.push_back(&item);
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

void MappingDrawing::updateMappings(const PositionOf& positionOf)
{
    if (_roomMade && _mappingsLeftOut > 0)
    {
        for (const auto& [mapping, item] : _items)
        {
            if (item.leftOut) _changed.insert(mapping);
        }
    }
    std::vector<Item*> items;
    for (ProjectiveMapping* mapping : _changed)
    {
        Item& item = _items.at(mapping);
        item.leftOut = false;
        if (ready(item))
            items.push_back(&item);
        else
            takeOff(item);
    }
    // How the grid is split depends on the order, and that of the set is one of addresses.
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
    if (!placed || _mappingsLeftOut > 0)
    {
        _mappingsLeftOut = static_cast<int>(std::count_if(
            _items.begin(), _items.end(), [](const auto& each) { return each.second.leftOut; }));
    }
}

void MappingDrawing::warnOfLimits()
{
    if (_mappingsLeftOut > 0 && !_warnedMappings)
    {
        OSG_WARN
            << "osgGeoFX: The texture buffer's limit of " << _settings.maxTexels << " texels leaves out "
            << _mappingsLeftOut << " of " << _items.size()
            << " mappings, the least important; raise maxDataSize, if the GPU has more, or their importance."
            << std::endl;
    }
    if (_layersLeftOut > 0 && !_warnedLayers)
    {
        OSG_WARN << "osgGeoFX: The limit of " << _settings.maxPages << " pages of " << _settings.pageSide
                 << " texels leaves out " << _layersLeftOut << " of " << _layers.size()
                 << " data layers, the least important; raise maxPages, if the GPU has more, or make layers "
                    "smaller."
                 << std::endl;
    }
    _warnedMappings = _mappingsLeftOut > 0;
    _warnedLayers = _layersLeftOut > 0;
}

MappingDrawing::Frame MappingDrawing::commit(const Settings& settings, const PositionOf& positionOf,
                                             CameraList& list, const Wanted& wanted)
{
    // Under one lock: another camera's commit would come between.
    const std::lock_guard<std::mutex> lock(_mutex);
    reset(settings);
    for (ProjectiveMapping* mapping : _changed)
        use(_items.at(mapping));
    updateLayers();
    updateTables();
    updateMappings(positionOf);
    _changed.clear();
    _roomMade = false;
    warnOfLimits();
    drop(list);
    if (wanted) setList(list, wanted);
    const std::uint64_t number = _store->commit(_arena, std::move(_commit));
    _commit = {};
    return {number, _index->root(), _index->longestList(), _features, _store};
}

void MappingDrawing::release(CameraList& list)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    drop(list);
}

void MappingDrawing::drop(CameraList& list)
{
    // With the store, the arena that it was in has gone.
    if (list.texels > 0 && list.store == _store) _arena.release(list.offset, list.texels);
    list = {};
}

void MappingDrawing::setList(CameraList& list, const Wanted& wanted)
{
    std::unordered_map<std::uint32_t, const ProjectiveMapping*> mappings;
    for (const auto& [mapping, item] : _items)
    {
        if (item.record != 0) mappings[item.record] = mapping;
    }
    std::vector<std::uint32_t> words = {0};
    for (const auto& [rank, record] : _sorted)
    {
        if (wanted(*mappings.at(record))) words.push_back(record);
    }
    words[0] = static_cast<std::uint32_t>(words.size() - 1);
    const auto count = static_cast<std::uint32_t>((words.size() + 3) / 4);
    const std::uint32_t offset = words[0] > 0 ? _arena.allocate(count) : 0;
    if (offset == 0) return;
    list = {offset, count, _store};
    words.resize(4u * list.texels);
    TexelArena::Texel* texels = _arena.edit(list.offset, list.texels);
    for (std::size_t i = 0; i < words.size(); ++i)
        texels[i / 4][i % 4] = words[i];
}

ProjectiveMappings::Capacity MappingDrawing::capacity() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    ProjectiveMappings::Capacity result;
    if (!_store) return result;
    result.pages = _settings.maxPages;
    result.pagesUsed = _atlas->pages();
    result.texels = _settings.maxTexels;
    result.texelsUsed = static_cast<int>(_arena.used());
    result.mappingsLeftOut = _mappingsLeftOut;
    result.layersLeftOut = _layersLeftOut;
    result.uploadedBytes = _store->uploadedBytes();
    return result;
}

void MappingDrawing::releaseGLObjects(osg::State* state)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_store) _store->releaseGLObjects(state);
}

} // namespace osgGeoFX
