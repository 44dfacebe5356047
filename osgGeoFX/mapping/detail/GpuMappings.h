// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/detail/GpuStore.h>
#include <osgGeoFX/mapping/detail/LayerResidency.h>
#include <osgGeoFX/mapping/detail/MappingRecords.h>
#include <osgGeoFX/mapping/detail/TableRows.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/// The properties of ProjectiveMappings that decide about room and positions.
struct MappingSettings
{
    int pageSide = 0;
    int maxPages = 0;
    int maxTexels = 0;
    int reservedPages = 0; ///< to have from the beginning, since more of them take a while
    /// The origin on a globe, on which positions depend; 0 on a plane.
    double longitude = 0.0;
    double latitude = 0.0;

    bool sameRoom(const MappingSettings& other) const
    {
        return pageSide == other.pageSide && maxPages == other.maxPages && maxTexels == other.maxTexels;
    }
    bool sameFrame(const MappingSettings& other) const
    {
        return longitude == other.longitude && latitude == other.latitude;
    }
};

/** The GPU's copy of ProjectiveMappings: its mappings, their layers and their tables, for all scenes with the same
    ground.

    The thread that changes a mapping notes the change here. The next camera that culls works it in. Thread-safe. The
    parts are not; this class has the lock for all of them. */
class GpuMappings
{
public:
    using Settings = MappingSettings;
    using PositionOf = MappingRecords::PositionOf;
    using Wanted = MappingRecords::Wanted;

    /// `rank`: see MappingRecords::add().
    void add(ProjectiveMapping& mapping, std::uint64_t rank = 0);
    void remove(ProjectiveMapping& mapping);
    void clear();
    void change(ProjectiveMapping& mapping);
    /// Replaces parts of a mapping (MappingRecords::addPart()). Layers that both have keep their places.
    using Parts = std::vector<osg::ref_ptr<ProjectiveMapping>>;
    void setParts(ProjectiveMapping& whole, const Parts& added, const Parts& removed);

    /// All that a frame is drawn with, as it was at one time.
    struct Frame
    {
        std::uint64_t number = 0;  ///< the number of the frame's commit
        std::uint64_t changes = 0; ///< the number of changes that it brought, for changedSince()
        MappingIndex::Root root;
        std::size_t longestList = 0;
        std::uint32_t features = 0;
        osg::ref_ptr<GpuStore> store;
        int exact = 0;                ///< the number of mappings that cannot be drawn beforehand
        std::optional<PageBase> base; ///< below all others
    };
    /// Works in all changes. With `wanted`, it also replaces the camera's list by one of the wanted mappings.
    /// Without, the camera has no list.
    Frame commit(const Settings& settings, const PositionOf& positionOf, CameraList& list,
                 const Wanted& wanted);
    /// Where the picture of the mappings has changed since a commit, by its number of changes. Nothing for everywhere.
    std::optional<std::vector<PlaneBox>> changedSince(std::uint64_t changes) const;
    /// Calls an action with the grid, which does not change in the meantime.
    template<class Action>
    void withIndex(const Action& action) const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        action(_records.index());
    }
    /// Gives the texels of a list back.
    void release(CameraList& list);
    ProjectiveMappings::Capacity capacity() const;
    void releaseGLObjects(osg::State* state);

private:
    void reset(Settings settings);
    void use(ProjectiveMapping& mapping, const MappingRecords::Sources& next,
             MappingRecords::Sources& former);
    void drop(ProjectiveMapping& mapping);
    void warnOfLimits();

    mutable std::mutex _mutex;
    Settings _settings;
    MappingChanges _changes;
    LayerResidency _layers{_changes};
    TableRows _tables{_changes};
    MappingRecords _records{_changes, _layers, _tables};
    Parts _leaving;                ///< until the next commit
    osg::ref_ptr<GpuStore> _store; ///< null before the first commit
    bool _warnedMappings = false;
    bool _warnedLayers = false;
};

} // namespace osgGeoFX
