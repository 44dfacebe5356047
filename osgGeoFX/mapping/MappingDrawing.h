// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/GpuStore.h>
#include <osgGeoFX/mapping/MappingIndex.h>
#include <osgGeoFX/mapping/MappingRecord.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

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

    Changes are noted by the thread that makes them, and worked in by the first camera that culls thereafter. Thread-safe. */
class MappingDrawing
{
public:
    using Settings = MappingSettings;
    /// Where in the frame a place of the plane at a height is.
    using PositionOf = std::function<osg::Vec3d(const osg::Vec3d& place)>;

    void add(ProjectiveMapping& mapping);
    void remove(ProjectiveMapping& mapping);
    void clear();
    void change(ProjectiveMapping& mapping);

    /// A camera's list of mappings, lowest first.
    struct CameraList
    {
        std::uint32_t offset = 0; ///< 0 for none
        std::uint32_t texels = 0;
        osg::ref_ptr<GpuStore> store; ///< the one that it is in
    };
    using Wanted = std::function<bool(const ProjectiveMapping&)>;
    /// All that a frame is drawn with, as it was at one time.
    struct Frame
    {
        std::uint64_t number = 0; ///< of the frame's commit
        MappingIndex::Root root;
        std::size_t longestList = 0;
        /// What the shader's code must have; only grows, so that it is not compiled again and again.
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
    struct TableKey
    {
        const ColorTable* table = nullptr;
        double low = 0.0;
        double high = 0.0;
        bool operator<(const TableKey& other) const
        {
            return std::tie(table, low, high) < std::tie(other.table, other.low, other.high);
        }
    };
    struct Item
    {
        osg::ref_ptr<ProjectiveMapping> mapping;
        std::uint64_t sequence = 0;
        std::uint64_t rank = 0;   ///< while it is on the GPU
        std::uint32_t record = 0; ///< 0: not on the GPU
        std::uint32_t texels = 0;
        osg::ref_ptr<DataLayer> layer, mask;
        TableKey table;
        bool leftOut = false;
    };
    using Users = std::unordered_set<ProjectiveMapping*>;
    struct Layer
    {
        Users users;
        bool seen = false;
        unsigned int revision = 0;
        unsigned int imageCount = 0;
        std::optional<PlacedLayer> placed;
        bool leftOut = false;
    };
    struct Table
    {
        osg::ref_ptr<ColorTable> table;
        Users users;
        unsigned int revision = 0;
        int row = -1;
        bool seen = false;
    };

    void reset(Settings settings);
    void drop(CameraList& list);
    void setList(CameraList& list, const Wanted& wanted);
    void use(Item& item);
    void leave(Item& item);
    void leaveLayer(DataLayer* data, ProjectiveMapping& mapping);
    void leaveTable(const TableKey& key, ProjectiveMapping& mapping);
    void updateLayers();
    bool updateLayer(DataLayer& data, Layer& layer);
    void unplace(Layer& layer);
    bool makeRoomFor(const DataLayer& data);
    void updateTables();
    void updateMappings(const PositionOf& positionOf);
    bool ready(const Item& item) const;
    bool writeRecord(Item& item, const PositionOf& positionOf);
    bool place(Item& item, const PositionOf& positionOf);
    bool placeAll(const std::vector<Item*>& items, const PositionOf& positionOf);
    void placeByImportance(const PositionOf& positionOf);
    void takeOff(Item& item);
    void setRank(Item& item, std::uint64_t rank);
    static std::uint64_t rankOf(const Item& item);
    void warnOfLimits();

    mutable std::mutex _mutex;
    Settings _settings;
    TexelArena _arena;
    std::unique_ptr<MappingIndex> _index;
    std::unique_ptr<LayerAtlas> _atlas;
    osg::ref_ptr<GpuStore> _store;
    std::uint64_t _sequence = 0;
    std::unordered_map<ProjectiveMapping*, Item> _items;
    std::unordered_set<ProjectiveMapping*> _changed;
    std::map<DataLayer*, Layer> _layers;
    std::map<TableKey, Table> _tables;
    std::set<int> _freeRows;
    int _rows = 0;
    GpuStore::Commit _commit;
    std::map<std::uint64_t, std::uint32_t> _sorted; ///< records on the GPU by rank
    std::uint32_t _features = 0;
    bool _roomMade = false;
    int _mappingsLeftOut = 0;
    int _layersLeftOut = 0;
    bool _warnedMappings = false;
    bool _warnedLayers = false;
};

} // namespace osgGeoFX
