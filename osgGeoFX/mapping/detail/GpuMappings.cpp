// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/GpuMappings.h>

#include <osg/Notify>

#include <algorithm>
#include <utility>

namespace osgGeoFX
{

namespace
{

MappingRecords::Sources sourcesOf(ProjectiveMapping& mapping)
{
    const ColorTransfer& transfer = *mapping.getTransfer();
    MappingRecords::Sources sources;
    sources.layers.layer = mapping.getLayer();
    if (transfer.getAlpha() == ColorTransfer::FROM_MASK) sources.layers.mask = mapping.getMask();
    if (mapping.getTable() && transfer.getSource() == ColorTransfer::TABLE)
        sources.table = {mapping.getTable(), transfer.getLowValue(), transfer.getHighValue()};
    return sources;
}

} // namespace

void GpuMappings::add(ProjectiveMapping& mapping, std::uint64_t rank)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _records.add(mapping, rank);
}

void GpuMappings::remove(ProjectiveMapping& mapping)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    drop(mapping);
}

void GpuMappings::drop(ProjectiveMapping& mapping)
{
    MappingRecords::Sources* sources = _records.sources(mapping);
    if (!sources) return;
    use(mapping, {}, *sources);
    _records.remove(mapping);
}

void GpuMappings::setParts(ProjectiveMapping& whole, const Parts& added, const Parts& removed)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const osg::ref_ptr<ProjectiveMapping>& part : added)
        _records.addPart(*part, whole);
    _leaving.insert(_leaving.end(), removed.begin(), removed.end());
}

void GpuMappings::clear()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _records.each([this](ProjectiveMapping& mapping, MappingRecords::Sources& sources)
                  { use(mapping, {}, sources); });
    _records.clear();
    _leaving.clear();
}

void GpuMappings::change(ProjectiveMapping& mapping)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_records.sources(mapping)) _changes.mappings.insert(&mapping);
}

void GpuMappings::use(ProjectiveMapping& mapping, const MappingRecords::Sources& next,
                      MappingRecords::Sources& former)
{
    _layers.use(mapping, next.layers, former.layers);
    _tables.use(mapping, next.table, former.table);
    former = next;
}

void GpuMappings::reset(Settings settings)
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
        if (!settings.sameFrame(_settings)) _records.changeAll();
        if (settings.sameRoom(_settings))
        {
            if (settings.reservedPages > _settings.reservedPages)
                _store->reserve(std::min(settings.reservedPages, settings.maxPages));
            _settings = settings;
            return;
        }
    }
    const bool texelsFit = static_cast<std::uint32_t>(settings.maxTexels) >= _records.arena().size();
    const bool pagesStay =
        _store && settings.pageSide == _settings.pageSide && settings.maxPages == _settings.maxPages;
    _settings = settings;
    _changes.roomMade = true;
    if (!pagesStay || !texelsFit)
    {
        // Everything starts anew.
        _records.reset();
        _layers.reset(settings.pageSide, settings.maxPages);
        _tables.reset();
        _store = new GpuStore(settings.pageSide);
        _changes.uploads = {};
    }
    _records.arena().setLimit(static_cast<std::uint32_t>(settings.maxTexels));
    _store->reserve(std::min(settings.reservedPages, settings.maxPages));
}

void GpuMappings::warnOfLimits()
{
    const int mappings = _records.leftOut();
    if (mappings > 0 && !_warnedMappings)
    {
        OSG_WARN
            << "osgGeoFX: The texture buffer's limit of " << _settings.maxTexels << " texels leaves out "
            << mappings << " of " << _records.count()
            << " mappings, the least important; raise maxDataSize, if the GPU has more, or their importance."
            << std::endl;
    }
    const int layers = _layers.leftOut();
    if (layers > 0 && !_warnedLayers)
    {
        OSG_WARN << "osgGeoFX: The limit of " << _settings.maxPages << " pages of " << _settings.pageSide
                 << " texels leaves out " << layers << " of " << _layers.count()
                 << " data layers, the least important; raise maxPages, if the GPU has more, or make layers "
                    "smaller."
                 << std::endl;
    }
    _warnedMappings = mappings > 0;
    _warnedLayers = layers > 0;
}

GpuMappings::Frame GpuMappings::commit(const Settings& settings, const PositionOf& positionOf,
                                       CameraList& list, const Wanted& wanted)
{
    // One lock for all steps, so that no other camera's commit comes between them.
    const std::lock_guard<std::mutex> lock(_mutex);
    reset(settings);
    for (ProjectiveMapping* mapping : _changes.mappings)
        use(*mapping, sourcesOf(*mapping), *_records.sources(*mapping));
    for (const osg::ref_ptr<ProjectiveMapping>& part : _leaving)
        drop(*part);
    _leaving.clear();
    _layers.update();
    _tables.update();
    _records.update(positionOf);
    for (ProjectiveMapping* mapping : _changes.repainted)
        _records.repaint(*mapping);
    _changes.repainted.clear();
    _changes.mappings.clear();
    _changes.roomMade = false;
    warnOfLimits();
    _records.release(list);
    if (wanted) _records.fill(list, wanted);
    const std::uint64_t number = _store->commit(_records.arena(), std::move(_changes.uploads));
    _changes.uploads = {};
    Frame frame;
    frame.number = number;
    frame.root = _records.index().root();
    frame.longestList = _records.index().longestList();
    frame.features = _records.features();
    frame.store = _store;
    frame.exact = _records.exact();
    frame.changes = _records.changes().number();
    if (const ProjectiveMapping* base = _records.base())
    {
        const std::optional<PlaneFootprint> outline = base->outline();
        if (outline) frame.base = {base->getTransfer()->effectiveMatrix(), base->getOpacity(), *outline};
        if (!outline) ++frame.exact;
    }
    return frame;
}

std::optional<std::vector<PlaneBox>> GpuMappings::changedSince(std::uint64_t changes) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _records.changes().since(changes);
}

void GpuMappings::release(CameraList& list)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _records.release(list);
}

ProjectiveMappings::Capacity GpuMappings::capacity() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    ProjectiveMappings::Capacity result;
    if (!_store) return result;
    result.pages = _settings.maxPages;
    result.pagesUsed = _layers.pagesUsed();
    result.texels = _settings.maxTexels;
    result.texelsUsed = static_cast<int>(_records.arena().used());
    result.mappingsLeftOut = _records.leftOut();
    result.layersLeftOut = _layers.leftOut();
    result.uploadedBytes = _store->uploadedBytes();
    return result;
}

void GpuMappings::releaseGLObjects(osg::State* state)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_store) _store->releaseGLObjects(state);
}

} // namespace osgGeoFX
