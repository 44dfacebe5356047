// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/CameraList.h>
#include <osgGeoFX/mapping/detail/LayerResidency.h>
#include <osgGeoFX/mapping/detail/MappingIndex.h>
#include <osgGeoFX/mapping/detail/PageKind.h>
#include <osgGeoFX/mapping/detail/PlaneChanges.h>
#include <osgGeoFX/mapping/detail/TableRows.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/** The mappings' records in the texel arena, the grid over them (MappingIndex), and cameras' lists of them.

    A record exists while its mapping shows something and the arena has room. If there is not enough room, the most
    important mappings stay, and the largest among equal ones. The others are left out until room is made. For one
    thread at a time. */
class MappingRecords
{
public:
    /// The position in the frame of a place: x and y on the plane, and a height.
    using PositionOf = std::function<osg::Vec3d(const osg::Vec3d& place)>;
    using Wanted = std::function<bool(const ProjectiveMapping&)>;
    /// What a record refers to since the mapping's last change was worked in.
    struct Sources
    {
        LayerResidency::Pair layers;
        TableRows::Key table;
    };

    /// All three must outlive this object.
    MappingRecords(MappingChanges& changes, const LayerResidency& layers, const TableRows& tables);

    /// `rank`: its place among the mappings of its order, from 2^47 on (RankOfRoute); 0: above those that were added so before.
    void add(ProjectiveMapping& mapping, std::uint64_t rank = 0);
    /// Adds a mapping that is drawn in the place of another one, which was added; with others, in no order. The other one shows
    /// again when the last of its parts is removed. False if it has too many.
    bool addPart(ProjectiveMapping& part, ProjectiveMapping& whole);
    /// A mapping must have no parts any more.
    void remove(ProjectiveMapping& mapping);
    void clear();
    std::size_t count() const { return _items.size(); }
    /// Null for a mapping that was not added. Valid until the mapping is removed.
    Sources* sources(ProjectiveMapping& mapping);
    template<class Action>
    void each(const Action& action)
    {
        for (auto& [mapping, item] : _items)
            action(*mapping, item.sources);
    }

    /// Notes that all records must be written anew.
    void changeAll();
    /// Takes another arena. No mapping has a record before the next update(), and cameras' lists are no longer valid.
    void reset();
    /// Writes the records of mappings that have changed, or takes them off.
    void update(const PositionOf& positionOf);

    /// Fills a camera's empty list with the mappings that are wanted.
    void fill(CameraList& list, const Wanted& wanted);
    void release(CameraList& list) { list.release(_arena); }

    TexelArena& arena() { return *_arena; }
    const TexelArena& arena() const { return *_arena; }
    const MappingIndex& index() const { return *_index; }
    /// What the shader's code must have. It only grows, so that the code is not compiled again and again.
    std::uint32_t features() const { return _features; }
    /// The number of mappings that show something and have no room.
    int leftOut() const { return _leftOut; }

    /// Where the picture of the mappings has changed.
    const PlaneChanges& changes() const { return _planeChanges; }
    /// Notes that what a mapping shows has changed, although its record may stay as it is.
    void repaint(ProjectiveMapping& mapping);
    /// The number of mappings on the GPU that cannot be drawn beforehand, in their order or at all.
    int exact() const;
    /// The mapping of the kind Base below all others; null for none.
    const ProjectiveMapping* base() const;

private:
    struct Item
    {
        osg::ref_ptr<ProjectiveMapping> mapping;
        std::uint64_t sequence = 0;
        std::uint64_t rank = 0;   ///< while it is on the GPU
        std::uint32_t record = 0; ///< 0: not on the GPU
        std::uint32_t texels = 0;
        Sources sources;
        ProjectiveMapping* whole = nullptr; ///< of which it is a part
        std::set<std::uint64_t> parts;      ///< their numbers
        bool leftOut = false;
        bool noted = false; ///< whether the next three are known, and counted
        PageKind kind = PageKind::Page;
        std::uint64_t notedRank = 0;
        PlaneBox box;
    };

    bool isReady(const Item& item) const;
    bool writeRecord(Item& item, const PositionOf& positionOf);
    bool place(Item& item, const PositionOf& positionOf);
    bool placeAll(const std::vector<Item*>& items, const PositionOf& positionOf);
    void placeByImportance(const PositionOf& positionOf);
    void takeOff(Item& item);
    void note(Item& item);
    void forget(Item& item);
    void setRank(Item& item, std::uint64_t rank);
    static std::uint64_t rankOf(const Item& item);

    MappingChanges& _changes;
    const LayerResidency& _layers;
    const TableRows& _tables;
    std::shared_ptr<TexelArena> _arena; ///< shared with no one; lists find out by it whether they are valid
    std::unique_ptr<MappingIndex> _index;
    std::uint64_t _sequence = 0;
    std::unordered_map<ProjectiveMapping*, Item> _items;
    std::map<std::uint64_t, std::uint32_t> _sorted;           ///< records on the GPU, by rank
    std::map<std::uint64_t, const ProjectiveMapping*> _bases; ///< by rank
    int _exact = 0;
    PlaneChanges _planeChanges;
    std::uint32_t _features = 0;
    int _leftOut = 0;
};

} // namespace osgGeoFX
