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

namespace osgGeoFX
{

/// What of ProjectiveMappings decides on the room and the positions.
struct MappingSettings
{
    int pageSide = 0;
    int maxPages = 0;
    int maxTexels = 0;
    /// What the positions depend on, beside the ground.
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

/** The other side of ProjectiveMappings: keeps the GPU's copy of the mappings, their layers and tables, for all scenes with the
    same ground.

    Changes are noted by the thread that makes them, and worked in by the first camera that culls thereafter. Thread-safe: its
    parts are not, and it has the lock for all of them. */
class GpuMappings
{
public:
    using Settings = MappingSettings;
    using PositionOf = MappingRecords::PositionOf;
    using Wanted = MappingRecords::Wanted;

    void add(ProjectiveMapping& mapping);
    void remove(ProjectiveMapping& mapping);
    void clear();
    void change(ProjectiveMapping& mapping);

    /// All that a frame is drawn with, as it was at one time.
    struct Frame
    {
        std::uint64_t number = 0; ///< of the frame's commit
        MappingIndex::Root root;
        std::size_t longestList = 0;
        std::uint32_t features = 0;
        osg::ref_ptr<GpuStore> store;
    };
    /// Works in what has changed. With `wanted`, makes the camera's list of those in the place of its former one; without, it has
    /// none.
    Frame commit(const Settings& settings, const PositionOf& positionOf, CameraList& list,
                 const Wanted& wanted);
    /// Gives a list back.
    void release(CameraList& list);
    ProjectiveMappings::Capacity capacity() const;
    void releaseGLObjects(osg::State* state);

private:
    void reset(Settings settings);
    void use(ProjectiveMapping& mapping, const MappingRecords::Sources& next,
             MappingRecords::Sources& former);
    void warnOfLimits();

    mutable std::mutex _mutex;
    Settings _settings;
    MappingChanges _changes;
    LayerResidency _layers{_changes};
    TableRows _tables{_changes};
    MappingRecords _records{_changes, _layers, _tables};
    osg::ref_ptr<GpuStore> _store; ///< null before the first commit
    bool _warnedMappings = false;
    bool _warnedLayers = false;
};

} // namespace osgGeoFX
